// A solid cut by planes without ever closing the cut: what convex decomposition measures its cuts with.
// The surface is a set of convex polygons. Each cut clips every polygon for itself and closes both parts by a fan of
// signed triangles in the plane of the cut: the triangles may overlap, and what is too much cancels, so that volumes by
// the divergence theorem are right whatever the outline of the cut is, with holes or in many pieces.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/solid/polyhedron.hpp"

namespace breve {

/// Convex polygons, counter-clockwise seen from outside, one after the other.
struct PolygonSet {
  std::pmr::vector<Vector3> corners;
  std::pmr::vector<std::uint32_t> ends;  // one past the last corner of each

  explicit PolygonSet(std::pmr::memory_resource* memory) : corners(memory), ends(memory) {}
  void add_triangle(const Vector3& a, const Vector3& b, const Vector3& c);
  void close() { ends.push_back(static_cast<std::uint32_t>(corners.size())); }
};

/// The part of a solid that is in a convex cell.
struct CellPart {
  PolygonSet surface;  // of the solid, in the cell
  PolygonSet caps;     // signed triangles in the planes of the cuts
  PolygonSet cell;     // the faces of the cell

  explicit CellPart(std::pmr::memory_resource* memory) : surface(memory), caps(memory), cell(memory) {}
  std::size_t corner_count() const { return surface.corners.size() + caps.corners.size() + cell.corners.size(); }
  double volume() const;
};

/// Clip `part` by a plane into what is behind it (normal . p < offset) and what is in front. Corners within `hair` of
/// the plane are on it. Cost O(corners).
void cut(const CellPart& part, const Plane& plane, double hair, CellPart& behind, CellPart& front);

}  // namespace breve
