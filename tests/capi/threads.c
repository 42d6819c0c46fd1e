/* Two threads at once, as a trainer with many worlds has them: what each sees is what a run alone sees. Under
 * ThreadSanitizer the same runs show that nothing is shared that must not be. */
#include <inttypes.h>
#include <pthread.h>

#include "check.h"

enum { kThreads = 2, kSteps = 40 };

/* It takes part in everything that could be shared by mistake: random numbers, shapes, neighbours, handlers at the time
 * of impact, schedule, lists, hashes, strings, methods called by name, agents that come and go, errors in handlers. */
static const char* const crowd_text =
    "@use Control.\n"
    "@use Mobile.\n"
    "@use Shape.\n"
    "Controller Square.\n"
    "Control : Square {\n"
    "  + variables:\n"
    "    agents, heard (list).\n"
    "    names (hash).\n"
    "    ball (object).\n"
    "    meetings (int).\n"
    "  + to init:\n"
    "    ball = (new Sphere init-with radius 0.4).\n"
    "    agents = 40 new Walkers.\n"
    "    agents set-shape to ball.\n"
    "    self schedule-repeating method-call \"tell\" with-interval 0.2.\n"
    "  + to iterate:\n"
    "    agent (object).\n"
    "    self update-neighbors.\n"
    "    super iterate.\n"
    "    agent = agents{random[(|agents| - 1)]}.\n"
    "    names{\"walker $meetings\"} = |(agent get-neighbors)|.\n"
    "    if |heard| > 20: heard = { }.\n"
    "  + to tell:\n"
    "    push \"met $meetings\" onto heard.\n"
    "    print heard, names.\n"
    "    free (agents{0}).\n"
    "    agents{0} = (new Walker).\n"
    "    (agents{0}) set-shape to ball.\n"
    "    (agents{0}) call-method named \"hurry\".\n"
    "  + to meet:\n"
    "    meetings++.\n"
    "  + to fail:\n"
    "    die \"on purpose\".\n"
    "}\n"
    "Mobile : Walker (aka Walkers) {\n"
    "  + to init:\n"
    "    self move to random[(10, 10, 2)].\n"
    "    self set-velocity to random[(4, 4, 0)] - (2, 2, 0).\n"
    "    self set-neighborhood-size to 3.0.\n"
    "    self handle-collisions with-type \"Walker\" with-method \"bump\".\n"
    "  + to hurry:\n"
    "    self set-velocity to 2 * (self get-velocity).\n"
    "  + to bump with other (object):\n"
    "    controller meet.\n"
    "    self set-velocity to -(self get-velocity).\n"
    "}\n";

/* What one thread is given and what it found. Only its own thread touches it until it is joined. */
typedef struct task {
  breve_runtime* runtime; /* NULL: the thread makes its own, and a program in it */
  breve_program* program;
  breve_world* world; /* NULL: the thread makes its own */
  uint64_t seed;
  breve_status status;
  uint64_t hash;
  size_t printed;
  bool error_is_mine;
} task;

static void count_prints(void* user, breve_world* world, breve_channel channel, const char* text, size_t size) {
  (void)world, (void)text;
  if (channel == BREVE_CHANNEL_PRINT) *(size_t*)user += size;
}

static breve_status make_world(breve_runtime* runtime, const breve_program* program, uint64_t seed,
                               breve_world** world) {
  breve_world_config config = breve_world_config_default();
  config.seed = seed;
  return breve_world_create(runtime, program, &config, world);
}

/* Steps the world, then fails in it: the text of the error must be of this world. */
static breve_status run_world(task* t) {
  breve_status status = BREVE_OK;
  for (int i = 0; i < kSteps && status == BREVE_OK; ++i) status = breve_world_step(t->world);
  if (status == BREVE_OK) status = breve_world_hash(t->world, &t->hash);
  if (status != BREVE_OK) return status;
  breve_value none;
  const breve_status failed = breve_object_call(t->world, breve_world_controller(t->world), "fail", NULL, 0, &none);
  const breve_error* error = breve_world_last_error(t->world);
  t->error_is_mine = failed == BREVE_ERROR_SCRIPT && error && strstr(error->text, "on purpose") != NULL;
  return BREVE_OK;
}

static void* run_task(void* argument) {
  task* t = argument;
  breve_runtime* own_runtime = NULL;
  breve_program* own_program = NULL;
  t->status = BREVE_OK;
  if (!t->runtime) {
    breve_runtime_config config = breve_runtime_config_default();
    config.user = &t->printed;
    config.print = count_prints;
    t->status = breve_runtime_create(&config, &own_runtime);
    if (t->status == BREVE_OK)
      t->status = breve_program_compile(own_runtime, "crowd.tz", crowd_text, strlen(crowd_text), &own_program);
    if (t->status == BREVE_OK) t->status = make_world(own_runtime, own_program, t->seed, &t->world);
  }
  if (t->status == BREVE_OK) t->status = run_world(t);
  breve_world_destroy(t->world);
  breve_program_destroy(own_program);
  breve_runtime_destroy(own_runtime);
  t->world = NULL;
  return NULL;
}

