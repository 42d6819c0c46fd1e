// Newton's and Euler's equations of each body, once the springs have pulled.
#include "runtime/dynamics/spring_network.hpp"

#include <algorithm>

#include "runtime/articulated/joints.hpp"
#include "runtime/base/error.hpp"

namespace breve {

namespace {

constexpr int kPositions = 7, kVelocities = 6;  // of a body

/// A point in the link's frame as a vector from its origin, in world axes, m.
Vector3 rotated(const Matrix3& rotation, const Vector3& arm) {
  return arm == Vector3::Zero() ? arm : Vector3(rotation * arm);
}

const articulated::Body& only_link(const Tree& tree) { return tree.model.body(0); }

}  // namespace

bool SpringNetwork::are(std::span<Tree* const> trees) {
  return std::all_of(trees.begin(), trees.end(), [](const Tree* tree) {
    return tree->model.size() == 1 && only_link(*tree).type == articulated::JointType::Free && tree->loops.empty();
  });
}

void SpringNetwork::place(const Node& body, const double* q, const double* v, Stage& stage) {
  const articulated::Body& link = only_link(*body.tree);
  stage.rotation.noalias() = link.rotation * articulated::rotation_matrix(q + 3);
  stage.origin = link.position + link.rotation * Vector3(q[0], q[1], q[2]);
  stage.velocity = link.rotation * Vector3(v[0], v[1], v[2]);
  stage.spin = stage.rotation * Vector3(v[3], v[4], v[5]);
  stage.arm = rotated(stage.rotation, link.com);
  const TreeLink& set = body.tree->links.front();
  stage.force = set.force;
  stage.couple = set.torque;
}

void SpringNetwork::begin(const Dynamics::Core& core) {
  const auto own = [this](int number, const Vector3& point) {
    if (number < 0) return Vector3(Vector3::Zero());
    return Vector3(point - bodies_[static_cast<std::size_t>(number)].tree->links.front().origin);
  };
  pulled_ = false;
  for (Edge& edge : edges_) {
    const SpringDescription& is = core.springs[edge.spring].is;
    edge.own_a = own(edge.a, is.point_a);
    edge.own_b = own(edge.b, is.point_b);
    edge.length = is.length;
    edge.strength = is.strength;
    edge.damping = is.damping;
    edge.plain = edge.a >= 0 && edge.b >= 0 && edge.own_a == Vector3::Zero() && edge.own_b == Vector3::Zero() &&
                 is.mode == SpringMode::Both && is.maximum_force == 0;
  }
}

SpringNetwork::End SpringNetwork::end_of(const Dynamics::Core& core, int number, BodyIndex body, const Vector3& point,
                                         const Vector3& own) const {
  if (number < 0) {
    const Pose at = core.pose(body);
    const Vector3 arm = at.orientation * point;
    return {at.location + arm, core.bodies->velocity(body) + core.bodies->rotational_velocity(body).cross(arm)};
  }
  const Stage& stage = bodies_[static_cast<std::size_t>(number)].stage;
  const Vector3 arm = rotated(stage.rotation, own);
  return {stage.origin + arm, stage.velocity + stage.spin.cross(arm)};
}

void SpringNetwork::push(int number, const Vector3& force, const Vector3& point) {
  if (number < 0) return;
  Stage& stage = bodies_[static_cast<std::size_t>(number)].stage;
  stage.force += force;
  stage.couple += Vector3(point - stage.origin - stage.arm).cross(force);
}

/// A plain spring: `pull_of` without its cases.
void SpringNetwork::pull(Edge& edge, Powers& powers) {
  Stage &a = bodies_[static_cast<std::size_t>(edge.a)].stage, &b = bodies_[static_cast<std::size_t>(edge.b)].stage;
  const Vector3 way = b.origin - a.origin;
  const double length = way.norm();
  edge.force = 0;
  if (!(length > 0)) return;
  const double inverse = 1 / length, speed = inverse * way.dot(b.velocity - a.velocity);
  edge.force = edge.strength * (length - edge.length) + edge.damping * speed;
  powers.drag += edge.damping * speed * speed;
  const Vector3 force = (edge.force * inverse) * way;
  a.force += force;
  b.force -= force;
  if (a.arm != Vector3::Zero()) a.couple -= a.arm.cross(force);
  if (b.arm != Vector3::Zero()) b.couple += b.arm.cross(force);
}

void SpringNetwork::pull(const Dynamics::Core& core, Edge& edge, Powers& powers) {
  const SpringDescription& is = core.springs[edge.spring].is;
  const End a = end_of(core, edge.a, is.a, is.point_a, edge.own_a),
            b = end_of(core, edge.b, is.b, is.point_b, edge.own_b);
  const SpringPull pull = pull_of(is, b.point - a.point, b.velocity - a.velocity);
  edge.force = pull.force;
  powers.drag += pull.loss;
  const Vector3 force = pull.force * pull.direction;
  push(edge.a, force, a.point);
  push(edge.b, -force, b.point);
}

/// Newton's equation of the centre of mass and Euler's in the body's own axes; `a` is of the link's frame.
void SpringNetwork::answer(const Node& body, const Vector3& gravity, const double* v, double* a) {
  const articulated::Body& link = only_link(*body.tree);
  const Stage& stage = body.stage;
  Vector3 force = stage.force, couple = stage.couple;
  if (body.tree->loads.reacts) {
    const double* reaction = body.tree->loads.reaction.data();
    const Vector3 push = link.rotation * Vector3(reaction[0], reaction[1], reaction[2]);
    force += push;
    couple += stage.rotation * Vector3(reaction[3], reaction[4], reaction[5]) - stage.arm.cross(push);
  }
  const Vector3 spin(v[3], v[4], v[5]);
  articulated::Symmetric3 inverse;
  articulated::invert(link.inertia_com, inverse);
  const Vector3 own = inverse * (stage.rotation.transpose() * couple - spin.cross(link.inertia_com * spin));
  Vector3 way = gravity + force / link.mass;
  if (link.com != Vector3::Zero()) way -= stage.rotation * (own.cross(link.com) + spin.cross(spin.cross(link.com)));
  Eigen::Map<Vector3>{a} = link.rotation.transpose() * way;
  Eigen::Map<Vector3>{a + 3} = own;
}

SpringNetwork::Powers SpringNetwork::accelerate(Dynamics::Core& core, const articulated::Vector& q,
                                                const articulated::Vector& v, articulated::Vector& a) {
  Powers powers;
  pulled_ = true;
  const double *from_q = q.data(), *from_v = v.data();
  for (Node& body : bodies_) {
    Stage& stage = body.stage;
    place(body, from_q, from_v, stage);
    if (body.tree->pushed)
      powers.script += stage.force.dot(stage.velocity + stage.spin.cross(stage.arm)) + stage.couple.dot(stage.spin);
    from_q += kPositions;
    from_v += kVelocities;
  }
  for (Edge& edge : edges_)
    if (edge.plain)
      pull(edge, powers);
    else
      pull(core, edge, powers);
  from_v = v.data();
  double* to = a.data();
  for (const Node& body : bodies_) {
    answer(body, core.settings.gravity, from_v, to);
    if (!Eigen::Map<const Eigen::Matrix<double, kVelocities, 1>>(to).allFinite())
      throw Error(ErrorCode::Numeric, body.tree->model.name(0) + ": its acceleration is not finite");
    from_v += kVelocities;
    to += kVelocities;
  }
  return powers;
}

void SpringNetwork::note_forces(Dynamics::Core& core) const {
  if (!pulled_) return;
  for (const Edge& edge : edges_) core.springs[edge.spring].force = edge.force;
}

Vector3 SpringNetwork::point_of(const Dynamics::Core& core, int number, BodyIndex body, const Vector3& point,
                                const Vector3& own) const {
  if (number < 0) {
    const Pose at = core.pose(body);
    return at.location + at.orientation * point;
  }
  const articulated::Data& data = bodies_[static_cast<std::size_t>(number)].tree->data;
  return data.motion_of(0).origin + rotated(data.of(0).rotation, own);
}

double SpringNetwork::spring_energy(const Dynamics::Core& core) const {
  double sum = 0;
  for (const Edge& edge : edges_) {
    if (edge.plain) {
      const articulated::Data &a = bodies_[static_cast<std::size_t>(edge.a)].tree->data,
                              &b = bodies_[static_cast<std::size_t>(edge.b)].tree->data;
      const double length = (b.motion_of(0).origin - a.motion_of(0).origin).norm(), stretch = length - edge.length;
      if (length > 0) sum += 0.5 * edge.strength * stretch * stretch;
      continue;
    }
    const SpringDescription& is = core.springs[edge.spring].is;
    const Vector3 way =
        point_of(core, edge.b, is.b, is.point_b, edge.own_b) - point_of(core, edge.a, is.a, is.point_a, edge.own_a);
    sum += pull_of(is, way, Vector3::Zero()).energy;
  }
  return sum;
}

}  // namespace breve
