// The convex hull of a cloud of points: quickhull (Barber, Dobkin and Huhdanpaa 1996) on triangles; neighbours in one
// plane become one face at the end. Bullet's btConvexHullComputer was measured beside it (`./run bench hulls`): it
// rounds to a grid of some ten thousand steps and leaves points 1.6e-4 of the extent outside, which separating axes
// would feel.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "runtime/base/error.hpp"
#include "runtime/solid/polyhedron.hpp"

namespace breve {

namespace {

// Beyond these numbers a coarser mesh is meant.
constexpr std::size_t kMostHullPoints = 1'000'000;
constexpr std::size_t kMostFaces = 4000;
constexpr double kFlatCloud = 5e-7;  // thinner than this part of its extent a cloud is flat: a solid needs a thickness
constexpr double kLevel = 1e-12;     // of the extent: a point so little above a face is on it
constexpr double kOneFace = 1e-8;    // of the extent: triangles so near to one plane are one face
constexpr double kWrong = 1e-7;      // of the extent: what may be outside after all
constexpr double kFar = 16;          // extents from the origin: farther, round-off of the place is taken out first

[[noreturn]] void refuse_hull(const std::string& why) { throw Error(ErrorCode::Argument, "a convex hull " + why); }

struct HullFace {
  std::array<int, 3> corner{}, neighbour{};  // neighbour i is across the edge from corner i to the next
  Plane plane{Vector3::Zero(), 0};
  double area = 0;
  bool alive = true;
  std::vector<int> outside;  // points above this face that no earlier one claimed
};

class Quickhull {
 public:
  explicit Quickhull(std::span<const Vector3> points) : given_(points), points_(points), face_from_(points.size(), -1) {
    measure();
  }
  Polyhedron run();

 private:
  const Vector3& point(int i) const { return points_[at(i)]; }
  double height(const HullFace& face, int p) const { return face.plane.normal.dot(point(p)) - face.plane.offset; }
  void measure();
  std::array<int, 4> first_solid() const;
  int add_face(int a, int b, int c);
  void start(const std::array<int, 4>& corners);
  void claim(const std::vector<int>& candidates, std::size_t first_face);
  struct Rim {
    int from, to, beyond;  // corners, and the face on the other side
  };
  std::vector<Rim> rim_seen_from(int apex, int face, std::vector<int>& seen);
  void raise(int face);
  std::vector<std::vector<int>> merged() const;
  bool outline(const std::vector<int>& group, const std::vector<int>& group_of, std::vector<int>& corners) const;
  void check(const Polyhedron& solid) const;

