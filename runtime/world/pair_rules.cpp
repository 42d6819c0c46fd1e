// The tables of pairs that do not collide.
#include "runtime/world/pair_rules.hpp"

#include <tuple>

namespace breve {

PairRules::Key PairRules::key_of(ObjectId a, ObjectId b) {
  const bool in_order = std::tie(a.index, a.generation) <= std::tie(b.index, b.generation);
  return in_order ? Key(a, b) : Key(b, a);
}

bool PairRules::Earlier::operator()(const Key& x, const Key& y) const {
  return std::tie(x.first.index, x.first.generation, x.second.index, x.second.generation) <
         std::tie(y.first.index, y.first.generation, y.second.index, y.second.generation);
}

bool PairRules::exclude(ObjectId a, ObjectId b, bool excluded) {
  const Key key = key_of(a, b);
  if (excluded) return insert(key);
  mirrored_.erase(Key(key.second, key.first));
  return excluded_.erase(key) != 0;
}

bool PairRules::insert(const Key& key) {
  mirrored_.emplace(key.second, key.first);  // first: without its partner it does no harm
  return excluded_.insert(key).second;
}

void PairRules::begin() {
  for (auto& [key, decision] : near_) decision.seen = false;
}

bool PairRules::finish() {
  bool changed = false;
  std::erase_if(near_, [&](const auto& entry) {
    changed = changed || (!entry.second.seen && (entry.second.denied || entry.second.passing));
    return !entry.second.seen;
  });
  return changed;
}

void PairRules::forget(ObjectId object) {
  const auto drop = [object](auto& some, auto& others) {
    auto at = some.lower_bound(Key(object, ObjectId()));
    while (at != some.end() && at->first == object) {
      others.erase(Key(at->second, object));
      at = some.erase(at);
    }
  };
  drop(excluded_, mirrored_);
  drop(mirrored_, excluded_);
  std::erase_if(near_, [&](const auto& entry) { return entry.first.first == object || entry.first.second == object; });
}

void PairRules::save(ByteWriter& out) const {
  out.put(static_cast<std::uint64_t>(excluded_.size()));
  for (const Key& key : excluded_) {
    out.put(key.first);
    out.put(key.second);
  }
  out.put(static_cast<std::uint64_t>(near_.size()));
  for (const auto& [key, decision] : near_) {
    out.put(key.first);
    out.put(key.second);
    for (const bool flag : {decision.asked_first, decision.asked_second, decision.denied, decision.passing})
      out.put(flag);
  }
}

void PairRules::load(ByteReader& in) {
  const auto read_key = [&in] {
    const ObjectId first = in.get_object(), second = in.get_object();
    const Key key = key_of(first, second);
    if (!first || !second || first == second || key.first != first) ByteReader::fail();
    return key;
  };
  for (std::size_t left = in.get_count(4 * sizeof(std::uint32_t)); left > 0; --left)
    if (!insert(read_key())) ByteReader::fail();
  for (std::size_t left = in.get_count(4 * sizeof(std::uint32_t)); left > 0; --left) {
    const auto [at, is_new] = near_.emplace(read_key(), Decision());
    if (!is_new) ByteReader::fail();
    Decision& one = at->second;
    for (bool* flag : {&one.asked_first, &one.asked_second, &one.denied, &one.passing}) *flag = in.get_bool();
  }
}

void PairRules::hash(Hasher& hasher) const {
  const auto add = [&](const Key& key) { hasher.add(std::uint64_t{key.first.index} << 32 | key.second.index); };
  for (const Key& key : excluded_) add(key);
  for (const auto& [key, decision] : near_) {
    add(key);
    hasher.add(static_cast<std::uint64_t>(decision.denied) | static_cast<std::uint64_t>(decision.passing) << 1 |
               static_cast<std::uint64_t>(decision.asked_first) << 2 |
               static_cast<std::uint64_t>(decision.asked_second) << 3);
  }
}

}  // namespace breve
