// Where everything was at the last update of neighbours, and who asks about it: points for the search, and beside them
// what the world gives out, so that an answer needs no look at the table of objects.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/ids.hpp"
#include "runtime/space/neighbors.hpp"
#include "runtime/world/objects.hpp"

namespace breve {

class NeighborRecord {
 public:
  explicit NeighborRecord(std::pmr::memory_resource* memory)
      : points_(memory), ids_(memory), gone_(memory), slot_(memory), result_(memory), user_result_(memory) {}

  /// Begin a new moment; live objects follow in order of creation. @param slots  of the table of objects
  void clear(std::size_t slots);
  void add(ObjectId id, std::uint64_t user, const Vector3& center, double radius);
  void close(const Extent& space) { points_.close(space); }  // all are there
  /// The object is released: no answer names it from now on.
  void forget(ObjectId id);
  void set_user(ObjectId id, std::uint64_t user);

  /// Live neighbours in order of creation; none for an object that was not there at the update. Valid until the next
  /// call.
  const std::pmr::vector<ObjectId>& neighbors(ObjectId id);
  std::span<const std::uint64_t> users(ObjectId id);    // the same neighbours' user words
  bool answered() const { return points_.answered(); }  // all answers are known: a question is a look-up

  void save(ByteWriter& out) const;
  /// Into an empty record. @throws Error{Image} for what no record can hold
  void load(ByteReader& in, const ObjectTable& objects);
  void hash(Hasher& hasher) const;
  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kNowhere = 0xffffffffU;
  std::uint32_t find(ObjectId id) const;  // kNowhere if it is not of this moment

  Neighbors points_;  // labelled with the user words
  // By place in the record, which is the order of creation.
  std::pmr::vector<ObjectId> ids_;
  std::pmr::vector<std::uint8_t> gone_;  // released since the update
  bool any_gone_ = false;
  std::pmr::vector<std::uint32_t> slot_;  // by object slot; of an object not recorded it means nothing
  std::pmr::vector<ObjectId> result_;
  std::pmr::vector<std::uint64_t> user_result_;
};

}  // namespace breve
