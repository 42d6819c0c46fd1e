/* Many objects at once: places, motion, colours and variables as arrays, and calls of all of them. */
#include <math.h>
#include <string.h>

#include "scene.h"

enum { kBirds = 5 };

static const char* const flock =
    "@use Control.\n@use Mobile.\nController Main.\n"
    "Mobile : Bird (aka Birds) {\n"
    "  + variables:\n    energy (float). age (int). goal (vector). name (string). friend (object). past (3 ints).\n"
    "  + to init:\n    energy = 1.5.\n    age = 7.\n    goal = (1, 2, 3).\n    name = \"bird\".\n"
    "  + to be-older by years = 1 (int):\n    age += years.\n    return age.\n"
    "  + to eat bird victim (object):\n    if victim: free victim.\n    victim = 0.\n    return energy.\n"
    "  + to say-name:\n    return name.\n"
    "  + to fall-at-seven:\n    if age == 7: return { 1, 2 }{age}.\n    return 1.\n"
    "}\n"
    "Mobile : Plane {\n  + variables:\n    energy (float). goal (float).\n}\n"
    "Control : Main {\n"
    "  + variables:\n    birds (list). plane (object). chosen (object).\n"
    "  + to init:\n    birds = 5 new Birds.\n    plane = new Plane.\n"
    "  + to free-next-of bird one (object):\n    free chosen.\n"
    "}\n";

/* What the functions here are tried on. */
typedef struct aviary {
  scene s;
  breve_object birds[kBirds], plane;
} aviary;

static bool open_text(aviary* a, const char* text) {
  size_t count = 0;
  if (!scene_open_text(&a->s, text, NULL)) return false;
  CHECK_STATUS(BREVE_OK, breve_world_objects(a->s.world, "Bird", a->birds, kBirds, &count));
  CHECK(count == kBirds);
  CHECK_STATUS(BREVE_OK, breve_world_objects(a->s.world, "Plane", &a->plane, 1, &count));
  return true;
}

static breve_array doubles(double* numbers, uint32_t width) {
  const breve_array array = {numbers, 0, BREVE_NUMBER_DOUBLE, width};
  return array;
}

static uint64_t hash_of(const aviary* a) {
  uint64_t hash = 0;
  CHECK_STATUS(BREVE_OK, breve_world_hash(a->s.world, &hash));
  return hash;
}

static void properties_are_those_of_each(const char* text) {
  static const uint32_t widths[] = {3, 4, 7, 3, 3, 4};
  aviary a;
  if (!open_text(&a, text)) return;
  breve_world* const w = a.s.world;
  for (int i = 0; i < kBirds; ++i) {
    const breve_pose pose = {{i, 2 * i, 0}, {cos(0.1 * i), 0, 0, sin(0.1 * i)}};
    const double velocity[3] = {0.5 * i, -i, 0}, turning[3] = {0, 0, 0.25 * i}, rgba[4] = {0.1 * i, 0.2, 0.3, 0.5};
    CHECK_STATUS(BREVE_OK, breve_object_set_pose(w, a.birds[i], &pose));
    CHECK_STATUS(BREVE_OK, breve_object_set_velocity(w, a.birds[i], velocity));
    CHECK_STATUS(BREVE_OK, breve_object_set_rotational_velocity(w, a.birds[i], turning));
    CHECK_STATUS(BREVE_OK, breve_object_set_color(w, a.birds[i], rgba));
  }
  for (uint32_t property = BREVE_PROPERTY_LOCATION; property <= BREVE_PROPERTY_COLOR; ++property) {
    const uint64_t before = hash_of(&a);
    double all[kBirds * 7], one[7];
    const breve_array array = doubles(all, widths[property]);
    CHECK_STATUS(BREVE_OK, breve_objects_property(w, a.birds, kBirds, property, &array));
    for (int i = 0; i < kBirds; ++i) {
      breve_pose pose;
      CHECK_STATUS(BREVE_OK, breve_object_pose(w, a.birds[i], &pose));
      const double* row = all + i * (int)widths[property];
      if (property == BREVE_PROPERTY_LOCATION || property == BREVE_PROPERTY_POSE)
        CHECK(memcmp(row, pose.location, sizeof pose.location) == 0);
      if (property == BREVE_PROPERTY_POSE) row += 3;
      if (property == BREVE_PROPERTY_ROTATION || property == BREVE_PROPERTY_POSE)
        CHECK(memcmp(row, pose.rotation, sizeof pose.rotation) == 0);
      if (property == BREVE_PROPERTY_VELOCITY) CHECK_STATUS(BREVE_OK, breve_object_velocity(w, a.birds[i], one));
      if (property == BREVE_PROPERTY_ROTATIONAL_VELOCITY)
        CHECK_STATUS(BREVE_OK, breve_object_rotational_velocity(w, a.birds[i], one));
      if (property == BREVE_PROPERTY_COLOR) CHECK_STATUS(BREVE_OK, breve_object_color(w, a.birds[i], one));
      if (property >= BREVE_PROPERTY_VELOCITY) CHECK(memcmp(row, one, widths[property] * sizeof(double)) == 0);
    }
    /* The values are written back unchanged, and nothing has changed; rotations are made unit quaternions anew. */
    CHECK_STATUS(BREVE_OK, breve_objects_set_property(w, a.birds, kBirds, property, &array));
    if (property != BREVE_PROPERTY_ROTATION && property != BREVE_PROPERTY_POSE) CHECK(hash_of(&a) == before);
  }
  scene_close(&a.s);
}

