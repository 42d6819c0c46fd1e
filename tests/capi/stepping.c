/* The clock, steps, advance for game loops, pause, end, seeds, arguments, callbacks during a step. */
#include <stdlib.h>

#include "scene.h"

static void steps_advance_the_clock_by_the_iteration_step(void) {
  scene s;
  if (!scene_open(&s)) return;
  const double step = breve_world_iteration_step(s.world);
  CHECK_NEAR(0.06, step, 1e-15); /* the library's default */
  CHECK(breve_world_time(s.world) == 0);
  for (int i = 0; i < 10; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(breve_world_iteration(s.world) == 10);
  CHECK_NEAR(10 * step, breve_world_time(s.world), 1e-12); /* sums of thirty sub-steps round */
  CHECK(int_of(&s, "count") == 17);
  scene_close(&s);
}

static void configured_steps_replace_the_scripts_own(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.integration_step = 0.005;
  config.iteration_step = 0.01;
  if (!scene_open_text(&s, scene_text, &config)) return;
  CHECK_NEAR(0.01, breve_world_iteration_step(s.world), 0);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_NEAR(0.01, breve_world_time(s.world), 1e-15);
  scene_close(&s);
}

static void advance_runs_whole_iterations_and_keeps_the_rest(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.integration_step = 0.05;
  config.iteration_step = 0.1;
  if (!scene_open_text(&s, scene_text, &config)) return;
  double fraction = -1;
  CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 0.04, &fraction));
  CHECK(breve_world_iteration(s.world) == 0);
  CHECK_NEAR(0.4, fraction, 1e-12);
  CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 0.21, &fraction));
  CHECK(breve_world_iteration(s.world) == 2);
  CHECK_NEAR(0.5, fraction, 1e-12);
  CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 0.05, NULL));
  CHECK(breve_world_iteration(s.world) == 3);
  /* Frames of a tenth of a step lose none to rounding. */
  for (int i = 0; i < 1000; ++i) CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 0.01, &fraction));
  CHECK(breve_world_iteration(s.world) == 103);
  CHECK(fraction >= 0 && fraction < 1);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_advance(s.world, -1, &fraction));
  const double nan = strtod("nan", NULL);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_advance(s.world, nan, &fraction));
  CHECK(breve_world_iteration(s.world) == 103);
  scene_close(&s);
}

static void sixty_frames_of_a_sixtieth_are_one_second(void) {
  const double steps[] = {1.0 / 60, 1.0 / 30, 0.025, 0.2};
  for (int k = 0; k < 4; ++k) {
    scene s;
    breve_world_config config = breve_world_config_default();
    config.iteration_step = steps[k];
    config.integration_step = 0.0125;
    if (!scene_open_text(&s, scene_text, &config)) return;
    for (int i = 0; i < 60; ++i) CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 1.0 / 60, NULL));
    CHECK_NEAR(1.0, breve_world_time(s.world), 1e-9);
    scene_close(&s);
  }
}

/* Neither the controller nor its sub-steps, into which an iteration may not divide, change how long an iteration is. */
static void an_iteration_is_as_long_as_it_was_configured(void) {
  static const char* const controllers[] = {"Control", "PhysicalControl", "PlanarControl"};
  const double steps[] = {1.0 / 60, 1.0 / 30, 0.03};
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 3; ++k) {
      scene s;
      char text[200];
      breve_world_config config = breve_world_config_default();
      config.iteration_step = steps[k];
      snprintf(text, sizeof text, "@use %s.\nController C.\n%s : C {\n  + to iterate: super iterate.\n}\n",
               controllers[c], controllers[c]);
      if (!scene_open_text(&s, text, &config)) return;
      CHECK_NEAR(steps[k], breve_world_iteration_step(s.world), 0);
      for (int i = 0; i < 60; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
      CHECK_NEAR(60 * steps[k], breve_world_time(s.world), 1e-9);
      for (int i = 0; i < 60; ++i) CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 1.0 / 60, NULL));
      /* The rest, which does not fill an iteration, is left. */
      const double advanced = breve_world_time(s.world) - 60 * steps[k];
      CHECK(advanced > 1 - steps[k] && advanced < 1 + 1e-9);
      scene_close(&s);
    }
}

