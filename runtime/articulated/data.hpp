// Workspace of the algorithms: everything they write, allocated once for a model. One Data serves one thread at a time.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/articulated/model.hpp"
#include "runtime/articulated/state.hpp"

namespace breve::articulated {

/// One link, world axes, moments about its own origin. The algorithms state which pass writes which field.
struct Work {
  Matrix3 rotation = Matrix3::Identity();  // world = rotation * body
  Vector3 offset = Vector3::Zero();        // from the parent's origin to this one
  Vector3 axis = Vector3::Zero();          // of the joint
  Vector3 spin = Vector3::Zero();          // rotational velocity
  Vector3 bias_alpha = Vector3::Zero();    // what rotational acceleration would be if parent's and joint's were zero
  Vector3 bias_acc = Vector3::Zero();      // the same of the origin's acceleration
  ArticulatedInertia inertia;              // of the link and all that hangs on it, joints free
  Vector3 couple = Vector3::Zero();        // force at the inboard joint that the links beyond need at zero acceleration
  Vector3 force = Vector3::Zero();
  Vector3 pull_couple = Vector3::Zero();  // inertia times the joint's axis
  Vector3 pull_force = Vector3::Zero();
  double inverse = 0;               // 1 / (axis . inertia . axis)
  double push = 0;                  // joint force left over for acceleration
  Vector3 alpha = Vector3::Zero();  // rotational acceleration
  Vector3 acc = Vector3::Zero();    // of the origin, gravity taken off
};

/// What joints with two, three and six degrees of freedom need besides.
struct WideWork {
  Vector3 axis2 = Vector3::Zero();         // universal: second axis
  Vector3 pull2_couple = Vector3::Zero();  // universal: inertia times it, the first axis being free
  Vector3 pull2_force = Vector3::Zero();
  double inverse2 = 0;                    // universal: 1 / (axis2 . pull2)
  double coupling = 0;                    // universal: axis . inertia . axis2
  double push2 = 0;                       // universal: second joint force left over
  Symmetric3 inverse;                     // ball: of the joint's inertia; free: of its rotational part, origin free
  Symmetric3 inverse_mass;                // free: of the linear block
  double added = 0;                       // ball: on the diagonal of the joint's inertia
  Vector3 push_couple = Vector3::Zero();  // ball, free: joint force left over, world axes
  Vector3 push_force = Vector3::Zero();   // free
};

/// A link seen from the world.
struct Motion {
  Vector3 origin = Vector3::Zero();    // of the body frame
  Vector3 velocity = Vector3::Zero();  // of that point
};

/// What motors of ball joints that are at their limit need besides (ball_motors.hpp).
struct BallMotors {
  Vector gains;                        // (nv) with which they give just their limit
  Vector direction, answer;            // (nv)
  std::pmr::vector<int> at;            // first velocity of each that is at its limit
  std::pmr::vector<double> responses;  // of each to each
  std::pmr::vector<double> steps;
};

class Data {
 public:
  /// @param memory  where the arrays of links live; outlives the Data
  explicit Data(const Model& model, std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  // Entry 0 is the world, which rests; link i has entry i + 1. So roots need no special case. After inverse_dynamics
  // the couple and force of the world are what the ground gives.
  std::pmr::vector<Work> work;
  std::pmr::vector<WideWork> wide;
  std::pmr::vector<Motion> motion;

  Vector tau;                              // (nv) joint forces, drives included
  Vector diagonal;                         // (nv) added to the joints' own inertia
  Vector acceleration;                     // (nv)
  Vector rest;                             // (nq) all joints at zero: where springs are slack if nothing else is said
  Vector deflection;                       // (nv) of springs
  Vector held;                             // (nv) forces of motors that are at their limit
  std::pmr::vector<signed char> at_limit;  // (nv) 1 or -1: the motor is, on that side (of a ball joint 1); 0: it is not
  BallMotors balls;

  Work& of(int link) { return work[static_cast<std::size_t>(link + 1)]; }
  const Work& of(int link) const { return work[static_cast<std::size_t>(link + 1)]; }
  Motion& motion_of(int link) { return motion[static_cast<std::size_t>(link + 1)]; }
  const Motion& motion_of(int link) const { return motion[static_cast<std::size_t>(link + 1)]; }
  /// The data of a joint with more than one degree of freedom; for others some entry that nobody reads.
  WideWork& wide_of(const Body& body) { return wide[static_cast<std::size_t>(body.wide + 1)]; }
  const WideWork& wide_of(const Body& body) const { return wide[static_cast<std::size_t>(body.wide + 1)]; }

  /// Whether all that forward_kinematics writes belongs to this state, to the bit: passes need not place links again.
  bool stands_at(const State& state) const { return stands_ && same_bits(at_.q, state.q) && same_bits(at_.v, state.v); }
  /// The same of what depends on q alone: rotation, offset and axes.
  bool stands_at(const Vector& q) const { return stands_ && same_bits(at_.q, q); }
  void stand_at(const State& state);
  /// Some pass is about to place links elsewhere.
  void leave() { stands_ = false; }
  /// Another number for each time that forward_kinematics places links: what was summed over them holds while it stays.
  std::uint64_t standing() const { return standing_; }

 private:
  static bool same_bits(const Vector& a, const Vector& b);

  State at_;
  bool stands_ = false;
  std::uint64_t standing_ = 0;
};

}  // namespace breve::articulated
