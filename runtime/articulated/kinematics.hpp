// Links as seen from the world: poses, velocities, accelerations.
#pragma once

#include "runtime/articulated/data.hpp"
#include "runtime/articulated/loads.hpp"

namespace breve::articulated {

/// Places all links and gives them their velocities: rotation, offset, axis, spin and bias in data.work, origin and its
/// velocity in data.motion. World axes. Cost O(links). No allocation.
void forward_kinematics(const Model& model, Data& data, const State& state);

struct Pose {
  Vector3 position;  // of the body frame's origin, m
  Matrix3 rotation;  // world = rotation * body
};
/// After forward_kinematics.
Pose pose(const Data& data, int link);
Vector3 com_position(const Model& model, const Data& data, int link);  // m
Vector3 spin(const Data& data, int link);                              // rad/s, world axes
Vector3 com_velocity(const Model& model, const Data& data, int link);  // m/s
/// The velocity of the link's material point that is at `point` (world), m/s.
Vector3 point_velocity(const Data& data, int link, const Vector3& point);

/// After forward_dynamics with the same loads: accelerations in world axes.
Vector3 rotational_acceleration(const Data& data, int link);                                   // rad/s^2
Vector3 com_acceleration(const Model& model, const Data& data, const Loads& loads, int link);  // m/s^2, free fall: g

}  // namespace breve::articulated