static void rows_lie_where_the_host_has_them(void) {
  typedef struct instance {
    char tag;
    float place[3];
    uint32_t texture;
  } instance;
  aviary a;
  if (!open_text(&a, flock)) return;
  instance all[kBirds];
  memset(all, 0x55, sizeof all);
  for (int i = 0; i < kBirds; ++i)
    for (int k = 0; k < 3; ++k) all[i].place[k] = (float)(10 * i + k) + 0.5F;
  const breve_array array = {all[0].place, sizeof(instance), BREVE_NUMBER_FLOAT, 3};
  CHECK_STATUS(BREVE_OK, breve_objects_set_property(a.s.world, a.birds, kBirds, BREVE_PROPERTY_LOCATION, &array));
  breve_pose pose;
  CHECK_STATUS(BREVE_OK, breve_object_pose(a.s.world, a.birds[3], &pose));
  CHECK(pose.location[0] == 30.5 && pose.location[1] == 31.5 && pose.location[2] == 32.5);
  for (int i = 0; i < kBirds; ++i) memset(all[i].place, 0, sizeof all[i].place);
  CHECK_STATUS(BREVE_OK, breve_objects_property(a.s.world, a.birds, kBirds, BREVE_PROPERTY_LOCATION, &array));
  for (int i = 0; i < kBirds; ++i) {
    CHECK(all[i].place[2] == (float)(10 * i) + 2.5F);
    CHECK(all[i].tag == 0x55 && all[i].texture == 0x55555555);
  }
  /* At any address. */
  char bytes[1 + 3 * sizeof(double)];
  const breve_array odd = {bytes + 1, 0, BREVE_NUMBER_DOUBLE, 3};
  double place[3];
  CHECK_STATUS(BREVE_OK, breve_objects_property(a.s.world, a.birds + 3, 1, BREVE_PROPERTY_LOCATION, &odd));
  memcpy(place, bytes + 1, sizeof place);
  CHECK(memcmp(place, pose.location, sizeof place) == 0);
  scene_close(&a.s);
}

static void variables_are_those_of_each(void) {
  aviary a;
  if (!open_text(&a, flock)) return;
  breve_world* const w = a.s.world;
  double energy[kBirds + 1], goal[kBirds][3];
  float age[kBirds];
  const breve_array energies = doubles(energy, 1), goals = doubles(goal[0], 3);
  const breve_array ages = {age, 0, BREVE_NUMBER_FLOAT, 1};
  CHECK_STATUS(BREVE_OK, breve_objects_get(w, a.birds, kBirds, "energy", &energies));
  CHECK_STATUS(BREVE_OK, breve_objects_get(w, a.birds, kBirds, "age", &ages));
  CHECK_STATUS(BREVE_OK, breve_objects_get(w, a.birds, kBirds, "goal", &goals));
  for (int i = 0; i < kBirds; ++i) CHECK(energy[i] == 1.5 && age[i] == 7 && goal[i][0] == 1 && goal[i][2] == 3);
  for (int i = 0; i < kBirds; ++i) energy[i] = i + 0.25, age[i] = (float)i, goal[i][1] = -i;
  CHECK_STATUS(BREVE_OK, breve_objects_set(w, a.birds, kBirds, "energy", &energies));
  CHECK_STATUS(BREVE_OK, breve_objects_set(w, a.birds, kBirds, "age", &ages));
  CHECK_STATUS(BREVE_OK, breve_objects_set(w, a.birds, kBirds, "goal", &goals));
  breve_value value;
  CHECK_STATUS(BREVE_OK, breve_object_get(w, a.birds[4], "energy", &value));
  CHECK(value.type == BREVE_TYPE_DOUBLE && value.as.number == 4.25);
  CHECK_STATUS(BREVE_OK, breve_object_get(w, a.birds[4], "age", &value));
  CHECK(value.type == BREVE_TYPE_INT && value.as.integer == 4);
  CHECK_STATUS(BREVE_OK, breve_object_get(w, a.birds[4], "goal", &value));
  CHECK(value.as.vector[0] == 1 && value.as.vector[1] == -4 && value.as.vector[2] == 3);
  /* Objects of two classes, where the variable has one type. */
  breve_object mixed[kBirds + 1];
  memcpy(mixed, a.birds, sizeof a.birds);
  mixed[kBirds] = a.plane;
  CHECK_STATUS(BREVE_OK, breve_objects_get(w, mixed, kBirds + 1, "energy", &energies));
  CHECK(energy[4] == 4.25 && energy[kBirds] == 0);
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_objects_get(w, mixed, kBirds + 1, "goal", &goals));
  scene_close(&a.s);
}

