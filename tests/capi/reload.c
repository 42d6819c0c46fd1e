/* A changed program in the place of the running one: what it keeps, what it refuses, and that it is all or nothing. */
#include <stdlib.h>

#include "scene.h"

#define HEAD "@use Control.\n@use Mobile.\n@use Stationary.\nController Stage.\n"

/* Bodies, lists, hashes, strings, schedule, random numbers, auto-free, neighbours. */
static const char* const lively = HEAD
    "Control : Stage {\n"
    "  + variables:\n"
    "    bugs, log (list).\n"
    "    table (hash).\n"
    "    ticks (int).\n"
    "    name (string).\n"
    "    where (vector).\n"
    "    turn (matrix).\n"
    "    first (Bug object).\n"
    "    grid (3 floats).\n"
    "  + to init:\n"
    "    bugs = 12 new Bug.\n"
    "    first = bugs{0}.\n"
    "    name = \"stage\".\n"
    "    turn = [(1, 2, 3), (4, 5, 6), (7, 8, 9)].\n"
    "    grid[1] = 2.5.\n"
    "    self schedule method-call \"tick\" at-time 0.5.\n"
    "    bugs set-neighborhood-size to 3.0.\n"
    "  + to tick:\n"
    "    ticks += 1.\n"
    "    table{ticks} = \"tick $ticks\".\n"
    "    table{(bugs{0})} = { ticks, \"constant\" }.\n"
    "    push (new Bug) onto bugs.\n"
    "    push { log } onto log.\n"
    "    free bugs{1}.\n"
    "    remove bugs{1}.\n"
    "    self schedule method-call \"tick\" at-time ((self get-time) + 0.3).\n"
    "  + to iterate:\n"
    "    self update-neighbors.\n"
    "    super iterate.\n"
    "}\n"
    "Mobile : Bug (aka Bugs) {\n"
    "  + variables:\n"
    "    friends (list).\n"
    "  + to init:\n"
    "    self move to (random[(10, 10, 10)] - (5, 5, 5)).\n"
    "    self handle-collisions with-type \"Bug\" with-method \"meet\".\n"
    "  + to meet other o (object):\n"
    "    self offset by (0, 0.1, 0).\n"
    "  + to iterate:\n"
    "    friends = (self get-neighbors).\n"
    "    self set-velocity to (random[(2, 2, 2)] - (1, 1, 1)) * (1 + |friends|).\n"
    "}\n";

static breve_program* compiled(scene* s, const char* text) {
  breve_program* program = NULL;
  if (breve_program_compile(s->runtime, "changed.tz", text, strlen(text), &program) != BREVE_OK) {
    CHECK(!"the changed program compiles");
    printf("%s", breve_runtime_last_error(s->runtime)->text);
  }
  return program;
}

static breve_status reload(scene* s, const char* text) {
  breve_program* program = compiled(s, text);
  const breve_status status = breve_world_reload(s->world, program);
  breve_program_destroy(program); /* the world keeps it */
  return status;
}

static uint64_t hash_of(const breve_world* world) {
  uint64_t hash = 0;
  CHECK_STATUS(BREVE_OK, breve_world_hash(world, &hash));
  return hash;
}

static int call_int(scene* s, breve_object object, const char* method) {
  breve_value v = breve_value_null();
  CHECK_STATUS(BREVE_OK, breve_object_call(s->world, object, method, NULL, 0, &v));
  return v.type == BREVE_TYPE_INT ? v.as.integer : -999;
}

static void the_same_program_changes_no_bit(void) {
  scene a, b;
  if (!scene_open_text(&a, lively, NULL) || !scene_open_text(&b, lively, NULL)) return;
  static unsigned char image_a[1 << 20], image_b[1 << 20];
  for (int i = 0; i < 60; ++i) {
    if (i % 7 == 3) {
      CHECK_STATUS(BREVE_OK, breve_world_reload(a.world, a.program));
      size_t size_a = 0, size_b = 0;
      CHECK_STATUS(BREVE_OK, breve_world_snapshot(a.world, image_a, sizeof image_a, &size_a));
      CHECK_STATUS(BREVE_OK, breve_world_snapshot(b.world, image_b, sizeof image_b, &size_b));
      CHECK(size_a == size_b);
    }
    CHECK(hash_of(a.world) == hash_of(b.world));
    CHECK_STATUS(BREVE_OK, breve_world_step(a.world));
    CHECK_STATUS(BREVE_OK, breve_world_step(b.world));
  }
  CHECK(hash_of(a.world) == hash_of(b.world));
  CHECK_TEXT("", a.said.warning);
  scene_close(&a);
  scene_close(&b);
}

