// Impulses pass inward through the joints; only the answer of all joints needs a pass outward.
#include "runtime/articulated/impulse.hpp"

#include <memory_resource>
#include <vector>

#include "runtime/articulated/elimination.hpp"

namespace breve::articulated {

namespace {

/// A link of a plain joint through which nothing passes: most of a tree, for impulses on one of its links.
bool idle(const Body& body, const double* f, const Work& w) {
  return (body.type == JointType::Revolute || body.type == JointType::Prismatic) && (!f || f[body.v] == 0) &&
         w.couple == Vector3::Zero() && w.force == Vector3::Zero();
}

void pass_through(const Model& model, Data& data, const double* f, Vector& out) {
  for (int i = model.size() - 1; i >= 0; --i) {
    const Body& body = model.body(i);
    Work& w = data.of(i);
    if (idle(body, f, w)) {
      w.push = 0;
      continue;
    }
    Vector3 couple = w.couple, force = w.force;
    carry(body, f, w, data.wide_of(body), couple, force);
    Work& parent = data.of(body.parent);
    parent.couple += couple + w.offset.cross(force);
    parent.force += force;
  }
  data.work.front().acc.setZero();
  for (int i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    Work& w = data.of(i);
    const Work& parent = data.of(body.parent);
    w.alpha = parent.alpha;
    w.acc = parent.acc + parent.alpha.cross(w.offset);
    respond(body, w, data.wide_of(body), w.alpha, w.acc, out.data());
  }
}

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

void clear_forces(Data& data) {
  for (Work& w : data.work) w.couple.setZero(), w.force.setZero();
}

/// What links need so that the unit impulses along x, y and z do not move them; a column each.
struct UnitImpulses {
  Matrix3 couple = Matrix3::Zero();
  Matrix3 force = Matrix3::Zero();

  void add(const Vector3& arm, double sign) {
    couple -= sign * cross_matrix(arm);
    force.diagonal().array() -= sign;
  }
};

void add_square(const Eigen::RowVector3d& u, double inverse, Symmetric3& sum) {
  sum.subtract_outer(-inverse * u.transpose(), u.transpose());
}

void add_square(const Matrix3& u, const Matrix3& times_u, Symmetric3& sum) {
  sum += Symmetric3::upper(Matrix3(u.transpose() * times_u));
}

/// One degree of freedom: `u` of the impulses is left to it.
void pass_axis(const Eigen::RowVector3d& u, double inverse, const Vector3& pull_couple, const Vector3& pull_force,
               UnitImpulses& p, Symmetric3& sum) {
  add_square(u, inverse, sum);
  p.couple += pull_couple * (inverse * u);
  p.force += pull_force * (inverse * u);
}

/// Takes the impulses through the joint of a link and adds what it yields to `sum`.
void pass_joint(const Body& body, const Work& w, const WideWork& wide, UnitImpulses& p, Symmetric3& sum) {
  switch (body.type) {
    case JointType::Revolute:
      pass_axis(-w.axis.transpose() * p.couple, w.inverse, w.pull_couple, w.pull_force, p, sum);
      break;
    case JointType::Prismatic:
      pass_axis(-w.axis.transpose() * p.force, w.inverse, w.pull_couple, w.pull_force, p, sum);
      break;
    case JointType::Universal:
      pass_axis(-w.axis.transpose() * p.couple, w.inverse, w.pull_couple, w.pull_force, p, sum);
      pass_axis(-wide.axis2.transpose() * p.couple, wide.inverse2, wide.pull2_couple, wide.pull2_force, p, sum);
      break;
    case JointType::Ball: {
      const Matrix3 u = -p.couple;
      const Matrix3 rate = wide.inverse.matrix() * u;
      add_square(u, rate, sum);
      p.couple += u - wide.added * rate;
      p.force += w.inertia.b.transpose() * rate;
      break;
    }
    case JointType::Free: {
      const Matrix3 along = wide.inverse_mass.matrix() * -p.force;
      const Matrix3 u = -p.couple - w.inertia.b * along;
      add_square(-p.force, along, sum);
      add_square(u, wide.inverse.matrix() * u, sum);
      break;
    }
    case JointType::Fixed: break;
  }
  p.couple += cross_matrix(w.offset) * p.force;
}

}  // namespace

void impulse_response(const Model& model, Data& data, std::span<const Impulse> impulses, Vector& change) {
  clear_forces(data);
  for (const Impulse& impulse : impulses) {
    Work& w = data.of(impulse.link);
    const Vector3 arm = impulse.point - data.motion_of(impulse.link).origin;
    w.couple -= impulse.angular + arm.cross(impulse.linear);
    w.force -= impulse.linear;
  }
  pass_through(model, data, nullptr, change);
}

void apply_inverse_mass(const Model& model, Data& data, const Vector& f, Vector& out) {
  clear_forces(data);
  pass_through(model, data, f.data(), out);
}

Vector inverse_mass_diagonal(const Model& model, Data& data) {
  // Of links; entry 0 is the world, which does not move.
  std::pmr::vector<Matrix6> answers(data.work.size(), data.work.get_allocator());
  answers.front().setZero();
  Vector diagonal(model.velocities()), force = Vector::Zero(model.velocities()), rates(model.velocities());
  for (int i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    Work& w = data.of(i);
    WideWork& wide = data.wide_of(body);
    const Matrix6& parent = answers[static_cast<std::size_t>(body.parent + 1)];
    // What the link does if it needs `couple` and `force` and does not get them, and its joint gets `f`.
    const auto answer = [&](const double* f, Vector3 couple, Vector3 force_needed) {
      carry(body, f, w, wide, couple, force_needed);
      Vector6 needed;
      needed << couple + w.offset.cross(force_needed), force_needed;
      const Vector6 moved = parent * needed;
      Vector3 alpha = moved.head<3>(), acc = moved.tail<3>() + alpha.cross(w.offset);
      respond(body, w, wide, alpha, acc, rates.data());
      Vector6 motion;
      motion << alpha, acc;
      return motion;
    };
    for (int k = 0; k < 3; ++k) {
      Matrix6& own = answers[static_cast<std::size_t>(i + 1)];
      own.col(k) = answer(nullptr, Vector3::Unit(k), Vector3::Zero());
      own.col(k + 3) = answer(nullptr, Vector3::Zero(), Vector3::Unit(k));
    }
    for (int k = body.v; k < body.v + velocity_count(body.type); ++k) {
      force[k] = 1;
      answer(force.data(), Vector3::Zero(), Vector3::Zero());
      force[k] = 0;
      diagonal[k] = rates[k];
    }
  }
  return diagonal;
}

Symmetric3 collision_matrix(const Model& model, const Data& data, int link_a, const Vector3& point_a, int link_b,
                            const Vector3& point_b) {
  Symmetric3 sum;
  UnitImpulses a, b;
  if (link_a >= 0) a.add(point_a - data.motion_of(link_a).origin, -1);
  if (link_b >= 0) b.add(point_b - data.motion_of(link_b).origin, 1);
  // Parents come before children: going on with the higher one, the two meet where their paths do.
  while (link_a != link_b) {
    int& link = link_a > link_b ? link_a : link_b;
    const Body& body = model.body(link);
    pass_joint(body, data.of(link), data.wide_of(body), link_a > link_b ? a : b, sum);
    link = body.parent;
  }
  a.couple += b.couple;
  a.force += b.force;
  for (int link = link_a; link >= 0; link = model.body(link).parent) {
    const Body& body = model.body(link);
    pass_joint(body, data.of(link), data.wide_of(body), a, sum);
  }
  return sum;
}

}  // namespace breve::articulated
