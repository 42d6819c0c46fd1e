// Bodies in flight that rebound from one another and from what does not move.
#pragma once

#include "runtime/planar/core.hpp"

namespace breve {

/// One sub-step of bodies that nothing touches, and which may meet within it, along the parabolas between impacts.
class Planar::Core::Flight {
 public:
  explicit Flight(Core& core);
  static bool may_fly(const FlatBody& flat);
  /// Takes a body, and all that it may meet in flight within dt. Whether one of them rebounds then, and none can meet
  /// anything else.
  bool rebounds(FlatBody& first, double dt);
  /// Takes the sub-step, which rebounds() has looked at, as far as the bodies rebound. Returns s, that are left of it.
  double take(double dt);
  std::span<FlatBody* const> bodies() const { return bodies_; }

 private:
  /// Two shapes that may meet, or a shape and an edge of a profile.
  struct Near {
    b2Fixture *a, *b;
    int child;  // of b
  };
  Vector2 acceleration(const FlatBody& flat) const;
  b2Vec2 gained(const FlatBody& flat, double t) const;
  b2AABB passed_over(const FlatBody& flat, b2Fixture& own, double t) const;
  bool approach(const FlatBody& a, const FlatBody& b, double t) const;
  void look_around(FlatBody& flat, double t);
  void add(FlatBody& flat, b2Fixture* own, const b2AABB& box, b2Fixture* other, int child, double t);
  bool take_in(FlatBody& flat);
  void find_impact(double t);
  bool bounces() const;
  void move(FlatBody& flat, double t) const;

  Core& core_;
  std::pmr::vector<FlatBody*> bodies_;
  std::pmr::vector<Near> near_;
  Hit hit_;
  bool found_ = false, alone_ = true, begun_ = false;
};

}  // namespace breve
