// Threads that share a list of tasks. oneTBB is seen in workers.cpp alone; its threads are the process's, so that many
// worlds do not start more of them than the machine has cores.
#pragma once

#include <functional>
#include <memory>
#include <memory_resource>
#include <mutex>

#include "runtime/base/memory.hpp"

namespace breve {

class Workers : public InMemory {
 public:
  Workers();
  ~Workers();

  /// Calls task(i) for every i below `count`, in any order, on up to `threads` threads, the caller's among them; what
  /// the caller did before is seen by the tasks, what these did by the caller after.
  /// @param task  must not throw, and must not touch what another task touches
  void run(int threads, std::size_t count, const std::function<void(std::size_t)>& task);

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;  // of the number of threads that was asked for last
};

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
