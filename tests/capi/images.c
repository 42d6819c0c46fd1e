/* Images that are not to be trusted though their checksum is right, and images of worlds in states that are seldom. */
#include <stdlib.h>

#include "scene.h"

/* --- the form of an image: magic, version, program, length and checksum of the rest, the rest ---------------------- */

enum { LENGTH_AT = 20, CHECKSUM_AT = 28, BODY = 36 };

static uint64_t mixed(uint64_t state, uint64_t word) {
  __extension__ typedef unsigned __int128 wide;
  const wide product = (wide)(state ^ word) * 0x9e3779b97f4a7c15u;
  return (uint64_t)product ^ (uint64_t)(product >> 64) ^ 0xd1b54a32d192ed03u;
}

static uint64_t checksum(const unsigned char* bytes, size_t size) {
  uint64_t state = mixed(0x2545f4914f6cdd1du, size), word;
  for (; size >= sizeof word; bytes += sizeof word, size -= sizeof word) {
    memcpy(&word, bytes, sizeof word);
    state = mixed(state, word);
  }
  word = 0;
  if (size != 0) memcpy(&word, bytes, size);
  return mixed(state, word);
}

static void seal(unsigned char* image, size_t size) {
  if (size < BODY) return;
  const uint64_t length = size - BODY, sum = checksum(image + BODY, size - BODY);
  memcpy(image + LENGTH_AT, &length, sizeof length);
  memcpy(image + CHECKSUM_AT, &sum, sizeof sum);
}

/* --- worlds -------------------------------------------------------------------------------------------------------- */

static uint64_t hash_of(const breve_world* world) {
  uint64_t hash = 0;
  CHECK_STATUS(BREVE_OK, breve_world_hash(world, &hash));
  return hash;
}

/* Malloc'ed, with room for one byte more. */
static unsigned char* image_of(const breve_world* world, size_t* size) {
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(world, NULL, 0, size));
  unsigned char* image = malloc(*size + 1);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(world, image, *size, size));
  return image;
}

static const char* const lists =
    "@use Control.\n@use Mobile.\nController A.\n"
    "Mobile : Bug (aka Bugs) { + to iterate: self set-velocity to random[(1, 1, 1)]. }\n"
    "Control : A {\n"
    "  + variables:\n    k (list).\n    h (hash).\n"
    "  + to init:\n    k = {1, {2, 3}}.\n    h{\"a\"} = k.\n    2 new Bugs.\n"
    "  + to iterate:\n    super iterate.\n    push \"x\" onto k.\n"
    "}\n";

/* The image is refused, and the world, including a reference to a list of it, is unchanged. */
static void check_refused(scene* s, const unsigned char* image, size_t size) {
  breve_value list;
  size_t before = 0, after = 0;
  const uint64_t hash = hash_of(s->world);
  CHECK_STATUS(BREVE_OK, breve_object_get(s->world, breve_world_controller(s->world), "k", &list));
  CHECK_STATUS(BREVE_OK, breve_list_size(s->world, &list, &before));
  CHECK_STATUS(BREVE_ERROR_IMAGE, breve_world_restore(s->world, image, size));
  CHECK_STATUS(BREVE_OK, breve_list_size(s->world, &list, &after));
  CHECK(before == after);
  CHECK(hash_of(s->world) == hash);
}

