// The script heap of one world: deferred reference counts for what dies young, an incremental mark and sweep, bounded
// by counted work, for cycles. Frames are not counted: a cell whose count is 0 waits in a table until a safe point.
//
// Sources: Deutsch and Bobrow 1976 (deferred counting); Yuasa 1990 (snapshot-at-the-beginning marking); Baker 1992
// (colours as regions of one table instead of bits in cells).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory_resource>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/invariant.hpp"
#include "runtime/base/memory.hpp"
#include "steve/machine/budget.hpp"
#include "steve/machine/cells.hpp"

namespace breve::steve {

/// Calls back for every reference that keeps something alive: table of objects, frames, pinned values.
class RootSource {
 public:
  virtual ~RootSource() = default;
  /// References held by running frames and natives (uncounted). Called at a safe point. The same cells must be visited
  /// when it is called twice without anything in between; null and immortal ones are welcome.
  virtual void visit_frames(const std::function<void(Cell*)>& visit) = 0;
  /// Counted references from outside the heap: pinned values. Instances without auto-free are roots by themselves, the
  /// heap knows them; visiting them too is harmless but costs time in one slice.
  virtual void visit_roots(const std::function<void(Cell*)>& visit) = 0;
  /// An auto-free instance that nothing refers to any more: run `destroy`, then free it as `free` would.
  virtual void free_unreachable(Instance& instance) = 0;
};

class Heap : public InMemory {
 public:
  Heap(std::pmr::memory_resource* memory, RootSource& roots);
  ~Heap();  // frees every cell; runs no script
  Heap(const Heap&) = delete;
  Heap& operator=(const Heap&) = delete;

  // --- making cells; each may throw std::bad_alloc (then nothing has changed), none collects -----------------------
  StringCell* string(std::string_view bytes);  // null for the empty string
  StringCell* concat(std::string_view a, std::string_view b);
  /// a + b, where `a` may be the same text that was added to before: amortised O(b).
  StringCell* append(StringCell* a, std::string_view b);
  /// A string that up to `capacity` bytes are appended to in place: as `append` left the one that an image was made of.
  StringCell* roomy_string(std::string_view bytes, std::size_t capacity);
  /// The bytes of a string with a zero byte behind them; null gives "".
  const char* terminated(StringCell* string);
  MatrixCell* matrix(const Matrix3& m);
  ListCell* list(std::uint32_t capacity = 0);
  HashCell* hash();
  PointerCell* pointer(std::unique_ptr<NativePointer> native);
  DataCell* data(std::string_view bytes);
  Instance* instance(const ClassInfo& cls);  // slots zeroed, serial given, count 0

  // --- counted references --------------------------------------------------------------------------------------------
  void retain(Cell* cell) {
    if (cell && !cell->immortal) ++cell->count;
  }
  /// The write barrier: call for every reference that a heap slot loses.
  void release(Cell* cell) {
    if (!cell || cell->immortal) return;
    if (barrier_) [[unlikely]]
      shade(cell);
    invariant(cell->count > 0, "a reference to a cell is released once more than it was taken");
    if (--cell->count == 0) {
      if (!cell->listed) enlist(cell);
    } else if (is_container(cell->tag)) {
      note_survivor(static_cast<Container*>(cell));
    }
  }
  void retain(const Value& v) {
    if (v.is_reference()) retain(v.ref);
  }
  void release(const Value& v) {
    if (v.is_reference()) release(v.ref);
  }
  /// slot = value with counting, for slots inside cells.
  void store(Value& slot, const Value& value) {
    const Value old = slot;
    const Value fresh = value;
    retain(fresh);
    slot = fresh;
    release(old);
  }
  void store(Slot& slot, Cell* ref) {
    Cell* old = slot.ref;
    retain(ref);
    slot.ref = ref;
    release(old);
  }
  /// Release every reference in the slots of an instance and zero all its slots (what `free` does to variables).
  void clear_slots(Instance& instance);

  // --- lists ---------------------------------------------------------------------------------------------------------

  // Positions are checked by the caller. Adding to a list of 2^31 - 1 elements is RunError{Bounds}.

