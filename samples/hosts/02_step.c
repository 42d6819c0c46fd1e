/* A game loop: frames at the screen's rate, iterations at the world's, and poses in between. */
#include <breve/breve.h>
#include <stdio.h>
#include <string.h>

static const char* const text =
    "@use Control.\n"
    "@use Mobile.\n"
    "Controller Loop.\n"
    "Control : Loop {\n"
    "  + to init:\n"
    "    self set-iteration-step to 0.1.\n"
    "    (new Mobile) set-velocity to (1, 0, 0).\n"
    "}\n";

/* What a frame shows: the renderer's own layout, filled in one call for all bodies. */
typedef struct instance {
  float place[3];
  float size;
} instance;

static breve_status play(breve_world* world) {
  const double frame = 1 / 60.0; /* s: measure it in a real loop */
  breve_object bodies[8];
  instance shown[8] = {{{0}, 1}};
  const breve_array places = {shown[0].place, sizeof(instance), BREVE_NUMBER_FLOAT, 3};
  size_t count = 0;
  breve_status status = breve_world_set_interpolated(world, true);
  for (int i = 0; i < 30 && status == BREVE_OK; ++i) {
    double fraction = 0;
    status = breve_world_advance(world, frame, &fraction);
    if (status == BREVE_OK) status = breve_world_objects(world, "Mobile", bodies, 8, &count);
    if (count > 8) count = 8;
    if (status == BREVE_OK)
      status = breve_objects_interpolated(world, bodies, count, fraction, BREVE_PROPERTY_LOCATION, &places);
    if (i % 6 == 5)
      printf("frame %2d, iteration %d: x = %.3f\n", i + 1, (int)breve_world_iteration(world),
             (double)shown[0].place[0]);
    /* Slow motion in the second half. */
    if (i == 14 && status == BREVE_OK) status = breve_world_set_time_scale(world, 0.5);
  }
  return status;
}

int main(void) {
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  breve_status status = breve_runtime_create(NULL, &runtime);
  if (status == BREVE_OK) status = breve_program_compile(runtime, "loop.tz", text, strlen(text), &program);
  if (status == BREVE_OK) status = breve_world_create(runtime, program, NULL, &world);
  if (status == BREVE_OK) status = play(world);
  if (status != BREVE_OK) printf("%s\n", breve_status_name(status));
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return status != BREVE_OK;
}
