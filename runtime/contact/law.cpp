// Combination of materials; the older kind of number and the exact kind each by its own rule.
#include "runtime/contact/law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace breve::contact {

namespace {

/// The root of the square of a number is that number again, so equal bodies give their own, bit for bit.
double geometric_mean(double a, double b) { return std::sqrt(std::min(a * b, std::numeric_limits<double>::max())); }

}  // namespace

Law combine(const Material& a, const Material& b, double unit) {
  Law law;
  const bool exact_friction =
      a.static_friction >= 0 && b.static_friction >= 0 && a.dynamic_friction >= 0 && b.dynamic_friction >= 0;
  if (exact_friction) {
    law.static_friction = geometric_mean(a.static_friction, b.static_friction);
    law.dynamic_friction = geometric_mean(a.dynamic_friction, b.dynamic_friction);
  } else {
    law.static_friction = law.dynamic_friction = std::max(0.0, 1 + (a.friction + b.friction) / 2);
  }
  // What slides must not hold better than what rests.
  law.dynamic_friction = std::min(law.dynamic_friction, law.static_friction);

  if (a.normal_restitution >= 0 && b.normal_restitution >= 0) {
    law.restitution = std::max(a.normal_restitution, b.normal_restitution);
    law.tangential_restitution = std::max(a.tangential_restitution, b.tangential_restitution);
    law.restitution_threshold = std::max(a.restitution_threshold, b.restitution_threshold);
  } else {
    law.restitution = (a.restitution + b.restitution) / 2;
    law.restitution_threshold = kRestingApproach * unit;
  }
  law.restitution = std::clamp(law.restitution, 0.0, 1.0);
  law.tangential_restitution = std::clamp(law.tangential_restitution, -1.0, 1.0);
  return law;
}

}  // namespace breve::contact
