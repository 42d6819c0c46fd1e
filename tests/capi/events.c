/* Events of an iteration: contacts, births and deaths, announcements, sleep. */
#include <math.h>

#include "bodies.h"

static size_t contacts(scene* s, breve_contact* list, size_t room) {
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_contacts(s->world, list, room, &count));
  return count;
}

static void a_bounce_begins_persists_and_ends(bool flat) {
  scene s;
  if (!open_bodies(&s, flat)) return;
  const breve_geometry ball = ball_of_radius(0.5), slab = box_of_size(10, 1, 10);
  const breve_object ground = add_body(&s, "Stationary", &slab, 0, 0, 0);
  const breve_object body = add_body(&s, "Mobile", &ball, 0, 2, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, body, true));
  breve_contact list[4];
  step_times(&s, 1);
  CHECK(contacts(&s, list, 4) == 0 && !effect_of(&s, "events")->active);
  CHECK_STATUS(BREVE_OK, breve_world_set_events(s.world, BREVE_EVENT_CONTACT));
  CHECK(breve_world_events(s.world) == BREVE_EVENT_CONTACT);
  step_times(&s, 1);
  CHECK(contacts(&s, list, 4) == 0);
  CHECK_STATUS(BREVE_OK, breve_object_watch_contacts(s.world, body, true));
  int begins = 0, ends = 0, persists = 0;
  double impulse = 0;
  bool touching = false;
  for (int i = 0; i < 200; ++i) {
    step_times(&s, 1);
    const size_t count = contacts(&s, list, 4);
    CHECK(count <= 1);
    if (count == 0) {
      CHECK(!touching);
      continue;
    }
    CHECK(same_object(list[0].a, ground) && same_object(list[0].b, body));
    CHECK_NEAR(-1, list[0].normal[1], 1e-6);
    CHECK_NEAR(0.5, list[0].point[1], 0.02);
    /* The impulse is on a, the ground: down. */
    CHECK(list[0].impulse[1] <= 0);
    impulse -= list[0].impulse[1];
    begins += list[0].phase == BREVE_PHASE_BEGIN, ends += list[0].phase == BREVE_PHASE_END;
    persists += list[0].phase == BREVE_PHASE_PERSIST;
    CHECK((list[0].phase == BREVE_PHASE_BEGIN) == !touching);
    touching = list[0].phase != BREVE_PHASE_END;
  }
  CHECK(touching && begins == ends + 1 && begins >= 2 && persists > 20);
  /* The first impact alone: mass times (speed of a fall of 1 m) times (1 + restitution), at least the first factor. */
  const double mass = 4 * acos(-1) / 3 * 0.125;
  CHECK(impulse > (flat ? 0.4 : 1) * mass * sqrt(2 * 9.81 * 1));
  /* Picked up: it ends. */
  put_at(&s, body, 0, 30, 0);
  step_times(&s, 1);
  CHECK(contacts(&s, list, 4) == 1 && list[0].phase == BREVE_PHASE_END);
  step_times(&s, 1);
  CHECK(contacts(&s, list, 4) == 0);
  scene_close(&s);
}
static void bounces_begin_persist_and_end(void) {
  a_bounce_begins_persists_and_ends(false), a_bounce_begins_persists_and_ends(true);
}

