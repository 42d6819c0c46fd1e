// Work that is counted while it is done, so that it can be bounded at the same place on every machine.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

#include "runtime/base/error.hpp"

namespace breve {

/// How much work there may be, and who may end it early.
struct WorkBound {
  std::uint64_t most = 0;                    // units, see Meter; 0: no bound
  const std::atomic<bool>* ended = nullptr;  // true: nothing more is to be done at all. Outlives the work

  /// @throws  Error{Interrupted} if it is
  void poll() const {
    if (ended && ended->load(std::memory_order_relaxed)) throw Error(ErrorCode::Interrupted, "interrupted");
  }
};

/// One unit takes about as long as an iteration of a script's loop, some 30 ns: a row swept once, a facet looked at, a
/// sixteenth of a link's part in forward dynamics.
class Meter {
 public:
  static constexpr std::uint64_t kNoBound = std::numeric_limits<std::uint64_t>::max();

  void begin(std::uint64_t most, const std::atomic<bool>* ended) {
    done_ = 0;
    most_ = most;
    ended_ = ended;
  }
  /// What follows is counted, and not bounded.
  void open() {
    most_ = kNoBound;
    ended_ = nullptr;
  }
  void add(std::uint64_t units) { done_ += units; }
  std::uint64_t done() const { return done_; }
  const std::atomic<bool>* end() const { return ended_; }  // may be null
  bool ended() const { return ended_ && ended_->load(std::memory_order_relaxed); }
  /// No more is to be begun than has to be.
  bool over() const { return done_ >= most_ || ended(); }
  /// The same of what takes so much.
  bool over(std::uint64_t units) const { return over() || units > most_ - done_; }

 private:
  std::uint64_t done_ = 0, most_ = kNoBound;
  const std::atomic<bool>* ended_ = nullptr;
};

}  // namespace breve
