// The memory and the workspace of one tree.
#include "runtime/dynamics/tree.hpp"

#include <utility>

#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/kinematics.hpp"

namespace breve {

namespace {

/// What a model, a state, loads and an integrator of that many links and joints take from C++'s allocator.
std::size_t estimate(const std::vector<articulated::Link>& links) {
  std::size_t numbers = 0;
  for (const articulated::Link& link : links)
    numbers +=
        static_cast<std::size_t>(articulated::position_count(link.type) + articulated::velocity_count(link.type));
  constexpr std::size_t kVectors = 64;  // of an integrator, Data, State and Loads, each (nq) or (nv)
  return links.size() * (sizeof(articulated::Body) + sizeof(articulated::Drive) + sizeof(articulated::Wrench) +
                         sizeof(std::string)) +
         kVectors * numbers * sizeof(double);
}

}  // namespace

Tree::Tree(std::pmr::memory_resource* memory, const std::vector<articulated::Link>& description)
    : reserved(memory, estimate(description)),
      model(description),
      data(model, memory),
      state(articulated::neutral_state(model)),
      links(memory),
      loops(memory),
      held(memory),
      row_numbers(memory),
      row_forces(memory),
      row_order(memory),
      anchors(memory),
      loop_holders(memory) {
  work_q = state.q;
  work_v = work_u = work_w = free_v = smooth_v = way = push = kick = reacted = motor_impulse = part_impulse = state.v;
  limit_force = held_force = mean = state.v;
  loads.reaction = state.v;
  step_state = sub_state = part_state = state;
}

const articulated::Whole& Tree::measured() {
  articulated::forward_kinematics(model, data, state);
  if (std::exchange(measured_at_, data.standing()) != data.standing()) measured_ = measure_whole(model, data);
  return measured_;
}

double Tree::kinetic() {
  articulated::forward_kinematics(model, data, state);
  if (std::exchange(kinetic_at_, data.standing()) != data.standing()) kinetic_ = kinetic_energy(model, data);
  return kinetic_;
}

Pose Tree::pose(int link) const {
  const articulated::Work& work = data.of(link);
  Pose pose;
  const articulated::Body& body = model.body(link);
  if (body.type == articulated::JointType::Free) {
    // The state's own quaternion: a matrix on the way would cost digits.
    const double* q = state.q.data() + body.q + 3;
    pose.orientation = Quaternion(q[0], q[1], q[2], q[3]);
  } else {
    pose.orientation = Quaternion(Eigen::Matrix3d(work.rotation)).normalized();
  }
  pose.location = data.motion_of(link).origin - work.rotation * links[static_cast<std::size_t>(link)].origin;
  return pose;
}

Vector3 Tree::velocity(int link) const {
  const articulated::Work& work = data.of(link);
  return data.motion_of(link).velocity -
         work.spin.cross(Vector3(work.rotation * links[static_cast<std::size_t>(link)].origin));
}

}  // namespace breve
