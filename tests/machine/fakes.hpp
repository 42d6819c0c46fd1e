// A heap without a machine: frames and roots are lists of cells, destroying an instance is noted.
#pragma once

#include <functional>
#include <memory_resource>
#include <vector>

#include "runtime/base/memory.hpp"
#include "steve/code/program.hpp"
#include "steve/machine/heap.hpp"

namespace breve::steve::testing {

/// Iterations after which a cycle is gone at the latest, by the number of live objects: what docs/limits.md promises.
inline std::uint64_t bound(std::uint64_t live) { return (live + 19'999) / 20'000 + 2; }

struct FakeRoots : RootSource {
  std::vector<Cell*> frames;
  std::vector<Cell*> roots;
  std::vector<std::uint64_t> destroyed;  // serial numbers, in the order of destruction
  std::function<void(Instance&)> on_destroy;
  Heap* heap = nullptr;

  void visit_frames(const std::function<void(Cell*)>& visit) override {
    for (Cell* cell : frames) visit(cell);
  }
  void visit_roots(const std::function<void(Cell*)>& visit) override {
    for (Cell* cell : roots) visit(cell);
  }
  void free_unreachable(Instance& instance) override {
    destroyed.push_back(instance.serial);
    instance.state = Instance::State::BeingFreed;
    if (on_destroy) on_destroy(instance);
    heap->clear_slots(instance);
    instance.state = Instance::State::Freed;
  }
};

/// Refuses the n-th allocation, counted from when it is armed.
class FailingMemory final : public std::pmr::memory_resource {
 public:
  long fail_at = -1;  // < 0: never
  std::size_t used = 0;
  std::size_t given = 0;  // in all

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    if (fail_at >= 0 && fail_at-- == 0) throw std::bad_alloc();
    used += bytes;
    given += bytes;
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override {
    used -= bytes;
    std::pmr::new_delete_resource()->deallocate(memory, bytes, alignment);
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }
};

/// A class whose instances have `count` slots, all of them references.
inline ClassInfo reference_class(std::uint16_t count) {
  ClassInfo cls;
  cls.name = "Node";
  cls.slot_count = count;
  for (std::uint16_t i = 0; i < count; ++i) cls.reference_slots.push_back(i);
  return cls;
}

struct World {  // a heap with its memory and its roots
  FailingMemory memory;
  FakeRoots roots;
  Heap heap{&memory, roots};
  World() { roots.heap = &heap; }

  Value list() { return Value::of(Tag::List, heap.list()); }
  Value string(std::string_view text) { return Value::of(Tag::String, heap.string(text)); }
  /// A live instance in the table of objects, as the machine makes them.
  Instance* object(const ClassInfo& cls) {
    Instance* instance = heap.instance(cls);
    heap.retain(instance);
    return instance;
  }
  Instance* auto_object(const ClassInfo& cls) {
    Instance* instance = heap.instance(cls);
    instance->auto_free = true;
    return instance;
  }
};

inline Value number(std::int32_t i) { return Value::of(i); }
inline Value number(double d) { return Value::of(d); }

}  // namespace breve::steve::testing
