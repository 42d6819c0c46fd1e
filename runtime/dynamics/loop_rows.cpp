// Which relations each kind of joint holds: two or three of position, none to three of rotation.
#include "runtime/dynamics/loop_rows.hpp"

#include "runtime/contact/impact_law.hpp"
#include "runtime/dynamics/core.hpp"
#include "runtime/dynamics/joint_frames.hpp"

namespace breve {

namespace {

/// The parent's side of the row is where the child's point is, along a prismatic joint's axis far from its own: what
/// rotates with the parent is then told from what slides.
void add_linear(const Vector3& axis, const Vector3& child, const Vector3& parent, LoopRows& rows) {
  rows.add({axis, false, child, child, axis.dot(child - parent)});
}

void add_angular(const Vector3& axis, double error, LoopRows& rows) {
  LoopRow row;
  row.axis = axis;
  row.angular = true;
  row.error = error;
  rows.add(row);
}

/// Position and rotation of an end: a link of the tree as it stands, or a body that does not move by itself.
Pose end_pose(const Dynamics::Core& core, const Tree& tree, BodyIndex body, int& link) {
  link = -1;
  if (body == kNoBody) return {};
  if (!core.bodies->dynamic(body)) return core.pose(body);
  link = core.find(body)->link;
  return tree.pose(link);
}

}  // namespace

LoopRows Dynamics::Core::loop_rows(const Tree& tree, const JointDescription& is) const {
  LoopRows rows;
  const Pose child = end_pose(*this, tree, is.child, rows.child);
  const Pose parent = end_pose(*this, tree, is.parent, rows.parent);
  const Vector3 on_child = child.location + child.orientation * is.child_point;
  const Vector3 on_parent = parent.location + parent.orientation * is.parent_point;
  Vector3 normal = Vector3::UnitX(), t1, t2;
  if (is.kind != JointKind::Fixed) normal = parent.orientation * is.normal;
  contact::tangents(normal, t1, t2);
  if (is.kind != JointKind::Prismatic) add_linear(normal, on_child, on_parent, rows);
  add_linear(t1, on_child, on_parent, rows);
  add_linear(t2, on_child, on_parent, rows);
  // A small rotation from where the child should be; twice the vector part of its quaternion.
  Quaternion open = child.orientation * (parent.orientation * is.relative_rotation).conjugate();
  if (open.w() < 0) open.coeffs() = -open.coeffs();
  const Vector3 rotation = 2 * open.vec();
  switch (is.kind) {
    case JointKind::Fixed:
    case JointKind::Prismatic:
      for (const Vector3* axis : {&normal, &t1, &t2}) add_angular(*axis, axis->dot(rotation), rows);
      break;
    case JointKind::Revolute: {
      const Vector3 of_child = child.orientation * (is.relative_rotation.conjugate() * is.normal);
      const Vector3 tilt = normal.cross(of_child);
      add_angular(t1, tilt.dot(t1), rows);
      add_angular(t2, tilt.dot(t2), rows);
      break;
    }
    case JointKind::Universal: {
      const Vector3 second = child.orientation * (is.relative_rotation.conjugate() * axes_of(is).second);
      const Vector3 across = normal.cross(second);
      rows.universal = true;
      rows.first = normal;
      rows.second = second;
      if (across.norm() > 0) add_angular(across.normalized(), -normal.dot(second), rows);
      break;
    }
    case JointKind::Ball: break;
  }
  return rows;
}

}  // namespace breve
