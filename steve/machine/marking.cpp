// How the collector of the whole heap marks what is alive. Nearly all of its time is waiting for memory: cells lie far
// apart. So each cell is asked for some units before it is looked at, its elements some units before they are read, and
// what leads no further is never queued. Between slices nothing is on its way: all that waits is grey.
//
// Sources: Cher, Hosking and Vitek 2004 (a queue of cells to fetch before the stack of those to scan).
#include <algorithm>
#include <array>
#include <cstring>

#include "steve/code/program.hpp"
#include "steve/machine/collecting.hpp"
#include "steve/machine/heap.hpp"

namespace breve::steve {

using namespace collecting;

/// Cells on their way from memory, in three stages: reached, waiting for its mark, ready to be scanned.
class Heap::Marker {
 public:
  explicit Marker(Heap& heap) : heap_(heap) {}
  ~Marker() { flush(); }
  Marker(const Marker&) = delete;
  Marker& operator=(const Marker&) = delete;

  void reach(Cell* cell) {
    if (cell == nullptr) return;
    fetch(cell);
    std::swap(cell, heads_[next_head_++ % kHeads]);
    if (cell != nullptr) arrived(cell);
  }
  /// Is it a reference that may lead on?
  std::uint32_t reach(const Value& v) {
    if (!is_container(v.tag)) return 0;
    reach(v.ref);
    return 1;
  }

  /// Are so few cells on their way that a root may be scanned?
  bool hungry() const { return stacked_ + waiting_ < kAhead && heap_.grey_.empty(); }
  /// The next cell to scan, or null if nothing is grey but cells that find_left_grey finds.
  Container* next();
  void scan(Container& cell, std::int64_t& work);
  void scan_part(std::int64_t& work);

 private:
  static constexpr std::uint8_t kOnItsWay = kGrey | kColour;  // grey, and in one of the stages
  static constexpr std::uint32_t kHeads = 16, kSlots = 8, kReady = 8, kStack = 256, kAhead = 24, kRefill = 32;

  // Roots have their turn in the order of the table, which is nearly that of memory; one that ceases to be a root is
  // shaded by the release of the table of objects.
  void arrived(Cell* cell) {
    if (!is_container(cell->tag) || is_root(*static_cast<const Container*>(cell))) return;
    auto* container = static_cast<Container*>(cell);
    fetch(&heap_.marks_[container->slot]);
    std::swap(container, slots_[next_slot_++ % kSlots]);
    if (container != nullptr) darken(*container);
  }
  void darken(Container& cell) {
    if (!heap_.is_white(cell.slot)) return;
    if (is_leaf(cell)) {
      if (heap_.white_left_ > 0) --heap_.white_left_;
      return heap_.blacken(cell.slot);
    }
    if (stacked_ == kStack) return heap_.shade_slot(cell.slot);
    heap_.marks_[cell.slot] = kOnItsWay;
    stack_[stacked_++] = &cell;
  }
  void refill();
  static void fetch_elements(const Container& cell) {
    if (cell.tag == Tag::List) {
      const auto& list = static_cast<const ListCell&>(cell);
      const char* elements = reinterpret_cast<const char*>(list.store) + list.first * list.element_bytes();
      fetch(elements);
      if (!list.narrow()) fetch(elements + 64);
    } else if (cell.tag == Tag::Hash) {
      fetch(static_cast<const HashCell&>(cell).entries);
    } else {
      fetch(static_cast<const Instance&>(cell).slots);
    }
  }
  bool settle_reached();
  void flush();

