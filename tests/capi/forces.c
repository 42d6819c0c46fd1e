/* Pushes: forces of one iteration, impulses, at points, waking, and platforms that reach a target. */
#include <math.h>

#include "bodies.h"

static breve_object floating(scene* s, const breve_geometry* geometry) {
  const double none[3] = {0, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_world_set_gravity(s->world, none));
  const breve_object body = add_body(s, "Mobile", geometry, 0, 0, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s->world, body, true));
  return body;
}

static void moves(scene* s, breve_object body, double vx, double vy, double wz) {
  double v[3], w[3];
  CHECK_STATUS(BREVE_OK, breve_object_velocity(s->world, body, v));
  CHECK_STATUS(BREVE_OK, breve_object_rotational_velocity(s->world, body, w));
  CHECK_NEAR(vx, v[0], 1e-6);
  CHECK_NEAR(vy, v[1], 1e-6);
  CHECK_NEAR(wz, w[2], 1e-6);
}

static void an_impulse_changes_velocity_at_once(bool flat) {
  scene s;
  if (!open_bodies(&s, flat)) return;
  breve_geometry box = box_of_size(2, 1, 1);
  box.density = 2; /* mass 4, moment about z 4 (4 + 1) / 12 */
  const breve_object body = floating(&s, &box);
  const double push[3] = {8, 0, 0}, side[3] = {0, 3, 0}, end[3] = {1, 0, 0};
  double mass = 0;
  CHECK_STATUS(BREVE_OK, breve_object_mass(s.world, body, &mass));
  CHECK_STATUS(BREVE_OK, breve_object_add_impulse(s.world, body, push, NULL));
  moves(&s, body, 8 / mass, 0, 0);
  CHECK_STATUS(BREVE_OK, breve_object_add_impulse(s.world, body, side, end));
  moves(&s, body, 8 / mass, 3 / mass, 3 / (mass * 5 / 12));
  step_times(&s, 1);
  moves(&s, body, 8 / mass, 3 / mass, 3 / (mass * 5 / 12));
  scene_close(&s);
}
static void impulses_change_velocity_at_once(void) {
  an_impulse_changes_velocity_at_once(false), an_impulse_changes_velocity_at_once(true);
}

static void a_force_acts_for_one_iteration(bool flat) {
  scene s;
  if (!open_bodies(&s, flat)) return;
  const breve_geometry box = box_of_size(2, 1, 1);
  const breve_object body = floating(&s, &box);
  const double push[3] = {4, 0, 0}, torque[3] = {0, 0, 1}, steady[3] = {0, 2, 0}, end[3] = {0, 0.5, 0};
  double mass = 0;
  CHECK_STATUS(BREVE_OK, breve_object_mass(s.world, body, &mass));
  const double h = breve_world_iteration_step(s.world), moment = mass * 5 / 12;
  CHECK_STATUS(BREVE_OK, breve_object_set_force(s.world, body, steady, NULL));
  CHECK_STATUS(BREVE_OK, breve_object_add_force(s.world, body, push, NULL, NULL));
  CHECK_STATUS(BREVE_OK, breve_object_add_force(s.world, body, push, torque, NULL));
  moves(&s, body, 0, 0, 0);
  /* Forces that have not acted yet are in images. */
  static char image[1 << 20];
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, sizeof image, &size));
  for (int i = 0; i < 2; ++i) {
    CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
    step_times(&s, 1);
    moves(&s, body, 8 * h / mass, 2 * h / mass, h / moment);
    step_times(&s, 1);
    moves(&s, body, 8 * h / mass, 4 * h / mass, h / moment);
  }
  /* At a point. */
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  step_times(&s, 1);
  put_at(&s, body, 0, 0, 0);
  rotate_about_z(&s, body, 0);
  CHECK_STATUS(BREVE_OK, breve_object_add_force(s.world, body, push, NULL, end));
  step_times(&s, 1);
  moves(&s, body, 12 * h / mass, 4 * h / mass, (1 - 2) * h / moment);
  scene_close(&s);
}
static void forces_act_for_one_iteration(void) {
  a_force_acts_for_one_iteration(false), a_force_acts_for_one_iteration(true);
}

