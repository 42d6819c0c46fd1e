// Nine-link walkers for benchmarks: in worlds of ours through breve.h, and one in a multibody world of Bullet with the
// same links, masses, joints and motors on the same floor.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "tests/reference/world.hpp"

namespace breve::bench {

using reference::Vector3;

inline constexpr int kHinges = 8;
inline constexpr double kStrength = 6, kDamping = 0.05;  // N*m, N*m*s
inline constexpr double kFriction = 1;

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

/// Walkers on a floor, too far from one another to meet.
class Walkers : public reference::World {
 public:
  /// @param first  number of the genes of the first one; they repeat after `kinds`
  Walkers(breve_rung rung, double step, int count, int first = 0, int kinds = 1 << 20);
  void iterate();  // aims the motors, then a step
  int count() const { return static_cast<int>(walkers_.size()); }

 private:
  struct One {
    Genes genes;
    std::vector<breve_object> joints, parents, children;
    std::vector<breve_joint_drive> drives;
  };
  void add(const Vector3& at, const Genes& genes);
  double angle(breve_object parent, breve_object child) const;
  std::vector<breve_object> shapes_;  // of the sections, which all walkers share
  std::vector<One> walkers_;
};

/// The same with Bullet's multibody dynamics, in double precision, its sequential solver with 10 iterations.
class BulletWalker {
 public:
  BulletWalker(double step, const Genes& genes);
  ~BulletWalker();
  BulletWalker(const BulletWalker&) = delete;
  BulletWalker& operator=(const BulletWalker&) = delete;
  void iterate();
  double height() const;  // of the trunk

 private:
  struct Inside;
  std::unique_ptr<Inside> in_;
  double step_, time_ = 0;
  Genes genes_;
};

double cpu_seconds();
double median(std::vector<double> numbers);

}  // namespace breve::bench