  void push(ListCell& list, const Value& value) {
    if (!push_slot(list, value.tag, value.bits[0])) push_slowly(list, value);
  }
  /// Push what stands in one slot, if the list is one of such elements and has room: else nothing happens.
  bool push_slot(ListCell& list, Tag tag, std::uint64_t bits) {
    if (list.kind != tag || tag == Tag::Null || list.first + list.size == list.capacity) return false;
    Slot& slot = list.store[list.first + list.size++];
    slot.bits = bits;
    if (tag >= Tag::Matrix) retain(slot.ref);
    return true;
  }
  void prepend(ListCell& list, const Value& value);
  void insert(ListCell& list, std::uint32_t position, const Value& value);
  /// list{position} = value
  void set(ListCell& list, std::uint32_t position, const Value& value);
  Value pop(ListCell& list) {  // the list is not empty
    const Value value = list[--list.size];
    release(value);
    return value;
  }
  Value unprepend(ListCell& list) {  // the list is not empty
    const Value value = list[0];
    ++list.first;
    --list.size;
    release(value);
    return value;
  }
  Value remove(ListCell& list, std::uint32_t position);
  ListCell* copy(const ListCell& list);             // and all nested lists, sharing and cycles preserved; no recursion
  void resize(ListCell& list, std::uint32_t size);  // shrink, or grow with NULL values
  void reserve(ListCell& list, std::uint32_t capacity);  // room for that many elements in all

  // --- hashes --------------------------------------------------------------------------------------------------------
  const Value* find(const HashCell& hash, const Value& key) const;  // null if absent
  void set(HashCell& hash, const Value& key, const Value& value);
  bool remove(HashCell& hash, const Value& key, Value& removed);  // false if absent
  ListCell* keys(const HashCell& hash);                           // in order of insertion

  // --- collection ----------------------------------------------------------------------------------------------------
  /// Safe point inside running code: true when so many zero-count cells wait, or so many bytes were taken, that
  /// `reclaim` is worth its cost.
  bool wants_reclaim() const { return wants_reclaim_; }
  /// Free the waiting cells that no frame refers to. Runs `destroy` of unreachable auto-free instances, in the order
  /// in which they were made.
  void reclaim();
  /// End of an iteration: reclaim all, then one bounded slice of the cycle collector.
  void end_of_iteration();

  /// For what is built outside the heap and could become large: are so many bytes to be had now?
  /// @throws std::bad_alloc if not, RunError{Bounds} if no string can be so long
  void check_room(std::size_t bytes) const;

  /// Bytes of strings and lists that were written or moved since this was asked last. When they are many, the
  /// budget looks in at the next loop iteration.
  std::uint64_t take_moved() { return std::exchange(moved_, 0); }
  /// @param settle  charges what take_moved() gives; it throws where the budget is used up
  void set_budget(Budget* budget, std::function<void()> settle) {
    budget_ = budget;
    settle_ = std::move(settle);
  }
  /// @param ended  true: no more garbage is to be freed now than is begun; the rest waits for the next safe point. It
  ///               outlives the heap
  void set_ended(const std::atomic<bool>* ended) { ended_ = ended; }
  /// In the middle of long work, where memory may also run out: count so many bytes, and settle when they are many.
  void work_on(std::size_t bytes) {
    constexpr std::uint64_t kMany = 1 << 20;
    moved_ += bytes;
    if (moved_ >= kMany && settle_) settle_();
  }

  std::uint64_t next_serial() { return ++serial_; }
  std::uint64_t live_cells() const { return cells_; }
  std::pmr::memory_resource* memory() const { return memory_; }

  // --- snapshots -----------------------------------------------------------------------------------------------------

  // A snapshot writes the cells in the order of containers() (garbage not yet collected included), then those of
  // waiting() that are not containers, then save_state. Restoring makes the containers in the same order in an empty
  // heap, gives them their serials and contents (retaining), and calls load_state last: the restored heap then collects
  // at the same iterations and safe points as the saved one.

  /// Every list, hash and instance, in the order of the collector's table.
  std::span<Container* const> containers() const { return containers_; }
  /// Every cell whose count is or was 0 and that waits for `reclaim`; may be of any type.
  std::span<Cell* const> waiting() const { return zero_; }
  /// @param number  the number under which the snapshot wrote a cell
  void save_state(ByteWriter& out, const std::function<std::uint64_t(const Cell*)>& number) const;
  /// @param cell  the cell with that number; throws Error{Image} for a number that was never written
  /// @throws Error{Image} if the state cannot be that of this heap
  void load_state(ByteReader& in, const std::function<Cell*(std::uint64_t)>& cell);

 private:
  void move_bytes(std::size_t bytes) {
    constexpr std::uint64_t kMany = 1 << 16;
    moved_ += bytes;
    if (moved_ >= kMany && budget_ != nullptr) budget_->hold();
  }

  bool ended() const { return ended_ && ended_->load(std::memory_order_relaxed); }

  std::uint64_t moved_ = 0;
  Budget* budget_ = nullptr;
  const std::atomic<bool>* ended_ = nullptr;
  std::function<void()> settle_;

