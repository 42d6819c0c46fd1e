// One sub-step of an island: a look at what is near, smooth motion with what goes on acting, the rows' solution, and
// the books of all that.
#pragma once

#include "runtime/dynamics/island_loops.hpp"
#include "runtime/dynamics/island_overlaps.hpp"
#include "runtime/dynamics/island_solve.hpp"

namespace breve::island {

class SubStep {
 public:
  SubStep(State& state, Contacts& contacts, ContactSprings& springs, SmoothMotion& smooth, Rows& rows, Books& books,
          Prediction& prediction, Solver& solver, Positions& positions, Loops& loops, Overlaps& overlaps)
      : state_(state),
        contacts_(contacts),
        springs_(springs),
        smooth_(smooth),
        rows_(rows),
        books_(books),
        prediction_(prediction),
        solver_(solver),
        positions_(positions),
        loops_(loops),
        overlaps_(overlaps) {}

  /// Finds out what is near, for h seconds.
  /// @param spent  no impact is located any more: rows are to stop whatever comes within them
  void look(double h, bool spent);
  /// Notes the state, to which State::restore() goes back, and what is taken to go on for h seconds.
  void open(double h);
  /// Moves the island from the state that was noted by h seconds, with its rows.
  void advance(double time, double h);
  /// It counts, with all that it did.
  /// @param part  s, that it was to take
  /// @param took  s, that it took: less where an event ended it
  void keep(double part, double took);
  /// Positions that rows could not hold, after h seconds that count.
  void put_right(double h);

 private:
  void leave_to_rows();
  bool move(double time, double h);
  void solve(double time, double h);
  void solve_moved(double time, double h);
  void solve_as_learned(double time, double h);
  void check_prediction(double time, double h);
  bool catch_bounds(double time, double h);
  void move_by_rows(double h);
  bool missed(double h);

  bool by_rows_ = false;  // the stages of this sub-step do not hold the loops: rows do

  State& state_;
  Contacts& contacts_;
  ContactSprings& springs_;
  SmoothMotion& smooth_;
  Rows& rows_;
  Books& books_;
  Prediction& prediction_;
  Solver& solver_;
  Positions& positions_;
  Loops& loops_;
  Overlaps& overlaps_;
};

}  // namespace breve::island
