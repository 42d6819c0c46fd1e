// The edges of a convex solid as arcs on the unit sphere of directions, from the normal of one face to that of the
// other: who looks for arcs that cross another one looks at few. Source: Gregorius 2013, "The separating axis test".
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/base/math.hpp"

namespace breve {

/// A ball around an arc: its middle direction (unit), and the largest chord from there to a point of the arc.
struct ArcBall {
  static constexpr double kRoundOff = 1e-9;

  Vector3 middle = Vector3::UnitX();
  double reach = 2;

  /// The ball around the shorter arc between two unit vectors.
  static ArcBall between(const Vector3& from, const Vector3& to);
  bool meets(const ArcBall& other) const {
    const double most = reach + other.reach + kRoundOff;
    return (middle - other.middle).squaredNorm() <= most * most;
  }
};

class GaussMap {
 public:
  explicit GaussMap(std::pmr::memory_resource* memory)
      : balls_(memory), start_(memory), edges_(memory), wide_(memory) {}
  GaussMap(const GaussMap& other, std::pmr::memory_resource* memory)
      : balls_(other.balls_, memory),
        start_(other.start_, memory),
        edges_(other.edges_, memory),
        wide_(other.wide_, memory),
        most_reach_(other.most_reach_) {}

  void clear();
  bool empty() const { return balls_.empty(); }
  /// @param balls  of the edges, in their order
  void build(std::pmr::vector<ArcBall> balls);
  /// Numbers of the edges whose balls meet this one, ascending, into `out`.
  void meeting(const ArcBall& ball, std::vector<std::uint32_t>& out) const;

 private:
  static constexpr int kCells = 24;       // along each axis, over [-1, 1]
  static constexpr double kWide = 0.125;  // reach of arcs that are looked at always

  std::pmr::vector<ArcBall> balls_;                // by edge
  std::pmr::vector<std::uint32_t> start_, edges_;  // edges by the cell of their middle
  std::pmr::vector<std::uint32_t> wide_;
  double most_reach_ = 0;  // of those in cells
};

}  // namespace breve
