// Tasks on oneTBB's threads.
#include "runtime/dynamics/workers.hpp"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

namespace breve {

struct Workers::Arena {
  explicit Arena(int count) : threads(count), arena(count) {}
  int threads;
  tbb::task_arena arena;
};

Workers::Workers() = default;
Workers::~Workers() = default;

void Workers::run(int threads, std::size_t count, const std::function<void(std::size_t)>& task) {
  const auto do_all = [&] {
    for (std::size_t i = 0; i < count; ++i) task(i);
  };
  if (threads <= 1 || count <= 1) return do_all();
  threads = std::min(threads, tbb::info::default_concurrency());  // it would warn on stderr, and have no more
  if (threads <= 1) return do_all();
  if (!arena_ || arena_->threads != threads) arena_ = std::make_unique<Arena>(threads);
  // oneTBB orders what happens before and after a task by itself, but in a library that ThreadSanitizer does not see
  // into: these two say the same in code that it does.
  std::atomic<bool> begun{false};
  std::atomic<std::size_t> done{0};
  begun.store(true, std::memory_order_release);
  const auto one = [&](std::size_t i) {
    (void)begun.load(std::memory_order_acquire);
    task(i);
    done.fetch_add(1, std::memory_order_release);
  };
  arena_->arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, one); });
  (void)done.load(std::memory_order_acquire);
}

}  // namespace breve
