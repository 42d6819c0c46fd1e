// Threads that share a list of tasks. oneTBB is seen in workers.cpp alone; its threads are the process's, so that many
// worlds do not start more of them than the machine has cores.
#pragma once

#include <functional>
#include <memory>

namespace breve {

/// Worlds that are stepped by different threads may use the same workers at once.
class Workers {
 public:
  Workers();
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Calls task(i) for every i below `count`, in any order, on up to `threads` threads, the caller's among them. The
  /// tasks see what the caller did before, and the caller sees afterwards what the tasks did.
  /// @param task  must not throw, and must not touch what another task touches
  void run(int threads, std::size_t count, const std::function<void(std::size_t)>& task);

 private:
  struct Arenas;
  std::unique_ptr<Arenas> arenas_;
};

}  // namespace breve
