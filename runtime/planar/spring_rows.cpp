// Springs and dampers of a sub-step: where their ends are, and what each pulls along a path of its bodies.
#include "runtime/planar/spring_rows.hpp"

#include <algorithm>
#include <cmath>

namespace breve {

namespace {

Vector2 rotated(const Vector2& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

}  // namespace

SpringRows::SpringRows(Planar::Core& core)
    : core_(core),
      nodes_(core.memory),
      rows_(core.memory),
      node_of_(core.memory),
      assemblies_(core.memory),
      parts_(core.memory),
      part_of_(core.memory),
      inertias_(core.memory),
      shares_(core.memory),
      couplings_(core.memory),
      residual_(core.memory),
      tolerance_(core.memory),
      diagonal_(core.memory),
      step_(core.memory),
      left_(core.memory),
      ahead_(core.memory),
      way_(core.memory),
      pushed_(core.memory),
      scratch_(core.memory) {}

void SpringRows::begin(double dt) {
  dt_ = dt;
  nodes_.clear();
  rows_.clear();
  node_of_.assign(core_.slots.size(), -1);
  assemblies_.clear();
  looks_ = 0;
}

int SpringRows::node_of(FlatBody* flat) {
  if (!flat || flat->fixed) return -1;
  int& known = node_of_[static_cast<std::size_t>(flat - core_.slots.data())];
  if (known >= 0) return known;
  known = static_cast<int>(nodes_.size());
  const b2Vec2 v = flat->b2->GetLinearVelocity();
  Node made;
  made.flat = flat;
  made.root = known;
  made.start << core_.settings.unit * vector_of(v), double{flat->b2->GetAngularVelocity()};
  nodes_.push_back(made);
  return known;
}

SpringRows::End SpringRows::end_of(BodyIndex body, const Vector3& own, Vector2& point) {
  End end;
  FlatBody* flat = core_.find(body);
  if (!flat) {
    const Pose at = core_.pose(body);
    const Vector3 arm = at.orientation * own;
    point = (at.location + arm).head<2>();
    end.velocity = (core_.bodies->velocity(body) + core_.bodies->rotational_velocity(body).cross(arm)).head<2>();
    return end;
  }
  const b2Body& b = *flat->b2;
  const double u = core_.settings.unit;
  const b2Vec2 arm = b.GetWorldVector(b2Vec2(static_cast<float>(own.x() / u), static_cast<float>(own.y() / u)));
  point = u * (vector_of(b.GetPosition()) + vector_of(arm));
  end.arm = point - u * vector_of(b.GetWorldCenter());
  end.velocity = u * vector_of(b.GetLinearVelocity()) + double{b.GetAngularVelocity()} * left_of(end.arm);
  end.node = node_of(flat);
  return end;
}

/// Whether its force is not just in proportion to its stretch.
bool SpringRows::bends(const SpringDescription& is) { return is.mode != SpringMode::Both || is.maximum_force > 0; }

/// A spring of that length, without its damper.
SpringRows::Elastic SpringRows::elastic_of(const SpringDescription& is, double length) {
  if (bends(is)) {
    const SpringPull pull = pull_of(is, {length, 0, 0}, Vector3::Zero());
    return {pull.force, pull.energy};
  }
  if (!(length > 0)) return {};  // no direction to pull along
  const double stretch = length - is.length, force = is.strength * stretch;
  return {force, 0.5 * force * stretch};
}

void SpringRows::add(FlatSpring& spring) {
  Row row;
  row.spring = &spring;
  row.strength = spring.is.strength;
  row.damping = spring.is.damping;
  Vector2 from, to;
  row.ends[0] = end_of(spring.is.a, spring.is.point_a, from);
  row.ends[1] = end_of(spring.is.b, spring.is.point_b, to);
  row.way = to - from;
  row.from = row.way.norm();
  row.first = elastic_of(spring.is, row.from);
  connect(row.ends[0].node, row.ends[1].node);
  rows_.push_back(row);
}

/// Its position grows as the parent rotates or moves along the axis, relative to the child.
void SpringRows::add(FlatJoint& joint) {
  const JointDrive& drive = joint.drive;
  Row row;
  row.joint = &joint;
  row.strength = drive.stiffness;
  row.damping = drive.damping;
  FlatBody* bodies[2] = {joint.is.parent == kNoBody ? nullptr : core_.find(joint.is.parent),
                         core_.find(joint.is.child)};
  const double u = core_.settings.unit;
  const bool rotates = joint.is.kind == JointKind::Revolute;
  row.stretch = -drive.rest[0];
  if (rotates) {
    row.stretch -= joint.is.normal.z() * double{static_cast<b2RevoluteJoint*>(joint.b2)->GetJointAngle()};
  } else {
    row.stretch -= u * double{static_cast<b2PrismaticJoint*>(joint.b2)->GetJointTranslation()};
  }
  for (int i = 0; i < 2; ++i) {
    End& end = row.ends[i];
    end.node = node_of(bodies[i]);
    const double sign = i == 0 ? 1 : -1;
    end.along = {0, 0, sign * joint.is.normal.z()};
    if (end.node < 0 || rotates) continue;
    // A force acts along the line through the child's point, on both.
    const Vector2 axis = sign * core_.axis_of(joint);
    end.arm = u * (vector_of(joint.b2->GetAnchorB()) - vector_of(bodies[i]->b2->GetWorldCenter()));
    end.along << axis, cross(end.arm, axis);
  }
  connect(row.ends[0].node, row.ends[1].node);
  rows_.push_back(row);
}

/// The inverse effective mass of a row at an end.
double SpringRows::mobility(const End& end) const {
  if (end.node < 0) return 0;
  const MassProperties& mass = node(end.node).flat->mass;
  return end.along.head<2>().squaredNorm() / mass.mass + end.along.z() * end.along.z() / mass.inertia(2, 2);
}

void SpringRows::move_end(End& end, double h) const {
  end.moved = end.node < 0 ? Vector2(h * end.velocity) : Vector2(h * node(end.node).path.head<2>());
  end.mean = end.arm;
  if (end.node >= 0 && end.arm != Vector2::Zero()) rotate_end(end, h);
}

/// The point moves along a chord; this arm gives the torque about the centre of mass that does the same work.
void SpringRows::rotate_end(End& end, double h) const {
  const double half = h * node(end.node).path.z() / 2;
  end.moved += rotated(end.arm, 2 * half) - end.arm;
  end.mean = (half == 0 ? 1 : std::sin(half) / half) * rotated(end.arm, half);
}

/// @param h  s, that its bodies have moved: all of the sub-step, or 0 for the spring as it stands
void SpringRows::evaluate_spring(Row& row, double h) {
  for (End& end : row.ends) move_end(end, h);
  const Vector2 after = row.way + row.ends[1].moved - row.ends[0].moved;
  const double from = row.from, to = after.norm(), both = from + to;
  row.force = row.loss = row.stored = row.stiff = row.sideways = 0;
  row.size = both / 2;
  if (!(both > 0)) return;  // no direction to pull along
  const bool ends = row.rule == Rule::End && h > 0 && to > 0;
  if (ends)  // the gradient of what is stored then
    for (End& end : row.ends)
      if (end.node >= 0 && end.arm != Vector2::Zero()) end.mean = rotated(end.arm, h * node(end.node).path.z());
  const Vector2 along = ends ? Vector2(after / to) : Vector2((row.way + after) / both), across = left_of(along);
  for (int i = 0; i < 2; ++i) {
    End& end = row.ends[i];
    const double sign = i == 0 ? -1 : 1;
    end.along << sign * along, sign * cross(end.mean, along);
    end.across << sign * across, sign * cross(end.mean, across);
  }
  if (h > 0) set_elastic(row, to);
  row.sideways = std::max(row.force, 0.0) * dt_ / (ends ? to : both);
}

/// The force for a length that goes from one to another, and the loss in the damper.
void SpringRows::set_elastic(Row& row, double to) {
  const SpringDescription& is = row.spring->is;
  const double from = row.from;
  const Elastic& first = row.first;
  const Elastic last = elastic_of(is, to);
  const auto slack = [&](double length) {
    return (is.mode == SpringMode::ExpandOnly && length > is.length) ||
           (is.mode == SpringMode::ContractOnly && length < is.length);
  };
  if (slack(from) && slack(to)) return;
  constexpr double kSame = 1e-6;  // of the length: the mean of the forces is exact enough
  double elastic = row.rule == Rule::End ? last.force : (first.force + last.force) / 2;
  if (row.rule == Rule::Mean && bends(is) && std::abs(to - from) > kSame * (from + to))
    elastic = (last.energy - first.energy) / (to - from);
  row.force = elastic + row.damping * (to - from) / dt_;
  if (is.maximum_force > 0) row.force = std::clamp(row.force, -is.maximum_force, is.maximum_force);
  row.loss = (row.force - elastic) * (to - from);
  row.stored = last.energy + row.loss / 2;
  row.stiff = row.strength * (row.rule == Rule::End ? dt_ : dt_ / 2) + row.damping;
}

void SpringRows::evaluate_joint(Row& row) {
  double rate = 0;
  for (const End& end : row.ends)
    if (end.node >= 0) rate += end.along.dot(node(end.node).path);
  const double ahead = row.rule == Rule::End ? dt_ : dt_ / 2;
  row.force = row.strength * (row.stretch + ahead * rate) + row.damping * rate;
  row.loss = row.damping * rate * rate * dt_;
  const double stretch = row.stretch + dt_ * rate;
  row.stored = (row.strength * stretch * stretch + row.loss) / 2;
  row.stiff = row.strength * ahead + row.damping;
}

/// All that depends on the path.
void SpringRows::evaluate(const Part& part) {
  looks_ += part.rows.size();
  for (Row* row : part.rows) {
    if (row->rule == Rule::Now) continue;
    if (row->spring)
      evaluate_spring(*row, dt_);
    else
      evaluate_joint(*row);
  }
}

/// As it stands at the start.
void SpringRows::evaluate_now(Row& row) {
  double rate = 0;
  if (row.spring) {
    evaluate_spring(row, 0);
    const Vector2 speed = row.ends[1].velocity - row.ends[0].velocity;
    const SpringPull pull = pull_of(row.spring->is, {row.way.x(), row.way.y(), 0}, {speed.x(), speed.y(), 0});
    row.force = pull.force;
    row.loss = pull.loss * dt_;
    return;
  }
  for (const End& end : row.ends)
    if (end.node >= 0) rate += end.along.dot(node(end.node).start);
  row.force = row.strength * row.stretch + row.damping * rate;
  row.loss = row.damping * rate * rate * dt_;
}

}  // namespace breve
