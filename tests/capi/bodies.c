/* What the tests of bodies share. */
#include "bodies.h"

#include <math.h>

bool open_bodies(scene* s, bool flat) {
  memset(s, 0, sizeof *s);
  breve_runtime_config config = breve_runtime_config_default();
  breve_world_config world = breve_world_config_default();
  config.user = &s->said;
  config.print = remember;
  world.dimension = flat ? 2 : 3;
  return CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &s->runtime)) &&
         CHECK_STATUS(BREVE_OK, breve_program_create_library(s->runtime, NULL, &s->program)) &&
         CHECK_STATUS(BREVE_OK, breve_world_create(s->runtime, s->program, &world, &s->world));
}

bool same_object(breve_object a, breve_object b) { return a.index == b.index && a.generation == b.generation; }

breve_geometry ball_of_radius(double radius) {
  breve_geometry geometry = breve_geometry_default();
  geometry.radius = radius;
  return geometry;
}

breve_geometry box_of_size(double x, double y, double z) {
  breve_geometry geometry = breve_geometry_default();
  geometry.kind = BREVE_SHAPE_BOX;
  geometry.size[0] = x;
  geometry.size[1] = y;
  geometry.size[2] = z;
  return geometry;
}

breve_object add_body(scene* s, const char* class_name, const breve_geometry* geometry, double x, double y, double z) {
  breve_object body = {0, 0}, shape = {0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_create(s->world, class_name, &body));
  CHECK_STATUS(BREVE_OK, breve_shape_create(s->world, geometry, &shape));
  CHECK_STATUS(BREVE_OK, breve_object_set_shape(s->world, body, shape));
  put_at(s, body, x, y, z);
  return body;
}

void put_at(scene* s, breve_object object, double x, double y, double z) {
  breve_pose pose = pose_of(s, object);
  pose.location[0] = x;
  pose.location[1] = y;
  pose.location[2] = z;
  CHECK_STATUS(BREVE_OK, breve_object_set_pose(s->world, object, &pose));
}

void rotate_about_z(scene* s, breve_object object, double radians) {
  breve_pose pose = pose_of(s, object);
  pose.rotation[0] = cos(radians / 2);
  pose.rotation[1] = pose.rotation[2] = 0;
  pose.rotation[3] = sin(radians / 2);
  CHECK_STATUS(BREVE_OK, breve_object_set_pose(s->world, object, &pose));
}

void set_moving(scene* s, breve_object object, double x, double y, double z) {
  const double velocity[3] = {x, y, z};
  CHECK_STATUS(BREVE_OK, breve_object_set_velocity(s->world, object, velocity));
}

breve_pose pose_of(scene* s, breve_object object) {
  breve_pose pose = {{0}, {1, 0, 0, 0}};
  CHECK_STATUS(BREVE_OK, breve_object_pose(s->world, object, &pose));
  return pose;
}

uint64_t hash_of_world(scene* s) {
  uint64_t hash = 0;
  CHECK_STATUS(BREVE_OK, breve_world_hash(s->world, &hash));
  return hash;
}

void step_times(scene* s, int times) {
  for (int i = 0; i < times; ++i)
    if (!CHECK_STATUS(BREVE_OK, breve_world_step(s->world))) return;
}

const breve_effect* effect_of(scene* s, const char* name) {
  static breve_effect effects[64];
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_effects(s->world, effects, 64, &count));
  for (size_t i = 0; i < count && i < 64; ++i)
    if (strcmp(effects[i].name, name) == 0) return &effects[i];
  CHECK(!"there is an effect of that name");
  return &effects[0];
}

double draw(double low, double high) {
  static uint64_t state = 88172645463325252U;
  state ^= state << 13, state ^= state >> 7, state ^= state << 17; /* Marsaglia 2003 */
  return low + (high - low) * (double)(state >> 11) / 9007199254740992.0;
}
