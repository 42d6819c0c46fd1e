// What a shape is in a flat world: where the plane z = 0 of its own frame cuts it. A ball gives a circle, a box a
// rectangle, a capsule a rectangle between two circles, any solid its outline, cut into convex pieces of at most eight
// corners; a height field gives a profile.
#pragma once

#include <memory_resource>
#include <vector>

#include "runtime/base/math.hpp"
#include "runtime/solid/shape.hpp"

namespace breve {

using Vector2 = Eigen::Vector2d;
inline double cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Length units, the shape's own frame.
struct FlatPiece {
  enum class Kind : std::uint8_t { Circle, Polygon, Profile };
  Kind kind = Kind::Circle;
  double radius = 0;                 // Circle
  Vector2 center = Vector2::Zero();  // Circle
  std::pmr::vector<Vector2>
      points;  // Polygon: convex, counter-clockwise, at most kMostCorners; Profile: solid to the left

  explicit FlatPiece(std::pmr::memory_resource* memory) : points(memory) {}
};

struct Outline {
  static constexpr std::size_t kMostCorners = 8;
  std::pmr::vector<FlatPiece> pieces;
  double thickness = 0;  // half the narrowest width of a piece; infinite for a profile alone
  bool solid = true;     // false: a profile, which only what does not move can be

  explicit Outline(std::pmr::memory_resource* memory) : pieces(memory) {}
};

/// Error{Argument} if the plane does not meet the shape.
/// Concave outlines: ears are cut off (Meisters 1975) and triangles merged while they stay convex (Hertel and Mehlhorn
/// 1983).
Outline outline_of(const Shape& shape, std::pmr::memory_resource* memory);

/// A convex polygon moved inward by `margin` on every side; the corners that are left. Fewer than 3: nothing is left.
std::pmr::vector<Vector2> shrunk(const std::pmr::vector<Vector2>& polygon, double margin);

/// Half the least distance of two parallel lines with a convex polygon between them.
double half_width(const std::pmr::vector<Vector2>& polygon);

}  // namespace breve
