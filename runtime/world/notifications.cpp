// Registrations of observers. Delivery itself is the world's: it works on a copy, so handlers may change the lists.
#include "runtime/world/notifications.hpp"

#include <algorithm>

namespace breve {

namespace {
constexpr std::size_t kShort = 16;  // entries that are faster looked through than looked up
}

void Notifications::List::remove_entries(auto&& which) {
  std::erase_if(entries, which);
  removed = 0;
  if (!indexed) return;
  // A new one: clearing what once was large costs as much as its buckets, each time.
  decltype(index)(index.get_allocator()).swap(index);
  indexed = false;
}

void Notifications::List::build_index() {
  try {
    index.reserve(entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (entries[i].observer)
        index.emplace(key(entries[i].observer, entries[i].message), static_cast<std::uint32_t>(i));
    indexed = true;
  } catch (...) {
    index.clear();
    throw;
  }
}

void Notifications::observe(const ObjectTable& objects, ObjectId announcer, const Registration& registration) {
  auto* memory = by_announcer_.get_allocator().resource();
  auto& list = by_announcer_.try_emplace(announcer.index, memory).first->second;
  if (list.entries.size() >= list.sweep_at) {
    list.remove_entries([&](const Registration& r) { return !objects.alive(r.observer); });
    list.sweep_at = std::max<std::size_t>(16, 2 * list.entries.size());
  }
  list.entries.push_back(registration);
  if (!list.indexed) return;
  try {
    list.index.emplace(key(registration.observer, registration.message),
                       static_cast<std::uint32_t>(list.entries.size() - 1));
  } catch (...) {
    list.entries.pop_back();
    throw;
  }
}

std::size_t Notifications::unobserve(ObjectId observer, ObjectId announcer, NameId message) {
  const auto found = by_announcer_.find(announcer.index);
  if (found == by_announcer_.end()) return 0;
  List& list = found->second;
  const auto matches = [&](const Registration& r) { return r.observer == observer && r.message == message; };
  if (list.entries.size() <= kShort) {
    const std::size_t before = list.entries.size() - list.removed;
    list.remove_entries([&](const Registration& r) { return !r.observer || matches(r); });
    return before - list.entries.size();
  }
  if (!list.indexed) list.build_index();
  std::size_t count = 0;
  const auto [first, last] = list.index.equal_range(key(observer, message));
  for (auto entry = first; entry != last;) {
    Registration& r = list.entries[entry->second];
    if (!matches(r)) {  // of an earlier object in the same slot
      ++entry;
      continue;
    }
    r.observer = {};
    entry = list.index.erase(entry);
    ++count;
  }
  list.removed += count;
  if (2 * list.removed > list.entries.size()) list.remove_entries([](const Registration& r) { return !r.observer; });
  return count;
}

void Notifications::collect(const ObjectTable& objects, ObjectId announcer, NameId message,
                            std::pmr::vector<Registration>& out) const {
  const List* list = find(announcer);
  if (!list) return;
  for (const Registration& r : list->entries) {
    if (r.message == message && objects.alive(r.observer)) out.push_back(r);
  }
}

std::size_t Notifications::bytes() const {
  return by_announcer_.size() * (sizeof(List) + 4 * sizeof(void*)) + by_announcer_.bucket_count() * sizeof(void*);
}

const Notifications::List* Notifications::find(ObjectId announcer) const {
  const auto list = by_announcer_.find(announcer.index);
  return list == by_announcer_.end() ? nullptr : &list->second;
}

void Notifications::save(ByteWriter& out, const ObjectTable& objects) const {
  for (const ObjectId announcer : objects.order()) {
    if (!objects.alive(announcer)) continue;
    const List* list = find(announcer);
    // Those of observers that went are swept out sooner or later: they are not state.
    std::uint64_t count = 0;
    if (list) {
      for (const Registration& r : list->entries) count += objects.alive(r.observer) ? 1 : 0;
    }
    out.put(count);
    if (count == 0) continue;
    for (const Registration& r : list->entries) {
      if (!objects.alive(r.observer)) continue;
      out.put(r.observer);
      out.put(r.message);
      out.put(r.method);
    }
  }
}

void Notifications::load(ByteReader& in, const ObjectTable& objects, std::size_t names) {
  for (const ObjectId announcer : objects.order()) {
    if (!objects.alive(announcer)) continue;
    const std::size_t count = in.get_count(4 * sizeof(std::uint32_t));
    for (std::size_t i = 0; i < count; ++i) {
      Registration r;
      r.observer = in.get_object();
      r.message = in.get<NameId>();
      r.method = in.get<NameId>();
      if (r.message >= names || r.method >= names) ByteReader::fail();
      observe(objects, announcer, r);
    }
  }
}

void Notifications::hash(Hasher& hasher, const NameTable& names, const ObjectTable& objects) const {
  if (by_announcer_.empty()) return;
  for (const ObjectId announcer : objects.order()) {
    const List* list = objects.alive(announcer) ? find(announcer) : nullptr;
    if (!list) continue;
    for (const Registration& r : list->entries) {
      if (!objects.alive(r.observer)) continue;
      hasher.add(std::uint64_t{announcer.index} << 32 | r.observer.index);
      hasher.add(names.text(r.message));
      hasher.add(names.text(r.method));
    }
  }
}

}  // namespace breve
