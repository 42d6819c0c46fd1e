// The step of a free body that nothing is near and no spring holds: most islands of a crowd are such bodies. What an
// island does for them is a straight line here: the same motion, the same books.
#include <algorithm>
#include <cmath>

#include "runtime/dynamics/motion.hpp"

namespace breve {

namespace {

constexpr double kMostParts = 1000;
constexpr std::uint64_t kUnits = 10;  // of work, a sub-step

double mechanical_of(const FreeBody& body, const Vector3& gravity) {
  return body.kinetic() - body.solid->mass * gravity.dot(body.center);
}

bool finite(const FreeBody& body) {
  return body.center.allFinite() && body.velocity.allFinite() && body.spin.allFinite() &&
         body.orientation.coeffs().allFinite();
}

}  // namespace

/// @param work  that all islands may take
/// @param sum   what scripts did, and the residual
/// @return      false if that is an island's to do; nothing has changed then
bool Dynamics::Core::step_alone(std::size_t island, double start, double h, std::uint64_t work, Energy& sum) {
  if (!island_pairs.of(island).empty() || !island_clusters.of(island).empty()) return false;
  if (island_free.of(island).size() != 1) return false;
  const BodyIndex body = island_free.of(island).front();
  if (work != Meter::kNoBound) work /= near.movers().size() + island_pairs.size();
  if (settings.sleeping || over()) return false;
  const Accuracy& accuracy = accuracy_of(body);
  FreeBody free = read_free(*bodies, body);
  const double step = accuracy.step > 0 ? std::min(accuracy.step, h) : h;
  const double parts = std::max(1.0, std::ceil(h / step - 1e-9));
  const bool exact = free.solid->round && free.torque == Vector3::Zero();
  if (!exact && (!accuracy.implicit_spin || !(free.solid->round || free.spin.norm() * step <= kMostRotation)))
    return false;
  if (!(parts <= kMostParts) || kUnits * static_cast<std::uint64_t>(parts) >= work) return false;
  const double before = mechanical_of(free, settings.gravity), part = h / parts;
  BodyEntry* known = find(body);
  double next = known ? known->step : 0, done = 0;
  Meter meter;
  for (int i = 0; i < static_cast<int>(parts); ++i) {
    const Vector3 center = free.center, spin = free.spin;
    move_free(free, accuracy, settings.gravity, start + i * part, part, next, meter);
    done += free.force.dot(free.center - center) + 0.5 * part * free.torque.dot(spin + free.spin);
  }
  if (!finite(free)) return false;
  write_free(*bodies, body, free);
  if (known) known->step = next;
  const double after = mechanical_of(free, settings.gravity);
  // Read back as it will be when a script sets something: a centre of mass off the origin is rounded on the way.
  booked[body] = free.solid->center_of_mass == Vector3::Zero() ? after : free_energy(body).total();
  sum.script_work += done;
  sum.residual += after - before - done;
  ++counters.islands;
  counters.sub_steps += static_cast<std::uint64_t>(parts);
  counters.work += kUnits * static_cast<std::uint64_t>(parts);
  return true;
}

}  // namespace breve
