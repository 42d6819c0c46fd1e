// Do two boxes overlap?
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace adversary {

struct Box {
  Eigen::Vector3d at;
  Eigen::Matrix3d axes;  // columns
  Eigen::Vector3d half;
};

/// By the axis of separation (Gottschalk, Lin, Manocha 1996): the faces' normals and the products of the edges.
inline bool boxes_overlap(const Box& a, const Box& b) {
  const Eigen::Vector3d way = b.at - a.at;
  const auto apart = [&](const Eigen::Vector3d& axis) {
    const double reach =
        (a.axes.transpose() * axis).cwiseAbs().dot(a.half) + (b.axes.transpose() * axis).cwiseAbs().dot(b.half);
    return axis.norm() > 1e-6 && std::abs(way.dot(axis)) > reach;
  };
  for (int i = 0; i < 3; ++i) {
    if (apart(a.axes.col(i)) || apart(b.axes.col(i))) return false;
    for (int j = 0; j < 3; ++j)
      if (apart(a.axes.col(i).cross(b.axes.col(j)))) return false;
  }
  return true;
}

}  // namespace adversary
