/* restored PROGRAM.tz [BUDGET PHYSICS-BUDGET]: a world, and one that is restored from its image before each iteration,
 * are the same after each, on each rung. A program may say after how many it ends: "# iterations: 8". */
#include <stdlib.h>

#include "check.h"

static char* text_of(const char* path, size_t* size) {
  FILE* file = fopen(path, "rb");
  if (!file) return NULL;
  fseek(file, 0, SEEK_END);
  *size = (size_t)ftell(file);
  rewind(file);
  char* text = malloc(*size + 1);
  *size = fread(text, 1, *size, file);
  text[*size] = 0;
  fclose(file);
  return text;
}

/* As one world is, so is the other. */
static void copy(const breve_world* one, breve_world* other) {
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(one, NULL, 0, &size));
  unsigned char* image = malloc(size);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(one, image, size, &size));
  if (!CHECK_STATUS(BREVE_OK, breve_world_restore(other, image, size))) puts(breve_world_last_error(other)->text);
  free(image);
}

static bool same(const breve_world* one, const breve_world* other) {
  uint64_t hash = 0, again = 1;
  CHECK_STATUS(BREVE_OK, breve_world_hash(one, &hash));
  CHECK_STATUS(BREVE_OK, breve_world_hash(other, &again));
  return hash == again;
}

static int iterations_of(const char* text, int otherwise) {
  const char* mark = "# iterations: ";
  const char* found = strstr(text, mark);
  return found ? atoi(found + strlen(mark)) : otherwise;
}

static void goes_on_alike(breve_runtime* runtime, breve_program* program, breve_world_config config, int iterations) {
  breve_world *one = NULL, *other = NULL;
  CHECK_STATUS(BREVE_OK, breve_world_create(runtime, program, &config, &one));
  CHECK_STATUS(BREVE_OK, breve_world_create(runtime, program, &config, &other));
  for (int i = 0; i < iterations && failures == 0; ++i) {
    copy(one, other);
    CHECK(same(one, other));
    const breve_status status = breve_world_step(one);
    CHECK(status == BREVE_OK || status == BREVE_ERROR_SCRIPT || (config.budget && status == BREVE_ERROR_BUDGET));
    CHECK_STATUS(status, breve_world_step(other));
    CHECK(same(one, other));
    if (failures) printf("on %s, in iteration %d\n", config.accuracy, i + 1);
  }
  breve_world_destroy(one);
  breve_world_destroy(other);
}

int main(int count, char** arguments) {
  size_t size = 0;
  char* text = count == 2 || count == 4 ? text_of(arguments[1], &size) : NULL;
  if (!text) return 2;
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(NULL, &runtime));
  if (CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "program.tz", text, size, &program))) {
    static const char* const rungs[] = {"fast", "balanced", "precise", "reference"};
    breve_world_config config = breve_world_config_default();
    config.seed = 14;
    if (count == 4) {
      config.budget = strtoull(arguments[2], NULL, 10);
      config.physics_budget = strtoull(arguments[3], NULL, 10);
      config.depth_limit = 60;
    }
    const int iterations = iterations_of(text, config.budget ? 50 : 24);
    for (size_t i = 0; i < sizeof rungs / sizeof *rungs; ++i) {
      config.accuracy = rungs[i];
      goes_on_alike(runtime, program, config, iterations);
    }
  } else {
    puts(breve_runtime_last_error(runtime)->text);
  }
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  free(text);
  return failures != 0;
}
