// Distance of two separated polyhedra by the method of Gilbert, Johnson and Keerthi (1988).
// Bullet's GJK was measured first: on boxes in general position it stops early in 0.3 % of the cases with a distance
// too large by up to a fifth, which would let conservative advancement step over a contact. Here the point of a simplex
// closest to the origin is the best over all its sub-simplices, so that no wrong feature is kept; at 15 small problems
// a turn this costs little, and a polyhedron ends after finitely many turns.
#include <array>
#include <limits>

#include "runtime/solid/gap.hpp"

namespace breve {

namespace {

constexpr int kMaxTurns = 256;
constexpr double kRoundOff = 1e-15;  // relative; a few units in the last place
constexpr double kFlat = 1e-14;      // sine below which a triangle or tetrahedron counts as flat

/// A vertex of the Minkowski difference a - b.
struct Corner {
  Vector3 w = Vector3::Zero();
  int a = 0, b = 0;
};

/// The point of a simplex closest to the origin, as corners and weights.
struct Nearest {
  Vector3 point = Vector3::Zero();
  double square = std::numeric_limits<double>::infinity();
  std::array<int, 4> corner{};
  std::array<double, 4> weight{};
  int size = 0;

  void offer(const Vector3& p, int count, std::array<int, 4> corners, std::array<double, 4> weights) {
    const double s = p.squaredNorm();
    if (s >= square) return;
    point = p;
    square = s;
    size = count;
    corner = corners;
    weight = weights;
  }
};

struct Simplex {
  std::array<Corner, 4> corner;
  int size = 0;

