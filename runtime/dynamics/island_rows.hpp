// The rows of an island for the contact solver, and what each belongs to. The solver takes flat arrays; that the n-th
// row is the n-th touch's, and which scalar row is which limit's, motor's or loop's, is known here and nowhere else.
#pragma once

#include <array>

#include "runtime/contact/solver.hpp"
#include "runtime/dynamics/carried_point.hpp"
#include "runtime/dynamics/island_contacts.hpp"

namespace breve::island {

inline constexpr double kStrong = 2;  // times the speed that gravity adds: a force that is stronger bends paths

/// A motor as a scalar row: one number of its tree's velocity, and the most that it may push with.
struct MotorRow {
  Tree* tree;
  JointIndex joint;
  int axis;         // of the joint's numbers
  int velocity;     // of the tree's numbers
  int shared;       // rows that share the limit: this and those that follow it; 0: one of those
  double strength;  // N or N*m
};

class Rows {
 public:
  Rows(State& state, Contacts& contacts);

  void begin();  // of a step: the movers
  void clear();
  enum class Motors : bool { Leave, Drive };
  /// One row for each touch and for each bound that rests, for motors if they are to drive, and for loops: where the
  /// island stands, whose links are placed.
  void make(Motors motors);
  /// The row of one limit and nothing else.
  void make_only(std::size_t bound);

  // --- each row with what belongs to it
  struct ContactRow {
    Touch& touch;
    NearPair& pair;
    contact::Row& row;
    const contact::Law& law;
  };
  /// How far a loop stands open along a row, and in what.
  struct LoopError {
    double open;  // rad or m
    double unit;  // 1 rad, or the world's length unit
    double units() const { return open / unit; }
  };
  struct LimitRow {
    Bound& bound;
    contact::ScalarRow& row;
  };
  struct DrivenRow {
    const MotorRow& motor;
    contact::ScalarRow& row;
  };
  std::size_t contacts() const { return rows_.size(); }
  std::size_t limits() const { return limits_.size(); }
  std::size_t motors() const { return motors_.size(); }
  std::size_t loops() const { return loop_errors_.size(); }
  ContactRow contact(std::size_t i);
  LimitRow limit(std::size_t i) { return {contacts_.bounds()[limits_[i]], scalars_[i]}; }
  DrivenRow motor(std::size_t i) { return {motors_[i], scalars_[limits_.size() + i]}; }
  contact::ScalarRow& loop(std::size_t i) { return scalars_[limits_.size() + motors_.size() + i]; }
  LoopError& loop_error(std::size_t i) { return loop_errors_[i]; }
  NearPair& pair_of(const contact::Row& row) const { return *state_.pairs[static_cast<std::size_t>(row.pair)]; }

  // --- as the solver takes them: scalar rows are those of limits, then of motors, then of loops
  std::span<contact::Mover> movers() { return movers_; }
  std::span<contact::Row> rows() { return rows_; }
  std::span<const contact::Row> rows() const { return rows_; }
  std::span<contact::ScalarRow> scalars() { return scalars_; }
  std::span<const contact::ScalarRow> scalars() const { return scalars_; }
  std::span<const contact::Law> laws() const { return laws_; }
  bool empty() const { return rows_.empty() && scalars_.empty(); }
  /// Some contact gave an impulse.
  bool push() const;
  bool is_motor(std::size_t scalar) const { return scalar - limits_.size() < motors_.size(); }
  /// Holds what was solved last, to be solved again with other biases: by Positions, for the rows as they are.
  contact::Workspace& workspace() { return workspace_; }

  Vector3 arm_change(const Touch& touch, bool first, const Free& body, double h) const;
  double gap_now(const Touch& touch) const;
  /// m/s, by which the solution parts bodies without joints.
  double normal_change(std::size_t contact) const;
  /// Something stronger than gravity, such as a spring, changed the approach of bodies in h seconds of smooth motion.
  /// Of links it is known until the rows are solved.
  bool unsteady(std::size_t contact, double h) const;

