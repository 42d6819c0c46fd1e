/* Profiles: a tree that adds up, events that nest, and a world that does not notice. */
#include <stdlib.h>

#include "scene.h"

static const char* const program_text =
    "@use Control.\n"                             /*  1 */
    "@use Mobile.\n"                              /*  2 */
    "Controller Main.\n"                          /*  3 */
    "Control : Main {\n"                          /*  4 */
    "  + variables:\n"                            /*  5 */
    "    worker (object).\n"                      /*  6 */
    "  + to init:\n"                              /*  7 */
    "    worker = new Worker.\n"                  /*  8 */
    "    worker set-velocity to (1, 0, 0).\n"     /*  9 */
    "  + to iterate:\n"                           /* 10 */
    "    worker work turns 3.\n"                  /* 11 */
    "    worker work turns 2.\n"                  /* 12 */
    "    super iterate.\n"                        /* 13 */
    "  + to count-down from n (int):\n"           /* 14 */
    "    if n > 0: self count-down from n - 1.\n" /* 15 */
    "  + to fall:\n"                              /* 16 */
    "    self stumble.\n"                         /* 17 */
    "  + to stumble:\n"                           /* 18 */
    "    sqrt(4.0).\n"                            /* 19 */
    "    die \"fallen\".\n"                       /* 20 */
    "  + to ask:\n"                               /* 21 */
    "    print \"asked\".\n"                      /* 22 */
    "    free (new Worker).\n"                    /* 23 */
    "  + to order:\n"                             /* 24 */
    "    l (list).\n"                             /* 25 */
    "    l = { 3, 1, 2 }.\n"                      /* 26 */
    "    sort l with compare.\n"                  /* 27 */
    "    return l{0}.\n"                          /* 28 */
    "  + to compare a x (int) b y (int):\n"       /* 29 */
    "    return x - y.\n"                         /* 30 */
    "  + to spin:\n"                              /* 31 */
    "    while 1: self compare a 1 b 2.\n"        /* 32 */
    "}\n"
    "Mobile : Worker {\n"          /* 34 */
    "  + to work turns n (int):\n" /* 35 */
    "    i (int).\n"
    "    for i = 0, i < n, i++: self rest.\n" /* 37 */
    "  + to rest:\n"                          /* 38 */
    "    return random[1.0].\n"
    "}\n";

static bool open_profiled(scene* s, breve_trace_fn trace, void* user) {
  breve_world_config config = breve_world_config_default();
  config.profile = true;
  config.trace = trace;
  config.trace_user = user;
  return scene_open_text(s, program_text, &config);
}

static size_t count_of(scene* s) {
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_profile_node_count(s->world, &count));
  return count;
}

static breve_profile_node node_at(scene* s, size_t index) {
  breve_profile_node node;
  memset(&node, 0, sizeof node);
  CHECK_STATUS(BREVE_OK, breve_world_profile_node(s->world, index, &node));
  return node;
}

/* The child of a node with this name and line of call; 0 if there is none. */
static size_t child(scene* s, size_t parent, const char* class_name, const char* name, uint32_t call_line) {
  const size_t count = count_of(s);
  for (size_t i = parent + 1; i < count; ++i) {
    const breve_profile_node n = node_at(s, i);
    if (n.parent == parent && strcmp(n.class_name, class_name) == 0 && strcmp(n.name, name) == 0 &&
        n.call_line == call_line)
      return i;
  }
  return 0;
}