static void the_advance_limit_drops_time_that_cannot_be_caught_up(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.integration_step = 0.1;
  config.iteration_step = 0.1;
  config.advance_limit = 3;
  if (!scene_open_text(&s, scene_text, &config)) return;
  double fraction = -1;
  CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 5.05, &fraction));
  CHECK(breve_world_iteration(s.world) == 3);
  CHECK_NEAR(0.5, fraction, 1e-9);
  scene_close(&s);
}

static void nothing_passes_while_paused(void) {
  scene s;
  if (!scene_open(&s)) return;
  CHECK(!breve_world_paused(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_set_paused(s.world, true));
  CHECK(breve_world_paused(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 1, NULL));
  CHECK(breve_world_iteration(s.world) == 0);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(breve_world_iteration(s.world) == 1);
  CHECK_STATUS(BREVE_OK, breve_world_set_paused(s.world, false));
  CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 0.13, NULL));
  CHECK(breve_world_iteration(s.world) == 3);
  scene_close(&s);
}

static void a_program_can_end_the_simulation(void) {
  scene s;
  if (!scene_open(&s)) return;
  CHECK(!breve_world_ended(s.world));
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "stop", NULL, 0, NULL));
  CHECK(breve_world_ended(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_advance(s.world, 10, NULL));
  CHECK(breve_world_iteration(s.world) == 0);
  scene_close(&s);
}

static void one_seed_gives_one_run(void) {
  scene a, b, c;
  breve_world_config config = breve_world_config_default();
  config.seed = 1234567890123ULL;
  if (!scene_open_text(&a, scene_text, &config) || !scene_open_text(&b, scene_text, &config)) return;
  config.seed = 2;
  if (!scene_open_text(&c, scene_text, &config)) return;
  CHECK(breve_world_seed(a.world) == 1234567890123ULL);
  double x = -1, y = -2, z = -3;
  for (int i = 0; i < 100; ++i) {
    CHECK_STATUS(BREVE_OK, breve_world_draw_random(a.world, &x));
    CHECK_STATUS(BREVE_OK, breve_world_draw_random(b.world, &y));
    CHECK(x == y && x >= 0 && x <= 1);
  }
  CHECK_STATUS(BREVE_OK, breve_world_draw_random(c.world, &z));
  CHECK(x != z);
  scene_close(&a);
  scene_close(&b);
  scene_close(&c);
}

static void scripts_read_their_arguments(void) {
  const char* text =
      "@use Control.\nController Reader.\nControl : Reader {\n  + to init:\n    print (self get-argument-count), "
      "(self get-argument at-index 1).\n}\n";
  const char* arguments[] = {"reader.tz", "first"};
  breve_world_config config = breve_world_config_default();
  scene s;
  config.arguments = arguments;
  config.argument_count = 2;
  if (!scene_open_text(&s, text, &config)) return;
  CHECK_TEXT("2 first\n", s.said.print);
  scene_close(&s);
}

static void the_hosts_pointer_comes_back(void) {
  int mine = 0;
  scene s;
  breve_world_config config = breve_world_config_default();
  config.user = &mine;
  if (!scene_open_text(&s, scene_text, &config)) return;
  CHECK(breve_world_user(s.world) == &mine);
  scene_close(&s);
}

