// Vectors of coordinates, of any length.
#pragma once

#include <Eigen/Core>

namespace breve::articulated {

using Vector = Eigen::VectorXd;

}  // namespace breve::articulated
