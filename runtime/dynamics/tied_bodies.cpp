// Newton's and Euler's equations of each body, once the springs have pulled.
#include "runtime/dynamics/tied_bodies.hpp"

#include <algorithm>

#include "runtime/articulated/joints.hpp"
#include "runtime/base/error.hpp"

namespace breve {

namespace {

constexpr int kPositions = 7, kVelocities = 6;  // of a body

/// A point in the link's frame as a vector from its origin, in world axes, m.
Vector3 turned(const Matrix3& rotation, const Vector3& arm) {
  return arm == Vector3::Zero() ? arm : Vector3(rotation * arm);
}

const articulated::Body& only_link(const Tree& tree) { return tree.model.body(0); }

}  // namespace

bool TiedBodies::are(std::span<Tree* const> trees) {
  return std::all_of(trees.begin(), trees.end(), [](const Tree* tree) {
    return tree->model.size() == 1 && only_link(*tree).type == articulated::JointType::Free && tree->rings.empty();
  });
}

void TiedBodies::place(const Tied& body, const double* q, const double* v, Stage& stage) {
  const articulated::Body& link = only_link(*body.tree);
  stage.rotation.noalias() = link.turn * articulated::rotation_matrix(q + 3);
  stage.origin = link.position + link.turn * Vector3(q[0], q[1], q[2]);
  stage.velocity = link.turn * Vector3(v[0], v[1], v[2]);
  stage.spin = stage.rotation * Vector3(v[3], v[4], v[5]);
  stage.arm = turned(stage.rotation, link.com);
  const TreeLink& set = body.tree->links.front();
  stage.force = set.force;
  stage.couple = set.torque;
}

void TiedBodies::begin(const Dynamics::Core& core) {
  const auto own = [this](int number, const Vector3& point) {
    if (number < 0) return Vector3(Vector3::Zero());
    return Vector3(point - bodies_[static_cast<std::size_t>(number)].tree->links.front().origin);
  };
  pulled_ = false;
  for (Tie& tie : ties_) {
    const SpringDescription& is = core.springs[tie.spring].is;
    tie.own_a = own(tie.a, is.point_a);
    tie.own_b = own(tie.b, is.point_b);
    tie.length = is.length;
    tie.strength = is.strength;
    tie.damping = is.damping;
    tie.plain = tie.a >= 0 && tie.b >= 0 && tie.own_a == Vector3::Zero() && tie.own_b == Vector3::Zero() &&
                is.mode == SpringMode::Both && is.maximum_force == 0;
  }
}

TiedBodies::End TiedBodies::end_of(const Dynamics::Core& core, int number, BodyIndex body, const Vector3& point,
                                   const Vector3& own) const {
  if (number < 0) {
    const Pose at = core.pose(body);
    const Vector3 arm = at.orientation * point;
    return {at.location + arm, core.bodies->velocity(body) + core.bodies->rotational_velocity(body).cross(arm)};
  }
  const Stage& stage = bodies_[static_cast<std::size_t>(number)].stage;
  const Vector3 arm = turned(stage.rotation, own);
  return {stage.origin + arm, stage.velocity + stage.spin.cross(arm)};
}

void TiedBodies::push(int number, const Vector3& force, const Vector3& point) {
  if (number < 0) return;
  Stage& stage = bodies_[static_cast<std::size_t>(number)].stage;
  stage.force += force;
  stage.couple += Vector3(point - stage.origin - stage.arm).cross(force);
}

/// A plain spring: `pull_of` without its cases.
void TiedBodies::pull(Tie& tie, Powers& powers) {
  Stage &a = bodies_[static_cast<std::size_t>(tie.a)].stage, &b = bodies_[static_cast<std::size_t>(tie.b)].stage;
  const Vector3 way = b.origin - a.origin;
  const double length = way.norm();
  tie.force = 0;
  if (!(length > 0)) return;
  const double inverse = 1 / length, speed = inverse * way.dot(b.velocity - a.velocity);
  tie.force = tie.strength * (length - tie.length) + tie.damping * speed;
  powers.drag += tie.damping * speed * speed;
  const Vector3 force = (tie.force * inverse) * way;
  a.force += force;
  b.force -= force;
  if (a.arm != Vector3::Zero()) a.couple -= a.arm.cross(force);
  if (b.arm != Vector3::Zero()) b.couple += b.arm.cross(force);
}

void TiedBodies::pull(const Dynamics::Core& core, Tie& tie, Powers& powers) {
  const SpringDescription& is = core.springs[tie.spring].is;
  const End a = end_of(core, tie.a, is.a, is.point_a, tie.own_a), b = end_of(core, tie.b, is.b, is.point_b, tie.own_b);
  const TiePull pull = pull_of(is, b.point - a.point, b.velocity - a.velocity);
  tie.force = pull.force;
  powers.drag += pull.loss;
  const Vector3 force = pull.force * pull.direction;
  push(tie.a, force, a.point);
  push(tie.b, -force, b.point);
}

/// Newton's equation of the centre of mass and Euler's in the body's own axes; `a` is of the link's frame.
void TiedBodies::answer(const Tied& body, const Vector3& gravity, const double* v, double* a) {
  const articulated::Body& link = only_link(*body.tree);
  const Stage& stage = body.stage;
  Vector3 force = stage.force, couple = stage.couple;
  if (body.tree->loads.reacts) {
    const double* reaction = body.tree->loads.reaction.data();
    const Vector3 push = link.turn * Vector3(reaction[0], reaction[1], reaction[2]);
    force += push;
    couple += stage.rotation * Vector3(reaction[3], reaction[4], reaction[5]) - stage.arm.cross(push);
  }
  const Vector3 spin(v[3], v[4], v[5]);
  articulated::Symmetric3 inverse;
  articulated::invert(link.inertia_com, inverse);
  const Vector3 own = inverse * (stage.rotation.transpose() * couple - spin.cross(link.inertia_com * spin));
  Vector3 way = gravity + force / link.mass;
  if (link.com != Vector3::Zero()) way -= stage.rotation * (own.cross(link.com) + spin.cross(spin.cross(link.com)));
  Eigen::Map<Vector3>{a} = link.turn.transpose() * way;
  Eigen::Map<Vector3>{a + 3} = own;
}

TiedBodies::Powers TiedBodies::accelerate(Dynamics::Core& core, const articulated::Vector& q,
                                          const articulated::Vector& v, articulated::Vector& a) {
  Powers powers;
  pulled_ = true;
  const double *from_q = q.data(), *from_v = v.data();
  for (Tied& body : bodies_) {
    Stage& stage = body.stage;
    place(body, from_q, from_v, stage);
    if (body.tree->pushed)
      powers.script += stage.force.dot(stage.velocity + stage.spin.cross(stage.arm)) + stage.couple.dot(stage.spin);
    from_q += kPositions;
    from_v += kVelocities;
  }
  for (Tie& tie : ties_)
    if (tie.plain)
      pull(tie, powers);
    else
      pull(core, tie, powers);
  from_v = v.data();
  double* to = a.data();
  for (const Tied& body : bodies_) {
    answer(body, core.settings.gravity, from_v, to);
    if (!Eigen::Map<const Eigen::Matrix<double, kVelocities, 1>>(to).allFinite())
      throw Error(ErrorCode::Numeric, body.tree->model.name(0) + ": its acceleration is not finite");
    from_v += kVelocities;
    to += kVelocities;
  }
  return powers;
}

void TiedBodies::note_forces(Dynamics::Core& core) const {
  if (!pulled_) return;
  for (const Tie& tie : ties_) core.springs[tie.spring].force = tie.force;
}

Vector3 TiedBodies::point_of(const Dynamics::Core& core, int number, BodyIndex body, const Vector3& point,
                             const Vector3& own) const {
  if (number < 0) {
    const Pose at = core.pose(body);
    return at.location + at.orientation * point;
  }
  const articulated::Data& data = bodies_[static_cast<std::size_t>(number)].tree->data;
  return data.motion_of(0).origin + turned(data.of(0).rotation, own);
}

double TiedBodies::spring_energy(const Dynamics::Core& core) const {
  double sum = 0;
  for (const Tie& tie : ties_) {
    if (tie.plain) {
      const articulated::Data &a = bodies_[static_cast<std::size_t>(tie.a)].tree->data,
                              &b = bodies_[static_cast<std::size_t>(tie.b)].tree->data;
      const double length = (b.motion_of(0).origin - a.motion_of(0).origin).norm(), stretch = length - tie.length;
      if (length > 0) sum += 0.5 * tie.strength * stretch * stretch;
      continue;
    }
    const SpringDescription& is = core.springs[tie.spring].is;
    const Vector3 way =
        point_of(core, tie.b, is.b, is.point_b, tie.own_b) - point_of(core, tie.a, is.a, is.point_a, tie.own_a);
    sum += pull_of(is, way, Vector3::Zero()).energy;
  }
  return sum;
}

}  // namespace breve
