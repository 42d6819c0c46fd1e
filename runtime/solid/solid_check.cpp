// Whether closed triangles bound a solid: they must not cross one another, and shells must lie apart or be hollows.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "runtime/base/error.hpp"
#include "runtime/solid/pieces.hpp"

namespace breve {

namespace {

[[noreturn]] void refuse_solid(const std::string& why) { throw Error(ErrorCode::Argument, "a mesh " + why); }

bool has(const Triangle& t, std::int32_t corner) { return t[0] == corner || t[1] == corner || t[2] == corner; }

/// Looks for a triangle that one edge passes through.
class Crossing final : public FacetVisitor {
 public:
  Crossing(const TriangleMesh& mesh, std::int32_t a, std::int32_t b) : mesh_(mesh), a_(a), b_(b) {}
  bool wants(const Eigen::AlignedBox3d&) const override { return found < 0; }
  void visit(const Facet& facet) override {
    const Triangle& t = mesh_.triangles()[facet.index];
    if (found >= 0 || has(t, a_) || has(t, b_)) return;
    const Vector3 &a = mesh_.corners()[at(a_)], &b = mesh_.corners()[at(b_)];
    // Both ends clearly off the plane, so that solids which only touch do not count.
    const double hair = kHair * mesh_.bounds().sizes().maxCoeff();
    const double from = facet.normal.dot(a - facet.corner[0]), to = facet.normal.dot(b - facet.corner[0]);
    if (!((from > hair && to < -hair) || (from < -hair && to > hair))) return;
    const Vector3 x = a + from / (from - to) * (b - a);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 &p = facet.corner[i], &q = facet.corner[(i + 1) % 3];
      if (facet.normal.cross(q - p).stableNormalized().dot(x - p) <= hair) return;
    }
    found = static_cast<std::int64_t>(facet.index);
  }

  std::int64_t found = -1;

 private:
  static constexpr double kHair = 1e-9;  // of the extent

  const TriangleMesh& mesh_;
  std::int32_t a_, b_;
};

void check_crossings(const TriangleMesh& mesh, const Charge& charge) {
  for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
    const Triangle& t = mesh.triangles()[i];
    for (std::size_t e = 0; e < 3; ++e) {
      const std::int32_t a = t[e], b = t[(e + 1) % 3];
      if (a > b) continue;  // the neighbour's
      Crossing crossing(mesh, a, b);
      Eigen::AlignedBox3d box(mesh.corners()[at(a)]);
      mesh.under(box.extend(mesh.corners()[at(b)]), crossing);
      charge(1 + crossing.counters.boxes / 4);
      if (crossing.found < 0) continue;
      refuse_solid(fmt::format("crosses itself: an edge of triangle {} passes through triangle {}", i, crossing.found));
    }
  }
}

/// The number of the shell that each triangle belongs to: that of its lowest triangle.
std::vector<std::size_t> shells_of(const TriangleMesh& mesh) {
  std::vector<std::size_t> parent(mesh.triangles().size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<std::size_t> first_at(mesh.corners().size(), SIZE_MAX);
  for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
    for (const std::int32_t v : mesh.triangles()[i]) {
      std::size_t& first = first_at[at(v)];
      if (first == SIZE_MAX) first = i;
      const std::size_t p = root(first), q = root(i);
      parent[std::max(p, q)] = std::min(p, q);
    }
  }
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(i);
  return parent;
}

/// How many times the surface runs around a point: 1 inside a solid, 0 outside it and in its hollows.
int winding(const TriangleMesh& mesh, Vector3 point, double hair, const Charge& charge) {
  // Slanting, so that it runs along no face of what people build.
  const Vector3 direction = Vector3(0.5377, 0.7331, 0.4163).normalized();
  int around = 0;
  double t;
  Facet hit;
  while (mesh.raycast(point, direction, t, hit)) {
    charge(64);
    around += hit.normal.dot(direction) > 0 ? 1 : -1;
    point += (t + hair) * direction;
  }
  return around;
}

/// A hair off one triangle of each shell there must be nothing on the one side, and solid on the other.
void check_nesting(const TriangleMesh& mesh, const Charge& charge) {
  constexpr double kHair = 1e-7;  // of the extent
  const double hair = kHair * mesh.bounds().sizes().maxCoeff();
  const std::vector<std::size_t> shell = shells_of(mesh);
  for (std::size_t i = 0; i < shell.size(); ++i) {
    if (shell[i] != i) continue;
    const Triangle& t = mesh.triangles()[i];
    const Vector3 &a = mesh.corners()[at(t[0])], &b = mesh.corners()[at(t[1])], &c = mesh.corners()[at(t[2])];
    const Vector3 off = hair * normal_of(a, b, c);
    if (winding(mesh, (a + b + c) / 3 + off, hair / 100, charge) == 0) continue;
    refuse_solid(fmt::format(
        "has one closed part inside another (that of triangle {}): turn it inside out for a hollow, or leave it out",
        i));
  }
}

}  // namespace

void check_solid(const TriangleMesh& mesh, const Charge& charge) {
  if (!mesh.solid()) refuse_solid("is not closed: only a closed one can be split into convex pieces");
  check_crossings(mesh, charge);
  check_nesting(mesh, charge);
}

}  // namespace breve
