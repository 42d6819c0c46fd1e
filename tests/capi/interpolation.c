/* What a game loop needs beside steps: poses between two iterations, the pace of time, the length of an iteration. */
#include <math.h>

#include "bodies.h"

static void between(scene* s, breve_object object, double fraction, double pose[7]) {
  const breve_array row = {pose, 0, BREVE_NUMBER_DOUBLE, 7};
  CHECK_STATUS(BREVE_OK, breve_objects_interpolated(s->world, &object, 1, fraction, BREVE_PROPERTY_POSE, &row));
}

static void poses_lie_between_those_of_two_iterations(bool flat) {
  scene s;
  if (!open_bodies(&s, flat)) return;
  const breve_geometry ball = ball_of_radius(1);
  const breve_object body = add_body(&s, "Mobile", &ball, 1, 2, 0);
  const double spin[3] = {0, 0, 2};
  set_moving(&s, body, 3, 0, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_rotational_velocity(s.world, body, spin));
  CHECK_STATUS(BREVE_OK, breve_world_set_interpolated(s.world, true));
  double pose[7];
  between(&s, body, 0, pose); /* nothing was run yet */
  CHECK(pose[0] == 1 && pose[3] == 1);
  step_times(&s, 2);
  const double h = breve_world_iteration_step(s.world);
  for (int i = 0; i <= 4; ++i) {
    between(&s, body, i / 4.0, pose);
    CHECK_NEAR(1 + 3 * h * (1 + i / 4.0), pose[0], 1e-12);
    /* A sub-step turns a body by Euler's method. */
    CHECK_NEAR(cos(h * (1 + i / 4.0)), pose[3], 2e-5);
    CHECK_NEAR(sin(h * (1 + i / 4.0)), pose[6], 2e-5);
  }
  /* Floats, at a distance, of several properties. */
  float rows[2][8] = {{0}};
  const breve_object both[2] = {body, body};
  breve_array narrow = {rows, sizeof rows[0], BREVE_NUMBER_FLOAT, 3};
  CHECK_STATUS(BREVE_OK, breve_objects_interpolated(s.world, both, 2, 0.5, BREVE_PROPERTY_LOCATION, &narrow));
  CHECK_NEAR(1 + 4.5 * h, rows[1][0], 1e-6);
  narrow.width = 4;
  CHECK_STATUS(BREVE_OK, breve_objects_interpolated(s.world, both, 2, 0.5, BREVE_PROPERTY_ROTATION, &narrow));
  CHECK_NEAR(cos(1.5 * h), rows[1][0], 2e-5);
  /* What the host puts elsewhere is there; so is what it makes. */
  put_at(&s, body, 50, 0, 0);
  between(&s, body, 0.25, pose);
  CHECK(pose[0] == 50);
  const breve_object late = add_body(&s, "Mobile", &ball, 7, 0, 0);
  between(&s, late, 0.25, pose);
  CHECK(pose[0] == 7);
  /* An object in the place of one that is gone has no past. */
  step_times(&s, 1);
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, late));
  const breve_object heir = add_body(&s, "Mobile", &ball, -7, 0, 0);
  between(&s, heir, 0.25, pose);
  CHECK(pose[0] == -7);
  scene_close(&s);
}
static void poses_lie_between_those_of_two_iterations_in_space(void) {
  poses_lie_between_those_of_two_iterations(false);
}
static void poses_lie_between_those_of_two_iterations_in_a_plane(void) {
  poses_lie_between_those_of_two_iterations(true);
}

static void the_way_across_an_edge_is_the_short_one(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  CHECK_STATUS(BREVE_OK, breve_world_set_space(s.world, 0, BREVE_EDGE_WRAP, -10, 10));
  const breve_geometry ball = ball_of_radius(1);
  const double h = breve_world_iteration_step(s.world);
  const breve_object body = add_body(&s, "Mobile", &ball, 10 - h, 0, 0);
  set_moving(&s, body, 4, 0, 0);
  CHECK_STATUS(BREVE_OK, breve_world_set_interpolated(s.world, true));
  step_times(&s, 1);
  double pose[7];
  between(&s, body, 0.125, pose);
  CHECK_NEAR(10 - h / 2, pose[0], 1e-9);
  between(&s, body, 0.5, pose);
  CHECK_NEAR(-10 + h, pose[0], 1e-9);
  scene_close(&s);
}

static void a_loop_draws_smoothly_at_any_frame_rate(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(1);
  const breve_object body = add_body(&s, "Mobile", &ball, 0, 0, 0);
  set_moving(&s, body, 1, 0, 0);
  CHECK_STATUS(BREVE_OK, breve_world_set_iteration_step(s.world, 0.05));
  CHECK_STATUS(BREVE_OK, breve_world_set_time_scale(s.world, 0.5));
  CHECK_STATUS(BREVE_OK, breve_world_set_interpolated(s.world, true));
  double shown = 0, fraction = 0, pose[7];
  for (int frame = 1; frame <= 100; ++frame) {
    CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 1 / 60.0, &fraction));
    between(&s, body, fraction, pose);
    /* One iteration behind the time that has passed, at half speed. */
    const double passed = frame / 120.0 - 0.05;
    CHECK_NEAR(passed > 0 ? passed : 0, pose[0], 1e-6);
    CHECK(pose[0] >= shown);
    shown = pose[0];
  }
  CHECK_STATUS(BREVE_OK, breve_world_set_time_scale(s.world, 0));
  const uint64_t before = breve_world_iteration(s.world);
  CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 10, &fraction));
  CHECK(breve_world_iteration(s.world) == before);
  scene_close(&s);
}

static void what_cannot_be_is_refused(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(1);
  const breve_object body = add_body(&s, "Mobile", &ball, 0, 0, 0), controller = breve_world_controller(s.world);
  double numbers[7] = {0};
  const breve_array row = {numbers, 0, BREVE_NUMBER_DOUBLE, 7};
  breve_world* const w = s.world;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_interpolated(w, &body, 1, 0.5, BREVE_PROPERTY_POSE, &row));
  CHECK_STATUS(BREVE_OK, breve_world_set_interpolated(w, true));
  CHECK_STATUS(BREVE_OK, breve_objects_interpolated(w, &body, 1, 0.5, BREVE_PROPERTY_POSE, &row));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_interpolated(w, &body, 1, 1.5, BREVE_PROPERTY_POSE, &row));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_interpolated(w, &body, 1, NAN, BREVE_PROPERTY_POSE, &row));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_interpolated(w, &body, 1, 0.5, BREVE_PROPERTY_VELOCITY, &row));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_interpolated(w, &body, 1, 0.5, BREVE_PROPERTY_LOCATION, &row));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_interpolated(w, NULL, 1, 0.5, BREVE_PROPERTY_POSE, &row));
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_objects_interpolated(w, &controller, 1, 0.5, BREVE_PROPERTY_POSE, &row));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_iteration_step(w, 0));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_iteration_step(w, NAN));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_time_scale(w, -1));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_time_scale(w, INFINITY));
  scene_close(&s);
}

void interpolation_suite(void) {
  RUN(poses_lie_between_those_of_two_iterations_in_space);
  RUN(poses_lie_between_those_of_two_iterations_in_a_plane);
  RUN(the_way_across_an_edge_is_the_short_one);
  RUN(a_loop_draws_smoothly_at_any_frame_rate);
  RUN(what_cannot_be_is_refused);
}
