/* Fields of many agents at once. Run with each build of Lua. */
#include "scene.h"

#define AGENTS 100

#define FIELD                                                                                                          \
  "local Main = breve.class('Main', 'Control')\nbreve.main(Main)\n"                                                    \
  "local Bug = breve.class('Bug', 'Mobile')\n"                                                                         \
  "function Bug:start(n) self.energy = n / 4 self.age = n self.goal = breve.vector(n, 0, -n) self.name = 'bug' end\n"  \
  "function Main:init() self.bugs = {} for n = 1, 100 do local bug = Bug() bug:start(n) self.bugs[n] = bug end end\n"  \
  "function Main:sum() local sum = 0 for _, b in ipairs(self.bugs) do sum = sum + b.energy + b.goal.y end return sum " \
  "end\n"                                                                                                              \
  "function Main:whole() return math.type(self.bugs[1].age) == 'integer' and 1 or 0 end\n"                             \
  "function Main:tire() self.bugs[7].energy = nil self.bugs[8].energy = 'none' end\n"

static char why[256];

static void keep(void* sink, const char* text, size_t size) {
  (void)sink;
  snprintf(why, sizeof why, "%.*s", (int)size, text);
}

typedef struct field {
  stage s;
  breve_object bugs[AGENTS];
} field;

static bool field_open(field* f) {
  stage_begin(&f->s);
  if (!stage_open(&f->s, FIELD, NULL)) return false;
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_objects(f->s.world, "Bug", f->bugs, AGENTS, &count));
  CHECK_NEAR(AGENTS, (double)count, 0);
  return count == AGENTS;
}

static breve_status get(field* f, const char* name, const breve_array* array) {
  why[0] = 0;
  return breve_lua_objects_get(f->s.world, f->bugs, AGENTS, name, array, keep, NULL);
}

static breve_status set(field* f, const char* name, const breve_array* array) {
  why[0] = 0;
  return breve_lua_objects_set(f->s.world, f->bugs, AGENTS, name, array, keep, NULL);
}

static void numbers_and_vectors_are_read(void) {
  field f;
  float energy[AGENTS];
  struct {
    double goal[3];
    char rest[8];
  } rows[AGENTS];
  const breve_array floats = {energy, 0, BREVE_NUMBER_FLOAT, 1};
  const breve_array vectors = {rows, sizeof rows[0], BREVE_NUMBER_DOUBLE, 3};
  memset(rows, 'r', sizeof rows);
  if (field_open(&f)) {
    CHECK_STATUS(BREVE_OK, get(&f, "energy", &floats));
    CHECK_STATUS(BREVE_OK, get(&f, "goal", &vectors));
    for (int i = 0; i < AGENTS; ++i) {
      CHECK_NEAR((i + 1) / 4.0, energy[i], 0);
      CHECK_NEAR(i + 1, rows[i].goal[0], 0);
      CHECK_NEAR(-i - 1, rows[i].goal[2], 0);
      CHECK(rows[i].rest[0] == 'r' && rows[i].rest[7] == 'r');
    }
    CHECK_STATUS(BREVE_OK, breve_lua_objects_get(f.s.world, NULL, 0, "energy", &floats, NULL, NULL));
  }
  stage_end(&f.s);
}

static void numbers_and_vectors_are_written(void) {
  field f;
  double energy[AGENTS], goal[3 * AGENTS];
  const breve_array doubles = {energy, 0, BREVE_NUMBER_DOUBLE, 1}, vectors = {goal, 0, BREVE_NUMBER_DOUBLE, 3};
  for (int i = 0; i < AGENTS; ++i) energy[i] = 2, goal[3 * i] = 0, goal[3 * i + 1] = 1, goal[3 * i + 2] = 0;
  if (field_open(&f)) {
    CHECK_STATUS(BREVE_OK, set(&f, "energy", &doubles));
    CHECK_STATUS(BREVE_OK, set(&f, "goal", &vectors));
    CHECK_NEAR(3 * AGENTS, stage_number(&f.s, "sum"), 0);
    CHECK_STATUS(BREVE_OK, set(&f, "age", &doubles));
    CHECK_NEAR(1, stage_number(&f.s, "whole"), 0); /* 2, not 2.0 */
    energy[0] = 2.5;
    CHECK_STATUS(BREVE_OK, set(&f, "age", &doubles));
    CHECK_NEAR(0, stage_number(&f.s, "whole"), 0);
  }
  stage_end(&f.s);
}

