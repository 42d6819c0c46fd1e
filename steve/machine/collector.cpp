// The collector of the whole heap, for cycles that suspects.cpp leaves: it marks from what is alive when it begins and
// takes apart what it did not reach, in slices of counted work. What is in no cycle never needs it. Its state is the
// table of containers with a mark for each place and a queue of places, so that a snapshot can keep it exactly.
//
// Instances without auto-free are alive by themselves and have their turn in the order of the table, which is nearly
// that of memory; all else is scanned in the order in which it was reached.
#include <algorithm>

#include "steve/compile/program.hpp"
#include "steve/machine/heap.hpp"

namespace breve::steve {

namespace {

// Units of work. See docs/performance.md for what a slice takes. docs/limits.md promises in how many slices a cycle is
// gone, by the number of cells: two collections, each of at most kLook + kMark + 3 * kPlace + r units for a cell with r
// references, so that a slice is 40,000 cells with up to six references on the average.
constexpr std::int64_t kSlice = 2'120'000;
constexpr std::int64_t kLook = 4;      // is a place a root?
constexpr std::int64_t kMark = 40;     // reach and scan a cell: memory is waited for, whatever stands there
constexpr std::int64_t kElement = 1;   // look at a reference, or an element of a list or hash
constexpr std::int64_t kPlace = 1;     // look at the mark of a place
constexpr std::int64_t kBreak = 18;    // release a reference of garbage, or a cell of it
constexpr std::int64_t kBegin = 1000;  // so that collections that follow each other end a slice

// How far may_close_cycle looks; what leads further is suspected unseen.
constexpr int kLooks = 64;  // references and elements
constexpr int kLevels = 3;  // below the first

// How many cells to fetch ahead of their turn.
constexpr std::uint32_t kAhead = 24;
constexpr std::uint32_t kNear = 4;

void fetch(const void* memory) { __builtin_prefetch(memory); }

bool can_close_cycle(const Cell* cell) {
  if (cell == nullptr || !is_container(cell->tag)) return false;
  return cell->tag != Tag::Object || static_cast<const Instance*>(cell)->auto_free;
}

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
    if (needs_mark(arrived)) wait_for_mark(*static_cast<Container*>(arrived));
  }
  void operator()(const Value& v) {
    if (is_container(v.tag)) (*this)(v.ref);
  }
  void flush() {
    for (std::uint32_t i = 0; i < kRoom; ++i, ++next_) {
      Cell*& cell = waiting_[next_ % kRoom];
      if (needs_mark(cell)) wait_for_mark(*static_cast<Container*>(cell));
      cell = nullptr;
    }
    for (std::uint32_t i = 0; i < kMarks; ++i, ++next_mark_) settle(marks_[next_mark_ % kMarks]);
  }

 private:
  static constexpr std::uint32_t kRoom = 16, kMarks = 8;
  struct Mark {
    std::uint32_t place = kNoPlace;
    bool leaf = false;
  };

  // Roots have their turn in the order of the table, which is nearly that of memory; one that ceases to be a root is
  // shaded by the release of the table of objects.
  static bool needs_mark(const Cell* cell) {
    return cell != nullptr && is_container(cell->tag) && !is_root(*static_cast<const Container*>(cell));
  }
  static bool is_leaf(const Container& cell) {
    if (cell.tag != Tag::List) return false;
    const auto& list = static_cast<const ListCell&>(cell);
    return list.size == 0 || (list.narrow() && !is_container(list.kind));
  }
  void wait_for_mark(const Container& cell) {
    fetch(&heap_.marks_[cell.place]);
    Mark& mark = marks_[next_mark_++ % kMarks];
    settle(mark);
    mark = {cell.place, is_leaf(cell)};
  }
  void settle(Mark& mark) {
    if (mark.place == kNoPlace) return;
    if (!mark.leaf)
      heap_.shade_place(mark.place);
    else if (heap_.marks_[mark.place] < kBlack)
      heap_.marks_[mark.place] = kBlackOther;
    mark.place = kNoPlace;
  }

