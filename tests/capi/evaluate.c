/* Statements typed in: values, session variables, errors, nesting, interrupts. */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stdlib.h>
#include <time.h>

#include "scene.h"

static breve_status run(breve_world* world, const char* text, breve_value* value) {
  const breve_object nobody = {0, 0};
  return breve_world_evaluate(world, nobody, text, strlen(text), value);
}

static int int_from(breve_world* world, const char* text) {
  breve_value v = breve_value_null();
  CHECK_STATUS(BREVE_OK, run(world, text, &v));
  check_that(v.type == BREVE_TYPE_INT, text, __FILE__, __LINE__);
  return v.type == BREVE_TYPE_INT ? v.as.integer : -999;
}

static bool says(breve_world* world, const char* part) {
  const breve_error* error = breve_world_last_error(world);
  if (error && strstr(error->text, part)) return true;
  printf("not in the text: %s\n%s\n", part, error ? error->text : "(none)");
  return false;
}

static void a_bare_expression_gives_its_value(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_value v;
  CHECK(int_from(s.world, "2 + 3") == 5);
  CHECK(int_from(s.world, "2 + 3.") == 5);
  CHECK(int_from(s.world, "  count + 1 # and a comment") == 8);
  CHECK(int_from(s.world, "(self add first 2)") == 12 && int_from(s.world, "self add first 2 second 3.") == 5);
  CHECK(int_from(s.world, "return 4.") == 4);
  CHECK_STATUS(BREVE_OK, run(s.world, "name + \"!\"", &v));
  CHECK(v.type == BREVE_TYPE_STRING);
  CHECK_TEXT("stage!", v.as.string.bytes);
  CHECK_STATUS(BREVE_OK, run(s.world, "where * 2", &v));
  CHECK(v.type == BREVE_TYPE_VECTOR && v.as.vector[2] == 6);
  static const char* const valueless[] = {"", " ", "# only words", "print 1.", "if count: count.", "while 0: count."};
  for (size_t i = 0; i < sizeof valueless / sizeof *valueless; ++i) {
    CHECK_STATUS(BREVE_OK, run(s.world, valueless[i], &v));
    check_that(v.type == BREVE_TYPE_NULL, valueless[i], __FILE__, __LINE__);
  }
  CHECK_STATUS(BREVE_OK, breve_world_evaluate(s.world, (breve_object){0, 0}, NULL, 0, NULL));
  CHECK_TEXT("1\n", s.said.print);
  scene_close(&s);
}

static void statements_stand_in_a_method_of_the_object(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_value v;
  const breve_object ball = ball_of(&s);
  CHECK_STATUS(BREVE_OK, run(s.world, "count = 12. level = count + 1. things{0} = 9. grid[1] = 4.", NULL));
  CHECK(int_of(&s, "count") == 12 && value_of(&s, "level").as.number == 13.0);
  CHECK(int_from(s.world, "things{0} + grid[1]") == 13);
  CHECK_STATUS(BREVE_OK, breve_world_evaluate(s.world, ball, "self", 4, &v));
  CHECK(v.type == BREVE_TYPE_OBJECT && v.as.object.index == ball.index);
  CHECK_STATUS(BREVE_OK, breve_world_evaluate(s.world, ball, "self move to (1, 2, 3)", 22, NULL));
  breve_pose pose;
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, ball, &pose));
  CHECK(pose.location[1] == 2);
  CHECK_STATUS(BREVE_ERROR_COMPILE, breve_world_evaluate(s.world, ball, "count", 5, NULL));
  scene_close(&s);
}

