/* Flat worlds, chosen by a host. */
#include <math.h>
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

static void expect_same_flight(breve_world* world, breve_object ball, uint64_t hash, const breve_pose* target,
                               const double middle[7]) {
  uint64_t now = 0;
  CHECK_STATUS(BREVE_OK, breve_world_hash(world, &now));
  CHECK(now == hash);
  bool moves = false;
  breve_pose pose;
  CHECK_STATUS(BREVE_OK, breve_object_target(world, ball, &moves, &pose));
  CHECK(moves && memcmp(&pose, target, sizeof pose) == 0);
  double row[7] = {0};
  const breve_array array = {row, 0, BREVE_NUMBER_DOUBLE, 7};
  CHECK_STATUS(BREVE_OK, breve_objects_interpolated(world, &ball, 1, 0.5, BREVE_PROPERTY_POSE, &array));
  CHECK(memcmp(row, middle, sizeof row) == 0);
}

/* A body on its way to a target, in a world that also keeps poses for drawing: a refused pose or target, whichever
   half of it is bad, changes neither the way nor what is drawn, nor what the world does next. */
static void a_refused_pose_leaves_targets_and_drawing_alone(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.dimension = 2;
  if (!CHECK_STATUS(BREVE_OK, open_world(&s, NULL, &config))) return;
  breve_object ball = {0, 0}, link = {0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Mobile", &ball));
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Link", &link));
  const breve_pose start = {{1, 2, 0}, {1, 0, 0, 0}}, target = {{3, 2, 0}, {1, 0, 0, 0}};
  CHECK_STATUS(BREVE_OK, breve_object_set_pose(s.world, ball, &start));
  CHECK_STATUS(BREVE_OK, breve_world_set_interpolated(s.world, true));
  const double velocity[3] = {0.5, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_set_velocity(s.world, ball, velocity));
  for (int i = 0; i < 3; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_object_set_target(s.world, ball, &target));
  double middle[7] = {0};
  const breve_array array = {middle, 0, BREVE_NUMBER_DOUBLE, 7};
  CHECK_STATUS(BREVE_OK, breve_objects_interpolated(s.world, &ball, 1, 0.5, BREVE_PROPERTY_POSE, &array));
  breve_pose now;
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, ball, &now));
  CHECK(middle[0] < now.location[0]); /* drawn behind where it is */
  uint64_t hash = 0;
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &hash));

  const breve_pose bad[] = {{{3, 4, 1}, {0, 0, 0, 1}},     /* out of the plane */
                            {{2e28, 4, 0}, {0, 0, 0, 1}},  /* beyond the end of a flat world */
                            {{3, 4, 0}, {0.7, 0.7, 0, 0}}, /* tilted */
                            {{3, NAN, 0}, {1, 0, 0, 0}},   /* not a number */
                            {{3, 4, 0}, {0, 0, 0, 0}}};    /* not a rotation */
  for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_pose(s.world, ball, &bad[i]));
    expect_same_flight(s.world, ball, hash, &target, middle);
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_target(s.world, ball, &bad[i]));
    expect_same_flight(s.world, ball, hash, &target, middle);
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_assembly_pose(s.world, ball, &bad[i]));
    expect_same_flight(s.world, ball, hash, &target, middle);
  }
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, ball, &now));
  CHECK(memcmp(&now, &target, sizeof now) == 0);
  scene_close(&s);
}

/* World::leave notes where a body stood: a Stationary that was refused a pose must not be swept to where it is. */
static void a_refused_pose_does_not_set_a_driver_on_its_way(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.dimension = 2;
  if (!CHECK_STATUS(BREVE_OK, open_world(&s, NULL, &config))) return;
  breve_object wall = {0, 0}, link = {0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Stationary", &wall));
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Link", &link));
  const breve_pose near_it = {{8, -20, 0}, {1, 0, 0, 0}}, high = {{8.01, -20, 1}, {1, 0, 0, 0}};
  CHECK_STATUS(BREVE_OK, breve_object_set_pose(s.world, wall, &near_it));
  for (int i = 0; i < 2; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  const breve_pose nearer = {{8.02, -20, 0}, {1, 0, 0, 0}};
  uint64_t before = 0, after = 0;
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &before));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_pose(s.world, wall, &high));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &after));
  CHECK(before == after);
  CHECK_STATUS(BREVE_OK, breve_object_set_pose(s.world, wall, &nearer));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  breve_pose now;
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, wall, &now));
  CHECK(memcmp(&now, &nearer, sizeof now) == 0);
  scene_close(&s);
}

void flat_suite(void) {
  RUN(a_refused_pose_leaves_targets_and_drawing_alone);
  RUN(a_refused_pose_does_not_set_a_driver_on_its_way);
  RUN(the_config_makes_a_world_flat);
  RUN(dimension_and_length_unit_are_checked);
  RUN(what_is_refused_in_part_changes_nothing);
}
