// Interrupts the call that runs, and ends the process where one hangs. Time is that of the thread's processor, and is
// compared with bounds that grow as far as other processes slow down this machine at the moment (peer.hpp).
#pragma once

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <string>
#include <thread>

#include "breve/breve.h"
#include "peer.hpp"

namespace breve::limits {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kBudget = 1000000;
constexpr std::size_t kMemory = std::size_t{256} << 20;
constexpr double kLongest = 0.2;           // s of processor time of an idle machine, under that budget
constexpr double kLongestAfter = 0.05;     // the same from an interrupt to the end of the call
constexpr double kBeforeInterrupt = 0.01;  // s
constexpr double kHangs = 60;              // s of processor time: the process ends with a message
constexpr int kTries = 3;                  // the least of so many counts: the machine may be busy
constexpr int kMostTries = 30;             // with those that say nothing

inline double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

/// The least time of several tries, until one is within the bound. What `time` gives is less than 0 if it does not
/// know.
template <class Time>
double least_of_tries(double bound, Time&& time) {
  double least = std::numeric_limits<double>::infinity();
  for (int tries = 0, known = 0; tries < kMostTries && known < kTries && least > bound; ++tries) {
    const double taken = time();
    if (taken < 0) continue;
    ++known;
    least = std::min(least, taken);
  }
  return least;
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
    used_before_ = processor_time(processor_);
    interrupted_ = Clock::time_point();
    changed_.notify_all();
  }
  /// @param used  of the thread that calls, from the beginning of the call to its end
  /// @return  s from the first interrupt to here on an idle machine, or of any clock if the call waits; 0: there was
  ///          none; less than 0: the system held up this watch while it interrupted, so that nobody knows
  double end(const Used& used) {
    const std::lock_guard lock(mutex_);
    world_ = nullptr;
    if (interrupted_ == Clock::time_point()) return 0;
    if (waits_) return seconds(Clock::now() - interrupted_);
    constexpr double kHeldUp = 0.001;  // s
    if (after_ - before_ > kHeldUp) return -1;
    const double late = processor_time() - before_;
    return late <= kLongestAfter ? late : Peer::idle(used, late);
  }

 private:
  void watch() {
    std::unique_lock lock(mutex_);
    while (!ended_) {
      changed_.wait_for(lock, std::chrono::milliseconds(world_ ? 2 : 1000));
      if (!world_) continue;
      const double taken = seconds(Clock::now() - began_);
      if (interrupts_ && taken > kBeforeInterrupt) {
        const bool first = interrupted_ == Clock::time_point();
        if (first) {
          interrupted_ = Clock::now();
          before_ = processor_time(processor_);
        }
        breve_world_interrupt(world_);
        if (first) after_ = processor_time(processor_);
      }
      if ((waits_ ? taken : processor_time(processor_) - used_before_) > kHangs) {
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
  double used_before_ = 0;                         // s of the processor, at the beginning
  clockid_t processor_ = CLOCK_THREAD_CPUTIME_ID;  // of the thread that calls
  double before_ = 0, after_ = 0;                  // of it, around the interrupt
  bool waits_ = false;
  std::thread thread_;
};

}  // namespace breve::limits
