// Bodies and numbers at random, and the energy that they may not gain: for tests that throw what nobody has chosen.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "world.hpp"

namespace breve::reference {

/// The largest rise of the energy above the lowest that it was before, J.
struct Rise {
  double low, most = 0;
  explicit Rise(const World& world) : low(world.mechanical()) {}
  void look(const World& world) {
    const double now = world.mechanical();
    low = std::min(low, now);
    most = std::max(most, now - low);
  }
};

/// Ask for one number after the other, and never inside of a list of arguments: compilers differ in their order.
struct Chance {
  std::mt19937 random;
  double between(double low, double high) { return low + (high - low) * static_cast<double>(random()) / 4294967296.0; }
  Vector3 vector(double most) { return Vector3{between(-most, most), between(-most, most), between(-most, most)}; }
  bool one_in(std::uint32_t n) { return random() % n == 0; }
};

/// A ball, a box, a capsule or, in space, a cylinder: 0.15 to 0.5 m, 0.2 to 4.5 kg.
inline Solid any_solid(Chance& chance, bool flat) {
  const double mass = std::exp(chance.between(-1.5, 1.5)), size = chance.between(0.15, 0.5);
  const auto edge = [&] { return size * chance.between(0.3, 1); };
  switch (chance.random() % 4) {
    case 0: return sphere(0.5 * size, mass);
    case 1: return box(Vector3{edge(), edge(), edge()}, mass);
    default: break;
  }
  Solid solid;
  solid.geometry.kind = flat || chance.one_in(2) ? BREVE_SHAPE_CAPSULE : BREVE_SHAPE_CYLINDER;
  solid.geometry.radius = 0.3 * size;
  solid.geometry.height = size;
  solid.mass = mass;
  return solid;
}

}  // namespace breve::reference