static const char* const before = HEAD
    "Control : Stage {\n"
    "  + variables:\n"
    "    count, plain (int).\n"
    "    text (string).\n"
    "    number (float).\n"
    "    gone, kept (list).\n"
    "    table (hash).\n"
    "    bug (object).\n"
    "    grid (4 ints).\n"
    "  + to init:\n"
    "    count = 7. plain = 3. text = \"12 apples\". number = 2.75.\n"
    "    gone = { new Mobile }. kept = { 1, { 2 }, \"three\" }. table{\"k\"} = kept.\n"
    "    grid[0] = 10. grid[3] = 13.\n"
    "    bug = new Bug.\n"
    "    self schedule method-call \"later\" at-time 1.0.\n"
    "  + to value: return 1.\n"
    "  + to add to a (int) and b = 5 (int): return a + b.\n"
    "  + to later: count += 100.\n"
    "  + to old: return 1.\n"
    "}\n"
    "Object : Unused { }\n"
    "Mobile : Bug (aka Bugs) {\n"
    "  + variables: turns (int).\n"
    "  + to init: turns = 5.\n"
    "  + to iterate: turns += 1.\n"
    "}\n";

static const char* const after = HEAD
    "Object : New {\n"
    "  + variables: made (int).\n"
    "  + to init: made = 1.\n"
    "}\n"
    "Mobile : Animal {\n"
    "  + variables: turns, legs (int).\n"
    "}\n"
    "Animal : Bug (aka Bugs) {\n"
    "  + variables: extra (string).\n"
    "  + to init: extra = \"made\".\n"
    "  + to post-iterate: turns += 10.\n"
    "  + to get-turns: return turns.\n"
    "}\n"
    "Control : Stage {\n"
    "  + variables:\n"
    "    bug (object).\n"
    "    number (int).\n" /* was a float */
    "    fresh (float).\n"
    "    kept (list).\n"
    "    plain (vector).\n" /* was an int, which makes no vector */
    "    text (int).\n"     /* was a string */
    "    table (hash).\n"
    "    count (string).\n" /* was an int */
    "    things (list).\n"
    "    grid (2 floats).\n" /* was (4 ints) */
    "  + to init: fresh = 99.\n"
    "  + to value: return 2.\n"
    "  + to add and b = 50 (int) to a (int): return a * 1000 + b.\n"
    "  + to later: fresh = 5.5.\n"
    "  + to make: return ((new New) get-made).\n"
    "  + to grid-sum: return grid[0] + grid[1].\n"
    "}\n";

static void instances_keep_their_values_by_name(void) {
  scene s;
  if (!scene_open_text(&s, before, NULL)) return;
  const breve_object stage = breve_world_controller(s.world);
  for (int i = 0; i < 3; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  const breve_object bug = value_of(&s, "bug").as.object;
  breve_stats stats = breve_stats_default();
  CHECK_STATUS(BREVE_OK, breve_world_stats(s.world, &stats));
  const uint64_t objects = stats.objects;
  CHECK_STATUS(BREVE_OK, reload(&s, after));
  CHECK(breve_object_alive(s.world, stage) && breve_object_alive(s.world, bug));
  CHECK_TEXT("Bug", breve_object_class(s.world, bug));
  breve_value v;
  CHECK(value_of(&s, "number").type == BREVE_TYPE_INT && value_of(&s, "number").as.integer == 2);
  CHECK(value_of(&s, "text").as.integer == 12);
  CHECK_STATUS(BREVE_OK, breve_object_get(s.world, stage, "count", &v));
  CHECK_TEXT("7", v.as.string.bytes);
  CHECK(value_of(&s, "plain").type == BREVE_TYPE_VECTOR && value_of(&s, "plain").as.vector[0] == 0);
  CHECK(s.said.warnings == 1 && strstr(s.said.warning, "'plain'"));
  CHECK(value_of(&s, "fresh").as.number == 0.0); /* the new init has not run */
  const char* text = NULL;
  v = value_of(&s, "kept");
  CHECK_STATUS(BREVE_OK, breve_value_text(s.world, &v, &text));
  CHECK_TEXT("{ 1, { 2 }, three }", text);
  CHECK(value_of(&s, "bug").as.object.index == bug.index);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_object_get(s.world, stage, "gone", &v));
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, stage, "grid-sum", NULL, 0, &v));
  CHECK(v.type == BREVE_TYPE_DOUBLE && v.as.number == 10.0);
  /* A variable that moved to a parent; a new one; who iterates. */
  CHECK_STATUS(BREVE_OK, breve_object_get(s.world, bug, "turns", &v));
  CHECK(v.as.integer == 8);
  CHECK_STATUS(BREVE_OK, breve_object_get(s.world, bug, "extra", &v));
  CHECK(v.as.string.size == 0);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(call_int(&s, bug, "get-turns") == 18);
  CHECK(call_int(&s, stage, "value") == 2);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_object_call(s.world, stage, "old", NULL, 0, NULL));
  breve_object made;
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "New", &made));
  CHECK_STATUS(BREVE_OK, breve_object_get(s.world, made, "made", &v));
  CHECK(v.as.integer == 1);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_object_create(s.world, "Unused", &made));
  CHECK_STATUS(BREVE_OK, breve_world_stats(s.world, &stats));
  CHECK(stats.objects == objects + 1);
  for (int i = 0; i < 20; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(value_of(&s, "fresh").as.number == 5.5); /* the scheduled call, by its name */
  scene_close(&s);
}