static void calls_are_counted_below_the_line_that_made_them(void) {
  scene s;
  if (!open_profiled(&s, NULL, NULL)) return;
  for (int i = 0; i < 10; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  const breve_profile_node root = node_at(&s, 0);
  CHECK(root.kind == BREVE_PROFILE_WORLD && root.parent == 0 && root.calls == 0 && root.self_seconds == 0);
  const size_t iteration = child(&s, 0, "", "iteration", 0);
  CHECK(node_at(&s, iteration).calls == 10 && node_at(&s, iteration).kind == BREVE_PROFILE_STAGE);
  const size_t script = child(&s, iteration, "", "script", 0);
  const size_t iterate = child(&s, script, "Main", "iterate", 0);
  CHECK(iterate != 0 && node_at(&s, iterate).calls == 10 && node_at(&s, iterate).line == 10);
  const size_t three = child(&s, iterate, "Worker", "work", 11), two = child(&s, iterate, "Worker", "work", 12);
  CHECK(three != 0 && two != 0 && node_at(&s, three).calls == 10 && node_at(&s, two).calls == 10);
  const breve_profile_node rest = node_at(&s, child(&s, three, "Worker", "rest", 37));
  CHECK(rest.calls == 30 && rest.kind == BREVE_PROFILE_METHOD && rest.line == 38);
  CHECK_TEXT("scene.tz", rest.file);
  CHECK(node_at(&s, child(&s, two, "Worker", "rest", 37)).calls == 20);
  CHECK(child(&s, iteration, "", "garbage", 0) != 0);
  scene_close(&s);
}

static void init_and_what_the_engine_does_are_in_the_tree(void) {
  scene s;
  if (!open_profiled(&s, NULL, NULL)) return;
  const size_t made = child(&s, 0, "Main", "new", 0);
  const size_t init = child(&s, made, "Main", "init", 0);
  const size_t worker = child(&s, init, "Worker", "new", 8);
  CHECK(made != 0 && init != 0 && worker != 0 && node_at(&s, worker).kind == BREVE_PROFILE_ACT);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  bool native = false, motion = false;
  for (size_t i = 0; i < count_of(&s); ++i) {
    const breve_profile_node n = node_at(&s, i);
    if (n.kind == BREVE_PROFILE_NATIVE && n.line != 0) native = true;
    if (strcmp(n.name, "motion") == 0) {
      motion = n.calls == 3 && node_at(&s, n.parent).kind == BREVE_PROFILE_NATIVE; /* 3 integration steps */
      CHECK_STATUS(BREVE_OK, breve_world_profile_stop(s.world));
    }
  }
  CHECK(native && motion);
  scene_close(&s);
}

static void totals_are_the_sums_of_what_is_below(void) {
  scene s;
  if (!open_profiled(&s, NULL, NULL)) return;
  for (int i = 0; i < 50; ++i) breve_world_step(s.world);
  const size_t count = count_of(&s);
  double* sums = calloc(count, sizeof *sums);
  for (size_t i = count; i-- > 0;) {
    const breve_profile_node n = node_at(&s, i);
    CHECK(n.self_seconds >= 0 && n.parent <= i);
    sums[i] += n.self_seconds;
    CHECK_NEAR(n.total_seconds, sums[i], 1e-12);
    if (i != 0) sums[n.parent] += sums[i];
  }
  free(sums);
  double cost = -1;
  CHECK_STATUS(BREVE_OK, breve_world_profile_cost(s.world, &cost));
  CHECK(cost >= 0 && node_at(&s, 0).total_seconds > 0);
  scene_close(&s);
}

/* Both are made of the same readings of the clock; only a profile has its own cost taken out. */
static void stages_agree_with_the_effects(void) {
  scene s;
  breve_effect effects[32];
  size_t count = 0;
  double cost = 0;
  if (!scene_open_text(&s, program_text, NULL)) return;
  for (int i = 0; i < 5; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_profile_start(s.world, NULL, NULL));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_profile_cost(s.world, &cost));
  CHECK_STATUS(BREVE_OK, breve_world_effects(s.world, effects, 32, &count));
  int compared = 0;
  for (size_t e = 0; e < count; ++e) {
    double seconds = 0;
    for (size_t i = 0; i < count_of(&s); ++i)
      if (strcmp(node_at(&s, i).name, effects[e].name) == 0) seconds += node_at(&s, i).total_seconds;
    const double rounding = 1e-9;
    CHECK(seconds <= effects[e].seconds + rounding);
    CHECK(seconds >= effects[e].seconds - cost - rounding);
    if (effects[e].seconds > 0) ++compared;
  }
  CHECK(compared >= 2); /* script and motion */
  scene_close(&s);
}

static void recursion_counts_in_one_node(void) {
  scene s;
  if (!open_profiled(&s, NULL, NULL)) return;
  const breve_object controller = breve_world_controller(s.world);
  const breve_keyword from = {"from", breve_value_int(1000)};
  const size_t before = count_of(&s);
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, controller, "count-down", &from, 1, NULL));
  CHECK(count_of(&s) == before + 1);
  CHECK(node_at(&s, child(&s, 0, "Main", "count-down", 0)).calls == 1001);
  scene_close(&s);
}

