/* What a host keeps with worlds and objects, state of it that is part of snapshots, and the memory that it takes. */
#include "scene.h"

typedef struct guest {
  transcript said;
  breve_runtime* runtime;
  breve_program* program;
  breve_world* world;
} guest;

static const char* const text =
    "@use Control.\n@use Mobile.\nController Herd.\n"
    "Control : Herd { + variables: wolf (object). + to init: wolf = new Mobile. + to free-wolf: free wolf. }\n";

static bool guest_begin(guest* g, const breve_world_config* world) {
  breve_runtime_config config = breve_runtime_config_default();
  memset(g, 0, sizeof *g);
  config.user = &g->said;
  config.print = remember;
  return CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &g->runtime)) &&
         CHECK_STATUS(BREVE_OK, breve_program_compile(g->runtime, "herd.tz", text, strlen(text), &g->program)) &&
         CHECK_STATUS(BREVE_OK, breve_world_create(g->runtime, g->program, world, &g->world));
}

static void guest_close(guest* g) {
  CHECK_STATUS(BREVE_OK, breve_world_destroy(g->world));
  breve_program_destroy(g->program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(g->runtime));
}

static void count_up(void* user) { ++*(int*)user; }

static void data_of_worlds_and_objects_ends_with_them(void) {
  guest g;
  breve_object one, two;
  int of_world = 0, of_other = 0, of_one = 0, of_two = 0;
  void* user = NULL;
  if (!guest_begin(&g, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_set_user(g.world, &of_world, count_up));
  CHECK(breve_world_user(g.world) == &of_world);
  CHECK_STATUS(BREVE_OK, breve_world_set_user(g.world, &of_other, count_up));
  CHECK(of_world == 1);
  CHECK_STATUS(BREVE_OK, breve_object_create(g.world, "Mobile", &one));
  CHECK_STATUS(BREVE_OK, breve_object_create(g.world, "Mobile", &two));
  CHECK_STATUS(BREVE_OK, breve_object_user(g.world, one, &user));
  CHECK(user == NULL);
  CHECK_STATUS(BREVE_OK, breve_object_set_user(g.world, one, &of_one, count_up));
  CHECK_STATUS(BREVE_OK, breve_object_set_user(g.world, two, &of_two, count_up));
  CHECK_STATUS(BREVE_OK, breve_object_user(g.world, two, &user));
  CHECK(user == &of_two);
  CHECK_STATUS(BREVE_OK, breve_object_free(g.world, one));
  CHECK(of_one == 1 && of_two == 0);
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_user(g.world, one, &user));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_set_user(g.world, one, &of_one, count_up));
  guest_close(&g);
  CHECK(of_two == 1 && of_other == 1);
}

static void data_of_many_objects_takes_little_memory(void) {
  enum { kMany = 1000, kMost = 200 }; /* bytes for each object, those that the vector keeps for growth included */
  guest g;
  breve_object all[kMany];
  int ended = 0;
  breve_stats before = breve_stats_default(), after = breve_stats_default();
  if (!guest_begin(&g, NULL)) return;
  for (size_t i = 0; i < kMany; ++i) CHECK_STATUS(BREVE_OK, breve_object_create(g.world, "Mobile", &all[i]));
  CHECK_STATUS(BREVE_OK, breve_world_stats(g.world, &before));
  for (size_t i = 0; i < kMany; ++i) CHECK_STATUS(BREVE_OK, breve_object_set_user(g.world, all[i], &ended, count_up));
  CHECK_STATUS(BREVE_OK, breve_world_stats(g.world, &after));
  CHECK(after.memory_used - before.memory_used < kMany * kMost);
  guest_close(&g);
  CHECK(ended == kMany);
}

/* A counter that scripts of the host would read. */
typedef struct counter {
  int value, loads, gone, ended;
} counter;

static bool save_counter(void* user, breve_world* world, breve_write_fn write, void* sink, breve_write_fn reason,
                         void* reason_sink) {
  counter* c = user;
  (void)world;
  if (c->value < 0) reason(reason_sink, "a negative counter", 18);
  write(sink, (const char*)&c->value, sizeof c->value);
  return c->value >= 0;
}
static bool load_counter(void* user, breve_world* world, const char* bytes, size_t size, bool commit) {
  counter* c = user;
  (void)world;
  ++c->loads;
  if (size != sizeof c->value) return false;
  if (commit) memcpy(&c->value, bytes, size);
  return true;
}
static void object_gone(void* user, breve_object object) {
  (void)object;
  ++((counter*)user)->gone;
}
static void end_counter(void* user) { ++((counter*)user)->ended; }

