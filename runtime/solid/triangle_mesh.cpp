// Triangles welded at their corners, joined at their edges, and found again through a tree that halves them by place.
#include "runtime/solid/triangle_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "runtime/base/error.hpp"

namespace breve {

namespace {

[[noreturn]] void refuse_mesh(const std::string& why) { throw Error(ErrorCode::Argument, "a mesh " + why); }

/// Half of an edge as one triangle runs it.
struct HalfEdge {
  std::int32_t low, high;
  std::uint32_t triangle;
  std::uint8_t edge;
  bool rising;  // runs from low to high
};

}  // namespace

TriangleMesh::TriangleMesh(std::span<const Vector3> corners, std::span<const Triangle> triangles,
                           std::pmr::memory_resource* memory)
    : original_(memory),
      corners_(memory),
      triangles_(memory),
      neighbours_(memory),
      normals_(memory),
      active_(memory),
      order_(memory),
      nodes_(memory) {
  if (triangles.size() > kMostTriangles) {
    refuse_mesh(fmt::format("has {} triangles (at most {})", triangles.size(), kMostTriangles));
  }
  weld(corners, triangles);
  join();
  corners_ = original_;
  if (closed_ && moments().volume < 0) {
    for (Triangle& t : triangles_) std::swap(t[1], t[2]);
    join();
  }
  derive();
}

TriangleMesh::TriangleMesh(const TriangleMesh& other, const Vector3& factors)
    : original_(other.original_, other.original_.get_allocator()),
      corners_(other.original_.get_allocator()),
      triangles_(other.triangles_, other.triangles_.get_allocator()),
      neighbours_(other.neighbours_, other.neighbours_.get_allocator()),
      normals_(other.normals_.get_allocator()),
      active_(other.active_.get_allocator()),
      order_(other.order_.get_allocator()),
      nodes_(other.nodes_.get_allocator()),
      closed_(other.closed_) {
  corners_.reserve(original_.size());
  for (const Vector3& p : original_) corners_.push_back(p.cwiseProduct(factors));
  derive();
}

void TriangleMesh::weld(std::span<const Vector3> corners, std::span<const Triangle> triangles) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3& p = corners[i];
    if (!p.allFinite())
      refuse_mesh(fmt::format("has corner {} at ({}, {}, {}) (must be finite)", i, p.x(), p.y(), p.z()));
  }
  // Sorted by place, equal corners stand side by side; the first of them stays.
  std::pmr::vector<std::int32_t> sorted(corners.size(), original_.get_allocator()), name(sorted);
  std::iota(sorted.begin(), sorted.end(), 0);
  const auto coordinates = [&](std::int32_t i) {
    const Vector3& p = corners[at(i)];
    return std::array{p.x(), p.y(), p.z()};
  };
  std::sort(sorted.begin(), sorted.end(), [&](std::int32_t i, std::int32_t j) {
    const auto p = coordinates(i), q = coordinates(j);
    return p != q ? p < q : i < j;
  });
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const bool same = k > 0 && coordinates(sorted[k]) == coordinates(sorted[k - 1]);
    name[at(sorted[k])] = same ? name[at(sorted[k - 1])] : sorted[k];
  }
  // Renumber in the order of the corners, without those that nothing uses.
  std::pmr::vector<std::int32_t> number(corners.size(), -1, original_.get_allocator());
  triangles_.reserve(triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      if (triangles[f][k] < 0 || at(triangles[f][k]) >= corners.size()) {
        refuse_mesh(
            fmt::format("has triangle {} with corner {} (there are {} corners)", f, triangles[f][k], corners.size()));
      }
      t[k] = name[at(triangles[f][k])];
    }
    if (normal_of(corners[at(t[0])], corners[at(t[1])], corners[at(t[2])]).squaredNorm() < 0.5) continue;
    for (std::int32_t& v : t) {
      if (number[at(v)] < 0) {
        number[at(v)] = static_cast<std::int32_t>(original_.size());
        original_.push_back(corners[at(v)]);
      }
      v = number[at(v)];
    }
    triangles_.push_back(t);
  }
  if (triangles_.empty()) refuse_mesh("has no triangle with an area");
}

