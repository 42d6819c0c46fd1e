// Small cycles, found where they are left behind: a container that lost a reference and lives on, or that came to be
// referred to while it leads on, is suspected and judged at the end of the iteration. All that it leads to is gathered,
// up to a bound; what nothing outside refers to is garbage. What leads too far, and what has no room or no turn, is
// left to the collector of the whole heap (collector.cpp), which keeps the promise of docs/limits.md whatever is left
// to it.
//
// Source: Bacon and Rajan 2001 (trial deletion), with regions gathered and counts restored per suspect.
#include <algorithm>
#include <optional>

#include "steve/code/program.hpp"
#include "steve/machine/heap.hpp"

namespace breve::steve {

namespace {

// Units of work: a cell, or an element or slot of one.
constexpr std::int64_t kRegion = 2000;      // of one suspect
constexpr std::int64_t kIteration = 16000;  // of all; those that are left wait, and the whole heap is collected
constexpr std::int64_t kLarge = 20000;      // of those that lead farther than kRegion, when all others are judged
constexpr std::uint8_t kMostFarRest = 64;   // iterations for which these are not looked at, when one led farther still
constexpr std::int64_t kSuspect = 2;        // to begin with one

// Marks of cells while suspects are judged.
constexpr std::uint8_t kHeld = 1;    // by a frame: neither part of a region nor looked into
constexpr std::uint8_t kInside = 2;  // part of the region
constexpr std::uint8_t kAlive = 3;   // part of it, and reached from outside
constexpr std::uint8_t kJudged = 4;  // a suspect that a region has reported
constexpr std::uint8_t kFar = 5;     // a suspect that leads farther than kRegion

// Other instances are alive until they are freed, whoever refers to them.
bool can_be_garbage(const Cell* cell) {
  if (cell == nullptr || !is_container(cell->tag) || cell->mark == kHeld) return false;
  if (cell->tag != Tag::Object) return true;
  const auto& instance = static_cast<const Instance&>(*cell);
  return instance.auto_free && instance.state == Instance::State::Live;
}

std::int64_t cost(const Container& cell) {
  if (cell.tag == Tag::List)
    return 1 + (static_cast<const ListCell&>(cell).holds_references() ? static_cast<const ListCell&>(cell).size : 0U);
  if (cell.tag == Tag::Hash) return 1 + 2 * static_cast<std::int64_t>(static_cast<const HashCell&>(cell).used);
  return 1 + static_cast<std::int64_t>(static_cast<const Instance&>(cell).cls->reference_slots.size());
}

template <class Visit>
void each_reference(const Container& cell, const Visit& visit) {
  const auto visit_cell = [&visit](Cell* child) {
    if (can_be_garbage(child)) visit(*static_cast<Container*>(child));
  };
  if (cell.tag == Tag::Object) {
    const auto& instance = static_cast<const Instance&>(cell);
    for (const std::uint16_t slot : instance.cls->reference_slots) visit_cell(instance.slots[slot].ref);
  } else if (cell.tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(cell);
    if (!list.holds_references()) return;
    for (const Value& element : list)
      if (element.is_reference()) visit_cell(element.ref);
  } else {
    const auto& hash = static_cast<const HashCell&>(cell);
    for (std::uint32_t i = 0; i < hash.used; ++i) {
      if (!hash.entries[i].live()) continue;
      if (hash.entries[i].key.is_reference()) visit_cell(hash.entries[i].key.ref);
      if (hash.entries[i].value.is_reference()) visit_cell(hash.entries[i].value.ref);
    }
  }
}

// Suspects lie far apart: the head of one is fetched while others are looked at.
void fetch_head(std::span<Container* const> suspects, std::size_t index) {
  constexpr std::size_t kFar = 16;
  if (index + kFar < suspects.size()) __builtin_prefetch(suspects[index + kFar]);
}

// The same of those that are looked into: first the cell is fetched, then, when its head has arrived, what holds its
// references.
void fetch_suspects(std::span<Container* const> suspects, std::size_t index) {
  constexpr std::size_t kFar = 16, kNear = 8;
  if (index + kFar < suspects.size()) {
    const auto* far = reinterpret_cast<const char*>(suspects[index + kFar]);
    __builtin_prefetch(far);
    __builtin_prefetch(far + 64);
  }
  if (index + kNear >= suspects.size()) return;
  const Container& near = *suspects[index + kNear];
  if (near.tag == Tag::List) {
    const auto& list = static_cast<const ListCell&>(near);
    __builtin_prefetch(reinterpret_cast<const char*>(list.store) + list.first * list.element_bytes());
  }
  if (near.tag == Tag::Hash) __builtin_prefetch(static_cast<const HashCell&>(near).entries);
}

}  // namespace

/// What a suspect leads to. While it is gathered, references inside it are taken off the counts; they are put back
/// before anything else happens.
class Heap::Region {
 public:
  /// @throws std::bad_alloc  nothing has happened
  explicit Region(std::pmr::memory_resource* memory) : cells_(memory), path_(memory) { make_room(kRegion); }

