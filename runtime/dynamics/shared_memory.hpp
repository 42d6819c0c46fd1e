// Memory for islands that several threads step at once.
#pragma once

#include <memory_resource>
#include <mutex>

namespace breve {

/// Memory that several threads take from in turn: the resource behind it is never asked by two at once.
class SharedMemory final : public std::pmr::memory_resource {
 public:
  explicit SharedMemory(std::pmr::memory_resource* upstream) : upstream_(upstream) {}

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    const std::lock_guard lock(mutex_);
    return upstream_->allocate(bytes, alignment);
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override {
    const std::lock_guard lock(mutex_);
    upstream_->deallocate(memory, bytes, alignment);
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  std::pmr::memory_resource* upstream_;
  std::mutex mutex_;
};

}  // namespace breve
