// Joints and springs from C: objects of the class library, made, driven and read without a script.
#include <cmath>

#include "physical.hpp"
#include "steve/library/motors.hpp"

namespace breve::host {
namespace {

using steve::Instance;

constexpr const char* kClasses[] = {"RevoluteJoint", "PrismaticJoint", "FixedJoint", "UniversalJoint", "BallJoint"};

const char* class_of_kind(std::uint32_t kind) {
  const auto number = static_cast<std::size_t>(kind);
  if (number >= std::size(kClasses))
    fail(BREVE_ERROR_ARGUMENT, "breve_joint_description.kind is not a breve_joint_kind: " + std::to_string(number));
  return kClasses[number];
}

Instance* object_or_world(const breve_world& world, breve_object object) {
  return is_null(object) ? nullptr : &live_instance(world, object);
}

/// Two objects that stay what they are while another one is made: that runs script, which may free them.
class Kept {
 public:
  Kept(breve_world& world, Instance* one, Instance* other)
      : one_(*world.machine, steve::Value::of(steve::Tag::Object, one)),
        other_(*world.machine, steve::Value::of(steve::Tag::Object, other)) {}

 private:
  steve::Pin one_, other_;
};

/// The joint behind an object that must be a linked one.
JointIndex linked(const breve_world& world, breve_object joint) {
  const Instance& object = object_of_kind(world, joint, "Joint");
  const JointIndex index = steve::joint_of(*world.machine, object);
  if (index == kNoJoint) fail(BREVE_ERROR_ARGUMENT, "the joint is not linked");
  return index;
}

JointDescription description_of(const breve_joint_description& from) {
  JointDescription to;
  to.kind = static_cast<JointKind>(from.kind);
  to.keep_rotation = from.keep_rotation;
  to.parent_point = vector_of(from.parent_point, "parent_point");
  to.child_point = vector_of(from.child_point, "child_point");
  to.relative_rotation = rotation_of(from.rotation, "rotation");
  if (to.kind != JointKind::Fixed) to.normal = vector_of(from.normal, "normal");
  if (to.kind == JointKind::Universal || to.kind == JointKind::Ball)
    to.other_axis = vector_of(from.other_axis, "other_axis");
  // Before an object is made: a refused call is to leave no trace.
  if (!(to.normal.stableNorm() > 0)) fail(BREVE_ERROR_ARGUMENT, "the normal of the joint has no direction");
  if (!is_null(from.child) && from.parent.index == from.child.index && from.parent.generation == from.child.generation)
    fail(BREVE_ERROR_ARGUMENT, "parent and child of the joint are the same body");
  for (const bool reserved : from.reserved)
    if (reserved) fail(BREVE_ERROR_ARGUMENT, "a reserved field is not false");
  return to;
}

JointDrive drive_of(const breve_drive& from) {
  JointDrive to;
  to.motor_speed = vector_of(from.motor_speed, "motor_speed");
  to.strength_limit = from.strength_limit;
  to.double_strength = from.double_strength;
  to.double_max = from.double_max;
  to.double_min = from.double_min;
  to.damping = from.damping;
  to.stiffness = from.stiffness;
  to.rest = vector_of(from.rest, "rest");
  to.force = vector_of(from.force, "force");
  to.low = Vector3(from.low[0], from.low[1], from.low[2]);
  to.high = Vector3(from.high[0], from.high[1], from.high[2]);
  to.limit_restitution = from.limit_restitution;
  const double alone[] = {from.strength_limit, from.double_strength, from.double_max,       from.double_min,
                          from.damping,        from.stiffness,       from.limit_restitution};
  need_finite(alone, std::size(alone), "a number of breve_drive");
  return to;
}

breve_drive drive_from(const JointDrive& from) {
  breve_drive to{};
  to.struct_size = sizeof to;
  copy_to(to.motor_speed, from.motor_speed);
  to.strength_limit = from.strength_limit;
  to.double_strength = from.double_strength;
  to.double_max = from.double_max;
  to.double_min = from.double_min;
  to.damping = from.damping;
  to.stiffness = from.stiffness;
  copy_to(to.rest, from.rest);
  copy_to(to.force, from.force);
  copy_to(to.low, from.low);
  copy_to(to.high, from.high);
  to.limit_restitution = from.limit_restitution;
  return to;
}

breve_spring spring_from(const SpringDescription& from) {
  breve_spring to = breve_spring_default();
  copy_to(to.from_point, from.point_a);
  copy_to(to.to_point, from.point_b);
  to.mode = static_cast<breve_spring_mode>(from.mode);
  to.length = from.length;
  to.strength = from.strength;
  to.damping = from.damping;
  to.maximum_force = from.maximum_force;
  return to;
}

SpringDescription spring_of(const breve_spring& from) {
  constexpr unsigned kModes = 3;
  if (static_cast<unsigned>(from.mode) >= kModes)
    fail(BREVE_ERROR_ARGUMENT, "breve_spring.mode is not a breve_spring_mode");
  if (from.reserved != 0) fail(BREVE_ERROR_ARGUMENT, "a reserved field is not 0");
  SpringDescription to;
  to.point_a = vector_of(from.from_point, "from_point");
  to.point_b = vector_of(from.to_point, "to_point");
  to.length = from.length;
  to.strength = from.strength;
  to.damping = from.damping;
  to.maximum_force = from.maximum_force;
  for (const double number : {to.length, to.strength, to.damping, to.maximum_force})
    if (!(std::isfinite(number) && number >= 0))
      fail(BREVE_ERROR_ARGUMENT, "the numbers of a breve_spring must be finite and >= 0");
  to.mode = static_cast<SpringMode>(from.mode);
  return to;
}

}  // namespace
}  // namespace breve::host

