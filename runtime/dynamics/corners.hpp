// Solids of many corners: to find how deep they are in one another takes work of its own.
#pragma once

#include <cstddef>

#include "runtime/solid/shape.hpp"

namespace breve {

/// The corners of two convex solids together; 0 if they are few, or if one is a surface.
inline std::size_t many_corners(const Shape& a, const Shape& b) {
  constexpr std::size_t kMany = 128;
  if (a.surface() != nullptr || b.surface() != nullptr) return 0;
  const std::size_t corners = a.polyhedron().vertices.size() + b.polyhedron().vertices.size();
  return corners < kMany ? 0 : corners;
}

}  // namespace breve
