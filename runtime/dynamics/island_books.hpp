// The books of a sub-step whose rows are solved at its end. They take forces as constant: works by the mean of
// velocities are of second order only. What rows did in fact is known all the same, since smooth motion is measured by
// itself: it is what the energy changed by after that. Contacts and limits give nothing: what the solution gave is
// taken back from the motion of links among one another.
#pragma once

#include <optional>

#include "runtime/dynamics/island_momentum.hpp"
#include "runtime/dynamics/island_springs.hpp"

namespace breve::island {

class Books {
 public:
  Books(State& state, Contacts& contacts, ContactSprings& springs, Rows& rows, Momentum& momentum)
      : state_(state), contacts_(contacts), springs_(springs), rows_(rows), momentum_(momentum) {}

  void begin_try() { gained_ = unpaid_ = lent_ = erred_ = 0; }
  void open();
  bool kept() const { return kept_; }  // open() found rows to come
  void note_smooth(double free_works);
  void note_solved();
  void close();
  void settle_motors(double h);
  void settle_pushes(double pushed);
  /// J, that contacts of free bodies did because the bodies rotated: of order 1 of the sub-step. It is in the ledger,
  /// and finer sub-steps make it smaller.
  double rotated() const { return state_.trees.empty() ? rows_.rotated() : 0; }
  double pressed() const { return rows_.pressed(); }
  /// J, that contacts and limits gave and no motion has repaid yet.
  double owed() const { return debt() + unpaid_; }
  double debt() const;  // of that, from earlier steps
  void take_back_rest(bool undone);
  // For a sub-step whose loops are left to the rows. Motion that loops do not bend, and gaps that are closed by hand,
  // err by the square of the sub-step's length: the energy gained by that is taken from what moves.
  void note_start();                         // where the sub-step begins
  void take_gain();                          // after positions were put right
  double gained() const { return gained_; }  // J, that contacts and limits gave in this try of the step, but for little

  // Energies of the sub-step, J.
  /// After smooth motion, in an island with bodies on springs and without joints; else nothing.
  std::optional<double> smooth_stored() const { return sprung_ ? std::optional(smooth_stored_) : std::nullopt; }
  double kinetic() const { return sub_start_.kinetic; }
  /// What the rows of the sub-step took from trees so far, with all that was done to positions since.
  double taken();
  /// Of that, and of what rows of loops took in a sub-step without others, what closing loops by hand may give back.
  /// @param by_rows  rows hold the loops in this sub-step
  Given payable(bool by_rows);
  double smooth_kinetic() const { return sub_start_.smooth_kinetic; }
  double predicted() const { return sub_start_.predicted; }
  void set_predicted(double energy) { sub_start_.predicted = energy; }

 private:
  void close_networks();
  double pay(double given, double most);
  bool only_motors() const;  // of rows that do work
  double most_work_of(Tree& tree, double h, std::size_t& next) const;
  double most_work_of(const Tree* tree) const;

  State& state_;
  Contacts& contacts_;
  ContactSprings& springs_;
  Rows& rows_;
  Momentum& momentum_;
  SubStepEnergy sub_start_;   // of all
  double smooth_stored_ = 0;  // J, of clusters, or of all if springs connect bodies without joints, after smooth motion
  double smooth_all_ = 0;     // J, of all after smooth motion, in an island with closed loops
  double smooth_done_ = 0;    // J, that motors and scripts' forces worked until then
  double stored_ = 0;         // J, where note_start() was called
  Energy ledger_;             // likewise
  bool kept_ = false;
  bool sprung_ = false;  // open() found rows to come for bodies on springs, in an island without joints
  double gained_ = 0, unpaid_ = 0;
  // Of bodies on springs in this step, J: what contacts gave, and what smooth motion erred by, less what motion paid.
  double lent_ = 0, erred_ = 0;
  double smooth_works_ = 0;  // J, of smooth motion, less its losses
};

}  // namespace breve::island