static void prepared_selectors_and_collision_handlers_go_on_working(void) {
  scene s;
  if (!scene_open_text(&s, before, NULL)) return;
  const breve_object stage = breve_world_controller(s.world);
  const char* keywords[] = {"to"};
  const breve_value argument = breve_value_int(3);
  breve_selector selector;
  breve_value v;
  CHECK_STATUS(BREVE_OK, breve_world_prepare(s.world, "add", keywords, 1, &selector));
  CHECK_STATUS(BREVE_OK, breve_object_call_prepared(s.world, stage, selector, &argument, 1, &v));
  CHECK(v.as.integer == 8);
  CHECK_STATUS(BREVE_OK, reload(&s, after));
  CHECK_STATUS(BREVE_OK, breve_object_call_prepared(s.world, stage, selector, &argument, 1, &v));
  CHECK(v.as.integer == 3050);
  scene_close(&s);
}

#define CLASH(EXTRA, METHOD)                                                                                 \
  HEAD EXTRA                                                                                                 \
      "Control : Stage { + variables: hits (int). a (object).\n"                                             \
      "  + to init: a = new Left. new Right. self observe. self add-menu named \"M\" for-method \"menu\".\n" \
      "  + to observe: self observe instance a for-notification \"hit\" with-method \"told\".\n"             \
      "  + to told by o (object): hits += 1.\n"                                                              \
      "  + to menu: hits += 1000.\n"                                                                         \
      "}\n"                                                                                                  \
      "Mobile : Left { + to init: self set-velocity to (1, 0, 0).\n"                                         \
      "    self handle-collisions with-type \"Right\" with-method \"hit\".\n"                                \
      "  + to hit other o (object): " METHOD                                                                 \
      " }\n"                                                                                                 \
      "Mobile : Right { + to init: self move to (3, 0, 0). }\n"

static void handlers_observers_and_menus_are_kept_though_class_numbers_change(void) {
  scene s;
  if (!scene_open_text(&s, CLASH("", "self announce message \"hit\"."), NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "hits") == 0);
  CHECK_STATUS(BREVE_OK, reload(&s, CLASH("Object : Aaa { }\nMobile : Bbb { }\n",
                                          "self announce message \"hit\". self set-velocity to (-1, 0, 0).")));
  for (int i = 0; i < 40; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "hits") == 1);
  breve_menu_item items[20];
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_menu_items(s.world, items, 20, &count));
  CHECK(count >= 1 && count <= 20);
  CHECK_STATUS(BREVE_OK, breve_world_queue_choice(s.world, items[count - 1].item));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "hits") == 1001);
  scene_close(&s);
}

#define TOUCHING(TOLD, MET)                                                                                 \
  HEAD "Control : Stage { + variables: hits, met (int).\n"                                                  \
       "  + to init: new Left. new Right. self observe instance self for-notification \"hit\" with-method " \
       "\"told\".\n"                                                                                        \
       "  + to told: hits += " TOLD                                                                         \
       ".\n"                                                                                                \
       "  + to meet: met += " MET                                                                           \
       ".\n"                                                                                                \
       "  + to iterate: self announce message \"hit\". super iterate. }\n"                                  \
       "Mobile : Left { + to init: self handle-collisions with-type \"Right\" with-method \"hit\".\n"       \
       "  + to hit other o (object): controller meet. }\n"                                                  \
       "Mobile : Right { + to init: self move to (0.5, 0, 0). }\n"