static void classes_are_watched_and_ends_name_the_gone(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(1);
  breve_object link[2], mobile[2];
  const double none[3] = {0, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_world_set_gravity(s.world, none));
  for (int i = 0; i < 2; ++i) link[i] = add_body(&s, "Link", &ball, 10 * i, 0, 0);
  for (int i = 0; i < 2; ++i) mobile[i] = add_body(&s, "Mobile", &ball, 10 * i, 1.5, 0);
  add_body(&s, "Mobile", &ball, 0, 3, 0); /* touches a Mobile alone */
  CHECK_STATUS(BREVE_OK, breve_world_set_events(s.world, BREVE_EVENT_CONTACT));
  CHECK_STATUS(BREVE_OK, breve_world_watch_contacts(s.world, "Link", true));
  breve_contact list[8];
  step_times(&s, 1);
  if (CHECK(contacts(&s, list, 8) == 2)) {
    for (int i = 0; i < 2; ++i) {
      CHECK(same_object(list[i].a, link[i]) && same_object(list[i].b, mobile[i]));
      CHECK_NEAR(-0.5, list[i].distance, 1e-12);
      CHECK_NEAR(0.75, list[i].point[1], 1e-12);
      CHECK_NEAR(-1, list[i].normal[1], 1e-12);
    }
  }
  CHECK(contacts(&s, list, 1) == 2);
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, mobile[0]));
  step_times(&s, 1);
  if (CHECK(contacts(&s, list, 8) == 2)) {
    CHECK(list[0].phase == BREVE_PHASE_END && same_object(list[0].b, mobile[0]));
    CHECK(!breve_object_alive(s.world, list[0].b));
    CHECK(list[1].phase == BREVE_PHASE_PERSIST);
  }
  /* Contacts of a sensor are reported, those of bodies that do not meet are not. */
  breve_collision_filter f = breve_collision_filter_default();
  f.sensor = true;
  CHECK_STATUS(BREVE_OK, breve_object_set_collision_filter(s.world, link[1], &f));
  step_times(&s, 1);
  CHECK(contacts(&s, list, 8) == 1 && list[0].phase == BREVE_PHASE_PERSIST);
  f.mask = 0;
  CHECK_STATUS(BREVE_OK, breve_object_set_collision_filter(s.world, link[1], &f));
  step_times(&s, 1);
  CHECK(contacts(&s, list, 8) == 1 && list[0].phase == BREVE_PHASE_END);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_watch_contacts(s.world, "Nobody", true));
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_object_watch_contacts(s.world, breve_world_controller(s.world), true));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_events(s.world, 16));
  scene_close(&s);
}

static const char* const crier_text =
    "@use Control.\n@use Mobile.\nController Main.\n"
    "Mobile : Crier (aka Criers) {\n"
    "  + variables:\n    age (int).\n"
    "  + to iterate:\n    age++.\n    self announce message \"age $age\".\n    if age == 3: free self.\n"
    "}\n"
    "Control : Main {\n"
    "  + variables:\n    turn (int).\n"
    "  + to iterate:\n    turn++.\n    if turn == 1: 2 new Criers.\n    super iterate.\n"
    "}\n";

static void births_deaths_and_announcements_are_told_in_order(void) {
  scene s;
  if (!scene_open_text(&s, crier_text, NULL)) return;
  breve_life lives[8];
  breve_announcement said[8];
  size_t count = 0, spoken = 0;
  CHECK_STATUS(BREVE_OK, breve_world_set_events(s.world, BREVE_EVENT_LIFE | BREVE_EVENT_ANNOUNCEMENT));
  step_times(&s, 1);
  CHECK_STATUS(BREVE_OK, breve_world_lives(s.world, lives, 8, &count));
  if (CHECK(count == 2)) {
    CHECK(lives[0].born && lives[1].born && breve_object_alive(s.world, lives[0].object));
    CHECK_TEXT("Crier", lives[0].class_name);
  }
  const breve_object first = lives[0].object, second = lives[1].object;
  step_times(&s, 1);
  CHECK_STATUS(BREVE_OK, breve_world_announcements(s.world, said, 8, &spoken));
  if (CHECK(spoken == 2)) {
    CHECK(same_object(said[0].announcer, first) && same_object(said[1].announcer, second));
    CHECK_TEXT("age 1", said[0].message);
  }
  CHECK_STATUS(BREVE_OK, breve_world_lives(s.world, lives, 8, &count));
  CHECK(count == 0);
  step_times(&s, 2);
  CHECK_STATUS(BREVE_OK, breve_world_lives(s.world, lives, 8, &count));
  if (CHECK(count == 2)) CHECK(!lives[0].born && same_object(lives[0].object, first));
  CHECK(!breve_object_alive(s.world, first));
  CHECK_STATUS(BREVE_OK, breve_world_announcements(s.world, said, 8, &spoken));
  CHECK(spoken == 2);
  /* Objects that the host makes between iterations are also reported. */
  breve_object made;
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Crier", &made));
  CHECK_STATUS(BREVE_OK, breve_world_lives(s.world, lives, 8, &count));
  CHECK(count == 3 && lives[2].born && same_object(lives[2].object, made));
  CHECK_STATUS(BREVE_OK, breve_world_set_events(s.world, 0));
  CHECK_STATUS(BREVE_OK, breve_world_lives(s.world, lives, 8, &count));
  CHECK(count == 0);
  scene_close(&s);
}