static void assigned_names_live_in_the_session(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object ball = ball_of(&s);
  breve_value v;
  CHECK(int_from(s.world, "x = 5") == 5);
  CHECK_STATUS(BREVE_OK, breve_world_evaluate(s.world, ball, "x + 1", 5, &v));
  CHECK(v.as.integer == 6);
  CHECK(int_from(s.world, "x += 2. x++. x") == 8);
  CHECK_STATUS(BREVE_OK, run(s.world, "x = \"now a text\"", NULL)); /* of any type */
  CHECK_STATUS(BREVE_OK, run(s.world, "z = { 8 }. print \"$x, $z{0}, ${count}\".", NULL));
  CHECK_TEXT("now a text, 8, 7\n", s.said.print);
  CHECK(int_from(s.world, "k = { 1, 2, 3 }. t = 0. foreach e in k: t += e. t") == 6);
  CHECK(int_from(s.world, "e") == 3);
  CHECK(int_from(s.world, "push 4 onto k. k{3} = 5. |k|") == 4);
  CHECK(int_from(s.world, "v = (1, 2, 3). v::y = 7. v{0} = 4. |v::y + v::x - 11.0| < 0.001") == 1);
  CHECK(int_from(s.world, "for i = 0, i < 10, i++: t = i. t") == 9);
  CHECK_STATUS(BREVE_OK, run(s.world, "n = (new Ball)", &v));
  CHECK(v.type == BREVE_TYPE_OBJECT);
  CHECK_STATUS(BREVE_OK, run(s.world, "n set-velocity to (1, 0, 0). n::hits = 3. free n.", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_session(s.world, &v));
  size_t size = 0;
  breve_value key = breve_value_string("t"), held;
  CHECK_STATUS(BREVE_OK, breve_hash_size(s.world, &v, &size));
  CHECK(size == 8);
  CHECK_STATUS(BREVE_OK, breve_hash_get(s.world, &v, &key, &held));
  CHECK(held.as.integer == 9);
  held = breve_value_int(77);
  CHECK_STATUS(BREVE_OK, breve_hash_set(s.world, &v, &key, &held));
  CHECK(int_from(s.world, "t") == 77);
  scene_close(&s);
}

static void session_variables_keep_what_they_hold_alive(void) {
  scene s;
  if (!scene_open(&s)) return;
  CHECK_STATUS(BREVE_OK, run(s.world, "keep = { { 1, 2 }, \"te\" + \"xt\" }. push keep onto keep.", NULL));
  for (int i = 0; i < 20; ++i) {
    CHECK_STATUS(BREVE_OK, run(s.world, "g = { }. push g onto g. g = 0.", NULL)); /* cycles for the collector */
    CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  }
  CHECK(int_from(s.world, "keep{0}{1}") == 2);
  CHECK(int_from(s.world, "keep{1} == \"text\"") == 1);
  scene_close(&s);
}

static void what_does_not_compile_is_told_and_changes_nothing(void) {
  scene s;
  if (!scene_open(&s)) return;
  CHECK_STATUS(BREVE_ERROR_COMPILE, run(s.world, "count = 1. zqz + 1.\nzqw.", NULL));
  const breve_error* error = breve_world_last_error(s.world);
  CHECK_TEXT("input", error->file);
  CHECK(error->line == 1 && error->column == 12);
  CHECK(says(s.world, "input:1:12: error: unknown variable 'zqz'") && says(s.world, "input:2:1: error:"));
  CHECK(says(s.world, "zqz = 1."));
  CHECK(int_of(&s, "count") == 7);
  CHECK_STATUS(BREVE_ERROR_COMPILE, run(s.world, "coun", NULL));
  CHECK(says(s.world, "did you mean 'count'?"));
  CHECK_STATUS(BREVE_OK, run(s.world, "counter = 1.", NULL));
  CHECK_STATUS(BREVE_ERROR_COMPILE, run(s.world, "counte", NULL));
  CHECK(says(s.world, "did you mean 'count"));
  CHECK_STATUS(BREVE_ERROR_COMPILE, run(s.world, "new Nothing", NULL));
  CHECK(says(s.world, "unknown class 'Nothing'"));
  CHECK_STATUS(BREVE_ERROR_COMPILE, run(s.world, "new Wanderer", NULL));
  CHECK(says(s.world, "@use Wanderer."));
  CHECK_STATUS(BREVE_ERROR_COMPILE, run(s.world, "1 +", NULL));
  CHECK_STATUS(BREVE_ERROR_COMPILE, run(s.world, "}{ ) \" #!", NULL));
  CHECK_STATUS(BREVE_ERROR_COMPILE, run(s.world, "Object : X { }", NULL));
  CHECK(s.said.errors == 0);
  scene_close(&s);
}

static void what_fails_when_it_runs_leaves_a_usable_world(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.budget = 1000;
  config.depth_limit = 100;
  if (!scene_open_text(&s, scene_text, &config)) return;
  CHECK_STATUS(BREVE_ERROR_SCRIPT, run(s.world, "x = 3.\nself fail-deep.\nx = 4.", NULL));
  const breve_error* error = breve_world_last_error(s.world);
  CHECK(error->frame_count == 3);
  CHECK(says(s.world, "input:2") && says(s.world, "on purpose"));
  CHECK(int_from(s.world, "x") == 3);
  CHECK_STATUS(BREVE_ERROR_BUDGET, run(s.world, "while 1: x += 1.", NULL));
  CHECK(int_from(s.world, "x") > 900);
  CHECK_STATUS(BREVE_ERROR_DEPTH, run(s.world, "self recurse.", NULL));
  CHECK_STATUS(BREVE_ERROR_SCRIPT, run(s.world, "(self nothing)", NULL));
  CHECK_STATUS(BREVE_ERROR_SCRIPT, run(s.world, "o = 0. o touch.", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  scene_close(&s);
}

static void doubtful_statements_are_warned_of(void) {
  scene s;
  if (!scene_open(&s)) return;
  CHECK_STATUS(BREVE_OK, run(s.world, "if count = 3: count = 4.", NULL));
  CHECK(s.said.warnings == 1 && strstr(s.said.warning, "input:1:4"));
  scene_close(&s);
}

static void evaluate_in_print(breve_world* world, void* context) {
  int* left = context;
  if ((*left)-- <= 0) return;
  /* New strings, texts, call sites and interpolations while those of the outer statements are in use. */
  CHECK_STATUS(BREVE_OK,
               run(world, "inner = \"in$count\". (self add first 1 second 2). self say text \"i$inner\".", NULL));
}

static void statements_may_be_evaluated_while_others_run(void) {
  scene s;
  if (!scene_open(&s)) return;
  int left = 40;
  s.said.on_print = evaluate_in_print;
  s.said.context = &left;
  CHECK_STATUS(BREVE_OK, run(s.world, "inner = 0.", NULL));
  CHECK_STATUS(BREVE_OK, run(s.world, "self say text \"out\". o = \"$count and $inner\". self say text o.", NULL));
  CHECK(left < 0);
  s.said.on_print = NULL;
  CHECK(int_from(s.world, "o == \"7 and in7\"") == 1);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  scene_close(&s);
}

static void statements_have_their_place_in_a_profile(void) {
  scene s;
  if (!scene_open(&s)) return;
  CHECK_STATUS(BREVE_OK, run(s.world, "x = 1.", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_profile_start(s.world, NULL, NULL));
  for (int i = 0; i < 3; ++i) {
    CHECK_STATUS(BREVE_OK, run(s.world, "for i = 0, i < 10, i++: (self add first i).", NULL));
    CHECK_STATUS(BREVE_ERROR_SCRIPT, run(s.world, "self fail-now.", NULL));
  }
  CHECK_STATUS(BREVE_OK, breve_world_profile_stop(s.world));
  size_t count = 0;
  uint64_t evaluated = 0;
  CHECK_STATUS(BREVE_OK, breve_world_profile_node_count(s.world, &count));
  for (size_t i = 0; i < count; ++i) {
    breve_profile_node node;
    CHECK_STATUS(BREVE_OK, breve_world_profile_node(s.world, i, &node));
    if (strcmp(node.name, "evaluate") == 0) evaluated += node.calls;
    if (strcmp(node.name, "evaluate") == 0) CHECK_TEXT("Stage", node.class_name);
  }
  CHECK(evaluated == 6 && count < 20);
  scene_close(&s);
}

static const char* const describing =
    "@use Control.\nController Stage.\n"
    "Control : Stage {\n"
    "  + to get-description:\n"
    "    print \"describe\".\n"
    "    return \"me\".\n"
    "}\n";

static void grow_in_print(breve_world* world, void* context) {
  (void)context;
  static char text[200000];
  size_t size = 0;
  for (int i = 0; i < 8000; ++i) size += (size_t)sprintf(text + size, "\"$q %d\".", i);
  const breve_object nobody = {0, 0};
  CHECK_STATUS(BREVE_OK, run(world, "q = 1.", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_evaluate(world, nobody, text, size, NULL));
}

static void a_large_text_inside_a_running_one_moves_nothing_that_is_used(void) {
  scene s;
  if (!scene_open_text(&s, describing, NULL)) return;
  s.said.on_print = grow_in_print;
  breve_value v;
  CHECK_STATUS(BREVE_OK, run(s.world, "\"<$self|$self|${self}>\"", &v));
  s.said.on_print = NULL;
  CHECK(v.type == BREVE_TYPE_STRING && strncmp(v.as.string.bytes, "<Stage (0x", 10) == 0 &&
        v.as.string.bytes[v.as.string.size - 1] == '>');
  scene_close(&s);
}

static void evaluating_often_leaks_nothing(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_stats before, after;
  before.struct_size = after.struct_size = sizeof before;
  char text[200];
  for (int i = 0; i < 4000; ++i) {
    if (i == 1000) CHECK_STATUS(BREVE_OK, breve_world_stats(s.world, &before));
    sprintf(text, "x%d = \"text %d $count\". (self add first %d). x = %d %% 3.", i % 5, i, i, i);
    CHECK_STATUS(BREVE_OK, run(s.world, text, NULL));
    sprintf(text, "\"unknown $count\". name-%d.", i);
    CHECK_STATUS(BREVE_ERROR_COMPILE, run(s.world, text, NULL));
    sprintf(text, "self method-%d.", i);
    CHECK_STATUS(BREVE_ERROR_SCRIPT, run(s.world, text, NULL));
    if (i % 100 == 0) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  }
  CHECK_STATUS(BREVE_OK, breve_world_stats(s.world, &after));
  CHECK(after.heap_cells < before.heap_cells + 1200);
  CHECK(after.memory_used < before.memory_used + 100000);
  scene_close(&s);
}

static void a_gone_object_evaluates_nothing(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object ball = ball_of(&s), nobody = {0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, ball));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_world_evaluate(s.world, ball, "1", 1, NULL));
  CHECK_STATUS(BREVE_OK, run(s.world, "free self.", NULL)); /* the method ends there */
  CHECK_STATUS(BREVE_ERROR_STALE, breve_world_evaluate(s.world, nobody, "1", 1, NULL));
  scene_close(&s);
}

static void snapshots_hold_the_session_and_the_hash_does_not(void) {
  scene s;
  if (!scene_open(&s)) return;
  static unsigned char image[1 << 20];
  size_t size = 0;
  uint64_t before = 0, after = 0;
  CHECK_STATUS(BREVE_OK, run(s.world, "x = 1. k = { 1, self }.", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &before));
  CHECK_STATUS(BREVE_OK, run(s.world, "x = 2.", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &after));
  CHECK(before == after);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, sizeof image, &size));
  CHECK(size <= sizeof image);
  CHECK_STATUS(BREVE_OK, run(s.world, "x = 3. k = 0. y = 4.", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  CHECK(int_from(s.world, "x") == 2);
  CHECK(int_from(s.world, "k{1} == self") == 1);
  CHECK_STATUS(BREVE_ERROR_COMPILE, run(s.world, "y", NULL));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  scene_close(&s);
}

static void complete_statements_are_told_from_others(void) {
  static const struct {
    bool complete;
    const char* text;
  } cases[] = {
      {true, ""},
      {true, "  "},
      {true, "x = 5"},
      {true, "x = 5."},
      {true, "print 1. print 2"},
      {true, "if x: { print 1. }"},
      {true, "if x: print 1."},
      {true, "# words"},
      {true, "x = (1, 2, 3)"},
      {true, "\"a { b\""},
      {true, ") oh no"},
      {true, "5 ] 6"},
      {false, "if x: {"},
      {false, "if x: { print 1."},
      {false, "if x:"},
      {false, "if x"},
      {false, "while x <"},
      {false, "x ="},
      {false, "x +"},
      {false, "x = (1, 2"},
      {false, "\"open"},
      {false, "x = 1. #! open"},
      {false, "foreach e in k:\n"},
      {false, "push 4 onto"},
      {false, "x = { 1, 2,"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
    check_that(breve_statements_complete(cases[i].text, strlen(cases[i].text)) == cases[i].complete, cases[i].text,
               __FILE__, __LINE__);
  CHECK(breve_statements_complete(NULL, 0) && !breve_statements_complete(NULL, 3));
}

static void interrupt_in_print(breve_world* world, void* context) {
  (void)context;
  breve_world_interrupt(world);
}

static void* interrupt_later(void* world) {
  for (int i = 0; i < 100; ++i) {
    struct timespec pause = {0, 2000000};
    nanosleep(&pause, NULL);
    breve_world_interrupt(world);
  }
  return NULL;
}

static void an_interrupt_stops_what_runs(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_world_interrupt(s.world); /* nothing runs: nothing is stopped */
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  s.said.on_print = interrupt_in_print;
  CHECK_STATUS(BREVE_ERROR_INTERRUPTED, run(s.world, "print 1. while 1: count += 1.", NULL));
  CHECK_TEXT("BREVE_ERROR_INTERRUPTED", breve_status_name(BREVE_ERROR_INTERRUPTED));
  CHECK(says(s.world, "input:1"));
  s.said.on_print = NULL;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  pthread_t other;
  CHECK(pthread_create(&other, NULL, interrupt_later, s.world) == 0);
  CHECK_STATUS(BREVE_ERROR_INTERRUPTED,
               breve_object_call(s.world, breve_world_controller(s.world), "spin", NULL, 0, NULL));
  pthread_join(other, NULL);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  breve_world_interrupt(NULL);
  scene_close(&s);
}

void evaluate_suite(void) {
  RUN(a_bare_expression_gives_its_value);
  RUN(statements_stand_in_a_method_of_the_object);
  RUN(assigned_names_live_in_the_session);
  RUN(session_variables_keep_what_they_hold_alive);
  RUN(what_does_not_compile_is_told_and_changes_nothing);
  RUN(what_fails_when_it_runs_leaves_a_usable_world);
  RUN(doubtful_statements_are_warned_of);
  RUN(statements_may_be_evaluated_while_others_run);
  RUN(a_large_text_inside_a_running_one_moves_nothing_that_is_used);
  RUN(statements_have_their_place_in_a_profile);
  RUN(evaluating_often_leaks_nothing);
  RUN(a_gone_object_evaluates_nothing);
  RUN(snapshots_hold_the_session_and_the_hash_does_not);
  RUN(complete_statements_are_told_from_others);
  RUN(an_interrupt_stops_what_runs);
}