  const Vector3& w(int i) const { return corner[static_cast<std::size_t>(i)].w; }
  bool has(int a, int b) const {
    for (int i = 0; i < size; ++i) {
      const Corner& c = corner[static_cast<std::size_t>(i)];
      if (c.a == a && c.b == b) return true;
    }
    return false;
  }
  void keep(const Nearest& nearest) {
    std::array<Corner, 4> kept;
    for (int i = 0; i < nearest.size; ++i) {
      kept[static_cast<std::size_t>(i)] = corner[static_cast<std::size_t>(nearest.corner[static_cast<std::size_t>(i)])];
    }
    corner = kept;
    size = nearest.size;
  }
};

void offer_segment(const Simplex& s, int i, int j, Nearest& best) {
  const Vector3 d = s.w(j) - s.w(i);
  const double length = d.squaredNorm();
  const double t = length > 0 ? -s.w(i).dot(d) / length : -1;
  if (!(t > 0 && t < 1)) return;
  // Perpendicular once more: near the origin the first subtraction left only round-off along d.
  const Vector3 p = s.w(i) + t * d;
  best.offer(p - (p.dot(d) / length) * d, 2, {i, j}, {1 - t, t});
}

void offer_triangle(const Simplex& s, int i, int j, int k, Nearest& best) {
  const Vector3 &a = s.w(i), &b = s.w(j), &c = s.w(k);
  const Vector3 normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (area <= kFlat * kFlat * (b - a).squaredNorm() * (c - a).squaredNorm()) return;
  const double u = normal.dot(b.cross(c)) / area, v = normal.dot(c.cross(a)) / area, w = normal.dot(a.cross(b)) / area;
  if (u < 0 || v < 0 || w < 0) return;
  best.offer(normal * (normal.dot(a) / area), 3, {i, j, k}, {u, v, w});
}

bool holds_origin(const Simplex& s) {
  const Vector3 &a = s.w(0), &b = s.w(1), &c = s.w(2), &d = s.w(3);
  const double whole = (b - a).dot((c - a).cross(d - a));
  if (std::abs(whole) <= kFlat * (b - a).norm() * (c - a).norm() * (d - a).norm()) return false;
  const double sign = whole > 0 ? 1 : -1;
  return sign * b.dot(c.cross(d)) >= 0 && sign * -a.dot(c.cross(d)) >= 0 && sign * a.dot(b.cross(d)) >= 0 &&
         sign * -a.dot(b.cross(c)) >= 0;
}

Nearest nearest_to_origin(const Simplex& s) {
  Nearest best;
  if (s.size == 4 && holds_origin(s)) {
    best.offer(Vector3::Zero(), 4, {0, 1, 2, 3}, {});
    return best;
  }
  for (int i = 0; i < s.size; ++i) {
    best.offer(s.w(i), 1, {i}, {1});
    for (int j = i + 1; j < s.size; ++j) {
      offer_segment(s, i, j, best);
      for (int k = j + 1; k < s.size; ++k) offer_triangle(s, i, j, k, best);
    }
  }
  return best;
}

/// Weighted points on both solids; the weights belong to the corners that `simplex` kept.
void fill(const Placed& a, const Placed& b, const Simplex& simplex, const Nearest& nearest, Gap& gap) {
  gap = Gap{};
  for (int i = 0; i < simplex.size; ++i) {
    const Corner& corner = simplex.corner[static_cast<std::size_t>(i)];
    const double weight = nearest.weight[static_cast<std::size_t>(i)];
    gap.on_a += weight * a.vertex(corner.a);
    gap.on_b += weight * b.vertex(corner.b);
  }
  gap.distance = std::sqrt(nearest.square);
  gap.normal = nearest.point / gap.distance;
  // Two vertices on either side: edge against edge (or diagonals of two faces that lie flat on one another).
  const Corner& first = simplex.corner[0];
  int other_a = first.a, other_b = first.b;
  bool two_a = true, two_b = true;
  for (int i = 1; i < simplex.size; ++i) {
    const Corner& c = simplex.corner[static_cast<std::size_t>(i)];
    if (c.a != first.a) (other_a == first.a || other_a == c.a) ? void(other_a = c.a) : void(two_a = false);
    if (c.b != first.b) (other_b == first.b || other_b == c.b) ? void(other_b = c.b) : void(two_b = false);
  }
  if (two_a && two_b && other_a != first.a && other_b != first.b) {
    gap.start_a = a.vertex(first.a);
    gap.start_b = b.vertex(first.b);
    gap.edge_a = a.vertex(other_a) - gap.start_a;
    gap.edge_b = b.vertex(other_b) - gap.start_b;
  }
}

}  // namespace

int Placed::support(const Vector3& direction) const {
  const Vector3 local = rotation.transpose() * direction;
  const auto& vertices = solid->vertices;
  int best = 0;
  double farthest = local.dot(vertices[0]);
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const double along = local.dot(vertices[i]);
    if (along > farthest) {
      farthest = along;
      best = static_cast<int>(i);
    }
  }
  return best;
}

double Placed::reach(const Vector3& direction) const { return direction.dot(vertex(support(direction))); }

bool separated(const Placed& a, const Placed& b, Gap& gap) {
  const double scale = a.radius + b.radius + (a.location - b.location).norm();
  Simplex simplex;
  Nearest nearest;
  Vector3 toward = a.location - b.location;
  if (toward.squaredNorm() == 0) toward = Vector3::UnitY();
  for (int turn = 0; turn < kMaxTurns; ++turn) {
    const int ia = a.support(-toward), ib = b.support(toward);
    const Vector3 w = a.vertex(ia) - b.vertex(ib);
    if (simplex.size > 0) {
      const double slack = nearest.square - nearest.point.dot(w);
      const double length = std::sqrt(nearest.square);
      if (slack <= kRoundOff * length * (length + scale) || simplex.has(ia, ib)) break;
    }
    Simplex grown = simplex;
    grown.corner[static_cast<std::size_t>(grown.size++)] = {w, ia, ib};
    const Nearest next = nearest_to_origin(grown);
    if (next.square >= nearest.square) break;
    nearest = next;
    if (nearest.size == 4 || nearest.square <= kRoundOff * kRoundOff * scale * scale) return false;
    simplex = grown;
    simplex.keep(nearest);
    toward = nearest.point;
  }
  fill(a, b, simplex, nearest, gap);
  return true;
}

}  // namespace breve