  // Each phase passes over containers_ once; places before passed_ have been passed. New cells of a running collection
  // are black and come last.
  //   Mark:     roots are looked for and become grey; grey cells are scanned and become black
  //   Examine:  white instances with auto-free are noted to be destroyed, and become grey
  //   Remark:   grey cells are scanned: all that a destroy method can reach stays
  //   Sweep:    white cells are taken apart; all cells passed are white again
  // Idle: all cells are white.
  enum class Phase : std::uint8_t { Idle, Mark, Examine, Remark, Sweep };
  // Marks of places, a byte each, so that passes over the table read little. Which of the two colours is white changes
  // with each collection: what was found alive is white again without being touched.
  static constexpr std::uint8_t kOther = 1;   // a list or hash
  static constexpr std::uint8_t kColour = 2;  // one of the two: white_ says which
  static constexpr std::uint8_t kGrey = 4;
  static constexpr std::uint8_t kInert = 8;  // an instance that can refer to nothing: in no cycle, of no colour
  bool is_white(std::uint32_t slot) const { return (marks_[slot] & ~kOther) == white_; }
  void blacken(std::uint32_t slot) {
    marks_[slot] = static_cast<std::uint8_t>((marks_[slot] & kOther) | (white_ ^ kColour));
  }
  class Marker;
  struct FreeSlot {
    FreeSlot* next;
  };
  struct alignas(16) Chunk {
    Chunk* next;
    std::size_t bytes;
  };
  struct alignas(16) Single {  // stands before a cell that is not in a size class
    Single* previous;
    Single* next;
    std::size_t bytes;
  };
  static constexpr std::size_t kUnit = 16;                // bytes; size classes are multiples
  static constexpr std::size_t kClasses = 32;             // up to 512 bytes
  static constexpr std::size_t kReclaimBytes = 8U << 20;  // a few long strings are much garbage
  static constexpr std::size_t kMostSuspects = 16384;
  static constexpr std::size_t kReclaimAt = 1024;  // so little garbage that it is still in the cache when it goes

  // heap.cpp
  void* take(std::size_t bytes);
  void* take_single(std::size_t bytes);
  void give(void* memory, std::size_t bytes);
  void give_single(void* memory);
  void* carve(std::size_t units);
  void reserve_tables(bool container);
  template <class T>
  T* enter(T* cell);
  StringCell* raw_string(std::size_t size);
  SharedText* make_text(std::string_view begin, std::size_t capacity);
  StringCell* share(SharedText* text, std::string_view more);
  void leave_text(SharedText* text);
  void note_fresh(std::size_t bytes) {
    fresh_bytes_ += bytes;
    if (fresh_bytes_ >= kReclaimBytes) wants_reclaim_ = true;
  }
  void enlist(Cell* cell) {
    cell->listed = true;
    zero_.push_back(cell);  // never grows: reserve_tables keeps room for every cell
    if (zero_.size() >= reclaim_at_) [[unlikely]]
      wants_reclaim_ = true;
  }
  void destroy(Cell* cell);
  void release_children(Container& cell);
  // A list or hash that only the table of suspects and no frame refers to; its elements can go before it does.
  static bool is_lonely(const Cell& cell) {
    return cell.suspected && cell.count == 1 && cell.mark == 0 && (cell.tag == Tag::List || cell.tag == Tag::Hash);
  }
  // What garbage refers to is looked at in the same round, also where it is held as a suspect: a chain of suspects,
  // each of which holds the next one, would cost a look at all of them for each.
  void release_of_garbage(Cell* cell) {
    release(cell);
    if (cell && !cell->listed && is_lonely(*cell)) enlist(cell);
  }
  void release_of_garbage(const Value& value) {
    if (value.is_reference()) release_of_garbage(value.ref);
  }
  void free_arrays(Container& cell);
  bool reclaim_round();  // true if a destroy method may have run
  void reclaim_all();
  void doom_waiting(std::size_t kept);
  bool free_doomed();

  // collector.cpp
  void note_survivor(Container* cell) {
    if (!cell->suspected && (cell->tag != Tag::Object || static_cast<Instance*>(cell)->auto_free)) suspect(*cell);
  }
  static bool may_close_cycle(const Container& cell);
  static bool leads_on(const Container& cell, int levels, int& looks);
  void move_slot(std::uint32_t from, std::uint32_t to);
  void enrol(Container& cell);
  static std::uint8_t new_mark(const Container& cell, int colour);
  void strike(Container& cell);
  void begin_collection();
  std::int64_t slice() const;
  void examine(std::int64_t& work);
  void doom_condemned();
  void free_dying();
  void sweep(std::int64_t& work);
  bool is_swept_later(const Cell& cell) const;
  bool take_apart(Container& cell, std::int64_t& work);
  bool shed(ListCell& list, std::int64_t& work);
  bool shed(HashCell& hash, std::int64_t& work);

