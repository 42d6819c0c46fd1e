// Counted memory: every container and heap object of a world takes its bytes here, so that a limit is a limit.
#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>
#include <new>
#include <utility>

namespace breve {

/// A memory resource that counts the bytes in use and refuses to go beyond a limit (std::bad_alloc).
class MemoryMeter final : public std::pmr::memory_resource {
 public:
  /// @param standing  bytes that were taken from `upstream` before there was a meter: the meter's own place, say
  explicit MemoryMeter(std::pmr::memory_resource* upstream = std::pmr::new_delete_resource(), std::size_t standing = 0)
      : upstream_(upstream), used_(standing), peak_(standing) {}

  std::size_t used() const { return used_; }
  std::size_t peak() const { return peak_; }
  std::size_t limit() const { return limit_; }
  void set_limit(std::size_t bytes) { limit_ = bytes; }  // 0: none

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    if (limit_ != 0 && (bytes > limit_ || used_ > limit_ - bytes)) throw std::bad_alloc();
    void* memory = upstream_->allocate(bytes, alignment);
    used_ += bytes;
    if (used_ > peak_) peak_ = used_;
    return memory;
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override {
    used_ -= bytes;
    upstream_->deallocate(memory, bytes, alignment);
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  std::pmr::memory_resource* upstream_;
  std::size_t used_;
  std::size_t peak_;
  std::size_t limit_ = 0;
};

/// A base for what is made one at a time, without a container: it takes its bytes from a memory resource and gives them
/// back there when it is deleted. `new T` without one takes them from the C++ allocator.
class InMemory {
 public:
  /// What an object of `bytes` bytes takes from its resource.
  static constexpr std::size_t taken(std::size_t bytes) { return bytes + sizeof(Head); }
  static void* operator new(std::size_t bytes, std::pmr::memory_resource* memory) {
    void* block = memory->allocate(taken(bytes), alignof(Head));
    return new (block) Head{memory, taken(bytes)} + 1;
  }
  static void* operator new(std::size_t bytes) { return operator new(bytes, std::pmr::new_delete_resource()); }
  static void operator delete(void* object) noexcept {
    if (object == nullptr) return;
    Head* head = static_cast<Head*>(object) - 1;
    head->memory->deallocate(head, head->bytes, alignof(Head));
  }
  static void operator delete(void* object, std::pmr::memory_resource*) noexcept { operator delete(object); }

 private:
  struct alignas(std::max_align_t) Head {
    std::pmr::memory_resource* memory;
    std::size_t bytes;
  };
};

/// A new T that derives from InMemory.
template <class T, class... Arguments>
std::unique_ptr<T> make_in(std::pmr::memory_resource* memory, Arguments&&... arguments) {
  return std::unique_ptr<T>(new (memory) T(std::forward<Arguments>(arguments)...));
}

}  // namespace breve
