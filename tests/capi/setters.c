/* A setter takes all of its input, or nothing of it: each one that takes more than a number gets input of which one
   part is good and another one is not. The world is as before, in space and in a plane. */
#include <math.h>

#include "bodies.h"

/* What the setters are called with. */
typedef struct stage {
  scene s;
  breve_object body, link, other, joint, spring;
} stage;

static bool open_stage(stage* t, bool flat) {
  memset(t, 0, sizeof *t);
  if (!open_bodies(&t->s, flat)) return false;
  const breve_geometry ball = ball_of_radius(1);
  t->body = add_body(&t->s, "Mobile", &ball, 0, 5, 0);
  t->link = add_body(&t->s, "Link", &ball, 3, 0, 0);
  t->other = add_body(&t->s, "Link", &ball, 6, 0, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(t->s.world, t->body, true));
  breve_joint_description joint = breve_joint_description_default(BREVE_JOINT_REVOLUTE);
  joint.parent = t->link;
  joint.child = t->other;
  joint.normal[0] = 0, joint.normal[2] = 1;
  joint.parent_point[0] = 1, joint.child_point[0] = -2;
  breve_spring spring = breve_spring_default();
  spring.from = t->body;
  spring.to = t->link;
  return CHECK_STATUS(BREVE_OK, breve_joint_create(t->s.world, &joint, &t->joint)) &&
         CHECK_STATUS(BREVE_OK, breve_spring_create(t->s.world, &spring, &t->spring));
}

static const double good[3] = {1, 2, 0}, bad[3] = {1, 2, NAN};
static const breve_pose bad_rotation = {{7, 8, 0}, {NAN, 0, 0, 1}}, bad_location = {{7, NAN, 0}, {0, 0, 0, 1}};

static breve_status set_pose(stage* t) { return breve_object_set_pose(t->s.world, t->body, &bad_rotation); }
static breve_status set_location(stage* t) { return breve_object_set_pose(t->s.world, t->body, &bad_location); }
static breve_status set_target(stage* t) { return breve_object_set_target(t->s.world, t->body, &bad_rotation); }
static breve_status set_assembly(stage* t) {
  return breve_object_set_assembly_pose(t->s.world, t->link, &bad_rotation);
}
static breve_status set_velocity(stage* t) { return breve_object_set_velocity(t->s.world, t->body, bad); }
static breve_status set_spin(stage* t) { return breve_object_set_rotational_velocity(t->s.world, t->body, bad); }
static breve_status set_force(stage* t) { return breve_object_set_force(t->s.world, t->body, bad, good); }
static breve_status set_torque(stage* t) { return breve_object_set_force(t->s.world, t->body, good, bad); }
static breve_status set_gravity(stage* t) { return breve_world_set_gravity(t->s.world, bad); }
static breve_status set_state(stage* t) { return breve_joint_set_state(t->s.world, t->joint, good, bad); }
static breve_status set_space(stage* t) { return breve_world_set_space(t->s.world, 0, BREVE_EDGE_WRAP, 10, NAN); }

static breve_status set_color(stage* t) {
  const double rgba[4] = {0.5, 0.25, 0.125, NAN};
  return breve_object_set_color(t->s.world, t->body, rgba);
}

static breve_status set_material(stage* t) {
  const breve_material material = {0.125, 0.25, 0.75, 0.5, NAN};
  return breve_object_set_material(t->s.world, t->body, &material);
}

static breve_status set_drive(stage* t) {
  breve_drive drive = breve_drive_default();
  CHECK_STATUS(BREVE_OK, breve_joint_drive(t->s.world, t->joint, &drive));
  drive.motor_speed[0] = 3;
  drive.strength_limit = 2;
  drive.limit_restitution = 2;
  return breve_joint_set_drive(t->s.world, t->joint, &drive);
}

static breve_status set_spring(stage* t) {
  breve_spring spring = breve_spring_default();
  CHECK_STATUS(BREVE_OK, breve_spring_description(t->s.world, t->spring, &spring));
  spring.strength = 7;
  spring.maximum_force = -1;
  return breve_spring_set_description(t->s.world, t->spring, &spring);
}

static breve_accuracy half_wrong_accuracy(void) {
  breve_accuracy accuracy = breve_accuracy_default();
  CHECK_STATUS(BREVE_OK, breve_rung_accuracy(BREVE_RUNG_PRECISE, &accuracy));
  accuracy.tolerance = NAN;
  return accuracy;
}

static breve_status set_accuracy(stage* t) {
  const breve_accuracy accuracy = half_wrong_accuracy();
  return breve_world_set_accuracy(t->s.world, &accuracy);
}

static breve_status set_own_accuracy(stage* t) {
  const breve_accuracy accuracy = half_wrong_accuracy();
  return breve_object_set_accuracy(t->s.world, t->body, &accuracy);
}

static breve_status set_filter(stage* t) {
  breve_collision_filter filter = breve_collision_filter_default();
  filter.category = 4;
  filter.one_way[1] = NAN;
  return breve_object_set_collision_filter(t->s.world, t->body, &filter);
}

static breve_status set_property(stage* t) {
  const breve_object both[2] = {t->body, t->link};
  double velocities[6] = {1, 2, 0, 4, NAN, 0};
  const breve_array array = {velocities, 0, BREVE_NUMBER_DOUBLE, 3};
  return breve_objects_set_property(t->s.world, both, 2, BREVE_PROPERTY_VELOCITY, &array);
}

/* setters.cmake looks whether all of them are here. */
static const struct {
  const char* name;
  breve_status (*set)(stage* t);
} setters[] = {
    {"breve_object_set_pose", set_pose},
    {"breve_object_set_pose", set_location},
    {"breve_object_set_target", set_target},
    {"breve_object_set_assembly_pose", set_assembly},
    {"breve_object_set_velocity", set_velocity},
    {"breve_object_set_rotational_velocity", set_spin},
    {"breve_object_set_force", set_force},
    {"breve_object_set_force", set_torque},
    {"breve_object_set_color", set_color},
    {"breve_object_set_material", set_material},
    {"breve_object_set_accuracy", set_own_accuracy},
    {"breve_object_set_collision_filter", set_filter},
    {"breve_objects_set_property", set_property},
    {"breve_joint_set_drive", set_drive},
    {"breve_joint_set_state", set_state},
    {"breve_spring_set_description", set_spring},
    {"breve_world_set_accuracy", set_accuracy},
    {"breve_world_set_gravity", set_gravity},
    {"breve_world_set_space", set_space},
};

static void check_setters(bool flat) {
  stage t;
  if (open_stage(&t, flat)) {
    for (size_t i = 0; i < sizeof setters / sizeof *setters; ++i) {
      const uint64_t before = hash_of_world(&t.s);
      const bool refused = setters[i].set(&t) == BREVE_ERROR_ARGUMENT, kept = hash_of_world(&t.s) == before;
      if (!CHECK(refused && kept)) printf("  %s: refused %d, kept %d\n", setters[i].name, refused, kept);
    }
    CHECK_STATUS(BREVE_OK, breve_world_step(t.s.world));
  }
  scene_close(&t.s);
}

static void input_that_is_half_wrong_changes_nothing_in_space(void) { check_setters(false); }
static void input_that_is_half_wrong_changes_nothing_in_a_plane(void) { check_setters(true); }

void setters_suite(void) {
  RUN(input_that_is_half_wrong_changes_nothing_in_space);
  RUN(input_that_is_half_wrong_changes_nothing_in_a_plane);
}
