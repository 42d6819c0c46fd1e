// Observers of the begin and end of each stage of the world's step. The world times its stages for the ledger of
// effects anyway; an observer gets the same two readings of the clock, so that what it tells agrees with the ledger.
#pragma once

#include <chrono>
#include <string_view>

#include "runtime/world/effects.hpp"

namespace breve {

class StageObserver {
 public:
  using Clock = std::chrono::steady_clock;
  virtual ~StageObserver() = default;
  /// @param stage  a literal, the same one each time: it ends with a zero byte, and its address may serve as its number
  virtual void stage_begins(std::string_view stage, Clock::time_point now) noexcept = 0;
  /// The stage that began last and has not ended yet ends, perhaps by an exception.
  virtual void stage_ends(Clock::time_point now) noexcept = 0;
};

/// Times a scope. Time is reported, never read by the simulation.
class StageScope {
 public:
  using Clock = StageObserver::Clock;
  /// A stage of an effect: its wall time is added to the effect's in any case.
  StageScope(Effect& effect, StageObserver* observer)
      : seconds_(&effect.seconds), observer_(observer), start_(Clock::now()) {
    if (observer_) observer_->stage_begins(effect.name, start_);
  }
  /// A stage that only an observer asks about.
  StageScope(std::string_view stage, StageObserver* observer) : observer_(observer) {
    if (observer_) observer_->stage_begins(stage, Clock::now());
  }
  ~StageScope() {
    if (!seconds_ && !observer_) return;
    const auto now = Clock::now();
    if (seconds_) *seconds_ += std::chrono::duration<double>(now - start_).count();
    if (observer_) observer_->stage_ends(now);
  }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  double* seconds_ = nullptr;
  StageObserver* observer_;
  Clock::time_point start_{};
};

}  // namespace breve
