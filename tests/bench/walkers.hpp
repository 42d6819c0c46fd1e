// Nine-link walkers for benchmarks: in worlds of ours through breve.h, and one in a multibody world of Bullet with the
// same links, masses, joints and motors on the same floor.
#pragma once

#include <memory>
#include <vector>

#include "tests/reference/world.hpp"
#include "tests/scenes/nine_links.hpp"

namespace breve::bench {

using reference::Vector3;

using scenes::Genes;
using scenes::genes;
using scenes::kHinges;
using scenes::Section;
using scenes::sections;

inline constexpr double kStrength = scenes::kHingeStrength, kDamping = 0.05;  // N*m, N*m*s
inline constexpr double kFriction = 1;

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
    std::vector<breve_drive> drives;
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
