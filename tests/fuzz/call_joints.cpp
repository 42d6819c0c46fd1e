// Calls of joints, springs, and what they connect.
#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_joints {

breve_status joint_create(Caller& c) {
  breve_world* world = c.world();
  auto description = breve_joint_description_default(static_cast<breve_joint_kind>(c.choose().below(6)));
  description.parent = c.chance(30) ? breve_object{0, 0} : c.object_or_null(world, "Real");
  description.child = c.object(world, "Real");
  for (double& x : description.parent_point) x = c.finite();
  for (double& x : description.child_point) x = c.finite();
  description.keep_rotation = c.chance(50);
  switch (c.choose().below(12)) {
    case 0: c.choose().one_of(description.parent_point) = c.number(); break;
    case 1: c.choose().one_of(description.normal) = c.number(); break;
    case 2: c.choose().one_of(description.rotation) = c.number(); break;
    case 3: c.choose().one_of(description.other_axis) = c.number(); break;
    case 4: description.normal[0] = 0, description.rotation[0] = 0; break;
    case 5: description.reserved[1] = true, c.expect_refusal(); break;
    case 6: description.struct_size = c.struct_size(sizeof description); break;
    default: break;
  }
  const bool null = c.chance(3);
  if (null) c.expect_refusal();
  Out<breve_object> made(c);
  const breve_status status = made.after(breve_joint_create(world, null ? nullptr : &description, made.to()));
  if (made) c.keep(*made);
  return status;
}
breve_status joint_break(Caller& c) {
  breve_world* world = c.world();
  return breve_joint_break(world, c.object(world, "Joint"));
}
breve_status joint_read(Caller& c) {
  breve_world* world = c.world();
  const breve_object joint = c.object(world, "Joint");
  Out<breve_joint_info> info(c);
  return info.after(breve_joint_state(world, joint, info.to()));
}
breve_status joint_get_drive(Caller& c) {
  const breve_world* world = c.world();
  const breve_object joint = c.object(world, "Joint");
  Out<breve_drive> drive(c);
  drive.set_size(c.struct_size(sizeof(breve_drive)));
  return drive.after(breve_joint_drive(world, joint, drive.to()));
}
breve_status joint_set_drive(Caller& c) {
  breve_world* world = c.world();
  const breve_object joint = c.object(world, "Joint");
  breve_drive drive{};
  drive.struct_size = sizeof drive;
  breve_joint_drive(world, joint, &drive);
  double* const numbers[] = {drive.motor_speed,
                             &drive.strength_limit,
                             &drive.double_strength,
                             &drive.double_min,
                             &drive.double_max,
                             &drive.damping,
                             &drive.stiffness,
                             drive.rest,
                             drive.force,
                             drive.low,
                             drive.high,
                             &drive.limit_restitution};
  for (std::size_t i = 0; i < 2; ++i) {
    double* number = c.choose().one_of(numbers);
    *number = c.chance(70) ? c.finite() : c.number();
  }
  drive.struct_size = c.struct_size(drive.struct_size);
  const bool null = c.chance(3);
  if (null) c.expect_refusal();
  return breve_joint_set_drive(world, joint, null ? nullptr : &drive);
}
breve_status joint_place(Caller& c) {
  breve_world* world = c.world();
  const breve_object joint = c.object(world, "Joint");
  double position[3], velocity[3];
  const double* where = c.numbers(position, true);
  return breve_joint_set_state(world, joint, where, c.numbers(velocity, true));
}

/// A function that gives the bodies or joints that hang together.
template <auto kGet>
breve_status connected(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Link");
  Room<breve_object> room(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status = count.after(kGet(world, object, room.to(), room.capacity(), count.to()));
  room.after(status, count ? *count : 0);
  for (const breve_object found : room.written()) {
    require(breve_object_alive(world, found), "what hangs on a body is gone");
    c.keep(found);
  }
  return status;
}
breve_status object_set_self_collisions(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Link");
  return breve_object_set_self_collisions(world, object, c.chance(50));
}

// --- springs ---------------------------------------------------------------------------------------------------------

breve_spring draw_spring(Caller& c) {
  breve_spring spring = breve_spring_default();
  spring.mode = static_cast<breve_spring_mode>(c.choose().below(4));
  switch (c.choose().below(10)) {
    case 0: spring.length = c.number(); break;
    case 1: spring.strength = c.number(); break;
    case 2: spring.damping = c.number(); break;
    case 3: spring.maximum_force = c.number(); break;
    case 4: spring.reserved = 1, c.expect_refusal(); break;
    case 5: spring.struct_size = c.struct_size(sizeof spring); break;
    default: break;
  }
  return spring;
}
breve_status spring_create(Caller& c) {
  breve_world* world = c.world();
  breve_spring spring = draw_spring(c);
  spring.from = c.object(world, "Real");
  spring.to = c.object(world, "Real");
  for (double& x : spring.from_point) x = c.chance(97) ? c.finite() : c.number();
  const bool null = c.chance(3);
  if (null) c.expect_refusal();
  Out<breve_object> made(c);
  const breve_status status = made.after(breve_spring_create(world, null ? nullptr : &spring, made.to()));
  if (made) c.keep(*made);
  return status;
}
breve_status spring_set(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Spring");
  const breve_spring spring = draw_spring(c);
  const bool null = c.chance(3);
  if (null) c.expect_refusal();
  return breve_spring_set_description(world, object, null ? nullptr : &spring);
}
breve_status spring_read(Caller& c) {
  const breve_world* world = c.world();
  const breve_object spring = c.object(world, "Spring");
  Out<double> length(c, true);
  Out<double> force(c, true);
  const breve_status status = length.after(breve_spring_state(world, spring, length.to(), force.to()));
  return force.after(status);
}

constexpr Statuses kJoint = kScriptError | kStale | kType;

constexpr Function kFunctions[] = {
    {"breve_joint_create", joint_create, kScript | kBody | kNotFound, 3},
    {"breve_joint_break", joint_break, kJoint | kScriptError},
    {"breve_joint_state", joint_read, kJoint},
    {"breve_joint_drive", joint_get_drive, kJoint},
    {"breve_joint_set_drive", joint_set_drive, kJoint | kScriptError, 2},
    {"breve_joint_set_state", joint_place, kJoint | kScriptError},
    {"breve_object_links", connected<breve_object_links>, kBody},
    {"breve_object_joints", connected<breve_object_joints>, kBody},
    {"breve_object_set_self_collisions", object_set_self_collisions, kBody},
    {"breve_spring_create", spring_create, kScript | kBody | kNotFound, 2},
    {"breve_spring_set_description", spring_set, kJoint},
    {"breve_spring_state", spring_read, kJoint},
};

}  // namespace call_joints

std::span<const Function> joint_functions() { return call_joints::kFunctions; }

}  // namespace breve::fuzz