static void who_falls_asleep_and_wakes_is_told(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(0.5), slab = box_of_size(10, 1, 10);
  add_body(&s, "Stationary", &slab, 0, 0, 0);
  const breve_object body = add_body(&s, "Mobile", &ball, 0, 1, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, body, true));
  CHECK_STATUS(BREVE_OK, breve_world_set_sleeping(s.world, true));
  CHECK_STATUS(BREVE_OK, breve_world_set_events(s.world, BREVE_EVENT_SLEEP));
  breve_nap naps[4];
  size_t count = 0;
  int slept = 0;
  for (int i = 0; i < 100 && slept == 0; ++i) {
    step_times(&s, 1);
    CHECK_STATUS(BREVE_OK, breve_world_naps(s.world, naps, 4, &count));
    slept += count == 1 && naps[0].asleep && same_object(naps[0].object, body);
  }
  CHECK(slept == 1);
  step_times(&s, 1);
  CHECK_STATUS(BREVE_OK, breve_world_naps(s.world, naps, 4, &count));
  CHECK(count == 0);
  CHECK_STATUS(BREVE_OK, breve_object_wake(s.world, body));
  const double up[3] = {0, 3, 0};
  CHECK_STATUS(BREVE_OK, breve_object_add_impulse(s.world, body, up, NULL));
  step_times(&s, 1);
  CHECK_STATUS(BREVE_OK, breve_world_naps(s.world, naps, 4, &count));
  CHECK(count == 1 && !naps[0].asleep);
  scene_close(&s);
}

static void a_world_without_bodies_has_events(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  CHECK_STATUS(BREVE_OK, breve_world_set_events(s.world, 15));
  CHECK_STATUS(BREVE_OK, breve_world_set_sleeping(s.world, true));
  step_times(&s, 2);
  size_t count = 1;
  CHECK_STATUS(BREVE_OK, breve_world_naps(s.world, NULL, 0, &count));
  CHECK(count == 0);
  scene_close(&s);
}

static void who_is_told_changes_nothing_and_a_restore_begins_no_contact(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(1);
  const breve_object a = add_body(&s, "Mobile", &ball, 0, 0, 0);
  add_body(&s, "Mobile", &ball, 1, 0, 0);
  const uint64_t before = hash_of_world(&s);
  static char image[1 << 20], other[1 << 20];
  size_t size = 0, again = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, sizeof image, &size));
  CHECK_STATUS(BREVE_OK, breve_world_set_events(s.world, 15));
  CHECK_STATUS(BREVE_OK, breve_object_watch_contacts(s.world, a, true));
  CHECK(hash_of_world(&s) == before);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, other, sizeof other, &again));
  CHECK(size == again && memcmp(image, other, size) == 0);
  breve_contact list[2];
  step_times(&s, 1);
  CHECK(contacts(&s, list, 2) == 1 && list[0].phase == BREVE_PHASE_BEGIN);
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  CHECK(contacts(&s, list, 2) == 0);
  step_times(&s, 1);
  CHECK(contacts(&s, list, 2) == 1 && list[0].phase == BREVE_PHASE_PERSIST);
  scene_close(&s);
}

void events_suite(void) {
  RUN(bounces_begin_persist_and_end);
  RUN(classes_are_watched_and_ends_name_the_gone);
  RUN(births_deaths_and_announcements_are_told_in_order);
  RUN(who_falls_asleep_and_wakes_is_told);
  RUN(a_world_without_bodies_has_events);
  RUN(who_is_told_changes_nothing_and_a_restore_begins_no_contact);
}
