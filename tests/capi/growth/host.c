/* A host that is compiled with older or later headers than the library's. Each struct stands in a block of memory of
   just its size, so that a sanitizer sees a byte that is read or written behind it. */
#include <breve/breve.h>
#include <breve/view.h>
#ifdef BREVE_TEST_LUA
#include <breve/breve_lua.h>
#endif
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef BREVE_LATER_HEADER
#define EXPECTED BREVE_ERROR_ARGUMENT
#else
#define EXPECTED BREVE_OK
#endif

static int failures = 0;

static void expect(breve_status expected, breve_status status, const char* what) {
  if (status == expected) return;
  ++failures;
  fprintf(stderr, "%s: %s, not %s\n", what, breve_status_name(status), breve_status_name(expected));
}
#define EXPECT(status, call) expect(status, call, #call)

/* A part of the library that this build, or this machine, may lack: it may say so before it looks at a struct. */
static void expect_if_built(breve_status expected, breve_status status, const char* what) {
  if (status != BREVE_ERROR_UNSUPPORTED) expect(expected, status, what);
}
#define EXPECT_IF_BUILT(status, call) expect_if_built(status, call, #call)

#ifndef BREVE_LATER_HEADER
static void expect_kept(int kept, const char* what) {
  if (kept) return;
  ++failures;
  fprintf(stderr, "a setter changed a field that the host does not have: %s\n", what);
}
#endif

