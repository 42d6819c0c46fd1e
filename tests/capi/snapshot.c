/* Hash, snapshot, restore, and images that are not to be trusted. */
#include <stdlib.h>

#include "scene.h"

/* A program whose run depends on all that an image has to hold: bodies, generator, schedule, heap. */
static const char* const lively =
    "@use Control.\n"
    "@use Mobile.\n"
    "Controller Crowd.\n"
    "Control : Crowd {\n"
    "  + variables:\n"
    "    bugs (list).\n"
    "    ticks (int).\n"
    "    log (hash).\n"
    "  + to init:\n"
    "    bugs = 12 new Bug.\n"
    "    self schedule method-call \"tick\" at-time 0.5.\n"
    "    self set-neighborhood.\n"
    "  + to set-neighborhood:\n"
    "    bugs set-neighborhood-size to 3.0.\n"
    "  + to tick:\n"
    "    ticks += 1.\n"
    "    log{ticks} = \"tick $ticks\".\n"
    "    push (new Bug) onto bugs.\n"
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
    "  + to iterate:\n"
    "    friends = (self get-neighbors).\n"
    "    self set-velocity to (random[(2, 2, 2)] - (1, 1, 1)) * (1 + |friends|).\n"
    "}\n";

/* The same for discrete models: cells with code, states, agents on them, chemicals, a reaction, space that wraps. */
static const char* const discrete =
    "@use GridAgent.\n"
    "@use Mobile.\n"
    "@use Reaction.\n"
    "@use Control.\n"
    "Controller Town.\n"
    "Patch : Cell {\n"
    "  + variables:\n"
    "    n (int).\n"
    "  + to init-patch:\n"
    "    n = random[9].\n"
    "  + to mix:\n"
    "    n = (n + ((self get-patch-to-east) get-n)) % 200.\n"
    "    self set-state to n.\n"
    "    self set-color to (n, 0, 0).\n"
    "  + to get-n:\n"
    "    return n.\n"
    "}\n"
    "GridAgent : Ant (aka Ants) {\n"
    "  + to iterate:\n"
    "    if random[3] == 0: self move-to-free-cell.\n"
    "    else self move-to-free-neighbor.\n"
    "    if random[40] == 0: free self.\n"
    "}\n"
    "Control : Town {\n"
    "  + variables:\n"
    "    cells, board, salt, u, v, reaction, ball (object).\n"
    "  + to init:\n"
    "    i (int).\n"
    "    self wrap-space from (0, 0, 0) to (3, 3, 0).\n"
    "    cells = ((new PatchToroid) init-with x-count 4 y-count 4 z-count 1 patch-class \"Cell\").\n"
    "    board = ((new PatchGrid) init-with x-count 6 y-count 6 z-count 2).\n"
    "    cells set-update-order to \"random\".\n"
    "    board randomize-states with-density 0.4.\n"
    "    board set-rule born {5, 6} survive {4, 5, 6}.\n"
    "    salt = ((new PatchChemical) init-with diffusion-rate 0.1 decay-rate 0.01).\n"
    "    board track patch-chemical salt.\n"
    "    for i = 0, i < 8, i++: (new Ant) enter-free-cell of board.\n"
    "    u = ((new Matrix2D) init-with x-size 6 y-size 6).\n"
    "    v = ((new Matrix2D) init-with x-size 6 y-size 6).\n"
    "    u set-value to 1.0 at-x 2 at-y 3.\n"
    "    v set-value to 0.5 at-x 2 at-y 4.\n"
    "    reaction = ((new Reaction) init-with fields {u, v}).\n"
    "    reaction set-diffusion of u to 0.1.\n"
    "    reaction add-term to v rate 0.3 powers {1, 1}.\n"
    "    ball = new Mobile.\n"
    "    ball set-velocity to (5, 7, 1).\n"
    "  + to iterate:\n"
    "    super iterate.\n"
    "    cells update-patches with-method \"mix\".\n"
    "    board apply-rule.\n"
    "    (board get-patch-at x random[5] y 0 z 1) increase-concentration of salt by 1.0.\n"
    "    board update-concentrations.\n"
    "    reaction step by 0.5.\n"
    "    (new Ant) enter-free-cell of board.\n"
    "}\n";

static uint64_t hash_of(const breve_world* world) {
  uint64_t hash = 0;
  CHECK_STATUS(BREVE_OK, breve_world_hash(world, &hash));
  return hash;
}

static void step_times(breve_world* world, int times) {
  while (times-- > 0) CHECK_STATUS(BREVE_OK, breve_world_step(world));
}

/* The image is malloc'ed. */
static unsigned char* image_of(const breve_world* world, size_t* size) {
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(world, NULL, 0, size));
  unsigned char* image = malloc(*size);
  size_t again = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(world, image, *size, &again));
  CHECK(again == *size);
  return image;
}

