// The gap between two bodies along a sub-step of smooth motion, of which both ends are known.
#pragma once

#include <algorithm>
#include <cmath>

namespace breve {

/// Lengths in m; rates for the whole sub-step, also in m.
struct GapPath {
  double start, end;
  double start_rate, end_rate;

  /// Whether a cubic through both ends follows the gap: what swings to and fro several times in between goes a way that
  /// its ends do not tell. An oscillation at w does not follow from w h = 1.1 on.
  bool follows() const {
    constexpr double kFollows = 0.1;  // of the faster rate
    const double missing = end - start - 0.5 * (start_rate + end_rate);
    return std::abs(missing) <= kFollows * std::max(std::abs(start_rate), std::abs(end_rate));
  }

  /// The smallest gap of Hermite's cubic.
  double least() const {
    const double a = 2 * (start - end) + start_rate + end_rate, b = 3 * (end - start) - 2 * start_rate - end_rate;
    double least = std::min(start, end);
    const auto look = [&](double s) {
      if (s > 0 && s < 1) least = std::min(least, start + s * (start_rate + s * (b + s * a)));
    };
    // Roots of 3 a s^2 + 2 b s + start_rate, without cancellation.
    const double root = std::sqrt(std::max(0.0, b * b - 3 * a * start_rate)), q = -(b + std::copysign(root, b));
    if (a != 0) look(q / (3 * a));
    if (q != 0) look(start_rate / q);
    return least;
  }

  /// The bodies are apart at both ends and, as far as these tell, in between.
  bool stays_open() const { return start > 0 && end > 0 && (!follows() || least() > 0); }
};

}  // namespace breve