  Heap& heap_;
  std::uint32_t next_ = 0, next_mark_ = 0;
  std::array<Cell*, kRoom> waiting_{};  // cells whose heads are on their way
  std::array<Mark, kMarks> marks_;      // places whose marks are on their way
};

// A cell that was new, or held by frames alone, is now referred to from the heap. If nothing that it refers to leads
// back to it, it is in no cycle; if a cycle is closed later, its last link is seen here or in note_survivor. Most new
// cells are small trees of lists: they are known by a short look while they are still in the cache.
bool Heap::may_close_cycle(const Container& cell) {
  int looks = kLooks;
  return leads_on(cell, kLevels, looks);
}

bool Heap::leads_on(const Container& cell, int levels, int& looks) {
  const auto child_leads_on = [&](const Cell* child) {
    if (--looks < 0) return true;
    if (!can_close_cycle(child)) return false;
    return levels == 0 || leads_on(static_cast<const Container&>(*child), levels - 1, looks);
  };
  const auto element_leads_on = [&](const Value& v) { return child_leads_on(v.is_reference() ? v.ref : nullptr); };
  if (cell.tag == Tag::Object) {
    const auto& instance = static_cast<const Instance&>(cell);
    if (!instance.auto_free) return false;
    const auto& slots = instance.cls->reference_slots;
    return std::any_of(slots.begin(), slots.end(),
                       [&](std::uint16_t slot) { return child_leads_on(instance.slots[slot].ref); });
  }
  if (cell.tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(cell);
    if (list.narrow() && !is_container(list.kind)) return false;
    return std::any_of(list.begin(), list.end(), element_leads_on);
  }
  const auto& hash = static_cast<const HashCell&>(cell);
  return std::any_of(hash.entries, hash.entries + hash.used, [&](const HashCell::Entry& entry) {
    return element_leads_on(entry.key) || element_leads_on(entry.value);
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
  const bool dying = !dying_.empty();
  free_dying();
  if (dying || !zero_.empty()) reclaim_all();
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

// Roots are scanned as long as few cells wait, so that there is always something to fetch ahead.
void Heap::mark(std::int64_t& work) {
  Reach reach(*this);
  while (work > 0) {
    if (partial_ != nullptr) {
      scan_part(reach, work);
      continue;
    }
    for (; grey_.size() - next_grey_ < kAhead && passed_ < containers_.size() && work > 0; ++passed_) {
      fetch_place_ahead();
      work -= kPlace;
      if (marks_[passed_] != kWhite) continue;
      work -= kLook;
      Container& cell = *containers_[passed_];
      if (!is_root(cell)) continue;
      marks_[passed_] = kBlack;
      scan(cell, reach, work);
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

void Heap::fetch_place_ahead() const {
  const std::uint32_t ahead = passed_ + kAhead;
  if (ahead >= containers_.size() || marks_[ahead] != kWhite) return;
  const auto* cell = reinterpret_cast<const char*>(containers_[ahead]);
  fetch(cell);
  fetch(cell + 64);
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
    for (const std::uint16_t slot : instance.cls->reference_slots) reach(instance.slots[slot].ref);
    work -= kElement * static_cast<std::int64_t>(instance.cls->reference_slots.size());
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
  std::uint32_t count = 0;
  if (partial_->tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(*partial_);
    const std::uint32_t from = std::max(position_, list.first);
    const std::uint32_t end = list.first + list.size;
    const std::uint32_t to = from >= end ? end : from + std::min(most, end - from);
    for (std::uint32_t i = from; i < to; ++i) {
      if (!list.narrow())
        reach(list.values()[i]);
      else if (is_container(list.kind))
        reach(list.store[i].ref);
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
      reach(entry.key);
      reach(entry.value);
      ++count;
    }
    if (position_ >= hash.used) partial_ = nullptr;
  }
  work -= kElement * count;
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
    suspicion_ = true;  // what hangs on it is looked at again, when it is gone
    work -= kBreak;
    shade(&cell);
  }
  if (passed_ < containers_.size()) return;
  if (short_of_memory_) suspicion_ = true;
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
    if (last.is_reference()) work -= 2 * kBreak;  // it may be the last one, and the cell be freed
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