static void equal_runs_have_equal_hashes_and_unequal_ones_do_not(void) {
  scene a, b, c;
  breve_world_config config = breve_world_config_default();
  if (!scene_open_text(&a, lively, &config) || !scene_open_text(&b, lively, &config)) return;
  config.seed = 2;
  if (!scene_open_text(&c, lively, &config)) return;
  uint64_t last = 0;
  for (int i = 0; i < 30; ++i) {
    CHECK(hash_of(a.world) == hash_of(b.world));
    CHECK(hash_of(a.world) != hash_of(c.world));
    CHECK(hash_of(a.world) != last);
    last = hash_of(a.world);
    step_times(a.world, 1);
    step_times(b.world, 1);
    step_times(c.world, 1);
  }
  scene_close(&a);
  scene_close(&b);
  scene_close(&c);
}

static void check_restore_and_go_on(const char* program) {
  scene a, b;
  if (!scene_open_text(&a, program, NULL) || !scene_open_text(&b, program, NULL)) return;
  step_times(a.world, 20);
  size_t size = 0;
  unsigned char* image = image_of(a.world, &size);
  const uint64_t then = hash_of(a.world);
  uint64_t hashes[30];
  for (int i = 0; i < 30; ++i) {
    step_times(a.world, 1);
    hashes[i] = hash_of(a.world);
  }
  CHECK_STATUS(BREVE_OK, breve_world_restore(a.world, image, size)); /* back in time */
  step_times(b.world, 3);
  CHECK_STATUS(BREVE_OK, breve_world_restore(b.world, image, size)); /* and into another world */
  CHECK(hash_of(a.world) == then && hash_of(b.world) == then);
  CHECK(breve_world_iteration(a.world) == 20);
  for (int i = 0; i < 30; ++i) {
    step_times(a.world, 1);
    step_times(b.world, 1);
    CHECK(hash_of(a.world) == hashes[i]);
    CHECK(hash_of(b.world) == hashes[i]);
  }
  free(image);
  scene_close(&a);
  scene_close(&b);
}

static void restore_and_go_on_equals_save_and_go_on(void) { check_restore_and_go_on(lively); }
static void so_it_does_for_grids_agents_and_reactions(void) { check_restore_and_go_on(discrete); }

static void a_snapshot_changes_nothing(void) {
  scene a, b;
  if (!scene_open_text(&a, lively, NULL) || !scene_open_text(&b, lively, NULL)) return;
  for (int i = 0; i < 20; ++i) {
    size_t size = 0;
    free(image_of(a.world, &size));
    step_times(a.world, 1);
    step_times(b.world, 1);
    CHECK(hash_of(a.world) == hash_of(b.world));
  }
  scene_close(&a);
  scene_close(&b);
}

static void ids_of_the_snapshot_are_good_again_and_later_ones_are_stale(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object ball = ball_of(&s);
  size_t size = 0;
  unsigned char* image = image_of(s.world, &size);
  breve_object later;
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Ball", &later));
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, ball));
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  CHECK(breve_object_alive(s.world, ball));
  CHECK(!breve_object_alive(s.world, later));
  CHECK(int_of(&s, "count") == 7);
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, ball, "touch", NULL, 0, NULL));
  free(image);
  scene_close(&s);
}

static bool same(breve_object a, breve_object b) { return a.index == b.index && a.generation == b.generation; }

static breve_object new_ball(breve_world* world) {
  breve_object ball = {0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_create(world, "Ball", &ball));
  return ball;
}

/* Go back again and again, also to moments of branches that were abandoned: no id is given out twice. */
static void new_objects_never_get_an_id_of_an_abandoned_branch(void) {
  enum { ROUNDS = 12, EACH = 3 };
  scene s, straight;
  if (!scene_open(&s) || !scene_open(&straight)) return;
  breve_object given[ROUNDS * EACH];
  unsigned char* images[ROUNDS];
  size_t sizes[ROUNDS];
  const breve_object ball = ball_of(&s);
  for (int round = 0; round < ROUNDS; ++round) {
    images[round] = image_of(s.world, &sizes[round]);
    for (int i = 0; i < EACH; ++i) given[round * EACH + i] = new_ball(s.world);
    if (round % 2 == 1) CHECK_STATUS(BREVE_OK, breve_object_free(s.world, given[round * EACH]));
    const int back = round / 3;
    CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, images[back], sizes[back]));
    CHECK(breve_object_alive(s.world, ball));
  }
  for (int i = 0; i < ROUNDS * EACH; ++i)
    for (int j = 0; j < i; ++j) CHECK(!same(given[i], given[j]));
  /* What the ids are makes no difference to the world. */
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, images[0], sizes[0]));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_free(s.world, given[0]));
  CHECK(!same(new_ball(s.world), new_ball(straight.world)));
  CHECK(hash_of(s.world) == hash_of(straight.world));
  step_times(s.world, 3);
  step_times(straight.world, 3);
  CHECK(hash_of(s.world) == hash_of(straight.world));
  for (int round = 0; round < ROUNDS; ++round) free(images[round]);
  scene_close(&straight);
  scene_close(&s);
}

