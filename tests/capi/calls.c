/* Methods called by name and keywords, prepared selectors, errors in them, limits. */
#include "scene.h"

static void keywords_are_found_in_any_order_and_defaults_fill_in(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object stage = breve_world_controller(s.world);
  breve_keyword both[] = {{"second", breve_value_int(2)}, {"first", breve_value_int(40)}};
  breve_value result;
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, stage, "add", both, 2, &result));
  CHECK(result.type == BREVE_TYPE_INT && result.as.integer == 42);
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, stage, "add", &both[1], 1, &result));
  CHECK(result.as.integer == 50);
  breve_keyword apart[] = {{"from", breve_value_int(10)}, {"this", breve_value_double(2.5)}};
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, stage, "subtract", apart, 2, &result));
  CHECK(result.type == BREVE_TYPE_DOUBLE && result.as.number == 7.5);
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, stage, "touch", NULL, 0, NULL));
  CHECK(int_of(&s, "calls") == 1);
  scene_close(&s);
}

static void library_methods_are_called_the_same_way(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object ball = ball_of(&s);
  breve_keyword to = {"to", breve_value_vector(5, 6, 7)};
  breve_value where;
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, ball, "move", &to, 1, NULL));
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, ball, "get-location", NULL, 0, &where));
  CHECK(where.type == BREVE_TYPE_VECTOR && where.as.vector[1] == 6);
  scene_close(&s);
}

static void values_of_all_types_go_through_a_call(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object stage = breve_world_controller(s.world), ball = ball_of(&s);
  const double rows[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  breve_value result;
  breve_keyword value = {"value", breve_value_matrix(rows)};
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, stage, "echo-matrix", &value, 1, &result));
  CHECK(result.type == BREVE_TYPE_MATRIX && memcmp(result.as.matrix, rows, sizeof rows) == 0);
  value.value = breve_value_string("text");
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, stage, "echo-string", &value, 1, &result));
  CHECK_TEXT("text", result.as.string.bytes);
  value.value = breve_value_object(ball);
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, stage, "echo-object", &value, 1, &result));
  CHECK(result.as.object.index == ball.index && result.as.object.generation == ball.generation);
  value.value = breve_value_object((breve_object){0, 0});
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, stage, "echo-object", &value, 1, &result));
  CHECK(result.type == BREVE_TYPE_OBJECT && result.as.object.generation == 0);
  value.value.type = 77;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_call(s.world, stage, "echo-object", &value, 1, &result));
  scene_close(&s);
}

static void wrong_calls_say_what_is_wrong(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object stage = breve_world_controller(s.world);
  breve_keyword wrong = {"third", breve_value_int(1)};
  breve_value result = breve_value_int(123);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_object_call(s.world, stage, "fly", NULL, 0, &result));
  CHECK(strstr(breve_world_last_error(s.world)->message, "'fly'") != NULL);
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_call(s.world, stage, "add", &wrong, 1, &result));
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_call(s.world, stage, "add", NULL, 0, &result));
  CHECK(result.type == BREVE_TYPE_INT && result.as.integer == 123); /* results are written only on success */
  wrong = (breve_keyword){"text", breve_value_object((breve_object){0, 0})};
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, stage, "say", &wrong, 1, NULL));
  wrong = (breve_keyword){"first", breve_value_vector(1, 2, 3)};
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_call(s.world, stage, "add", &wrong, 1, NULL));
  scene_close(&s);
}

static void an_error_carries_place_and_chain_of_calls(void) {
  scene s;
  if (!scene_open(&s)) return;
  CHECK_STATUS(BREVE_ERROR_SCRIPT,
               breve_object_call(s.world, breve_world_controller(s.world), "fail-deep", NULL, 0, NULL));
  const breve_error* e = breve_world_last_error(s.world);
  CHECK(e->status == BREVE_ERROR_SCRIPT);
  CHECK(strstr(e->message, "on purpose") != NULL);
  CHECK_TEXT("scene.tz", e->file);
  CHECK(e->line > 0);
  if (CHECK(e->frame_count == 2)) {
    CHECK_TEXT("fail-now", e->frames[0].method);
    CHECK_TEXT("fail-deep", e->frames[1].method);
    CHECK_TEXT("Stage", e->frames[0].class_name);
    CHECK_TEXT("scene.tz", e->frames[0].file);
    CHECK(e->frames[0].line == e->line && e->frames[1].line > e->line);
  }
  CHECK(strstr(e->text, "fail-now") != NULL && strstr(e->text, "on purpose") != NULL);
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "touch", NULL, 0, NULL));
  scene_close(&s);
}

