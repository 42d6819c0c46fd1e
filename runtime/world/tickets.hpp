// What hosts know instances by: one number for each use of a slot, which no restore takes back.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/ids.hpp"

namespace breve {

/// Generations of ids go back with a restore, so that a restored world goes on as the saved one did: the same id then
/// names one instance before the restore and another one after it. A host may still hold the first. Tickets count the
/// uses of each slot over all that the world has been through. They take no part in hashes.
class Tickets {
 public:
  /// The ticket of a slot that is used up, and of an instance so old that its number is forgotten. Names nobody.
  static constexpr std::uint32_t kLost = 0xffffffffU;

  explicit Tickets(std::pmr::memory_resource* memory) : slots_(memory) {}

  void make_room(std::size_t slots);  // issue() never allocates
  void issue(ObjectId id);            // to a new instance
  std::uint32_t of(ObjectId id) const;
  /// The generation that the ticket was issued to, or 0 if that is not known.
  std::uint32_t generation(std::uint32_t index, std::uint32_t ticket) const {
    if (index >= slots_.size() || ticket > slots_[index].last || ticket == kLost) return 0;
    const std::uint32_t generation = ticket - slots_[index].offset;
    return generation >= slots_[index].since ? generation : 0;
  }
  /// No instance that is made in the slot would get one.
  bool spent(std::uint32_t index) const { return slots_[index].last >= kLost - 1; }
  /// This has been restored in the place of `abandoned`: what was issued there is not issued again.
  void keep(const Tickets& abandoned);
  std::size_t bytes() const { return slots_.capacity() * sizeof(Slot); }

  void save(ByteWriter& out) const;
  void load(ByteReader& in);

 private:
  struct Slot {
    std::uint32_t offset = 0;  // ticket less generation (modulo 2^32)
    std::uint32_t since = 0;   // of the generations from this one on
    std::uint32_t last = 0;    // the last that was issued; kLost if they are used up
  };
  std::pmr::vector<Slot> slots_;
};

}  // namespace breve
