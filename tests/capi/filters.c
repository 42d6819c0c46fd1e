/* Collision filters: bits, sensors, pairs, open sides, and answers of the host. */
#include <math.h>

#include "bodies.h"

/* A ball above a slab that does not move: in space or flat. */
typedef struct drop {
  scene s;
  breve_object ball, slab;
} drop;

static bool open_drop(drop* d, bool flat, double height) {
  if (!open_bodies(&d->s, flat)) return false;
  const breve_geometry ball = ball_of_radius(0.5), slab = box_of_size(10, 1, 10);
  d->slab = add_body(&d->s, "Stationary", &slab, 0, 0, 0);
  d->ball = add_body(&d->s, "Mobile", &ball, 0, height, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(d->s.world, d->ball, true));
  return true;
}

static double height_of(drop* d) { return pose_of(&d->s, d->ball).location[1]; }

static void filter(scene* s, breve_object object, uint32_t category, uint32_t mask) {
  breve_collision_filter f = breve_collision_filter_default();
  CHECK_STATUS(BREVE_OK, breve_object_collision_filter(s->world, object, &f));
  f.category = category;
  f.mask = mask;
  CHECK_STATUS(BREVE_OK, breve_object_set_collision_filter(s->world, object, &f));
}

/* Rests on the slab, or is far below it. */
static void rests(drop* d) { CHECK(fabs(height_of(d) - 1) < 0.05); }
static void has_fallen(drop* d) { CHECK(height_of(d) < -2); }

static void bits_decide(bool flat) {
  static const struct {
    uint32_t ball, ball_meets, slab, slab_meets;
    bool meet;
  } cases[] = {{1, ~0U, 1, ~0U, true},
               {2, 4, 4, 2, true},
               {2, 4, 4, 1, false},
               {2, 1, 4, 2, false},
               {0, ~0U, 1, ~0U, false},
               {6, 8, 12, 4, true},
               {1U << 31, ~0U, 1, 1U << 31, true}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    drop d;
    if (!open_drop(&d, flat, 1.5)) return;
    filter(&d.s, d.ball, cases[i].ball, cases[i].ball_meets);
    filter(&d.s, d.slab, cases[i].slab, cases[i].slab_meets);
    step_times(&d.s, 30);
    cases[i].meet ? rests(&d) : has_fallen(&d);
    scene_close(&d.s);
  }
}
static void bits_decide_who_meets_in_space(void) { bits_decide(false); }
static void bits_decide_who_meets_in_a_plane(void) { bits_decide(true); }

static void a_body_that_rests_falls_when_its_ground_is_filtered(bool flat, bool sleeping) {
  drop d;
  if (!open_drop(&d, flat, 1)) return;
  CHECK_STATUS(BREVE_OK, breve_world_set_sleeping(d.s.world, sleeping));
  step_times(&d.s, 60);
  rests(&d);
  bool asleep = false;
  CHECK_STATUS(BREVE_OK, breve_object_asleep(d.s.world, d.ball, &asleep));
  CHECK(asleep == sleeping);
  filter(&d.s, d.slab, 1, 0);
  step_times(&d.s, 30);
  has_fallen(&d);
  scene_close(&d.s);
}
static void what_rests_falls_when_its_ground_is_filtered(void) {
  for (int i = 0; i < 4; ++i) a_body_that_rests_falls_when_its_ground_is_filtered(i & 1, i & 2);
}

static void a_sensor_pushes_nobody(bool flat) {
  drop d;
  if (!open_drop(&d, flat, 1.5)) return;
  breve_collision_filter f = breve_collision_filter_default();
  f.sensor = true;
  CHECK_STATUS(BREVE_OK, breve_object_set_collision_filter(d.s.world, d.slab, &f));
  step_times(&d.s, 30);
  has_fallen(&d);
  scene_close(&d.s);
}
static void sensors_push_nobody(void) { a_sensor_pushes_nobody(false), a_sensor_pushes_nobody(true); }