static void endless_recursion_and_loops_are_cut(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.budget = 100000;
  config.depth_limit = 200;
  if (!scene_open_text(&s, scene_text, &config)) return;
  const breve_object stage = breve_world_controller(s.world);
  CHECK_STATUS(BREVE_ERROR_DEPTH, breve_object_call(s.world, stage, "recurse", NULL, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_object_call(s.world, stage, "spin", NULL, 0, NULL));
  const int first = int_of(&s, "calls");
  CHECK(first > 0 && first <= 100000);
  CHECK_STATUS(BREVE_ERROR_BUDGET, breve_object_call(s.world, stage, "spin", NULL, 0, NULL));
  CHECK(int_of(&s, "calls") == 2 * first); /* the same cut each time */
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  scene_close(&s);
}

static void prepared_selectors_serve_every_class(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object stage = breve_world_controller(s.world), ball = ball_of(&s);
  breve_selector touch, add, short_add, subtract;
  const char* reversed[] = {"second", "first"};
  const char* one[] = {"first"};
  const char* mixed[] = {"from", "this"};
  CHECK_STATUS(BREVE_OK, breve_world_prepare(s.world, "touch", NULL, 0, &touch));
  CHECK_STATUS(BREVE_OK, breve_world_prepare(s.world, "add", reversed, 2, &add));
  CHECK_STATUS(BREVE_OK, breve_world_prepare(s.world, "add", one, 1, &short_add));
  CHECK_STATUS(BREVE_OK, breve_world_prepare(s.world, "subtract", mixed, 2, &subtract));
  for (int i = 0; i < 3; ++i) {
    CHECK_STATUS(BREVE_OK, breve_object_call_prepared(s.world, stage, touch, NULL, 0, NULL));
    CHECK_STATUS(BREVE_OK, breve_object_call_prepared(s.world, ball, touch, NULL, 0, NULL));
  }
  CHECK(int_of(&s, "calls") == 3);
  breve_value hits, result;
  CHECK_STATUS(BREVE_OK, breve_object_get(s.world, ball, "hits", &hits));
  CHECK(hits.as.integer == 3);
  const breve_value arguments[] = {breve_value_int(2), breve_value_double(40.9)};
  CHECK_STATUS(BREVE_OK, breve_object_call_prepared(s.world, stage, add, arguments, 2, &result));
  CHECK(result.as.integer == 42);
  CHECK_STATUS(BREVE_OK, breve_object_call_prepared(s.world, stage, short_add, arguments, 1, &result));
  CHECK(result.as.integer == 12); /* with the default */
  CHECK_STATUS(BREVE_OK, breve_object_call_prepared(s.world, stage, subtract, arguments, 2, &result));
  CHECK_NEAR(2 - 40.9, result.as.number, 1e-14);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_object_call_prepared(s.world, ball, add, arguments, 2, &result));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_call_prepared(s.world, stage, add, arguments, 1, &result));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_call_prepared(s.world, stage, add, NULL, 2, &result));
  scene_close(&s);
}

static void a_selector_that_was_not_prepared_here_is_stale(void) {
  scene s, other;
  if (!scene_open(&s) || !scene_open(&other)) return;
  breve_selector mine, theirs;
  CHECK_STATUS(BREVE_OK, breve_world_prepare(s.world, "touch", NULL, 0, &mine));
  CHECK_STATUS(BREVE_OK, breve_world_prepare(other.world, "stop", NULL, 0, &theirs));
  const breve_object stage = breve_world_controller(s.world);
  const breve_selector null = {0, 0}, far = {1000, mine.generation};
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_call_prepared(s.world, stage, theirs, NULL, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_call_prepared(s.world, stage, null, NULL, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_call_prepared(s.world, stage, far, NULL, 0, NULL));
  CHECK(!breve_world_ended(s.world));
  scene_close(&s);
  scene_close(&other);
}

void calls_suite(void) {
  RUN(keywords_are_found_in_any_order_and_defaults_fill_in);
  RUN(library_methods_are_called_the_same_way);
  RUN(values_of_all_types_go_through_a_call);
  RUN(wrong_calls_say_what_is_wrong);
  RUN(an_error_carries_place_and_chain_of_calls);
  RUN(endless_recursion_and_loops_are_cut);
  RUN(prepared_selectors_serve_every_class);
  RUN(a_selector_that_was_not_prepared_here_is_stale);
}
