// Clipping of polygons by the method of Sutherland and Hodgman (1974), and the fans that close what it leaves open.
#include "runtime/solid/cell_cut.hpp"

#include <cmath>
#include <utility>

namespace breve {

void PolygonSet::add_triangle(const Vector3& a, const Vector3& b, const Vector3& c) {
  corners.insert(corners.end(), {a, b, c});
  close();
}

namespace {

using Rim = std::pmr::vector<std::pair<Vector3, Vector3>>;  // edges in the plane of a cut, as polygons run them

/// One polygon with the heights of its corners over a plane.
struct Heights {
  const Plane& plane;
  double hair;

  double of(const Vector3& p) const {
    const double height = plane.normal.dot(p) - plane.offset;
    return std::abs(height) <= hair ? 0 : height;
  }
};

/// Where an edge crosses the plane; the same point whichever way it is run, since `low` is the end behind the plane.
Vector3 crossing(const Vector3& low, double depth, const Vector3& high, double height) {
  return low + (depth / (depth - height)) * (high - low);
}

/// Appends the part of a polygon on one side (sign 1: behind); its edges in the plane are appended to `rim`.
void clip_to(const Vector3* corners, std::size_t count, const Heights& heights, double sign, PolygonSet& out,
             Rim& rim) {
  const std::size_t first = out.corners.size(), first_edge = rim.size();
  std::size_t level_before = SIZE_MAX;  // whether the corner put out last is in the plane, and where it stands
  const auto put = [&](const Vector3& p, bool level) {
    if (level && level_before != SIZE_MAX) rim.emplace_back(out.corners[level_before], p);
    level_before = level ? out.corners.size() : SIZE_MAX;
    out.corners.push_back(p);
  };
  bool first_level = false;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3 &p = corners[i], &q = corners[(i + 1) % count];
    const double hp = sign * heights.of(p), hq = sign * heights.of(q);
    if (hp <= 0) {
      if (out.corners.size() == first) first_level = hp == 0;
      put(p, hp == 0);
    }
    if (hp * hq >= 0) continue;
    const bool p_behind = sign > 0 ? hp < 0 : hp > 0;  // behind the plane, whichever side is asked for
    const Vector3 x = p_behind ? crossing(p, sign * hp, q, sign * hq) : crossing(q, sign * hq, p, sign * hp);
    if (out.corners.size() == first) first_level = true;
    put(x, true);
  }
  if (out.corners.size() - first < 3) {
    out.corners.resize(first);
    rim.resize(first_edge);
    return;
  }
  if (first_level && level_before != SIZE_MAX) rim.emplace_back(out.corners[level_before], out.corners[first]);
  out.close();
}

/// Put each polygon on its side, or a part on either; one in the plane goes to the side that it bounds.
void clip_all(const PolygonSet& set, const Heights& heights, PolygonSet& behind, PolygonSet& front, Rim& rim_behind,
              Rim& rim_front) {
  std::uint32_t begin = 0;
  for (const std::uint32_t end : set.ends) {
    const Vector3* const corners = set.corners.data() + begin;
    const std::size_t count = end - begin;
    begin = end;
    bool low = false, high = false;
    for (std::size_t i = 0; i < count; ++i) {
      const double height = heights.of(corners[i]);
      low = low || height < 0;
      high = high || height > 0;
    }
    if (!low && !high) {
      const Vector3 area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      low = area.dot(heights.plane.normal) > 0;
      high = !low;
    }
    if (low) clip_to(corners, count, heights, 1, behind, rim_behind);
    if (high) clip_to(corners, count, heights, -1, front, rim_front);
  }
}

/// Close a part along its rim: a fan that runs each edge the other way.
void close_with_fan(const Rim& rim, PolygonSet& out) {
  if (rim.empty()) return;
  const Vector3& base = rim.front().first;
  for (const auto& [from, to] : rim) {
    if (from != base && to != base) out.add_triangle(base, to, from);
  }
}

}  // namespace

double CellPart::volume() const {
  if (surface.corners.empty()) return 0;
  const Vector3& base = surface.corners[0];  // near, so that no digits are lost
  double six = 0;
  for (const PolygonSet* set : {&surface, &caps}) {
    std::uint32_t begin = 0;
    for (const std::uint32_t end : set->ends) {
      const Vector3 a = set->corners[begin] - base;
      for (std::uint32_t i = begin + 1; i + 1 < end; ++i) {
        six += a.dot((set->corners[i] - base).cross(set->corners[i + 1] - base));
      }
      begin = end;
    }
  }
  return six / 6;
}

void cut(const CellPart& part, const Plane& plane, double hair, CellPart& behind, CellPart& front) {
  std::pmr::memory_resource* const memory = part.surface.corners.get_allocator().resource();
  const Heights heights{plane, hair};
  Rim rim_behind(memory), rim_front(memory);
  clip_all(part.surface, heights, behind.surface, front.surface, rim_behind, rim_front);
  clip_all(part.caps, heights, behind.caps, front.caps, rim_behind, rim_front);
  close_with_fan(rim_behind, behind.caps);
  close_with_fan(rim_front, front.caps);
  rim_behind.clear();
  rim_front.clear();
  clip_all(part.cell, heights, behind.cell, front.cell, rim_behind, rim_front);
  close_with_fan(rim_behind, behind.cell);
  close_with_fan(rim_front, front.cell);
}

}  // namespace breve
