/* Events as callbacks during the iteration: which come when, what a callback may do, and that nothing is lost. */
#include "bodies.h"

typedef struct ear {
  scene s;
  char log[4096];      /* one letter for each event */
  uint64_t iteration;  /* of the last one */
  breve_status status; /* of the last call that a callback made */
  breve_object object; /* that the last one was about */
  void (*act)(struct ear* ear, breve_world* world);
} ear;

static void note(ear* e, breve_world* world, char letter, breve_object object) {
  const size_t length = strlen(e->log);
  CHECK(world == e->s.world);
  if (length + 1 < sizeof e->log) e->log[length] = letter;
  e->iteration = breve_world_iteration(world);
  e->object = object;
  if (e->act) e->act(e, world);
}
static void on_contact(void* user, breve_world* world, const breve_contact* contact) {
  static const char letters[] = "(-)";
  note(user, world, letters[contact->phase], contact->a);
}
static void on_life(void* user, breve_world* world, const breve_life* life) {
  CHECK(life->class_name[0] != '\0');
  note(user, world, life->born ? 'b' : 'd', life->object);
}
static void on_announcement(void* user, breve_world* world, const breve_announcement* announcement) {
  note(user, world, announcement->message[0], announcement->announcer);
}
static void on_nap(void* user, breve_world* world, const breve_nap* nap) {
  note(user, world, nap->asleep ? 'z' : 'w', nap->object);
}
static void on_intervention(void* user, breve_world* world, const breve_intervention* intervention) {
  CHECK(intervention->reason[0] != '\0' && intervention->action[0] != '\0');
  note(user, world, '!', intervention->body);
}

static breve_listener all_ears(ear* e) {
  breve_listener listener = breve_listener_default();
  listener.user = e;
  listener.contact = on_contact;
  listener.life = on_life;
  listener.announcement = on_announcement;
  listener.nap = on_nap;
  listener.intervention = on_intervention;
  return listener;
}

static void set(ear* e, const breve_listener* listener) {
  CHECK_STATUS(BREVE_OK, breve_world_set_listener(e->s.world, listener));
}
static void forget_log(ear* e) { memset(e->log, 0, sizeof e->log); }

static const char* const herd =
    "@use Control.\n@use Mobile.\nController Herd.\n"
    "Control : Herd {\n"
    "  + variables: sheep (object).\n"
    "  + to init: sheep = new Sheep.\n"
    "  + to iterate: self announce message \"1\". super iterate. self announce message \"2\".\n"
    "  + to post-iterate: free sheep. sheep = new Sheep.\n"
    "  + to fail: die \"no\".\n"
    "}\n"
    "Mobile : Sheep { + to iterate: self announce message \"s\". }\n";

static void events_come_in_order_in_each_of_many_iterations(void) {
  ear e = {0};
  if (!scene_open_text(&e.s, herd, NULL)) return;
  const breve_listener listener = all_ears(&e);
  set(&e, &listener);
  CHECK_STATUS(BREVE_OK, breve_world_step(e.s.world));
  CHECK_TEXT("12sdb", e.log); /* a sheep that is born now iterates next time */
  CHECK(e.iteration == 0);    /* the iteration still runs */
  forget_log(&e);
  const double step = breve_world_iteration_step(e.s.world);
  CHECK_STATUS(BREVE_OK, breve_world_advance(e.s.world, 3.5 * step, NULL));
  CHECK_TEXT("12sdb12sdb12sdb", e.log);
  /* The lists hold the last iteration only, as ever. */
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_lives(e.s.world, NULL, 0, &count));
  CHECK(count == 2 && breve_world_events(e.s.world) == 0);
  set(&e, NULL);
  CHECK_STATUS(BREVE_OK, breve_world_lives(e.s.world, NULL, 0, &count));
  CHECK(count == 0); /* nobody asks for them any more */
  forget_log(&e);
  CHECK_STATUS(BREVE_OK, breve_world_step(e.s.world));
  CHECK_TEXT("", e.log);
  CHECK(!effect_of(&e.s, "events")->active || effect_of(&e.s, "events")->items == 0);
  scene_close(&e.s);
}

