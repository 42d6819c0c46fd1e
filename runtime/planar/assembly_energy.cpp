// What the motion of an assembly errs by in energy goes back into its motion. It is small, since the sub-step is
// solved to second order, but what rotates far in a sub-step would lose some per cent in a minute.
#include <algorithm>
#include <cmath>

#include "runtime/planar/assembly.hpp"
#include "runtime/planar/doors.hpp"

namespace breve {

/// Springs, dampers or force methods act on it.
bool Planar::Core::Assembly::pulled() const {
  return std::any_of(links_.begin(), links_.end(), [](const Link& link) {
    const FlatBody& flat = *link.flat;
    return flat.pull != Vector2::Zero() || flat.twist != 0 || flat.asked != Vector2::Zero();
  });
}

/// A joint that moves by less stands still, length units or rad. Single precision leaves more far from the origin.
double Planar::Core::Assembly::least_move() const {
  constexpr double kStill = 1e-6, kSingle = 2.5e-7;
  double farthest = 0;
  for (const FlatPose& pose : after_) farthest = std::max(farthest, pose.center.cwiseAbs().maxCoeff());
  return kStill + kSingle * farthest;
}

/// Limits act in it that stop what moves.
bool Planar::Core::Assembly::stops(double dt) const {
  return std::any_of(joints_.begin(), joints_.end(), [dt, still = least_move()](const Member& member) {
    return member.locked && member.limited() && !member.rests(dt, still);
  });
}

/// The rate of a joint along its own axis.
double Planar::Core::Assembly::own_rate(std::size_t index, std::span<const FlatPose> poses) const {
  const auto [of_parent, of_child] = axis_rows(index, poses);
  const JointSystem::Ends& ends = system_.ends(index);
  double rate = 0;
  if (ends.parent >= 0) rate += of_parent.dot(velocities_[static_cast<std::size_t>(ends.parent)]);
  if (ends.child >= 0) rate += of_child.dot(velocities_[static_cast<std::size_t>(ends.child)]);
  return rate;
}

/// Takes down what motors are about to act on, at these poses.
void Planar::Core::Assembly::begin_works(std::span<const FlatPose> poses) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Member& member = joints_[i];
    if (!(member.strength > 0) || member.limited()) continue;
    member.rate_then = own_rate(i, poses);
    member.impulse_then = member.impulse[member.free_row()];
  }
}

/// The work of a motor is that of its impulses, by the means of the rates before and after each.
/// @param part  of the impulses of motors at their strength that acted since
void Planar::Core::Assembly::end_works(std::span<const FlatPose> poses, double part) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Member& member = joints_[i];
    if (!(member.strength > 0) || member.limited()) continue;
    const double given = member.locked ? member.impulse[member.free_row()] - member.impulse_then : part * member.load;
    member.work += given * (member.rate_then + own_rate(i, poses)) / 2;
  }
}

/// The work of all motors. A motor that presses on a limit does it with what it gives, a limit does none; nor does
/// either do work where a joint is put back that was beyond its limit.
double Planar::Core::Assembly::drive_work(double dt) {
  const double still = least_move();
  double sum = 0;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Member& member = joints_[i];
    if (member.strength > 0 && member.limited() && member.speed != member.target) {
      const bool beyond = member.travel < member.low - still || member.travel > member.high + still;
      const double rate = beyond ? member.target : (travel_of(i, after_) - member.travel) / dt;
      member.work = motor_share(member) * rate;
    }
    sum += member.work;
  }
  return sum;
}

/// Motors act in it.
bool Planar::Core::Assembly::driven() const {
  return std::any_of(joints_.begin(), joints_.end(),
                     [](const Member& member) { return member.load != 0 || (member.locked && member.strength > 0); });
}

/// The work of the springs of prismatic joints; that of all others is among that of forces.
double Planar::Core::Assembly::spring_work() const {
  double sum = 0;
  for (std::size_t i = 0; i < joints_.size(); ++i)
    if (joints_[i].spring != 0) sum += joints_[i].spring * (travel_of(i, after_) - joints_[i].travel);
  return sum;
}

/// The works of gravity, of constant forces and of motors are known: energy that exceeds them is an error. Limits may
/// take more, and the works of motors are less exact than the motion, so energy only goes back where neither acts; a
/// limit at which a joint rests takes nothing. The works of springs are not exact.
/// @param began  the energy of motion as the sub-step of dt seconds began, in Box2D's units
void Planar::Core::Assembly::settle_energy(double began, double dt) {
  lost_ = missing_ = 0;
  const bool limits = stops(dt), springs = pulled();
  if (springs && !limits) return;
  const double energy = began + work_ + drive_work(dt) + spring_work();
  if (!springs && (!(limits || driven()) || kinetic() > energy)) missing_ = restore_energy(energy);
  if (limits) lost_ = std::max(energy - kinetic(), 0.0);
}

/// The energy of motion, in Box2D's units.
double Planar::Core::Assembly::kinetic() const {
  double sum = 0;
  for (std::size_t i = 0; i < links_.size(); ++i)
    sum += velocities_[i].cwiseAbs2().cwiseQuotient(mobility_[i]).sum() / 2;
  return sum;
}

/// The work of gravity and forces along the path of h seconds.
double Planar::Core::Assembly::work_along_path(double h) const {
  const Vector2 fall = vector_of(core_.b2->GetGravity());
  double sum = 0;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Vector pull = forces_[i] + Vector(fall.x(), fall.y(), 0);
    sum += h * velocities_[i].dot(pull.cwiseQuotient(mobility_[i]));
  }
  return sum;
}

