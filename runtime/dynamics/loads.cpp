// What acts on a tree, gathered from joints, bodies, springs and scripts before a step, and at each of its stages.
#include <algorithm>

#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/core.hpp"
#include "runtime/dynamics/joint_frames.hpp"
#include "runtime/dynamics/spring_network.hpp"
#include "runtime/dynamics/stage.hpp"

namespace breve {

namespace {

// A motor lets its joint's velocity follow the wanted one with this delay, s, on every rung and at any step: so that
// the same motor is meant all the way up the ladder.
constexpr double kMotorTime = 0.01;
// How much stiffer a motor is than the inertia that it moves: by this part of it a load can push a held joint.
constexpr double kMotorStiffness = 1e6;

/// Whether a step of h follows the tree's springs and dampers by itself. A spring that is slower than the step loses
/// accuracy if it is treated as implicit; one that is faster would blow up if it were not. The sum over the joints
/// bounds the square of the highest frequency times h.
bool follows(double sum) {
  constexpr double kStable = 4;  // semi-implicit Euler's limit for one oscillator
  return sum < kStable;
}

/// What scripts set; nothing else pushes the link yet.
void read_forces(const Bodies& bodies, TreeLink& link) {
  link.force = bodies.force(link.body);
  link.torque = bodies.torque(link.body);
  link.asked.setZero();
  link.predicted = {};
}

}  // namespace

bool Dynamics::Core::has_limits(const JointEntry& joint) { return breve::has_limits(joint.drive, joint.is.kind); }

void Dynamics::Core::measure_motors(Tree& tree) {
  const articulated::Vector answers = articulated::inverse_mass_diagonal(tree.model, tree.data);
  for (int i = 0; i < tree.model.size(); ++i) {
    const articulated::Body& body = tree.model.body(i);
    double most = 0;
    for (int k = body.v; k < body.v + articulated::velocity_count(body.type); ++k)
      most = std::max(most, answers[k] > 0 ? 1 / answers[k] : 0);
    tree.links[static_cast<std::size_t>(i)].gain_unit = most;
  }
}

void Dynamics::Core::set_loads(Tree& tree, const Accuracy& accuracy, double h) {
  const bool implicit = accuracy.implicit_joints;
  articulated::Loads& loads = tree.loads;
  const auto size = static_cast<std::size_t>(tree.model.size());
  loads.gravity = settings.gravity;
  loads.wrenches.resize(size);
  loads.drives.resize(size);
  tree.springs.drives.resize(size);
  loads.rest.resize(tree.model.positions());
  loads.rest = tree.data.rest;
  loads.tau.setZero(tree.model.velocities());
  tree.set_tau.setZero(tree.model.velocities());
  loads.motor_speed.setZero(tree.model.velocities());
  loads.motor_time = std::max(kMotorTime, h);
  loads.reacts = tree.braced = false;
  tree.driven = tree.aimed = tree.pushed = false;
  double fastest = 0;
  for (const TreeLink& link : tree.links) {
    if (link.joint == kNoJoint || !(link.gain_unit > 0)) continue;
    const JointDrive& drive = joints[link.joint].drive;
    fastest += axis_count(joints[link.joint].is.kind) * h * (drive.damping + h * drive.stiffness) / link.gain_unit;
  }
  const bool explicitly = follows(fastest);
  bool drives = false;
  for (std::size_t i = 0; i < size; ++i) {
    TreeLink& link = tree.links[i];
    read_forces(*bodies, link);
    loads.wrenches[i] = {link.torque, link.force};
    tree.pushed = tree.pushed || link.force != Vector3::Zero() || link.torque != Vector3::Zero();
    articulated::Drive& made = loads.drives[i] = {};
    tree.springs.drives[i] = {};
    if (link.joint == kNoJoint) continue;
    const JointEntry& joint = joints[link.joint];
    const JointDrive& drive = joint.drive;
    const articulated::Body& body = tree.model.body(static_cast<int>(i));
    link.slow_spring = explicitly && (drive.stiffness > 0 || drive.damping > 0);
    link.slow_damping = link.slow_spring && implicit ? drive.damping : 0;
    if (!link.slow_spring || !implicit) {
      made.stiffness = drive.stiffness;
      made.damping = drive.damping;
    }
    tree.springs.drives[i] = made;
    // What a motor gives inside the stages does not know of the forces that hold loops: there all of it is the row's.
    if (drive.strength_limit > 0 && tree.loops.empty()) {
      made.motor_gain = kMotorStiffness * link.gain_unit / kMotorTime;
      made.motor_limit = drive.strength_limit;
    }
    put_joint_position(joint.is, joint.flipped, drive.rest, loads.rest.data() + body.q);
    drives = drives || drive.stiffness > 0 || drive.damping > 0 || drive.strength_limit > 0;
    if (implicit && link.slow_spring) tree.aimed = tree.driven = true;
    const bool forced = drive.force != JointVector::Zero();
    tree.driven = tree.driven || drive.damping > 0 || drive.strength_limit > 0 || forced;
    const bool moving = drive.strength_limit > 0 && (drive.double_strength != 0 || joint.is.kind == JointKind::Ball);
    tree.aimed = tree.aimed || moving || (forced && joint.is.kind == JointKind::Ball);
  }
  aim(tree);
  if (!drives && !tree.driven) loads.drives.clear();
  if (!tree.driven) loads.tau.resize(0);
}

void Dynamics::Core::aim(Tree& tree) const {
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    if (tree.links[i].joint == kNoJoint) continue;
    const JointEntry& joint = joints[tree.links[i].joint];
    const JointDrive& drive = joint.drive;
    const articulated::Body& body = tree.model.body(static_cast<int>(i));
    const double* q = tree.state.q.data() + body.q;
    if (tree.loads.tau.size() && (drive.force != JointVector::Zero() || tree.links[i].slow_spring)) {
      put_joint_force(joint.is, joint.flipped, q, drive.force, tree.set_tau.data() + body.v);
      const int count = axis_count(joint.is.kind);
      tree.loads.tau.segment(body.v, count) = tree.set_tau.segment(body.v, count);
      if (tree.links[i].slow_spring && tree.loads.drives[i].stiffness == 0 && tree.loads.drives[i].damping == 0) {
        const Vector3 way = joint_deflection(joint.is.kind, tree.loads.rest.data() + body.q, q);
        tree.loads.tau.segment(body.v, count) -=
            drive.stiffness * way.head(count) + drive.damping * tree.state.v.segment(body.v, count);
      }
    }
    if (!(drive.strength_limit > 0)) continue;
    JointVector speed = drive.motor_speed;
    if (drive.double_strength != 0) {
      const double at = joint_position(joint.is, joint.flipped, q)[0];
      const double bound =
          std::clamp(at, std::min(drive.double_min, drive.double_max), std::max(drive.double_min, drive.double_max));
      speed[0] += drive.double_strength * (bound - at);
    }
    put_joint_velocity(joint.is, joint.flipped, q, speed, tree.loads.motor_speed.data() + body.v);
  }
}

