// Natives of Joint and its five kinds: linking, driving, reading.
#include <algorithm>
#include <cmath>

#include "steve/library/motors.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

JointResource& resource(Machine& machine, Instance& self) { return resource_made<JointResource>(machine, self); }

/// What a setter does to a joint that is linked; otherwise nothing, which is said once for each selector.
template <class Change>
void change_drive(Machine& machine, Instance& self, std::string_view selector, Change change) {
  const JointIndex joint = joint_of(machine, self);
  if (joint == kNoJoint) {
    machine.warn_once("joint:" + std::string(selector), [&] {
      return std::string(selector) + ": " + name_of(self) + " is not linked; the call has no effect (link it first)";
    });
    return;
  }
  JointDrive drive = dynamics_of(machine).drive(joint);
  change(drive);
  drive_joint(machine, self, joint, drive);
}

/// The value of a linked joint, otherwise zero.
template <class Read>
auto read(Machine& machine, Instance& self, Read get) -> decltype(get(dynamics_of(machine), JointIndex{})) {
  const JointIndex joint = joint_of(machine, self);
  using Result = decltype(get(dynamics_of(machine), JointIndex{}));
  if (joint == kNoJoint) {
    if constexpr (std::is_same_v<Result, double>)
      return 0;
    else
      return Vector3::Zero();
  }
  return get(dynamics_of(machine), joint);
}

// --- linking --------------------------------------------------------------------------------------------------------

Instance* link(Machine& machine, Instance& self, const Vector3& normal, const Vector3& parent_point,
               const Vector3& child_point, Instance* child, Instance* parent, std::int32_t keep_rotation) {
  JointDescription description;
  description.normal = normal;
  description.parent_point = parent_point;
  description.child_point = child_point;
  description.relative_rotation = resource(machine, self).is.relative_rotation;
  description.keep_rotation = keep_rotation != 0;
  link_joint(machine, self, description, parent, child);
  return &self;
}

Instance* link_with_normal(Machine& machine, Instance& self, Vector3 normal, Vector3 parent_point, Vector3 child_point,
                           Instance* child, Instance* parent, std::int32_t keep_rotation) {
  return link(machine, self, normal, parent_point, child_point, child, parent, keep_rotation);
}

Instance* link_fixed(Machine& machine, Instance& self, Vector3 parent_point, Vector3 child_point, Instance* child,
                     Instance* parent, std::int32_t keep_rotation) {
  return link(machine, self, Vector3::UnitX(), parent_point, child_point, child, parent, keep_rotation);
}

Instance* link_ball(Machine& machine, Instance& self, Vector3 parent_point, Vector3 child_point, Instance* child,
                    Instance* parent, Vector3 normal, std::int32_t keep_rotation) {
  return link(machine, self, normal, parent_point, child_point, child, parent, keep_rotation);
}

void joint_break(Machine& machine, Instance& self) {
  const JointIndex joint = joint_of(machine, self);
  if (joint != kNoJoint) charge_for_break(machine, joint);
  break_joint(machine, self);
}
void joint_archive(Machine& machine, Instance& self) { prepare_joint(machine, self); }
void joint_dearchive(Machine& machine, Instance& self) { relink_joint(machine, self); }

std::int32_t joint_is_linked(Machine& machine, Instance& self) { return joint_of(machine, self) != kNoJoint; }

Instance* get_parent(Machine& machine, Instance& self) {
  return joint_of(machine, self) == kNoJoint ? nullptr : library_object(machine, self, "Joint", "parentObject");
}
Instance* get_child(Machine& machine, Instance& self) {
  return joint_of(machine, self) == kNoJoint ? nullptr : library_object(machine, self, "Joint", "childObject");
}

// --- where it is ----------------------------------------------------------------------------------------------------

/// Change the description, of a linked joint at once: its bodies are placed anew.
template <class Change>
void change_description(Machine& machine, Instance& self, Change change) {
  JointResource& own = resource(machine, self);
  const JointIndex joint = joint_of(machine, self);
  if (joint == kNoJoint) return change(own.is);
  JointDescription description = dynamics_of(machine).joint(joint);
  constexpr std::size_t kOfLink = 128;  // units of work: the assembly is built anew
  machine.charge(kOfLink * dynamics_of(machine).links_of(description.child).size());
  change(description);
  dynamics_of(machine).relink(joint, description);
  resource(machine, self).is = dynamics_of(machine).joint(joint);
}