static void errors_leave_the_tree_in_order(void) {
  scene s;
  if (!open_profiled(&s, NULL, NULL)) return;
  const breve_object controller = breve_world_controller(s.world);
  for (int i = 0; i < 3; ++i)
    CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_call(s.world, controller, "fall", NULL, 0, NULL));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  const size_t fall = child(&s, 0, "Main", "fall", 0);
  const size_t stumble = child(&s, fall, "Main", "stumble", 17);
  CHECK(node_at(&s, fall).calls == 3 && node_at(&s, stumble).calls == 3);
  CHECK(node_at(&s, child(&s, 0, "", "iteration", 0)).calls == 1);
  scene_close(&s);
}

static void acts_and_functions_have_nodes(void) {
  scene s;
  if (!open_profiled(&s, NULL, NULL)) return;
  const breve_object controller = breve_world_controller(s.world);
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, controller, "ask", NULL, 0, NULL));
  const size_t ask = child(&s, 0, "Main", "ask", 0);
  CHECK(child(&s, ask, "", "print", 22) != 0 && child(&s, ask, "Worker", "new", 23) != 0 &&
        child(&s, ask, "Worker", "free", 23) != 0);
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, controller, "order", NULL, 0, NULL));
  const size_t sort = child(&s, child(&s, 0, "Main", "order", 0), "", "sort", 27);
  CHECK(sort != 0 && node_at(&s, child(&s, sort, "Main", "compare", 0)).calls >= 2);
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_call(s.world, controller, "fall", NULL, 0, NULL));
  scene_close(&s);
}

/* What a trace told: is it well nested, and is its time monotonic? */
typedef struct record {
  int depth, deepest, events, wrong;
  double last;
  bool rest_seen;
  breve_world* world;
  breve_status status;
} record;

static void watch(void* user, const breve_trace_event* event) {
  record* r = user;
  ++r->events;
  r->depth += event->begins ? 1 : -1;
  if (r->depth > r->deepest) r->deepest = r->depth;
  if (r->depth < 0 || event->seconds < r->last) ++r->wrong;
  r->last = event->seconds;
  if (strcmp(event->name, "rest") == 0 && event->begins)
    r->rest_seen = strcmp(event->class_name, "Worker") == 0 && event->line == 38 && event->call_line == 37 &&
                   strcmp(event->file, "scene.tz") == 0 && event->kind == BREVE_PROFILE_METHOD;
  if (r->world) r->status = breve_object_call(r->world, breve_world_controller(r->world), "ask", NULL, 0, NULL);
}

static void events_nest_and_follow_the_clock(void) {
  scene s;
  record r = {0};
  if (!open_profiled(&s, watch, &r)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_call(s.world, breve_world_controller(s.world), "fall", NULL, 0, NULL));
  CHECK(r.depth == 0 && r.deepest >= 5 && r.wrong == 0 && r.rest_seen);
  uint64_t calls = 0;
  for (size_t i = 0; i < count_of(&s); ++i) calls += node_at(&s, i).calls;
  CHECK((uint64_t)r.events == 2 * calls);
  scene_close(&s);
}

static void a_trace_callback_cannot_run_script(void) {
  scene s;
  record r = {0};
  if (!scene_open_text(&s, program_text, NULL)) return;
  r.world = s.world;
  CHECK_STATUS(BREVE_OK, breve_world_profile_start(s.world, watch, &r));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(r.events > 0 && r.status == BREVE_ERROR_BUSY && s.said.prints == 0);
  scene_close(&s);
}

static void profile_from_inside(breve_world* world, void* context) {
  breve_profile_node node;
  size_t count;
  double cost;
  (void)context;
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_profile_start(world, NULL, NULL));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_profile_stop(world));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_profile_node_count(world, &count));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_profile_node(world, 0, &node));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_profile_cost(world, &cost));
}

static void a_running_script_is_busy(void) {
  scene s;
  if (!open_profiled(&s, NULL, NULL)) return;
  s.said.on_print = profile_from_inside;
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "ask", NULL, 0, NULL));
  CHECK(s.said.prints == 1);
  scene_close(&s);
}

