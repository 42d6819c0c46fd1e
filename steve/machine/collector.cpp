// The collector of cycles: it marks from what is alive when it begins and takes apart what it did not reach, in slices
// of counted work. What is not in a cycle never needs it. Its state is the order of one table and three boundaries, so
// that a snapshot can keep it exactly.
#include <algorithm>

#include "steve/compile/program.hpp"
#include "steve/machine/heap.hpp"

namespace breve::steve {

namespace {

// Units of work. A slice marks about 60,000 cells, or takes 60,000 apart, or looks at 1e6 places.
constexpr std::int64_t kSlice = 2'000'000;
constexpr std::int64_t kMarkCell = 32;
constexpr std::int64_t kLookAtCell = 2;
constexpr std::int64_t kBreakCell = 32;
constexpr std::int64_t kElement = 1;
constexpr std::int64_t kBegin = 1000;  // so that collections that follow each other end a slice

bool can_close_cycle(const Cell* cell) {
  if (cell == nullptr || !is_container(cell->tag)) return false;
  return cell->tag != Tag::Object || static_cast<const Instance*>(cell)->auto_free;
}
bool can_close_cycle(const Value& v) { return v.is_reference() && can_close_cycle(v.ref); }

}  // namespace

// A cell that was new, or held by frames alone, is now referred to from the heap. If it refers to nothing that could
// lead back to it, it is in no cycle; if a cycle is closed later, its last link is seen here or in note_survivor.
bool Heap::may_close_cycle(const Container& cell) {
  constexpr std::uint32_t kLook = 64;  // a longer one is suspected unseen
  if (cell.tag == Tag::Object) {
    const auto& instance = static_cast<const Instance&>(cell);
    if (!instance.auto_free) return false;
    const auto& slots = instance.cls->reference_slots;
    return std::any_of(slots.begin(), slots.end(),
                       [&instance](std::uint16_t slot) { return can_close_cycle(instance.slots[slot].ref); });
  }
  if (cell.tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(cell);
    return list.size > kLook ||
           std::any_of(list.begin(), list.end(), [](const Value& v) { return can_close_cycle(v); });
  }
  const auto& hash = static_cast<const HashCell&>(cell);
  return hash.used > kLook || std::any_of(hash.entries, hash.entries + hash.used, [](const HashCell::Entry& entry) {
           return can_close_cycle(entry.key) || can_close_cycle(entry.value);
         });
}

// --- regions ---------------------------------------------------------------------------------------------------------

std::size_t Heap::region(const Container& cell) const {
  return static_cast<std::size_t>(
      std::count_if(ends_.begin(), ends_.end(), [&cell](std::uint32_t end) { return end <= cell.place; }));
}

void Heap::swap_places(std::uint32_t a, std::uint32_t b) {
  std::swap(containers_[a], containers_[b]);
  containers_[a]->place = a;
  containers_[b]->place = b;
}

// Into a region further to the front.
void Heap::promote(Container& cell, std::size_t target) {
  for (std::size_t r = region(cell); r > target; --r) swap_places(cell.place, ends_[r - 1]++);
}

void Heap::enrol(Container& cell) {
  cell.place = static_cast<std::uint32_t>(containers_.size());
  containers_.push_back(&cell);
  if (phase_ != Phase::Idle) promote(cell, 0);
}

void Heap::strike(Container& cell) {
  if (partial_ == &cell) partial_ = nullptr;
  for (std::size_t r = region(cell); r < ends_.size(); ++r) swap_places(cell.place, --ends_[r]);
  Container* last = containers_.back();
  last->place = cell.place;
  containers_[cell.place] = last;
  containers_.pop_back();
}

void Heap::shade(Cell* cell) {
  if (cell == nullptr || !is_container(cell->tag)) return;
  auto& container = static_cast<Container&>(*cell);
  if (container.place >= ends_[1]) promote(container, 1);
}

// --- phases ----------------------------------------------------------------------------------------------------------

void Heap::end_of_iteration() {
  reclaim_all();
  if (held_by_frames_) suspicion_ = true;
  held_by_frames_ = false;
  std::int64_t work = kSlice;
  while (work > 0 && (phase_ != Phase::Idle || suspicion_)) {
    switch (phase_) {
      case Phase::Idle:
        work -= kBegin;
        begin_collection();
        break;
      case Phase::Mark: mark(work); break;
      case Phase::Examine: examine(work); break;
      case Phase::Sweep: sweep(work); break;
    }
    if (phase_ == Phase::Idle) reclaim_all();
  }
  if (!zero_.empty()) reclaim_all();
}

void Heap::begin_collection() {
  suspicion_ = false;
  phase_ = Phase::Mark;
  ends_ = {0, 0, 0};
  const auto reach = [this](Cell* cell) { shade(cell); };
  roots_.visit_roots(reach);
  // What a frame holds now may be left in a cycle when the frame ends: a later iteration has to look again.
  roots_.visit_frames([this](Cell* cell) {
    shade(cell);
    if (can_close_cycle(cell) && cell->count > 0) held_by_frames_ = true;
  });
  for (const Doomed& doomed : doomed_) shade(doomed.instance);
}

void Heap::end_collection() {
  phase_ = Phase::Idle;
  ends_ = {0, 0, 0};
}

void Heap::mark(std::int64_t& work) {
  while (work > 0) {
    if (partial_ != nullptr) {
      scan_part(work);
    } else if (ends_[0] < ends_[1]) {
      Container& cell = *containers_[ends_[0]++];
      scan(cell, work);
    } else if (ends_[2] < containers_.size()) {
      work -= kLookAtCell;
      Container& cell = *containers_[ends_[2]];
      const auto& instance = static_cast<const Instance&>(cell);
      const bool root = cell.tag == Tag::Object && instance.live() &&
                        (!instance.auto_free || instance.state == Instance::State::BeingFreed);
      promote(cell, root ? 1 : 2);
    } else {
      phase_ = Phase::Examine;
      ends_[2] = ends_[1];
      return;
    }
  }
}

void Heap::scan(Container& cell, std::int64_t& work) {
  work -= kMarkCell;
  if (cell.tag == Tag::Object) {
    auto& instance = static_cast<Instance&>(cell);
    for (const std::uint16_t slot : instance.cls->reference_slots) shade(instance.slots[slot].ref);
    work -= kElement * static_cast<std::int64_t>(instance.cls->reference_slots.size());
    return;
  }
  partial_ = &cell;
  position_ = cell.tag == Tag::List ? static_cast<ListCell&>(cell).first : 0;
  scan_part(work);
}

// Positions count from the start of the store, so that adding and removing at either end does not shift them. What is
// removed unseen is shaded by `release`.
void Heap::scan_part(std::int64_t& work) {
  const auto most = static_cast<std::uint32_t>(std::max<std::int64_t>(work, 1));
  if (partial_->tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(*partial_);
    const std::uint32_t from = std::max(position_, list.first);
    const std::uint32_t end = list.first + list.size;
    const std::uint32_t to = from >= end ? end : from + std::min(most, end - from);
    for (std::uint32_t i = from; i < to; ++i) shade(list.store[i]);
    if (to > from) work -= kElement * (to - from);
    position_ = to;
    if (to == end) partial_ = nullptr;
    return;
  }
  const auto& hash = static_cast<const HashCell&>(*partial_);
  const std::uint32_t from = std::min(position_, hash.used);
  const std::uint32_t to = from + std::min(most, hash.used - from);
  for (std::uint32_t i = from; i < to; ++i) {
    shade(hash.entries[i].key);
    shade(hash.entries[i].value);
  }
  work -= kElement * (to - from);
  position_ = to;
  if (to == hash.used) partial_ = nullptr;
}

void Heap::finish_partial() {
  std::int64_t work = INT32_MAX;
  while (partial_ != nullptr) scan_part(work);
}

// Garbage is known. Auto-free instances in it must run destroy, which may bring anything of it back to life: then
// nothing is taken apart now, and the next collection begins at once.
void Heap::examine(std::int64_t& work) {
  while (work > 0 && ends_[2] < containers_.size()) {
    work -= kLookAtCell;
    Container& cell = *containers_[ends_[2]];
    const auto& instance = static_cast<const Instance&>(cell);
    const bool doomed = cell.tag == Tag::Object && instance.auto_free && instance.state == Instance::State::Live;
    promote(cell, doomed ? 1 : 2);
  }
  if (ends_[2] < containers_.size()) return;
  if (ends_[0] == ends_[1]) {
    phase_ = Phase::Sweep;
  } else {
    doom_unreachable();
  }
}

void Heap::doom_unreachable() {
  const std::size_t old = doomed_.size();
  try {
    doomed_.reserve(old + (ends_[1] - ends_[0]));
    for (std::uint32_t i = ends_[0]; i < ends_[1]; ++i)
      doomed_.push_back({static_cast<Instance*>(containers_[i]), true});
  } catch (const std::bad_alloc&) {
    // No memory to remember them now: they are found again by the collection that follows.
  }
  for (std::size_t i = old; i < doomed_.size(); ++i) retain(doomed_[i].instance);
  std::sort(doomed_.begin() + static_cast<std::ptrdiff_t>(old), doomed_.end(),
            [](const Doomed& a, const Doomed& b) { return a.instance->serial < b.instance->serial; });
  end_collection();
  suspicion_ = true;
}

// Taking a cell apart releases what it refers to. When every cell of the garbage has lost its references, every count
// in it is 0, and the cells are freed like any others.
void Heap::sweep(std::int64_t& work) {
  const bool suspicion = suspicion_;
  while (work > 0 && ends_[0] < containers_.size()) {
    Container& cell = *containers_.back();
    promote(cell, 0);
    work -= kBreakCell;
    if (cell.tag == Tag::List) work -= kElement * static_cast<ListCell&>(cell).size;
    if (cell.tag == Tag::Hash) work -= kElement * static_cast<HashCell&>(cell).used;
    release_children(cell);
  }
  suspicion_ = suspicion;  // the counts that garbage lowers close no cycle
  if (ends_[0] == containers_.size()) end_collection();
}

}  // namespace breve::steve
