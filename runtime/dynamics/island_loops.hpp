// Joints that close loops: held closed by the stages of an integrator, by impulses at both ends of smooth motion, or by
// a projection of positions after it. Loops may be impossible to close: they then end as nearly closed as they can be.
#pragma once

#include "runtime/dynamics/island_books.hpp"
#include "runtime/dynamics/island_positions.hpp"
#include "runtime/dynamics/island_smooth.hpp"

namespace breve::island {

class Loops {
 public:
  Loops(State& state, Contacts& contacts, Rows& rows, Positions& positions, SmoothMotion& smooth, Momentum& momentum,
        Books& books)
      : state_(state),
        contacts_(contacts),
        rows_(rows),
        positions_(positions),
        smooth_(smooth),
        momentum_(momentum),
        books_(books) {}

  /// As a step begins: the gaps that scripts left are theirs until loops are closed, or come no closer.
  void see_whose_gaps();

  /// Schemes of order 4 and 5 hold loops inside their stages; others by hold(), a rule of order 2.
  bool in_stages() const;
  /// Smooth motion of h seconds that leaves the loops closed, where no other rows are.
  /// @return  false if none was found: near a position in which a loop may fold either way
  bool hold(double time, double h);
  /// Some loop stands open, by more than an integrator errs: it is still to be closed, or cannot be. Stages and hold()
  /// begin from closed loops; such loops are left to the rows.
  bool stand_open() const;
  /// They stand open, or stages took too long for them lately.
  bool left_to_rows() const;
  /// The stages take too long to hold them, as near a position in which loops can hardly move: they are left to the
  /// rows for some sub-steps.
  void leave_to_rows();
  /// Such a sub-step is over.
  void note_left();
  /// Closes them by hand, as far as they can be closed and something pays for it.
  /// @param by_rows  rows held them in this sub-step
  void close(bool by_rows);

 private:
  double read_errors();
  double errors_squared();
  /// Energy, J. The inner part of a body could grow by drawing it together even where nothing outside touches it.
  struct Stored {
    double inner = 0, all = 0;  // motion and springs; also gravity
    double springs = 0;         // alone
    double script = 0;          // the work of scripts' forces so far
  };
  Stored read_stored();
  /// Loops that are being closed, and the energy, J, that this may give.
  struct Closing {
    bool open = false;    // by more than an integrator errs
    bool theirs = false;  // as scripts left them, or stages that tore them
    Given rows;           // of what rows took before
    double motion = 0;    // of what motion pays for
    double free = 0;      // so little of that is not taken from it
  };
  Closing begin_closing(bool by_rows);
  double gap_of(const Tree& tree) const;
  bool touches() const;
  bool carries() const;
  bool approach(Closing& closing);
  bool pay_for_closing(const Stored& held, Closing& closing);
  bool pay_for_theirs(const Stored& held, const Stored& now);
  void close_velocities();

  State& state_;
  Contacts& contacts_;
  Rows& rows_;
  Positions& positions_;
  SmoothMotion& smooth_;
  Momentum& momentum_;
  Books& books_;
};

}  // namespace breve::island
