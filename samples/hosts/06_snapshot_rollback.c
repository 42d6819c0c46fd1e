/* Snapshots: a game rolls back to an earlier moment and plays it again with other input, as network games do. */
#include <breve/breve.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char* const text =
    "@use Control.\n"
    "Controller Game.\n"
    "Control : Game {\n"
    "  + variables:\n    score (int).\n"
    "  + to catch-key-j-down: score += 10.\n"
    "  + to iterate: score++. super iterate.\n"
    "}\n";

/* The state of a world at one moment. */
typedef struct moment {
  void* image;
  size_t size;
} moment;

static breve_status take(const breve_world* world, moment* m) {
  breve_status status = breve_world_snapshot(world, NULL, 0, &m->size); /* how large is it? */
  if (status != BREVE_OK) return status;
  m->image = malloc(m->size);
  return m->image ? breve_world_snapshot(world, m->image, m->size, &m->size) : BREVE_ERROR_MEMORY;
}

/* Ten iterations; a key comes in the one of that number. */
static breve_status play(breve_world* world, int key_at) {
  breve_status status = BREVE_OK;
  breve_value score = breve_value_null();
  uint64_t hash = 0;
  for (int i = 0; i < 10 && status == BREVE_OK; ++i) {
    if (i == key_at) status = breve_world_queue_key(world, "j", true);
    if (status == BREVE_OK) status = breve_world_step(world);
  }
  if (status == BREVE_OK) status = breve_world_hash(world, &hash);
  if (status == BREVE_OK) status = breve_object_get(world, breve_world_controller(world), "score", &score);
  if (status == BREVE_OK) printf("score %d, hash %016llx\n", (int)score.as.integer, (unsigned long long)hash);
  return status;
}

int main(void) {
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  moment start = {NULL, 0};
  breve_status status = breve_runtime_create(NULL, &runtime);
  if (status == BREVE_OK) status = breve_program_compile(runtime, "game.tz", text, strlen(text), &program);
  if (status == BREVE_OK) status = breve_world_create(runtime, program, NULL, &world);
  if (status == BREVE_OK) status = take(world, &start);
  if (status == BREVE_OK) status = play(world, -1); /* as we guessed it */
  /* The other player's key arrives late: back, and once more with it. The same input gives the same hash. */
  for (int i = 0; i < 2 && status == BREVE_OK; ++i) {
    status = breve_world_restore(world, start.image, start.size);
    if (status == BREVE_OK) status = play(world, 3);
  }
  if (status != BREVE_OK) printf("%s\n", breve_status_name(status));
  free(start.image);
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return status != BREVE_OK;
}
