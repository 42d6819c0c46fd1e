// A thousand clouds of points for convex hulls, random and nasty, and what is known of their hulls.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "runtime/solid/polyhedron.hpp"
#include "tests/runtime/solid_oracle.hpp"

namespace breve::hull_sets {

constexpr int kSets = 1000;

enum class Cloud { Ball, Sphere, Lattice, Box, Doubled, Sliver, Far, Needle, Trembling, Prism };
constexpr int kClouds = 10;
constexpr const char* kCloudNames[kClouds] = {"in a ball", "on a sphere", "lattice", "box",         "doubled points",
                                              "sliver",    "far away",    "needle",  "near copies", "prism"};

struct Set {
  Cloud cloud{};
  std::vector<Vector3> points;
  std::optional<Moments> exact;  // of the hull, about `center`, where there is a closed form
  Vector3 center = Vector3::Zero();
  double extent = 0;  // the longest side of the box around the points
};

/// Moments of a box or of a prism with a regular base, about its centre, turned by `rotation`.
inline Moments box_moments(const Vector3& size, const Quaternion& rotation) {
  const Vector3 squares = size.cwiseAbs2() / 12;
  const Matrix3 r = rotation.toRotationMatrix();
  return {size.prod(), Vector3::Zero(), size.prod() * (r * squares.asDiagonal() * r.transpose())};
}
inline Moments prism_moments(int sides, double height, double radius, const Quaternion& rotation) {
  const double angle = 2 * std::numbers::pi / sides;
  const double area = sides * radius * radius * std::sin(angle) / 2;
  // Mean square of x over a regular polygon, the same along each axis.
  const double square = radius * radius * (2 + std::cos(angle)) / 12;
  const Matrix3 r = rotation.toRotationMatrix();
  const Vector3 squares(square, height * height / 12, square);
  return {area * height, Vector3::Zero(), area * height * (r * squares.asDiagonal() * r.transpose())};
}

/// Corners of a box, and `more` points inside, on its faces and on its edges.
inline std::vector<Vector3> box_points(oracle::Dice& dice, const Vector3& size, int more) {
  std::vector<Vector3> points;
  for (int i = 0; i < 8; ++i) {
    points.push_back(Vector3(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5).cwiseProduct(size));
  }
  for (int i = 0; i < more; ++i) {
    Vector3 p = dice.vector(0.5);
    if (i % 3 > 0) p[i % 2] = i % 4 < 2 ? 0.5 : -0.5;  // on a face
    if (i % 3 > 1) p[2] = i % 8 < 4 ? 0.5 : -0.5;      // on an edge
    points.push_back(p.cwiseProduct(size));
  }
  return points;
}

inline Set make_set(int number) {
  oracle::Dice dice(static_cast<std::uint64_t>(7000 + number));
  Set set;
  set.cloud = static_cast<Cloud>(number % kClouds);
  const int more = 4 + (number / kClouds) * 2;
  const Quaternion rotation = number % 20 < 10 ? dice.rotation() : Quaternion::Identity();
  const auto box = [&](const Vector3& size) {
    set.points = box_points(dice, size, more);
    set.exact = box_moments(size, rotation);
  };
  const auto ball = [&](bool on_sphere) {
    while (static_cast<int>(set.points.size()) < more + 8) {
      const Vector3 p = dice.vector(1);
      if (p.norm() > 1e-3 && p.norm() < 1) set.points.push_back(on_sphere ? Vector3(p.normalized()) : p);
    }
  };
  switch (set.cloud) {
    case Cloud::Ball: ball(false); break;
    case Cloud::Sphere: ball(true); break;
    case Cloud::Lattice:
      ball(false);
      for (Vector3& p : set.points) p = (3 * p).array().round().matrix();
      break;
    case Cloud::Box: box(dice.edges(0.2, 2)); break;
    case Cloud::Doubled:
      box(Vector3(1, 2, 3));
      for (int i = 0; i < more; ++i) set.points.push_back(set.points[static_cast<std::size_t>(i) % 8]);
      break;
    case Cloud::Sliver: box(Vector3(1, 1e-6, dice.between(0.5, 1))); break;
    case Cloud::Far:
      box(Vector3(1, 1, 1));
      set.center = 1e4 * dice.direction();
      break;
    case Cloud::Needle: box(Vector3(1e-2, 1e3, 1e-2)); break;
    case Cloud::Trembling:
      box(Vector3(1, 1.5, 2));
      for (int i = 0; i < more; ++i) {
        set.points.push_back((1 - 1e-9) * set.points[static_cast<std::size_t>(i) % 8] + dice.vector(1e-10));
      }
      break;
    case Cloud::Prism: {
      const int sides = 3 + number / kClouds;
      const auto prism = make_prism(sides, 0.7, 1.3);
      set.points.assign(prism.vertices.begin(), prism.vertices.end());
      set.exact = prism_moments(sides, 0.7, 1.3, rotation);
      break;
    }
  }
  Eigen::AlignedBox3d bounds;
  for (Vector3& p : set.points) bounds.extend(p = rotation * p + set.center);
  set.extent = bounds.sizes().maxCoeff();
  return set;
}

/// How well a solid is the hull of a set: relative errors; `outside` is of the extent.
struct Quality {
  double outside = 0;  // the farthest that a point of the set is over a face
  double volume = 0, inertia = 0;
};

inline Quality quality(const Set& set, const Polyhedron& solid) {
  Quality q;
  for (const auto& face : solid.faces) {
    Polyhedron one;  // the true plane of the face, as its corners have it
    const auto corner = [&](std::size_t i) { return solid.vertices[at(face[i % face.size()])]; };
    Vector3 area = Vector3::Zero();
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      area += (corner(i) - corner(0)).cross(corner(i + 1) - corner(0));
    }
    // The plane of a sliver of a face is round-off; whatever is over it is over its neighbours, which say so.
    if (area.norm() < 1e-9 * set.extent * set.extent) continue;
    for (const Vector3& p : set.points) q.outside = std::max(q.outside, area.normalized().dot(p - corner(0)));
  }
  q.outside /= set.extent;
  if (!set.exact) return q;
  Polyhedron moved = solid;
  for (Vector3& p : moved.vertices) p -= set.center;
  const Moments found = moments(moved);
  q.volume = std::abs(found.volume - set.exact->volume) / set.exact->volume;
  q.inertia = (found.second - set.exact->second).norm() / set.exact->second.norm();
  return q;
}

}  // namespace breve::hull_sets
