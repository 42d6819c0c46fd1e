// Hashes: an index of entry numbers with linear probing, over entries in order of insertion. A removed entry stays as
// a marker until the entries are copied.
#include <algorithm>

#include "steve/machine/heap.hpp"
#include "steve/machine/operators.hpp"

namespace breve::steve {

namespace {

constexpr std::uint32_t kLeastIndex = 8;
constexpr std::uint32_t kMostEntries = 0x40000000U;
constexpr std::size_t kOfNewKey = 256;  // bytes: what a key moves until the hash has its size, whatever size that is

/// The entry that holds `key`, or null. Ends because the index is never full.
HashCell::Entry* look_up(const HashCell& hash, const Value& key, std::uint32_t code) {
  if (hash.index == nullptr) return nullptr;
  const std::uint32_t mask = hash.index_capacity - 1;
  for (std::uint32_t i = code & mask; hash.index[i] != 0; i = (i + 1) & mask) {
    HashCell::Entry& entry = hash.entries[hash.index[i] - 1];
    if (entry.hash == code && same_key(entry.key, key)) return &entry;
  }
  return nullptr;
}

void enter_index(HashCell& hash, std::uint32_t entry) {
  const std::uint32_t mask = hash.index_capacity - 1;
  std::uint32_t i = hash.entries[entry].hash & mask;
  while (hash.index[i] != 0) i = (i + 1) & mask;
  hash.index[i] = entry + 1;
}

}  // namespace

const Value* Heap::find(const HashCell& hash, const Value& key) const {
  const HashCell::Entry* entry = look_up(hash, key, key_hash(key));
  return entry != nullptr ? &entry->value : nullptr;
}

// Room for more entries: at the same size if a quarter of them are removed ones, else doubled. The index has at least
// twice as many places as there are entries.
void Heap::regrow(HashCell& hash) {
  if (hash.count_live >= kMostEntries)
    throw RunError(RunErrorKind::Bounds, "a hash cannot have more than 1073741824 keys");
  const bool same = hash.entries != nullptr && hash.count_live <= hash.used - hash.used / 4;
  std::uint32_t index_capacity = hash.index_capacity;
  if (!same) index_capacity = std::max(kLeastIndex, index_capacity * 2);
  const std::uint32_t entry_capacity = index_capacity / 2;
  settle(hash);

  auto* entries = static_cast<HashCell::Entry*>(
      memory_->allocate(entry_capacity * sizeof(HashCell::Entry), alignof(HashCell::Entry)));
  std::uint32_t* index = nullptr;
  try {
    index =
        static_cast<std::uint32_t*>(memory_->allocate(index_capacity * sizeof(std::uint32_t), alignof(std::uint32_t)));
  } catch (...) {
    memory_->deallocate(entries, entry_capacity * sizeof(HashCell::Entry), alignof(HashCell::Entry));
    throw;
  }
  std::memset(index, 0, index_capacity * sizeof(std::uint32_t));
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < hash.used; ++i)
    if (hash.entries[i].live()) new (&entries[count++]) HashCell::Entry(hash.entries[i]);
  free_arrays(hash);
  hash.entries = entries;
  hash.entry_capacity = entry_capacity;
  hash.index = index;
  hash.index_capacity = index_capacity;
  hash.used = hash.count_live = count;
  for (std::uint32_t i = 0; i < count; ++i) enter_index(hash, i);
}

void Heap::set(HashCell& hash, const Value& key, const Value& value) {
  const std::uint32_t code = key_hash(key);
  if (HashCell::Entry* entry = look_up(hash, key, code)) return store(entry->value, value);
  const Value new_key = key, new_value = value;
  if (hash.used == hash.entry_capacity) regrow(hash);
  move_bytes(kOfNewKey);
  retain(new_key);
  retain(new_value);
  new (&hash.entries[hash.used]) HashCell::Entry{new_key, new_value, code};
  enter_index(hash, hash.used);
  ++hash.used;
  ++hash.count_live;
}

bool Heap::remove(HashCell& hash, const Value& key, Value& removed) {
  HashCell::Entry* entry = look_up(hash, key, key_hash(key));
  if (entry == nullptr) return false;
  const HashCell::Entry old = *entry;
  *entry = {Value(), Value(), HashCell::kRemoved};
  --hash.count_live;
  removed = old.value;
  release(old.key);
  release(old.value);
  return true;
}

ListCell* Heap::keys(const HashCell& hash) {
  ListCell* result = list(hash.count_live);
  for (std::uint32_t i = 0; i < hash.used; ++i)
    if (hash.entries[i].live()) push(*result, hash.entries[i].key);
  return result;
}

}  // namespace breve::steve
