/* Flat worlds, chosen by a host. */
#include <stdlib.h>

#include "scene.h"

static breve_status open_world(scene* s, const char* controller, const breve_world_config* config) {
  memset(s, 0, sizeof *s);
  breve_runtime_config runtime = breve_runtime_config_default();
  runtime.user = &s->said;
  runtime.print = remember;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&runtime, &s->runtime));
  CHECK_STATUS(BREVE_OK, breve_program_create_library(s->runtime, controller, &s->program));
  return breve_world_create(s->runtime, s->program, config, &s->world);
}

static void the_config_makes_a_world_flat(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.dimension = 2;
  config.length_unit = 0.5;
  if (!CHECK_STATUS(BREVE_OK, open_world(&s, NULL, &config))) return;
  breve_object ball = {0, 0}, link = {0, 0}, joint;
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Link", &link));
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Mobile", &ball));
  breve_joint_description d = breve_joint_description_default(BREVE_JOINT_BALL);
  d.child = link;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_joint_create(s.world, &d, &joint));
  CHECK(strstr(breve_world_last_error(s.world)->message, "flat") != NULL);
  for (int i = 0; i < 20; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  breve_pose pose;
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, link, &pose));
  CHECK_NEAR(-4.9 * 1 * 1, pose.location[1], 0.02);
  CHECK(pose.location[2] == 0);

  size_t size = 0;
  uint64_t before = 0, after = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, NULL, 0, &size));
  void* image = malloc(size);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, size, &size));
  for (int i = 0; i < 20; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &before));
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  for (int i = 0; i < 20; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &after));
  CHECK(before == after);
  free(image);
  scene_close(&s);
}

static void dimension_and_length_unit_are_checked(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.dimension = 4;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, open_world(&s, NULL, &config));
  scene_close(&s);
  config.dimension = 3;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, open_world(&s, "PlanarControl", &config));
  scene_close(&s);
  config.dimension = 0;
  CHECK_STATUS(BREVE_OK, open_world(&s, "PlanarControl", &config));
  scene_close(&s);
  config.length_unit = -1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, open_world(&s, "PlanarControl", &config));
  scene_close(&s);
  config.length_unit = 1e-12;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, open_world(&s, "PlanarControl", &config));
  scene_close(&s);
  config.dimension = 3;
  config.length_unit = 0.001;
  CHECK_STATUS(BREVE_OK, open_world(&s, "PhysicalControl", &config));
  breve_value unit;
  CHECK_STATUS(BREVE_OK,
               breve_object_call(s.world, breve_world_controller(s.world), "get-length-unit", NULL, 0, &unit));
  CHECK(unit.type == BREVE_TYPE_DOUBLE && unit.as.number == 0.001);
  scene_close(&s);
}

/* A setter takes all of its input, or nothing of it. */
static void what_is_refused_in_part_changes_nothing(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.dimension = 2;
  if (!CHECK_STATUS(BREVE_OK, open_world(&s, NULL, &config))) return;
  breve_object link = {0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Link", &link));
  const breve_pose good = {{1, 2, 0}, {1, 0, 0, 0}}, tilted = {{3, 4, 0}, {0.7, 0.7, 0, 0}},
                   high = {{3, 4, 1}, {0, 0, 0, 1}};
  CHECK_STATUS(BREVE_OK, breve_object_set_pose(s.world, link, &good));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_pose(s.world, link, &tilted));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_pose(s.world, link, &high));
  breve_pose pose;
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, link, &pose));
  CHECK(memcmp(&pose, &good, sizeof pose) == 0);
  const double force[3] = {1, 2, 0}, out_of_plane[3] = {1, 2, 3}, torque[3] = {0, 0, 5};
  uint64_t before = 0, after = 0;
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &before));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_force(s.world, link, force, out_of_plane));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_force(s.world, link, out_of_plane, torque));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &after));
  CHECK(before == after);
  CHECK_STATUS(BREVE_OK, breve_object_set_force(s.world, link, force, torque));
  scene_close(&s);
}

void flat_suite(void) {
  RUN(the_config_makes_a_world_flat);
  RUN(dimension_and_length_unit_are_checked);
  RUN(what_is_refused_in_part_changes_nothing);
}
