// How much script may still run. Loop iterations, calls and new objects are counted and nothing else, so that a cut
// falls at the same iteration on every machine, in every build, and whatever instructions are merged.
#pragma once

#include <algorithm>
#include <cstdint>

namespace breve::steve {

/// Two limits at once: of the run (an iteration, or a call by the host) and, inside of it, of one call by the world.
/// They are counted down in pieces, so that the interpreter looks at one number.
class Budget {
 public:
  /// One more loop iteration. True: the piece is at its end, and next_piece is to be asked.
  bool count_iteration() { return --piece_ == 0; }
  /// False: there is nothing left, now and at every later iteration.
  bool next_piece() {
    piece_ = std::min({kPiece, run_, call_});
    run_ -= piece_;
    call_ -= piece_;
    if (piece_ != 0) return true;
    piece_ = 1;
    return false;
  }
  /// Look in again at the very next iteration.
  void hold() {
    give_back();
    piece_ = 1;
  }
  /// Many loop iterations at once, for the work of native code. False as next_piece.
  bool charge(std::uint64_t iterations) {
    give_back();
    const std::uint64_t used = std::min({iterations, run_, call_});
    run_ -= used;
    call_ -= used;
    return next_piece();
  }
  /// Would `charge` say true?
  bool affords(std::uint64_t iterations) const { return iterations < std::min(run_, call_) + piece_; }
  /// @param turns  iterations that are allowed; 0: without limit
  void begin_run(std::uint64_t iterations) {
    run_ = limit(iterations);
    call_ = kUnlimited;
    next_piece();
  }
  /// Is it the run, and not the call alone, that has nothing left?
  bool run_is_used_up() const { return run_ + piece_ <= 1; }

  /// A call by the world, with a limit of its own; what it uses is the run's as well, and not the outer call's.
  class Call {
   public:
    Call(Budget& budget, std::uint64_t iterations) : budget_(budget), outer_((budget.give_back(), budget.call_)) {
      budget_.call_ = limit(iterations);
      budget_.next_piece();
    }
    ~Call() {
      budget_.give_back();
      budget_.call_ = outer_;
      budget_.next_piece();
    }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

   private:
    Budget& budget_;
    const std::uint64_t outer_;
  };

 private:
  static constexpr std::uint64_t kPiece = 1 << 16;  // iterations: less than a millisecond, to see an interrupt
  static constexpr std::uint64_t kUnlimited = std::uint64_t{1} << 62;
  // The iteration after the last one that is allowed is the one that fails.
  static std::uint64_t limit(std::uint64_t iterations) {
    return iterations == 0 || iterations >= kUnlimited ? kUnlimited : iterations + 1;
  }
  void give_back() {
    run_ += piece_;
    call_ += piece_;
    piece_ = 0;
  }

  std::uint64_t piece_ = 1;
  std::uint64_t run_ = kUnlimited;   // behind this piece
  std::uint64_t call_ = kUnlimited;  // likewise
};

}  // namespace breve::steve