static void state_of_the_host_is_part_of_snapshots_and_hash(void) {
  static char image[400000], plain[400000];
  guest g;
  counter c = {1, 0, 0, 0};
  uint64_t before = 0, after = 0;
  size_t size = 0, plain_size = 0;
  breve_state state = breve_state_default();
  if (!guest_begin(&g, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(g.world, plain, sizeof plain, &plain_size));
  state.user = &c;
  state.save = save_counter;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_state(g.world, "counter", &state)); /* no `load` */
  state.load = load_counter;
  state.gone = object_gone;
  state.destroy = end_counter;
  CHECK_STATUS(BREVE_OK, breve_world_set_state(g.world, "counter", &state));
  CHECK(breve_world_state(g.world, "counter") == &c && breve_world_state(g.world, "other") == NULL);
  CHECK_STATUS(BREVE_OK, breve_world_hash(g.world, &before));
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(g.world, image, sizeof image, &size));
  c.value = 2;
  CHECK_STATUS(BREVE_OK, breve_world_hash(g.world, &after));
  CHECK(before != after);
  CHECK_STATUS(BREVE_OK, breve_object_call(g.world, breve_world_controller(g.world), "free-wolf", NULL, 0, NULL));
  CHECK(c.gone == 1);
  CHECK_STATUS(BREVE_OK, breve_world_restore(g.world, image, size));
  CHECK(c.value == 1 && c.loads == 2);
  CHECK_STATUS(BREVE_OK, breve_world_hash(g.world, &after));
  CHECK(before == after);
  CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_restore(g.world, plain, plain_size));
  for (size_t cut = 1; cut < 40; ++cut)
    CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_restore(g.world, image, size - cut));
  c.value = -1;
  CHECK_STATUS(BREVE_ERROR_UNSUPPORTED, breve_world_snapshot(g.world, image, sizeof image, &size));
  CHECK_TEXT("a negative counter", breve_world_last_error(g.world)->message);
  guest_close(&g);
  CHECK(c.ended == 1);
}

/* Data whose end attaches data to other objects, so that the world's table of them moves, and replaces itself. */
typedef struct herd {
  breve_world* world;
  breve_object others[200], own;
  size_t used;
  int ended;
  breve_status destroyed;
} herd;

static void end_of_later_data(void* user) { ++((herd*)user)->ended; }
static void attach_to_others(void* user) {
  herd* h = user;
  ++h->ended;
  while (h->used < sizeof h->others / sizeof *h->others)
    breve_object_set_user(h->world, h->others[h->used++], h, end_of_later_data);
  breve_object_set_user(h->world, h->own, h, end_of_later_data);
  h->destroyed = breve_world_destroy(h->world);
}
static void destroy_again(void* user) {
  herd* h = user;
  ++h->ended;
  h->destroyed = breve_world_destroy(h->world);
}

static void the_end_of_data_may_attach_and_replace_data(void) {
  const int others = sizeof((herd*)0)->others / sizeof(breve_object);
  guest g;
  herd h = {0};
  if (!guest_begin(&g, NULL)) return;
  h.world = g.world;
  CHECK_STATUS(BREVE_OK, breve_object_create(g.world, "Mobile", &h.own));
  for (int i = 0; i < others; ++i) CHECK_STATUS(BREVE_OK, breve_object_create(g.world, "Mobile", &h.others[i]));
  CHECK_STATUS(BREVE_OK, breve_object_set_user(g.world, h.own, &h, attach_to_others));
  CHECK_STATUS(BREVE_OK, breve_object_free(g.world, h.own));
  CHECK(h.ended == 1 && h.destroyed == BREVE_ERROR_BUSY); /* a script's `free` was going on */
  CHECK_STATUS(BREVE_OK, breve_object_set_user(g.world, h.others[0], &h, attach_to_others));
  h.own = h.others[0];
  CHECK_STATUS(BREVE_OK,
               breve_object_set_user(g.world, h.own, &h, end_of_later_data)); /* after what the first one attached */
  CHECK(h.ended == 4); /* with the data that it replaced itself */
  CHECK_STATUS(BREVE_OK, breve_world_set_user(g.world, &h, destroy_again));
  guest_close(&g);
  /* The data attached to the object that was being freed has ended with the world. */
  CHECK(h.ended == 6 + others && h.destroyed == BREVE_ERROR_BUSY);
}