  // marking.cpp
  void shade(Cell* cell);
  void shade_slot(std::uint32_t slot);
  void push_grey(std::uint32_t slot);
  std::uint32_t next_slot(std::uint32_t from, std::uint32_t to, std::uint8_t mask, std::uint8_t mark) const;
  std::uint32_t count_white() const;
  bool pass_to(std::uint8_t kinds, std::int64_t& work);
  void mark(std::int64_t& work);
  void fetch_slot_ahead() const;
  void end_of_marking();
  bool find_left_grey();
  /// Before the elements of a half-scanned list or hash move: finish scanning it.
  void settle(const Container& cell) {
    if (partial_ == &cell) [[unlikely]]
      finish_partial();
  }
  void finish_partial();

  // suspects.cpp
  class Region;
  void suspect(Container& cell);
  bool drop_lonely_suspects();  // true if there were any
  void judge_suspects();
  void drop_suspects();
  void judge_region(Region& region);
  void judge_far_suspects(Region& region);
  void condemn(Region& region);
  void break_up(const Region& region);

  // heap_state.cpp
  void save_marks(ByteWriter& out) const;
  void load_marks(ByteReader& in);

  // lists.cpp, hashes.cpp
  void free_store(ListCell& list);
  void move_store(ListCell& list, std::uint32_t capacity, std::uint32_t first);
  void make_room_behind(ListCell& list);
  void make_room_before(ListCell& list);
  void push_slowly(ListCell& list, const Value& value);
  void fit(ListCell& list, Tag tag);
  void widen(ListCell& list);
  static void put(ListCell& list, std::uint32_t position, const Value& value);
  void regrow(HashCell& hash);

  std::pmr::memory_resource* memory_;
  RootSource& roots_;
  std::array<FreeSlot*, kClasses + 1> free_{};
  Chunk* chunks_ = nullptr;
  std::array<std::size_t, kClasses + 1> chunk_bytes_{};
  Single* singles_ = nullptr;
  SharedText* texts_ = nullptr;

  std::pmr::vector<Cell*> zero_;
  std::pmr::vector<Container*> containers_;
  std::pmr::vector<std::uint8_t> marks_;   // by place
  std::pmr::vector<std::uint32_t> grey_;   // a stack of places where grey cells stood when they became grey
  std::pmr::vector<Instance*> doomed_;     // in no cycle, to be destroyed now
  std::pmr::vector<Instance*> condemned_;  // in cycles, to be dying when all are found
  std::pmr::vector<Container*> suspects_;  // to be judged at the end of the iteration; each counts as a reference
  std::size_t reclaim_at_ = kReclaimAt;
  std::size_t fresh_bytes_ = 0;  // taken for strings since the last reclaim
  bool wants_reclaim_ = false;   // one of the two has reached its limit
  std::uint64_t serial_ = 0x1000;
  std::uint64_t cells_ = 0;
  bool freeing_doomed_ = false;

  Phase phase_ = Phase::Idle;
  bool suspicion_ = false;        // since the last collection began, a suspect was left to it
  bool held_by_frames_ = false;   // the last collection began while frames held something that can be in a cycle
  bool barrier_ = false;          // what loses a reference must be marked: Mark, Examine, Remark
  bool short_of_memory_ = false;  // not all that was to be done in this iteration could be noted
  std::uint8_t white_ = 0;        // or kColour
  std::uint8_t far_rest_ = 0;     // iterations in which far suspects are left to the collector at once
  std::uint8_t next_far_rest_ = 0;
  std::uint32_t passed_ = 0;
  Container* partial_ = nullptr;  // the list or hash whose scan, or taking apart, was cut by the end of a slice
  std::uint32_t position_ = 0;    // where: index into its store or entries

  /// An instance in a cycle, to be destroyed. Its serial number stands beside it: to sort must not wait for memory.
  struct Dying {
    std::uint64_t serial;
    Instance* instance;
  };
  std::pmr::vector<Dying> dying_;  // the last one goes first: a share in each iteration
  std::uint64_t share_ = 0;
  std::uint64_t slices_left_ = 0;  // for the running collection, this one included
  std::uint64_t white_left_ = 0;   // cells that are white yet, or a few more
};

/// Sort in place, stable: `before(a, b)` is true if a must come before b. Works on a copy of the elements, so that
/// `before` may run script, change the list, or throw (then the list stays as `before` left it). The elements are kept
/// alive meanwhile. A list that `before` has changed is replaced by the sorted elements.
using Before = std::function<bool(const Value&, const Value&)>;
void merge_sort(Heap& heap, ListCell& list, const Before& before);

}  // namespace breve::steve