static void a_pushed_joint_answers_with_both_bodies(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry box = box_of_size(1, 1, 1);
  const breve_object one = floating(&s, &box), two = add_body(&s, "Link", &box, 2, 0, 0);
  breve_joint_description d = breve_joint_description_default(BREVE_JOINT_FIXED);
  breve_object joint;
  d.parent = one;
  d.child = two;
  d.parent_point[0] = 1;
  d.child_point[0] = -1;
  CHECK_STATUS(BREVE_OK, breve_joint_create(s.world, &d, &joint));
  const double push[3] = {6, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_add_impulse(s.world, two, push, NULL));
  step_times(&s, 1);
  moves(&s, one, 3, 0, 0); /* two bodies of mass 1 */
  moves(&s, two, 3, 0, 0);
  scene_close(&s);
}

/* Where a body stands on the platform: the slab is 1 high, and so is the box. */
static double lag(scene* s, breve_object platform, breve_object body) {
  return pose_of(s, body).location[0] - pose_of(s, platform).location[0];
}

static bool is_moving(scene* s, breve_object platform, breve_pose* target) {
  bool moves = false;
  CHECK_STATUS(BREVE_OK, breve_object_target(s->world, platform, &moves, target));
  return moves;
}

/* Moves a platform by targets, one for each iteration; each is reached exactly. */
static void drive(scene* s, breve_object platform, double x, double y, int times) {
  for (int i = 0; i < times; ++i) {
    breve_pose target = pose_of(s, platform), read = {{0}, {1, 0, 0, 0}};
    target.location[0] += x;
    target.location[1] += y;
    CHECK(!is_moving(s, platform, NULL));
    CHECK_STATUS(BREVE_OK, breve_object_set_target(s->world, platform, &target));
    CHECK(is_moving(s, platform, &read));
    CHECK(memcmp(&read, &target, sizeof read) == 0);
    step_times(s, 1);
    CHECK_NEAR(target.location[0], pose_of(s, platform).location[0], 1e-12);
    CHECK_NEAR(target.location[1], pose_of(s, platform).location[1], 1e-12);
  }
  CHECK(!is_moving(s, platform, NULL));
}

static void a_platform_carries_what_stands_on_it(bool flat) {
  scene s;
  if (!open_bodies(&s, flat)) return;
  const breve_geometry slab = box_of_size(6, 1, 6), box = box_of_size(1, 1, 1);
  const breve_object platform = add_body(&s, "Stationary", &slab, 0, 0, 0),
                     body = add_body(&s, "Mobile", &box, 0, 1, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, body, true));
  step_times(&s, 20);
  const double h = breve_world_iteration_step(s.world), before = lag(&s, platform, body);
  /* 0.5 units per second, reached from rest by friction: what stands there slides less than v^2 / (2 mu g). */
  drive(&s, platform, 0.5 * h, 0, 40);
  CHECK_NEAR(20 * h, pose_of(&s, platform).location[0], 1e-9);
  CHECK_NEAR(before, lag(&s, platform, body), 0.05);
  double velocity[3] = {0, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_velocity(s.world, body, velocity));
  CHECK_NEAR(0.5, velocity[0], 1e-3);
  /* It stops, and so does what stands on it; then both go up. */
  step_times(&s, 40);
  CHECK_NEAR(20 * h, pose_of(&s, platform).location[0], 1e-9);
  CHECK_STATUS(BREVE_OK, breve_object_velocity(s.world, body, velocity));
  CHECK_NEAR(0, velocity[0], 1e-3);
  drive(&s, platform, 0, 0.5 * h, 40);
  CHECK_NEAR(1, pose_of(&s, body).location[1] - pose_of(&s, platform).location[1], 0.01);
  scene_close(&s);
}
static void platforms_carry_what_stands_on_them(void) {
  a_platform_carries_what_stands_on_it(false), a_platform_carries_what_stands_on_it(true);
}

