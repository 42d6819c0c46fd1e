// Static against dynamic friction, settled between solves: inside a sweep the choice would depend on the others'
// errors.
#include "runtime/contact/friction.hpp"

#include <cmath>

#include "runtime/contact/pack.hpp"

namespace breve::contact {

namespace {

struct Slip {
  double x, y;
  double dot(const Slip& other) const { return x * other.x + y * other.y; }
  double length() const { return std::sqrt(x * x + y * y); }
};

/// A point was sliding when the step began if it did so faster than what its friction changes in the step; so noise
/// around rest does not count, and neither does a point whose sliding ends and would turn round within the step.
bool goes_on(const Slip& before, const Slip& after) { return before.dot(after) > 0.5 * after.dot(after); }

/// What the slip would be with friction shortened to the dynamic coefficient, all other impulses being as they are.
Slip slip_if_loose(const Point& c, const double u[3], double dynamic) {
  const double held = std::sqrt(c.impulse[1] * c.impulse[1] + c.impulse[2] * c.impulse[2]);
  const double keep = held > 0 ? dynamic * c.impulse[0] / held : 1;
  const double d1 = (keep - 1) * c.impulse[1], d2 = (keep - 1) * c.impulse[2];
  return {u[1] + c.response.s11 * d1 + c.response.s12 * d2, u[2] + c.response.s12 * d1 + c.response.s22 * d2};
}

/// What an unsettled point does, after a solve with its static coefficient.
Grip settled(const Row& row, const double u[3], double tolerance, const Point& c) {
  const double held = std::sqrt(c.impulse[1] * c.impulse[1] + c.impulse[2] * c.impulse[2]);
  if (held <= row.dynamic_friction * c.impulse[0]) return Grip::Unsettled;
  // Sliding is distinguished from the noise of a solve by what friction does in this step.
  const double noise = 1e-5 * held * (c.response.s11 + c.response.s22) + 10 * tolerance;
  if (held >= (1 - 1e-9) * c.friction * c.impulse[0] && Slip{u[1], u[2]}.length() > noise) return Grip::Slides;
  if (goes_on({row.slip[0], row.slip[1]}, slip_if_loose(c, u, row.dynamic_friction))) return Grip::GoesOn;
  return Grip::Unsettled;
}

}  // namespace

bool settle_friction(std::span<const Row> rows, double tolerance, Workspace& work) {
  bool changed = false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Point& c = work.points[i];
    Grip& grip = work.grips[i];
    if (grip == Grip::Holds || grip == Grip::Slides || !(c.impulse[0] > 0)) continue;
    double u[3];
    velocity(work, i, u);
    const Grip before = grip;
    if (before == Grip::Unsettled)
      grip = settled(rows[i], u, tolerance, c);
    else if (!goes_on({rows[i].slip[0], rows[i].slip[1]}, {u[1], u[2]}))
      grip = Grip::Holds;
    if (grip == before) continue;
    c.friction = grip == Grip::Holds ? rows[i].static_friction : rows[i].dynamic_friction;
    changed = true;
  }
  return changed;
}

}  // namespace breve::contact
