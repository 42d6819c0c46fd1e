// The script heap of one world: deferred reference counts for what dies young, an incremental mark and sweep, bounded
// by counted work, for cycles. Frames are not counted: a cell whose count is 0 waits in a table until a safe point.
//
// Sources: Deutsch and Bobrow 1976 (deferred counting); Yuasa 1990 (snapshot-at-the-beginning marking).
#pragma once

#include <cstdint>
#include <functional>
#include <memory_resource>
#include <string_view>
#include <vector>

#include "steve/machine/cells.hpp"

namespace breve::steve {

/// Calls back for every reference that keeps something alive: table of objects, frames, pinned values.
class RootSource {
 public:
  virtual ~RootSource() = default;
  /// References held by running frames and natives (uncounted). Called at a safe point.
  virtual void visit_frames(const std::function<void(Cell*)>& visit) = 0;
  /// Instances that live until they are freed (those without auto-free), and pinned values (counted).
  virtual void visit_roots(const std::function<void(Cell*)>& visit) = 0;
  /// An auto-free instance that nothing refers to any more: run `destroy`, then free it as `free` would.
  virtual void free_unreachable(Instance& instance) = 0;
};

class Heap {
 public:
  Heap(std::pmr::memory_resource* memory, RootSource& roots);
  ~Heap();  // frees every cell; runs no script
  Heap(const Heap&) = delete;
  Heap& operator=(const Heap&) = delete;

  // --- making cells; each may throw std::bad_alloc, none collects ---------------------------------------------------
  StringCell* string(std::string_view bytes);  // null for the empty string
  StringCell* concat(std::string_view a, std::string_view b);
  MatrixCell* matrix(const Matrix3& m);
  ListCell* list(std::uint32_t capacity = 0);
  HashCell* hash();
  PointerCell* pointer(std::unique_ptr<NativePointer> native);
  DataCell* data(std::string_view bytes);
  Instance* instance(const ClassInfo& cls);  // slots zeroed, serial given, count 0

  // --- counted references ---------------------------------------------------------------------------------------------
  void retain(Cell* cell) {
    if (cell && !cell->immortal) ++cell->count;
  }
  void release(Cell* cell);  // the write barrier: call for every reference that a heap slot loses
  void retain(const Value& v) {
    if (v.is_reference()) retain(v.ref);
  }
  void release(const Value& v) {
    if (v.is_reference()) release(v.ref);
  }
  /// slot = value with counting, for slots inside cells.
  void store(Value& slot, const Value& value) {
    const Value old = slot;
    retain(value);
    slot = value;
    release(old);
  }
  void store(Slot& slot, Cell* ref) {
    Cell* old = slot.ref;
    retain(ref);
    slot.ref = ref;
    release(old);
  }
  /// Release every reference in the slots of an instance and zero them (what `free` does to variables).
  void clear_slots(Instance& instance);

  // --- lists; positions are checked by the caller -----------------------------------------------------------------------
  void push(ListCell& list, const Value& value);
  void prepend(ListCell& list, const Value& value);
  void insert(ListCell& list, std::uint32_t position, const Value& value);
  Value pop(ListCell& list);        // the list is not empty
  Value unprepend(ListCell& list);  // the list is not empty
  Value remove(ListCell& list, std::uint32_t position);
  ListCell* copy(const ListCell& list);  // and all nested lists, sharing and cycles preserved; no recursion
  void resize(ListCell& list, std::uint32_t size);  // shrink, or grow with NULL values

  // --- hashes -----------------------------------------------------------------------------------------------------------
  const Value* find(const HashCell& hash, const Value& key) const;  // null if absent
  void set(HashCell& hash, const Value& key, const Value& value);
  bool remove(HashCell& hash, const Value& key, Value& removed);  // false if absent
  ListCell* keys(const HashCell& hash);                           // in order of insertion

  // --- collection -------------------------------------------------------------------------------------------------------
  /// Safe point inside running code: true when so many zero-count cells wait that `reclaim` is worth its cost.
  bool wants_reclaim() const { return zero_.size() >= reclaim_at_; }
  /// Free the waiting cells that no frame refers to. Runs `destroy` of unreachable auto-free instances, in the order
  /// in which they were made.
  void reclaim();
  /// End of an iteration: reclaim all, then one bounded slice of the cycle collector.
  void end_of_iteration();

  std::uint64_t next_serial() { return ++serial_; }
  std::uint64_t live_cells() const { return cells_; }
  std::pmr::memory_resource* memory() const { return memory_; }

 private:
  std::pmr::memory_resource* memory_;
  RootSource& roots_;
  std::pmr::vector<Cell*> zero_;
  std::size_t reclaim_at_ = 65536;
  std::uint64_t serial_ = 0x1000;
  std::uint64_t cells_ = 0;
};

}  // namespace breve::steve