/// The child of a linked joint is rotated there, even if it kept its rotation when it was linked.
void rest_at(Machine& machine, Instance& self, const Quaternion& rotation) {
  change_description(machine, self, [&](JointDescription& is) {
    is.relative_rotation = rotation;
    is.keep_rotation = false;
  });
}

void set_relative_rotation_matrix(Machine& machine, Instance& self, Matrix3 rotation) {
  if (!rotation.allFinite() || std::abs(rotation.determinant()) < 1e-6)
    throw Error(ErrorCode::Argument, "set-relative-rotation-matrix: this matrix is not a rotation");
  const Eigen::JacobiSVD<Matrix3> svd(rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3 nearest = svd.matrixU() * svd.matrixV().transpose();
  if (nearest.determinant() < 0)
    throw Error(ErrorCode::Argument, "set-relative-rotation-matrix: this matrix is a reflection, not a rotation");
  rest_at(machine, self, Quaternion(nearest));
}

void set_relative_rotation(Machine& machine, Instance& self, Vector3 axis, double radians) {
  finite(axis, "set-relative-rotation: the axis");
  finite(radians, "set-relative-rotation: the angle");
  const double length = axis.stableNorm();
  if (length == 0) return;
  rest_at(machine, self, Quaternion(Eigen::AngleAxisd(radians, axis / length)));
}

template <Vector3 JointDescription::*Member>
void set_part(Machine& machine, Instance& self, Vector3 value) {
  finite(value, Member == &JointDescription::normal ? "set-joint-normal: the normal" : "a link point");
  if (Member == &JointDescription::normal && value.isZero(0))
    throw Error(ErrorCode::Argument, "set-joint-normal: the normal is (0, 0, 0): it has no direction");
  change_description(machine, self, [&](JointDescription& is) { is.*Member = value; });
}

template <Vector3 JointDescription::*Member>
Vector3 get_part(Machine& machine, Instance& self) {
  const JointIndex joint = joint_of(machine, self);
  return joint == kNoJoint ? resource(machine, self).is.*Member : dynamics_of(machine).joint(joint).*Member;
}

void scale_part(Machine& machine, Instance& self, Instance* shape_owner, Vector3 JointDescription::*member) {
  if (!shape_owner) return;
  Instance* shape = library_object(machine, *shape_owner, "Real", "collisionShape");
  if (!shape) return;
  const Pin pin(machine, Value::of(Tag::Object, shape));  // the first method may free it
  const Value now = machine.call(*shape, "get-scale");
  const Value before = shape->live() ? machine.call(*shape, "get-last-scale") : Value();
  if (now.tag != Tag::Vector || before.tag != Tag::Vector || !self.live()) return;
  const Vector3 factors = now.vector().cwiseQuotient(before.vector());
  if (!factors.allFinite()) return;
  change_description(machine, self, [&](JointDescription& is) { is.*member = (is.*member).cwiseProduct(factors); });
}

void rescale_parent_link_point(Machine& machine, Instance& self) {
  scale_part(machine, self, library_object(machine, self, "Joint", "parentObject"), &JointDescription::parent_point);
}

void rescale_child_link_point(Machine& machine, Instance& self) {
  scale_part(machine, self, library_object(machine, self, "Joint", "childObject"), &JointDescription::child_point);
}

void softness_is_ignored(Machine& machine, Instance&, double value) {
  finite(value, "the softness of a joint");
  machine.warn_once("joint:softness",
                    "set-erp and set-cfm of a joint are ignored: joints are exact and their sides never drift apart");
}

// --- motors, springs, limits ----------------------------------------------------------------------------------------

void set_velocity(Machine& machine, Instance& self, double speed) {
  change_drive(machine, self, "set-joint-velocity", [&](JointDrive& d) { d.motor_speed = {speed, 0, 0}; });
}
void set_velocity_two(Machine& machine, Instance& self, double first, double second) {
  change_drive(machine, self, "set-joint-velocity", [&](JointDrive& d) { d.motor_speed = {first, second, 0}; });
}
void set_velocity_vector(Machine& machine, Instance& self, Vector3 speeds) {
  change_drive(machine, self, "set-joint-velocity", [&](JointDrive& d) { d.motor_speed = speeds; });
}

void set_force(Machine& machine, Instance& self, double force) {
  change_drive(machine, self, "set-joint-torque", [&](JointDrive& d) { d.force = {force, 0, 0}; });
}
void set_force_vector(Machine& machine, Instance& self, Vector3 forces) {
  change_drive(machine, self, "set-joint-torque-vector", [&](JointDrive& d) { d.force = forces; });
}

/// Clamped to 0 .. the hard limit; what is cut above is said once.
void set_strength_limit(Machine& machine, Instance& self, double limit) {
  finite(limit, "set-strength-limit: the limit");
  change_drive(machine, self, "set-strength-limit", [&](JointDrive& d) { d.strength_limit = std::max(0.0, limit); });
}

void set_damping(Machine& machine, Instance& self, double damping) {
  change_drive(machine, self, "set-joint-damping", [&](JointDrive& d) { d.damping = damping; });
}

void set_spring(Machine& machine, Instance& self, double stiffness, Vector3 rest) {
  change_drive(machine, self, "set-joint-spring", [&](JointDrive& d) {
    d.stiffness = stiffness;
    d.rest = rest;
  });
}

void set_limit_restitution(Machine& machine, Instance& self, double e) {
  change_drive(machine, self, "set-limit-restitution", [&](JointDrive& d) { d.limit_restitution = e; });
}

void set_double_spring(Machine& machine, Instance& self, double strength, double most, double least) {
  const JointIndex joint = joint_of(machine, self);
  if (joint == kNoJoint)
    throw Error(ErrorCode::Argument, "set-double-spring: " + name_of(self) + " is not linked (link it first)");
  const JointKind kind = dynamics_of(machine).joint(joint).kind;
  if (kind != JointKind::Revolute && kind != JointKind::Prismatic) {
    machine.warn_once("joint:double-spring",
                      "set-double-spring: only revolute and prismatic joints have a double spring");
    return;
  }
  change_drive(machine, self, "set-double-spring", [&](JointDrive& d) {
    d.double_strength = strength;
    d.double_max = most;
    d.double_min = least;
  });
}

/// Limits of the axes that the joint has, of a ball's middle axis no wider than it may be.
void set_limits(Machine& machine, Instance& self, const Vector3& low, const Vector3& high) {
  change_drive(machine, self, "set-joint-limits", [&](JointDrive& d) {
    const JointKind kind = dynamics_of(machine).joint(joint_of(machine, self)).kind;
    for (int i = 0; i < axis_count(kind); ++i) {
      d.low[i] = low[i];
      d.high[i] = high[i];
    }
    if (kind != JointKind::Ball) return;
    d.low[1] = std::clamp(d.low[1], -kBallMiddle, kBallMiddle);
    d.high[1] = std::clamp(d.high[1], -kBallMiddle, kBallMiddle);
  });
}

void set_limits_one(Machine& machine, Instance& self, double low, double high) {
  set_limits(machine, self, {low, 0, 0}, {high, 0, 0});
}
void set_limits_two(Machine& machine, Instance& self, double low_1, double high_1, double low_2, double high_2) {
  set_limits(machine, self, {low_1, low_2, 0}, {high_1, high_2, 0});
}
void set_limits_three(Machine& machine, Instance& self, double low_1, double high_1, double low_2, double high_2,
                      double low_3, double high_3) {
  set_limits(machine, self, {low_1, low_2, low_3}, {high_1, high_2, high_3});
}
void set_limit_vectors(Machine& machine, Instance& self, Vector3 low, Vector3 high) {
  set_limits(machine, self, low, high);
}

template <JointVector JointDrive::*Limit>
Vector3 get_limits(Machine& machine, Instance& self) {
  return read(machine, self, [](Mechanics& dynamics, JointIndex joint) {
    Vector3 limits = dynamics.drive(joint).*Limit;
    for (int i = axis_count(dynamics.joint(joint).kind); i < 3; ++i) limits[i] = 0;
    return limits;
  });
}

double get_strength_limit(Machine& machine, Instance& self) {
  return read(machine, self, [](Mechanics& d, JointIndex joint) { return d.drive(joint).strength_limit; });
}
double get_strength_hard_limit(Machine& machine, Instance& self) {
  return read(machine, self, [](Mechanics& d, JointIndex joint) { return d.strength_hard_limit(joint); });
}

// --- how it stands and moves ----------------------------------------------------------------------------------------

double get_position(Machine& machine, Instance& self) {
  return read(machine, self, [](Mechanics& d, JointIndex joint) { return d.position(joint)[0]; });
}
Vector3 get_positions(Machine& machine, Instance& self) {
  return read(machine, self, [](Mechanics& d, JointIndex joint) { return Vector3(d.position(joint)); });
}
double get_velocity(Machine& machine, Instance& self) {
  return read(machine, self, [](Mechanics& d, JointIndex joint) { return d.velocity(joint)[0]; });
}
Vector3 get_velocity_vector(Machine& machine, Instance& self) {
  return read(machine, self, [](Mechanics& d, JointIndex joint) { return Vector3(d.velocity(joint)); });
}
/// Forward dynamics of all links, and the dense equations of joints that close loops.
void charge_for_reaction(Machine& machine, const Mechanics& dynamics, BodyIndex body) {
  constexpr std::uint64_t kOfLink = 64, kRows = 6, kOperations = 64;  // units; of a closed loop; of a unit
  const std::uint64_t links = dynamics.links_of(body).size(), joints = dynamics.joints_of(body).size();
  const std::uint64_t rows = kRows * (joints >= links ? joints - links + 1 : 0);
  machine.charge(kOfLink * links + rows * rows * (rows + kRows * links) / kOperations);
}

Vector3 reaction(Machine& machine, Instance& self, Vector3 JointReaction::*part) {
  return read(machine, self, [&machine, part](Mechanics& dynamics, JointIndex joint) -> Vector3 {
    charge_for_reaction(machine, dynamics, dynamics.joint(joint).child);
    return dynamics.reaction(joint).*part;
  });
}

Vector3 get_reaction_force(Machine& machine, Instance& self) { return reaction(machine, self, &JointReaction::force); }
Vector3 get_reaction_torque(Machine& machine, Instance& self) {
  return reaction(machine, self, &JointReaction::torque);
}

constexpr Native kJointNatives[] = {
    native<link_with_normal>("joint.link-with-normal"),
    native<link_fixed>("joint.link-fixed"),
    native<link_ball>("joint.link-ball"),
    native<joint_break>("joint.break-joint"),
    native<joint_archive>("joint.archive"),
    native<joint_dearchive>("joint.dearchive"),
    native<joint_is_linked>("joint.is-linked"),
    native<get_parent>("joint.get-parent"),
    native<get_child>("joint.get-child"),
    native<set_relative_rotation_matrix>("joint.set-relative-rotation-matrix"),
    native<set_relative_rotation>("joint.set-relative-rotation"),
    native<set_part<&JointDescription::parent_point>>("joint.set-parent-link-point"),
    native<set_part<&JointDescription::child_point>>("joint.set-child-link-point"),
    native<set_part<&JointDescription::normal>>("joint.set-joint-normal"),
    native<get_part<&JointDescription::parent_point>>("joint.get-parent-link-point"),
    native<get_part<&JointDescription::child_point>>("joint.get-child-link-point"),
    native<get_part<&JointDescription::normal>>("joint.get-joint-normal"),
    native<rescale_parent_link_point>("joint.rescale-parent-link-point"),
    native<rescale_child_link_point>("joint.rescale-child-link-point"),
    native<softness_is_ignored>("joint.set-softness"),
    native<set_velocity>("joint.set-joint-velocity"),
    native<set_velocity_two>("universal-joint.set-joint-velocity"),
    native<set_velocity_vector>("ball-joint.set-joint-velocity"),
    native<set_force>("joint.set-joint-torque"),
    native<set_force_vector>("joint.set-joint-torque-vector"),
    native<set_strength_limit>("joint.set-strength-limit"),
    native<set_damping>("joint.set-joint-damping"),
    native<set_spring>("joint.set-joint-spring"),
    native<set_limit_restitution>("joint.set-limit-restitution"),
    native<set_double_spring>("joint.set-double-spring"),
    native<set_limits_one>("joint.set-joint-limits"),
    native<set_limits_two>("universal-joint.set-joint-limits"),
    native<set_limits_three>("ball-joint.set-joint-limits"),
    native<set_limit_vectors>("joint.set-joint-limit-vectors"),
    native<get_limits<&JointDrive::high>>("joint.get-max-joint-limit-vector"),
    native<get_limits<&JointDrive::low>>("joint.get-min-joint-limit-vector"),
    native<get_strength_limit>("joint.get-strength-limit"),
    native<get_strength_hard_limit>("joint.get-strength-hard-limit"),
    native<get_position>("joint.get-joint-position"),
    native<get_positions>("joint.get-joint-angles"),
    native<get_velocity>("joint.get-joint-velocity"),
    native<get_velocity_vector>("joint.get-joint-velocity-vector"),
    native<get_reaction_force>("joint.get-force"),
    native<get_reaction_torque>("joint.get-torque"),
};

}  // namespace

std::span<const Native> joint_natives() { return kJointNatives; }

}  // namespace breve::steve