static void a_profile_is_kept_until_the_next(void) {
  scene s;
  breve_profile_node node;
  size_t count;
  double cost;
  if (!scene_open_text(&s, program_text, NULL)) return;
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_profile_stop(s.world));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_profile_node_count(s.world, &count));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_profile_node(s.world, 0, &node));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_profile_cost(s.world, &cost));
  CHECK_STATUS(BREVE_OK, breve_world_profile_start(s.world, NULL, NULL));
  CHECK(count_of(&s) == 1);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_profile_stop(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_profile_stop(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(node_at(&s, child(&s, 0, "", "iteration", 0)).calls == 1);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_profile_node(s.world, count_of(&s), &node));
  CHECK_STATUS(BREVE_OK, breve_world_profile_start(s.world, NULL, NULL));
  CHECK(count_of(&s) == 1);
  scene_close(&s);
}

static void profiling_changes_neither_hash_nor_budget(void) {
  uint64_t hashes[2] = {0, 1};
  for (int profiled = 0; profiled < 2; ++profiled) {
    scene s;
    record r = {0};
    breve_world_config config = breve_world_config_default();
    config.budget = 1000;
    config.profile = profiled;
    config.trace = watch;
    config.trace_user = &r;
    if (!scene_open_text(&s, program_text, &config)) return;
    for (int i = 0; i < 20; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    CHECK_STATUS(BREVE_ERROR_BUDGET,
                 breve_object_call(s.world, breve_world_controller(s.world), "spin", NULL, 0, NULL));
    CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &hashes[profiled]));
    CHECK((r.events != 0) == profiled);
    scene_close(&s);
  }
  CHECK(hashes[0] == hashes[1]);
}

/* Sorting, printing, making and freeing too cost as much of a budget with a profile as without. */
static void a_budget_cuts_at_the_same_place(void) {
  static const char* const methods[] = {"order", "ask"};
  scene s;
  int cut = 0, done = 0;
  if (!scene_open_text(&s, program_text, NULL)) return;
  for (uint64_t budget = 1; budget < 30; ++budget) {
    breve_status statuses[2][2] = {{BREVE_OK, BREVE_OK}, {BREVE_OK, BREVE_OK}};
    uint64_t hashes[2] = {0, 0};
    for (int profiled = 0; profiled < 2; ++profiled) {
      breve_world_config config = breve_world_config_default();
      breve_world* world = NULL;
      config.budget = budget;
      config.profile = profiled;
      statuses[profiled][0] = breve_world_create(s.runtime, s.program, &config, &world);
      if (!world) continue;
      for (int m = 0; m < 2; ++m)
        statuses[profiled][m] = breve_object_call(world, breve_world_controller(world), methods[m], NULL, 0, NULL);
      CHECK_STATUS(BREVE_OK, breve_world_hash(world, &hashes[profiled]));
      CHECK_STATUS(BREVE_OK, breve_world_destroy(world));
    }
    for (int m = 0; m < 2; ++m) {
      CHECK_STATUS(statuses[0][m], statuses[1][m]);
      if (statuses[0][m] == BREVE_ERROR_BUDGET) ++cut;
      if (statuses[0][m] == BREVE_OK) ++done;
    }
    CHECK(hashes[0] == hashes[1]);
  }
  CHECK(cut > 5 && done > 5);
  scene_close(&s);
}

static void a_profile_without_memory_ends_and_the_run_goes_on(void) {
  scene s;
  breve_stats stats = breve_stats_default();
  if (!scene_open_text(&s, program_text, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_stats(s.world, &stats));
  bool ended = false, whole = false;
  /* A world that has all it needs, with room for nothing more, up to room for its profile. */
  for (size_t room = 0; room <= 100 * 1000 && !whole; room += 200) {
    breve_world_config config = breve_world_config_default();
    config.memory_limit = stats.memory_peak + room;
    breve_world* world = NULL;
    if (!CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, &config, &world))) break;
    CHECK_STATUS(BREVE_OK, breve_world_step(world));
    const breve_status started = breve_world_profile_start(world, NULL, NULL);
    CHECK(started == BREVE_OK || started == BREVE_ERROR_MEMORY);
    CHECK_STATUS(BREVE_OK, breve_world_step(world));
    if (started == BREVE_OK) {
      const breve_status stopped = breve_world_profile_stop(world);
      CHECK(stopped == BREVE_OK || stopped == BREVE_ERROR_MEMORY);
      ended = ended || (stopped == BREVE_ERROR_MEMORY && breve_world_last_error(world) != NULL);
      whole = stopped == BREVE_OK;
    }
    CHECK_STATUS(BREVE_OK, breve_world_destroy(world));
  }
  CHECK(ended);
  CHECK(whole);
  scene_close(&s);
}

