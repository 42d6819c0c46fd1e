/* The budget of physics: the functions and reports for a host; interrupts within a step. */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <time.h>

#include "scene.h"

/* A body whose step is so short that an iteration takes forever. */
static const char* const kSlow =
    "@use PhysicalControl.\n@use Mobile.\nController Lab.\n"
    "PhysicalControl : Lab {\n"
    "  + to init:\n    (new Mobile) enable-physics.\n"
    "    self set-accuracy to \"precise\".\n    self set-accuracy-setting named \"step\" to 1.0e-11.\n"
    "}\n";

static uint64_t work_of(const breve_world* world) {
  breve_physics_counters counters = breve_physics_counters_default();
  CHECK_STATUS(BREVE_OK, breve_world_physics_counters(world, &counters));
  return counters.work;
}

static size_t finished(const breve_world* world) {
  breve_intervention all[64];
  size_t count = 0, told = 0;
  CHECK_STATUS(BREVE_OK, breve_world_interventions(world, all, 64, &count));
  for (size_t i = 0; i < count && i < 64; ++i) {
    if (strcmp(all[i].action, "finished coarsely") != 0) continue;
    CHECK_TEXT("the work budget of the step is used up", all[i].reason);
    ++told;
  }
  return told;
}

static void a_step_takes_what_it_may(void) {
  breve_world_config config = breve_world_config_default();
  config.physics_budget = 100000;
  scene s;
  if (!scene_open_text(&s, kSlow, &config)) return;
  for (int i = 0; i < 3; ++i) {
    CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    CHECK(work_of(s.world) >= 90000 && work_of(s.world) <= 110000);
    CHECK(finished(s.world) != 0);
  }
  /* Another machine is put in the world's place, with the same budget. */
  static char image[1 << 20];
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, sizeof image, &size));
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(work_of(s.world) <= 110000);
  scene_close(&s);
}

static void who_bounds_the_script_bounds_its_physics(void) {
  breve_world_config config = breve_world_config_default();
  config.budget = 1000;
  scene s;
  if (!scene_open_text(&s, kSlow, &config)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(finished(s.world) != 0);
  CHECK(work_of(s.world) >= 900000 && work_of(s.world) <= 1100000);
  scene_close(&s);
}

/* Late enough for the step to have begun its physics, even on a busy machine. */
static void* interrupt_later(void* world) {
  for (int i = 0; i < 10; ++i) {
    const struct timespec pause = {0, 100000000};
    nanosleep(&pause, NULL);
    breve_world_interrupt(world);
  }
  return NULL;
}

static void an_interrupt_ends_a_step(void) {
  scene s;
  if (!scene_open_text(&s, kSlow, NULL)) return;
  pthread_t other;
  CHECK(pthread_create(&other, NULL, interrupt_later, s.world) == 0);
  CHECK_STATUS(BREVE_ERROR_INTERRUPTED, breve_world_step(s.world));
  pthread_join(other, NULL);
  CHECK(finished(s.world) != 0);
  scene_close(&s);
}

/* Discs in one place, of which Box2D would pair each with each: for minutes, in memory of its own. */
static const char* const kCrowd =
    "@use PlanarControl.\n@use Mobile.\nController A.\n"
    "PlanarControl : A { + to init:\n    (5000 new Mobiles) enable-physics.\n}\n";

static void a_flat_crowd_is_refused_before_it_is_paired(void) {
  breve_world_config config = breve_world_config_default();
  config.physics_budget = 1000000;
  scene s;
  if (!scene_open_text(&s, kCrowd, &config)) return;
  for (int i = 0; i < 2; ++i) {
    CHECK_STATUS(BREVE_ERROR_BUDGET, breve_world_step(s.world));
    CHECK(strstr(breve_world_last_error(s.world)->text, "physics budget of 1000000") != NULL);
  }
  scene_close(&s);
}

static void a_flat_crowd_stays_within_the_worlds_memory(void) {
  breve_world_config config = breve_world_config_default();
  config.memory_limit = (size_t)256 << 20;
  scene s;
  if (!scene_open_text(&s, kCrowd, &config)) return;
  for (int i = 0; i < 2; ++i) CHECK_STATUS(BREVE_ERROR_MEMORY, breve_world_step(s.world));
  scene_close(&s);
}

/* The same in space: to solve what each pair does to the others would take seconds. Put apart, they go on. */
static void a_crowd_in_space_is_refused_until_it_is_put_apart(void) {
  breve_world_config config = breve_world_config_default();
  config.budget = 1000000;
  scene s;
  if (!scene_open_text(&s,
                       "@use PhysicalControl.\n@use Mobile.\nController A.\n"
                       "PhysicalControl : A {\n  + to init:\n    (500 new Mobiles) enable-physics.\n"
                       "  + to spread:\n    i (int).\n"
                       "    for i = 0, i < 500, i++: (all Mobiles){i} move to (3 * i, 0, 0).\n}\n",
                       &config))
    return;
  for (int i = 0; i < 2; ++i) {
    CHECK_STATUS(BREVE_ERROR_BUDGET, breve_world_step(s.world));
    CHECK(strstr(breve_world_last_error(s.world)->text, "8000 pairs") != NULL);
  }
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "spread", NULL, 0, NULL));
  for (int i = 0; i < 2; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  scene_close(&s);
}

