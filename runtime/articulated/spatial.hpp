// Algebra of one rigid or articulated body: pairs of 3-vectors and symmetric blocks instead of 6x6 matrices, because a
// block that is known to be symmetric or zero need not be multiplied.
//
// Frame of everything here: axes of the world, moments about the origin of the link's own frame (which sits on its
// inboard joint). World axes mean that an inertia moves from child to parent by a shift alone, without a rotation; own
// origins mean that no digits are lost far from the world's origin. Accelerations are the plain ones of that point (not
// spatial accelerations), so that linear velocities never enter the dynamics.
#pragma once

#include "runtime/base/math.hpp"

namespace breve::articulated {

/// A symmetric 3x3 matrix.
struct Symmetric3 {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  static Symmetric3 identity(double s) { return {s, 0, 0, s, 0, s}; }
  /// From the upper triangle of `m`.
  template <class M>
  static Symmetric3 upper(const M& m) {
    return {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
  }

  Vector3 operator*(const Vector3& v) const {
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z()};
  }
  Symmetric3& operator+=(const Symmetric3& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
    return *this;
  }
  /// Minus u v^T, where u is a multiple of v.
  void subtract_outer(const Vector3& u, const Vector3& v) {
    xx -= u.x() * v.x(), xy -= u.x() * v.y(), xz -= u.x() * v.z();
    yy -= u.y() * v.y(), yz -= u.y() * v.z(), zz -= u.z() * v.z();
  }
  Matrix3 matrix() const {
    Matrix3 m;
    m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m;
  }
  double trace() const { return xx + yy + zz; }

  /// R S R^T: the same tensor in the axes that R maps to.
  Symmetric3 rotated(const Matrix3& r) const {
    const Vector3 a = *this * Vector3(r.row(0)), b = *this * Vector3(r.row(1)), c = *this * Vector3(r.row(2));
    return {r.row(0).dot(a), r.row(0).dot(b), r.row(0).dot(c), r.row(1).dot(b), r.row(1).dot(c), r.row(2).dot(c)};
  }
};

/// [v]x, the matrix of the cross product: [v]x w = v x w.
inline Matrix3 cross_matrix(const Vector3& v) {
  Matrix3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Inverse of a positive-definite `s` by L D L^T. Returns false if a pivot has no correct digit left.
inline bool invert(const Symmetric3& s, Symmetric3& out) {
  constexpr double kNoDigits = 4e-16;  // two units of round-off, relative to the largest possible pivot
  const double least = kNoDigits * s.trace();
  const double d0 = s.xx;
  if (!(d0 > least)) return false;
  const double l10 = s.xy / d0, l20 = s.xz / d0;
  const double d1 = s.yy - l10 * s.xy;
  if (!(d1 > least)) return false;
  const double l21 = (s.yz - l20 * s.xy) / d1;
  const double d2 = s.zz - l20 * s.xz - l21 * l21 * d1;
  if (!(d2 > least)) return false;
  const double i0 = 1 / d0, i1 = 1 / d1, i2 = 1 / d2;
  const double m20 = l10 * l21 - l20;  // L^-1 is unit lower with -l10, m20, -l21
  out.zz = i2;
  out.yz = -l21 * i2;
  out.xz = m20 * i2;
  out.yy = i1 + l21 * l21 * i2;
  out.xy = -l10 * i1 - l21 * m20 * i2;
  out.xx = i0 + l10 * l10 * i1 + m20 * m20 * i2;
  return true;
}

/// Inertia of a body with whatever hangs on it: couple = a*alpha + b*acc, force = b^T*alpha + c*acc. 21 numbers.
struct ArticulatedInertia {
  Symmetric3 a;                 // kg*m^2
  Matrix3 b = Matrix3::Zero();  // kg*m
  Symmetric3 c;                 // kg

  /// A rigid body: `about_origin` its inertia about the frame's origin, `moment` mass times centre of mass.
  void set_rigid(const Symmetric3& about_origin, const Vector3& moment, double mass) {
    a = about_origin;
    b = cross_matrix(moment);
    c = Symmetric3::identity(mass);
  }
  Vector3 couple(const Vector3& alpha, const Vector3& acc) const { return a * alpha + b * acc; }
  Vector3 force(const Vector3& alpha, const Vector3& acc) const { return b.transpose() * alpha + c * acc; }

  /// Takes away what a free direction of motion does not feel: minus w w^T * inverse with w = (couple, force).
  void subtract_dyad(const Vector3& couple, const Vector3& force, double inverse) {
    const Vector3 k = inverse * couple, l = inverse * force;
    a.subtract_outer(k, couple);
    b.noalias() -= k * force.transpose();
    c.subtract_outer(l, force);
  }

  /// Adds `child`, as seen at a point that lies at `r` in the child's stead: X^T child X with X = [1 0; -[r]x 1].
  void add_shifted(const ArticulatedInertia& child, const Vector3& r) {
    c += child.c;
    // b' = b + [r]x c;  a' = a - b [r]x + [r]x b'^T, of which only the upper triangle is needed.
    const Symmetric3& k = child.c;
    const Matrix3& o = child.b;
    Matrix3 n;
    n << o(0, 0) + r.y() * k.xz - r.z() * k.xy, o(0, 1) + r.y() * k.yz - r.z() * k.yy,
        o(0, 2) + r.y() * k.zz - r.z() * k.yz, o(1, 0) + r.z() * k.xx - r.x() * k.xz,
        o(1, 1) + r.z() * k.xy - r.x() * k.yz, o(1, 2) + r.z() * k.xz - r.x() * k.zz,
        o(2, 0) + r.x() * k.xy - r.y() * k.xx, o(2, 1) + r.x() * k.yy - r.y() * k.xy,
        o(2, 2) + r.x() * k.yz - r.y() * k.xz;
    b += n;
    a.xx += child.a.xx + (r.y() * o(0, 2) - r.z() * o(0, 1)) + (r.y() * n(0, 2) - r.z() * n(0, 1));
    a.xy += child.a.xy + (r.z() * o(0, 0) - r.x() * o(0, 2)) + (r.y() * n(1, 2) - r.z() * n(1, 1));
    a.xz += child.a.xz + (r.x() * o(0, 1) - r.y() * o(0, 0)) + (r.y() * n(2, 2) - r.z() * n(2, 1));
    a.yy += child.a.yy + (r.z() * o(1, 0) - r.x() * o(1, 2)) + (r.z() * n(1, 0) - r.x() * n(1, 2));
    a.yz += child.a.yz + (r.x() * o(1, 1) - r.y() * o(1, 0)) + (r.z() * n(2, 0) - r.x() * n(2, 2));
    a.zz += child.a.zz + (r.x() * o(2, 1) - r.y() * o(2, 0)) + (r.x() * n(2, 1) - r.y() * n(2, 0));
  }
};

}  // namespace breve::articulated
