// Regular solids, their planes and edges, and exact moments.
#include "runtime/solid/polyhedron.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include "runtime/base/error.hpp"

namespace breve {

namespace {

// Tests of pairs of edges are quadratic in the number of sides; beyond this a sphere or a coarser polygon is meant.
constexpr int kMaxSides = 1000;

void check_length(const char* what, double value) {
  if (!std::isfinite(value) || value <= 0) {
    throw Error(ErrorCode::Argument, fmt::format("{} is {} (must be finite and > 0)", what, value));
  }
}

void check_polygon(const char* what, int sides, double height, double radius) {
  if (sides < 3 || sides > kMaxSides) {
    throw Error(ErrorCode::Argument, fmt::format("a {} has {} sides (must be from 3 to {})", what, sides, kMaxSides));
  }
  check_length(fmt::format("the height of a {}", what).c_str(), height);
  check_length(fmt::format("the radius of a {}", what).c_str(), radius);
}

/// `sides` points of the circle about the y axis at height y, the first `offset` steps past +x.
void add_ring(std::pmr::vector<Vector3>& out, int sides, double y, double radius, double offset) {
  for (int i = 0; i < sides; ++i) {
    const double angle = (i + offset) * 2 * std::numbers::pi / sides;
    out.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
  }
}

/// Twice the vector area of a polygon (Newell's method): robust for polygons that are only nearly planar.
Vector3 doubled_area(const Polyhedron& solid, const std::pmr::vector<int>& face) {
  const Vector3& origin = solid.vertices[static_cast<std::size_t>(face[0])];
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    const Vector3 p = solid.vertices[static_cast<std::size_t>(face[i])] - origin;
    const Vector3 q = solid.vertices[static_cast<std::size_t>(face[i + 1])] - origin;
    sum += p.cross(q);
  }
  return sum;
}

void finish(Polyhedron& solid) {
  connect(solid);
  update_planes(solid);
}

}  // namespace

Polyhedron make_box(const Vector3& size, std::pmr::memory_resource* memory) {
  static constexpr const char* kWhat[] = {"a box's size along x", "a box's size along y", "a box's size along z"};
  for (int i = 0; i < 3; ++i) check_length(kWhat[i], size[i]);
  Polyhedron box(memory);
  box.vertices.reserve(8);
  for (int i = 0; i < 8; ++i) {
    const Vector3 corner((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    box.vertices.emplace_back(corner.cwiseProduct(size) * 0.5);
  }
  static constexpr std::array<int, 4> kFaces[] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  box.faces.reserve(std::size(kFaces));
  for (const auto& face : kFaces) box.faces.emplace_back(face.begin(), face.end());
  // As connect() finds them, which would take half of the time that it takes to make a box.
  box.edges = {{0, 4, 0, 2}, {4, 6, 0, 5}, {6, 2, 0, 3}, {2, 0, 0, 4}, {1, 3, 1, 4}, {3, 7, 1, 3},
               {7, 5, 1, 5}, {5, 1, 1, 2}, {0, 1, 2, 4}, {5, 4, 2, 5}, {6, 7, 3, 5}, {3, 2, 3, 4}};
  update_planes(box);
  return box;
}

Polyhedron make_prism(int sides, double height, double radius) {
  check_polygon("polygon disk", sides, height, radius);
  Polyhedron prism;
  add_ring(prism.vertices, sides, -height / 2, radius, 0.5);
  add_ring(prism.vertices, sides, height / 2, radius, 0.5);
  std::pmr::vector<int> bottom, top;
  // Rising angles rotate from +x to +z: clockwise seen from +y.
  for (int i = 0; i < sides; ++i) bottom.push_back(i);
  for (int i = sides - 1; i >= 0; --i) top.push_back(sides + i);
  prism.faces = {bottom, top};
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    prism.faces.push_back({i, sides + i, sides + next, next});
  }
  finish(prism);
  return prism;
}

Polyhedron make_cone(int sides, double height, double radius) {
  check_polygon("polygon cone", sides, height, radius);
  Polyhedron cone;
  add_ring(cone.vertices, sides, -height / 2, radius, 0);
  cone.vertices.emplace_back(0, height / 2, 0);
  std::pmr::vector<int> base;
  for (int i = 0; i < sides; ++i) base.push_back(i);
  cone.faces = {base};
  for (int i = 0; i < sides; ++i) cone.faces.push_back({i, sides, (i + 1) % sides});
  finish(cone);
  return cone;
}

void connect(Polyhedron& solid) {
  solid.edges.clear();
  std::map<std::pair<int, int>, std::size_t> open;  // directed edge as its left face runs it
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    const auto& face = solid.faces[f];
    for (std::size_t i = 0; i < face.size(); ++i) {
      const int a = face[i], b = face[(i + 1) % face.size()];
      const auto twin = open.find({b, a});
      if (twin != open.end() && solid.edges[twin->second].right < 0) {
        solid.edges[twin->second].right = static_cast<int>(f);
      } else if (twin != open.end() || !open.emplace(std::pair{a, b}, solid.edges.size()).second) {
        throw Error(ErrorCode::Argument,
                    fmt::format("face {} of a convex shape uses an edge that two faces share already", f));
      } else {
        solid.edges.push_back({a, b, static_cast<int>(f), -1});
      }
    }
  }
  for (const Edge& edge : solid.edges) {
    if (edge.right < 0) {
      throw Error(ErrorCode::Argument,
                  fmt::format("a convex shape is not closed: an edge of face {} belongs to no other face", edge.left));
    }
  }
}

