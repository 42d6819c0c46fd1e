// The state as a step began, to which a step that went wrong returns, and the balance of energy since then.
#pragma once

#include <algorithm>
#include <cmath>

#include "runtime/dynamics/island_state.hpp"

namespace breve::island {

class Balance {
 public:
  explicit Balance(State& state);

  void keep_start();
  void back_to_start();
  /// Measures the energy as a try of the step begins, J.
  double open();
  /// A handler brought in that much, J.
  void add_handled(double energy) { handled_ += energy; }
  /// The energy that came in since the step began and that the energy ledger does not explain, J.
  double unexplained(double after) const;
  /// Enters into the ledger the part of the step's change in energy that it does not explain, of all and of each tree.
  /// @param turnover  set to the energy, J, of which the residual is to be a small part
  /// @return          the residual, J
  double close(double& turnover);
  /// When the step is over: contacts and limits give nothing, so what they are booked to have given, and what was lost
  /// without an explanation, are one.
  void settle();
  /// After close(): by how much the energy rose beyond works, whatever losses the ledger has besides, J.
  double risen() const { return risen_; }
  /// After close(): the energy of motion as the step began, and what motors and scripts gave or took since, J.
  double supplied() const { return opened_.kinetic + std::abs(works_); }
  /// After close(): one account lost far more than there was, and another gave it back.
  bool absurd() const { return absurd_; }

 private:
  struct ResultStart {
    DynamicsCounters counters;
    Energy ledger;
    std::size_t impacts = 0;
  };
  struct Stored {  // J
    double kinetic = 0, height = 0, springs = 0;
    double total() const { return kinetic + height + springs; }
  };
  Stored measure(bool start);
  bool goes_astray(double lost, double most) const;

  State& state_;
  ResultStart start_;
  std::pmr::vector<FreeBody> free_start_;
  std::pmr::vector<NearPair> pair_start_;
  Stored opened_;
  double handled_ = 0;  // J
  double risen_ = 0;    // J
  double works_ = 0;    // J
  bool absurd_ = false;
};

/// The energy that contacts may give back by lifting links out of overlaps. A solver that is not exact lets links sink
/// into what they rest on, and contacts take what that gives. They may give it back, but not at once what they took
/// over a long time: each tree has an amount that grows by what contacts and limits take and falls by what they give,
/// and that never exceeds a small part of the largest energy with which the tree has moved. Its energy together with
/// this amount does not rise, so that its energy alone rises by that part at most.
class Credit {
 public:
  explicit Credit(State& state) : state_(state) {}

  /// As a try of a step begins.
  void begin_try() {
    most_ = left_ = 0;
    for (const Tree* tree : state_.trees) {
      most_ += most_of(*tree);
      left_ += tree->credit;
    }
    lost_ = lost();
  }

  /// J, that is left by now.
  double left() {
    const double now = lost();
    left_ = std::clamp(left_ + now - lost_, 0.0, most_);
    lost_ = now;
    return left_;
  }

  /// After the step: each tree keeps its part of what is left.
  void keep() {
    const double part = most_ > 0 ? left() / most_ : 0;
    for (Tree* tree : state_.trees) tree->credit = part * most_of(*tree);
  }

 private:
  static double most_of(const Tree& tree) {
    constexpr double kPart = 0.005;  // of the largest energy of motion
    return kPart * tree.fastest;
  }

  /// J, in contacts and limits so far.
  double lost() const {
    const Energy& ledger = state_.result.ledger;
    return ledger.contact_loss + ledger.friction_loss + ledger.limit_loss;
  }

  State& state_;
  double most_ = 0, left_ = 0;  // J
  double lost_ = 0;             // J, when left_ was as it is
};

/// What left by contacts, friction, drag and limits between two states of a ledger, J.
double losses(const Energy& now, const Energy& then);

}  // namespace breve::island