static void a_failing_step_leaves_a_world_that_can_go_on(void) {
  const char* text =
      "@use Control.\n"
      "Controller Shaky.\n"
      "Control : Shaky {\n"
      "  + variables:\n"
      "    turns (int).\n"
      "  + to iterate:\n"
      "    turns += 1.\n"
      "    if turns == 2: die \"second turn\".\n"
      "    super iterate.\n"
      "}\n";
  scene s;
  if (!scene_open_text(&s, text, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(breve_world_last_error(s.world) == NULL);
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_world_step(s.world));
  const breve_error* error = breve_world_last_error(s.world);
  CHECK(error && error->status == BREVE_ERROR_SCRIPT);
  CHECK(error && strstr(error->message, "second turn") != NULL);
  CHECK_TEXT("scene.tz", error ? error->file : NULL);
  CHECK(error && error->line == 8);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "turns") == 3);
  scene_close(&s);
}

/* A step that the control of step sizes would cut into billions is not taken: the guard deals with it, or an error
 * tells. */
static void what_turns_too_fast_for_any_step_ends_soon(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.accuracy = "reference";
  if (!scene_open_text(&s, "@use PhysicalControl.\n@use Link.\nController Spun.\nPhysicalControl : Spun {}\n", &config))
    return;
  breve_geometry brick = breve_geometry_default();
  brick.kind = BREVE_SHAPE_BOX;
  brick.size[1] = 2;
  brick.size[2] = 3;
  breve_object link = {0, 0}, shape = {0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Link", &link));
  CHECK_STATUS(BREVE_OK, breve_shape_create(s.world, &brick, &shape));
  CHECK_STATUS(BREVE_OK, breve_object_set_shape(s.world, link, shape));
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, link, true));
  const double spin[3] = {1e9, 2e9, 3e9};
  CHECK_STATUS(BREVE_OK, breve_object_set_rotational_velocity(s.world, link, spin));
  CHECK_STATUS(BREVE_OK, breve_world_set_guard(s.world, BREVE_GUARD_OFF));
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_world_step(s.world));
  CHECK(strstr(breve_world_last_error(s.world)->message, "too fast") != NULL);
  CHECK_STATUS(BREVE_OK, breve_world_set_guard(s.world, BREVE_GUARD_REST));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_interventions(s.world, NULL, 0, &count));
  CHECK(count > 0);
  scene_close(&s);
}

