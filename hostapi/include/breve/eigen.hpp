// eigen.hpp: the numbers of breve.hpp as types of Eigen, for hosts that use it. Needs Eigen 3.4; nothing else of breve
// does.
//
//     Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> places(birds.size(), 3);
//     world.get_all(birds.data(), birds.size(), BREVE_PROPERTY_LOCATION, breve::rows(places)).or_throw();
//     const Eigen::Vector3d centre = places.colwise().mean();
//
// Maps refer to the memory that they are made from, and copy nothing.
#ifndef BREVE_EIGEN_HPP
#define BREVE_EIGEN_HPP

#include <Eigen/Geometry>

#include "breve/breve.hpp"

namespace breve {
inline namespace abi4 {

inline Eigen::Map<Eigen::Vector3d> map(Vector& v) { return Eigen::Map<Eigen::Vector3d>(v.data()); }
inline Eigen::Map<const Eigen::Vector3d> map(const Vector& v) { return Eigen::Map<const Eigen::Vector3d>(v.data()); }
inline Vector vector_of(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

inline Eigen::Map<Eigen::Vector3d> location(breve_pose& pose) { return Eigen::Map<Eigen::Vector3d>(pose.location); }
inline Eigen::Map<const Eigen::Vector3d> location(const breve_pose& pose) {
  return Eigen::Map<const Eigen::Vector3d>(pose.location);
}
/// A copy: Eigen stores the numbers of a quaternion in another order.
inline Eigen::Quaterniond rotation(const breve_pose& pose) {
  return {pose.rotation[0], pose.rotation[1], pose.rotation[2], pose.rotation[3]};
}
/// From the object's own frame to the world's.
inline Eigen::Isometry3d transform(const breve_pose& pose) {
  return Eigen::Translation3d(location(pose)) * rotation(pose);
}
inline breve_pose pose_of(const Eigen::Vector3d& location, const Eigen::Quaterniond& rotation) {
  return {{location[0], location[1], location[2]}, {rotation.w(), rotation.x(), rotation.y(), rotation.z()}};
}
inline breve_pose pose_of(const Eigen::Isometry3d& transform) {
  return pose_of(transform.translation(), Eigen::Quaterniond(transform.linear()));
}

/// The rows of a matrix as an array for bulk calls, one row for each object. The matrix keeps its memory during the
/// call.
template <class Number, int rows_, int columns>
Array rows(Eigen::Matrix<Number, rows_, columns, Eigen::RowMajor>& matrix) {
  return {matrix.data(), static_cast<std::uint32_t>(matrix.cols())};
}

}  // namespace abi4
}  // namespace breve

#endif
