// What the world tells about its bodies' energy, and about what the guard did.
#pragma once

#include <cstdint>
#include <string_view>

#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"

namespace breve {

/// J. The first three are of now, the rest since the ledger began; works are positive when energy comes in, losses when
/// it goes out. kinetic + potential + springs - (their sum at the start) = works - losses + residual.
struct Energy {
  double kinetic = 0;
  double potential = 0;      // in the field of gravity, zero at the world's origin
  double springs = 0;        // of joints, of Springs and of contacts
  double motor_work = 0;     // of the motors of joints
  double script_work = 0;    // of forces that scripts and hosts set, and of moving, striking and changing bodies
  double contact_loss = 0;   // in impacts and resting contacts, along the normal
  double friction_loss = 0;  // in them, along the surface
  double drag_loss = 0;      // of dampers: of joints and Springs
  double limit_loss = 0;     // at the limits of joints
  double residual = 0;       // unexplained energy: the error of the method

  double total() const { return kinetic + potential + springs; }
};

enum class GuardMode : std::uint8_t { Off, Report, Refine, Rest };
/// "off", "report", "refine", "rest".
std::string_view name_of(GuardMode mode);
/// Error{Argument} that lists the names if there is no such mode.
GuardMode guard_named(std::string_view name);

/// Why the guard looked up.
enum class GuardReason : std::uint8_t {
  NotFinite,
  Residual,
  Penetration,
  FastRotation,
  FastDamping,
  Impacts,
  NoSolution,
  Work,
  FastMotion,
  OpenJoint
};
/// In words: "a number is not finite".
std::string_view words_for(GuardReason reason);

/// What the guard did about it.
enum class GuardAction : std::uint8_t { Reported, Refined, Rested, Finished };
std::string_view name_of(GuardAction action);

struct Intervention {
  std::uint64_t iteration = 0;
  double time = 0;  // s
  ObjectId body;    // the one that showed it
  GuardReason reason = GuardReason::NotFinite;
  GuardAction action = GuardAction::Reported;
  double value = 0;  // what was measured: J, m, |w| h, c h / I, units of work
};

/// An impulse at a contact, for hosts: in the order in which they happened.
struct Impact {
  ObjectId a, b;  // b may be null: something without an object
  double time = 0;
  Vector3 point = Vector3::Zero();
  Vector3 normal = Vector3::Zero();   // unit, from b toward a
  Vector3 impulse = Vector3::Zero();  // on a, N*s
};

/// What the last iteration took. Counts only: what they count is defined, so that runs can be compared.
struct DynamicsCounters {
  std::uint64_t sub_steps = 0;    // of islands, rejected ones not counted
  std::uint64_t evaluations = 0;  // of forces, by trees
  std::uint64_t rejected = 0;     // steps of step control that were tried again
  std::uint64_t islands = 0;
  std::uint64_t pairs = 0;  // looked at by the narrow phase
  std::uint64_t manifolds = 0;
  std::uint64_t contacts = 0;  // points
  std::uint64_t warm = 0;      // of them, with an impulse from the last sub-step
  std::uint64_t impacts = 0;   // at their time of impact
  std::uint64_t searches = 0;  // for a time of impact
  std::uint64_t solver_iterations = 0;
  std::uint64_t direct = 0;    // islands solved directly
  std::uint64_t limits = 0;    // joint limits that were in force
  std::uint64_t rebuilt = 0;   // trees
  std::uint64_t sleeping = 0;  // bodies asleep now
  std::uint64_t interventions = 0;
  std::uint64_t work = 0;  // units of it, see Meter
  // The worst error of the solutions of all rows, m/s: how far some row's velocity misses its law; where rows were
  // swept, by how much the last sweep still changed one. A flat world's engine does not tell.
  double residual = 0;
};

}  // namespace breve
