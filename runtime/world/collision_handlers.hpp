// Which classes want to know when they touch which: by exact class on both sides.
#pragma once

#include <cstdint>
#include <map>
#include <memory_resource>
#include <span>
#include <utility>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/ids.hpp"
#include "runtime/world/behaviour.hpp"
#include "runtime/world/name_table.hpp"

namespace breve {

class CollisionHandlers {
 public:
  explicit CollisionHandlers(std::pmr::memory_resource* memory) : pairs_(memory), taking_part_(memory) {}

  /// The first handler of a pair of classes stays; later ones are ignored. Ignoring stands beside handling.
  void handle(ClassId owner, ClassId other, NameId method);
  void ignore(ClassId owner, ClassId other);
  /// The method that `owner` wants called when it touches `other`; kNoName if none.
  NameId method(ClassId owner, ClassId other) const;
  /// What `owner` asked for, by the other class: visit(other, method, ignored). The method is kNoName if there is none.
  template <class Visit>
  void for_each_of(ClassId owner, Visit visit) const {
    for (auto pair = pairs_.lower_bound({owner, 0}); pair != pairs_.end() && pair->first.first == owner; ++pair)
      visit(pair->first.second, pair->second.method, pair->second.ignored);
  }
  /// True if either side asked not to be pushed apart.
  bool ignored(ClassId a, ClassId b) const;
  /// True if a contact between the two has a handler on either side.
  bool handled(ClassId a, ClassId b) const { return method(a, b) != kNoName || method(b, a) != kNoName; }
  /// True if some handler names this class on either side.
  bool takes_part(ClassId cls) const { return cls < taking_part_.size() && taking_part_[cls] != 0; }
  bool any_handler() const { return handlers_ != 0; }
  void note_change() { ++revision_; }  // who asks for answers asks for more than these handlers
  /// Grows with every change that can matter to a pair that was looked at before.
  std::uint64_t revision() const { return revision_; }

  /// The same handlers under other class numbers; those of classes that are gone are left out (reclass.cpp).
  CollisionHandlers reclassed(std::span<const ClassChange> classes) const;
  void swap(CollisionHandlers& other) noexcept;  // one with the same memory

  void save(ByteWriter& out) const;
  void load(ByteReader& in, std::size_t names);
  void hash(Hasher& hasher, const NameTable& names) const;

 private:
  struct Entry {
    NameId method = kNoName;
    bool ignored = false;
  };
  void mark(ClassId cls);

  std::pmr::map<std::pair<ClassId, ClassId>, Entry> pairs_;
  std::pmr::vector<std::uint8_t> taking_part_;  // by class
  std::size_t handlers_ = 0;
  std::uint64_t revision_ = 1;
};

}  // namespace breve