static void a_failing_init_makes_no_world(void) {
  const char* text = "@use Control.\nController Never.\nControl : Never {\n  + to init:\n    die \"not today\".\n}\n";
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(NULL, &runtime));
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "never.tz", text, strlen(text), &program));
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_world_create(runtime, program, NULL, &world));
  CHECK(world == NULL);
  const breve_error* error = breve_runtime_last_error(runtime);
  CHECK(error && strstr(error->message, "not today") != NULL);
  CHECK(error && error->line == 5);
  CHECK(error && strstr(error->text, "never.tz") != NULL);
  breve_program_destroy(program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

static bool read_nothing(void* handle, void* bytes, size_t size, size_t* got) {
  (void)handle, (void)bytes, (void)size;
  *got = 0;
  return true;
}

static bool open_empty(void* user, breve_world* world, const char* name, breve_file* file, breve_write_fn reason,
                       void* sink) {
  transcript* t = user;
  (void)reason, (void)sink;
  CHECK(world != NULL);
  snprintf(t->error, sizeof t->error, "%s", name);
  file->read = read_nothing;
  return true;
}

static bool run_nothing(void* user, breve_world* world, const char* command, breve_write_fn write, void* sink) {
  transcript* t = user;
  CHECK(world != NULL);
  snprintf(t->error, sizeof t->error, "%s", command);
  write(sink, "part one, ", 10);
  write(sink, "part two", 8);
  return true;
}

static void files_and_commands_are_asked_of_the_host(void) {
  const char* text =
      "@use Control.\nController Asker.\nControl : Asker {\n  + to find: print findFile(\"picture.png\").\n"
      "  + to run: print system(\"date\").\n}\n";
  transcript t;
  memset(&t, 0, sizeof t);
  breve_runtime_config config = breve_runtime_config_default();
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  config.user = &t;
  config.print = remember;
  config.files.user = &t;
  config.files.open_for_reading = open_empty;
  config.system = run_nothing;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &runtime));
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "asker.tz", text, strlen(text), &program));
  CHECK_STATUS(BREVE_OK, breve_world_create(runtime, program, NULL, &world));
  CHECK_STATUS(BREVE_OK, breve_object_call(world, breve_world_controller(world), "find", NULL, 0, NULL));
  CHECK_TEXT("picture.png", t.error);
  CHECK_TEXT("picture.png\n", t.print);
  CHECK_STATUS(BREVE_OK, breve_object_call(world, breve_world_controller(world), "run", NULL, 0, NULL));
  CHECK_TEXT("date", t.error);
  CHECK_TEXT("picture.png\npart one, part two\n", t.print);
  CHECK_STATUS(BREVE_OK, breve_world_destroy(world));
  breve_program_destroy(program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

static void stats_count_objects_bodies_and_errors(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_stats stats = breve_stats_default();
  size_t count = 0, shaped = 0;
  CHECK_STATUS(BREVE_OK, breve_world_objects(s.world, NULL, NULL, 0, &count));
  CHECK_STATUS(BREVE_OK, breve_world_objects(s.world, "Real", NULL, 0, &shaped));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_stats(s.world, &stats));
  CHECK(stats.iterations == 1);
  CHECK_NEAR(0.06, stats.time, 1e-12);
  CHECK(stats.objects == count);
  CHECK(stats.bodies == shaped && shaped == 1);
  CHECK(stats.heap_cells > 0 && stats.memory_used > 0 && stats.memory_peak >= stats.memory_used);
  CHECK(stats.memory_limit == 0 && stats.errors == 0);
  scene_close(&s);
}

static void effects_are_listed_with_reason_and_who_asked(void) {
  scene s;
  if (!scene_open(&s)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  size_t count = 0;
  breve_effect effects[64];
  CHECK_STATUS(BREVE_OK, breve_world_effects(s.world, NULL, 0, &count));
  CHECK(count > 0 && count <= 64);
  CHECK_STATUS(BREVE_OK, breve_world_effects(s.world, effects, 64, &count));
  bool motion = false;
  for (size_t i = 0; i < count; ++i) {
    CHECK(effects[i].name[0] != '\0');
    CHECK(effects[i].active == (effects[i].reason[0] != '\0'));
    if (strcmp(effects[i].name, "motion") == 0) {
      const breve_object ball = ball_of(&s);
      motion = effects[i].active;
      CHECK(effects[i].asked_by.index == ball.index && effects[i].asked_by.generation == ball.generation);
    }
  }
  CHECK(motion); /* the ball has a velocity */
  scene_close(&s);
}

void stepping_suite(void) {
  RUN(steps_advance_the_clock_by_the_iteration_step);
  RUN(configured_steps_replace_the_scripts_own);
  RUN(advance_runs_whole_iterations_and_keeps_the_rest);
  RUN(sixty_frames_of_a_sixtieth_are_one_second);
  RUN(an_iteration_is_as_long_as_it_was_configured);
  RUN(the_advance_limit_drops_time_that_cannot_be_caught_up);
  RUN(nothing_passes_while_paused);
  RUN(a_program_can_end_the_simulation);
  RUN(one_seed_gives_one_run);
  RUN(scripts_read_their_arguments);
  RUN(the_hosts_pointer_comes_back);
  RUN(a_failing_step_leaves_a_world_that_can_go_on);
  RUN(what_turns_too_fast_for_any_step_ends_soon);
  RUN(a_failing_init_makes_no_world);
  RUN(files_and_commands_are_asked_of_the_host);
  RUN(stats_count_objects_bodies_and_errors);
  RUN(effects_are_listed_with_reason_and_who_asked);
}