/* The method found for a handler that has already run is forgotten with the old program. */
static void handlers_that_have_run_are_replaced(void) {
  scene s;
  if (!scene_open_text(&s, TOUCHING("1", "1"), NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  const int hits = int_of(&s, "hits"), met = int_of(&s, "met");
  CHECK(hits == 1 && met >= 1);
  for (int i = 0; i < 3; ++i) {
    CHECK_STATUS(BREVE_OK, reload(&s, TOUCHING("100", "100")));
    CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  }
  CHECK(int_of(&s, "hits") == 301);
  CHECK(int_of(&s, "met") == met + 300 * met);
  scene_close(&s);
}

static void what_cannot_be_is_refused_and_changes_nothing(void) {
  scene s;
  if (!scene_open_text(&s, before, NULL)) return;
  static const struct {
    const char *text, *says;
  } cases[] = {
      {HEAD "Control : Stage { }\n", "1 object of class Bug"},
      {HEAD "Control : Stage { }\nObject : Bug { }\n", "Mobile"},
      {HEAD "Control : Stage { }\nStationary : Bug { }\n", "Stationary"},
      {HEAD "Object : Stage { }\nMobile : Bug { }\n", "Stage"},
      {"@use Control.\n@use Mobile.\nController Other.\nControl : Other { }\nControl : Stage { }\nMobile : Bug { }\n",
       "Other"},
      {"@use Control.\n@use Mobile.\nController Other.\nControl : Other { }\nMobile : Bug { }\n", "Stage"},
  };
  const uint64_t hash = hash_of(s.world);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    CHECK_STATUS(BREVE_ERROR_RELOAD, reload(&s, cases[i].text));
    const breve_error* error = breve_world_last_error(s.world);
    check_that(error && strstr(error->message, cases[i].says), cases[i].says, __FILE__, __LINE__);
    CHECK(hash_of(s.world) == hash);
  }
  CHECK_TEXT("BREVE_ERROR_RELOAD", breve_status_name(BREVE_ERROR_RELOAD));
  CHECK(call_int(&s, breve_world_controller(s.world), "value") == 1);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  /* Without objects of it a class may go. */
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, value_of(&s, "bug").as.object));
  CHECK_STATUS(BREVE_OK, reload(&s, HEAD "Control : Stage { + to value: return 3. }\n"));
  CHECK(call_int(&s, breve_world_controller(s.world), "value") == 3);
  scene_close(&s);
}

static void reload_in_print(breve_world* world, void* context) {
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_reload(world, context));
}

static void nothing_is_replaced_while_it_runs(void) {
  scene s;
  if (!scene_open_text(&s, HEAD "Control : Stage { + to iterate: print 1. super iterate. }\n", NULL)) return;
  s.said.on_print = reload_in_print;
  s.said.context = s.program;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(s.said.prints == 1);
  scene_close(&s);
}

static void other_worlds_of_the_program_are_left_alone(void) {
  scene s;
  if (!scene_open_text(&s, before, NULL)) return;
  breve_world* other = NULL;
  CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, NULL, &other));
  const uint64_t hash = hash_of(other);
  CHECK_STATUS(BREVE_OK, reload(&s, after));
  CHECK(hash_of(other) == hash);
  breve_value v;
  CHECK_STATUS(BREVE_OK, breve_object_call(other, breve_world_controller(other), "value", NULL, 0, &v));
  CHECK(v.as.integer == 1);
  CHECK_STATUS(BREVE_OK, breve_world_step(other));
  CHECK_STATUS(BREVE_OK, breve_world_destroy(other));
  scene_close(&s);
}

static void snapshots_belong_to_the_program_they_were_taken_with(void) {
  scene s;
  if (!scene_open_text(&s, before, NULL)) return;
  static unsigned char image[1 << 20];
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, sizeof image, &size));
  CHECK_STATUS(BREVE_OK, reload(&s, after));
  CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_restore(s.world, image, size));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, sizeof image, &size));
  const uint64_t hash = hash_of(s.world);
  for (int i = 0; i < 5; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  CHECK(hash_of(s.world) == hash);
  scene_close(&s);
}

