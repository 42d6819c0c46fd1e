// The mathematical types of the runtime: Eigen's, under the names that the rest of the code uses.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace breve {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;  // world = R * local; rows as scripts see them
using Quaternion = Eigen::Quaterniond;                         // unit length; (w, x, y, z) in files and in the C API

}  // namespace breve
