/* flock.c: a C host that owns its loop, steps a flock of birds frame by frame, and looks at it between the frames.
 *
 * What it teaches: the four handles (runtime, program, world, object), loading a file of agents, stepping, enumerating
 * and reading agents without a copy of the world, calling a script method, and errors as values.
 *
 *     flock_c [FILE.tz [FRAMES]]        default: samples/worlds/flock.tz, 600 frames
 */
#include <breve/breve.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MAX_BIRDS = 1000 };

/* What the host wants to know about the flock. */
typedef struct Look {
  double spread; /* mean distance of the birds from their centre, length units */
  double order;  /* |mean heading| of those that fly: 1 if all fly the same way */
  int landed;
} Look;

static double length(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

static double seconds_now(void) {
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The library reads no files. It asks for each module by name; this host answers from the file system. */
static bool read_module(void* user, const char* name, const char* from, breve_module* module) {
  (void)user, (void)from;
  FILE* file = fopen(name, "rb");
  if (!file) return false;
  char* text = NULL;
  size_t size = 0, got = 0;
  char block[4096];
  while ((got = fread(block, 1, sizeof block, file)) > 0) {
    char* more = realloc(text, size + got);
    if (!more) break;
    text = more;
    memcpy(text + size, block, got);
    size += got;
  }
  fclose(file);
  module->text = text;
  module->size = size;
  return true;
}

static void release_module(void* user, const breve_module* module) {
  (void)user;
  free((void*)module->text);
}

/* Warnings and errors go to stderr. What the script prints is left out: this host prints its own table. */
static void speak(void* user, breve_world* world, breve_channel channel, const char* text, size_t size) {
  (void)user, (void)world;
  if (channel != BREVE_CHANNEL_PRINT) fwrite(text, 1, size, stderr);
}

static int fail(const char* what, const breve_error* error) {
  fprintf(stderr, "flock: %s failed\n%s", what, error ? error->text : "");
  return EXIT_FAILURE;
}

/* One look at all birds: ids in order of creation, then pose and velocity of each. */
static breve_status look_at_flock(breve_world* world, Look* look) {
  static breve_object birds[MAX_BIRDS];
  static breve_pose poses[MAX_BIRDS];
  size_t count = 0;
  breve_status status = breve_world_objects(world, "Bird", birds, MAX_BIRDS, &count);
  if (status != BREVE_OK) return status;
  if (count > MAX_BIRDS) count = MAX_BIRDS;
  double center[3] = {0, 0, 0}, heading[3] = {0, 0, 0}, sum = 0;
  size_t flying = 0;
  for (size_t i = 0; i < count; ++i) {
    double velocity[3];
    if ((status = breve_object_pose(world, birds[i], &poses[i])) != BREVE_OK) return status;
    if ((status = breve_object_velocity(world, birds[i], velocity)) != BREVE_OK) return status;
    const double speed = length(velocity);
    for (int k = 0; k < 3; ++k) {
      center[k] += poses[i].location[k] / (double)count;
      if (speed > 0) heading[k] += velocity[k] / speed;
    }
    if (speed > 0) ++flying;
  }
  for (size_t i = 0; i < count; ++i) {
    const double* p = poses[i].location;
    sum += length((double[3]){p[0] - center[0], p[1] - center[1], p[2] - center[2]});
  }
  look->spread = count ? sum / (double)count : 0;
  look->order = flying ? length(heading) / (double)flying : 0;

  /* What the host cannot see from outside, it asks the controller for. */
  breve_value landed;
  status = breve_object_call(world, breve_world_controller(world), "get-landed-count", NULL, 0, &landed);
  if (status == BREVE_OK) look->landed = landed.as.integer;
  return status;
}

static int run(breve_world* world, int frames) {
  double total = 0, worst = 0;
  printf("%7s %9s %9s %7s %7s %12s\n", "frame", "time", "spread", "order", "landed", "frame time");
  for (int frame = 1; frame <= frames; ++frame) {
    const double start = seconds_now();
    if (breve_world_step(world) != BREVE_OK) return fail("a step", breve_world_last_error(world));
    const double spent = seconds_now() - start;
    total += spent;
    if (spent > worst) worst = spent;
    if (frame % 60 != 0 && frame != frames) continue;
    Look look;
    if (look_at_flock(world, &look) != BREVE_OK) return fail("looking", breve_world_last_error(world));
    printf("%7d %7.1f s %9.2f %7.2f %7d %9.3f ms\n", frame, breve_world_time(world), look.spread, look.order,
           look.landed, 1e3 * spent);
  }
  uint64_t hash = 0;
  if (breve_world_hash(world, &hash) != BREVE_OK) return fail("hashing", breve_world_last_error(world));
  printf("\n%d frames, %.1f simulated seconds, in %.2f s: %.3f ms a frame, %.3f ms the longest\n", frames,
         breve_world_time(world), total, 1e3 * total / frames, 1e3 * worst);
  printf("hash %016llx\n", (unsigned long long)hash);
  return EXIT_SUCCESS;
}

int main(int argc, char** argv) {
  const char* file = argc > 1 ? argv[1] : "samples/worlds/flock.tz";
  const int frames = argc > 2 ? atoi(argv[2]) : 600;
  if (frames < 1) {
    fprintf(stderr, "usage: %s [FILE.tz [FRAMES]]\n", argv[0]);
    return 2;
  }

  breve_runtime_config config = breve_runtime_config_default();
  config.print = speak;
  config.resolve_module = read_module;
  config.release_module = release_module;

  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  int result = EXIT_FAILURE;
  if (breve_runtime_create(&config, &runtime) != BREVE_OK)
    fprintf(stderr, "flock: no runtime\n");
  else if (breve_program_load(runtime, file, &program) != BREVE_OK)
    fail(file, breve_runtime_last_error(runtime));
  else if (breve_world_create(runtime, program, NULL, &world) != BREVE_OK)
    fail("making a world", breve_runtime_last_error(runtime));
  else
    result = run(world, frames);

  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return result;
}