static void targets_are_in_images_and_bad_ones_are_refused(void) {
  scene s;
  if (!open_bodies(&s, true)) return;
  const breve_geometry box = box_of_size(1, 1, 1);
  const breve_object platform = add_body(&s, "Stationary", &box, 0, 0, 0), body = add_body(&s, "Mobile", &box, 0, 9, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, body, true));
  const breve_pose there = {{1, 2, 0}, {1, 0, 0, 0}}, out = {{1, 2, 3}, {1, 0, 0, 0}},
                   wrong = {{NAN, 0, 0}, {1, 0, 0, 0}}, empty = {{0}, {0}};
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_target(s.world, body, &there)); /* it has physics */
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_target(s.world, platform, &out));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_target(s.world, platform, &wrong));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_target(s.world, platform, &empty));
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_object_set_target(s.world, breve_world_controller(s.world), &there));
  CHECK(!is_moving(&s, platform, NULL) && !is_moving(&s, body, NULL));
  CHECK_STATUS(BREVE_OK, breve_object_set_target(s.world, platform, &there));
  static char image[1 << 20];
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, sizeof image, &size));
  step_times(&s, 1);
  const uint64_t reached = hash_of_world(&s);
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  breve_pose read = {{0}, {1, 0, 0, 0}};
  CHECK(is_moving(&s, platform, &read));
  CHECK(memcmp(&read, &there, sizeof read) == 0);
  step_times(&s, 1);
  CHECK(hash_of_world(&s) == reached);
  CHECK_NEAR(2, pose_of(&s, platform).location[1], 1e-12);
  scene_close(&s);
}

static void bad_pushes_are_refused(void) {
  scene s;
  if (!open_bodies(&s, true)) return;
  const breve_geometry box = box_of_size(1, 1, 1);
  const breve_object body = floating(&s, &box), still = add_body(&s, "Stationary", &box, 9, 0, 0);
  const breve_object kinematic = add_body(&s, "Mobile", &box, 5, 0, 0);
  const uint64_t before = hash_of_world(&s);
  const double fine[3] = {1, 0, 0}, out[3] = {0, 0, 1}, wrong[3] = {INFINITY, 0, 0}, huge[3] = {0, 1e300, 0},
               far[3] = {1e300, 0, 0};
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_add_force(s.world, body, wrong, NULL, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_add_force(s.world, body, fine, NULL, wrong));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_add_force(s.world, body, out, NULL, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_add_force(s.world, body, fine, fine, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_add_force(s.world, body, huge, NULL, far));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_add_impulse(s.world, body, huge, far));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_add_impulse(s.world, body, out, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_add_impulse(s.world, body, NULL, NULL));
  for (int i = 0; i < 2; ++i) {
    const breve_object one = i == 0 ? still : kinematic;
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_add_force(s.world, one, fine, NULL, NULL));
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_add_impulse(s.world, one, fine, NULL));
    CHECK_STATUS(BREVE_OK, breve_object_wake(s.world, one));
  }
  const breve_object controller = breve_world_controller(s.world);
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_object_add_impulse(s.world, controller, fine, NULL));
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_object_wake(s.world, controller));
  CHECK(hash_of_world(&s) == before);
  /* One that is freed before it is pushed. */
  CHECK_STATUS(BREVE_OK, breve_object_add_force(s.world, body, fine, NULL, NULL));
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, body));
  step_times(&s, 1);
  scene_close(&s);
}

void forces_suite(void) {
  RUN(impulses_change_velocity_at_once);
  RUN(forces_act_for_one_iteration);
  RUN(a_pushed_joint_answers_with_both_bodies);
  RUN(platforms_carry_what_stands_on_them);
  RUN(targets_are_in_images_and_bad_ones_are_refused);
  RUN(bad_pushes_are_refused);
}
