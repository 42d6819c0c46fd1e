// What acts on a tree of bodies: gravity, joint forces, wrenches on links, and the springs, dampers and motors of
// joints.
#pragma once

#include <vector>

#include "runtime/articulated/state.hpp"

namespace breve::articulated {

/// A force and a couple, world axes.
struct Wrench {
  Vector3 couple = Vector3::Zero();  // N*m
  Vector3 force = Vector3::Zero();   // N
};

/// Spring, damper and motor of one joint. All act on each degree of freedom alike; a spring of a ball joint pulls along
/// the rotation vector back to its rest.
struct Drive {
  double stiffness = 0;    // N*m/rad or N/m, >= 0
  double damping = 0;      // N*m*s or N*s/m, >= 0
  double motor_gain = 0;   // the motor gives gain * (its speed - v), N*m*s or N*s/m, >= 0; 0: no motor
  double motor_limit = 0;  // and at most this, N*m or N, >= 0
};

struct Loads {
  Vector3 gravity = Vector3::Zero();  // m/s^2, world axes
  Vector tau;                         // joint forces (nv); empty: none
  std::vector<Wrench> wrenches;       // one a link, couple about and force through its centre of mass; empty: none
  std::vector<Drive> drives;          // one a link; empty: none
  Vector rest;                        // (nq) where springs are slack; empty: joints at zero
  Vector motor_speed;                 // (nv) what motors aim at; empty: 0
  Vector reaction;                    // (nv) further joint forces, of what holds the tree; only if `reacts`
  bool reacts = false;
  /// s; above 0 a motor looks ahead by that time, with any `step`: it gives gain * (its speed - v - motor_time * v').
  /// With a gain beyond the joint's inertia over motor_time, v follows its speed as (speed - v) / motor_time, whatever
  /// the load, up to the motor's limit. Smooth, so that every scheme keeps its order.
  double motor_time = 0;
};

/// How far ahead motors look in a solve with `step`, s.
inline double motor_lag(const Loads& loads, double step) { return loads.motor_time > 0 ? loads.motor_time : step; }

class Data;

/// Gathers joint forces into data.tau and what the implicit treatment adds to the joints' inertia into data.diagonal.
/// @param step  0: forces at q and v. Above: springs, dampers and motors at the end of a step of that length (s),
/// linearly
///              implicit: tau = -k (q + h v) - d v, and h d + h^2 k on the joint's own inertia, so that no stiffness is
///              too large for the step. Motors are implicit but for those that data.at_limit names
void gather_joint_forces(const Model& model, const Loads& loads, const State& state, double step, Data& data);

/// Energy stored in the springs of all joints, J.
double spring_energy(const Model& model, const Loads& loads, const Vector& q, Data& data);

}  // namespace breve::articulated
