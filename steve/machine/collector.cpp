// The collector of cycles: it marks from what is alive when it begins and takes apart what it did not reach, in slices
// of counted work. What is not in a cycle never needs it. Its state is the table of containers with a mark for each
// place and a queue of places, so that a snapshot can keep it exactly.
#include <algorithm>

#include "steve/compile/program.hpp"
#include "steve/machine/heap.hpp"

namespace breve::steve {

namespace {

// Units of work, about a nanosecond each. See docs/performance.md for what a slice takes; docs/limits.md promises in
// how many slices a cycle is gone: a cell costs at most kLook + kMark + 2 kPlace and its references.
constexpr std::int64_t kSlice = 2'000'000;
constexpr std::int64_t kLook = 4;        // is a place a root?
constexpr std::int64_t kMark = 20;       // scan a cell
constexpr std::int64_t kReference = 16;  // reach a cell from another
constexpr std::int64_t kElement = 1;     // look at an element of a list or hash
constexpr std::int64_t kPlace = 1;       // look at the mark of a place
constexpr std::int64_t kBreak = 40;      // release a reference of garbage, or a cell of it
constexpr std::int64_t kBegin = 1000;    // so that collections that follow each other end a slice

// How many cells to fetch ahead of their turn.
constexpr std::uint32_t kAhead = 24;
constexpr std::uint32_t kNear = 4;

void fetch(const void* memory) { __builtin_prefetch(memory); }

bool can_close_cycle(const Cell* cell) {
  if (cell == nullptr || !is_container(cell->tag)) return false;
  return cell->tag != Tag::Object || static_cast<const Instance*>(cell)->auto_free;
}
bool can_close_cycle(const Value& v) { return v.is_reference() && can_close_cycle(v.ref); }

bool is_root(const Container& cell) {
  if (cell.tag != Tag::Object) return false;
  const auto& instance = static_cast<const Instance&>(cell);
  return instance.live() && (!instance.auto_free || instance.state == Instance::State::BeingFreed);
}

bool can_be_doomed(const Container& cell) {
  if (cell.tag != Tag::Object) return false;
  const auto& instance = static_cast<const Instance&>(cell);
  return instance.auto_free && instance.state == Instance::State::Live;
}

}  // namespace

/// References on their way to `shade`: each waits until the cells behind it are on their way from memory.
class Heap::Reach {
 public:
  explicit Reach(Heap& heap) : heap_(heap) {}
  void operator()(Cell* cell) {
    if (cell == nullptr) return;
    fetch(cell);
    const std::uint32_t turn = next_++ % kRoom;
    Cell* arrived = waiting_[turn];
    waiting_[turn] = cell;
    if (arrived == nullptr || !is_container(arrived->tag)) return;
    const std::uint32_t place = static_cast<Container*>(arrived)->place;
    fetch(&heap_.marks_[place]);
    const std::uint32_t marked = next_mark_++ % kMarks;
    if (marks_[marked] != kNoPlace) heap_.shade_place(marks_[marked]);
    marks_[marked] = place;
  }
  void operator()(const Value& v) {
    if (is_container(v.tag)) (*this)(v.ref);
  }
  void flush() {
    for (std::uint32_t i = 0; i < kMarks; ++i, ++next_mark_) {
      std::uint32_t& place = marks_[next_mark_ % kMarks];
      if (place != kNoPlace) heap_.shade_place(place);
      place = kNoPlace;
    }
    for (std::uint32_t i = 0; i < kRoom; ++i, ++next_) {
      Cell*& cell = waiting_[next_ % kRoom];
      heap_.shade(cell);
      cell = nullptr;
    }
  }