using namespace breve::host;
using breve::JointIndex;
using breve::Mechanics;

breve_status breve_joint_create(breve_world* world, const breve_joint_description* description, breve_object* joint) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(description, "description");
    need(joint, "joint");
    const auto given =
        read_config(description, breve_joint_description_default(BREVE_JOINT_REVOLUTE), "breve_joint_description");
    const char* cls = class_of_kind(given.kind);
    const auto is = description_of(given);
    auto* parent = object_or_world(*world, given.parent);
    auto& child = live_instance(*world, given.child);
    if (parent) live_body(*world, given.parent);
    live_body(*world, given.child);
    const Kept kept(*world, parent, &child);
    *joint = make_with(*world, cls, [&](breve::steve::Instance& object) {
      breve::steve::link_joint(*world->machine, object, is, parent, &child);
    });
  });
}

breve_status breve_joint_break(breve_world* world, breve_object joint) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error,
               [&] { breve::steve::break_joint(*world->machine, object_of_kind(*world, joint, "Joint")); });
}

breve_status breve_joint_state(const breve_world* world, breve_object joint, breve_joint_info* info) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(info, "info");
    const auto& object = object_of_kind(*world, joint, "Joint");
    const JointIndex index = breve::steve::joint_of(*world->machine, object);
    breve_joint_info found{};
    found.kind = static_cast<breve_joint_kind>(breve::steve::joint_kind(object));
    found.linked = index != breve::kNoJoint;
    if (found.linked) {
      const Mechanics& dynamics = world->world->mechanics();
      const auto& is = dynamics.joint(index);
      const auto owner = [&](breve::BodyIndex body) {
        return body == breve::kNoBody ? breve_object{} : handle_of(*world, world->world->bodies().owner(body));
      };
      found.loop = dynamics.closes_loop(index);
      found.parent = owner(is.parent);
      found.child = owner(is.child);
      copy_to(found.position, dynamics.position(index));
      copy_to(found.velocity, dynamics.velocity(index));
      const auto reaction = dynamics.reaction(index);
      copy_to(found.force, reaction.force);
      copy_to(found.torque, reaction.torque);
      found.hard_limit = dynamics.strength_hard_limit(index);
    }
    *info = found;
  });
}

