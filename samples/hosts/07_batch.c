/* A batch: a hundred random walks on all cores, each with its seed, and what came of them. */
#include <breve/breve.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { kWalks = 100 };

static const char* const text =
    "@use Control.\n"
    "@use Mobile.\n"
    "Controller Walk.\n"
    "Mobile : Walker (aka Walkers) {\n"
    "  + to iterate: self offset by random[(2, 2, 0)] - (1, 1, 0).\n"
    "}\n"
    "Control : Walk {\n"
    "  + variables:\n    walker (object).\n"
    "  + to init: walker = new Walker.\n"
    "}\n";

/* World `index` has ended: called by the thread that ran it, each writes its own place. */
static bool read_end(void* user, size_t index, breve_world* world, const breve_outcome* outcome) {
  double* const far = user;
  breve_object walker;
  breve_pose pose;
  size_t count = 0;
  if (outcome->status == BREVE_OK && breve_world_objects(world, "Walker", &walker, 1, &count) == BREVE_OK &&
      breve_object_pose(world, walker, &pose) == BREVE_OK)
    far[index] = hypot(pose.location[0], pose.location[1]);
  return true;
}

int main(void) {
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_batch batch = breve_batch_default();
  double far[kWalks] = {0}, squares = 0;
  batch.count = kWalks;
  batch.iterations = 300;
  batch.user = far;
  batch.end = read_end;
  breve_status status = breve_runtime_create(NULL, &runtime);
  if (status == BREVE_OK) status = breve_program_compile(runtime, "walk.tz", text, strlen(text), &program);
  if (status == BREVE_OK) status = breve_batch_run(runtime, program, &batch, NULL);
  for (int i = 0; i < kWalks; ++i) squares += far[i] * far[i];
  /* Each step has a variance of 2/3. */
  printf("root of the mean square: %.1f, expected %.1f\n", sqrt(squares / kWalks), sqrt(300 * 2 / 3.0));
  if (status != BREVE_OK) printf("%s\n", breve_status_name(status));
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return status != BREVE_OK;
}