// --- at the stages --------------------------------------------------------------------------------------------------

Stage::Stage(Dynamics::Core& core, const ClusterEntry& cluster, MechanicsClient* client)
    : core_(core), cluster_(cluster), client_(client) {
  for (const std::uint32_t index : cluster.trees) {
    const Tree& tree = *core.trees[index];
    aims_ = aims_ || tree.aimed;
    pushed_ = pushed_ || tree.pushed;
    loops_ = loops_ || !tree.loops.empty();
    braces_ = braces_ || !tree.loose || tree.has_light();
  }
  asked_ = cluster.asked && client != nullptr;
  needed_ = aims_ || pushed_ || asked_ || loops_ || braces_ || !cluster.springs.empty();
  if (cluster.network) cluster.network->begin(core);
}

void Stage::aim() {
  if (!aims_) return;
  for (const std::uint32_t index : cluster_.trees)
    if (core_.trees[index]->aimed) core_.aim(*core_.trees[index]);
}

bool Stage::adds() const {
  if (pressed || pushed_ || asked_ || !cluster_.springs.empty()) return true;
  return braces_ && std::any_of(cluster_.trees.begin(), cluster_.trees.end(),
                                [this](std::uint32_t index) { return core_.trees[index]->braced; });
}

bool Stage::accelerate(const articulated::Vector& q, const articulated::Vector& v, articulated::Vector& a) {
  if (!cluster_.network || asked_ || pressed) return false;
  const SpringNetwork::Powers powers = cluster_.network->accelerate(core_, q, v, a);
  script_ = powers.script;
  drag_ = powers.drag;
  return true;
}

