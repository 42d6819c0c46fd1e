// Slow, plain answers to compare with: distance of polyhedra over all pairs of features, and random solids.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "runtime/solid/contact.hpp"

namespace breve::oracle {

inline double segment_segment(const Vector3& p, const Vector3& p2, const Vector3& q, const Vector3& q2) {
  // The minimum over the square of parameters is inside it or on one of its four sides.
  const Vector3 d = p2 - p, e = q2 - q, r = p - q;
  const auto point_segment = [](const Vector3& x, const Vector3& a, const Vector3& b) {
    return (x - a - std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0) * (b - a)).norm();
  };
  double best =
      std::min({point_segment(p, q, q2), point_segment(p2, q, q2), point_segment(q, p, p2), point_segment(q2, p, p2)});
  const double dd = d.dot(d), ee = e.dot(e), de = d.dot(e), det = dd * ee - de * de;
  if (det > 1e-18 * dd * ee) {
    const double s = (de * e.dot(r) - ee * d.dot(r)) / det, t = (dd * e.dot(r) - de * d.dot(r)) / det;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best = std::min(best, (r + s * d - t * e).norm());
  }
  return best;
}

/// Distance of a point from the inside of a face; infinity if it does not project into the face.
inline double point_face(const Vector3& p, const std::vector<Vector3>& corners) {
  const Vector3 n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3& a = corners[i];
    const Vector3& b = corners[(i + 1) % corners.size()];
    if ((b - a).cross(p - a).dot(n) < 0) return std::numeric_limits<double>::infinity();
  }
  return std::abs(n.dot(p - corners[0]));
}

struct Solid {
  std::vector<std::vector<Vector3>> faces;
  std::vector<Vector3> vertices;
};

inline Solid world(const Shape& shape, const Pose& pose) {
  Solid out;
  for (const Vector3& v : shape.vertices()) out.vertices.push_back(pose.location + pose.orientation * v);
  for (const auto& face : shape.faces()) {
    out.faces.emplace_back();
    for (const int v : face) out.faces.back().push_back(out.vertices[static_cast<std::size_t>(v)]);
  }
  return out;
}

/// Distance of two polyhedra that do not overlap.
inline double distance(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb) {
  const Solid sa = world(a, pa), sb = world(b, pb);
  double best = std::numeric_limits<double>::infinity();
  for (const auto& face : sa.faces) {
    for (const Vector3& p : sb.vertices) best = std::min(best, point_face(p, face));
  }
  for (const auto& face : sb.faces) {
    for (const Vector3& p : sa.vertices) best = std::min(best, point_face(p, face));
  }
  for (const auto& fa : sa.faces) {
    for (std::size_t i = 0; i < fa.size(); ++i) {
      for (const auto& fb : sb.faces) {
        for (std::size_t j = 0; j < fb.size(); ++j) {
          best = std::min(best, segment_segment(fa[i], fa[(i + 1) % fa.size()], fb[j], fb[(j + 1) % fb.size()]));
        }
      }
    }
  }
  return best;
}

/// max over a minus min over b along n: positive if a and b overlap in their shadows on n.
inline double shadow_overlap(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, const Vector3& n) {
  double high = -std::numeric_limits<double>::infinity(), low = std::numeric_limits<double>::infinity();
  for (const Vector3& v : a.vertices()) high = std::max(high, n.dot(pa.orientation * v));
  for (const Vector3& v : b.vertices()) low = std::min(low, n.dot(pb.orientation * v));
  return high - low - n.dot(pb.location - pa.location);
}

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * unit_(engine_); }
  Vector3 vector(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  // Compilers differ in the order of arguments: one number a declaration, so that all draw the same samples.
  Quaternion rotation() {
    const double z = between(-1, 1), y = between(-1, 1), x = between(-1, 1), w = between(-1, 1);
    return Quaternion(w, x, y, z).normalized();
  }
  Vector3 edges(double low, double high) {
    const double z = between(low, high), y = between(low, high), x = between(low, high);
    return {x, y, z};
  }
  Vector3 direction() { return rotation() * Vector3::UnitX(); }
  std::shared_ptr<Shape> polyhedron(int which) {
    switch (which % 4) {
      case 0: return Shape::box(edges(0.2, 2));
      case 1: {
        const double radius = between(0.3, 1.2), height = between(0.2, 2);
        return Shape::prism(3 + which % 7, height, radius);
      }
      case 2: {
        const double radius = between(0.3, 1.2), height = between(0.3, 2);
        return Shape::cone(3 + which % 5, height, radius);
      }
      default: {
        const double z = between(0.5, 2), y = between(0.5, 2), x = between(0.02, 0.1);
        const auto shape = Shape::box(Vector3(1, 1, 1));
        shape->set_scale(Vector3(x, y, z));  // a plate
        return shape;
      }
    }
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> unit_{0, 1};
};

}  // namespace breve::oracle
