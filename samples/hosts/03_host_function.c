/* Functions of the host: a game owns its terrain, and agents ask for its height as they ask for sqrt(x). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "breve/breve.h"

static const char* const program_text =
    "@use Control.\n"
    "@use Mobile.\n"
    "Controller Valley.\n"
    "Control : Valley {\n"
    "  + to init: 3 new Walkers.\n"
    "}\n"
    "Mobile : Walker (aka Walkers) {\n"
    "  + to iterate:\n"
    "    x (float).\n"
    "    x = (self get-location)::x + 10.\n"
    "    (self move to (x, worldHeight(x, 0), 0)).\n"
    "}\n";

/* What the game knows and scripts do not. */
typedef struct terrain {
  double width, hill;
} terrain;

/* The arguments are doubles, as declared below. Where there is no ground the script gets an error at its call. */
static breve_status world_height(void* user, const breve_call* call, breve_value* result) {
  const terrain* ground = user;
  const double x = call->arguments[0].as.number, y = call->arguments[1].as.number;
  static const char reason[] = "there is no ground";
  if (fabs(x) > ground->width || fabs(y) > ground->width) {
    call->reason(call->sink, reason, sizeof reason - 1);
    return BREVE_ERROR_NOT_FOUND;
  }
  *result = breve_value_double(ground->hill * sin(x / 10));
  return BREVE_OK;
}

static void say(void* user, breve_world* world, breve_channel channel, const char* text, size_t size) {
  (void)user, (void)world, (void)channel;
  fwrite(text, 1, size, stdout);
}

/* One walker's height after each step, until the walkers come to the end of the ground. */
static int walk(breve_world* world) {
  breve_object walker;
  breve_pose pose;
  size_t count;
  if (breve_world_objects(world, "Walker", &walker, 1, &count) != BREVE_OK) return 1;
  for (int i = 0; i < 3; ++i) {
    if (breve_world_step(world) != BREVE_OK || breve_object_pose(world, walker, &pose) != BREVE_OK) return 1;
    printf("height at %g: %.3f\n", pose.location[0], pose.location[1]);
  }
  return 0;
}

int main(void) {
  static const uint32_t doubles[] = {BREVE_TYPE_DOUBLE, BREVE_TYPE_DOUBLE};
  terrain ground = {25, 2};
  breve_runtime_config config = breve_runtime_config_default();
  breve_function height = breve_function_default();
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  int failed = 1;
  config.print = say; /* errors in `iterate` are printed here, and the run goes on */
  height.name = "worldHeight";
  height.doc = "Height of the ground at (x, y).";
  height.parameters = doubles;
  height.parameter_count = 2;
  height.result = BREVE_TYPE_DOUBLE;
  height.call = world_height;
  height.user = &ground;
  if (breve_runtime_create(&config, &runtime) == BREVE_OK &&
      breve_runtime_add_function(runtime, &height) == BREVE_OK && /* before the program is compiled */
      breve_program_compile(runtime, "valley.tz", program_text, strlen(program_text), &program) == BREVE_OK &&
      breve_world_create(runtime, program, NULL, &world) == BREVE_OK)
    failed = walk(world);
  const breve_error* error = world ? breve_world_last_error(world) : breve_runtime_last_error(runtime);
  if (error) printf("%s", error->text);
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return failed;
}
