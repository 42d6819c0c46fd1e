// Interrupts the call that runs, and ends the process where one hangs. Time is that of the thread's processor: other
// processes may be busy.
#pragma once

#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <string>
#include <thread>

#include "breve/breve.h"

namespace breve::limits {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kBudget = 1000000;
constexpr std::size_t kMemory = std::size_t{256} << 20;
constexpr double kLongest = 0.2;           // s of processor time under that budget
constexpr double kLongestAfter = 0.05;     // s from an interrupt to the end of the call
constexpr double kBeforeInterrupt = 0.01;  // s
constexpr double kHangs = 60;              // s: the process ends with a message
constexpr int kTries = 3;                  // the least of so many counts: the machine may be busy

inline double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

inline double processor_time(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Watch {
 public:
  explicit Watch(bool interrupts) : interrupts_(interrupts), thread_([this] { watch(); }) {}
  ~Watch() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  /// @param waits  the call takes time and no processor
  void begin(breve_world* world, const std::string& name, bool waits) {
    const std::lock_guard lock(mutex_);
    world_ = world;
    waits_ = waits;
    pthread_getcpuclockid(pthread_self(), &processor_);
    name_ = name;
    began_ = Clock::now();
    interrupted_ = Clock::time_point();
    changed_.notify_all();
  }
  /// @return s since the first interrupt, of processor time unless the call waits; 0: there was none
  double end() {
    const std::lock_guard lock(mutex_);
    world_ = nullptr;
    if (interrupted_ == Clock::time_point()) return 0;
    return waits_ ? seconds(Clock::now() - interrupted_) : processor_time(processor_) - used_;
  }

 private:
  void watch() {
    std::unique_lock lock(mutex_);
    while (!ended_) {
      changed_.wait_for(lock, std::chrono::milliseconds(world_ ? 2 : 1000));
      if (!world_) continue;
      const double taken = seconds(Clock::now() - began_);
      if (interrupts_ && taken > kBeforeInterrupt) {
        if (interrupted_ == Clock::time_point()) {
          interrupted_ = Clock::now();
          used_ = processor_time(processor_);
        }
        breve_world_interrupt(world_);
      }
      if (taken > kHangs) {
        std::fprintf(stderr, "hangs: %s\n", name_.c_str());
        std::_Exit(1);
      }
    }
  }

  const bool interrupts_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
  breve_world* world_ = nullptr;
  std::string name_;
  Clock::time_point began_, interrupted_;
  clockid_t processor_ = CLOCK_THREAD_CPUTIME_ID;  // of the thread that calls
  double used_ = 0;                                // of it, at the interrupt
  bool waits_ = false;
  std::thread thread_;
};

}  // namespace breve::limits
