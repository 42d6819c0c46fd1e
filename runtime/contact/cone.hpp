// One contact alone: the exact answer of Coulomb's law for a point with a 3x3 response, and the projection on its cone.
#pragma once

namespace breve::contact {

/// A symmetric 3x3 matrix in (normal, tangent 1, tangent 2).
struct LocalMatrix {
  double nn = 0, n1 = 0, n2 = 0, s11 = 0, s12 = 0, s22 = 0;
};

/// The inverse of a positive semidefinite matrix, made regular by a share `kRegular` of its largest diagonal element;
/// zero if the matrix is.
inline constexpr double kRegular = 1e-11;
LocalMatrix regular_inverse(const LocalMatrix& matrix);

/// The impulse of a point that can neither open nor stick.
/// @param newton  steps for the direction at most
/// @param exact   search all directions if they do not end at a root; otherwise the direction is as good as they made
/// it
/// @param p       in: where the direction begins; out: the impulse
void slide_in_cone(const LocalMatrix& W, const double u0[3], double mu, int newton, bool exact, double p[3]);

/// The impulse p = (p_n, p_1, p_2) of one contact for which u = W p + u0 obeys: u_n >= 0, p_n >= 0, one of them zero;
/// |p_t| <= mu p_n; u_t = 0, or p_t has that length and points against u_t. If several do (Painleve), the one without
/// impulse, then the one that sticks. Never adds energy, lies in the cone to round-off, always finite.
/// @param u0       the velocity without the impulse, less what is wanted, m/s
/// @param inverse  of W, as regular_inverse makes it
/// @param newton   steps for the direction of sliding at most
/// @param exact    search all directions if they do not end at a root; otherwise the direction gets better from visit
/// to visit
/// @param p        in: an impulse nearby, whose direction is where the search for the direction begins; out: the
/// impulse Source: the sliding direction is a root of a quartic (Bonnefon and Daviet 2011, "Quartic formulation of
/// Coulomb 3D frictional contact"), found here on the circle by Newton's method, and by bracketing where that fails.
inline void sweep_cone(const LocalMatrix& W, const LocalMatrix& inverse, const double u0[3], double mu, int newton,
                       bool exact, double p[3]) {
  if (!(u0[0] < 0) || !(W.nn > 0)) {
    p[0] = p[1] = p[2] = 0;
    return;
  }
  if (mu == 0) {
    p[0] = -u0[0] / W.nn;
    p[1] = p[2] = 0;
    return;
  }
  const double stick0 = -(inverse.nn * u0[0] + inverse.n1 * u0[1] + inverse.n2 * u0[2]);
  const double stick1 = -(inverse.n1 * u0[0] + inverse.s11 * u0[1] + inverse.s12 * u0[2]);
  const double stick2 = -(inverse.n2 * u0[0] + inverse.s12 * u0[1] + inverse.s22 * u0[2]);
  const double radius = mu * stick0;
  if (!(stick0 > 0 && stick1 * stick1 + stick2 * stick2 <= radius * radius))
    return slide_in_cone(W, u0, mu, newton, exact, p);
  p[0] = stick0;
  p[1] = stick1;
  p[2] = stick2;
}

/// The nearest point with p_n >= 0 and |p_t| <= mu p_n that has the same p_n, if p_n >= 0; otherwise zero.
void clip_to_cone(double mu, double p[3]);

}  // namespace breve::contact
