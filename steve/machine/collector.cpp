// The collector of the whole heap, for cycles that suspects.cpp leaves: it marks from what is alive when it begins and
// takes apart what it did not reach, in slices of counted work. Cells outside of cycles never need it. Its state is the
// table of containers with a mark for each place and a queue of places, so that a snapshot can keep it exactly.
//
// Instances without auto-free are alive by themselves and have their turn in the order of the table, which is nearly
// that of memory; all else is scanned in the order in which it was reached.
#include <algorithm>
#include <memory>

#include "steve/code/program.hpp"
#include "steve/machine/collecting.hpp"
#include "steve/machine/heap.hpp"

namespace breve::steve {

using namespace collecting;

namespace {

// How far may_close_cycle looks; what leads further is suspected unseen.
constexpr int kLooks = 64;  // references and elements
constexpr int kLevels = 3;  // below the first

}  // namespace

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
  cell.slot = static_cast<std::uint32_t>(containers_.size());
  containers_.push_back(&cell);
  marks_.push_back(new_mark(cell, phase_ == Phase::Idle ? white_ : white_ ^ kColour));
}

std::uint8_t Heap::new_mark(const Container& cell, int colour) {
  if (cell.tag != Tag::Object) return static_cast<std::uint8_t>(kOther | colour);
  return static_cast<const Instance&>(cell).cls->reference_slots.empty() ? kInert : static_cast<std::uint8_t>(colour);
}

void Heap::move_slot(std::uint32_t from, std::uint32_t to) {
  if (from == to) return;
  containers_[to] = containers_[from];
  containers_[to]->slot = to;
  marks_[to] = marks_[from];
}

// The last cell takes the place, by way of the boundary, so that what was passed stays passed. Places on the stack of
// grey ones may become wrong by it: see find_left_grey.
void Heap::strike(Container& cell) {
  if (partial_ == &cell) partial_ = nullptr;
  std::uint32_t slot = cell.slot;
  if (white_left_ > 0 && is_white(slot)) --white_left_;
  if (slot < passed_) {
    move_slot(--passed_, slot);
    slot = passed_;
  }
  move_slot(static_cast<std::uint32_t>(containers_.size() - 1), slot);
  containers_.pop_back();
  marks_.pop_back();
}

// --- phases ----------------------------------------------------------------------------------------------------------

void Heap::end_of_iteration() {
  short_of_memory_ = false;
  reclaim_all();
  if (held_by_frames_) suspicion_ = true;
  held_by_frames_ = false;
  judge_suspects();
  std::int64_t work = slice();
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
  if (slices_left_ > 1) --slices_left_;
  const bool dying = !dying_.empty();
  free_dying();
  if (dying || !zero_.empty()) reclaim_all();
  if (short_of_memory_) throw std::bad_alloc();
}

// More than usual only where cells refer to so many others that the collection would not be done in time.
std::int64_t Heap::slice() const {
  if (phase_ != Phase::Mark) return kSlice;
  const std::uint64_t cells = white_left_ / slices_left_;
  if (slices_left_ == 1) return 8 * kSlice;
  return cells >= kHurry * 3 / 2 ? 4 * kSlice : cells >= kHurry ? 2 * kSlice : kSlice;
}

void Heap::begin_collection() {
  suspicion_ = false;
  phase_ = Phase::Mark;
  barrier_ = true;
  slices_left_ = cells_ / kPromised + 1;
  white_left_ = count_white();
  drop_suspects();  // what is garbage by now, this collection finds
  passed_ = 0;
  grey_.clear();
  const auto reach = [this](Cell* cell) { shade(cell); };
  roots_.visit_roots(reach);
  // What a frame holds now may be left in a cycle when the frame ends: a later iteration has to look again.
  roots_.visit_frames([this](Cell* cell) {
    shade(cell);
    if (can_close_cycle(cell) && cell->count > 0) held_by_frames_ = true;
  });
  for (Instance* doomed : doomed_) shade(doomed);
  for (const Dying& dying : dying_) shade(dying.instance);
}

// Garbage is known. Auto-free instances in it must run destroy, which may bring anything of it back to life: whatever
// they refer to is kept this time (Remark), the rest goes.
void Heap::examine(std::int64_t& work) {
  while (pass_to(0, work)) {
    Container& cell = *containers_[passed_++];
    work -= kLook;
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
  try {
    dying_.reserve(dying_.size() + condemned_.size());
    for (Instance* instance : condemned_) dying_.push_back({instance->serial, instance});
  } catch (const std::bad_alloc&) {  // they are found again by the collection that follows
    short_of_memory_ = true;
    for (Instance* instance : condemned_) release(instance);
  }
  condemned_.clear();
  std::sort(dying_.begin(), dying_.end(), [](const Dying& a, const Dying& b) { return a.serial > b.serial; });
  const std::uint64_t iterations = cells_ / kCells + 1;
  share_ = (dying_.size() + iterations - 1) / iterations;
}

// A share of the garbage in cycles is freed in each iteration, so that a collection that ends does not end in a long
// pause.
void Heap::free_dying() {
  for (std::uint64_t left = share_; left > 0 && !dying_.empty(); --left) {
    Instance* dying = dying_.back().instance;
    dying_.pop_back();
    const auto unpin = [this](Instance* instance) { release(instance); };
    const std::unique_ptr<Instance, decltype(unpin)> held(dying, unpin);
    if (dying->state == Instance::State::Live && dying->auto_free) roots_.free_unreachable(*dying);
  }
}

// Taking a cell apart releases what it refers to. When every cell of the garbage has lost its references, every count
// in it is 0, and the cells are freed like any others: no more in each iteration than leaves the promise.
void Heap::sweep(std::int64_t& work) {
  const bool suspicion = suspicion_;
  const auto share = static_cast<std::int64_t>((white_left_ + slices_left_ - 1) / slices_left_);
  const std::int64_t most = std::min(work, kSwept * std::max(share, kLeastSwept));
  std::int64_t left = most;
  while (left > 0 && passed_ < containers_.size()) {
    if (partial_ != nullptr) {  // others may have taken its place
      take_apart(*partial_, left);
      continue;
    }
    if (!pass_to(kOther, left) || !take_apart(*containers_[passed_], left)) break;
    blacken(passed_++);
    if (white_left_ > 0) --white_left_;
  }
  work -= most - left;
  suspicion_ = suspicion;  // the counts that garbage lowers close no cycle
  if (passed_ < containers_.size()) {
    work = 0;
    return;
  }
  phase_ = Phase::Idle;
  passed_ = 0;
  white_ ^= kColour;
}

// Freeing a cell of the garbage frees what it alone refers to, and so on: a cycle would be freed at once.
bool Heap::is_swept_later(const Cell& cell) const {
  if (phase_ != Phase::Sweep || !is_container(cell.tag)) return false;
  const auto& container = static_cast<const Container&>(cell);
  return is_white(container.slot) && !is_leaf(container);
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