/* A refusal leaves the array and the fields as they were, and says which object it is about. */
static void fields_that_are_something_else_are_refused(void) {
  field f;
  double numbers[3 * AGENTS];
  const breve_array one = {numbers, 0, BREVE_NUMBER_DOUBLE, 1}, three = {numbers, 0, BREVE_NUMBER_DOUBLE, 3};
  for (int i = 0; i < 3 * AGENTS; ++i) numbers[i] = 5;
  if (field_open(&f)) {
    const double before = stage_number(&f.s, "sum");
    CHECK_STATUS(BREVE_ERROR_TYPE, get(&f, "energy", &three));
    CHECK_TEXT("objects[0]: the field 'energy' is of type number; rows of 3 numbers need a vector", why);
    CHECK_STATUS(BREVE_ERROR_TYPE, get(&f, "goal", &one));
    CHECK_STATUS(BREVE_ERROR_TYPE, get(&f, "name", &one));
    CHECK_STATUS(BREVE_ERROR_NOT_FOUND, get(&f, "mood", &one));
    CHECK_TEXT("objects[0]: the field 'mood' is of type nil; rows of 1 number need a number", why);
    CHECK_STATUS(BREVE_ERROR_NOT_FOUND, set(&f, "mood", &one));
    CHECK_NEAR(before, stage_number(&f.s, "sum"), 0);
    CHECK_STATUS(BREVE_OK, stage_call(&f.s, "tire", NULL));
    CHECK_STATUS(BREVE_ERROR_NOT_FOUND, set(&f, "energy", &one));
    CHECK_TEXT("objects[6]: the field 'energy' is of type nil; rows of 1 number need a number", why);
    CHECK_STATUS(BREVE_OK, breve_lua_objects_get(f.s.world, f.bugs, 6, "energy", &one, keep, NULL));
    CHECK_NEAR(1.5, numbers[5], 0); /* not the 5 that was refused */
    CHECK_NEAR(5, numbers[6], 0);
  }
  stage_end(&f.s);
}

static void objects_and_arrays_that_are_wrong_are_refused(void) {
  field f;
  double numbers[AGENTS];
  const breve_array one = {numbers, 0, BREVE_NUMBER_DOUBLE, 1};
  if (field_open(&f)) {
    const breve_array wrong[] = {{numbers, 0, 2, 1},
                                 {numbers, 0, BREVE_NUMBER_DOUBLE, 2},
                                 {numbers, 7, BREVE_NUMBER_DOUBLE, 1},
                                 {NULL, 0, BREVE_NUMBER_DOUBLE, 1}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
      CHECK_STATUS(BREVE_ERROR_ARGUMENT, get(&f, "energy", &wrong[i]));
      CHECK(strstr(why, "array.") == why);
    }
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, get(&f, NULL, &one));
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, get(&f, "energy", NULL));
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_lua_objects_get(NULL, f.bugs, 1, "energy", &one, NULL, NULL));
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_lua_objects_set(f.s.world, NULL, 1, "energy", &one, NULL, NULL));
    CHECK_STATUS(BREVE_OK, breve_object_free(f.s.world, f.bugs[3]));
    CHECK_STATUS(BREVE_ERROR_STALE, get(&f, "energy", &one));
    CHECK_TEXT("objects[3]: the object has been freed, or is one of another world", why);
    CHECK_STATUS(BREVE_ERROR_STALE, breve_lua_objects_get(f.s.world, f.bugs, AGENTS, "energy", &one, NULL, NULL));
  }
  stage_end(&f.s);
}

static void worlds_without_lua_have_no_fields(void) {
  stage s;
  double number = 0;
  const breve_array one = {&number, 0, BREVE_NUMBER_DOUBLE, 1};
  breve_program* program = NULL;
  breve_world* world = NULL;
  stage_begin(&s);
  CHECK_STATUS(BREVE_OK, breve_program_create_library(s.runtime, "Control", &program));
  CHECK_STATUS(BREVE_OK, breve_world_create(s.runtime, program, NULL, &world));
  const breve_object controller = breve_world_controller(world);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_lua_objects_get(world, &controller, 1, "energy", &one, keep, NULL));
  CHECK_TEXT("the world has no class that is written in Lua", why);
  breve_world_destroy(world);
  breve_program_destroy(program);
  stage_end(&s);
}

int main(void) {
  RUN(numbers_and_vectors_are_read);
  RUN(numbers_and_vectors_are_written);
  RUN(fields_that_are_something_else_are_refused);
  RUN(objects_and_arrays_that_are_wrong_are_refused);
  RUN(worlds_without_lua_have_no_fields);
  if (failures != 0) printf("%d checks failed\n", failures);
  return failures != 0;
}