static void the_session_is_kept(void) {
  scene s;
  if (!scene_open_text(&s, before, NULL)) return;
  const breve_object nobody = {0, 0};
  breve_value v;
  CHECK_STATUS(BREVE_OK, breve_world_evaluate(s.world, nobody, "x = { bug, 4 }", 14, NULL));
  CHECK_STATUS(BREVE_OK, reload(&s, after));
  CHECK_STATUS(BREVE_OK, breve_world_evaluate(s.world, nobody, "x{1} + (self value)", 19, &v));
  CHECK(v.as.integer == 6);
  CHECK_STATUS(BREVE_OK, breve_world_evaluate(s.world, nobody, "x{0} get-turns", 14, &v));
  CHECK(v.as.integer == 5);
  scene_close(&s);
}

static void an_object_that_no_longer_fits_a_variable_is_let_go(void) {
  scene s;
  if (!scene_open_text(&s, HEAD "Control : Stage { + variables: a, b (object). + to init: a = new Mobile. b = a. }\n",
                       NULL))
    return;
  CHECK_STATUS(BREVE_OK,
               reload(&s, HEAD "Control : Stage { + variables: a (Stationary object). b (Mobile object). }\n"));
  CHECK(value_of(&s, "a").as.object.index == 0 && value_of(&s, "a").as.object.generation == 0);
  CHECK(value_of(&s, "b").as.object.generation != 0);
  CHECK(s.said.warnings == 1);
  scene_close(&s);
}

static void what_only_a_dropped_variable_held_is_collected(void) {
  static const char* const held = HEAD
      "Control : Stage { + variables: keeper (object). + to init: keeper = new Left. }\n"
      "Object : Left { + to init: self enable-auto-free. + to destroy: print \"gone\". }\n";
  scene s;
  if (!scene_open_text(&s, held, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_TEXT("", s.said.print);
  CHECK_STATUS(BREVE_OK, reload(&s, HEAD "Control : Stage { }\n"
                                         "Object : Left { + to destroy: print \"gone now\". }\n"));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_TEXT("gone now\n", s.said.print);
  scene_close(&s);
}

/* An allocator that fails once `left` allocations were made. */
static long left = -1;
static void* scarce(void* user, size_t size, size_t alignment) {
  (void)user;
  if (left == 0) return NULL;
  if (left > 0) --left;
  return aligned_alloc(alignment < 16 ? 16 : alignment, (size + 15) / 16 * 16 + (alignment > 16 ? alignment : 0));
}
static void give_back(void* user, void* memory, size_t size, size_t alignment) {
  (void)user, (void)size, (void)alignment;
  free(memory);
}

static void no_memory_in_the_middle_changes_nothing(void) {
  breve_runtime_config config = breve_runtime_config_default();
  config.allocate = scarce;
  config.release = give_back;
  breve_runtime* runtime = NULL;
  breve_program *old = NULL, *new = NULL;
  breve_world* world = NULL;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &runtime));
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "before.tz", before, strlen(before), &old));
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "after.tz", after, strlen(after), &new));
  CHECK_STATUS(BREVE_OK, breve_world_create(runtime, old, NULL, &world));
  const uint64_t hash = hash_of(world);
  breve_status status = BREVE_ERROR_MEMORY;
  long n = 0;
  for (; n < 100000 && status == BREVE_ERROR_MEMORY; ++n) {
    left = n;
    status = breve_world_reload(world, new);
    left = -1;
    if (status == BREVE_ERROR_MEMORY) CHECK(hash_of(world) == hash);
  }
  CHECK_STATUS(BREVE_OK, status);
  CHECK(n > 5);
  CHECK(hash_of(world) != hash);
  CHECK_STATUS(BREVE_OK, breve_world_step(world));
  CHECK_STATUS(BREVE_OK, breve_world_destroy(world));
  breve_program_destroy(old);
  breve_program_destroy(new);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

void reload_suite(void) {
  RUN(the_same_program_changes_no_bit);
  RUN(instances_keep_their_values_by_name);
  RUN(prepared_selectors_and_collision_handlers_go_on_working);
  RUN(handlers_that_have_run_are_replaced);
  RUN(handlers_observers_and_menus_are_kept_though_class_numbers_change);
  RUN(what_cannot_be_is_refused_and_changes_nothing);
  RUN(nothing_is_replaced_while_it_runs);
  RUN(other_worlds_of_the_program_are_left_alone);
  RUN(snapshots_belong_to_the_program_they_were_taken_with);
  RUN(the_session_is_kept);
  RUN(an_object_that_no_longer_fits_a_variable_is_let_go);
  RUN(what_only_a_dropped_variable_held_is_collected);
  RUN(no_memory_in_the_middle_changes_nothing);
}
