// The forces of one sub-step: what scripts set, what their force methods answer, springs, and what joints do by
// themselves. A spring or damper that the sub-step follows acts as it stands; a stiffer one as it will stand at the end
// of the sub-step (linearly implicit), so that it does not blow up.
#include <algorithm>
#include <cmath>

#include "runtime/planar/core.hpp"

namespace breve {

namespace {

Vector2 rotated(const b2Body& body, const Vector3& own, double unit) {
  const b2Vec2 v = body.GetWorldVector(b2Vec2(static_cast<float>(own.x() / unit), static_cast<float>(own.y() / unit)));
  return Vector2(v.x, v.y) * unit;
}

/// The mobility of a body; zero if it does not move by itself.
struct Mobility {
  double mass = 0, inertia = 0;  // inverse
};
Mobility mobility(const FlatBody* flat) {
  if (!flat || flat->fixed) return {};
  return {1 / flat->mass.mass, 1 / flat->mass.inertia(2, 2)};
}

/// What a force -(k x + c v) is to be so that the step stays stable, with the inverse inertia that it moves.
double stable_force(double k, double c, double x, double v, double mobility, double h) {
  constexpr double kFollows = 0.5;
  const double stiff = h * (c + h * k) * mobility;
  if (stiff < kFollows) return -(k * x + c * v);
  return -(k * (x + h * v) + c * v) / (1 + stiff);
}

}  // namespace

void Planar::Core::apply_joint(FlatJoint& joint, double dt) {
  const JointDrive& drive = joint.drive;
  joint.pull = 0;
  if (joint.is.kind == JointKind::Fixed || !joint.b2) return;
  if (drive.double_strength != 0) put_drive(joint);
  if (drive.stiffness == 0 && drive.damping == 0 && drive.force[0] == 0) return;
  FlatBody *child = find(joint.is.child), *parent = joint.is.parent == kNoBody ? nullptr : find(joint.is.parent);
  const Mobility of_child = mobility(child), of_parent = mobility(parent);
  double x = 0, v = 0;
  const double u = settings.unit;
  Vector2 axis = Vector2::Zero();
  if (joint.is.kind == JointKind::Revolute) {
    auto* b = static_cast<b2RevoluteJoint*>(joint.b2);
    x = -joint.is.normal.z() * b->GetJointAngle();
    v = -joint.is.normal.z() * b->GetJointSpeed();
  } else {
    auto* b = static_cast<b2PrismaticJoint*>(joint.b2);
    x = -b->GetJointTranslation() * u;
    v = -b->GetJointSpeed() * u;
    axis = rotated(*b->GetBodyA(), joint.is.normal, 1);
  }
  const bool rotates = joint.is.kind == JointKind::Revolute;
  const double moves = rotates ? of_child.inertia + of_parent.inertia : of_child.mass + of_parent.mass;
  const double spring = stable_force(drive.stiffness, drive.damping, x - drive.rest[0], v, moves, dt);
  ledger.drag_loss += drive.damping * v * v * dt;
  ledger.script_work += drive.force[0] * v * dt;
  joint.pull = spring + drive.force[0];
  const auto give = [&](FlatBody* flat, double sign) {
    if (!flat || flat->fixed) return;
    if (rotates) {
      flat->twist += sign * joint.pull * joint.is.normal.z();
      return;
    }
    // Along the line through the child's point, on both.
    const b2Vec2 at = joint.b2->GetAnchorB(), center = flat->b2->GetWorldCenter();
    const Vector2 force = sign * joint.pull * axis;
    flat->pull += force;
    flat->twist += cross(Vector2(at.x - center.x, at.y - center.y) * u, force);
  };
  give(parent, 1);
  give(child, -1);
}

void Planar::Core::apply_spring(FlatSpring& spring, double dt) {
  struct End {
    FlatBody* flat;
    Vector2 point, arm, velocity;
  };
  const auto end_of = [&](BodyIndex body, const Vector3& own) {
    End end{find(body), Vector2::Zero(), Vector2::Zero(), Vector2::Zero()};
    if (!end.flat) {
      const Pose at = pose(body);
      end.point = (at.location + at.orientation * own).head<2>();
      const Vector3 spin = bodies->rotational_velocity(body);
      end.velocity = (bodies->velocity(body) + spin.cross(at.orientation * own)).head<2>();
      return end;
    }
    const b2Body& b = *end.flat->b2;
    const double u = settings.unit;
    const b2Vec2 origin = b.GetPosition(), center = b.GetWorldCenter(), v = b.GetLinearVelocity();
    end.point = Vector2(origin.x, origin.y) * u + rotated(b, own, u);
    end.arm = end.point - Vector2(center.x, center.y) * u;
    end.velocity = Vector2(v.x, v.y) * u + double{b.GetAngularVelocity()} * left_of(end.arm);
    return end;
  };
  const End a = end_of(spring.is.a, spring.is.point_a), b = end_of(spring.is.b, spring.is.point_b);
  const Vector2 way = b.point - a.point, rate = b.velocity - a.velocity;
  const SpringPull pull = pull_of(spring.is, {way.x(), way.y(), 0}, {rate.x(), rate.y(), 0});
  spring.force = pull.force;
  if (pull.force == 0 && pull.energy == 0) return;
  const Vector2 along = pull.direction.head<2>();
  const auto moves = [&](const End& end) {
    const Mobility m = mobility(end.flat);
    const double lever = cross(end.arm, along);
    return m.mass + lever * lever * m.inertia;
  };
  const double stiff = dt * (spring.is.damping + dt * spring.is.strength) * (moves(a) + moves(b));
  constexpr double kFollows = 0.5;
  if (stiff >= kFollows) {
    spring.force = (pull.force + dt * spring.is.strength * along.dot(rate)) / (1 + stiff);
    if (spring.is.maximum_force > 0)
      spring.force = std::clamp(spring.force, -spring.is.maximum_force, spring.is.maximum_force);
  }
  ledger.drag_loss += pull.loss * dt;
  const auto give = [&](const End& end, double sign) {
    if (!end.flat || end.flat->fixed) return;
    end.flat->pull += sign * spring.force * along;
    end.flat->twist += cross(end.arm, sign * spring.force * along);
    end.flat->pulled = true;
  };
  give(a, 1);
  give(b, -1);
}

void Planar::Core::ask_forces() {
  for (std::size_t i = 0; i < force_methods.size(); ++i) {
    FlatBody* flat = find(force_methods[i]);
    if (!flat || flat->fixed || flat->set_apart) continue;
    write_back(*flat);
    flat->asked = client->stage_force(flat->body, now, sub_step).head<2>();
    flat->pulled = true;
  }
}

void Planar::Core::apply_forces(double dt) {
  const double u = settings.unit;
  // Where nothing ever pulled, nothing is to be cleared.
  const bool pulls = !joints.empty() || !springs.empty() || !force_methods.empty();
  if (pulls)
    for (FlatBody& flat : slots) {
      if (flat.set_apart) continue;
      flat.pulled = false;
      flat.asked = flat.pull = Vector2::Zero();
      flat.twist = 0;
    }
  if (!force_methods.empty()) ask_forces();
  for (FlatJoint& joint : joints)
    if (joint.used && steps(joint)) apply_joint(joint, dt);
  for (FlatSpring& spring : springs)
    if (spring.used && steps(spring)) apply_spring(spring, dt);
  for (FlatBody& flat : slots) {
    if ((!pulls && !flat.has_force) || flat.body == kNoBody || flat.fixed || flat.set_apart) continue;
    const Vector2 force = flat.force + flat.asked + flat.pull;
    const double torque = flat.torque + flat.twist;
    if (force == Vector2::Zero() && torque == 0) continue;
    // What sleeps goes on sleeping under a force that did not change.
    const bool wake = flat.pulled || flat.asked != Vector2::Zero();
    flat.b2->ApplyForceToCenter(b2Vec2(static_cast<float>(force.x() / u), static_cast<float>(force.y() / u)), wake);
    flat.b2->ApplyTorque(static_cast<float>(torque / (u * u)), wake);
  }
}

}  // namespace breve
