#include "measure.hpp"

#include <algorithm>
#include <cmath>

namespace adversary {

namespace {

constexpr double kPi = 3.14159265358979323846;

Vector3 vector(const breve::Vector& v) { return Vector3(v[0], v[1], v[2]); }

/// Angle about `axis` from `a` to `b`.
double angle_about(const Vector3& axis, const Vector3& a, const Vector3& b) {
  return std::atan2(axis.dot(a.cross(b)), a.dot(b) - axis.dot(a) * axis.dot(b));
}

/// The angle of as many full rotations as the joint reports.
double unwound(double angle, double told) { return angle + 2 * kPi * std::round((told - angle) / (2 * kPi)); }

}  // namespace

bool State::finite() const {
  return std::isfinite(total()) && momentum.allFinite() && spin.allFinite() && center.allFinite();
}

Positions positions_of(Creature& creature, const Joint& joint) {
  Positions out;
  const Pose parent = creature.pose(joint.parent), child = creature.pose(joint.child);
  const breve_joint_info info = creature.world().joint(joint.object).or_throw();
  // Positive where the parent moves relative to the child: hence the signs.
  const Matrix3 relative =
      (parent.orientation.conjugate() * child.orientation * joint.zero.conjugate()).toRotationMatrix();
  const Vector3 way =
      parent.orientation.conjugate() * (child.at + child.orientation * joint.on_child - parent.at) - joint.on_parent;
  switch (joint.kind) {
    case BREVE_JOINT_REVOLUTE:
      out.q[0] = unwound(-angle_about(joint.axis, joint.other, relative * joint.other), info.position[0]);
      break;
    case BREVE_JOINT_PRISMATIC: out.q[0] = -joint.axis.dot(way); break;
    case BREVE_JOINT_UNIVERSAL:
      out.q[0] = unwound(-angle_about(joint.axis, joint.other, relative * joint.other), info.position[0]);
      out.q[1] = unwound(angle_about(joint.other, joint.axis, relative.transpose() * joint.axis), info.position[1]);
      break;
    default: break;
  }
  if (joint.kind == BREVE_JOINT_BALL) {
    const double angle = Eigen::AngleAxisd(relative).angle();
    out.square = angle * angle;
    return out;
  }
  for (int k = 0; k < joint.axes; ++k) {
    out.told = std::max(out.told, std::abs(out.q[k] - info.position[k]));
    out.square += (out.q[k] - joint.drive.rest[k]) * (out.q[k] - joint.drive.rest[k]);
  }
  return out;
}

State measure(Creature& creature) {
  State now;
  const breve::World& world = creature.world();
  const auto& bodies = creature.bodies();
  struct Moving {
    Pose pose;
    Vector3 velocity, spin;
  };
  std::vector<Moving> all;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    const Moving& m =
        all.emplace_back(Moving{creature.pose(static_cast<int>(i)), vector(world.velocity(body.object).or_throw()),
                                vector(world.rotational_velocity(body.object).or_throw())});
    const Vector3 own = m.pose.orientation.conjugate() * m.spin;
    now.kinetic += 0.5 * body.mass * m.velocity.squaredNorm() + 0.5 * own.dot(body.inertia.cwiseProduct(own));
    const double height = -body.mass * creature.gravity().dot(m.pose.at);
    now.potential += height;
    now.terms += std::abs(height);
    now.mass += body.mass;
    now.momentum += body.mass * m.velocity;
    now.center += body.mass * m.pose.at;
  }
  now.links = static_cast<int>(bodies.size());
  now.center /= now.mass;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Moving& m = all[i];
    const Vector3 from = m.pose.at - now.center;
    const Vector3 own = m.pose.orientation.conjugate() * m.spin;
    now.spin += bodies[i].mass * from.cross(m.velocity - now.momentum / now.mass) +
                m.pose.orientation * bodies[i].inertia.cwiseProduct(own);
    now.roundness += bodies[i].mass * from.squaredNorm() + bodies[i].inertia.maxCoeff();
    now.size = std::max(now.size, from.norm() + bodies[i].half.norm());
  }
  for (const Joint& joint : creature.joints()) {
    if (joint.axes == 0) continue;
    const Positions at = positions_of(creature, joint);
    now.told = std::max(now.told, at.told);
    now.springs += 0.5 * joint.drive.stiffness * at.square;
  }
  if (const Spring& spring = creature.spring(); spring.a >= 0) {
    const double length = (creature.pose(spring.a).at - creature.pose(spring.b).at).norm();
    now.springs += 0.5 * spring.strength * (length - spring.length) * (length - spring.length);
  }
  now.terms += now.kinetic + now.springs;
  return now;
}

}  // namespace adversary
