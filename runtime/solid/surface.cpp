// The few formulas that both kinds of surface need.
#include "runtime/solid/surface.hpp"

#include <cmath>
#include <limits>

namespace breve {

Vector3 normal_of(const Vector3& a, const Vector3& b, const Vector3& c) {
  return Vector3((b - a).cross(c - a)).stableNormalized();
}

double ray_meets(const std::array<Vector3, 3>& corner, const Vector3& origin, const Vector3& direction) {
  constexpr double kMiss = std::numeric_limits<double>::infinity(), kRim = 1e-12;
  const Vector3 u = corner[1] - corner[0], v = corner[2] - corner[0], s = origin - corner[0];
  const Vector3 normal = u.cross(v);
  const double rise = -direction.dot(normal);
  if (rise == 0) return kMiss;
  const double t = s.dot(normal) / rise;
  const Vector3 across = s.cross(direction);
  const double b = v.dot(across) / rise, c = -u.dot(across) / rise;
  if (!(t >= 0 && b >= -kRim && c >= -kRim && b + c <= 1 + kRim)) return kMiss;
  return t;
}

namespace {

/// Ends at the first facet.
class AnyFacet final : public FacetVisitor {
 public:
  bool wants(const Eigen::AlignedBox3d&) const override { return !found; }
  void visit(const Facet&) override { found = true; }
  bool found = false;
};

}  // namespace

bool Surface::meets(const Eigen::AlignedBox3d& box) const {
  AnyFacet any;
  under(box, any);
  return any.found;
}

bool stands_out(const Vector3& normal, const Vector3& neighbour, const Vector3& opposite, bool solid) {
  constexpr double kFlat = 0.99996;  // the cosine of half a degree
  if (normal.dot(neighbour) > kFlat) return false;
  return !solid || normal.dot(opposite) < 0;
}

}  // namespace breve