static void only_what_has_a_function_is_gathered(void) {
  ear e = {0};
  if (!scene_open_text(&e.s, herd, NULL)) return;
  breve_listener listener = breve_listener_default(), read = breve_listener_default();
  listener.user = &e;
  listener.announcement = on_announcement;
  set(&e, &listener);
  CHECK_STATUS(BREVE_OK, breve_world_listener(e.s.world, &read));
  CHECK(memcmp(&read, &listener, sizeof read) == 0);
  CHECK_STATUS(BREVE_OK, breve_world_step(e.s.world));
  CHECK_TEXT("12s", e.log);
  size_t count = 9;
  CHECK_STATUS(BREVE_OK, breve_world_lives(e.s.world, NULL, 0, &count));
  CHECK(count == 0);
  listener.struct_size = 3;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_listener(e.s.world, &listener));
  CHECK_STATUS(BREVE_OK, breve_world_step(e.s.world)); /* the one before is still there */
  CHECK_TEXT("12s12s", e.log);
  scene_close(&e.s);
}

static void what_happens_between_iterations_comes_with_the_next(void) {
  ear e = {0};
  breve_object made;
  if (!scene_open_text(&e.s, herd, NULL)) return;
  const breve_listener listener = all_ears(&e);
  set(&e, &listener);
  CHECK_STATUS(BREVE_OK, breve_object_create(e.s.world, "Object", &made));
  CHECK_STATUS(BREVE_OK, breve_object_free(e.s.world, made));
  CHECK_TEXT("", e.log);
  CHECK_STATUS(BREVE_OK, breve_world_step(e.s.world));
  CHECK_TEXT("bd12sdb", e.log);
  scene_close(&e.s);
}

static void act_refused(ear* e, breve_world* world) {
  size_t size = 0;
  uint64_t hash = 0;
  char image[4] = {0};
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_step(world));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_advance(world, 1, NULL));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_destroy(world));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_snapshot(world, NULL, 0, &size));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_restore(world, image, sizeof image));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_hash(world, &hash));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_set_listener(world, NULL));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_reload(world, e->s.program));
  CHECK(strstr(breve_world_last_error(world)->message, "breve_world_reload") != NULL);
}
static void what_cannot_work_in_an_iteration_is_refused(void) {
  ear e = {0};
  if (!scene_open_text(&e.s, herd, NULL)) return;
  const breve_listener listener = all_ears(&e);
  e.act = act_refused;
  set(&e, &listener);
  CHECK_STATUS(BREVE_OK, breve_world_step(e.s.world));
  CHECK_TEXT("12sdb", e.log);
  scene_close(&e.s);
}

/* A birth makes a further object, as long as there are few; a death has its class and a stale id. */
static void act_breeds(ear* e, breve_world* world) {
  size_t count = 0;
  breve_object made;
  const char last = e->log[strlen(e->log) - 1];
  if (last == 'd') CHECK(!breve_object_alive(world, e->object));
  CHECK_STATUS(BREVE_OK, breve_world_objects(world, "Sheep", NULL, 0, &count));
  if (last == 'b' && count < 4) CHECK_STATUS(BREVE_OK, breve_object_create(world, "Sheep", &made));
  if (last == 's') e->status = breve_object_free(world, e->object); /* the one that has just iterated */
}
static void callbacks_may_create_free_and_call(void) {
  ear e = {0};
  if (!scene_open_text(&e.s, herd, NULL)) return;
  const breve_listener listener = all_ears(&e);
  e.act = act_breeds;
  set(&e, &listener);
  for (int i = 0; i < 20; ++i) {
    CHECK_STATUS(BREVE_OK, breve_world_step(e.s.world));
    CHECK(e.status == BREVE_OK);
  }
  CHECK(strlen(e.log) > 100);
  /* A failing call is the callback's own affair: the iteration goes on. */
  CHECK(breve_world_iteration(e.s.world) == 20);
  scene_close(&e.s);
}

static void act_fails(ear* e, breve_world* world) {
  if (e->log[strlen(e->log) - 1] != '1') return; /* what this causes would cause more, and so on */
  e->status = breve_object_call(world, breve_world_controller(world), "fail", NULL, 0, NULL);
  CHECK_STATUS(BREVE_OK, breve_world_set_events(world, 0));
  CHECK_STATUS(BREVE_OK, breve_world_set_events(world, 15));
  CHECK_STATUS(BREVE_OK, breve_object_call(world, breve_world_controller(world), "post-iterate", NULL, 0, NULL));
}
static void errors_of_a_callback_do_not_end_the_iteration(void) {
  ear e = {0};
  if (!scene_open_text(&e.s, herd, NULL)) return;
  const breve_listener listener = all_ears(&e);
  e.act = act_fails;
  set(&e, &listener);
  for (int i = 0; i < 5; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(e.s.world));
  CHECK(e.status == BREVE_ERROR_SCRIPT && breve_world_iteration(e.s.world) == 5);
  scene_close(&e.s);
}

