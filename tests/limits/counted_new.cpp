// All forms of operator new and delete, over malloc, with a head in front that remembers the size.
#include "counted_new.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace limits {

namespace {

// Atomic, since workers also allocate; the n-th allocation is the same one only without them.
struct Counts {
  std::atomic<std::size_t> blocks = 0, bytes = 0;
};
Counts by_new, by_allocator;
std::atomic<std::uint64_t> asked = 0, failing = 0;
std::atomic<bool> has_failed = false, was_nothrow = false;

bool fails(bool nothrow) {
  if (++asked != failing) return false;
  has_failed = true;
  was_nothrow = nothrow;
  return true;
}

struct Head {
  void* block;
  std::size_t size;
};

void* get(Counts& counts, std::size_t size, std::size_t alignment, bool nothrow) {
  if (fails(nothrow)) return nullptr;
  alignment = std::max(alignment, alignof(std::max_align_t));
  char* block = static_cast<char*>(std::malloc(size + sizeof(Head) + alignment));
  if (block == nullptr) return nullptr;
  const auto address = reinterpret_cast<std::uintptr_t>(block) + sizeof(Head) + alignment - 1;
  char* memory = block + (address / alignment * alignment - reinterpret_cast<std::uintptr_t>(block));
  new (memory - sizeof(Head)) Head{block, size};
  ++counts.blocks;
  counts.bytes += size;
  return memory;
}

void give(Counts& counts, void* memory) {
  if (memory == nullptr) return;
  const Head head = *reinterpret_cast<Head*>(static_cast<char*>(memory) - sizeof(Head));
  --counts.blocks;
  counts.bytes -= head.size;
  std::free(head.block);
}

void* get_or_throw(std::size_t size, std::size_t alignment) {
  if (void* memory = get(by_new, size, alignment, false)) return memory;
  throw std::bad_alloc();
}

}  // namespace

std::size_t live_blocks() { return by_new.blocks; }
std::size_t live_bytes() { return by_new.bytes; }
std::size_t given_blocks() { return by_allocator.blocks; }
std::size_t given_bytes() { return by_allocator.bytes; }

void fail_allocation(std::uint64_t n) {
  asked = 0;
  failing = n;
  has_failed = false;
  was_nothrow = false;
}
std::uint64_t allocations() { return asked; }
bool failed() { return has_failed; }
bool failed_nothrow() { return was_nothrow; }

breve_runtime_config counted_config() {
  breve_runtime_config config = breve_runtime_config_default();
  config.allocate = [](void*, std::size_t size, std::size_t alignment) {
    return get(by_allocator, size, alignment, false);
  };
  config.release = [](void*, void* memory, std::size_t, std::size_t) { give(by_allocator, memory); };
  return config;
}

}  // namespace limits

using namespace limits;

void* operator new(std::size_t size) { return get_or_throw(size, 0); }
void* operator new[](std::size_t size) { return get_or_throw(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return get_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return get_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return get(by_new, size, 0, true); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return get(by_new, size, 0, true); }
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return get(by_new, size, static_cast<std::size_t>(alignment), true);
}
void* operator new[](std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return get(by_new, size, static_cast<std::size_t>(alignment), true);
}
void operator delete(void* memory) noexcept { give(by_new, memory); }
void operator delete[](void* memory) noexcept { give(by_new, memory); }
void operator delete(void* memory, std::size_t) noexcept { give(by_new, memory); }
void operator delete[](void* memory, std::size_t) noexcept { give(by_new, memory); }
void operator delete(void* memory, std::align_val_t) noexcept { give(by_new, memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { give(by_new, memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { give(by_new, memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { give(by_new, memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { give(by_new, memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { give(by_new, memory); }
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept { give(by_new, memory); }
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept { give(by_new, memory); }