namespace {

constexpr std::size_t kManyVertices = 32;  // fewer are looked at one by one
constexpr std::size_t kManyFaces = 64;     // likewise
constexpr std::size_t kManyEdges = 256;    // likewise, each with each of another solid

/// Do the faces at each edge fold outward? Then what is higher than all its neighbors is the highest.
bool folds_outward(const Polyhedron& solid) {
  constexpr double kRoundOff = 1e-12;  // of the extent
  double extent = 0;
  for (const Vector3& p : solid.vertices) extent = std::max(extent, p.lpNorm<Eigen::Infinity>());
  return std::all_of(solid.edges.begin(), solid.edges.end(), [&](const Edge& edge) {
    const Vector3 &normal = solid.planes[at(edge.left)].normal, &start = solid.vertices[at(edge.a)];
    const auto& beyond = solid.faces[at(edge.right)];
    return std::all_of(beyond.begin(), beyond.end(),
                       [&](int v) { return normal.dot(solid.vertices[at(v)] - start) <= kRoundOff * extent; });
  });
}

void find_neighbors(Polyhedron& solid) {
  solid.neighbors.clear();
  solid.first_neighbor.clear();
  solid.arcs.clear();
  solid.looks.clear();
  const std::size_t count = solid.vertices.size();
  if (count < kManyVertices || solid.edges.empty() || !folds_outward(solid)) return;
  std::pmr::vector<int>& first = solid.first_neighbor;
  first.assign(count + 1, 0);
  for (const Edge& edge : solid.edges) ++first[at(edge.a) + 1], ++first[at(edge.b) + 1];
  for (std::size_t i = 1; i <= count; ++i) first[i] += first[i - 1];
  solid.neighbors.resize(2 * solid.edges.size());
  std::pmr::vector<int> next = first;
  for (const Edge& edge : solid.edges) {
    solid.neighbors[at(next[at(edge.a)]++)] = edge.b;
    solid.neighbors[at(next[at(edge.b)]++)] = edge.a;
  }
  if (solid.faces.size() >= kManyFaces) solid.looks.build(solid);
  if (solid.edges.size() < kManyEdges) return;
  std::pmr::vector<ArcBall> balls(first.get_allocator());
  balls.reserve(solid.edges.size());
  for (const Edge& edge : solid.edges)
    balls.push_back(ArcBall::between(solid.planes[at(edge.left)].normal, solid.planes[at(edge.right)].normal));
  solid.arcs.build(std::move(balls));
}

}  // namespace

int Polyhedron::farthest(const Vector3& direction, int from) const {
  int best = neighbors.empty() ? 0 : from;
  double most = direction.dot(vertices[at(best)]);
  const auto look = [&](int i) {
    const double along = direction.dot(vertices[at(i)]);
    if (!(along > most || (along == most && i < best))) return;
    most = along;
    best = i;
  };
  if (neighbors.empty()) {
    for (std::size_t i = 1; i < vertices.size(); ++i) look(static_cast<int>(i));
    return best;
  }
  for (int here = -1; here != best;) {
    here = best;
    for (int k = first_neighbor[at(here)]; k < first_neighbor[at(here) + 1]; ++k) look(neighbors[at(k)]);
  }
  return best;
}

void update_planes(Polyhedron& solid) {
  solid.planes.clear();
  solid.planes.reserve(solid.faces.size());
  for (const auto& face : solid.faces) {
    const Vector3 normal = doubled_area(solid, face).stableNormalized();
    double offset = normal.dot(solid.vertices[static_cast<std::size_t>(face[0])]);
    // Slightly warped faces get the outermost plane, so that no vertex is outside its own face.
    for (const int v : face) offset = std::max(offset, normal.dot(solid.vertices[static_cast<std::size_t>(v)]));
    solid.planes.push_back({normal, offset});
  }
  find_neighbors(solid);
}

void add_tetrahedron(const Vector3& a, const Vector3& b, const Vector3& c, Moments& sum) {
  const double six_volumes = a.dot(b.cross(c));
  const Vector3 s = a + b + c;
  sum.volume += six_volumes / 6;
  sum.first += six_volumes / 24 * s;
  sum.second += six_volumes / 120 * (s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
}

Moments moments(const Polyhedron& solid) {
  Moments sum{0, Vector3::Zero(), Matrix3::Zero()};
  for (const auto& face : solid.faces) {
    const Vector3& a = solid.vertices[static_cast<std::size_t>(face[0])];
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      const Vector3& b = solid.vertices[static_cast<std::size_t>(face[i])];
      const Vector3& c = solid.vertices[static_cast<std::size_t>(face[i + 1])];
      add_tetrahedron(a, b, c, sum);
    }
  }
  return sum;
}

}  // namespace breve