bool Planar::Core::Assembly::held_by_world() const {
  for (std::size_t i = 0; i < joints_.size(); ++i)
    if (system_.ends(i).parent < 0 || system_.ends(i).child < 0) return true;
  return false;
}

/// The motion that a rigid body of the same momenta would have, as a velocity of the common center of mass and an
/// angular one about it. Zero where the world holds the assembly.
Planar::Core::Assembly::Common Planar::Core::Assembly::common_motion() const {
  Common common;
  if (held_by_world()) return common;
  double mass = 0, momentum = 0;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const double m = 1 / mobility_[i][0];
    mass += m;
    common.center += m * after_[i].center;
    common.velocity.head<2>() += m * velocities_[i].head<2>();
  }
  common.center /= mass;
  common.velocity /= mass;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const double m = 1 / mobility_[i][0], own = 1 / mobility_[i][2];
    const Vector2 arm = after_[i].center - common.center;
    common.inertia += own + m * arm.squaredNorm();
    momentum += own * velocities_[i][2] + m * cross(arm, Vector2(velocities_[i].head<2>()));
  }
  common.velocity[2] = momentum / common.inertia;
  return common;
}

/// Gives all links together the rotation with which their angular momentum is what it was, now that they have moved.
void Planar::Core::Assembly::keep_rotation(const Common& had) {
  if (!(had.inertia > 0)) return;
  Common change = common_motion();
  change.velocity = Vector(0, 0, had.inertia * had.velocity[2] / change.inertia - change.velocity[2]);
  for (std::size_t i = 0; i < links_.size(); ++i) velocities_[i] += carried(change, i);
}

/// The velocity of a link, as if it moved with all others as a rigid body.
Planar::Core::Assembly::Vector Planar::Core::Assembly::carried(const Common& common, std::size_t link) const {
  const Vector2 moved = common.velocity[2] * left_of(after_[link].center - common.center);
  return common.velocity + Vector(moved.x(), moved.y(), 0);
}

/// The energy of the motion of the links among one another, in Box2D's units. That motion is then in moves_.
double Planar::Core::Assembly::motion_among() {
  const Common common = common_motion();
  double sum = 0;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    moves_[i] = velocities_[i] - carried(common, i);
    sum += moves_[i].cwiseAbs2().cwiseQuotient(mobility_[i]).sum() / 2;
  }
  return sum;
}

/// Scales the motion of the links among one another, which keeps all momenta, so that the energy is what it was and
/// what the works came to.
/// @param energy  of motion, that there is to be, in Box2D's units
/// @return        what of it is missing afterwards: where hardly anything moves among the links, they cannot take it
double Planar::Core::Assembly::restore_energy(double energy) {
  constexpr double kMost = 0.1;  // of the energy of that motion
  const double missing = energy - kinetic(), among = motion_among();
  if (!(among > 0) || !std::isfinite(missing)) return missing;
  const double taken = std::clamp(missing, -kMost * among, kMost * among), scale = std::sqrt(1 + taken / among);
  for (std::size_t i = 0; i < links_.size(); ++i) velocities_[i] += (scale - 1) * moves_[i];
  return missing - taken;
}

/// Whether nothing pushes it but bodies that neither move by themselves nor by scripts.
bool Planar::Core::Assembly::touches_only_fixed() const {
  for (const Link& link : links_) {
    if (link.flat->pulled) return false;
    for (const b2ContactEdge* edge = link.flat->b2->GetContactList(); edge; edge = edge->next) {
      const FlatBody& other = core_.of(edge->other);
      const bool own = other.assembly == link.flat->assembly, still = other.fixed && !other.driven;
      if (edge->contact->IsTouching() && !own && !still) return false;
    }
  }
  return true;
}

void Planar::Core::Assembly::take_back(double dt) {
  constexpr double kFlies = 4;    // times that energy: what lies has hardly any
  constexpr double kSeen = 1e-6;  // of it: less is round-off
  double given = 0, has = 0;      // J
  for (Link& link : links_) {
    link.flat = core_.find(link.body);
    if (!link.flat || link.flat->fixed || link.flat->solved || link.flat->set_apart) return;
    if (!link.flat->b2->IsAwake()) return;
    const b2Vec2 moved_by = link.flat->b2->GetLinearVelocity();
    given += core_.held_work(*link.flat, moved_by, dt) + core_.lifted(*link.flat, moved_by, dt);
    has += core_.motion_of(*link.flat);
  }
  for (const Member& member : joints_) {
    const FlatJoint& joint = core_.joints[member.joint];
    if (!joint.used || joint.serial != member.serial || connects_script(joint.is)) return;
    given -= core_.motor_work(joint, dt);
  }
  if (!(given > kSeen * has) || !(has > kFlies * given) || !touches_only_fixed()) return;
  const auto left = static_cast<float>(std::sqrt(1 - given / has));
  for (const Link& link : links_) {
    b2Body& b = *link.flat->b2;
    const float slow = sleep_time(b);  // a velocity that is set would begin it anew
    b.SetLinearVelocity(left * b.GetLinearVelocity());
    b.SetAngularVelocity(left * b.GetAngularVelocity());
    sleep_time(b) = slow;
  }
}

}  // namespace breve
