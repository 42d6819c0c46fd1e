// Contact springs. Calibration: with damping ratio z and w = 1, a contact comes to rest after a(z) = acos(z) / sqrt(1 -
// z^2) and has lost exp(-z a(z)) of its speed; parting, the force ends after the same time and factor, and the surface
// leaves the gap 2 z v behind, which takes another 2 z. (Schwager and Poeschel 2007, "Coefficient of restitution and
// linear-dashpot model revisited".)
#include "runtime/contact/springs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace breve::contact {

namespace {

constexpr double kTangential = 2.0 / 7.0;
constexpr double kMostDamping = 0.9;
constexpr double kHardening = 4.5;      // at twice its linear depth a spring is ten times as stiff
constexpr double kLeastDamping = 0.05;  // along the surface, where a slider needs a damper to follow

double time_to_rest(double z) {
  if (std::abs(1 - z) < 1e-9) return 1;
  return z < 1 ? std::acos(z) / std::sqrt(1 - z * z) : std::acosh(z) / std::sqrt(z * z - 1);
}

double loss(double z) { return z * time_to_rest(z); }  // of the logarithm of the speed; grows with z

/// The argument where a growing function passes `value`.
template <class F>
double invert(double low, double high, double value, F&& f) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) < value ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double damping_ratio(double restitution) {
  if (!(restitution > 0)) return kMostDamping;
  const double loss = -std::log(std::min(restitution, 1.0));
  return std::min(loss / std::hypot(std::numbers::pi, loss), kMostDamping);
}

Dashpots calibrate(double zeta) {
  zeta = std::clamp(zeta, 0.0, kMostDamping);
  if (zeta == 0) return {};
  const double s = std::sqrt(1 - zeta * zeta);
  const double wanted_loss = std::numbers::pi * zeta / s, wanted_time = std::numbers::pi / s;
  const double most = std::exp(wanted_loss);  // loss(z) > log(z) + 0.6 beyond 1
  const auto partner = [&](double out) { return invert(0, most, wanted_loss - loss(out), loss); };
  const auto time = [&](double out) { return time_to_rest(partner(out)) + time_to_rest(out) + 2 * out; };
  const double out = invert(0, invert(0, most, wanted_loss, loss), wanted_time, time);
  return {partner(out), out};
}

Spring make_spring(double stiffness, const Dashpots& dashpots, double mass, const Law& law) {
  const double scale = 2 * std::sqrt(stiffness * mass);
  Spring spring;
  spring.stiffness = stiffness;
  spring.in = dashpots.in * scale;
  spring.out = dashpots.out * scale;
  spring.tangential_stiffness = kTangential * stiffness;
  spring.tangential_damping = kTangential * std::max(0.5 * (spring.in + spring.out), kLeastDamping * scale);
  spring.static_friction = law.static_friction;
  spring.dynamic_friction = law.dynamic_friction;
  return spring;
}

Press press(const Spring& spring, double gap, double gap_rate) {
  Press out;
  if (!(gap < 0)) return out;
  const double depth = -gap;
  double elastic = spring.stiffness * depth;
  out.stored = 0.5 * elastic * depth;
  if (spring.linear_depth > 0 && depth > spring.linear_depth) {
    const double beyond = depth - spring.linear_depth;
    const double harder = kHardening * spring.stiffness / spring.linear_depth * beyond * beyond;
    elastic += harder;
    out.stored += harder * beyond / 3;
  }
  const double damper = gap_rate < 0 ? spring.in : spring.out;
  const double acts = depth < spring.damped_depth ? depth / spring.damped_depth : 1;
  out.force = std::max(0.0, elastic - acts * damper * gap_rate);
  out.loss = (elastic - out.force) * gap_rate;
  return out;
}

Drag drag(const Spring& spring, const Vector2& stretch, const Vector2& slip, double normal_force) {
  Drag out;
  out.stored = 0.5 * spring.tangential_stiffness * stretch.squaredNorm();
  const Vector2 elastic = spring.tangential_stiffness * stretch;
  const Vector2 held = elastic + spring.tangential_damping * slip;
  const double size = held.norm();
  if (size <= spring.static_friction * normal_force) {
    out.force = -held;
    out.stretch_rate = slip;
  } else {
    out.slides = true;
    const Vector2 limit = held * (std::min(1.0, spring.dynamic_friction * normal_force / size));
    out.force = -limit;
    out.stretch_rate = (limit - elastic) / spring.tangential_damping;  // spring and damper carry what it lets through
  }
  out.loss = elastic.dot(-out.stretch_rate) - out.force.dot(slip);
  return out;
}

}  // namespace breve::contact