/* A later image knows the ids that its objects had, although other objects had their places in between. */
static void objects_made_after_a_restore_keep_their_ids_in_images(void) {
  scene s;
  if (!scene_open(&s)) return;
  size_t first_size = 0, second_size = 0;
  unsigned char* first = image_of(s.world, &first_size);
  const breve_object abandoned = new_ball(s.world);
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, first, first_size));
  const breve_object kept = new_ball(s.world);
  CHECK(kept.index == abandoned.index && kept.generation != abandoned.generation);
  unsigned char* second = image_of(s.world, &second_size);
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, first, first_size));
  CHECK(!breve_object_alive(s.world, kept));
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, second, second_size));
  CHECK(breve_object_alive(s.world, kept));
  CHECK(!breve_object_alive(s.world, abandoned));
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, kept));
  const breve_object next = new_ball(s.world);
  CHECK(next.index == kept.index && !same(next, kept) && !same(next, abandoned));
  CHECK(!breve_object_alive(s.world, kept));
  free(first);
  free(second);
  scene_close(&s);
}

static void ids_of_another_world_are_stale(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_world* other = NULL;
  CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, s.program, NULL, &other));
  const breve_object mine = ball_of(&s);
  const breve_object its = breve_world_controller(other);
  CHECK(!breve_object_alive(s.world, its) && breve_object_alive(other, its));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_free(other, mine));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_call(s.world, its, "touch", NULL, 0, NULL));
  const breve_value foreign = breve_value_object(its);
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_set(s.world, breve_world_controller(s.world), "ball", &foreign));
  CHECK(breve_object_class(s.world, its) == NULL);
  CHECK(hash_of(s.world) == hash_of(other));
  size_t size = 0;
  unsigned char* image = image_of(s.world, &size);
  CHECK_STATUS(BREVE_OK, breve_world_restore(other, image, size)); /* whose objects they are not, all the same */
  CHECK(!breve_object_alive(other, mine) && breve_object_alive(other, its));
  free(image);
  CHECK_STATUS(BREVE_OK, breve_world_destroy(other));
  scene_close(&s);
}

static void a_room_that_is_too_small_is_not_written_to(void) {
  scene s;
  if (!scene_open(&s)) return;
  unsigned char room[8];
  size_t size = 0;
  memset(room, 0x5a, sizeof room);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, room, sizeof room, &size));
  CHECK(size > sizeof room);
  for (size_t i = 0; i < sizeof room; ++i) CHECK(room[i] == 0x5a);
  scene_close(&s);
}

static void damaged_images_are_refused_and_change_nothing(void) {
  scene s;
  if (!scene_open_text(&s, lively, NULL)) return;
  step_times(s.world, 12);
  size_t size = 0;
  unsigned char* image = image_of(s.world, &size);
  step_times(s.world, 1);
  const uint64_t before = hash_of(s.world);
  for (size_t cut = 0; cut < size; cut += 1 + size / 61) /* cut off */
    CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_restore(s.world, image, cut));
  for (size_t at = 0; at < size; at += 1 + size / 251) { /* a byte changed */
    image[at] ^= 0x41;
    CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_restore(s.world, image, size));
    image[at] ^= 0x41;
  }
  CHECK(hash_of(s.world) == before);
  unsigned char noise[300];
  for (size_t i = 0; i < sizeof noise; ++i) noise[i] = (unsigned char)(i * 37);
  CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_restore(s.world, noise, sizeof noise));
  CHECK(hash_of(s.world) == before);
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(hash_of(s.world) == before);
  free(image);
  scene_close(&s);
}

static void an_image_of_another_program_is_refused(void) {
  scene a, b;
  if (!scene_open_text(&a, lively, NULL) || !scene_open(&b)) return;
  size_t size = 0;
  unsigned char* image = image_of(a.world, &size);
  const uint64_t before = hash_of(b.world);
  CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_restore(b.world, image, size));
  CHECK(breve_world_last_error(b.world)->status == BREVE_ERROR_IMAGE);
  CHECK(hash_of(b.world) == before);
  free(image);
  scene_close(&a);
  scene_close(&b);
}

void snapshot_suite(void) {
  RUN(equal_runs_have_equal_hashes_and_unequal_ones_do_not);
  RUN(restore_and_go_on_equals_save_and_go_on);
  RUN(so_it_does_for_grids_agents_and_reactions);
  RUN(a_snapshot_changes_nothing);
  RUN(ids_of_the_snapshot_are_good_again_and_later_ones_are_stale);
  RUN(new_objects_never_get_an_id_of_an_abandoned_branch);
  RUN(objects_made_after_a_restore_keep_their_ids_in_images);
  RUN(ids_of_another_world_are_stale);
  RUN(a_room_that_is_too_small_is_not_written_to);
  RUN(damaged_images_are_refused_and_change_nothing);
  RUN(an_image_of_another_program_is_refused);
}
