// The joint-space mass matrix, for those who need it whole; the dynamics does without.
#pragma once

#include "runtime/articulated/data.hpp"

namespace breve::articulated {

/// M(q) with kinetic energy v.Mv/2, by the composite-rigid-body algorithm.
/// @param mass  (nv, nv), symmetric, positive definite; kg, kg*m, kg*m^2 by the joints it couples. Resized if needed
/// Overwrites the articulated inertias in `data`. Source: Featherstone 2008, table 6.2. Cost O(links * depth).
void mass_matrix(const Model& model, Data& data, const Vector& q, Eigen::MatrixXd& mass);

}  // namespace breve::articulated
