/* Pushes: forces of one iteration, impulses, at points, and waking. */
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
  RUN(bad_pushes_are_refused);
}
