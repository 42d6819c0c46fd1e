/* Callbacks that call back in: what may be done inside a running script, and what may not. */
#include "scene.h"

typedef struct visit {
  int count;
  breve_object stage, ball;
  breve_value kept; /* a reference that must not outlive the callback */
} visit;

static void do_what_may_not_be_done(breve_world* world, void* context) {
  visit* v = context;
  uint64_t hash;
  size_t size;
  char image[16];
  ++v->count;
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_step(world));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_advance(world, 1, NULL));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_destroy(world));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_hash(world, &hash));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_snapshot(world, NULL, 0, &size));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_restore(world, image, sizeof image));
  CHECK(breve_world_last_error(world)->status == BREVE_ERROR_BUSY);
}

static void stepping_hashing_and_destroying_are_busy_inside_a_script(void) {
  scene s;
  if (!scene_open(&s)) return;
  visit v = {0};
  s.said.on_print = do_what_may_not_be_done;
  s.said.context = &v;
  const breve_keyword text = {"text", breve_value_string("hello")};
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "say", &text, 1, NULL));
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, ball_of(&s))); /* its destroy prints */
  CHECK(v.count == 2);
  CHECK(breve_world_iteration(s.world) == 0);
  scene_close(&s);
}

static void init_is_inside_a_script_too(void) {
  const char* text = "@use Control.\nController Loud.\nControl : Loud { + to init: print \"hi\". }\n";
  visit v = {0};
  scene s;
  memset(&s, 0, sizeof s);
  s.said.on_print = do_what_may_not_be_done;
  s.said.context = &v;
  breve_runtime_config config = breve_runtime_config_default();
  config.user = &s.said;
  config.print = remember;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &s.runtime));
  CHECK_STATUS(BREVE_OK, breve_program_compile(s.runtime, "loud.tz", text, strlen(text), &s.program));
  CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, NULL, &s.world));
  CHECK(v.count == 1);
  scene_close(&s);
}

static void do_what_may_be_done(breve_world* world, void* context) {
  visit* v = context;
  if (++v->count > 1) return;
  breve_pose pose;
  breve_value value;
  size_t count;
  breve_object made;
  CHECK_STATUS(BREVE_OK, breve_object_pose(world, v->ball, &pose));
  CHECK_STATUS(BREVE_OK, breve_object_get(world, v->stage, "things", &v->kept));
  CHECK_STATUS(BREVE_OK, breve_list_size(world, &v->kept, &count));
  CHECK(count == 4);
  CHECK_STATUS(BREVE_OK, breve_object_call(world, v->stage, "touch", NULL, 0, &value));
  CHECK_STATUS(BREVE_OK, breve_object_create(world, "Ball", &made));
  CHECK_STATUS(BREVE_OK, breve_object_free(world, made)); /* prints: this function again */
  CHECK_STATUS(BREVE_OK, breve_world_queue_key(world, "a", true));
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_call(world, v->stage, "fail-now", NULL, 0, NULL));
}

static void a_callback_may_read_call_make_and_free(void) {
  scene s;
  if (!scene_open(&s)) return;
  visit v = {0, breve_world_controller(s.world), ball_of(&s), breve_value_null()};
  s.said.on_print = do_what_may_be_done;
  s.said.context = &v;
  const breve_keyword text = {"text", breve_value_string("hello")};
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, v.stage, "say", &text, 1, NULL));
  CHECK(v.count == 2);
  CHECK(int_of(&s, "calls") == 1);
  size_t count;
  CHECK_STATUS(BREVE_ERROR_STALE, breve_list_size(s.world, &v.kept, &count));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "pressed") == 1);
  scene_close(&s);
}

static breve_status deepest;
static int deepest_at;

static void call_again(breve_world* world, void* context) {
  visit* v = context;
  const breve_keyword text = {"text", breve_value_string("deeper")};
  ++v->count;
  const breve_status status = breve_object_call(world, v->stage, "say", &text, 1, NULL);
  if (deepest == BREVE_OK && status != BREVE_OK) {
    deepest = status;
    deepest_at = v->count;
  }
}

static void host_and_script_nest_to_a_depth_and_no_further(void) {
  scene s;
  if (!scene_open(&s)) return;
  visit v = {0, breve_world_controller(s.world), {0, 0}, breve_value_null()};
  s.said.on_print = call_again;
  s.said.context = &v;
  const breve_keyword text = {"text", breve_value_string("down")};
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, v.stage, "say", &text, 1, NULL));
  CHECK(deepest == BREVE_ERROR_DEPTH);
  CHECK(deepest_at == v.count && v.count > 10);
  s.said.on_print = NULL;
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, v.stage, "say", &text, 1, NULL));
  scene_close(&s);
}

static void step_the_other(breve_world* world, void* context) {
  breve_world* other = context;
  (void)world;
  CHECK_STATUS(BREVE_OK, breve_world_step(other));
}

static void other_worlds_are_free_while_one_is_busy(void) {
  scene a, b;
  if (!scene_open(&a) || !scene_open(&b)) return;
  a.said.on_print = step_the_other;
  a.said.context = b.world;
  const breve_keyword text = {"text", breve_value_string("hello")};
  CHECK_STATUS(BREVE_OK, breve_object_call(a.world, breve_world_controller(a.world), "say", &text, 1, NULL));
  CHECK(breve_world_iteration(b.world) == 1);
  scene_close(&a);
  scene_close(&b);
}

void reentry_suite(void) {
  RUN(stepping_hashing_and_destroying_are_busy_inside_a_script);
  RUN(init_is_inside_a_script_too);
  RUN(a_callback_may_read_call_make_and_free);
  RUN(host_and_script_nest_to_a_depth_and_no_further);
  RUN(other_worlds_are_free_while_one_is_busy);
}
