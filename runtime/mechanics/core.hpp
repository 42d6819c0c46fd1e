// What the inside of Dynamics and the inside of Planar have in common: settings, what joints and springs are, what
// happened in the last iteration. The functions of Mechanics that are the same in both work on this.
#pragma once

#include <algorithm>
#include <map>
#include <memory_resource>
#include <vector>

#include "runtime/mechanics/mechanics.hpp"

namespace breve {

/// An entry of the table of joints, as far as it is the same in space and in a flat world.
struct JointRecord {
  bool used = false;
  ObjectId owner;
  JointDescription is;
  JointDrive drive;
  std::uint64_t serial = 0;  // in the order of creation
  bool loop = false;         // it closes a loop
};

/// The same of a spring.
struct SpringRecord {
  bool used = false;
  ObjectId owner;
  SpringDescription is;
  double force = 0;  // N, in the last sub-step
};

struct AssemblySettings {
  bool has_self = false, self_collisions = false;
  double self_erp = 0, self_cfm = 0;  // in space
  bool has_accuracy = false;
  Accuracy accuracy;
};

struct WorldSettings {
  Vector3 gravity{0, -9.81, 0};
  Accuracy accuracy = accuracy_of(Rung::Balanced);
  GuardMode guard = GuardMode::Rest;
  bool sleeping = false;
  int fast_contacts = 0;
  double erp = 0.1, cfm = 1e-6;
  int workers = 1;
  double unit = 1;  // m, about the size of bodies; a flat world computes with it as 1
};

struct MechanicsCore : InMemory {
  MechanicsCore(std::pmr::memory_resource* where, Bodies& of)
      : memory(where),
        bodies(&of),
        free_joints(where),
        free_springs(where),
        own(where),
        interventions(where),
        impacts(where) {}

  std::pmr::memory_resource* memory;
  Bodies* bodies;
  WorldSettings settings;
  std::pmr::vector<JointIndex> free_joints;  // of the table of joints; the next to be used last
  std::uint64_t next_serial = 0;             // of a joint
  std::pmr::vector<SpringIndex> free_springs;
  std::pmr::map<BodyIndex, AssemblySettings> own;  // by body
  std::uint64_t rules = 0;  // grows when the answer may change whether two bodies push each other

  std::uint64_t iteration = 0;
  std::uint64_t sub_step = 0;  // since the beginning, for force methods
  WorkBound bound;             // of the iteration
  DynamicsCounters counters;
  std::pmr::vector<Intervention> interventions;
  std::pmr::vector<Impact> impacts;
  Energy ledger;  // works and losses of all since the ledger began

  bool over() const {
    if (bound.ended && bound.ended->load(std::memory_order_relaxed)) return true;
    return bound.most > 0 && counters.work >= bound.most;
  }
};

// --- tables with free places ----------------------------------------------------------------------------------------

/// Whoever gives a place back allocates nothing.
template <class Entry, class Index>
void reserve_free(const std::pmr::vector<Entry>& table, std::pmr::vector<Index>& free) {
  if (free.capacity() <= table.size()) free.reserve(2 * table.size() + 16);
}

/// A place for a new entry: a free one, or one more.
template <class Entry, class Index>
Index take_slot(std::pmr::vector<Entry>& table, std::pmr::vector<Index>& free) {
  if (free.empty()) {
    table.emplace_back();
    return static_cast<Index>(table.size() - 1);
  }
  const Index index = free.back();
  free.pop_back();
  return index;
}

// --- joints in the order of creation --------------------------------------------------------------------------------

template <class Joint>
void insert_joint(const std::pmr::vector<Joint>& joints, JointIndex joint, std::pmr::vector<JointIndex>& list) {
  const auto earlier = [&joints](JointIndex x, std::uint64_t serial) { return joints[x].serial < serial; };
  list.insert(std::lower_bound(list.begin(), list.end(), joints[joint].serial, earlier), joint);
}

template <class Joint>
void sort_joints(const std::pmr::vector<Joint>& joints, std::pmr::vector<JointIndex>& list) {
  std::sort(list.begin(), list.end(),
            [&joints](JointIndex x, JointIndex y) { return joints[x].serial < joints[y].serial; });
}

template <class Joint>
std::pmr::vector<JointIndex> used_joints(const std::pmr::vector<Joint>& joints, std::pmr::memory_resource* memory) {
  std::pmr::vector<JointIndex> all(memory);
  for (JointIndex i = 0; i < joints.size(); ++i)
    if (joints[i].used) all.push_back(i);
  sort_joints(joints, all);
  return all;
}

// --- what is asked and refused in the same words --------------------------------------------------------------------

/// Joints and springs of a census.
template <class Joint, class Spring>
void count_connections(const std::pmr::vector<Joint>& joints, const std::pmr::vector<Spring>& springs,
                       Mechanics::Census& census) {
  const auto count = [](std::size_t& number, ObjectId& first, ObjectId owner) {
    if (number++ == 0) first = owner;
  };
  for (const JointRecord& joint : joints) {
    if (!joint.used) continue;
    count(census.joints, census.first_joint, joint.owner);
    if (has_limits(joint.drive, joint.is.kind)) count(census.limits, census.first_limit, joint.owner);
    if (joint.drive.strength_limit > 0) count(census.motors, census.first_motor, joint.owner);
    if (joint.drive.stiffness > 0) count(census.springs, census.first_spring, joint.owner);
  }
  for (const SpringRecord& spring : springs)
    if (spring.used) count(census.springs, census.first_spring, spring.owner);
}

/// The functions below throw Error{Argument}.
void check_motion(const Vector3& velocity, const Vector3& spin);
void check_softness_within(double erp, double cfm);
void check_ends(const SpringDescription& is, const Bodies& bodies);
[[noreturn]] void fail_no_joint();
[[noreturn]] void fail_no_spring();
/// "the position of a joint must be finite"
[[noreturn]] void fail_not_finite(std::string_view what);
[[noreturn]] void fail_loop_joint(JointKind kind);

/// Settings out of an image: Error{Image} for those that no setter lets pass.
void check_loaded(const WorldSettings& settings);

}  // namespace breve
