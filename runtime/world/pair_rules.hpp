// Which single pairs of objects do not collide: those that were excluded, those for which the answer to a question was
// no, and those of which one passes through the open side of the other.
#pragma once

#include <cstdint>
#include <map>
#include <memory_resource>
#include <set>
#include <utility>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/ids.hpp"

namespace breve {

class PairRules {
 public:
  explicit PairRules(std::pmr::memory_resource* memory) : excluded_(memory), mirrored_(memory), near_(memory) {}

  /// Returns whether that is a change.
  bool exclude(ObjectId a, ObjectId b, bool excluded);
  bool excluded(ObjectId a, ObjectId b) const { return !excluded_.empty() && excluded_.contains(key_of(a, b)); }

  /// The decision about a pair, kept while it is near: at least one of the two chooses which bodies it collides with.
  struct Decision {
    bool asked_first = false, asked_second = false;  // the one with the smaller index, the other
    bool denied = false;                             // neither pushed nor reported
    bool passing = false;                            // not pushed
    bool seen = false;                               // in this sub-step
  };
  Decision& decision(ObjectId a, ObjectId b) { return near_[key_of(a, b)]; }
  static bool is_first(ObjectId one, ObjectId other) { return key_of(one, other).first == one; }
  const Decision* decided(ObjectId a, ObjectId b) const {
    if (near_.empty()) return nullptr;
    const auto at = near_.find(key_of(a, b));
    return at == near_.end() ? nullptr : &at->second;
  }
  /// Before the pairs of a sub-step are looked at, and after: those that were not seen are forgotten. True if one of
  /// them had an effect.
  void begin();
  bool finish();
  void forget(ObjectId object);
  bool any() const { return !excluded_.empty() || !near_.empty(); }
  std::size_t count() const { return excluded_.size() + near_.size(); }

  void save(ByteWriter& out) const;
  void load(ByteReader& in);  // into fresh ones; Error{Image}
  void hash(Hasher& hasher) const;

 private:
  using Key = std::pair<ObjectId, ObjectId>;
  struct Earlier {
    bool operator()(const Key& x, const Key& y) const;
  };
  static Key key_of(ObjectId a, ObjectId b);
  bool insert(const Key& key);  // into the two sets of excluded pairs

  std::pmr::set<Key, Earlier> excluded_;
  std::pmr::set<Key, Earlier> mirrored_;  // the same pairs the other way round, to find those of one object
  std::pmr::map<Key, Decision, Earlier> near_;
};

/// Whom the world asks about pairs beside their objects.
class PairJudge {
 public:
  virtual ~PairJudge() = default;
  /// May the two collide? `a` asked to be asked. May change the world; may throw.
  virtual bool accepts(ObjectId a, ObjectId b) = 0;
};

}  // namespace breve