static void bodies_tell_of_contacts_sleep_and_the_guard(bool flat) {
  ear e = {0};
  if (!open_bodies(&e.s, flat)) return;
  const breve_geometry ball = ball_of_radius(0.5), slab = box_of_size(10, 1, 10);
  add_body(&e.s, "Stationary", &slab, 0, 0, 0);
  const breve_object body = add_body(&e.s, "Mobile", &ball, 0, 1.2, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(e.s.world, body, true));
  CHECK_STATUS(BREVE_OK, breve_world_set_sleeping(e.s.world, true));
  CHECK_STATUS(BREVE_OK, breve_object_watch_contacts(e.s.world, body, true));
  const breve_listener listener = all_ears(&e);
  set(&e, &listener);
  for (int i = 0; i < 200 && !strchr(e.log, 'z'); ++i) step_times(&e.s, 1);
  CHECK(strchr(e.log, '(') == e.log && strchr(e.log, 'z') != NULL && strchr(e.log, '!') == NULL);
  forget_log(&e);
  put_at(&e.s, body, 0, 40, 0);
  step_times(&e.s, 1);
  CHECK_TEXT(")w", e.log);
  forget_log(&e);
  if (!flat) { /* faster than anything can be followed */
    const breve_geometry brick = box_of_size(1, 2, 3);
    const double spin[3] = {1e9, 2e9, 3e9};
    const breve_object top = add_body(&e.s, "Mobile", &brick, 0, 90, 0);
    CHECK_STATUS(BREVE_OK, breve_object_set_physics(e.s.world, top, true));
    CHECK_STATUS(BREVE_OK, breve_object_set_rotational_velocity(e.s.world, top, spin));
    step_times(&e.s, 2);
    CHECK(strchr(e.log, '!') != NULL);
  }
  scene_close(&e.s);
}
static void contacts_sleep_and_the_guard_are_told(void) {
  bodies_tell_of_contacts_sleep_and_the_guard(false), bodies_tell_of_contacts_sleep_and_the_guard(true);
}

static void who_only_listens_leaves_no_trace(void) {
  uint64_t hashes[2] = {0, 1};
  for (int i = 0; i < 2; ++i) {
    ear e = {0};
    if (!scene_open_text(&e.s, herd, NULL)) return;
    const breve_listener listener = all_ears(&e);
    if (i == 1) set(&e, &listener);
    for (int k = 0; k < 10; ++k) CHECK_STATUS(BREVE_OK, breve_world_step(e.s.world));
    hashes[i] = hash_of_world(&e.s);
    scene_close(&e.s);
  }
  CHECK(hashes[0] == hashes[1]);
}

static void a_restore_forgets_what_was_not_told(void) {
  ear e = {0};
  static char image[1 << 18];
  size_t size = 0;
  breve_object made;
  if (!scene_open_text(&e.s, herd, NULL)) return;
  const breve_listener listener = all_ears(&e);
  set(&e, &listener);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(e.s.world, image, sizeof image, &size));
  CHECK_STATUS(BREVE_OK, breve_object_create(e.s.world, "Object", &made));
  CHECK_STATUS(BREVE_OK, breve_world_restore(e.s.world, image, size));
  CHECK_STATUS(BREVE_OK, breve_world_step(e.s.world));
  CHECK_TEXT("12sdb", e.log);
  scene_close(&e.s);
}

void listener_suite(void) {
  RUN(events_come_in_order_in_each_of_many_iterations);
  RUN(only_what_has_a_function_is_gathered);
  RUN(what_happens_between_iterations_comes_with_the_next);
  RUN(what_cannot_work_in_an_iteration_is_refused);
  RUN(callbacks_may_create_free_and_call);
  RUN(errors_of_a_callback_do_not_end_the_iteration);
  RUN(contacts_sleep_and_the_guard_are_told);
  RUN(who_only_listens_leaves_no_trace);
  RUN(a_restore_forgets_what_was_not_told);
}