/* A block of the size of a struct, with what its initialiser gives. */
static void* block(const void* made, size_t size) {
  void* const copy = malloc(size);
  if (copy == NULL) exit(2);
  return memcpy(copy, made, size);
}
#define MADE(type, name, initialiser)   \
  const type name##_made = initialiser; \
  type* const name = (type*)block(&name##_made, sizeof *name)

static const char text[] =
    "@use PhysicalControl.\n@use MultiBody.\n@use Spring.\n@use Shape.\n@use Joint.\n"
    "Controller Main.\nPhysicalControl : Main {\n  + variables:\n    base, arm, joint (object).\n"
    "  + to init:\n"
    "    base = new Link. base set-shape to (new Shape init-with-cube size (1, 1, 1)).\n"
    "    arm = new Link. arm set-shape to (new Shape init-with-cube size (1, 1, 1)).\n"
    "  + to get-base: return base.\n  + to get-arm: return arm.\n}\n";

static breve_object asked(breve_world* world, const char* method) {
  breve_value value;
  EXPECT(BREVE_OK, breve_object_call(world, breve_world_controller(world), method, NULL, 0, &value));
  return value.as.object;
}

static void bodies(breve_world* world) {
  MADE(breve_geometry, geometry, breve_geometry_default());
  breve_object shape;
  EXPECT(EXPECTED, breve_shape_create(world, geometry, &shape));
  MADE(breve_joint_description, description, breve_joint_description_default(BREVE_JOINT_REVOLUTE));
  description->parent = asked(world, "get-base");
  description->child = asked(world, "get-arm");
  description->child_point[0] = 2;
  breve_object joint;
  EXPECT(EXPECTED, breve_joint_create(world, description, &joint));
#ifndef BREVE_LATER_HEADER
  MADE(breve_drive, drive, breve_drive_default());
  EXPECT(BREVE_OK, breve_joint_drive(world, joint, drive));
  /* What this header does not have: the number behind the struct. */
  struct {
    breve_drive known;
    double limit_restitution;
  } whole;
  memset(&whole, 0, sizeof whole);
  whole.known.struct_size = sizeof whole;
  EXPECT(BREVE_OK, breve_joint_drive(world, joint, &whole.known));
  whole.limit_restitution = 0.25;
  EXPECT(BREVE_OK, breve_joint_set_drive(world, joint, &whole.known));
  drive->damping = 3;
  EXPECT(BREVE_OK, breve_joint_set_drive(world, joint, drive));
  whole.limit_restitution = 0;
  EXPECT(BREVE_OK, breve_joint_drive(world, joint, &whole.known));
  expect_kept(whole.known.damping == 3 && whole.limit_restitution == 0.25, "limit_restitution of a drive");
  free(drive);
#endif
  free(description);
  free(geometry);
  MADE(breve_spring, spring, breve_spring_default());
  spring->from = asked(world, "get-base");
  spring->to = asked(world, "get-arm");
  breve_object made;
  EXPECT(EXPECTED, breve_spring_create(world, spring, &made));
  if (EXPECTED == BREVE_OK) EXPECT(BREVE_OK, breve_spring_set_description(world, made, spring));
  free(spring);
}

#ifndef BREVE_LATER_HEADER
/* What an older host sets, and what it leaves as it is: the number behind the struct that its header has. */
static void setters_keep_the_rest(breve_world* world) {
  MADE(breve_accuracy, accuracy, breve_accuracy_default());
  struct {
    breve_accuracy known;
    double contact_damping;
  } exact;
  memset(&exact, 0, sizeof exact);
  exact.known.struct_size = sizeof exact;
  EXPECT(BREVE_OK, breve_world_accuracy(world, &exact.known));
  exact.contact_damping = 0.5;
  EXPECT(BREVE_OK, breve_world_set_accuracy(world, &exact.known));
  EXPECT(BREVE_OK, breve_world_accuracy(world, accuracy));
  accuracy->contact_stiffness = 12345;
  EXPECT(BREVE_OK, breve_world_set_accuracy(world, accuracy));
  exact.contact_damping = 0;
  EXPECT(BREVE_OK, breve_world_accuracy(world, &exact.known));
  expect_kept(exact.known.contact_stiffness == 12345 && exact.contact_damping == 0.5, "contact_damping of an accuracy");
  free(accuracy);

  MADE(breve_spring, spring, breve_spring_default());
  struct {
    breve_spring known;
    double maximum_force;
  } strong;
  memset(&strong, 0, sizeof strong);
  strong.known = *spring;
  strong.known.struct_size = sizeof strong;
  strong.known.from = asked(world, "get-base");
  strong.known.to = asked(world, "get-arm");
  strong.maximum_force = 7;
  breve_object made;
  EXPECT(BREVE_OK, breve_spring_create(world, &strong.known, &made));
  EXPECT(BREVE_OK, breve_spring_description(world, made, spring));
  spring->strength = 3;
  EXPECT(BREVE_OK, breve_spring_set_description(world, made, spring));
  strong.maximum_force = 0;
  EXPECT(BREVE_OK, breve_spring_description(world, made, &strong.known));
  expect_kept(strong.known.strength == 3 && strong.maximum_force == 7, "maximum_force of a spring");
  free(spring);
}

/* A host whose header ends before one_way: it knows the categories alone. */
static void a_filter_of_categories_keeps_the_rest(breve_world* world) {
  typedef struct older_filter {
    size_t struct_size;
    uint32_t category, mask;
  } older_filter;
  const size_t known = sizeof(older_filter);
  const breve_object base = asked(world, "get-base");
  breve_collision_filter filter = breve_collision_filter_default();
  filter.category = 2;
  filter.mask = 3;
  filter.one_way[1] = 1;
  filter.sensor = true;
  EXPECT(BREVE_OK, breve_object_set_collision_filter(world, base, &filter));
  filter.struct_size = known;
  older_filter* const few = (older_filter*)block(&filter, known);
  few->category = few->mask = 0;
  EXPECT(BREVE_OK, breve_object_collision_filter(world, base, (breve_collision_filter*)few));
  if (few->category != 2 || few->mask != 3 || few->struct_size != known) {
    ++failures;
    fprintf(stderr, "an older host does not get the fields that it knows\n");
  }
  few->category = 4;
  EXPECT(BREVE_OK, breve_object_set_collision_filter(world, base, (const breve_collision_filter*)few));
  filter = breve_collision_filter_default();
  EXPECT(BREVE_OK, breve_object_collision_filter(world, base, &filter));
  expect_kept(filter.category == 4 && filter.mask == 3 && filter.one_way[1] == 1 && filter.sensor,
              "one_way or sensor of a filter");
  free(few);
}
#endif

static void space(breve_world* world) {
  const double start[3] = {0, 5, 0}, way[3] = {0, -10, 0};
  MADE(breve_query, query, breve_query_default());
  bool found = false;
  EXPECT(EXPECTED, breve_world_ray_first(world, start, way, query, &found, NULL));
  if (EXPECTED == BREVE_OK && !found) {
    ++failures;
    fprintf(stderr, "a ray of an older host finds nothing\n");
  }
  free(query);
  MADE(breve_collision_filter, filter, breve_collision_filter_default());
  EXPECT(EXPECTED, breve_object_collision_filter(world, asked(world, "get-arm"), filter));
  EXPECT(EXPECTED, breve_object_set_collision_filter(world, asked(world, "get-arm"), filter));
  free(filter);
}

static void count_line(void* user, const double from[3], const double to[3], const double rgba[4]) {
  (void)from, (void)to, (void)rgba;
  ++*(int*)user;
}

static void count_contact(void* user, breve_world* world, const breve_contact* contact) {
  (void)world, (void)contact;
  ++*(int*)user;
}

static void callbacks(breve_world* world) {
  int lines = 0, contacts = 0;
  MADE(breve_debug_draw, draw, breve_debug_draw_default());
  draw->user = &lines;
  draw->line = count_line;
  EXPECT(EXPECTED, breve_world_debug_draw(world, draw));
  if ((EXPECTED == BREVE_OK) != (lines > 0)) {
    ++failures;
    fprintf(stderr, "debug draw: %d lines\n", lines);
  }
  free(draw);
  MADE(breve_listener, listener, breve_listener_default());
  listener->user = &contacts;
  listener->contact = count_contact;
  EXPECT(EXPECTED, breve_world_set_listener(world, listener));
  EXPECT(EXPECTED, breve_world_listener(world, listener));
  EXPECT(BREVE_OK, breve_world_step(world));
  EXPECT(BREVE_OK, breve_world_set_listener(world, NULL));
  free(listener);
  MADE(breve_state, state, breve_state_default());
  state->user = &contacts;
  EXPECT(EXPECTED, breve_world_set_state(world, "growth", state));
  free(state);
}

static breve_status doubled(void* user, const breve_call* call, breve_value* result) {
  (void)user;
  *result = breve_value_int(2 * call->arguments[0].as.integer);
  return BREVE_OK;
}

static void extensions(breve_runtime* runtime) {
  static const uint32_t types[] = {BREVE_TYPE_INT};
  MADE(breve_function, function, breve_function_default());
  function->name = "doubled";
  function->parameters = types;
  function->parameter_count = 1;
  function->call = doubled;
  EXPECT(EXPECTED, breve_runtime_add_function(runtime, function));
  free(function);
  breve_method method;
  memset(&method, 0, sizeof method);
  method.name = "grow";
  method.call = doubled;
  MADE(breve_class, description, breve_class_default());
  description->name = "Grown";
  description->methods = &method;
  description->method_count = 1;
  EXPECT(EXPECTED, breve_runtime_add_class(runtime, description));
  free(description);
  MADE(breve_network_config, config, breve_network_config_default());
  breve_network network;
  memset(&network, 0, sizeof network);
  EXPECT_IF_BUILT(EXPECTED, breve_network_open(config, &network));
  EXPECT(BREVE_OK, breve_network_release(&network));
  free(config);
#ifdef BREVE_TEST_LUA
  MADE(breve_lua_config, lua, breve_lua_config_default());
  EXPECT(EXPECTED, breve_lua_add(runtime, lua, "growth.lua", "", 0, NULL, NULL));
  free(lua);
#endif
}

static void pictures(breve_runtime* runtime, breve_world* world) {
  MADE(breve_view_config, config, breve_view_config_default());
  breve_view* view = NULL;
  EXPECT_IF_BUILT(EXPECTED, breve_view_create(runtime, config, &view));
  free(config);
  if (view == NULL) breve_view_create(runtime, NULL, &view);
  if (view != NULL) {
    MADE(breve_view_counters, counters, breve_view_counters_default());
    EXPECT(EXPECTED, breve_view_counts(view, counters));
    free(counters);
  }
  breve_view_destroy(view);
  breve_scene* scene = NULL;
  EXPECT(BREVE_OK, breve_scene_create(&scene));
  EXPECT(BREVE_OK, breve_scene_read(scene, world));
  MADE(breve_backdrop, backdrop, breve_backdrop_default());
  EXPECT(EXPECTED, breve_scene_backdrop(scene, backdrop));
  free(backdrop);
  breve_scene_destroy(scene);
  MADE(breve_plot_config, plot, breve_plot_config_default());
  size_t size = 0;
  EXPECT(EXPECTED, breve_plot_file(plot, BREVE_PLOT_FORMAT_CSV, NULL, 0, &size));
  free(plot);
  MADE(breve_movie_config, movie_config, breve_movie_config_default());
  movie_config->width = movie_config->height = 16;
  movie_config->path = "growth.gif"; /* not finished, and so removed */
  breve_movie* movie = NULL;
  EXPECT(EXPECTED, breve_movie_create(runtime, movie_config, &movie));
  breve_movie_destroy(movie);
  free(movie_config);
}

static void batches(breve_runtime* runtime, const breve_program* program) {
  MADE(breve_batch, batch, breve_batch_default());
  batch->count = 2;
  batch->iterations = 1;
  batch->workers = 1;
  breve_outcome outcomes[2];
  memset(outcomes, 0, sizeof outcomes);
  EXPECT(EXPECTED, breve_batch_run(runtime, program, batch, outcomes));
  if (EXPECTED == BREVE_OK && outcomes[1].iterations != 1) {
    ++failures;
    fprintf(stderr, "a batch of an older host does not run\n");
  }
  free(batch);
}

static void results(breve_world* world) {
  MADE(breve_accuracy, accuracy, breve_accuracy_default());
  EXPECT(EXPECTED, breve_rung_accuracy(BREVE_RUNG_PRECISE, accuracy));
  EXPECT(EXPECTED, breve_world_set_accuracy(world, accuracy));
  EXPECT(EXPECTED, breve_world_accuracy(world, accuracy));
  free(accuracy);
  MADE(breve_energy, energy, breve_energy_default());
  EXPECT(EXPECTED, breve_world_energy(world, energy));
  free(energy);
  MADE(breve_physics_counters, counters, breve_physics_counters_default());
  EXPECT(EXPECTED, breve_world_physics_counters(world, counters));
  free(counters);
  MADE(breve_stats, stats, breve_stats_default());
  EXPECT(EXPECTED, breve_world_stats(world, stats));
  free(stats);
}

int main(void) {
  MADE(breve_runtime_config, runtime_config, breve_runtime_config_default());
  breve_runtime* runtime = NULL;
  EXPECT(EXPECTED, breve_runtime_create(runtime_config, &runtime));
  free(runtime_config);
  if (runtime == NULL) EXPECT(BREVE_OK, breve_runtime_create(NULL, &runtime));
  breve_runtime* other = NULL;
  EXPECT(BREVE_ERROR_UNSUPPORTED, breve_runtime_create_for(BREVE_ABI + 1, NULL, &other));
  extensions(runtime);
  breve_program* program = NULL;
  EXPECT(BREVE_OK, breve_program_compile(runtime, "growth.tz", text, strlen(text), &program));
  MADE(breve_world_config, world_config, breve_world_config_default());
  breve_world* world = NULL;
  EXPECT(EXPECTED, breve_world_create(runtime, program, world_config, &world));
  free(world_config);
  if (world == NULL) EXPECT(BREVE_OK, breve_world_create(runtime, program, NULL, &world));
  bodies(world);
#ifndef BREVE_LATER_HEADER
  setters_keep_the_rest(world);
  a_filter_of_categories_keeps_the_rest(world);
#endif
  space(world);
  callbacks(world);
  results(world);
  pictures(runtime, world);
  batches(runtime, program);
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return failures == 0 ? 0 : 1;
}
