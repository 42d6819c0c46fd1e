// Where energy is and where it went. A sub-step changes the velocity of a body by gravity, by forces, and by what joins
// and touches it; half the sum of the velocities before and after, times the impulse, is the work of each. Energy
// stored is computed in double precision from Box2D's numbers.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/planar/core.hpp"
#include "runtime/planar/doors.hpp"

namespace breve {

namespace {

double square(double x) { return x * x; }

}  // namespace

/// The kinetic energy of a body as Box2D has it, J.
double Planar::Core::motion_of(const FlatBody& flat) const {
  const b2Vec2 v = flat.b2->GetLinearVelocity();
  const double u = settings.unit;
  return 0.5 * flat.mass.mass * (square(v.x * u) + square(v.y * u)) +
         0.5 * flat.mass.inertia(2, 2) * square(flat.b2->GetAngularVelocity());
}

/// The energy of a body as Box2D has it, J: motion and height.
double Planar::Core::kinetic_of(const FlatBody& flat) const {
  const b2Vec2 at = flat.b2->GetWorldCenter();
  return motion_of(flat) -
         flat.mass.mass * settings.unit * settings.gravity.head<2>().dot(Vector2(double{at.x}, double{at.y}));
}

/// What the guard compares before and after a step: what is stored, less what came and went with bodies.
/// @param in_springs  the energy that springs store now, J
Planar::Core::Balance Planar::Core::balance(double in_springs) const {
  Balance now_is;
  const double lift = settings.gravity.norm() * b2_linearSlop * settings.unit;
  for (const FlatBody& flat : slots) {
    if (flat.body == kNoBody || flat.fixed) continue;
    if (flat.b2->IsAwake()) now_is.slack += lift * flat.mass.mass;
    now_is.kinetic += motion_of(flat);
    now_is.stored += kinetic_of(flat);
  }
  now_is.stored += in_springs - base;
  now_is.works = ledger.motor_work + ledger.script_work;
  now_is.losses = ledger.contact_loss + ledger.friction_loss + ledger.drag_loss + ledger.limit_loss;
  return now_is;
}

/// The energy of a body as the arrays have it, J: motion and height.
double Planar::Core::energy_of(BodyIndex body) const {
  if (!bodies->dynamic(body)) return 0;
  const MassProperties& mass = bodies->mass_properties(body);
  const Vector3 arm = bodies->orientation(body) * mass.center_of_mass;
  const Vector3& spin = bodies->rotational_velocity(body);
  const Vector3 v = bodies->velocity(body) + spin.cross(arm);
  return 0.5 * mass.mass * v.squaredNorm() + 0.5 * mass.inertia(2, 2) * square(spin.z()) -
         mass.mass * settings.gravity.dot(bodies->location(body) + arm);
}

double Planar::Core::springs_energy() const {
  double sum = 0;
  for (const FlatSpring& spring : springs) {
    if (!spring.used || !bodies->used(spring.is.a) || !bodies->used(spring.is.b)) continue;
    const Pose a = pose(spring.is.a), b = pose(spring.is.b);
    const Vector3 way = b.location + b.orientation * spring.is.point_b - a.location - a.orientation * spring.is.point_a;
    sum += pull_of(spring.is, way, Vector3::Zero()).energy;
  }
  for (const FlatJoint& joint : joints)
    if (joint.used && joint.drive.stiffness > 0)
      sum += 0.5 * joint.drive.stiffness * square(read_position(joint) - joint.drive.rest[0]);
  return sum;
}

Energy Planar::Core::stored() const {
  Energy sum;
  if (bodies->rigid() == 0) return sum;
  for (const BodyIndex body : bodies->rigid_bodies()) {
    const MassProperties& mass = bodies->mass_properties(body);
    const Vector3 arm = bodies->orientation(body) * mass.center_of_mass;
    const double height = -mass.mass * settings.gravity.dot(bodies->location(body) + arm);
    sum.potential += height;
    sum.kinetic += energy_of(body) - height;
  }
  sum.springs = springs_energy();
  return sum;
}

Energy Planar::Core::energy() const {
  Energy sum = stored();
  sum.motor_work = ledger.motor_work;
  sum.script_work = ledger.script_work + sum.springs - springs_known;
  sum.contact_loss = ledger.contact_loss;
  sum.friction_loss = ledger.friction_loss;
  sum.drag_loss = ledger.drag_loss;
  sum.limit_loss = ledger.limit_loss;
  if (!b2) return sum;
  const double works = sum.motor_work + sum.script_work;
  const double losses = sum.contact_loss + sum.friction_loss + sum.drag_loss + sum.limit_loss;
  sum.residual = sum.total() - base - works + losses;
  return sum;
}

/// The rate of the motor's own axis in Box2D, rad/s or length units per second.
double Planar::Core::joint_rate(const FlatJoint& joint) const {
  if (!joint.b2) return 0;
  if (joint.is.kind == JointKind::Revolute) return static_cast<const b2RevoluteJoint*>(joint.b2)->GetJointSpeed();
  return joint.is.kind == JointKind::Prismatic ? static_cast<const b2PrismaticJoint*>(joint.b2)->GetJointSpeed() : 0;
}

/// The work of a joint's motor in this sub-step, J.
double Planar::Core::motor_work(const FlatJoint& joint, double dt) const {
  if (!joint.used || !joint.b2 || !(joint.drive.strength_limit > 0) || joint.is.kind == JointKind::Fixed) return 0;
  if (is_solved(joint)) return joint.work;
  const auto rate = static_cast<float>(1 / dt);
  const double strength = joint.is.kind == JointKind::Revolute
                              ? static_cast<const b2RevoluteJoint*>(joint.b2)->GetMotorTorque(rate)
                              : static_cast<const b2PrismaticJoint*>(joint.b2)->GetMotorForce(rate);
  return strength * dt * (joint.rate + joint_rate(joint)) / 2 * settings.unit * settings.unit;
}

/// Whether its assembly was solved as a whole.
bool Planar::Core::is_solved(const FlatJoint& joint) const {
  for (const BodyIndex end : {joint.is.child, joint.is.parent})
    if (const FlatBody* flat = end == kNoBody ? nullptr : find(end); flat && flat->solved) return true;
  return false;
}

/// A body that flies and meets only what does not move may rotate far in the sub-step in which it does, and rebounds
/// from where it was as that began: energy that contacts gave it is taken from its motion.
/// @param given  J
/// @return       J, that this took
double Planar::Core::take_back(FlatBody& flat, double given) {
  constexpr double kFlies = 4;  // times that energy: what lies has hardly any
  constexpr double kSingle = 2 * double{std::numeric_limits<float>::epsilon()};
  // Rounding of its height is not taken back.
  const double weight = flat.mass.mass * settings.gravity.norm() * settings.unit;
  if (!(given > kSingle * weight * double{flat.b2->GetWorldCenter().Length()}) || flat.jointed || flat.pulled ||
      !flat.b2->IsAwake())
    return 0;
  const double has = motion_of(flat);
  if (!(has > kFlies * given)) return 0;
  for (const b2ContactEdge* edge = flat.b2->GetContactList(); edge; edge = edge->next)
    if (edge->contact->IsTouching() && !(of(edge->other).fixed && !of(edge->other).driven)) return 0;
  const auto left = static_cast<float>(std::sqrt(1 - given / has));
  const float slow = sleep_time(*flat.b2);  // a velocity that is set would begin it anew
  flat.b2->SetLinearVelocity(left * flat.b2->GetLinearVelocity());
  flat.b2->SetAngularVelocity(left * flat.b2->GetAngularVelocity());
  sleep_time(*flat.b2) = slow;
  return given;
}

/// The work of all that joins and touches a body in this sub-step, J.
/// @param moved_by  the velocity by which Box2D has moved it
double Planar::Core::held_work(const FlatBody& flat, const b2Vec2& moved_by, double dt) const {
  const double u = settings.unit, m = flat.mass.mass;
  const Vector2 before = u * vector_of(flat.before), after = u * vector_of(flat.b2->GetLinearVelocity());
  const double w = flat.b2->GetAngularVelocity(), w_before = flat.before_spin;
  const Vector2 force = flat.force + flat.asked + flat.pull;
  // Gravity works along the way that the body was moved, which is not the mean velocity's where something struck.
  return (m * (after - before) - dt * force).dot(before + after) / 2 -
         dt * u * m * settings.gravity.head<2>().dot(vector_of(moved_by)) +
         (flat.mass.inertia(2, 2) * (w - w_before) - dt * (flat.torque + flat.twist)) * (w + w_before) / 2;
}

/// The energy of the height that a body has gained beyond the way on which its velocity took it, J: it was moved out of
/// overlaps, joints were closed, or it had another velocity before it struck something.
/// @param moved_by  the velocity by which Box2D has moved it
double Planar::Core::lifted(const FlatBody& flat, const b2Vec2& moved_by, double dt) const {
  if (flat.solved) return 0;
  const Vector2 path = vector_of(flat.b2->GetWorldCenter()) - vector_of(flat.at) - dt * vector_of(moved_by);
  return -flat.mass.mass * settings.unit * settings.gravity.head<2>().dot(path);
}

/// Gives back what was taken off, takes back what contacts gave, and writes down what the sub-step did.
void Planar::Core::end_ledger(double dt) {
  const double u = settings.unit;
  double held_back = 0;          // work of all that joins and touches
  double forced = 0, lifts = 0;  // that of forces that scripts set, and of what was moved without velocity
  for (FlatBody& flat : slots) {
    if (flat.body == kNoBody || flat.fixed || flat.set_apart) continue;
    const b2Vec2 moved_by = flat.b2->GetLinearVelocity();
    if (flat.kicked && flat.b2->IsAwake()) flat.b2->SetLinearVelocity(flat.b2->GetLinearVelocity() + flat.kick);
    flat.kicked = false;
    const b2Vec2 v = flat.b2->GetLinearVelocity();
    const double w = flat.b2->GetAngularVelocity(), lift = lifted(flat, moved_by, dt);
    const Vector2 sum(u * (double{v.x} + flat.before.x), u * (double{v.y} + flat.before.y));
    const double spins = w + double{flat.before_spin};
    const bool moves = sum != Vector2::Zero() || spins != 0;
    if (!moves && lift == 0) continue;
    const double held = lift + (moves ? held_work(flat, moved_by, dt) : 0);
    // Joints do no work on what was solved as a whole: what its energy errs by shows in the residual.
    if (!flat.solved) held_back += held - take_back(flat, held);
    lifts += lift;
    const Vector2 force = flat.force + flat.asked;
    if (flat.has_force || flat.asked != Vector2::Zero()) forced += dt * (force.dot(sum) + flat.torque * spins) / 2;
  }
  if (!std::isfinite(held_back)) {  // nor is any other work of this sub-step
    spoiled = true;
    return;
  }
  ledger.script_work += forced;
  double motors = 0;  // of joints whose assemblies may touch something
  for (const FlatJoint& joint : joints) {
    if (!joint.used || !steps(joint)) continue;
    const double work = motor_work(joint, dt);
    ledger.motor_work += work;
    if (!is_solved(joint)) motors += work;
  }
  ledger.script_work += driven_work;
  // The rest is lost where bodies touch; if it came in, nothing explains it, and it shows in the residual.
  const double rest = motors + driven_work - held_back, lost = std::max(0.0, rest);
  const double lifted_most = std::clamp(lifts, 0.0, std::max(-rest, 0.0));
  // What scripts move also lifts others out of the overlaps that it makes.
  if (driven_work != 0)
    ledger.script_work += lifted_most;
  else
    pushed += lifted_most;
  const double rubbed = std::min(friction, lost);
  ledger.friction_loss += rubbed;
  ledger.contact_loss += lost - rubbed;
}

}  // namespace breve