 private:
  static constexpr std::uint32_t kRoom = 16, kMarks = 8;
  Heap& heap_;
  std::uint32_t next_ = 0, next_mark_ = 0;
  std::array<Cell*, kRoom> waiting_{};             // cells whose heads are on their way
  std::array<std::uint32_t, kMarks> marks_ = [] {  // places whose marks are on their way
    std::array<std::uint32_t, kMarks> none;
    none.fill(kNoPlace);
    return none;
  }();
};

// A cell that was new, or held by frames alone, is now referred to from the heap. If it refers to nothing that could
// lead back to it, it is in no cycle; if a cycle is closed later, its last link is seen here or in note_survivor.
bool Heap::may_close_cycle(const Container& cell) {
  constexpr std::uint32_t kMost = 64;  // a longer one is suspected unseen
  if (cell.tag == Tag::Object) {
    const auto& instance = static_cast<const Instance&>(cell);
    if (!instance.auto_free) return false;
    const auto& slots = instance.cls->reference_slots;
    return std::any_of(slots.begin(), slots.end(),
                       [&instance](std::uint16_t slot) { return can_close_cycle(instance.slots[slot].ref); });
  }
  if (cell.tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(cell);
    return list.size > kMost ||
           std::any_of(list.begin(), list.end(), [](const Value& v) { return can_close_cycle(v); });
  }
  const auto& hash = static_cast<const HashCell&>(cell);
  return hash.used > kMost || std::any_of(hash.entries, hash.entries + hash.used, [](const HashCell::Entry& entry) {
           return can_close_cycle(entry.key) || can_close_cycle(entry.value);
         });
}

// --- the table -------------------------------------------------------------------------------------------------------

void Heap::enrol(Container& cell) {
  cell.place = static_cast<std::uint32_t>(containers_.size());
  containers_.push_back(&cell);
  marks_.push_back(phase_ == Phase::Idle ? white(cell) : black(cell));
}

void Heap::move_place(std::uint32_t from, std::uint32_t to) {
  if (from == to) return;
  containers_[to] = containers_[from];
  containers_[to]->place = to;
  marks_[to] = marks_[from];
  if (marks_[to] >= kGrey) grey_[marks_[to] - kGrey] = to;
}

// The last cell takes the place, by way of the boundary, so that what was passed stays passed.
void Heap::strike(Container& cell) {
  if (partial_ == &cell) partial_ = nullptr;
  std::uint32_t place = cell.place;
  if (marks_[place] >= kGrey) grey_[marks_[place] - kGrey] = kNoPlace;
  if (place < passed_) {
    move_place(--passed_, place);
    place = passed_;
  }
  move_place(static_cast<std::uint32_t>(containers_.size() - 1), place);
  containers_.pop_back();
  marks_.pop_back();
}

void Heap::shade(Cell* cell) {
  if (cell == nullptr || !is_container(cell->tag)) return;
  shade_place(static_cast<Container*>(cell)->place);
}

void Heap::shade_place(std::uint32_t place) {
  if (marks_[place] >= kBlack) return;
  marks_[place] = kGrey + static_cast<std::uint32_t>(grey_.size());
  grey_.push_back(place);  // never grows: each place is white once in a collection
}

// --- phases ----------------------------------------------------------------------------------------------------------

void Heap::end_of_iteration() {
  short_of_memory_ = false;
  reclaim_all();
  if (held_by_frames_) suspicion_ = true;
  held_by_frames_ = false;
  judge_suspects();
  std::int64_t work = kSlice;
  while (work > 0 && (phase_ != Phase::Idle || suspicion_)) {
    const Phase before = phase_;
    switch (phase_) {
      case Phase::Idle:
        work -= kBegin;
        begin_collection();
        break;
      case Phase::Mark:
      case Phase::Remark: mark(work); break;
      case Phase::Examine: examine(work); break;
      case Phase::Sweep: sweep(work); break;
    }
    if (phase_ != before && phase_ == Phase::Idle) reclaim_all();
  }
  free_dying();
  if (!zero_.empty()) reclaim_all();
  if (short_of_memory_) throw std::bad_alloc();
}

void Heap::begin_collection() {
  suspicion_ = false;
  phase_ = Phase::Mark;
  barrier_ = true;
  passed_ = 0;
  grey_.clear();
  next_grey_ = 0;
  const auto reach = [this](Cell* cell) { shade(cell); };
  roots_.visit_roots(reach);
  // What a frame holds now may be left in a cycle when the frame ends: a later iteration has to look again.
  roots_.visit_frames([this](Cell* cell) {
    shade(cell);
    if (can_close_cycle(cell) && cell->count > 0) held_by_frames_ = true;
  });
  for (Instance* doomed : doomed_) shade(doomed);
  for (Instance* dying : dying_) shade(dying);
}

// Roots are looked for as long as few cells wait, so that there is always something to fetch ahead.
void Heap::mark(std::int64_t& work) {
  Reach reach(*this);
  while (work > 0) {
    if (partial_ != nullptr) {
      scan_part(reach, work);
      continue;
    }
    for (; grey_.size() - next_grey_ < kAhead && passed_ < containers_.size() && work > 0; ++passed_) {
      const std::uint32_t ahead = passed_ + kAhead;
      if (ahead < containers_.size() && marks_[ahead] == kWhite) fetch(containers_[ahead]);
      work -= kPlace;
      if (marks_[passed_] != kWhite) continue;
      work -= kLook;
      if (is_root(*containers_[passed_])) shade_place(passed_);
    }
    if (next_grey_ == grey_.size()) {
      reach.flush();
      if (next_grey_ != grey_.size() || passed_ < containers_.size()) continue;
      return end_of_marking();
    }
    fetch_ahead();
    const std::uint32_t place = grey_[next_grey_++];
    if (place == kNoPlace) continue;
    Container& cell = *containers_[place];
    marks_[place] = black(cell);
    scan(cell, reach, work);
  }
  reach.flush();
}

// First the cell, then, when its head has arrived, its elements.
void Heap::fetch_ahead() const {
  if (next_grey_ + kAhead / 2 < grey_.size() && grey_[next_grey_ + kAhead / 2] != kNoPlace) {
    const auto* far = reinterpret_cast<const char*>(containers_[grey_[next_grey_ + kAhead / 2]]);
    fetch(far);
    fetch(far + 64);
  }
  if (next_grey_ + kNear >= grey_.size() || grey_[next_grey_ + kNear] == kNoPlace) return;
  const Container& near = *containers_[grey_[next_grey_ + kNear]];
  if (near.tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(near);
    fetch(reinterpret_cast<const char*>(list.store) + list.first * list.element_bytes());
  }
  if (near.tag == Tag::Hash) fetch(static_cast<const HashCell&>(near).entries);
}

void Heap::end_of_marking() {
  passed_ = 0;
  phase_ = phase_ == Phase::Mark ? Phase::Examine : Phase::Sweep;
  if (phase_ == Phase::Sweep) barrier_ = false;
}

void Heap::scan(Container& cell, Reach& reach, std::int64_t& work) {
  work -= kMark;
  if (cell.tag == Tag::Object) {
    auto& instance = static_cast<Instance&>(cell);
    for (const std::uint16_t slot : instance.cls->reference_slots) {
      work -= instance.slots[slot].ref != nullptr ? kReference : kElement;
      reach(instance.slots[slot].ref);
    }
    return;
  }
  partial_ = &cell;
  position_ = cell.tag == Tag::List ? static_cast<ListCell&>(cell).first : 0;
  scan_part(reach, work);
}

// Positions count from the start of the store, so that adding and removing at either end does not shift them. What is
// removed unseen is shaded by `release`.
void Heap::scan_part(Reach& reach, std::int64_t& work) {
  constexpr std::int64_t kPiece = 1024;  // elements, so that what they refer to is counted in time
  const auto most = static_cast<std::uint32_t>(std::clamp<std::int64_t>(work, 1, kPiece));
  std::uint32_t references = 0, count = 0;
  if (partial_->tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(*partial_);
    const std::uint32_t from = std::max(position_, list.first);
    const std::uint32_t end = list.first + list.size;
    const std::uint32_t to = from >= end ? end : from + std::min(most, end - from);
    for (std::uint32_t i = from; i < to; ++i) {
      if (!list.narrow()) {
        references += is_container(list.values()[i].tag) ? 1U : 0U;
        reach(list.values()[i]);
      } else if (is_container(list.kind)) {
        ++references;
        reach(list.store[i].ref);
      }
    }
    count = to > from ? to - from : 0;
    position_ = to;
    if (to == end) partial_ = nullptr;
  } else {
    const auto& hash = static_cast<const HashCell&>(*partial_);
    // Removed entries are not counted: a restored hash has none.
    for (; position_ < hash.used && count < most; ++position_) {
      const HashCell::Entry& entry = hash.entries[position_];
      if (!entry.live()) continue;
      references += (is_container(entry.key.tag) ? 1U : 0U) + (is_container(entry.value.tag) ? 1U : 0U);
      reach(entry.key);
      reach(entry.value);
      ++count;
    }
    if (position_ >= hash.used) partial_ = nullptr;
  }
  work -= kElement * count + kReference * references;
}

void Heap::finish_partial() {
  Reach reach(*this);
  std::int64_t work = INT64_MAX;
  while (partial_ != nullptr) scan_part(reach, work);
  reach.flush();
}

// Garbage is known. Auto-free instances in it must run destroy, which may bring anything of it back to life: whatever
// they refer to is kept this time (Remark), the rest goes.
void Heap::examine(std::int64_t& work) {
  for (; work > 0 && passed_ < containers_.size(); ++passed_) {
    work -= kPlace;
    if (marks_[passed_] != kWhite) continue;
    work -= kLook;
    Container& cell = *containers_[passed_];
    if (!can_be_doomed(cell)) continue;
    try {
      condemned_.push_back(static_cast<Instance*>(&cell));
      retain(&cell);
    } catch (const std::bad_alloc&) {  // it is found again by the collection that follows
      short_of_memory_ = true;
    }
    work -= kBreak;
    shade(&cell);
  }
  if (passed_ < containers_.size()) return;
  if (!condemned_.empty() || short_of_memory_) suspicion_ = true;
  doom_condemned();
  phase_ = Phase::Remark;
}

// In order of creation, together with what is left of earlier ones. They go in so many iterations as leave the promise.
void Heap::doom_condemned() {
  constexpr std::uint64_t kCells = 60'000;  // of the heap, for each iteration that may pass until all are destroyed
  if (dying_.empty()) dying_.swap(condemned_);
  try {
    dying_.insert(dying_.end(), condemned_.begin(), condemned_.end());
    condemned_.clear();
  } catch (const std::bad_alloc&) {  // they are found again by the collection that follows
    short_of_memory_ = true;
    for (Instance* instance : condemned_) release(instance);
    condemned_.clear();
  }
  std::sort(dying_.begin(), dying_.end(), [](const Instance* a, const Instance* b) { return a->serial > b->serial; });
  const std::uint64_t iterations = cells_ / kCells + 1;
  share_ = (dying_.size() + iterations - 1) / iterations;
}

// Taking a cell apart releases what it refers to. When every cell of the garbage has lost its references, every count
// in it is 0, and the cells are freed like any others.
void Heap::sweep(std::int64_t& work) {
  const bool suspicion = suspicion_;
  while (work > 0 && passed_ < containers_.size()) {
    if (partial_ != nullptr) {  // others may have taken its place
      take_apart(*partial_, work);
      continue;
    }
    work -= kPlace;
    if (marks_[passed_] >= kBlack)
      marks_[passed_] -= kBlack - kWhite;
    else if (!take_apart(*containers_[passed_], work))
      break;
    ++passed_;
  }
  suspicion_ = suspicion;  // the counts that garbage lowers close no cycle
  if (passed_ < containers_.size()) return;
  phase_ = Phase::Idle;
  passed_ = 0;
}

// A list or hash goes piece by piece; meanwhile it is held, so that it does not go as a whole by having lost its last
// reference, perhaps to itself. False if the work was used up first.
bool Heap::take_apart(Container& cell, std::int64_t& work) {
  if (partial_ == nullptr) work -= kBreak;
  if (cell.tag == Tag::Object) {
    work -= kBreak * static_cast<std::int64_t>(static_cast<Instance&>(cell).cls->reference_slots.size());
    clear_slots(static_cast<Instance&>(cell));
    return true;
  }
  if (partial_ == nullptr) {
    partial_ = &cell;
    retain(&cell);
  }
  const bool empty =
      cell.tag == Tag::List ? shed(static_cast<ListCell&>(cell), work) : shed(static_cast<HashCell&>(cell), work);
  if (!empty) return false;
  partial_ = nullptr;
  release(&cell);
  return true;
}

bool Heap::shed(ListCell& list, std::int64_t& work) {
  for (; list.size > 0 && work > 0; work -= kElement) {
    const Value last = list[--list.size];
    if (last.is_reference()) work -= kBreak;
    release(last);
  }
  return list.size == 0;
}

bool Heap::shed(HashCell& hash, std::int64_t& work) {
  while (hash.used > 0 && work > 0) {
    const HashCell::Entry last = hash.entries[--hash.used];
    if (!last.live()) continue;
    --hash.count_live;
    work -= 2 * kBreak;
    release(last.key);
    release(last.value);
  }
  if (hash.used != 0) return false;
  if (hash.index != nullptr) std::memset(hash.index, 0, hash.index_capacity * sizeof(std::uint32_t));
  return true;
}

}  // namespace breve::steve
