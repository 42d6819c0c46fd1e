/* Events and queries: a ball that falls through a platform's open side, bumps, and is found by a ray. */
#include <breve/breve.h>
#include <stdio.h>

static breve_object add(breve_world* world, const char* class_name, const breve_geometry* geometry, double height) {
  const breve_pose pose = {{0, height, 0}, {1, 0, 0, 0}};
  breve_object body = {0, 0}, shape = {0, 0};
  breve_object_create(world, class_name, &body);
  breve_shape_create(world, geometry, &shape);
  breve_object_set_shape(world, body, shape);
  breve_object_set_pose(world, body, &pose);
  return body;
}

/* What happened in the last iteration. */
static void tell(breve_world* world) {
  static const char* const phases[] = {"begins", "persists", "ends"};
  breve_contact contacts[8];
  size_t count = 0;
  breve_world_contacts(world, contacts, 8, &count);
  for (size_t i = 0; i < count && i < 8; ++i)
    if (contacts[i].phase != BREVE_PHASE_PERSIST)
      printf("%.2f s: a contact %s at a height of %.1f\n", breve_world_time(world), phases[contacts[i].phase],
             contacts[i].point[1]);
}

static breve_status play(breve_world* world) {
  breve_geometry ball = breve_geometry_default(), slab = breve_geometry_default();
  ball.radius = 0.5;
  slab.kind = BREVE_SHAPE_BOX;
  slab.size[0] = slab.size[2] = 10;
  const breve_object floor = add(world, "Stationary", &slab, 0), platform = add(world, "Stationary", &slab, 4);
  const breve_object body = add(world, "Mobile", &ball, 2);
  (void)floor;
  breve_status status = breve_object_set_physics(world, body, true);

  /* The platform stops what comes from above, and lets pass what comes from below. */
  breve_collision_filter filter = breve_collision_filter_default();
  filter.one_way[1] = 1;
  if (status == BREVE_OK) status = breve_object_set_collision_filter(world, platform, &filter);

  /* Report the contacts of this one body. */
  if (status == BREVE_OK) status = breve_world_set_events(world, BREVE_EVENT_CONTACT);
  if (status == BREVE_OK) status = breve_object_watch_contacts(world, body, true);

  double mass = 0;
  if (status == BREVE_OK) status = breve_object_mass(world, body, &mass);
  const double jump[3] = {0, 9 * mass, 0}; /* 9 m/s upward */
  if (status == BREVE_OK) status = breve_object_add_impulse(world, body, jump, NULL);
  for (int i = 0; i < 50 && status == BREVE_OK; ++i) {
    status = breve_world_step(world);
    tell(world);
  }

  /* Whom does a ray from the sky meet? */
  const double sky[3] = {0, 20, 0}, down[3] = {0, -40, 0};
  breve_hit hits[8];
  size_t count = 0;
  if (status == BREVE_OK) status = breve_world_ray_all(world, sky, down, NULL, hits, 8, &count);
  for (size_t i = 0; i < count && i < 8; ++i)
    printf("%s at %.1f\n", breve_object_class(world, hits[i].object), hits[i].point[1]);
  return status;
}

int main(void) {
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  breve_status status = breve_runtime_create(NULL, &runtime);
  if (status == BREVE_OK) status = breve_program_create_library(runtime, NULL, &program);
  if (status == BREVE_OK) status = breve_world_create(runtime, program, NULL, &world);
  if (status == BREVE_OK) status = play(world);
  if (status != BREVE_OK) printf("%s\n", breve_status_name(status));
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return status != BREVE_OK;
}