static void run_at_once(task tasks[kThreads]) {
  pthread_t threads[kThreads];
  int started = 0;
  while (started < kThreads && CHECK(pthread_create(&threads[started], NULL, run_task, &tasks[started]) == 0))
    ++started;
  for (int i = 0; i < started; ++i) CHECK(pthread_join(threads[i], NULL) == 0);
}

/* The same seed, alone: what the threads must find. */
static task run_alone(uint64_t seed) {
  task t = {.seed = seed};
  run_task(&t);
  CHECK_STATUS(BREVE_OK, t.status);
  CHECK(t.printed > 0);
  CHECK(t.error_is_mine);
  return t;
}

static void check_as_alone(const task* t) {
  const task alone = run_alone(t->seed);
  CHECK_STATUS(BREVE_OK, t->status);
  CHECK(t->hash == alone.hash);
  CHECK(t->error_is_mine);
}

static void two_runtimes_share_nothing(void) {
  task tasks[kThreads] = {{.seed = 1}, {.seed = 2}};
  run_at_once(tasks);
  for (int i = 0; i < kThreads; ++i) {
    check_as_alone(&tasks[i]);
    CHECK(tasks[i].printed > 0);
  }
  CHECK(tasks[0].hash != tasks[1].hash);
}

static void two_worlds_of_one_program_run_on_two_threads(void) {
  task tasks[kThreads] = {{.seed = 1}, {.seed = 2}};
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  if (!CHECK_STATUS(BREVE_OK, breve_runtime_create(NULL, &runtime))) return;
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "crowd.tz", crowd_text, strlen(crowd_text), &program));
  for (int i = 0; i < kThreads; ++i) {
    tasks[i].runtime = runtime;
    tasks[i].program = program;
    CHECK_STATUS(BREVE_OK, make_world(runtime, program, tasks[i].seed, &tasks[i].world));
  }
  run_at_once(tasks);
  for (int i = 0; i < kThreads; ++i) check_as_alone(&tasks[i]);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
}

/* Many islands, and some that meet. */
static const char* const heaps_text =
    "@use PhysicalControl.\n@use Mobile.\n@use Stationary.\n@use Shape.\nController Heaps.\n"
    "PhysicalControl : Heaps { + variables: block, piece (object). i (int).\n"
    "  + to init:\n    new Floor.\n    block = (new Cube init-with size (1, 1, 1)).\n"
    "    for i = 0, i < 60, i++: {\n      piece = new Mobile. piece set-shape to block. piece enable-physics.\n"
    "      piece move to (3 * (i % 20), 1 + 1.2 * (i / 20), random[0.5]).\n    }\n"
    "  + to fail:\n    die \"on purpose\".\n}\n";

static breve_world* make_heaps(breve_runtime* runtime, const breve_program* program, uint32_t workers) {
  breve_world* world = NULL;
  if (!CHECK_STATUS(BREVE_OK, make_world(runtime, program, 3, &world))) return NULL;
  CHECK_STATUS(BREVE_OK, breve_world_set_workers(world, workers));
  return world;
}

/* The worlds of a runtime have their workers in common: different numbers of them, asked for at once. */
static void worlds_share_the_workers_of_their_runtime(void) {
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  if (!CHECK_STATUS(BREVE_OK, breve_runtime_create(NULL, &runtime))) return;
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "heaps.tz", heaps_text, strlen(heaps_text), &program));
  task alone = {.runtime = runtime, .program = program, .world = make_heaps(runtime, program, 1)};
  run_task(&alone);
  CHECK_STATUS(BREVE_OK, alone.status);
  task tasks[kThreads] = {{.runtime = runtime, .program = program}, {.runtime = runtime, .program = program}};
  for (uint32_t i = 0; i < kThreads; ++i) tasks[i].world = make_heaps(runtime, program, 2 + i);
  run_at_once(tasks);
  for (int i = 0; i < kThreads; ++i) {
    CHECK_STATUS(BREVE_OK, tasks[i].status);
    CHECK(tasks[i].hash == alone.hash);
  }
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
}

void threads_suite(void);
void threads_suite(void) {
  RUN(two_runtimes_share_nothing);
  RUN(two_worlds_of_one_program_run_on_two_threads);
  RUN(worlds_share_the_workers_of_their_runtime);
}
