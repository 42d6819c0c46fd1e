// A body without joints, and how it moves when nothing touches it.
#pragma once

#include "runtime/dynamics/core.hpp"

namespace breve {

/// About its centre of mass, world axes.
struct FreeBody {
  const MassProperties* solid = nullptr;
  Vector3 center = Vector3::Zero(), velocity = Vector3::Zero(), spin = Vector3::Zero();
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
  Quaternion orientation{1, 0, 0, 0};

  Matrix3 inertia() const {
    const Matrix3 r = orientation.toRotationMatrix();
    return r * solid->inertia * r.transpose();
  }
  /// Rotates it by hand: it keeps its angular momentum, and what does not look alike from all sides spins otherwise.
  /// @param unseen  rad/s, a change of its spin that need not be made
  /// @return        J, that it gained by that
  double rotate(const Vector3& rotation, double unseen);
  double kinetic() const {
    const Vector3 own = orientation.conjugate() * spin;
    return 0.5 * (solid->mass * velocity.squaredNorm() + own.dot(solid->inertia * own));
  }
};

FreeBody read_free(const Bodies& bodies, BodyIndex body);
void write_free(Bodies& bodies, BodyIndex body, const FreeBody& free);

/// How far a body may rotate in a sub-step, rad, so that a rule of fixed steps follows it.
inline constexpr double kMostRotation = 0.5;

/// Whether free bodies move by semi-implicit Euler: on `fast`, whose scheme for trees that is, their parabola is exact.
bool semi_implicit(const Accuracy& accuracy);

/// Its rotation in h seconds without contacts, by the rung's rule.
/// @param next_step  s, of step control; in and out
void rotate_free(FreeBody& body, const Accuracy& accuracy, double time, double h, double& next_step, Meter& meter);

/// One step of h seconds without contacts. Translation is exact (on `fast` semi-implicit), rotation by the rung's rule.
/// @param next_step  s, of step control; in and out
void move_free(FreeBody& body, const Accuracy& accuracy, const Vector3& gravity, double time, double h,
               double& next_step, Meter& meter);

/// Whether a rung is finer than another: an island takes the finest of its bodies.
bool finer(Rung a, Rung b);

}  // namespace breve
