// The state as a step began, to which a step that went wrong returns, and the balance of energy since then.
#pragma once

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
  /// After close(): by how much the energy rose beyond works, whatever losses the ledger has besides, J.
  double risen() const { return risen_; }
  /// After close(): the energy of motion as the step began, and what motors and scripts gave or took since, J.
  double supplied() const { return opened_.kinetic + std::abs(works_); }
  /// After close(): one account lost far more than there was, and another gave it back.
  bool absurd() const { return absurd_; }
  const Energy& start_ledger() const { return start_.ledger; }

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

/// What left by contacts, friction, drag and limits between two states of a ledger, J.
double losses(const Energy& now, const Energy& then);

}  // namespace breve::island
