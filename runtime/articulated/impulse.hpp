// How a tree of bodies answers impulses: M^-1 applied in O(links), and the collision matrix of two points in O(depth).
#pragma once

#include <span>

#include "runtime/articulated/data.hpp"

namespace breve::articulated {

// All of these stand on the factors that forward_dynamics or factorize left in `data`, and those with points on
// forward_kinematics as well, for the same q. A `step` that these were given also holds here: M then includes what the
// implicit treatment of drives adds. They overwrite alpha, acc, couple and force of data.work. No allocation.

/// An impulse on a link.
struct Impulse {
  int link;
  Vector3 point;                      // of attack, world, m
  Vector3 linear;                     // N*s, world axes
  Vector3 angular = Vector3::Zero();  // N*m*s, world axes
};

/// Change of v (nv) by impulses on links.
void impulse_response(const Model& model, Data& data, std::span<const Impulse> impulses, Vector& change);

/// M^-1 f for joint forces or impulses `f` (nv). `out` may be f.
void apply_inverse_mass(const Model& model, Data& data, const Vector& f, Vector& out);

/// The diagonal of M^-1 (nv): how each joint answers its own force, the other joints being free. Each link's answer to
/// forces on itself follows from its parent's. Source: the operational space inertia of Kreutz-Delgado, Jain, Rodriguez
/// 1992. Cost O(links). Allocates; also overwrites what is left of the joints' forces in `data`.
Vector inverse_mass_diagonal(const Model& model, Data& data);

/// W with dv = W P: the change of the velocity of b's point relative to a's, by an impulse P on b and -P on a.
/// Symmetric and positive semidefinite, also in floating point, being a sum of squares: W = sum over joints of u^T D^-1
/// u, where u is what of the impulse the joint does not take up. Links of one model; -1 is the world. For two models
/// add each one's W against the world. 1/kg. Source: the square factors of the inverse mass matrix, Rodriguez, Jain,
/// Kreutz-Delgado 1991.
Symmetric3 collision_matrix(const Model& model, const Data& data, int link_a, const Vector3& point_a, int link_b,
                            const Vector3& point_b);

}  // namespace breve::articulated
