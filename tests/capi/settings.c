/* Hosts read back what was set; a click goes to the first body that a ray meets. */
#include <math.h>

#include "bodies.h"

static void what_is_set_is_read_back(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  breve_world* const w = s.world;
  const breve_geometry ball = ball_of_radius(1);
  const breve_object body = add_body(&s, "Mobile", &ball, 0, 0, 0), other = add_body(&s, "Mobile", &ball, 5, 0, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(w, body, true));
  breve_material material = {0.5, 0.25, 0.75, -0.5, 0.125}, read = {9, 9, 9, 9, 9};
  CHECK_STATUS(BREVE_OK, breve_object_material(w, body, &read));
  CHECK(read.static_friction == -1 && read.dynamic_friction == -1 && read.restitution == -1);
  CHECK_STATUS(BREVE_OK, breve_object_set_material(w, body, &material));
  CHECK_STATUS(BREVE_OK, breve_object_material(w, body, &read));
  CHECK(memcmp(&read, &material, sizeof read) == 0);
  const double force[3] = {1, 2, 3}, torque[3] = {4, 5, 6};
  double f[3], t[3];
  CHECK_STATUS(BREVE_OK, breve_object_set_force(w, body, force, torque));
  CHECK_STATUS(BREVE_OK, breve_object_force(w, body, f, t));
  CHECK(memcmp(f, force, sizeof f) == 0 && memcmp(t, torque, sizeof t) == 0);
  CHECK(!breve_world_sleeping(w) && breve_world_workers(w) == 1);
  CHECK_STATUS(BREVE_OK, breve_world_set_sleeping(w, true));
  CHECK_STATUS(BREVE_OK, breve_world_set_workers(w, 3));
  CHECK(breve_world_sleeping(w) && breve_world_workers(w) == 3);
  breve_accuracy accuracy = breve_accuracy_default(), own = breve_accuracy_default();
  CHECK_STATUS(BREVE_OK, breve_rung_accuracy(BREVE_RUNG_PRECISE, &accuracy));
  CHECK_STATUS(BREVE_OK, breve_object_set_accuracy(w, body, &accuracy));
  CHECK_STATUS(BREVE_OK, breve_object_accuracy(w, body, &own));
  CHECK(own.rung == BREVE_RUNG_PRECISE);
  CHECK_STATUS(BREVE_OK, breve_object_accuracy(w, other, &own));
  CHECK(own.rung == BREVE_RUNG_BALANCED);
  bool on = true;
  CHECK_STATUS(BREVE_OK, breve_object_self_collisions(w, body, &on));
  CHECK(!on);
  CHECK_STATUS(BREVE_OK, breve_object_set_self_collisions(w, body, true));
  CHECK_STATUS(BREVE_OK, breve_object_self_collisions(w, body, &on));
  CHECK(on);
  breve_spring spring = breve_spring_default(), is = breve_spring_default();
  breve_object made;
  spring.from = body;
  spring.to = other;
  spring.from_point[1] = 0.5;
  spring.length = 4;
  spring.mode = BREVE_SPRING_CONTRACT_ONLY;
  CHECK_STATUS(BREVE_OK, breve_spring_create(w, &spring, &made));
  CHECK_STATUS(BREVE_OK, breve_spring_description(w, made, &is));
  CHECK(memcmp(&is, &spring, sizeof is) == 0);
  CHECK_STATUS(BREVE_OK, breve_object_free(w, other));
  CHECK_STATUS(BREVE_OK, breve_spring_description(w, made, &is));
  CHECK(is.to.generation == 0 && is.length == 4);
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_spring_description(w, body, &is));
  scene_close(&s);
}

static void time_gravity_and_what_is_watched_are_read_back(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  breve_world* const w = s.world;
  double gravity[3];
  const double moon[3] = {0, -1.62, 0}, wrong[3] = {0, INFINITY, 0};
  CHECK_STATUS(BREVE_OK, breve_world_gravity(w, gravity));
  CHECK(gravity[0] == 0 && gravity[1] == -9.8 && gravity[2] == 0); /* as PhysicalControl sets it */
  CHECK_STATUS(BREVE_OK, breve_world_set_gravity(w, moon));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_gravity(w, wrong));
  CHECK_STATUS(BREVE_OK, breve_world_gravity(w, gravity));
  CHECK(memcmp(gravity, moon, sizeof gravity) == 0);
  const double refused[] = {-1, NAN, INFINITY};
  CHECK(breve_world_time_scale(w) == 1 && !breve_world_interpolated(w));
  CHECK_STATUS(BREVE_OK, breve_world_set_time_scale(w, 0.25));
  CHECK_STATUS(BREVE_OK, breve_world_set_integration_step(w, 0.125));
  CHECK_STATUS(BREVE_OK, breve_world_set_interpolated(w, true));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_integration_step(w, 0));
  for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i) {
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_time_scale(w, refused[i]));
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_integration_step(w, refused[i]));
  }
  CHECK(breve_world_time_scale(w) == 0.25 && breve_world_integration_step(w) == 0.125 && breve_world_interpolated(w));
  const breve_geometry ball = ball_of_radius(1);
  const breve_object one = add_body(&s, "Mobile", &ball, 0, 0, 0), two = add_body(&s, "Mobile", &ball, 5, 0, 0);
  bool watched[2] = {true, true};
  CHECK_STATUS(BREVE_OK, breve_object_watch_contacts(w, one, true));
  CHECK_STATUS(BREVE_OK, breve_object_contacts_watched(w, one, &watched[0]));
  CHECK_STATUS(BREVE_OK, breve_object_contacts_watched(w, two, &watched[1]));
  CHECK(watched[0] && !watched[1]);
  CHECK_STATUS(BREVE_OK, breve_world_watch_contacts(w, "Mobile", true)); /* by its class */
  CHECK_STATUS(BREVE_OK, breve_object_contacts_watched(w, two, &watched[1]));
  CHECK(watched[1]);
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_object_contacts_watched(w, breve_world_controller(w), &watched[0]));
  scene_close(&s);
}

static void a_click_goes_to_what_a_ray_meets(void) {
  scene s;
  if (!scene_open(&s)) return;
  const double start[3] = {0, 0, 50}, way[3] = {0, 0, -100}, aside[3] = {0, 100, 0}, wrong[3] = {NAN, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_world_queue_click_ray(s.world, start, way));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "clicks") == 1 && same_object(value_of(&s, "clicked").as.object, ball_of(&s)));
  CHECK_STATUS(BREVE_OK, breve_world_queue_click_ray(s.world, start, aside));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "clicks") == 2 && value_of(&s, "clicked").as.object.generation == 0);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_queue_click_ray(s.world, wrong, way));
  scene_close(&s);
}

void settings_suite(void) {
  RUN(what_is_set_is_read_back);
  RUN(time_gravity_and_what_is_watched_are_read_back);
  RUN(a_click_goes_to_what_a_ray_meets);
}