/// The neighbours of each triangle. Closed: each edge is run by two triangles, once in each sense.
void TriangleMesh::join() {
  std::pmr::vector<HalfEdge> halves(triangles_.get_allocator());
  halves.reserve(3 * triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::uint8_t e = 0; e < 3; ++e) {
      const std::int32_t a = triangles_[t][e], b = triangles_[t][(e + 1U) % 3];
      halves.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t), e, a < b});
    }
  }
  std::sort(halves.begin(), halves.end(), [](const HalfEdge& p, const HalfEdge& q) {
    return std::tie(p.low, p.high, p.triangle, p.edge) < std::tie(q.low, q.high, q.triangle, q.edge);
  });
  neighbours_.assign(triangles_.size(), Triangle{-1, -1, -1});
  closed_ = true;
  for (std::size_t i = 0; i < halves.size();) {
    std::size_t end = i + 1;
    while (end < halves.size() && halves[end].low == halves[i].low && halves[end].high == halves[i].high) ++end;
    if (end - i == 2) {
      const HalfEdge &p = halves[i], &q = halves[i + 1];
      neighbours_[p.triangle][p.edge] = static_cast<std::int32_t>(q.triangle);
      neighbours_[q.triangle][q.edge] = static_cast<std::int32_t>(p.triangle);
      if (p.rising == q.rising) closed_ = false;
    } else {
      closed_ = false;
    }
    i = end;
  }
}

/// Normals, edges that stand out and the tree, from corners that are scaled.
void TriangleMesh::derive() {
  normals_.clear();
  active_.clear();
  bounds_.setEmpty();
  for (const Vector3& p : corners_) bounds_.extend(p);
  for (const Triangle& t : triangles_) {
    normals_.push_back(normal_of(corners_[at(t[0])], corners_[at(t[1])], corners_[at(t[2])]));
  }
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Triangle& t = triangles_[i];
    std::uint8_t active = 0;
    for (std::uint8_t e = 0; e < 3; ++e) {
      const std::int32_t n = neighbours_[i][e];
      bool out = true;
      if (n >= 0) {
        const std::int32_t a = t[e], b = t[(e + 1U) % 3];
        const auto& other = triangles_[at(n)];
        const auto far = std::find_if(other.begin(), other.end(), [&](std::int32_t v) { return v != a && v != b; });
        const Vector3 opposite = far == other.end() ? Vector3::Zero() : Vector3(corners_[at(*far)] - corners_[at(a)]);
        // A neighbour that runs the edge in the same sense shows its back: its normal is turned for the comparison.
        const bool reversed = std::any_of(other.begin(), other.end(), [&](const std::int32_t& v) {
          return v == a && other[static_cast<std::size_t>(&v - other.data() + 1) % 3] == b;
        });
        out = stands_out(normals_[i], reversed ? Vector3(-normals_[at(n)]) : normals_[at(n)], opposite, closed_);
      }
      if (out) active = static_cast<std::uint8_t>(active | (1U << e));
    }
    active_.push_back(active);
  }
  build_tree();
}

void TriangleMesh::build_tree() {
  constexpr std::uint32_t kLeaf = 4;
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.clear();
  nodes_.reserve(triangles_.size());
  const auto center = [&](std::uint32_t t, Eigen::Index axis) {
    const Triangle& c = triangles_[t];
    return corners_[at(c[0])][axis] + corners_[at(c[1])][axis] + corners_[at(c[2])][axis];
  };
  struct Task {
    std::uint32_t begin, end;
    std::int64_t parent;  // whose second child this is
  };
  std::pmr::vector<Task> tasks({{0, static_cast<std::uint32_t>(order_.size()), -1}}, order_.get_allocator());
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    if (task.parent >= 0) nodes_[static_cast<std::size_t>(task.parent)].first = number;
    Node& node = nodes_.emplace_back();
    for (std::uint32_t i = task.begin; i < task.end; ++i) {
      for (const std::int32_t v : triangles_[order_[i]]) node.box.extend(corners_[at(v)]);
    }
    if (task.end - task.begin <= kLeaf) {
      node.first = task.begin;
      node.count = task.end - task.begin;
      continue;
    }
    Eigen::Index axis;
    node.box.sizes().maxCoeff(&axis);
    const std::uint32_t middle = (task.begin + task.end) / 2;
    std::nth_element(order_.begin() + task.begin, order_.begin() + middle, order_.begin() + task.end,
                     [&](std::uint32_t p, std::uint32_t q) {
                       const double x = center(p, axis), y = center(q, axis);
                       return x != y ? x < y : p < q;
                     });
    tasks.push_back({middle, task.end, number});
    tasks.push_back({task.begin, middle, -1});
  }
}

Facet TriangleMesh::facet(std::uint32_t triangle) const {
  const Triangle& t = triangles_[triangle];
  return {
      {corners_[at(t[0])], corners_[at(t[1])], corners_[at(t[2])]}, normals_[triangle], triangle, active_[triangle]};
}