void Stage::add(double time) {
  script_ = drag_ = reaction_ = 0;
  if (!adds()) return;
  if (asked_) show();
  for (const std::uint32_t index : cluster_.trees) {
    Tree& tree = *core_.trees[index];
    for (int i = 0; i < tree.model.size(); ++i) {
      TreeLink& link = tree.links[static_cast<std::size_t>(i)];
      articulated::Wrench& wrench = tree.loads.wrenches[static_cast<std::size_t>(i)];
      wrench = {link.torque, link.force};
      if (asked_ && core_.find(link.body)->force_method)
        wrench.force += link.asked = client_->stage_force(link.body, time, core_.sub_step);
      if (wrench.force != Vector3::Zero() || wrench.couple != Vector3::Zero())
        script_ += wrench.force.dot(articulated::com_velocity(tree.model, tree.data, i)) +
                   wrench.couple.dot(articulated::spin(tree.data, i));
      if (tree.braced) {
        reaction_ += link.predicted.force.dot(articulated::com_velocity(tree.model, tree.data, i)) +
                     link.predicted.couple.dot(articulated::spin(tree.data, i));
        wrench.force += link.predicted.force;
        wrench.couple += link.predicted.couple;
      }
      if (!pressed) continue;
      wrench.force += link.pressed.force;
      wrench.couple += link.pressed.couple;
    }
  }
  if (asked_ && cluster_.network) cluster_.network->begin(core_);
  for (const SpringIndex spring : cluster_.springs) pull(core_.springs[spring]);
}

/// All links, also those that have no force method, into the arrays, where force methods see them.
void Stage::show() {
  for (const std::uint32_t index : cluster_.trees) core_.write_back(*core_.trees[index]);
}

Stage::End Stage::end_of(BodyIndex body, const Vector3& point) const {
  End end;
  const BodyEntry& known = *core_.find(body);
  if (known.tree == kNone) {
    const Pose at = core_.pose(body);
    end.point = at.location + at.orientation * point;
    end.velocity =
        core_.bodies->velocity(body) + core_.bodies->rotational_velocity(body).cross(end.point - at.location);
    return end;
  }
  end.tree = core_.trees[known.tree].get();
  end.link = known.link;
  const TreeLink& link = end.tree->links[static_cast<std::size_t>(known.link)];
  end.point =
      end.tree->data.motion_of(known.link).origin + end.tree->data.of(known.link).rotation * (point - link.origin);
  end.velocity = articulated::point_velocity(end.tree->data, known.link, end.point);
  return end;
}

void Stage::pull(SpringEntry& spring) {
  const End a = end_of(spring.is.a, spring.is.point_a), b = end_of(spring.is.b, spring.is.point_b);
  const SpringPull pull = pull_of(spring.is, b.point - a.point, b.velocity - a.velocity);
  spring.force = pull.force;
  drag_ += pull.loss;
  const Vector3 force = pull.force * pull.direction;
  for (const auto& [end, sign] : {std::pair{&a, 1.0}, std::pair{&b, -1.0}}) {
    if (!end->tree) continue;
    articulated::Wrench& wrench = end->tree->loads.wrenches[static_cast<std::size_t>(end->link)];
    const Vector3 arm = end->point - articulated::com_position(end->tree->model, end->tree->data, end->link);
    wrench.force += sign * force;
    wrench.couple += arm.cross(sign * force);
  }
}

}  // namespace breve
