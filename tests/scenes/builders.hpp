// What the files of scenes share. Each builder makes one family of scenes.
#pragma once

#include <random>

#include "tests/scenes/scene.hpp"

namespace breve::scenes {

/// Numbers that are the same with every library.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * static_cast<double>(random_()) / 4294967296.0; }
  Vector3 within(const Vector3& half);  // of the box between -half and half
  Quaternion orientation(bool flat);

 private:
  std::mt19937 random_;
};

/// A fixed box whose top is the plane y = 0.
void add_floor(Scene& scene, double length = 400);

Scene clump(int count, bool flat);
Scene springs(int side, bool flat);
Scene meshes();
Scene terrain_agents();
Scene terrain_balls(bool flat);
Scene pyramid(bool flat);
Scene dominoes(bool flat);
Scene crowd(bool flat);
Scene pour(bool flat);

enum class Wheels { Prisms, Balls };
Scene vehicle(Wheels wheels, bool flat);
Scene walkers(int count, bool flat);
Scene ragdoll(bool flat);

}  // namespace breve::scenes
