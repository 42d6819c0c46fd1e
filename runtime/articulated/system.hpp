// What an integrator needs to know of what it moves: x'' = f(x, v, t), where x may lie on a curved space.
#pragma once

#include <cstdint>

#include "runtime/articulated/vector.hpp"

namespace breve::articulated {

/// The kind of a coordinate, by which errors are judged: an error of 1e-6 means other things for a way and an angle.
enum class Kind : signed char {
  Angle,
  Length,
  Ledger  // what is integrated along, in units of lengths: nothing depends on it
};

/// One virtual call an evaluation of all coordinates, never one a joint.
class System {
 public:
  virtual ~System() = default;

  virtual int positions() const = 0;          // numbers in q
  virtual int velocities() const = 0;         // numbers in v and in tangents
  virtual Kind kind(int velocity) const = 0;  // of each tangent direction
  /// Along this tangent direction springs may pull, or other forces that go with the way.
  virtual bool sprung(int velocity) const { return kind(velocity) != Kind::Ledger; }

  /// a (nv): the acceleration at q, v, t. With `step` above 0 stiff internal forces may be treated as linearly implicit
  /// over a step of that length; a is then its mean acceleration.
  /// @throws Error{Numeric} if there is none
  virtual void acceleration(double t, const Vector& q, const Vector& v, double step, Vector& a) = 0;
  /// Which piece of forces that are smooth in pieces only the last acceleration was of.
  virtual std::uint64_t piece() const { return 0; }
  /// The work of the step is used up: step control gives up.
  virtual bool over() const { return false; }

  // A space that is flat needs no more. A curved one is moved along tangents d (nv) from a point.
  virtual void move(const Vector& q, const Vector& d, Vector& out) { out = q + d; }
  /// The rate of d in move(q, d(t)) where the velocity is v.
  virtual void rate_of_move(const Vector& d, const Vector& v, Vector& out) {
    static_cast<void>(d);
    out = v;
  }
  /// Replaces the rotations in d by Cayley's; see state.hpp.
  virtual void bend_to_cayley(Vector& d) { static_cast<void>(d); }
};

/// The state of a system in time. The step size of the scheme with step control is part of it: a run that is saved and
/// taken up again goes on with the same steps.
struct Instant {
  double t = 0;  // s
  Vector q, v;
  double step = 0;   // s, the next step that step control would try; 0: none yet
  int attempts = 0;  // of step control in the last step
  int spent = 0;     // that count as made before the next
  Vector mean{};     // (nv) the last step's mean acceleration, where the midpoint rule begins; other sizes: none
  /// How many times its tolerance step control may err by. Above 1 it first tries the implicit midpoint rule.
  double slack = 1;
};

}  // namespace breve::articulated