static void what_is_refused_changes_nothing(const char* text, bool flat) {
  aviary a;
  if (!open_text(&a, text)) return;
  breve_world* const w = a.s.world;
  const uint64_t before = hash_of(&a);
  double all[kBirds * 7];
  for (int i = 0; i < kBirds * 7; ++i) all[i] = i % 7 == 2 || i % 7 == 4 || i % 7 == 5 ? 0 : i;
  breve_array poses = doubles(all, 7), places = doubles(all, 3), ages = doubles(all, 1);
  all[4 * 7] = NAN;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_set_property(w, a.birds, kBirds, BREVE_PROPERTY_POSE, &poses));
  all[4 * 7] = 1;
  all[4 * 7 + 3] = all[4 * 7 + 6] = 0;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_set_property(w, a.birds, kBirds, BREVE_PROPERTY_POSE, &poses));
  CHECK_TEXT("objects[4]: a rotation has length 0: it is not a rotation", breve_world_last_error(w)->message);
  all[4 * 7 + 3] = 1;
  if (flat) {
    all[4 * 7 + 2] = 0.5; /* out of the plane */
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_set_property(w, a.birds, kBirds, BREVE_PROPERTY_POSE, &poses));
    all[4 * 7 + 2] = 0;
    all[4 * 7 + 4] = 0.5; /* about another axis */
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_set_property(w, a.birds, kBirds, BREVE_PROPERTY_POSE, &poses));
    all[4 * 7 + 4] = 0;
  }
  CHECK(hash_of(&a) == before);
  CHECK_STATUS(BREVE_OK, breve_objects_set_property(w, a.birds, kBirds, BREVE_PROPERTY_POSE, &poses));
  CHECK(hash_of(&a) != before);
  const uint64_t after = hash_of(&a);
  /* Invalid ids, arrays and names. */
  const breve_object gone = a.birds[4], nobody = {0, 0};
  const breve_object controller = breve_world_controller(w);
  a.birds[4] = controller;
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_objects_set_property(w, a.birds, kBirds, BREVE_PROPERTY_LOCATION, &places));
  a.birds[4] = nobody;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_property(w, a.birds, kBirds, BREVE_PROPERTY_LOCATION, &places));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_get(w, a.birds, kBirds, "energy", &ages));
  CHECK_TEXT("objects[4]: the null object was given where a live one is needed", breve_world_last_error(w)->message);
  a.birds[4] = gone;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_property(w, a.birds, kBirds, 6, &places));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_property(w, a.birds, kBirds, BREVE_PROPERTY_COLOR, &places));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_property(w, NULL, 1, BREVE_PROPERTY_LOCATION, &places));
  places.stride = 23;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_property(w, a.birds, kBirds, BREVE_PROPERTY_LOCATION, &places));
  CHECK_TEXT("array.stride is 23 bytes, but an object's 3 numbers take 24", breve_world_last_error(w)->message);
  places.stride = 0;
  places.number = 2;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_property(w, a.birds, kBirds, BREVE_PROPERTY_LOCATION, &places));
  places.number = BREVE_NUMBER_DOUBLE;
  places.numbers = NULL;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_property(w, a.birds, kBirds, BREVE_PROPERTY_LOCATION, &places));
  CHECK_STATUS(BREVE_OK, breve_objects_property(w, NULL, 0, BREVE_PROPERTY_LOCATION, &places));
  CHECK_STATUS(BREVE_OK, breve_objects_set(w, NULL, 0, "anything", &places));
  all[0] = 1, all[1] = 2.5, all[2] = 3;
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_objects_set(w, a.birds, 3, "age", &ages));
  CHECK_TEXT("objects[1]: an int cannot represent 2.500000", breve_world_last_error(w)->message);
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_objects_get(w, a.birds, 3, "name", &ages));
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_objects_get(w, a.birds, 3, "friend", &ages));
  CHECK_STATUS(BREVE_ERROR_UNSUPPORTED, breve_objects_get(w, a.birds, 3, "past", &ages));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_objects_get(w, a.birds, 3, "wings", &ages));
  CHECK(hash_of(&a) == after);
  CHECK_STATUS(BREVE_OK, breve_object_free(w, gone));
  const uint64_t fewer = hash_of(&a);
  CHECK_STATUS(BREVE_ERROR_STALE, breve_objects_set(w, a.birds, kBirds, "energy", &ages));
  CHECK(hash_of(&a) == fewer);
  scene_close(&a.s);
}