static void a_byte_too_many_is_refused_and_changes_nothing(void) {
  scene s;
  if (!scene_open_text(&s, lists, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  size_t size = 0;
  unsigned char* image = image_of(s.world, &size);
  image[size] = 0;
  seal(image, size + 1);
  check_refused(&s, image, size + 1);
  for (int i = 0; i < 50; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  free(image);
  scene_close(&s);
}

static void an_image_cut_anywhere_is_refused_and_changes_nothing(void) {
  scene s;
  if (!scene_open_text(&s, lists, NULL)) return;
  size_t size = 0;
  unsigned char* image = image_of(s.world, &size);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  unsigned char* cut = malloc(size);
  for (size_t left = 0; left < size; ++left) {
    memcpy(cut, image, left);
    seal(cut, left);
    check_refused(&s, cut, left);
  }
  for (int i = 0; i < 50; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  free(cut);
  free(image);
  scene_close(&s);
}

/* Many of these are good images of other worlds: taken or refused, the world can be used. */
static void any_byte_may_be_another(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  config.budget = 100000;
  config.memory_limit = (size_t)64 << 20;
  if (!scene_open_text(&s, lists, &config)) return;
  size_t size = 0;
  unsigned char* image = image_of(s.world, &size);
  unsigned char* other = malloc(size);
  for (size_t at = BODY; at < size; ++at) {
    const uint64_t before = hash_of(s.world);
    memcpy(other, image, size);
    other[at] ^= (unsigned char)(1u << at % 8);
    seal(other, size);
    const breve_status status = breve_world_restore(s.world, other, size);
    CHECK(status == BREVE_OK || status == BREVE_ERROR_IMAGE || status == BREVE_ERROR_MEMORY);
    if (status != BREVE_OK) CHECK(hash_of(s.world) == before);
    const breve_status stepped = breve_world_step(s.world);
    CHECK(stepped == BREVE_OK || stepped == BREVE_ERROR_SCRIPT || stepped == BREVE_ERROR_BUDGET ||
          stepped == BREVE_ERROR_MEMORY);
    CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  }
  free(other);
  free(image);
  scene_close(&s);
}

/* --- what a world saves, it can load, and goes on from bit for bit -------------------------------------------------- */

/* After each iteration another world is made of an image, and both go on for two iterations. */
static void check_goes_on(const char* program, int iterations) {
  scene a, b;
  breve_world_config config = breve_world_config_default();
  if (!scene_open_text(&a, program, &config) || !scene_open_text(&b, program, &config)) return;
  for (int i = 0; i < iterations; ++i) {
    breve_world_step(a.world);
    size_t size = 0;
    unsigned char* image = image_of(a.world, &size);
    CHECK_STATUS(BREVE_OK, breve_world_restore(b.world, image, size));
    CHECK(hash_of(a.world) == hash_of(b.world));
    for (int k = 0; k < 2; ++k) {
      const breve_status one = breve_world_step(a.world);
      CHECK_STATUS(one, breve_world_step(b.world));
      CHECK(hash_of(a.world) == hash_of(b.world));
    }
    CHECK_STATUS(BREVE_OK, breve_world_restore(a.world, image, size));
    free(image);
  }
  scene_close(&a);
  scene_close(&b);
}

static void links_that_have_lost_their_physics_come_back(void) {
  check_goes_on(
      "@use PhysicalControl.\n@use Link.\n@use Joint.\nController A.\n"
      "PhysicalControl : A {\n"
      "  + variables:\n    a, b, j (object).\n"
      "  + to init:\n    a = new Link. b = new Link. j = new RevoluteJoint.\n"
      "    j link with-normal (1, 0, 0) parent a to-child b with-parent-point (0, 2, 0) with-child-point (0, -2, 0).\n"
      "  + to iterate:\n    super iterate.\n    a disable-physics.\n"
      "}\n",
      6);
}

static void links_whose_physics_comes_and_goes_come_back(void) {
  check_goes_on(
      "@use PhysicalControl.\n@use Link.\n@use Joint.\nController A.\n"
      "PhysicalControl : A {\n"
      "  + variables:\n    a, b, j (object).\n    n (int).\n"
      "  + to init:\n    a = new Link. b = new Link. j = new RevoluteJoint.\n"
      "    j link with-normal (1, 0, 0) parent a to-child b with-parent-point (0, 2, 0) with-child-point (0, -2, 0).\n"
      "  + to iterate:\n    super iterate.\n    n++.\n"
      "    if n % 3 == 0: a disable-physics.\n    else a enable-physics.\n"
      "    if n % 2 == 0: b set-velocity to (0, 0, 1).\n"
      "    if n % 5 == 0: b move to (0, 5, n).\n"
      "}\n",
      20);
}

static void controllers_that_freed_themselves_in_init_come_back(void) {
  check_goes_on(
      "@use Control.\n@use Mobile.\nController A.\nMobile : Bug { }\n"
      "Control : A { + to init:\n    new Bug.\n    free self.\n}\n",
      3);
}

static void pairs_that_are_apart_come_back(void) {
  check_goes_on(
      "@use PhysicalControl.\n@use Link.\n@use Stationary.\nController A.\n"
      "PhysicalControl : A {\n"
      "  + variables:\n    l (object).\n"
      "  + to init:\n    l = new Link.\n    l move to (1, 0, 0).\n    new Stationary.\n"
      "}\n",
      20);
}

static void sleepers_go_on_sleeping(void) {
  check_goes_on(
      "@use PhysicalControl.\n@use Mobile.\n@use Stationary.\n@use Shape.\nController A.\n"
      "PhysicalControl : A {\n"
      "  + to init:\n    b (object).\n    i (int).\n"
      "    self enable-auto-disable.\n    new Floor.\n"
      "    for i = 0, i < 3, i++: {\n"
      "      b = new Mobile.\n      b set-shape to (new Cube init-with size (1, 1, 1)).\n"
      "      b move to (0, 1.5 + i * 1.01, 0).\n      b enable-physics.\n    }\n"
      "}\n",
      120);
}

static void a_flat_link_that_is_refused_leaves_nothing(void) {
  check_goes_on(
      "@use PlanarControl.\n@use Link.\n@use Joint.\nController A.\n"
      "PlanarControl : A {\n"
      "  + variables:\n    l, j (object).\n"
      "  + to refused:\n    j link parent 0 to-child l with-parent-point (3.0, -1.0e14, 0) with-child-point (-1.0, "
      "2.0, 0).\n"
      "  + to init:\n    l = new Link.\n    j = new FixedJoint.\n    l move to (0, 9.0e27, 0).\n"
      "    callMethodNamed(self, \"refused\", {}).\n"
      "  + to iterate:\n    super iterate.\n"
      "}\n",
      5);
  check_goes_on(
      "@use PlanarControl.\n@use Link.\n@use Joint.\nController A.\n"
      "PlanarControl : A {\n"
      "  + variables:\n    l, j (object).\n"
      "  + to refused:\n    j link parent 0 to-child l with-parent-point (3.0, -1.0e300, 0) with-child-point (-1.0, "
      "2.0, 0).\n"
      "  + to init:\n    l = new Link.\n    j = new FixedJoint.\n    callMethodNamed(self, \"refused\", {}).\n"
      "}\n",
      5);
}

static void a_point_too_far_to_be_a_number_is_refused(void) {
  scene s;
  const char* text =
      "@use PhysicalControl.\n@use Link.\n@use Joint.\nController A.\n"
      "PhysicalControl : A {\n"
      "  + variables:\n    a, j (object).\n"
      "  + to far: j link with-normal (1, 0, 0) parent 0 to-child a with-parent-point (0, 2, 0) with-child-point "
      "(0, -1.0e200, 0).\n"
      "  + to init:\n    a = new Link.\n    j = new RevoluteJoint.\n"
      "}\n";
  if (!scene_open_text(&s, text, NULL)) return;
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_call(s.world, breve_world_controller(s.world), "far", NULL, 0, NULL));
  CHECK(strstr(breve_world_last_error(s.world)->message, "child's point") != NULL);
  size_t size = 0;
  unsigned char* image = image_of(s.world, &size);
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  free(image);
  scene_close(&s);
}

void images_suite(void) {
  RUN(a_byte_too_many_is_refused_and_changes_nothing);
  RUN(an_image_cut_anywhere_is_refused_and_changes_nothing);
  RUN(any_byte_may_be_another);
  RUN(links_that_have_lost_their_physics_come_back);
  RUN(links_whose_physics_comes_and_goes_come_back);
  RUN(controllers_that_freed_themselves_in_init_come_back);
  RUN(pairs_that_are_apart_come_back);
  RUN(sleepers_go_on_sleeping);
  RUN(a_flat_link_that_is_refused_leaves_nothing);
  RUN(a_point_too_far_to_be_a_number_is_refused);
}