  /// For regions of up to so many units. @throws std::bad_alloc  nothing has happened
  void make_room(std::int64_t units) {
    cells_.reserve(static_cast<std::size_t>(units + 1));
    path_.reserve(static_cast<std::size_t>(units + 1));
  }

  /// False if it leads too far, which is more than `most` units; then nothing has changed but `work`, and suspects
  /// among what was gathered are marked `otherwise`: they share its lot, so that what is large is gathered once.
  bool gather(Container& suspect, std::int64_t most, std::int64_t& work, std::uint8_t otherwise) {
    cells_.clear();
    add(suspect);
    std::int64_t left = most;
    std::size_t done = 0;
    for (; done < cells_.size() && left >= 0; ++done) {
      left -= cost(*cells_[done]);
      if (left < 0) break;
      each_reference(*cells_[done], [this](Container& child) {
        if (child.mark != kInside) add(child);
        --child.count;
      });
    }
    work -= most - std::max<std::int64_t>(left, 0);
    if (left >= 0) return true;
    restore(done);
    leave(otherwise);
    return false;
  }

  /// Tell the living from the dead, and put the counts back.
  void judge() {
    for (Container* cell : cells_)
      if (cell->count > (cell->suspected ? 1U : 0U)) revive(*cell);
    restore(cells_.size());
  }

  /// A dead cell that is to stay for now, with all that it leads to.
  void revive(Container& cell) {
    if (cell.mark != kInside) return;
    cell.mark = kAlive;
    path_.push_back(&cell);
    while (!path_.empty()) {
      const Container& next = *path_.back();
      path_.pop_back();
      each_reference(next, [this](Container& child) {
        if (child.mark != kInside) return;
        child.mark = kAlive;
        path_.push_back(&child);
      });
    }
  }

  /// Take the marks away; what is left in cells() is dead.
  void leave(std::uint8_t suspects = kJudged) {
    std::size_t dead = 0;
    for (Container* cell : cells_) {
      if (cell->mark == kInside) cells_[dead++] = cell;
      cell->mark = cell->suspected ? suspects : 0;
    }
    cells_.resize(dead);
  }

  static bool dead(const Container& cell) { return cell.mark == kInside; }
  const std::pmr::vector<Container*>& cells() const { return cells_; }

 private:
  void add(Container& cell) {
    cell.mark = kInside;
    cells_.push_back(&cell);
  }
  void restore(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) each_reference(*cells_[i], [](Container& child) { ++child.count; });
  }

  std::pmr::vector<Container*> cells_;
  std::pmr::vector<Container*> path_;
};

void Heap::suspect(Container& cell) {
  if (suspects_.size() == kMostSuspects) {
    suspicion_ = true;
    return;
  }
  cell.suspected = true;
  ++cell.count;
  suspects_.push_back(&cell);
  if (suspects_.size() % kReclaimAt == 0) wants_reclaim_ = true;
}

// Those that only the table holds are in no cycle, but garbage like any other.
bool Heap::drop_lonely_suspects() {
  std::size_t next = 0;
  const auto dropped = std::erase_if(suspects_, [this, &next](Container* cell) {
    fetch_head(suspects_, next++);
    if (cell->count > 1) return false;
    cell->suspected = false;
    cell->count = 0;
    if (!cell->listed) enlist(cell);
    return true;
  });
  return dropped != 0;
}

