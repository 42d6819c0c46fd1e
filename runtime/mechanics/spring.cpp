// Springs between bodies: what their numbers must be, and what one does now.
#include "runtime/mechanics/spring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"

namespace breve {

namespace {

void require(bool holds, std::string_view property, double value, std::string_view rule) {
  if (!holds) throw Error(ErrorCode::Argument, fmt::format("spring: {} must be {}, but is {}", property, rule, value));
}

}  // namespace

void check(const SpringDescription& is) {
  if (!is.point_a.allFinite() || !is.point_b.allFinite())
    throw Error(ErrorCode::Argument, "spring: a point of attachment is not finite");
  require(std::isfinite(is.length) && is.length >= 0, "length", is.length, "finite and >= 0");
  require(std::isfinite(is.strength) && is.strength >= 0, "strength", is.strength, "finite and >= 0");
  require(std::isfinite(is.damping) && is.damping >= 0, "damping", is.damping, "finite and >= 0");
  require(std::isfinite(is.maximum_force) && is.maximum_force >= 0, "maximum force", is.maximum_force,
          "finite and >= 0");
}

SpringPull pull_of(const SpringDescription& is, const Vector3& way, const Vector3& rate) {
  SpringPull pull;
  const double length = way.norm();
  if (!(length > 0)) return pull;  // no direction to pull along
  if (is.mode == SpringMode::ExpandOnly && length > is.length) return pull;
  if (is.mode == SpringMode::ContractOnly && length < is.length) return pull;
  pull.direction = way / length;
  const double stretch = length - is.length, speed = pull.direction.dot(rate);
  const double elastic = is.strength * stretch;
  pull.force = elastic + is.damping * speed;
  pull.energy = 0.5 * is.strength * stretch * stretch;
  if (is.maximum_force > 0) {
    // Beyond the bound the force is constant: the energy goes on linearly, and no damper acts.
    const double reach = is.strength > 0 ? is.maximum_force / is.strength : 0;
    if (std::abs(stretch) > reach && is.strength > 0)
      pull.energy = is.maximum_force * (std::abs(stretch) - 0.5 * reach);
    pull.force = std::clamp(pull.force, -is.maximum_force, is.maximum_force);
    pull.loss = (pull.force - std::clamp(elastic, -is.maximum_force, is.maximum_force)) * speed;
  } else {
    pull.loss = is.damping * speed * speed;
  }
  return pull;
}

}  // namespace breve
