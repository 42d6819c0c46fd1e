// What a tree of bodies is made of, without where it is: links, joints, inertias. Const once built, shared by all
// states.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/articulated/spatial.hpp"

namespace breve::articulated {

/// The freedom of a link's inboard joint, with its positions q, velocities v and joint forces.
enum class JointType {
  Revolute,   // q: angle about `axis`; v its rate; torque along it
  Prismatic,  // q: way along `axis`; v its rate; force along it
  Universal,  // q: two angles, Rot(axis, q0) Rot(axis2, q1); v their rates; torques conjugate to them
  Ball,   // q: unit quaternion, child's axes to joint frame; v: the child's spin relative to its parent, child's axes
  Free,   // q: place in the joint frame, then quaternion; v: rate of the place, then spin in the child's axes
  Fixed,  // none
};

/// Numbers that a joint adds to q and to v.
constexpr int position_count(JointType type) {
  constexpr int kCounts[] = {1, 1, 2, 4, 7, 0};
  return kCounts[static_cast<int>(type)];
}
constexpr int velocity_count(JointType type) {
  constexpr int kCounts[] = {1, 1, 2, 3, 6, 0};
  return kCounts[static_cast<int>(type)];
}
/// Whether the k-th velocity of a joint is of a length, m/s, not of an angle, rad/s.
constexpr bool is_length(JointType type, int k) {
  return type == JointType::Prismatic || (type == JointType::Free && k < 3);
}

/// A link and its inboard joint, as described by whoever builds a model. The body frame coincides with the joint frame
/// when the joint is at zero: its origin lies on the joint.
struct Link {
  std::string name;                       // for messages; may be empty
  int parent = -1;                        // index below this link's own; -1: the world
  JointType type = JointType::Revolute;   // Free needs the world as parent
  Vector3 position = Vector3::Zero();     // joint frame's origin in the parent's body frame, m
  Quaternion rotation{1, 0, 0, 0};        // joint frame to parent's body frame, unit
  Vector3 axis = Vector3::UnitZ();        // revolute, prismatic, universal: unit, in the joint frame
  Vector3 axis2 = Vector3::UnitX();       // universal: unit, perpendicular to `axis`
  double mass = 1;                        // kg, > 0
  Vector3 com = Vector3::Zero();          // centre of mass in the body frame, m
  Matrix3 inertia = Matrix3::Identity();  // about the centre of mass, body axes, positive definite, kg*m^2
};

/// A link as the algorithms read it: what can be worked out beforehand is.
struct Body {
  JointType type;
  int parent;           // -1: the world
  int q, v;             // where its joint's numbers begin
  int wide;             // index among joints with more than one degree of freedom; -1: none
  double mass;          // kg
  Vector3 position;     // joint frame's origin in the parent's frame
  Vector3 axis, axis2;  // in the joint frame
  // The joint's rotation in the parent's axes is rotation + sin(q) rotation_sin + cos(q) rotation_cos for revolute
  // joints and the first angle of universal ones (Rodrigues' formula, multiplied out); for all others it begins with
  // `rotation`.
  Matrix3 rotation, rotation_sin, rotation_cos;
  Vector3 com;             // in the body frame
  Vector3 moment;          // mass * com
  Symmetric3 inertia;      // about the body frame's origin, body axes
  Symmetric3 inertia_com;  // about the centre of mass, body axes
};

class Model {
 public:
  /// @param links  parents before children
  /// @throws Error{Argument} naming link and property: no links; parent not below the link; a number that is not
  /// finite;
  ///         mass not positive; inertia not symmetric or not positive definite; axis or rotation not of unit length
  ///         (within 1e-6; what is within is normalised); axes of a universal joint not perpendicular; a free joint
  ///         that hangs on another link
  explicit Model(const std::vector<Link>& links);

  int size() const { return static_cast<int>(bodies_.size()); }
  int positions() const { return nq_; }   // length of q
  int velocities() const { return nv_; }  // length of v
  int wide_joints() const { return wide_; }
  const Body& body(int link) const { return bodies_[static_cast<std::size_t>(link)]; }
  const std::vector<Body>& bodies() const { return bodies_; }
  double mass() const { return mass_; }  // of all links, kg

  /// "link 'leg'" or "link 3", for messages.
  std::string name(int link) const;

 private:
  void add(const Link& link);

  std::vector<Body> bodies_;
  std::vector<std::string> names_;
  int nq_ = 0, nv_ = 0, wide_ = 0;
  double mass_ = 0;
};

}  // namespace breve::articulated