  std::span<const Vector3> given_, points_;  // those that heights are measured of may be nearer to the origin
  std::vector<Vector3> near_;
  std::vector<HullFace> faces_;
  std::vector<int> dropped_;    // points that could not be raised
  std::vector<int> face_from_;  // while a hole is closed: the new face that starts at a point
  double extent_ = 0;
};

void Quickhull::measure() {
  if (points_.size() < 4 || points_.size() > kMostHullPoints) {
    refuse_hull(fmt::format("of {} points (must be from 4 to {})", points_.size(), kMostHullPoints));
  }
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vector3& p = points_[i];
    if (!p.allFinite())
      refuse_hull(fmt::format("of point {} at ({}, {}, {}) (must be finite)", i, p.x(), p.y(), p.z()));
    box.extend(p);
  }
  extent_ = box.sizes().maxCoeff();
  if (!std::isfinite(extent_ * extent_ * extent_)) refuse_hull(fmt::format("of points {} apart: too large", extent_));
  const Vector3 middle = box.center();
  if (middle.lpNorm<Eigen::Infinity>() <= kFar * extent_) return;
  near_.reserve(points_.size());
  for (const Vector3& p : points_) near_.emplace_back(p - middle);  // exact: they differ by less than a factor of two
  points_ = near_;
}

/// Two points far apart, the farthest from their line, and the farthest from that plane.
std::array<int, 4> Quickhull::first_solid() const {
  const auto farthest = [&](auto&& measure) {
    int best = 0;
    for (int i = 1; i < static_cast<int>(points_.size()); ++i) {
      if (measure(point(i)) > measure(point(best))) best = i;
    }
    return best;
  };
  const int a = farthest([](const Vector3& p) { return p.x() + 0.37 * p.y() + 0.21 * p.z(); });
  const int b = farthest([&](const Vector3& p) { return (p - point(a)).squaredNorm(); });
  const Vector3 line = (point(b) - point(a)).stableNormalized();
  const int c = farthest([&](const Vector3& p) { return (p - point(a)).cross(line).squaredNorm(); });
  const Vector3 normal = line.cross(point(c) - point(a)).stableNormalized();
  const int d = farthest([&](const Vector3& p) { return std::abs(normal.dot(p - point(a))); });
  if (!(std::abs(normal.dot(point(d) - point(a))) > kFlatCloud * extent_)) {
    refuse_hull(
        "of points that lie in one plane, or nearly (a solid needs a thickness; keep a flat mesh as triangles)");
  }
  if (normal.dot(point(d) - point(a)) > 0) return {a, c, b, d};
  return {a, b, c, d};
}

int Quickhull::add_face(int a, int b, int c) {
  HullFace& face = faces_.emplace_back();
  face.corner = {a, b, c};
  const Vector3 doubled = (point(b) - point(a)).cross(point(c) - point(a));
  face.area = doubled.norm();
  face.plane.normal = doubled.stableNormalized();
  face.plane.offset =
      std::max({face.plane.normal.dot(point(a)), face.plane.normal.dot(point(b)), face.plane.normal.dot(point(c))});
  return static_cast<int>(faces_.size()) - 1;
}

void Quickhull::start(const std::array<int, 4>& k) {
  // The fourth is below the first face.
  add_face(k[0], k[1], k[2]);
  add_face(k[0], k[3], k[1]);
  add_face(k[1], k[3], k[2]);
  add_face(k[2], k[3], k[0]);
  faces_[0].neighbour = {1, 2, 3};
  faces_[1].neighbour = {3, 2, 0};
  faces_[2].neighbour = {1, 3, 0};
  faces_[3].neighbour = {2, 1, 0};
  std::vector<int> all(points_.size());
  std::iota(all.begin(), all.end(), 0);
  claim(all, 0);
}

/// Give each candidate to the face from `first_face` on that it is highest above; what is above none is inside.
void Quickhull::claim(const std::vector<int>& candidates, std::size_t first_face) {
  for (const int p : candidates) {
    double most = kLevel * extent_;
    std::size_t owner = faces_.size();
    for (std::size_t f = first_face; f < faces_.size(); ++f) {
      const double here = height(faces_[f], p);
      if (here <= most) continue;
      most = here;
      owner = f;
    }
    if (owner < faces_.size()) faces_[owner].outside.push_back(p);
  }
}

/// The edges around all faces that a point over `face` sees, which are taken out and appended to `seen`.
std::vector<Quickhull::Rim> Quickhull::rim_seen_from(int apex, int face, std::vector<int>& seen) {
  std::vector<Rim> rim;
  seen.push_back(face);
  faces_[at(face)].alive = false;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t e = 0; e < 3; ++e) {
      const int here = seen[i], next = faces_[at(here)].neighbour[e];
      HullFace& other = faces_[at(next)];
      if (!other.alive) continue;
      if (height(other, apex) > kLevel * extent_) {
        other.alive = false;
        seen.push_back(next);
      } else {
        rim.push_back({faces_[at(here)].corner[e], faces_[at(here)].corner[(e + 1) % 3], next});
      }
    }
  }
  return rim;
}

/// Replace all faces that the farthest point over `face` sees by a fan from that point to their rim.
void Quickhull::raise(int face) {
  auto& outside = faces_[at(face)].outside;
  const auto top = std::max_element(outside.begin(), outside.end(), [&](int p, int q) {
    return height(faces_[at(face)], p) < height(faces_[at(face)], q);
  });
  const int apex = *top;
  outside.erase(top);
  std::vector<int> seen;
  const std::vector<Rim> rim = rim_seen_from(apex, face, seen);
  // A rim that meets itself is round-off at work: the point is then not worth raising.
  bool simple = true;
  for (const Rim& r : rim) {
    simple = simple && face_from_[at(r.from)] < 0;
    face_from_[at(r.from)] = 0;
  }
  for (const Rim& r : rim) face_from_[at(r.from)] = -1;
  if (!simple) {
    for (const int f : seen) faces_[at(f)].alive = true;
    dropped_.push_back(apex);
    return;
  }
  const std::size_t first = faces_.size();
  for (const Rim& r : rim) {
    const int made = add_face(r.from, r.to, apex);
    face_from_[at(r.from)] = made;
    HullFace& beyond = faces_[at(r.beyond)];
    faces_[at(made)].neighbour[0] = r.beyond;
    for (std::size_t e = 0; e < 3; ++e) {
      if (beyond.corner[e] == r.to && beyond.corner[(e + 1) % 3] == r.from) beyond.neighbour[e] = made;
    }
    // A sliver along the rim is level with the face beyond.
    if (faces_[at(made)].area <= kLevel * extent_ * extent_) faces_[at(made)].plane = beyond.plane;
  }
  for (const Rim& r : rim) {
    const int made = face_from_[at(r.from)], next = face_from_[at(r.to)];
    faces_[at(made)].neighbour[1] = next;
    faces_[at(next)].neighbour[2] = made;
  }
  for (const Rim& r : rim) face_from_[at(r.from)] = -1;
  for (const int f : seen) {
    const std::vector<int> orphans = std::move(faces_[at(f)].outside);
    claim(orphans, first);
  }
}