static void pairs_are_told_not_to_collide(bool flat) {
  drop d;
  if (!open_drop(&d, flat, 1.5)) return;
  bool collides = false;
  CHECK_STATUS(BREVE_OK, breve_object_collides(d.s.world, d.ball, d.slab, &collides));
  CHECK(collides);
  CHECK_STATUS(BREVE_OK, breve_object_set_collides(d.s.world, d.slab, d.ball, false));
  CHECK_STATUS(BREVE_OK, breve_object_collides(d.s.world, d.ball, d.slab, &collides));
  CHECK(!collides);
  /* An image knows. */
  static char image[1 << 20];
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(d.s.world, image, sizeof image, &size));
  const uint64_t before = hash_of_world(&d.s);
  CHECK_STATUS(BREVE_OK, breve_object_set_collides(d.s.world, d.ball, d.slab, true));
  CHECK(hash_of_world(&d.s) != before);
  CHECK_STATUS(BREVE_OK, breve_world_restore(d.s.world, image, size));
  CHECK(hash_of_world(&d.s) == before);
  step_times(&d.s, 30);
  has_fallen(&d);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_collides(d.s.world, d.ball, d.ball, true));
  scene_close(&d.s);
}
static void single_pairs_are_told_not_to_collide(void) {
  pairs_are_told_not_to_collide(false), pairs_are_told_not_to_collide(true);
}

static void open_upward(drop* d) {
  breve_collision_filter f = breve_collision_filter_default();
  f.one_way[1] = 1;
  CHECK_STATUS(BREVE_OK, breve_object_set_collision_filter(d->s.world, d->slab, &f));
}

static void a_platform_is_jumped_onto_from_below(bool flat) {
  drop d;
  /* From above it holds. */
  if (!open_drop(&d, flat, 3)) return;
  open_upward(&d);
  step_times(&d.s, 60);
  rests(&d);
  scene_close(&d.s);
  /* From below it lets pass, and holds what comes down again. */
  if (!open_drop(&d, flat, -3)) return;
  open_upward(&d);
  set_moving(&d.s, d.ball, 0, 12, 0);
  double highest = -3;
  for (int i = 0; i < 80; ++i) {
    step_times(&d.s, 1);
    if (height_of(&d) > highest) highest = height_of(&d);
  }
  CHECK_NEAR(-3 + 144 / (2 * 9.81), highest, 0.2); /* nothing slowed it down */
  rests(&d);
  scene_close(&d.s);
  /* Too slow to get through: it falls back down. */
  if (!open_drop(&d, flat, -1.5)) return;
  open_upward(&d);
  set_moving(&d.s, d.ball, 0, 4.5, 0);
  step_times(&d.s, 40);
  has_fallen(&d);
  scene_close(&d.s);
  /* A bullet from above does not get through in one sub-step. */
  if (!open_drop(&d, flat, 40)) return;
  open_upward(&d);
  set_moving(&d.s, d.ball, 0, -900, 0);
  step_times(&d.s, 3);
  CHECK(height_of(&d) > 0.9);
  scene_close(&d.s);
}
static void platforms_are_jumped_onto_from_below(void) {
  a_platform_is_jumped_onto_from_below(false), a_platform_is_jumped_onto_from_below(true);
}

static void an_image_knows_who_is_passing(bool flat) {
  drop d;
  if (!open_drop(&d, flat, -1.2)) return;
  open_upward(&d);
  set_moving(&d.s, d.ball, 0, 10, 0);
  step_times(&d.s, 2); /* it is within the platform now */
  CHECK(fabs(height_of(&d)) < 1);
  static char image[1 << 20];
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(d.s.world, image, sizeof image, &size));
  if (flat) CHECK_STATUS(BREVE_OK, breve_world_restore(d.s.world, image, size));
  step_times(&d.s, 70);
  const uint64_t hash = hash_of_world(&d.s);
  CHECK_STATUS(BREVE_OK, breve_world_restore(d.s.world, image, size));
  step_times(&d.s, 70);
  CHECK(hash_of_world(&d.s) == hash);
  rests(&d);
  scene_close(&d.s);
}
static void images_know_who_is_passing(void) {
  an_image_knows_who_is_passing(false), an_image_knows_who_is_passing(true);
}

/* --- answers of the host ------------------------------------------------------------------------------------------ */

typedef struct answers {
  int asked;
  bool answer, frees;
  breve_object object, other;
} answers;

