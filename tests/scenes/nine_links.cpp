// The nine-link walker.
#include "tests/scenes/nine_links.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace breve::scenes {

double Genes::goal(int hinge, double time) const {
  const auto i = static_cast<std::size_t>(hinge);
  return amplitudes[i] * std::sin(2 * std::numbers::pi * (time / wavelength + phases[i]));
}

Genes genes(int n) {
  std::minstd_rand random(static_cast<unsigned>(n) + 1);
  random.discard(10);
  const auto uniform = [&random] { return static_cast<double>(random()) / std::minstd_rand::max(); };
  Genes made;
  made.wavelength = 0.5 + 1.5 * uniform();
  for (double& phase : made.phases) phase = uniform();
  for (double& amplitude : made.amplitudes) amplitude = uniform();
  return made;
}

const std::array<Section, kHinges + 1>& sections() {
  static const std::array<Section, kHinges + 1> all = [] {
    std::array<Section, kHinges + 1> made;
    made[0] = {Vector3(2, 0.5, 1), Vector3::Zero(), Vector3::Zero(), -1};
    std::size_t n = 1;
    for (const double x : {-0.8, 0.8})
      for (const double z : {-0.65, 0.65}) {
        made[n] = {Vector3(0.25, 0.7, 0.25), Vector3(x, -0.2, z), Vector3(0, 0.3, 0), 0};
        made[n + 1] = {Vector3(0.2, 0.7, 0.2), Vector3(0, -0.35, 0), Vector3(0, 0.35, 0), static_cast<int>(n)};
        n += 2;
      }
    return made;
  }();
  return all;
}

}  // namespace breve::scenes
