// How bodies that joints connect answer impulses: what collisions, stops of joints and set velocities are solved with.
#pragma once

#include <Eigen/Cholesky>

#include "runtime/planar/core.hpp"

namespace breve {

/// How some bodies answer impulses, each of them (force, force, torque about the centre of mass), in Box2D's units.
/// Free bodies answer alone; what joints connect answers as a whole, M^-1 - M^-1 J^T (J M^-1 J^T)^-1 J M^-1, with J the
/// velocities that the joints forbid. Assemblies with more than 100 joints answer as if none held.
class Response {
 public:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  /// About the centre of mass, in Box2D's units.
  static double inertia(const FlatBody& flat);

  /// The response of two bodies and their assemblies. Null, or what does not move by itself, answers nothing.
  Response(const Planar::Core& core, FlatBody* a, FlatBody* b);

  Eigen::Index size() const { return 3 * static_cast<Eigen::Index>(bodies_.size()); }
  std::span<FlatBody* const> bodies() const { return bodies_; }
  bool holds() const { return jacobian_.rows() > 0; }  // joints hold some of them
  /// Where its three numbers are; -1 for what does not move by itself.
  Eigen::Index index_of(const FlatBody& flat) const;

  /// What these impulses, (size), change velocities by.
  Vector answer(const Vector& impulses) const;
  /// The impulse P on b and -P on a, each at its arm from the centre of mass.
  Vector answer(const Vector2& arm_a, const Vector2& arm_b, const Vector2& impulse) const;
  /// The same of a torque on b, and its opposite on a.
  Vector answer_rotation() const;
  /// The change of the velocity of a point of a body.
  Vector2 at_point(const FlatBody& flat, const Vector2& arm, const Vector& change) const;
  /// The change of its angular velocity.
  double spin(const FlatBody& flat, const Vector& change) const;
  /// The least change, by kinetic energy, to these velocities after which the joints allow them.
  Vector allowed(const Vector& velocities) const;

  /// What impulses of joints hold against these on the bodies, (size), as a step of Box2D may start from.
  std::pmr::vector<std::pair<JointIndex, WarmJoint>> holding(const Vector& impulses) const;

  Vector velocities() const;  // as Box2D has them
  void give(const Vector& change) const;
  double kinetic() const;  // in Box2D's units

 private:
  void gather(FlatBody& flat);
  void hold_joints();
  void add_rows(const FlatJoint& joint, Matrix& jacobian, Eigen::Index& rows) const;

  const Planar::Core& core_;
  std::pmr::vector<FlatBody*> bodies_;
  std::pmr::vector<JointIndex> held_;
  Vector mobility_;
  Matrix jacobian_, spread_, columns_;  // columns_: of the impulses on a, and on b
  Eigen::LDLT<Matrix> between_;
};

}  // namespace breve