  // --- velocities at the rows
  void recall_rates();
  void read_rates();
  void note_starts(double h, double given);
  /// Of one side's point along the row's axes, from the movers' v as they are. A tree that touches itself is one side.
  Vector3 rate_of(const contact::Row& row, bool first) const;
  /// The same as the sub-step began: after recall_rates() or read_rates().
  const Vector3& before(std::size_t contact, bool first) const { return before_[contact][first ? 0 : 1]; }
  double rate_of(const contact::ScalarRow& row) const;
  double response(const contact::ScalarRow& row) const;  // of that rate to a unit impulse of the row

  // --- a solution
  void set_biases(double h);
  /// Forces at which the solution is to begin become impulses of h seconds.
  void set_length(double h);
  void begin_cold();  // contacts begin without
  /// The fastest relative motion at a contact, or that one asks for, m/s.
  double fastest() const;
  /// Whether something that a script moves gave way by much of what rows had to stop, m/s. Its rows are soft then, and
  /// all have neither impulses nor changed velocities: they are to be solved again.
  bool squeezed(double stopped);
  double length() const { return solved_h_; }  // s, of the sub-step that was solved last
  /// J, that rows gave beside the work of their impulses. After they were solved.
  void note_given(double given) { given_ += given; }
  void book();
  /// J, in this try of a step, by which the work of impulses is another along the velocities before(): bodies rotate
  /// meanwhile, by an angle that finer sub-steps make smaller.
  double rotated() const { return rotated_; }
  /// J, in this try of a step, that the impulses would give if each acted alone. What rests under opposite impulses has
  /// round-off of them.
  double pressed() const { return pressed_; }
  /// J, by which the work of motors on a tree (null: on all) may differ from what was booked: they pushed, in smooth
  /// motion and as rows, while the rate went from before() to what it is.
  double motor_doubt(const Tree* tree) const;
  void note_contact_forces(double h);
  void note_limit_forces(double h);
  /// The next solution begins with these impulses.
  /// @param h  s, that the impulses lasted; 0: an event cut the sub-step so short that they say nothing of forces
  void keep_warm(double h);

 private:
  double* numbers_of(const Tree& tree, int count);
  void respond(Tree& tree, const double* j, double* r) const;
  bool carries(const NearPair& pair, bool first) const;
  Vector3 taken(const Touch& touch, bool first) const;
  Meeting carried(const Touch& touch) const;
  contact::ScalarRow tree_row(const Tree& tree, const double* j, const double* r) const;
  void add_touch(Touch& touch);
  void add_limit(std::size_t index);
  void add_motors(Tree& tree);
  void add_loops(Tree& tree);
  double yield_of_drivers() const;
  double pressure() const;
  double swerve(std::size_t contact, bool first) const;
  bool turns_back(std::size_t contact, double h);

  State& state_;
  Contacts& contacts_;
  std::pmr::vector<contact::Mover> movers_;
  std::pmr::vector<contact::Row> rows_;               // of touches, in their order
  std::pmr::vector<contact::ScalarRow> scalars_;      // of limits_, then of motors_, then of loop_errors_
  std::pmr::vector<contact::Law> laws_;               // of rows_
  std::pmr::vector<std::array<Vector3, 2>> before_;   // of rows_, once rates were read
  std::pmr::vector<std::array<Vector3, 2>> started_;  // likewise, at the points that impulses push
  double yield_ = 0;                                  // 1/kg, softness of rows of what a script moves
  double given_ = 0;                                  // J, that rows gave beside the work of their impulses
  double rotated_ = 0, pressed_ = 0;                  // J, what rotated() and pressed() give
  std::pmr::vector<std::size_t> limits_;              // bounds that have a row
  std::pmr::vector<MotorRow> motors_;
  std::pmr::vector<LoopError> loop_errors_;
  std::pmr::vector<double> scalars_before_;  // of scalars_
  std::pmr::vector<double> numbers_;         // of Jacobians
  std::pmr::vector<double> before_force_;    // of rows_: N along the normal, in the last sub-step
  double solved_h_ = 0;
  contact::Workspace workspace_;
};

}  // namespace breve::island