breve_status breve_joint_drive(const breve_world* world, breve_object joint, breve_drive* drive) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(drive, "drive");
    write_struct(drive, drive_from(world->world->mechanics().drive(linked(*world, joint))), "breve_drive");
  });
}

breve_status breve_joint_set_drive(breve_world* world, breve_object joint, const breve_drive* drive) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(drive, "drive");
    const JointIndex index = linked(*world, joint);
    Mechanics& dynamics = world->world->mechanics();
    // What an older header does not have stays as it is.
    breve::steve::drive_joint(*world->machine, object_of_kind(*world, joint, "Joint"), index,
                              drive_of(read_config(drive, drive_from(dynamics.drive(index)), "breve_drive")));
  });
}

breve_status breve_joint_set_state(breve_world* world, breve_object joint, const double position[3],
                                   const double velocity[3]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const JointIndex index = linked(*world, joint);
    if (position) vector_of(position, "position");
    if (velocity) vector_of(velocity, "velocity");
    world->machine->refuse_in_stage("move a body");
    if (position) world->world->mechanics().set_position(index, vector_of(position, "position"));
    if (velocity) world->world->mechanics().set_velocity(index, vector_of(velocity, "velocity"));
  });
}

// --- springs --------------------------------------------------------------------------------------------------------

breve_status breve_spring_create(breve_world* world, const breve_spring* description, breve_object* spring) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(description, "description");
    need(spring, "spring");
    const auto given = read_config(description, breve_spring_default(), "breve_spring");
    const auto is = spring_of(given);
    if (live_body(*world, given.from) == live_body(*world, given.to))
      fail(BREVE_ERROR_ARGUMENT, "both ends of the spring are the same body");
    auto& from = live_instance(*world, given.from);
    auto& to = live_instance(*world, given.to);
    const Kept kept(*world, &from, &to);
    *spring = make_with(*world, "Spring", [&](breve::steve::Instance& object) {
      breve::steve::connect_spring(*world->machine, object, is, &from, &to);
    });
  });
}

breve_status breve_spring_set_description(breve_world* world, breve_object spring, const breve_spring* description) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(description, "description");
    auto& object = object_of_kind(*world, spring, "Spring");
    auto& resource = breve::steve::resource_made<breve::steve::SpringResource>(*world->machine, object);
    const auto given = read_config(description, spring_from(resource.is), "breve_spring");
    auto changed = spring_of(given);
    changed.point_a = resource.is.point_a;
    changed.point_b = resource.is.point_b;
    breve::steve::change_spring(*world->machine, object, changed);
  });
}

breve_status breve_spring_state(const breve_world* world, breve_object spring, double* length, double* force) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    auto& object = object_of_kind(*world, spring, "Spring");
    const breve::SpringIndex index = breve::steve::spring_of(*world->machine, object);
    const Mechanics& dynamics = world->world->mechanics();
    if (length) *length = index == breve::kNoSpring ? 0 : dynamics.spring_length(index);
    if (force) *force = index == breve::kNoSpring ? 0 : dynamics.spring_force(index);
  });
}

breve_status breve_spring_description(const breve_world* world, breve_object spring, breve_spring* description) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    auto& object = object_of_kind(*world, spring, "Spring");
    const auto* found = breve::steve::resource_of<breve::steve::SpringResource>(*world->machine, &object);
    breve_spring to = found ? spring_from(found->is) : breve_spring_default();
    const breve::SpringIndex index = found ? breve::steve::spring_of(*world->machine, object) : breve::kNoSpring;
    if (index != breve::kNoSpring) {
      const breve::World& w = *world->world;
      const breve::SpringDescription& ends = w.mechanics().spring(index);
      to.from = handle_of(*world, w.bodies().owner(ends.a));
      to.to = handle_of(*world, w.bodies().owner(ends.b));
    }
    write_struct(description, to, "breve_spring");
  });
}
