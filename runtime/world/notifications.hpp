// Observers and the announcements that they registered for. Registrations hang on their announcer, in order of
// registration.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <unordered_map>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/ids.hpp"
#include "runtime/world/name_table.hpp"
#include "runtime/world/objects.hpp"

namespace breve {

class Notifications {
 public:
  struct Registration {
    ObjectId observer;
    NameId message = kNoName;
    NameId method = kNoName;
  };

  explicit Notifications(std::pmr::memory_resource* memory) : by_announcer_(memory) {}

  void observe(const ObjectTable& objects, ObjectId announcer, const Registration& registration);
  /// Remove every matching registration. Returns how many. O(1) each, amortised. @throws std::bad_alloc, unchanged
  std::size_t unobserve(ObjectId observer, ObjectId announcer, NameId message);
  /// Those who want this message now, in order of registration, appended to `out`.
  void collect(const ObjectTable& objects, ObjectId announcer, NameId message,
               std::pmr::vector<Registration>& out) const;
  /// An announcer is going. (Observers that went are skipped, and swept out as lists grow.)
  void forget(ObjectId announcer) { by_announcer_.erase(announcer.index); }
  std::size_t bytes() const;

  void save(ByteWriter& out, const ObjectTable& objects) const;
  void load(ByteReader& in, const ObjectTable& objects, std::size_t names);
  void hash(Hasher& hasher, const NameTable& names, const ObjectTable& objects) const;

 private:
  /// In order. A removed registration stays as an entry without an observer until there are many: the places stay the
  /// same.
  struct List {
    explicit List(std::pmr::memory_resource* memory) : entries(memory), index(memory) {}
    void remove_entries(auto&& which);
    void build_index();

    std::pmr::vector<Registration> entries;
    // Observer's slot and message to places in `entries`, found by key only. A short list has none.
    std::pmr::unordered_multimap<std::uint64_t, std::uint32_t> index;
    bool indexed = false;
    std::size_t removed = 0;
    std::size_t sweep_at = 16;  // length at which entries of observers that went are swept out
  };
  static std::uint64_t key(ObjectId observer, NameId message) {
    return std::uint64_t{observer.index} << 32 | static_cast<std::uint32_t>(message);
  }
  const List* find(ObjectId announcer) const;

  // By the announcer's slot; found by key, walked only through the order of objects.
  std::pmr::unordered_map<std::uint32_t, List> by_announcer_;
};

}  // namespace breve
