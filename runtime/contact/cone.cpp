// One contact under Coulomb's law: it opens, sticks or slides, and is asked in this order.
#include "runtime/contact/cone.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace breve::contact {

namespace {

/// How the velocity of sliding depends on a unit direction d of friction, while the normal velocity is held at zero:
/// u_t(d) = (M d + c) / D(d), p_n(d) = load / D(d), with D(d) = W_nn + mu W_nt . d.
struct Sliding {
  double m11, m12, m21, m22, c1, c2;
  double nn, mu_n1, mu_n2, load, mu;

  Sliding(const LocalMatrix& W, const double u0[3], double friction)
      : m11(friction * (u0[1] * W.n1 - u0[0] * W.s11)),
        m12(friction * (u0[1] * W.n2 - u0[0] * W.s12)),
        m21(friction * (u0[2] * W.n1 - u0[0] * W.s12)),
        m22(friction * (u0[2] * W.n2 - u0[0] * W.s22)),
        c1(u0[1] * W.nn - u0[0] * W.n1),
        c2(u0[2] * W.nn - u0[0] * W.n2),
        nn(W.nn),
        mu_n1(friction * W.n1),
        mu_n2(friction * W.n2),
        load(-u0[0]),
        mu(friction) {}

  double divisor(double x, double y) const { return nn + mu_n1 * x + mu_n2 * y; }

  /// Across the direction: zero where u_t is parallel to d. `along` must not be positive: friction opposes.
  double across(double x, double y, double& along, double& slope) const {
    const double f1 = m11 * x + m12 * y + c1, f2 = m21 * x + m22 * y + c2;
    along = x * f1 + y * f2;
    const double rotated1 = m12 * x - m11 * y, rotated2 = m22 * x - m21 * y;  // M times the normal of d
    slope = x * rotated2 - y * rotated1 - along;
    return x * f2 - y * f1;
  }

  bool good(double x, double y) const {
    double along = 0, slope = 0;
    across(x, y, along, slope);
    return along <= 0 && divisor(x, y) > 1e-12 * nn;
  }

  void impulse(double x, double y, double p[3]) const {
    p[0] = load / divisor(x, y);
    p[1] = mu * p[0] * x;
    p[2] = mu * p[0] * y;
  }
};

/// Newton's method on the circle from (x, y). True if it ended at a root; the direction is a unit vector in any case.
bool rotate_to_root(const Sliding& sliding, int steps, double& x, double& y) {
  for (int i = 0; i < steps; ++i) {
    double along = 0, slope = 0;
    const double g = sliding.across(x, y, along, slope);
    if (std::abs(g) <= 1e-15 * (std::abs(along) + std::abs(slope))) return true;
    if (!(slope > 0)) return false;
    const double angle = std::clamp(-g / slope, -1.0, 1.0);
    const double nx = x - angle * y, ny = y + angle * x;
    const double scale = 1 / std::sqrt(nx * nx + ny * ny);
    x = nx * scale;
    y = ny * scale;
    if (std::abs(angle) < 1e-8) return true;  // the next step would be its square
  }
  return false;
}

/// Unit vectors all around the circle, the first and the last the same.
class Directions {
 public:
  static constexpr int kCount = 48;
  struct Direction {
    double x, y;
  };
  static const Direction& at(int i) {
    static const Directions all;
    return all.directions_[static_cast<std::size_t>(i)];
  }

 private:
  Directions() {
    for (int i = 0; i <= kCount; ++i) {
      const double angle = i % kCount * (2 * std::numbers::pi / kCount);
      directions_[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle)};
    }
  }
  std::array<Direction, kCount + 1> directions_;
};

/// Every root lies between two of these directions where the sign changes; the first good one of the scan.
bool scan_for_root(const Sliding& sliding, double& x, double& y) {
  double along = 0, slope = 0;
  double before = sliding.across(1, 0, along, slope);
  for (int i = 1; i <= Directions::kCount; ++i) {
    Directions::Direction low = Directions::at(i - 1), high = Directions::at(i);
    const double here = sliding.across(high.x, high.y, along, slope);
    if ((before <= 0) != (here <= 0)) {
      for (int halving = 0; halving < 52; ++halving) {
        Directions::Direction middle{low.x + high.x, low.y + high.y};
        const double scale = 1 / std::sqrt(middle.x * middle.x + middle.y * middle.y);
        middle = {middle.x * scale, middle.y * scale};
        const bool as_before = (sliding.across(middle.x, middle.y, along, slope) <= 0) == (before <= 0);
        (as_before ? low : high) = middle;
      }
      if (sliding.good(high.x, high.y)) {
        x = high.x;
        y = high.y;
        return true;
      }
    }
    before = here;
  }
  return false;
}

/// No direction obeys the law in these numbers: at least stop the approach.
void stop_without_friction(const LocalMatrix& W, const double u0[3], double p[3]) {
  p[0] = -u0[0] / W.nn;
  p[1] = p[2] = 0;
}

}  // namespace

namespace {
/// Newton's method from a direction, which need not be a unit vector, to a good one.
bool search_from(const Sliding& sliding, int steps, bool exact, double x, double y, double p[3]) {
  const double length = std::sqrt(x * x + y * y);
  if (!(length > 0)) return false;
  x /= length;
  y /= length;
  const bool root = rotate_to_root(sliding, steps, x, y);
  if (!(root || !exact) || !sliding.good(x, y)) return false;
  sliding.impulse(x, y, p);
  return true;
}
}  // namespace

void slide_in_cone(const LocalMatrix& W, const double u0[3], double mu, int newton, bool exact, double p[3]) {
  const Sliding sliding(W, u0, mu);
  if (search_from(sliding, newton, exact, p[1], p[2], p)) return;
  // Against the way it would slide if friction pushed on nothing but that: as it does on a ball.
  if (search_from(sliding, newton, exact, -sliding.c1, -sliding.c2, p)) return;
  double x = 0, y = 0;
  if (scan_for_root(sliding, x, y)) return sliding.impulse(x, y, p);
  stop_without_friction(W, u0, p);
}

LocalMatrix regular_inverse(const LocalMatrix& W) {
  const double largest = std::max({W.nn, W.s11, W.s22});
  if (!(largest > 0)) return {};
  // Scaled to 1, so that products of three elements neither overflow nor vanish.
  const double scale = 1 / largest;
  const double a = W.nn * scale + kRegular, b = W.n1 * scale, c = W.n2 * scale;
  const double d = W.s11 * scale + kRegular, e = W.s12 * scale, f = W.s22 * scale + kRegular;
  const double minor_a = d * f - e * e, minor_b = c * e - b * f, minor_c = b * e - c * d;
  const double determinant = a * minor_a + b * minor_b + c * minor_c;
  if (!(determinant > 0)) return {};
  const double over = scale / determinant;
  return {minor_a * over,         minor_b * over,         minor_c * over,
          (a * f - c * c) * over, (b * c - a * e) * over, (a * d - b * b) * over};
}

void clip_to_cone(double mu, double p[3]) {
  if (!(p[0] > 0)) {
    p[0] = p[1] = p[2] = 0;
    return;
  }
  const double length = std::sqrt(p[1] * p[1] + p[2] * p[2]), radius = mu * p[0];
  if (length <= radius) return;
  p[1] *= radius / length;
  p[2] *= radius / length;
}

}  // namespace breve::contact
