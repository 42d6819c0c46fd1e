// Calls that wait for their time: a binary heap, so that a million of them cost n log n; and, once one of many is
// cancelled, an index by target and method, so that cancelling a million of them also costs n log n.
#pragma once

#include <cstdint>
#include <functional>
#include <memory_resource>
#include <set>
#include <tuple>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/ids.hpp"
#include "runtime/world/name_table.hpp"
#include "runtime/world/objects.hpp"

namespace breve {

class Schedule {
 public:
  struct Entry {
    double when = 0;
    double interval = 0;         // > 0: again and again
    std::uint64_t sequence = 0;  // order of scheduling
    ObjectId target;
    NameId method = kNoName;
  };

  explicit Schedule(std::pmr::memory_resource* memory) : heap_(memory), index_(memory) {}

  void add(ObjectTable& objects, ObjectId target, NameId method, double when, double interval);
  /// The next entry due at `until` whose target lives, taken out; a repeating one is queued again at once.
  /// @return false if none is due
  bool take_due(ObjectTable& objects, double until, Entry& entry);
  /// Hears of work that has been done, in units of about a loop iteration; it may throw to end the rest.
  using Work = std::function<void(std::uint64_t units)>;
  /// Remove entries of a target: those of `method` (kNoName: any) at `when` (0: any). Returns how many. If `work` ends
  /// it, some of them are removed.
  std::size_t remove(ObjectTable& objects, ObjectId target, NameId method, double when, const Work& work);
  /// A target with waiting entries is going: they are dropped when met, or together once they are the majority.
  void forget(ObjectTable& objects, ObjectId target);

  /// Among equal times: false (default) the last scheduled goes first, as programs observed; true the first.
  void set_stable(bool stable);
  bool stable() const { return stable_; }
  std::size_t size() const { return heap_.size() - dead_; }
  std::size_t bytes() const {
    return heap_.capacity() * sizeof(Entry) + index_.size() * (sizeof(Key) + 4 * sizeof(void*));
  }

  void save(ByteWriter& out, const ObjectTable& objects) const;
  void load(ByteReader& in, ObjectTable& objects, std::size_t names);
  void hash(Hasher& hasher, const NameTable& names, const ObjectTable& objects) const;

 private:
  struct Later {
    bool stable;
    bool operator()(const Entry& a, const Entry& b) const {
      if (a.when != b.when) return a.when > b.when;
      return stable ? a.sequence > b.sequence : a.sequence < b.sequence;
    }
  };
  /// Target, method, time, sequence: those of one method of one target stand together.
  using Key = std::tuple<std::uint32_t, NameId, double, std::uint64_t>;
  static Key key(const Entry& e) { return {e.target.index, e.method, e.when, e.sequence}; }

  void push(const Entry& entry);
  Entry pop();
  void build_index(const ObjectTable& objects, const Work& work);
  bool counts(const Entry& entry, const ObjectTable& objects) const {
    return objects.alive(entry.target) && (!indexed_ || index_.count(key(entry)) != 0);
  }
  void drop_dead(const ObjectTable& objects, const Work& work);
  /// What counts, in the order in which it comes due: the same however the heap came about.
  std::pmr::vector<Entry> in_order(const ObjectTable& objects) const;

  std::pmr::vector<Entry> heap_;
  std::pmr::set<Key> index_;  // of what counts, if indexed_
  std::uint64_t sequences_ = 0;
  std::size_t dead_ = 0;  // entries that were cancelled, or whose target is gone
  bool indexed_ = false;
  bool stable_ = false;
};

}  // namespace breve