namespace {

// Halving 2 million triangles to leaves of four goes 19 deep.
constexpr std::size_t kDeepest = 64;

/// Does a ray meet a box before `farthest`?
bool ray_meets_box(const Eigen::AlignedBox3d& box, const Vector3& origin, const Vector3& direction, double farthest) {
  double first = 0, last = farthest;
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0) {
      if (origin[i] < box.min()[i] || origin[i] > box.max()[i]) return false;
      continue;
    }
    const double a = (box.min()[i] - origin[i]) / direction[i], b = (box.max()[i] - origin[i]) / direction[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last + 1e-12 * (1 + std::abs(last));
}

}  // namespace

void TriangleMesh::under(const Eigen::AlignedBox3d& box, FacetVisitor& visitor) const {
  std::array<std::uint32_t, kDeepest> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t number = stack[--top];
    const Node& node = nodes_[number];
    ++visitor.counters.boxes;
    if (!node.box.intersects(box) || !visitor.wants(node.box)) continue;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::uint32_t triangle = order_[node.first + i];
      const Triangle& t = triangles_[triangle];
      Eigen::AlignedBox3d around(corners_[at(t[0])]);
      around.extend(corners_[at(t[1])]).extend(corners_[at(t[2])]);
      ++visitor.counters.boxes;
      if (!around.intersects(box) || !visitor.wants(around)) continue;
      ++visitor.counters.facets;
      visitor.visit(facet(triangle));
    }
    if (node.count > 0) continue;
    stack[top++] = node.first;
    stack[top++] = number + 1;
  }
}

bool TriangleMesh::raycast(const Vector3& origin, const Vector3& direction, double& fraction, Facet& hit) const {
  double best = std::numeric_limits<double>::infinity();
  std::array<std::uint32_t, kDeepest> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t number = stack[--top];
    const Node& node = nodes_[number];
    if (!ray_meets_box(node.box, origin, direction, best)) continue;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const Facet f = facet(order_[node.first + i]);
      const double t = ray_meets(f.corner, origin, direction);
      // Of equals the one with the lowest number.
      if (t < best || (t == best && std::isfinite(t) && f.index < hit.index)) {
        best = t;
        hit = f;
      }
    }
    if (node.count > 0) continue;
    stack[top++] = node.first;
    stack[top++] = number + 1;
  }
  if (!std::isfinite(best)) return false;
  fraction = best;
  return true;
}

bool TriangleMesh::inside(const Vector3& point) const {
  if (!closed_ || !bounds_.contains(point)) return false;
  // Slanting, so that it runs along no face of what people build.
  const Vector3 direction(0.5377, 0.7331, 0.4163);
  double t;
  Facet hit;
  return raycast(point, direction, t, hit) && hit.normal.dot(direction) > 0;
}

Moments TriangleMesh::moments() const {
  Moments sum{0, Vector3::Zero(), Matrix3::Zero()};
  for (const Triangle& t : triangles_) {
    add_tetrahedron(corners_[at(t[0])], corners_[at(t[1])], corners_[at(t[2])], sum);
  }
  return sum;
}

std::shared_ptr<Surface> TriangleMesh::scaled(const Vector3& factors) const {
  return std::shared_ptr<Surface>(new (original_.get_allocator().resource()) TriangleMesh(*this, factors),
                                  std::default_delete<Surface>(), original_.get_allocator());
}

void TriangleMesh::hash(Hasher& hasher) const {
  for (const Vector3& p : corners_) hasher.add(p);
  for (const Triangle& t : triangles_) {
    for (const std::int32_t v : t) hasher.add(static_cast<std::uint64_t>(v));
  }
}

void TriangleMesh::save(ByteWriter& out) const {
  out.put(static_cast<std::uint64_t>(original_.size()));
  for (const Vector3& p : original_) out.put(p);
  out.put(static_cast<std::uint64_t>(triangles_.size()));
  for (const Triangle& t : triangles_) {
    for (const std::int32_t v : t) out.put(v);
  }
}

std::shared_ptr<TriangleMesh> TriangleMesh::load(ByteReader& in) {
  std::pmr::vector<Vector3> corners(in.get_count(3 * sizeof(double)), in.memory());
  for (Vector3& p : corners) p = in.get_vector();
  std::pmr::vector<Triangle> triangles(in.get_count(3 * sizeof(std::int32_t)), in.memory());
  for (Triangle& t : triangles) {
    for (std::int32_t& v : t) v = in.get<std::int32_t>();
  }
  return std::shared_ptr<TriangleMesh>(new (in.memory()) TriangleMesh(corners, triangles, in.memory()),
                                       std::default_delete<TriangleMesh>(), corners.get_allocator());
}

}  // namespace breve
