// The heap of scheduled calls. Time is the key; ties go by the order of scheduling (language, 12.2 and F33).
#include "runtime/world/schedule.hpp"

#include <algorithm>

namespace breve {

void Schedule::push(const Entry& entry) {
  heap_.push_back(entry);
  std::push_heap(heap_.begin(), heap_.end(), Later{stable_});
}

Schedule::Entry Schedule::pop() {
  std::pop_heap(heap_.begin(), heap_.end(), Later{stable_});
  const Entry entry = heap_.back();
  heap_.pop_back();
  return entry;
}

void Schedule::add(ObjectTable& objects, ObjectId target, NameId method, double when, double interval) {
  ObjectTable::Slot& slot = objects.at(target);
  push({when, interval, ++sequences_, target, method});
  ++slot.events;
}

bool Schedule::take_due(ObjectTable& objects, double until, Entry& entry) {
  while (!heap_.empty() && heap_.front().when <= until) {
    entry = pop();
    if (!objects.alive(entry.target)) {
      --dead_;
      continue;
    }
    --objects.at(entry.target).events;
    // Queued before the call, so that the call can unschedule it and an error in the call does not end it. An
    // interval below the resolution of the clock would fire for ever within one pass: it ends instead.
    if (entry.interval > 0 && entry.when + entry.interval > entry.when) {
      add(objects, entry.target, entry.method, entry.when + entry.interval, entry.interval);
    }
    return true;
  }
  return false;
}

std::size_t Schedule::remove(ObjectTable& objects, ObjectId target, NameId method, double when) {
  ObjectTable::Slot& slot = objects.at(target);
  if (slot.events == 0) return 0;
  const auto removed = std::erase_if(heap_, [&](const Entry& entry) {
    return entry.target == target && (method == kNoName || entry.method == method) && (when == 0 || entry.when == when);
  });
  if (removed != 0) std::make_heap(heap_.begin(), heap_.end(), Later{stable_});
  slot.events -= static_cast<std::uint32_t>(removed);
  return removed;
}

void Schedule::forget(ObjectTable& objects, ObjectId target) {
  dead_ += objects.at(target).events;
  if (dead_ * 2 <= heap_.size()) return;
  std::erase_if(heap_, [&](const Entry& entry) { return entry.target == target || !objects.alive(entry.target); });
  std::make_heap(heap_.begin(), heap_.end(), Later{stable_});
  dead_ = 0;
}

void Schedule::set_stable(bool stable) {
  stable_ = stable;
  std::make_heap(heap_.begin(), heap_.end(), Later{stable_});
}

void Schedule::save(ByteWriter& out) const {
  out.put(stable_);
  out.put(sequences_);
  out.put(static_cast<std::uint64_t>(dead_));
  out.put(static_cast<std::uint64_t>(heap_.size()));
  for (const Entry& entry : heap_) {
    out.put(entry.when);
    out.put(entry.interval);
    out.put(entry.sequence);
    out.put(entry.target);
    out.put(entry.method);
  }
}

void Schedule::load(ByteReader& in, std::size_t names) {
  stable_ = in.get_bool();
  sequences_ = in.get<std::uint64_t>();
  dead_ = static_cast<std::size_t>(in.get<std::uint64_t>());
  heap_.resize(in.get_count(sizeof(Entry) - sizeof(NameId)));
  for (Entry& entry : heap_) {
    entry.when = in.get<double>();
    entry.interval = in.get<double>();
    entry.sequence = in.get<std::uint64_t>();
    entry.target = in.get_object();
    entry.method = in.get<NameId>();
    if (entry.method >= names || !(entry.when == entry.when)) ByteReader::fail();
  }
  if (dead_ > heap_.size() || !std::is_heap(heap_.begin(), heap_.end(), Later{stable_})) ByteReader::fail();
}

void Schedule::hash(Hasher& hasher, const NameTable& names, const ObjectTable& objects) const {
  hasher.add(static_cast<std::uint64_t>(heap_.size() - dead_) << 1 | static_cast<std::uint64_t>(stable_));
  for (const Entry& entry : heap_) {
    if (!objects.alive(entry.target)) continue;
    hasher.add(entry.when);
    hasher.add(entry.interval);
    hasher.add(std::uint64_t{entry.target.index} << 32 | entry.target.generation);
    hasher.add(names.text(entry.method));
  }
}

}  // namespace breve