void Heap::judge_suspects() {
  if (far_rest_ > 0) --far_rest_;
  if (suspects_.empty()) return;
  std::optional<Region> region;
  try {
    region.emplace(memory_);
  } catch (const std::bad_alloc&) {  // they wait
    short_of_memory_ = true;
    return;
  }
  roots_.visit_frames([](Cell* cell) {
    if (cell != nullptr && !cell->immortal) cell->mark = kHeld;
  });
  std::int64_t work = kIteration;
  std::size_t next = 0;
  int far = 0;
  const auto judge_near = [&](int most_far) {
    const std::uint8_t otherwise = most_far > 0 ? kFar : kJudged;
    for (far = 0; next < suspects_.size() && work > 0 && far <= most_far; ++next) {
      fetch_suspects(suspects_, next);
      Container& suspect = *suspects_[next];
      if (suspect.mark != 0) continue;
      work -= kSuspect;
      suspect.mark = kJudged;
      if (suspect.count == 1 || !can_be_garbage(&suspect)) continue;
      if (region->gather(suspect, kRegion, work, otherwise))
        judge_region(*region);
      else if (most_far > 0)
        ++far;
      else
        suspicion_ = true;
    }
  };
  // One large structure has many suspects in it: it is judged when two have failed, and then the others are.
  judge_near(1);
  if (far > 0) {
    judge_far_suspects(*region);
    judge_near(0);
  }
  roots_.visit_frames([](Cell* cell) {
    if (cell != nullptr && !cell->immortal) cell->mark = 0;
  });
  std::erase_if(suspects_, [this](Container* cell) {
    if (cell->mark != kJudged) return false;
    cell->mark = 0;
    cell->suspected = false;
    if (--cell->count == 0 && !cell->listed) enlist(cell);
    return true;
  });
  if (!condemned_.empty() && phase_ != Phase::Examine) doom_condemned();
  const bool left_over = !suspects_.empty();
  if (!zero_.empty() || left_over) reclaim_all();
  if (left_over && !suspects_.empty()) suspicion_ = true;  // their turn may come later than was promised
}

void Heap::drop_suspects() {
  for (Container* cell : suspects_) {
    cell->suspected = false;
    if (--cell->count == 0 && !cell->listed) enlist(cell);
  }
  suspects_.clear();
}

void Heap::judge_region(Region& region) {
  region.judge();
  condemn(region);
  region.leave();
  break_up(region);
}

// A cycle of some thousands is worth more work than looking through the whole heap for it. A large structure that lives
// may come to be suspected in each iteration, and is not.
void Heap::judge_far_suspects(Region& region) {
  std::int64_t work = far_rest_ == 0 ? kLarge : 0;
  try {
    if (work > 0) region.make_room(kLarge);
  } catch (const std::bad_alloc&) {
    short_of_memory_ = true;
    work = 0;
  }
  const bool looked = work > 0;
  bool any_left = false;
  for (Container* suspect : suspects_) {
    if (suspect->mark != kFar) continue;
    suspect->mark = kJudged;
    if (work > 0 && region.gather(*suspect, work, work, kJudged))
      judge_region(region);
    else
      any_left = true;
  }
  if (any_left) suspicion_ = true;
  if (!looked) return;
  next_far_rest_ =
      any_left ? std::clamp<std::uint8_t>(static_cast<std::uint8_t>(next_far_rest_ * 2), 4, kMostFarRest) : 0;
  far_rest_ = next_far_rest_;
}

// Dead instances must run destroy, which may bring anything that they lead to back to life: that stays this time.
void Heap::condemn(Region& region) {
  const std::size_t old = condemned_.size();
  for (Container* cell : region.cells()) {
    if (!Region::dead(*cell) || cell->tag != Tag::Object) continue;
    try {
      condemned_.push_back(static_cast<Instance*>(cell));
    } catch (const std::bad_alloc&) {  // the collector of the whole heap finds it
      short_of_memory_ = suspicion_ = true;
      region.revive(*cell);
    }
  }
  for (std::size_t i = old; i < condemned_.size(); ++i) {
    retain(condemned_[i]);
    if (barrier_) shade(condemned_[i]);
    region.revive(*condemned_[i]);
  }
}

// All are held until each has lost its references.
void Heap::break_up(const Region& region) {
  for (Container* cell : region.cells()) retain(cell);
  for (Container* cell : region.cells()) release_children(*cell);
  for (Container* cell : region.cells())
    if (--cell->count == 0 && !cell->listed) enlist(cell);
}

}  // namespace breve::steve
