/* Many worlds at once: the same outcomes whatever runs them. */
#include <pthread.h>
#include <stdlib.h>

#include "scene.h"

enum { kWorlds = 24 };

static const char* const wanderers =
    "@use Control.\n@use Mobile.\nController Main.\n"
    "Mobile : Bird (aka Birds) {\n"
    "  + to init:\n    self move to random[(10, 10, 10)].\n    self set-velocity to random[(2, 2, 2)] - (1, 1, 1).\n"
    "  + to iterate:\n    if random[5] == 0: self set-velocity to random[(2, 2, 2)] - (1, 1, 1).\n"
    "}\n"
    "Control : Main {\n"
    "  + variables:\n    turns, most, extra (int).\n"
    "  + to init:\n    most = 1000.\n    20 new Birds.\n"
    "    if getArgc() > 1: extra = getArgv(1).\n    if extra == 13: die \"unlucky\".\n"
    "  + to iterate:\n    turns++.\n    if turns == most: self end-simulation.\n"
    "    if extra == 7 && turns == 3: die \"on purpose\".\n    super iterate.\n"
    "}\n";

typedef struct run {
  breve_batch batch;
  breve_outcome outcomes[kWorlds];
  pthread_mutex_t lock;
  int prepared, begun, ended, unmade;
  char arguments[kWorlds][8];
  const char* lists[kWorlds][2];
  size_t stop_after;
  int failures;
  char unmade_reason[80], failed_reason[80]; /* of worlds 13 and 7 */
} run;

static void failed(void* user, size_t index, const breve_error* error) {
  run* r = user;
  pthread_mutex_lock(&r->lock);
  ++r->failures;
  if (index == 13)
    snprintf(r->unmade_reason, sizeof r->unmade_reason, "%s:%u: %s", error->file, error->line, error->message);
  if (index == 7) snprintf(r->failed_reason, sizeof r->failed_reason, "%s", error->message);
  pthread_mutex_unlock(&r->lock);
}

static void prepare(void* user, size_t index, breve_world_config* config) {
  run* r = user;
  CHECK(config->seed == 5 + index);
  sprintf(r->arguments[index], "%d", (int)index);
  r->lists[index][0] = "program";
  r->lists[index][1] = r->arguments[index];
  config->arguments = r->lists[index];
  config->argument_count = 2;
  pthread_mutex_lock(&r->lock);
  ++r->prepared;
  pthread_mutex_unlock(&r->lock);
}

static bool begin(void* user, size_t index, breve_world* world) {
  run* r = user;
  const breve_value most = breve_value_int(index == 3 ? 2 : 1000);
  CHECK_STATUS(BREVE_OK, breve_object_set(world, breve_world_controller(world), "most", &most));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_destroy(world));
  pthread_mutex_lock(&r->lock);
  ++r->begun;
  pthread_mutex_unlock(&r->lock);
  return index != 4;
}

static bool end(void* user, size_t index, breve_world* world, const breve_outcome* outcome) {
  run* r = user;
  uint64_t hash = 0;
  if (world) CHECK_STATUS(BREVE_OK, breve_world_hash(world, &hash));
  CHECK(hash == outcome->hash);
  if (outcome->status == BREVE_ERROR_SCRIPT && world)
    CHECK(strstr(breve_world_last_error(world)->text, "on purpose") != NULL);
  if (world) CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_destroy(world));
  pthread_mutex_lock(&r->lock);
  ++r->ended;
  r->unmade += world == NULL;
  pthread_mutex_unlock(&r->lock);
  return index != r->stop_after;
}

static run* new_run(void) {
  run* r = calloc(1, sizeof *r);
  pthread_mutex_init(&r->lock, NULL);
  r->batch = breve_batch_default();
  r->batch.count = kWorlds;
  r->batch.iterations = 10;
  r->batch.first_seed = 5;
  r->batch.hashes = true;
  r->batch.user = r;
  r->batch.prepare = prepare;
  r->batch.begin = begin;
  r->batch.end = end;
  r->batch.failed = failed;
  r->stop_after = kWorlds;
  return r;
}

/* A host's own threads: two, which take jobs from a list. */
typedef struct pool {
  pthread_mutex_t lock;
  struct {
    void (*run)(void* job);
    void* job;
  } jobs[kWorlds];
  size_t count, next;
} pool;

static void* work(void* user) {
  pool* p = user;
  for (;;) {
    pthread_mutex_lock(&p->lock);
    const size_t mine = p->next++;
    pthread_mutex_unlock(&p->lock);
    if (mine >= p->count) return NULL;
    p->jobs[mine].run(p->jobs[mine].job);
  }
}
static void enqueue(void* user, void (*run)(void* job), void* job) {
  pool* p = user;
  p->jobs[p->count].run = run;
  p->jobs[p->count++].job = job;
}
static void wait_for_all(void* user) {
  pthread_t threads[2];
  for (int i = 0; i < 2; ++i) pthread_create(&threads[i], NULL, work, user);
  for (int i = 0; i < 2; ++i) pthread_join(threads[i], NULL);
}

