/* Hosts that call back in at bad moments: while events are traced, while a native walks a list, while a function that
   runs no script has a warning to tell. */
#include <stdlib.h>

#include "scene.h"

/* --- a reference that is used after its callback has ended --------------------------------------------------------- */

typedef struct tracing {
  breve_world* world;
  breve_value list;
  int events, stale;
} tracing;

static void keep_and_use(void* user, const breve_trace_event* event) {
  tracing* t = user;
  (void)event;
  if (!t->world) return;
  if (++t->events == 5) CHECK_STATUS(BREVE_OK, breve_list_create(t->world, &t->list));
  if (t->events <= 20 || t->stale >= 60) return;
  const breve_value one = breve_value_int(1);
  CHECK_STATUS(BREVE_ERROR_STALE, breve_list_push(t->world, &t->list, &one));
  ++t->stale;
}

static void a_reference_of_a_trace_callback_dies_with_it(void) {
  scene s;
  tracing t = {0};
  const char* text =
      "@use Control.\nController A.\n"
      "Control : A {\n"
      "  + variables:\n    s (string).\n    i (int).\n    k (list).\n"
      "  + to iterate:\n    super iterate.\n"
      "    for i = 0, i < 3000, i++: { s = \"garbage $i\". self get-time. }\n    k = {1, {2}, {3}}.\n"
      "}\n";
  if (!scene_open_text(&s, text, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_profile_start(s.world, keep_and_use, &t));
  t.world = s.world;
  for (int i = 0; i < 3; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(t.stale == 60);
  CHECK_STATUS(BREVE_OK, breve_world_profile_stop(s.world));
  scene_close(&s);
}

/* --- a list that changes while a native walks it ------------------------------------------------------------------- */

static breve_world* asked;

static bool push_many(void* user, breve_world* world, const char* name, breve_file* file, breve_write_fn reason,
                      void* sink) {
  breve_value list;
  const breve_value one = breve_value_int(1);
  (void)user, (void)name, (void)file, (void)reason, (void)sink;
  if (!asked) return false;
  if (breve_object_get(world, breve_world_controller(world), "k", &list) == BREVE_OK)
    for (int i = 0; i < 100; ++i) CHECK_STATUS(BREVE_OK, breve_list_push(world, &list, &one));
  return false;
}

static void a_host_that_looks_for_files_may_change_the_list_of_their_names(void) {
  const char* text =
      "@use Control.\nController A.\n"
      "Control : A {\n"
      "  + variables:\n    k (list).\n"
      "  + to iterate:\n    super iterate.\n    k = {\"a\", \"b\", \"c\", \"d\", \"e\", \"f\"}.\n"
      "    self set-skybox-images to k.\n"
      "}\n";
  breve_runtime_config config = breve_runtime_config_default();
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  config.files.open_for_reading = push_many;
  asked = NULL;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &runtime));
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "sky.tz", text, strlen(text), &program));
  CHECK_STATUS(BREVE_OK, breve_world_create(runtime, program, NULL, &world));
  asked = world;
  for (int i = 0; i < 3; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(world));
  CHECK_STATUS(BREVE_OK, breve_world_destroy(world));
  breve_program_destroy(program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

/* --- a warning of a function that runs no script ------------------------------------------------------------------- */

typedef struct hearing {
  void* image;
  size_t size;
  int heard;
} hearing;

static void do_all_that_is_busy(void* user, breve_world* world, breve_channel channel, const char* text, size_t size) {
  hearing* h = user;
  (void)text, (void)size;
  if (channel != BREVE_CHANNEL_WARNING || !h->image) return;
  ++h->heard;
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_destroy(world));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_restore(world, h->image, h->size));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_step(world));
}

static void free_the_item(void* user, breve_world* world, breve_channel channel, const char* text, size_t size) {
  hearing* h = user;
  breve_value item;
  (void)text, (void)size;
  if (channel != BREVE_CHANNEL_WARNING || h->heard++ != 0) return;
  CHECK_STATUS(BREVE_OK, breve_object_get(world, breve_world_controller(world), "item", &item));
  CHECK_STATUS(BREVE_OK, breve_object_free(world, item.as.object));
}

static const char* const typed =
    "@use Control.\nController A.\n"
    "Object : Item { + variables: x (int). }\n"
    "Control : A {\n"
    "  + variables:\n    x (int).\n    item (object).\n"
    "  + to init: item = new Item.\n"
    "}\n";

static void check_set(breve_print_fn print, const char* variable_of, breve_status wanted) {
  hearing h = {0};
  breve_runtime_config config = breve_runtime_config_default();
  breve_runtime* runtime = NULL;
  breve_program* program = NULL;
  breve_world* world = NULL;
  config.print = print;
  config.user = &h;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &runtime));
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "typed.tz", typed, strlen(typed), &program));
  CHECK_STATUS(BREVE_OK, breve_world_create(runtime, program, NULL, &world));
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(world, NULL, 0, &h.size));
  h.image = malloc(h.size);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(world, h.image, h.size, &h.size));
  breve_object object = breve_world_controller(world);
  if (strcmp(variable_of, "item") == 0) {
    breve_value item;
    CHECK_STATUS(BREVE_OK, breve_object_get(world, object, "item", &item));
    object = item.as.object;
  }
  const breve_value nothing = breve_value_null();
  CHECK_STATUS(wanted, breve_object_set(world, object, "x", &nothing));
  CHECK(h.heard > 0);
  CHECK_STATUS(BREVE_OK, breve_world_step(world));
  CHECK_STATUS(BREVE_OK, breve_world_destroy(world));
  free(h.image);
  breve_program_destroy(program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

static void a_world_is_busy_while_it_tells_a_warning(void) { check_set(do_all_that_is_busy, "controller", BREVE_OK); }

static void an_object_may_be_freed_while_a_warning_about_it_is_told(void) {
  check_set(free_the_item, "item", BREVE_ERROR_TYPE);
}

void moments_suite(void) {
  RUN(a_reference_of_a_trace_callback_dies_with_it);
  RUN(a_host_that_looks_for_files_may_change_the_list_of_their_names);
  RUN(a_world_is_busy_while_it_tells_a_warning);
  RUN(an_object_may_be_freed_while_a_warning_about_it_is_told);
}