/* A state whose callbacks replace it. */
typedef struct meddler {
  breve_world* world;
  breve_status saved, loaded, gone;
} meddler;

static bool save_meddler(void* user, breve_world* world, breve_write_fn write, void* sink, breve_write_fn reason,
                         void* reason_sink) {
  (void)reason, (void)reason_sink;
  write(sink, "x", 1);
  ((meddler*)user)->saved = breve_world_set_state(world, "meddler", NULL);
  return true;
}
static bool load_meddler(void* user, breve_world* world, const char* bytes, size_t size, bool commit) {
  (void)commit;
  ((meddler*)user)->loaded = breve_world_set_state(world, "meddler", NULL);
  return size == 1 && bytes[0] == 'x';
}
static void meddler_gone(void* user, breve_object object) {
  meddler* m = user;
  (void)object;
  m->gone = breve_world_set_state(m->world, "meddler", NULL);
}

static void a_state_may_not_be_replaced_by_its_own_callbacks(void) {
  static char image[400000];
  guest g;
  size_t size = 0;
  breve_object object;
  breve_state state = breve_state_default();
  if (!guest_begin(&g, NULL)) return;
  meddler m = {g.world, BREVE_OK, BREVE_OK, BREVE_OK};
  state.user = &m;
  state.save = save_meddler;
  state.load = load_meddler;
  state.gone = meddler_gone;
  CHECK_STATUS(BREVE_OK, breve_world_set_state(g.world, "meddler", &state));
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(g.world, image, sizeof image, &size));
  CHECK_STATUS(BREVE_OK, breve_object_create(g.world, "Mobile", &object));
  CHECK_STATUS(BREVE_OK, breve_object_free(g.world, object));
  CHECK_STATUS(BREVE_OK, breve_world_restore(g.world, image, size));
  CHECK(m.saved == BREVE_ERROR_BUSY && m.loaded == BREVE_ERROR_BUSY && m.gone == BREVE_ERROR_BUSY);
  CHECK_STATUS(BREVE_OK, breve_world_set_state(g.world, "meddler", NULL));
  guest_close(&g);
}

static void memory_of_the_host_counts_against_the_limit(void) {
  guest g;
  breve_stats stats = breve_stats_default();
  breve_world_config config = breve_world_config_default();
  config.memory_limit = 8 << 20;
  if (!guest_begin(&g, &config)) return;
  CHECK_STATUS(BREVE_OK, breve_world_stats(g.world, &stats));
  const size_t used = stats.memory_used;
  void* memory = breve_world_allocate(g.world, 1 << 20);
  CHECK(memory != NULL && breve_world_allocate(g.world, 9 << 20) == NULL && breve_world_allocate(g.world, 0) == NULL);
  CHECK_STATUS(BREVE_OK, breve_world_stats(g.world, &stats));
  CHECK(stats.memory_used == used + (1 << 20));
  breve_world_release(g.world, memory, 1 << 20);
  CHECK_STATUS(BREVE_OK, breve_world_stats(g.world, &stats));
  CHECK(stats.memory_used == used && !breve_world_has_budget(g.world));
  guest_close(&g);
}

static void hosts_print_and_draw_as_scripts_do(void) {
  guest g;
  breve_value bound = breve_value_int(5), drawn;
  if (!guest_begin(&g, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_print(g.world, "moo\n", 4));
  CHECK_TEXT("moo\n", g.said.print);
  for (int i = 0; i < 50; ++i) {
    CHECK_STATUS(BREVE_OK, breve_world_random(g.world, &bound, &drawn));
    CHECK(drawn.type == BREVE_TYPE_INT && drawn.as.integer >= 0 && drawn.as.integer <= 5);
  }
  bound = breve_value_vector(1, 0, 2);
  CHECK_STATUS(BREVE_OK, breve_world_random(g.world, &bound, &drawn));
  CHECK(drawn.type == BREVE_TYPE_VECTOR && drawn.as.vector[1] == 0);
  bound = breve_value_string("x");
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_world_random(g.world, &bound, &drawn));
  guest_close(&g);
}

void user_data_suite(void) {
  RUN(data_of_worlds_and_objects_ends_with_them);
  RUN(data_of_many_objects_takes_little_memory);
  RUN(state_of_the_host_is_part_of_snapshots_and_hash);
  RUN(the_end_of_data_may_attach_and_replace_data);
  RUN(a_state_may_not_be_replaced_by_its_own_callbacks);
  RUN(memory_of_the_host_counts_against_the_limit);
  RUN(hosts_print_and_draw_as_scripts_do);
}
