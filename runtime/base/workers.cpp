// Tasks on oneTBB's threads.
#include "runtime/base/workers.hpp"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>

namespace breve {

/// One arena for each number of threads that was asked for.
struct Workers::Arenas {
  tbb::task_arena& of(int threads) {
    const std::lock_guard lock(mutex);
    return all.try_emplace(threads, threads).first->second;
  }
  std::mutex mutex;
  std::map<int, tbb::task_arena> all;
};

Workers::Workers() : arenas_(std::make_unique<Arenas>()) {}
Workers::~Workers() = default;

void Workers::run(int threads, std::size_t count, const std::function<void(std::size_t)>& task) {
  const auto do_all = [&] {
    for (std::size_t i = 0; i < count; ++i) task(i);
  };
  if (threads <= 1 || count <= 1) return do_all();
  threads = std::min(threads, tbb::info::default_concurrency());  // it would warn on stderr, and have no more
  if (threads <= 1) return do_all();
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
  arenas_->of(threads).execute([&] { tbb::parallel_for(std::size_t{0}, count, one); });
  (void)done.load(std::memory_order_acquire);
}

}  // namespace breve