  Heap& heap_;
  std::uint32_t next_head_ = 0, next_slot_ = 0, next_ready_ = 0;
  std::uint32_t stacked_ = 0, waiting_ = 0;
  std::array<Cell*, kHeads> heads_{};       // cells whose heads are on their way
  std::array<Container*, kSlots> slots_{};  // cells whose marks are on their way
  std::array<Container*, kReady> ready_{};  // grey cells whose elements are on their way
  std::array<Container*, kStack> stack_;    // grey cells; those for which there is no room are on grey_
};

// What became grey and has moved since, or died, is not where it was: find_left_grey looks for it.
void Heap::Marker::refill() {
  std::pmr::vector<std::uint32_t>& grey = heap_.grey_;
  while (stacked_ < kRefill && !grey.empty()) {
    const std::uint32_t slot = grey.back();
    grey.pop_back();
    if (slot >= heap_.marks_.size() || heap_.marks_[slot] != kGrey) continue;
    heap_.marks_[slot] = kOnItsWay;
    stack_[stacked_++] = heap_.containers_[slot];
    fetch(stack_[stacked_ - 1]);
  }
}

Container* Heap::Marker::next() {
  for (;;) {
    if (stacked_ == 0) refill();
    Container* cell = stacked_ > 0 ? stack_[--stacked_] : nullptr;
    if (cell == nullptr && waiting_ == 0) {
      if (settle_reached()) continue;
      return nullptr;
    }
    if (cell != nullptr) {
      fetch_elements(*cell);
      ++waiting_;
    }
    std::swap(cell, ready_[next_ready_++ % kReady]);
    if (cell == nullptr) continue;
    --waiting_;
    return cell;
  }
}

// False if nothing was on its way.
bool Heap::Marker::settle_reached() {
  for (std::uint32_t i = 0; i < kHeads; ++i, ++next_head_) {
    Cell*& cell = heads_[next_head_ % kHeads];
    if (cell != nullptr) arrived(cell);
    cell = nullptr;
  }
  for (std::uint32_t i = 0; i < kSlots; ++i, ++next_slot_) {
    Container*& cell = slots_[next_slot_ % kSlots];
    if (cell != nullptr) darken(*cell);
    cell = nullptr;
  }
  return stacked_ > 0 || !heap_.grey_.empty();
}

void Heap::Marker::flush() {
  settle_reached();
  const auto wait = [this](const Container& cell) {
    heap_.marks_[cell.slot] = kGrey;
    heap_.push_grey(cell.slot);
  };
  for (std::uint32_t i = 0; i < stacked_; ++i) wait(*stack_[i]);
  for (const Container* cell : ready_)
    if (cell != nullptr) wait(*cell);
}

void Heap::Marker::scan(Container& cell, std::int64_t& work) {
  heap_.marks_[cell.slot] = heap_.new_mark(cell, heap_.white_ ^ kColour);
  if (heap_.white_left_ > 0) --heap_.white_left_;
  work -= kMark;
  if (cell.tag == Tag::Object) {
    auto& instance = static_cast<Instance&>(cell);
    for (const std::uint16_t slot : instance.cls->reference_slots) reach(instance.slots[slot].ref);
    work -= kReference * static_cast<std::int64_t>(instance.cls->reference_slots.size());
    return;
  }
  heap_.partial_ = &cell;
  heap_.position_ = cell.tag == Tag::List ? static_cast<ListCell&>(cell).first : 0;
  scan_part(work);
}

// Positions count from the start of the store, so that adding and removing at either end does not shift them. Elements
// that are removed unseen are shaded by `release`.
void Heap::Marker::scan_part(std::int64_t& work) {
  constexpr std::int64_t kPiece = 1024;  // elements, so that what they refer to is counted in time
  const auto most = static_cast<std::uint32_t>(std::clamp<std::int64_t>(work, 1, kPiece));
  std::uint32_t count = 0, references = 0;
  std::uint32_t& position = heap_.position_;
  if (heap_.partial_->tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(*heap_.partial_);
    const std::uint32_t from = std::max(position, list.first);
    const std::uint32_t end = list.first + list.size;
    const std::uint32_t to = from >= end ? end : from + std::min(most, end - from);
    count = to > from ? to - from : 0;
    if (!list.narrow()) {
      for (std::uint32_t i = from; i < to; ++i) references += reach(list.values()[i]);
    } else if (is_container(list.kind)) {
      for (std::uint32_t i = from; i < to; ++i) reach(list.store[i].ref);
      references = count;
    }
    position = to;
    if (to == end) heap_.partial_ = nullptr;
  } else {
    const auto& hash = static_cast<const HashCell&>(*heap_.partial_);
    // Removed entries are not counted: a restored hash has none.
    for (; position < hash.used && count < most; ++position) {
      const HashCell::Entry& entry = hash.entries[position];
      if (!entry.live()) continue;
      references += reach(entry.key) + reach(entry.value);
      ++count;
    }
    if (position >= hash.used) heap_.partial_ = nullptr;
  }
  work -= kElement * count + kReference * references;
}

void Heap::shade(Cell* cell) {
  if (cell != nullptr && is_container(cell->tag)) shade_slot(static_cast<Container*>(cell)->slot);
}

void Heap::shade_slot(std::uint32_t slot) {
  if (!is_white(slot)) return;
  marks_[slot] = kGrey;
  push_grey(slot);
}

// Each place is white once in a collection, so there is room; if a damaged image has taken it, find_left_grey helps.
void Heap::push_grey(std::uint32_t slot) {
  if (grey_.size() < grey_.capacity()) grey_.push_back(slot);
}

// Eight places at a time.
std::uint32_t Heap::next_slot(std::uint32_t from, std::uint32_t to, std::uint8_t mask, std::uint8_t mark) const {
  constexpr std::uint64_t kOnes = 0x0101010101010101U;
  const std::uint8_t* marks = marks_.data();
  while (from < to) {
    if ((marks[from] & mask) == mark) return from;
    ++from;
    while (to - from >= 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, marks + from, 8);
      word = (word & (kOnes * mask)) ^ (kOnes * mark);
      if (((word - kOnes) & ~word & (kOnes << 7)) != 0) break;  // one of the bytes is zero
      from += 8;
    }
  }
  return to;
}

