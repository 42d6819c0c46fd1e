// The nine-link walker of scenes and benchmarks: a trunk on four legs of two links, eight hinges.
#pragma once

#include <array>
#include <vector>

#include "tests/scenes/scene.hpp"

namespace breve::scenes {

inline constexpr int kHinges = 8;
inline constexpr double kHingeStrength = 6;  // N*m

/// How the hinges are driven: each motor aims at a sine of time.
struct Genes {
  double wavelength = 1;
  std::array<double, kHinges> phases{}, amplitudes{};
  double goal(int hinge, double time) const;                  // rad
  double speed(int hinge, double time, double angle) const {  // rad/s
    return 8 * (goal(hinge, time) - angle);
  }
};
/// The n-th of a series that is always the same.
Genes genes(int n);

/// A box and where it hangs: numbers of both walkers. Links 2 k + 1 hang on the trunk, 2 k + 2 on the one before.
struct Section {
  Vector3 size, on_parent, on_child;
  int parent;  // -1: it is the trunk
};
const std::array<Section, kHinges + 1>& sections();

}  // namespace breve::scenes