/* A budget that is less than usual makes steps coarse: it does not refuse steps that are done soon. */
static void a_small_budget_refuses_no_small_crowd(void) {
  static const char* const kinds[] = {"PhysicalControl", "PlanarControl"};
  for (int kind = 0; kind < 2; ++kind) {
    char text[300];
    snprintf(text, sizeof text,
             "@use %s.\n@use Mobile.\nController A.\n%s : A { + to init:\n    (100 new Mobiles) enable-physics.\n}\n",
             kinds[kind], kinds[kind]);
    breve_world_config config = breve_world_config_default();
    config.physics_budget = 1000;
    scene s;
    if (!scene_open_text(&s, text, &config)) continue;
    for (int i = 0; i < 2; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    scene_close(&s);
  }
}

/* Bodies in one place that physics does not move: each meets each, and a handler is called for both. */
static const char* const kHandled =
    "@use Control.\n@use Mobile.\nController A.\n"
    "Mobile : Dust { + to init:\n    self handle-collisions with-type \"Dust\" with-method \"meet\".\n"
    "    self set-velocity to (1, 0, 0).\n  + to meet with other (object):\n    0.\n}\n"
    "Control : A { + to init:\n    5000 new Dust.\n}\n";

static void a_crowd_that_handlers_meet_ends_with_the_budget(void) {
  breve_world_config config = breve_world_config_default();
  config.budget = 1000000;
  scene s;
  if (!scene_open_text(&s, kHandled, &config)) return;
  breve_effect effects[32];
  for (int i = 0; i < 2; ++i) {
    CHECK_STATUS(BREVE_ERROR_BUDGET, breve_world_step(s.world));
    size_t count = 0;
    CHECK_STATUS(BREVE_OK, breve_world_effects(s.world, effects, 32, &count));
    for (size_t k = 0; k < count && k < 32; ++k) {
      /* Not all of twelve million pairs were found before. */
      if (strcmp(effects[k].name, "collision") == 0) CHECK(effects[k].bytes < ((uint64_t)64 << 20));
    }
  }
  scene_close(&s);
}

void physics_budget_suite(void) {
  RUN(a_step_takes_what_it_may);
  RUN(who_bounds_the_script_bounds_its_physics);
  RUN(an_interrupt_ends_a_step);
  RUN(a_flat_crowd_is_refused_before_it_is_paired);
  RUN(a_flat_crowd_stays_within_the_worlds_memory);
  RUN(a_crowd_in_space_is_refused_until_it_is_put_apart);
  RUN(a_small_budget_refuses_no_small_crowd);
  RUN(a_crowd_that_handlers_meet_ends_with_the_budget);
}