static void all_are_called(void) {
  aviary a;
  if (!open_text(&a, flock)) return;
  breve_world* const w = a.s.world;
  breve_selector older, eat, name, fall;
  const char* const by[] = {"by"};
  const char* const bird[] = {"bird"};
  CHECK_STATUS(BREVE_OK, breve_world_prepare(w, "be-older", by, 1, &older));
  CHECK_STATUS(BREVE_OK, breve_world_prepare(w, "eat", bird, 1, &eat));
  CHECK_STATUS(BREVE_OK, breve_world_prepare(w, "say-name", NULL, 0, &name));
  CHECK_STATUS(BREVE_OK, breve_world_prepare(w, "fall-at-seven", NULL, 0, &fall));
  breve_value results[kBirds], years = breve_value_int(3);
  CHECK_STATUS(BREVE_OK, breve_objects_call_prepared(w, a.birds, kBirds, older, &years, 1, results));
  for (int i = 0; i < kBirds; ++i) CHECK(results[i].type == BREVE_TYPE_INT && results[i].as.integer == 10);
  CHECK_STATUS(BREVE_OK, breve_objects_call_prepared(w, a.birds, kBirds, name, NULL, 0, results));
  CHECK(results[0].type == BREVE_TYPE_NULL); /* a text does not last */
  CHECK_STATUS(BREVE_OK, breve_objects_call_prepared(w, a.birds, kBirds, older, &years, 1, NULL));
  /* The first eats the third, which is passed over; for the fourth it is gone. */
  breve_value victim = breve_value_object(a.birds[2]);
  CHECK_STATUS(BREVE_ERROR_STALE, breve_objects_call_prepared(w, a.birds, kBirds, eat, &victim, 1, results));
  CHECK(results[0].type == BREVE_TYPE_DOUBLE && !breve_object_alive(w, a.birds[2]));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_objects_call_prepared(w, a.birds, kBirds, name, NULL, 0, results));
  a.birds[2] = a.birds[3];
  /* An error ends it: who came before is done. */
  const double ages[] = {1, 7, 1};
  const breve_array array = doubles((double*)ages, 1);
  CHECK_STATUS(BREVE_OK, breve_objects_set(w, a.birds, 3, "age", &array));
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_objects_call_prepared(w, a.birds, 3, fall, NULL, 0, results));
  CHECK(results[0].as.integer == 1 && results[1].type == BREVE_TYPE_NULL);
  years.type = 99;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_call_prepared(w, a.birds, 1, older, &years, 1, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_call_prepared(w, a.birds, 1, older, &years, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_objects_call_prepared(w, NULL, 1, name, NULL, 0, NULL));
  older.index = 999;
  CHECK_STATUS(BREVE_ERROR_STALE, breve_objects_call_prepared(w, a.birds, 1, older, &years, 1, NULL));
  scene_close(&a.s);
}

/* The same program with a controller of flat worlds. */
static const char* flat_flock(void) {
  static char text[4096];
  const char* const main_class = strstr(flock, "Control : Main");
  snprintf(text, sizeof text, "@use PlanarControl.\n%.*sPlanar%s", (int)(main_class - flock), flock, main_class);
  return text;
}

static void properties_are_those_of_each_bird(void) { properties_are_those_of_each(flock); }
static void so_they_are_in_a_flat_world(void) { properties_are_those_of_each(flat_flock()); }
static void what_is_refused_in_space_changes_nothing(void) { what_is_refused_changes_nothing(flock, false); }
static void what_is_refused_in_a_plane_changes_nothing(void) { what_is_refused_changes_nothing(flat_flock(), true); }

void bulk_suite(void) {
  RUN(properties_are_those_of_each_bird);
  RUN(so_they_are_in_a_flat_world);
  RUN(rows_lie_where_the_host_has_them);
  RUN(variables_are_those_of_each);
  RUN(what_is_refused_in_space_changes_nothing);
  RUN(what_is_refused_in_a_plane_changes_nothing);
  RUN(all_are_called);
}