static bool answer(void* user, breve_world* world, breve_object object, breve_object other) {
  answers* a = user;
  ++a->asked;
  a->object = object;
  a->other = other;
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_step(world));
  CHECK_STATUS(BREVE_ERROR_BUSY, breve_world_set_may_collide(world, NULL, NULL));
  if (a->frees) CHECK_STATUS(BREVE_OK, breve_object_free(world, other));
  return a->answer;
}

static void the_host_is_asked_once_while_a_pair_is_near(bool flat) {
  for (int yes = 0; yes < 2; ++yes) {
    drop d;
    answers a = {0};
    a.answer = yes;
    if (!open_drop(&d, flat, 2)) return;
    breve_collision_filter f = breve_collision_filter_default();
    f.asks = true;
    CHECK_STATUS(BREVE_OK, breve_object_set_collision_filter(d.s.world, d.slab, &f));
    CHECK_STATUS(BREVE_OK, breve_world_set_may_collide(d.s.world, answer, &a));
    step_times(&d.s, 40);
    yes ? rests(&d) : has_fallen(&d);
    CHECK(a.asked == 1 && same_object(a.object, d.slab) && same_object(a.other, d.ball));
    CHECK(effect_of(&d.s, "collision filters")->active);
    /* Near again: asked again. */
    put_at(&d.s, d.ball, 0, 50, 0);
    step_times(&d.s, 1);
    put_at(&d.s, d.ball, 0, 1.2, 0);
    set_moving(&d.s, d.ball, 0, 0, 0);
    step_times(&d.s, 2);
    CHECK(a.asked == 2);
    scene_close(&d.s);
  }
}
static void the_host_is_asked_in_space_and_in_a_plane(void) {
  the_host_is_asked_once_while_a_pair_is_near(false), the_host_is_asked_once_while_a_pair_is_near(true);
}

static void who_is_asked_may_free_the_other(void) {
  for (int flat = 0; flat < 2; ++flat) {
    drop d;
    answers a = {0};
    a.frees = a.answer = true;
    if (!open_drop(&d, flat, 1.2)) return;
    breve_collision_filter f = breve_collision_filter_default();
    f.asks = true;
    CHECK_STATUS(BREVE_OK, breve_object_set_collision_filter(d.s.world, d.slab, &f));
    CHECK_STATUS(BREVE_OK, breve_world_set_may_collide(d.s.world, answer, &a));
    step_times(&d.s, 5);
    CHECK(a.asked == 1 && !breve_object_alive(d.s.world, d.ball));
    scene_close(&d.s);
  }
}

static void bad_filters_are_refused(void) {
  drop d;
  if (!open_drop(&d, true, 3)) return;
  const uint64_t before = hash_of_world(&d.s);
  breve_collision_filter f = breve_collision_filter_default();
  f.one_way[0] = NAN;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_collision_filter(d.s.world, d.slab, &f));
  f.one_way[0] = 0, f.one_way[2] = 1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_collision_filter(d.s.world, d.slab, &f));
  f.one_way[2] = 0, f.reserved[5] = true;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_collision_filter(d.s.world, d.slab, &f));
  f.reserved[5] = false, f.struct_size = 9;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_collision_filter(d.s.world, d.slab, &f));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_collision_filter(d.s.world, d.slab, &f));
  f = breve_collision_filter_default();
  CHECK_STATUS(BREVE_ERROR_NO_BODY,
               breve_object_set_collision_filter(d.s.world, breve_world_controller(d.s.world), &f));
  CHECK(hash_of_world(&d.s) == before);
  scene_close(&d.s);
}

void filters_suite(void) {
  RUN(bits_decide_who_meets_in_space);
  RUN(bits_decide_who_meets_in_a_plane);
  RUN(what_rests_falls_when_its_ground_is_filtered);
  RUN(sensors_push_nobody);
  RUN(single_pairs_are_told_not_to_collide);
  RUN(platforms_are_jumped_onto_from_below);
  RUN(images_know_who_is_passing);
  RUN(the_host_is_asked_in_space_and_in_a_plane);
  RUN(who_is_asked_may_free_the_other);
  RUN(bad_filters_are_refused);
}
