// The heap of scheduled calls. Time is the key; ties go by the order of scheduling.
#include "runtime/world/schedule.hpp"

#include <algorithm>
#include <limits>

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
  const Entry entry{when, interval, sequences_ + 1, target, method};
  if (indexed_) index_.insert(key(entry));
  try {
    push(entry);
  } catch (...) {
    if (indexed_) index_.erase(key(entry));
    throw;
  }
  ++sequences_;
  ++slot.events;
}

bool Schedule::take_due(ObjectTable& objects, double until, Entry& entry) {
  while (!heap_.empty() && heap_.front().when <= until) {
    entry = pop();
    if (!counts(entry, objects)) {
      --dead_;
      continue;
    }
    if (indexed_) index_.erase(key(entry));
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

namespace {

/// Counts entries of the index that are made or looked for.
class Progress {
 public:
  explicit Progress(const Schedule::Work& work) : work_(work) {}
  void count() {
    if (++entries_ % kPiece == 0) work_(kPiece * kOfEntry);
  }

 private:
  static constexpr std::uint64_t kPiece = 1024, kOfEntry = 6;  // some 300 ns
  const Schedule::Work& work_;
  std::uint64_t entries_ = 0;
};

}  // namespace

std::size_t Schedule::remove(ObjectTable& objects, ObjectId target, NameId method, double when, const Work& work) {
  constexpr std::size_t kFew = 64;  // entries that are looked through without an index
  ObjectTable::Slot& slot = objects.at(target);
  if (slot.events == 0) return 0;
  const auto meant = [&](NameId its_method, double its_time) {
    return (method == kNoName || its_method == method) && (when == 0 || its_time == when);
  };
  std::size_t removed = 0;
  if (!indexed_ && heap_.size() <= kFew) {
    removed = std::erase_if(heap_, [&](const Entry& e) { return e.target == target && meant(e.method, e.when); });
    if (removed != 0) std::make_heap(heap_.begin(), heap_.end(), Later{stable_});
    slot.events -= static_cast<std::uint32_t>(removed);
    return removed;
  }
  if (!indexed_) build_index(objects, work);
  Progress progress(work);
  constexpr double kFirst = -std::numeric_limits<double>::infinity();
  auto at = method == kNoName ? index_.lower_bound({target.index, NameId{0}, kFirst, 0})
                              : index_.lower_bound({target.index, method, when == 0 ? kFirst : when, 0});
  while (at != index_.end() && std::get<0>(*at) == target.index) {
    if (meant(std::get<1>(*at), std::get<2>(*at))) {
      at = index_.erase(at);
      ++removed;
      ++dead_;
      --slot.events;
    } else if (method == kNoName) {
      ++at;
    } else {
      break;  // those of one method and time stand together
    }
    progress.count();
  }
  if (dead_ * 2 > heap_.size()) drop_dead(objects, work);
  return removed;
}

void Schedule::forget(ObjectTable& objects, ObjectId target) {
  ObjectTable::Slot& slot = objects.at(target);
  dead_ += slot.events;
  slot.events = 0;
  if (indexed_) {
    auto at = index_.lower_bound({target.index, NameId{0}, -std::numeric_limits<double>::infinity(), 0});
    while (at != index_.end() && std::get<0>(*at) == target.index) at = index_.erase(at);
  }
  if (dead_ * 2 <= heap_.size()) return;
  std::erase_if(heap_, [&](const Entry& entry) { return entry.target == target || !counts(entry, objects); });
  std::make_heap(heap_.begin(), heap_.end(), Later{stable_});
  dead_ = 0;
}

void Schedule::build_index(const ObjectTable& objects, const Work& work) {
  std::pmr::set<Key> index(index_.get_allocator());
  Progress progress(work);
  for (const Entry& entry : heap_) {
    if (objects.alive(entry.target)) index.insert(key(entry));
    progress.count();
  }
  index_.swap(index);
  indexed_ = true;
}

/// Those that are dead stay where they are if `work` ends this.
void Schedule::drop_dead(const ObjectTable& objects, const Work& work) {
  std::pmr::vector<Entry> kept(heap_.get_allocator());
  kept.reserve(size());
  Progress progress(work);
  for (const Entry& entry : heap_) {
    if (counts(entry, objects)) kept.push_back(entry);
    progress.count();
  }
  heap_.swap(kept);
  std::make_heap(heap_.begin(), heap_.end(), Later{stable_});
  dead_ = 0;
  if (heap_.empty()) indexed_ = false;
}

std::pmr::vector<Schedule::Entry> Schedule::in_order(const ObjectTable& objects) const {
  std::pmr::vector<Entry> entries(heap_.get_allocator());
  entries.reserve(size());
  for (const Entry& entry : heap_)
    if (counts(entry, objects)) entries.push_back(entry);
  const Later later{stable_};
  std::sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) { return later(b, a); });
  return entries;
}

void Schedule::set_stable(bool stable) {
  stable_ = stable;
  std::make_heap(heap_.begin(), heap_.end(), Later{stable_});
}

void Schedule::save(ByteWriter& out, const ObjectTable& objects) const {
  out.put(stable_);
  out.put(sequences_);
  const auto entries = in_order(objects);
  out.put(static_cast<std::uint64_t>(entries.size()));
  for (const Entry& entry : entries) {
    out.put(entry.when);
    out.put(entry.interval);
    out.put(entry.sequence);
    out.put(entry.target);
    out.put(entry.method);
  }
}

void Schedule::load(ByteReader& in, ObjectTable& objects, std::size_t names) {
  stable_ = in.get_bool();
  sequences_ = in.get<std::uint64_t>();
  heap_.resize(in.get_count(sizeof(Entry) - sizeof(NameId)));
  for (Entry& entry : heap_) {
    entry.when = in.get<double>();
    entry.interval = in.get<double>();
    entry.sequence = in.get<std::uint64_t>();
    entry.target = in.get_object();
    entry.method = in.get<NameId>();
    if (entry.method >= names || !(entry.when == entry.when) || entry.sequence > sequences_ ||
        !objects.alive(entry.target))
      ByteReader::fail();
    ++objects.at(entry.target).events;
  }
  const Later later{stable_};
  if (!std::is_sorted(heap_.begin(), heap_.end(), [&](const Entry& a, const Entry& b) { return later(b, a); }))
    ByteReader::fail();
}

void Schedule::hash(Hasher& hasher, const NameTable& names, const ObjectTable& objects) const {
  const auto entries = in_order(objects);
  hasher.add(static_cast<std::uint64_t>(entries.size()) << 1 | static_cast<std::uint64_t>(stable_));
  for (const Entry& entry : entries) {
    hasher.add(entry.when);
    hasher.add(entry.interval);
    hasher.add(std::uint64_t{entry.target.index} << 32 | entry.target.generation);
    hasher.add(names.text(entry.method));
  }
}

}  // namespace breve