// Moves passed_ to the next white place of these kinds; false if there is none, or no work left to look further.
bool Heap::pass_to(std::uint8_t kinds, std::int64_t& work) {
  if (work <= 0) return false;
  const auto size = static_cast<std::uint32_t>(marks_.size());
  const auto to = static_cast<std::uint32_t>(std::min<std::int64_t>(size, passed_ + work));
  const std::uint32_t slot = next_slot(passed_, to, static_cast<std::uint8_t>(~kinds), white_);
  work -= kSlot * (slot - passed_ + 1);
  passed_ = slot;
  return slot < to;
}

// Roots are scanned as long as few cells wait, so that there is always something to fetch ahead.
void Heap::mark(std::int64_t& work) {
  Marker marker(*this);
  while (work > 0) {
    if (partial_ != nullptr) {
      marker.scan_part(work);
      continue;
    }
    if (marker.hungry() && pass_to(0, work)) {
      fetch_slot_ahead();
      work -= kLook;
      Container& cell = *containers_[passed_++];
      if (!is_root(cell)) continue;
      work += kMark - kRoot;
      marker.scan(cell, work);
      continue;
    }
    if (Container* cell = marker.next(); cell != nullptr)
      marker.scan(*cell, work);
    else if (passed_ == containers_.size() && !find_left_grey())
      return end_of_marking();
  }
}

void Heap::fetch_slot_ahead() const {
  constexpr std::uint32_t kSlotsAhead = 24;
  const std::uint32_t ahead = passed_ + kSlotsAhead;
  if (ahead >= containers_.size() || marks_[ahead] != white_) return;
  const auto* cell = reinterpret_cast<const char*>(containers_[ahead]);
  fetch(cell);
  fetch(cell + 64);
}

// When a cell dies, another one takes its place, and the stack of grey ones may not know it. So the table is looked
// through when the stack is empty. True if there was one.
bool Heap::find_left_grey() {
  const auto size = static_cast<std::uint32_t>(marks_.size());
  for (std::uint32_t at = 0; (at = next_slot(at, size, kGrey, kGrey)) < size; ++at)
    if (grey_.size() < grey_.capacity()) grey_.push_back(at);
  return !grey_.empty();
}

void Heap::end_of_marking() {
  passed_ = 0;
  phase_ = phase_ == Phase::Mark ? Phase::Examine : Phase::Sweep;
  if (phase_ != Phase::Sweep) return;
  barrier_ = false;
  white_left_ = count_white();
}

std::uint32_t Heap::count_white() const {
  std::uint32_t count = 0;
  for (const std::uint8_t mark : marks_) count += (mark & ~kOther) == white_ ? 1U : 0U;
  return count;
}

void Heap::finish_partial() {
  Marker marker(*this);
  std::int64_t work = INT64_MAX;
  while (partial_ != nullptr) marker.scan_part(work);
}

}  // namespace breve::steve