/// The rim of a group of triangles as one loop; false if it does not form one.
bool Quickhull::outline(const std::vector<int>& group, const std::vector<int>& group_of,
                        std::vector<int>& corners) const {
  std::vector<std::pair<int, int>> steps;  // along the rim
  for (const int f : group) {
    for (std::size_t e = 0; e < 3; ++e) {
      if (group_of[at(faces_[at(f)].neighbour[e])] == group_of[at(f)]) continue;
      steps.emplace_back(faces_[at(f)].corner[e], faces_[at(f)].corner[(e + 1) % 3]);
    }
  }
  std::sort(steps.begin(), steps.end());
  corners.clear();
  int here = steps.empty() ? -1 : steps[0].first;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    corners.push_back(here);
    const auto next = std::lower_bound(steps.begin(), steps.end(), std::pair{here, -1});
    if (next == steps.end() || next->first != here) return false;
    here = next->second;
    if (here == steps[0].first && i + 1 < steps.size()) return false;
  }
  return corners.size() >= 3 && here == steps[0].first;
}

/// Faces as loops of points: triangles in one plane together, beginning with the largest.
std::vector<std::vector<int>> Quickhull::merged() const {
  std::vector<int> order, group_of(faces_.size(), -1);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].alive) order.push_back(static_cast<int>(f));
  }
  std::stable_sort(order.begin(), order.end(), [&](int p, int q) { return faces_[at(p)].area > faces_[at(q)].area; });
  std::vector<std::vector<int>> loops;
  std::vector<int> group, loop;
  for (const int seed : order) {
    if (group_of[at(seed)] >= 0) continue;
    group.assign(1, seed);
    group_of[at(seed)] = seed;
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (const int n : faces_[at(group[i])].neighbour) {
        const HullFace& other = faces_[at(n)];
        if (group_of[at(n)] >= 0) continue;
        const bool level = std::all_of(other.corner.begin(), other.corner.end(),
                                       [&](int p) { return height(faces_[at(seed)], p) > -kOneFace * extent_; });
        if (!level) continue;
        group_of[at(n)] = seed;
        group.push_back(n);
      }
    }
    if (outline(group, group_of, loop)) {
      loops.push_back(loop);
    } else {
      for (const int f : group) loops.emplace_back(faces_[at(f)].corner.begin(), faces_[at(f)].corner.end());
    }
  }
  return loops;
}

/// Nothing stands out but what round-off explains.
void Quickhull::check(const Polyhedron& solid) const {
  const auto outside = [&](const Plane& plane, const Vector3& p) {
    return plane.normal.dot(p) - plane.offset > kWrong * extent_;
  };
  for (const Plane& plane : solid.planes) {
    bool wrong = false;
    for (const Vector3& p : solid.vertices) wrong = wrong || outside(plane, p);
    for (const int p : dropped_) wrong = wrong || outside(plane, given_[at(p)]);
    if (wrong)
      refuse_hull("of points for which no closed solid exists in double precision: remove points that nearly coincide");
  }
}

Polyhedron Quickhull::run() {
  start(first_solid());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    while (faces_[f].alive && !faces_[f].outside.empty()) raise(static_cast<int>(f));
  }
  const auto loops = merged();
  if (loops.size() > kMostFaces) {
    refuse_hull(fmt::format("has {} faces (at most {}): use a coarser mesh, or keep it as triangles", loops.size(),
                            kMostFaces));
  }
  Polyhedron solid;
  std::vector<int> number(points_.size(), -1);
  for (const auto& loop : loops) {
    auto& face = solid.faces.emplace_back();
    for (const int p : loop) {
      if (number[at(p)] < 0) {
        number[at(p)] = static_cast<int>(solid.vertices.size());
        solid.vertices.push_back(given_[at(p)]);
      }
      face.push_back(number[at(p)]);
    }
  }
  connect(solid);
  update_planes(solid);
  check(solid);
  return solid;
}

}  // namespace

Polyhedron make_hull(std::span<const Vector3> points) { return Quickhull(points).run(); }

}  // namespace breve