static void outcomes_do_not_depend_on_who_runs_the_worlds(void) {
  scene s;
  if (!scene_open_text(&s, wanderers, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_destroy(s.world));
  s.world = NULL;
  run* runs[4];
  static pool threads;
  pthread_mutex_init(&threads.lock, NULL);
  for (int i = 0; i < 4; ++i) {
    runs[i] = new_run();
    runs[i]->batch.workers = i == 1 ? 2 : i == 2 ? 0 : 1;
    if (i == 3) {
      runs[i]->batch.jobs.user = &threads;
      runs[i]->batch.jobs.enqueue = enqueue;
      runs[i]->batch.jobs.wait = wait_for_all;
    }
    CHECK_STATUS(BREVE_OK, breve_batch_run(s.runtime, s.program, &runs[i]->batch, runs[i]->outcomes));
    CHECK(runs[i]->prepared == kWorlds && runs[i]->ended == kWorlds && runs[i]->unmade == 1);
    CHECK(runs[i]->begun == kWorlds - 1);
    CHECK(runs[i]->failures == 2 && strstr(runs[i]->unmade_reason, "unlucky") != NULL);
    CHECK_TEXT("on purpose", runs[i]->failed_reason);
    CHECK(memcmp(runs[0]->outcomes, runs[i]->outcomes, sizeof runs[0]->outcomes) == 0);
  }
  const breve_outcome* all = runs[0]->outcomes;
  CHECK(all[0].status == BREVE_OK && all[0].iterations == 10 && all[0].hash != 0);
  CHECK_NEAR(10 * 0.06, all[0].time, 1e-9);
  CHECK(all[3].status == BREVE_OK && all[3].iterations == 2);
  CHECK(all[4].status == BREVE_OK && all[4].iterations == 0);
  CHECK(all[7].status == BREVE_ERROR_SCRIPT && all[7].iterations == 2);
  CHECK(all[13].status == BREVE_ERROR_SCRIPT && all[13].iterations == 0 && all[13].hash == 0);
  for (int i = 1; i < kWorlds; ++i) CHECK(all[i].hash != all[i - 1].hash);
  /* One world of the batch, made alone. */
  breve_world_config config = breve_world_config_default();
  const char* arguments[] = {"program", "20"};
  uint64_t hash = 0;
  config.seed = 25;
  config.arguments = arguments;
  config.argument_count = 2;
  CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, &config, &s.world));
  for (int i = 0; i < 10; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &hash));
  CHECK(hash == all[20].hash);
  for (int i = 0; i < 4; ++i) free(runs[i]);
  scene_close(&s);
}

static void a_callback_ends_the_batch(void) {
  scene s;
  if (!scene_open_text(&s, wanderers, NULL)) return;
  run* r = new_run();
  r->batch.workers = 1;
  r->stop_after = 2;
  CHECK_STATUS(BREVE_OK, breve_batch_run(s.runtime, s.program, &r->batch, r->outcomes));
  CHECK(r->ended == 3 && r->outcomes[2].status == BREVE_OK && r->outcomes[3].status == BREVE_ERROR_INTERRUPTED);
  free(r);
  scene_close(&s);
}

static void bad_batches_are_refused(void) {
  scene s;
  if (!scene_open_text(&s, wanderers, NULL)) return;
  breve_batch batch = breve_batch_default();
  breve_world_config config = breve_world_config_default();
  CHECK_STATUS(BREVE_OK, breve_batch_run(s.runtime, s.program, &batch, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_batch_run(NULL, s.program, &batch, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_batch_run(s.runtime, NULL, &batch, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_batch_run(s.runtime, s.program, NULL, NULL));
  batch.workers = 257;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_batch_run(s.runtime, s.program, &batch, NULL));
  batch.workers = 0, batch.reserved[0] = true;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_batch_run(s.runtime, s.program, &batch, NULL));
  batch.reserved[0] = false, batch.jobs.enqueue = enqueue;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_batch_run(s.runtime, s.program, &batch, NULL));
  batch.jobs.enqueue = NULL, batch.struct_size = 1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_batch_run(s.runtime, s.program, &batch, NULL));
  batch = breve_batch_default();
  batch.config = &config;
  config.iteration_step = -1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_batch_run(s.runtime, s.program, &batch, NULL));
  scene_close(&s);
}

void batch_suite(void) {
  RUN(outcomes_do_not_depend_on_who_runs_the_worlds);
  RUN(a_callback_ends_the_batch);
  RUN(bad_batches_are_refused);
}