static void a_reloaded_method_goes_on_in_its_node(void) {
  scene s;
  breve_program* changed = NULL;
  char text[8192];
  if (!open_profiled(&s, NULL, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  const size_t before = count_of(&s);
  snprintf(text, sizeof text, "%s%s", program_text, "% A comment at the end.\n");
  CHECK_STATUS(BREVE_OK, breve_program_compile(s.runtime, "scene.tz", text, strlen(text), &changed));
  CHECK_STATUS(BREVE_OK, breve_world_reload(s.world, changed));
  breve_program_destroy(changed);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(count_of(&s) == before);
  const size_t script = child(&s, child(&s, 0, "", "iteration", 0), "", "script", 0);
  CHECK(node_at(&s, child(&s, script, "Main", "iterate", 0)).calls == 2);
  scene_close(&s);
}

/* --- code of the host ---------------------------------------------------------------------------------------------- */

typedef struct pilot {
  bool leaves; /* what it enters */
} pilot;

/* As a binding of another language would: its own functions, and the lines of its calls. */
static breve_status steer(void* user, const breve_call* call, breve_value* result) {
  static const breve_place look = {"look", "ship.lua", 30}, helper = {"helper", "ship.lua", 40};
  breve_world* w = call->world;
  (void)result;
  CHECK(breve_world_is_profiled(w));
  CHECK_STATUS(BREVE_OK, breve_world_profile_line(w, 21));
  CHECK_STATUS(BREVE_OK, breve_world_profile_enter(w, "Ship", &look));
  CHECK_STATUS(BREVE_OK, breve_world_profile_line(w, 31));
  CHECK_STATUS(BREVE_OK, breve_object_call(w, call->self, "report", NULL, 0, NULL));
  CHECK_STATUS(BREVE_OK, breve_world_profile_enter(w, NULL, &helper));
  if (!((pilot*)user)->leaves) return BREVE_OK;
  CHECK_STATUS(BREVE_OK, breve_world_profile_leave(w));
  CHECK_STATUS(BREVE_OK, breve_world_profile_leave(w));
  /* What the world entered is not the host's to leave. */
  for (int i = 0; i < 3; ++i) CHECK_STATUS(BREVE_OK, breve_world_profile_leave(w));
  return BREVE_OK;
}

static bool open_ship(scene* s, pilot* p) {
  static const char* const text =
      "@use Control.\n@use Ship.\nController Main.\n"
      "Ship : Liner {\n+ to report: return 1.\n}\n" /* 5 */
      "Control : Main {\n+ variables:\n ship (object).\n+ to init:\n ship = new Liner.\n"
      "+ to iterate:\n ship steer.\n ship wait.\n}\n"; /* 13, 14 */
  breve_class ship = breve_class_default();
  breve_world_config config = breve_world_config_default();
  breve_method methods[2];
  const breve_place places[] = {{NULL, "ship.lua", 20}, {NULL, NULL, 0}};
  memset(methods, 0, sizeof methods);
  methods[0].name = "steer";
  methods[1].name = "wait";
  for (int i = 0; i < 2; ++i) methods[i].call = steer, methods[i].user = p;
  ship.name = "Ship";
  ship.methods = methods;
  ship.method_count = 2;
  ship.method_places = places;
  config.profile = true;
  memset(s, 0, sizeof *s);
  CHECK_STATUS(BREVE_OK, breve_runtime_create(NULL, &s->runtime));
  CHECK_STATUS(BREVE_OK, breve_runtime_add_class(s->runtime, &ship));
  return CHECK_STATUS(BREVE_OK, breve_program_compile(s->runtime, "scene.tz", text, strlen(text), &s->program)) &&
         CHECK_STATUS(BREVE_OK, breve_world_create(s->runtime, s->program, &config, &s->world));
}

static void code_of_the_host_is_in_the_tree(void) {
  for (int leaves = 0; leaves < 2; ++leaves) {
    scene s;
    pilot p = {leaves != 0};
    if (!open_ship(&s, &p)) return;
    for (int i = 0; i < 3; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    const size_t script = child(&s, child(&s, 0, "", "iteration", 0), "", "script", 0);
    const size_t iterate = child(&s, script, "Main", "iterate", 0);
    const size_t turn = child(&s, iterate, "Ship", "steer", 13), wait = child(&s, iterate, "Ship", "wait", 14);
    CHECK(turn != 0 && wait != 0 && node_at(&s, turn).calls == 3 && node_at(&s, turn).kind == BREVE_PROFILE_METHOD);
    CHECK_TEXT("ship.lua", node_at(&s, turn).file);
    CHECK(node_at(&s, turn).line == 20 && node_at(&s, turn).parent == iterate);
    const size_t look = child(&s, turn, "Ship", "look", 21);
    CHECK(look != 0 && node_at(&s, look).kind == BREVE_PROFILE_METHOD && node_at(&s, look).line == 30);
    CHECK(node_at(&s, look).calls == 3);
    CHECK_TEXT("ship.lua", node_at(&s, look).file);
    CHECK(node_at(&s, child(&s, look, "Liner", "report", 31)).calls == 3);
    const size_t helper = child(&s, look, "", "helper", 0);
    CHECK(helper != 0 && node_at(&s, helper).kind == BREVE_PROFILE_FUNCTION && node_at(&s, helper).line == 40);
    CHECK(child(&s, wait, "Ship", "look", 21) != 0);
    scene_close(&s);
  }
}

static void without_a_profile_nothing_is_entered(void) {
  static const breve_place place = {"look", "ship.lua", 1};
  scene s;
  if (!scene_open_text(&s, program_text, NULL)) return;
  CHECK(!breve_world_is_profiled(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_profile_enter(s.world, "Ship", &place));
  CHECK_STATUS(BREVE_OK, breve_world_profile_leave(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_profile_start(s.world, NULL, NULL));
  CHECK(breve_world_is_profiled(s.world));
  /* Nothing of the world runs: what the host does meanwhile is not counted. */
  CHECK_STATUS(BREVE_OK, breve_world_profile_enter(s.world, "Ship", &place));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_profile_leave(s.world));
  CHECK(child(&s, 0, "Ship", "look", 0) == 0 && child(&s, 0, "", "iteration", 0) != 0);
  CHECK_STATUS(BREVE_OK, breve_world_profile_stop(s.world));
  CHECK(!breve_world_is_profiled(s.world));
  scene_close(&s);
}

static void enter_from_a_trace(void* user, const breve_trace_event* event) {
  static const breve_place place = {"look", "ship.lua", 1};
  record* r = user;
  (void)event;
  r->status = breve_world_profile_enter(r->world, NULL, &place);
  if (r->status == BREVE_ERROR_BUSY && breve_world_profile_leave(r->world) == BREVE_ERROR_BUSY) ++r->events;
}

static void a_trace_callback_cannot_enter_code(void) {
  scene s;
  record r = {0};
  if (!scene_open_text(&s, program_text, NULL)) return;
  r.world = s.world;
  CHECK_STATUS(BREVE_OK, breve_world_profile_start(s.world, enter_from_a_trace, &r));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(r.events > 0 && r.status == BREVE_ERROR_BUSY);
  scene_close(&s);
}

void profile_suite(void) {
  RUN(calls_are_counted_below_the_line_that_made_them);
  RUN(init_and_what_the_engine_does_are_in_the_tree);
  RUN(totals_are_the_sums_of_what_is_below);
  RUN(stages_agree_with_the_effects);
  RUN(recursion_counts_in_one_node);
  RUN(errors_leave_the_tree_in_order);
  RUN(acts_and_functions_have_nodes);
  RUN(events_nest_and_follow_the_clock);
  RUN(a_trace_callback_cannot_run_script);
  RUN(a_running_script_is_busy);
  RUN(a_profile_is_kept_until_the_next);
  RUN(profiling_changes_neither_hash_nor_budget);
  RUN(a_budget_cuts_at_the_same_place);
  RUN(a_profile_without_memory_ends_and_the_run_goes_on);
  RUN(a_reloaded_method_goes_on_in_its_node);
  RUN(code_of_the_host_is_in_the_tree);
  RUN(without_a_profile_nothing_is_entered);
  RUN(a_trace_callback_cannot_enter_code);
}
