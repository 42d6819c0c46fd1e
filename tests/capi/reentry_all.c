/* Every function of breve.h from inside every callback: it works, or says BREVE_ERROR_BUSY, and all goes on. A test
   looks that each function of the header is named in this file. */
#include <stdlib.h>

#include "breve/analysis.h"
#include "breve/sound.h"
#include "scene.h"

/* Where a call is made from. */
typedef struct place {
  breve_runtime* runtime;
  breve_program* program;
  breve_world* world;
  breve_object controller, ball;
  breve_selector touch;
  char* image; /* of the world, when it was idle */
  size_t image_size;
} place;

static const breve_object nobody = {0, 0};
static const char* const small_text = "@use Control.\nController Small.\nControl : Small { }\n";

/* --- one function a function of breve.h that can do anything; those that only look are in look_around ------------- */

#define TRY(call)                        \
  do {                                   \
    const breve_status tried = (call);   \
    if (tried != BREVE_OK) return tried; \
  } while (0)
static breve_status do_files_within(place* p) {
  (void)p;
  breve_files files = {0};
  const breve_status status = breve_files_add_directory(".", false, 0, &files);
  breve_files_release(&files);
  return status;
}
static breve_status do_files_release(place* p) {
  (void)p;
  breve_files files = {0};
  return breve_files_release(&files);
}
static breve_status do_runtime_destroy(place* p) { return breve_runtime_destroy(p->runtime); }
static breve_status do_runtime_allow(place* p) { return breve_runtime_allow_lint(p->runtime, "lint-unused-variable"); }
static breve_status never_called(void* user, const breve_call* call, breve_value* result) {
  (void)user, (void)call, (void)result;
  return BREVE_OK;
}
static breve_status do_add_function(place* p) {
  static int number;
  char name[32];
  breve_function function = breve_function_default();
  sprintf(name, "function%d", number++);
  function.name = name;
  function.call = never_called;
  return breve_runtime_add_function(p->runtime, &function);
}
static breve_status do_add_class(place* p) {
  static int number;
  char name[32];
  breve_class description = breve_class_default();
  sprintf(name, "Class%d", number++);
  description.name = name;
  return breve_runtime_add_class(p->runtime, &description);
}
static breve_status do_prepare_super(place* p) {
  breve_selector selector;
  return breve_world_prepare_super(p->world, "Ball", "iterate", NULL, 0, &selector);
}
static breve_status do_methods(place* p) {
  size_t count;
  return breve_world_methods(p->world, "Ball", NULL, 0, &count);
}
static breve_status do_draw(place* p) {
  const breve_value bound = breve_value_int(3);
  breve_value drawn;
  return breve_world_random(p->world, &bound, &drawn);
}
static breve_status do_print(place* p) { return breve_world_print(p->world, "", 0); }
static breve_status do_user(place* p) {
  void* user = NULL;
  TRY(breve_world_set_user(p->world, breve_world_user(p->world), NULL));
  TRY(breve_object_user(p->world, p->controller, &user));
  return breve_object_set_user(p->world, p->controller, user, NULL);
}
static breve_status do_state(place* p) {
  CHECK(breve_world_state(p->world, "none") == NULL);
  CHECK(!breve_world_has_budget(p->world));
  return breve_world_set_state(p->world, "none", NULL);
}
static breve_status do_allocate(place* p) {
  void* memory = breve_world_allocate(p->world, 100);
  breve_world_release(p->world, memory, 100);
  return memory ? BREVE_OK : BREVE_ERROR_MEMORY;
}
static breve_status do_list_read(place* p) {
  breve_value list;
  TRY(breve_list_create(p->world, &list));
  return breve_list_read(p->world, &list, 0, NULL, 0);
}
static breve_status do_charge(place* p) { return breve_world_charge(p->world, 1); }
static breve_status do_load(place* p) {
  breve_program* made = NULL;
  const breve_status status = breve_program_load(p->runtime, "there-is-none.tz", &made);
  breve_program_destroy(made);
  return status;
}
static breve_status do_compile(place* p) {
  breve_program* made = NULL;
  const breve_status status = breve_program_compile(p->runtime, "small.tz", small_text, strlen(small_text), &made);
  breve_program_destroy(made);
  return status;
}
static breve_status do_analyse(place* p) {
  breve_analysis* made = NULL;
  const breve_status status = breve_analysis_create(p->runtime, "small.tz", small_text, strlen(small_text), &made);
  breve_analysis_destroy(made);
  return status;
}
static breve_status do_world_create(place* p) {
  breve_world* made = NULL;
  const breve_status status = breve_world_create(p->runtime, p->program, NULL, &made);
  if (status == BREVE_OK) CHECK_STATUS(BREVE_OK, breve_world_destroy(made));
  return status;
}
static breve_status do_destroy(place* p) { return breve_world_destroy(p->world); }
static breve_status do_step(place* p) { return breve_world_step(p->world); }
static breve_status do_advance(place* p) { return breve_world_advance(p->world, .1, NULL); }
static breve_status do_set_paused(place* p) { return breve_world_set_paused(p->world, false); }
static breve_status do_random(place* p) {
  double number;
  return breve_world_draw_random(p->world, &number);
}
static breve_status do_objects(place* p) {
  breve_object some[2];
  size_t count;
  return breve_world_objects(p->world, NULL, some, 2, &count);
}
static breve_status do_is_a(place* p) {
  bool is;
  return breve_object_is_a(p->world, p->ball, "Mobile", &is);
}
static breve_status do_create_and_free(place* p) {
  breve_object made;
  const breve_status status = breve_object_create(p->world, "Ball", &made);
  if (status == BREVE_OK) CHECK_STATUS(BREVE_OK, breve_object_free(p->world, made));
  return status;
}
static breve_status do_pose(place* p) {
  breve_pose pose;
  const breve_status status = breve_object_pose(p->world, p->ball, &pose);
  return status != BREVE_OK ? status : breve_object_set_pose(p->world, p->ball, &pose);
}
static breve_status do_target(place* p) {
  const breve_pose pose = {{0, 0, 0}, {1, 0, 0, 0}};
  bool moves;
  TRY(breve_object_set_target(p->world, p->ball, &pose));
  return breve_object_target(p->world, p->ball, &moves, NULL);
}
static breve_status do_contact_force(place* p) {
  const breve_object all = {0, 0};
  double force[3];
  return breve_object_contact_force(p->world, p->ball, all, force);
}
static breve_status do_listener(place* p) {
  breve_listener listener = breve_listener_default();
  TRY(breve_world_listener(p->world, &listener));
  return breve_world_set_listener(p->world, &listener);
}
static breve_status do_velocity(place* p) {
  double v[3];
  const breve_status status = breve_object_velocity(p->world, p->ball, v);
  return status != BREVE_OK ? status : breve_object_set_velocity(p->world, p->ball, v);
}
static breve_status do_rotation(place* p) {
  double v[3];
  const breve_status status = breve_object_rotational_velocity(p->world, p->ball, v);
  return status != BREVE_OK ? status : breve_object_set_rotational_velocity(p->world, p->ball, v);
}
static breve_status do_color(place* p) {
  double rgba[4];
  const breve_status status = breve_object_color(p->world, p->ball, rgba);
  return status != BREVE_OK ? status : breve_object_set_color(p->world, p->ball, rgba);
}
static breve_status do_shape(place* p) {
  breve_shape shape;
  uint32_t sizes[8], indices[32];
  double corners[24];
  breve_status status = breve_object_shape(p->world, p->ball, &shape);
  if (status == BREVE_OK) status = breve_object_shape_vertices(p->world, p->ball, corners, 8);
  return status != BREVE_OK ? status : breve_object_shape_faces(p->world, p->ball, sizes, 8, indices, 32);
}
static breve_status do_text(place* p) {
  const char* text;
  const breve_value value = breve_value_object(p->ball);
  return breve_value_text(p->world, &value, &text);
}
static breve_status do_list(place* p) {
  breve_value list, element = breve_value_int(7);
  size_t size = 0;
  breve_status status = breve_list_create(p->world, &list);
  if (status == BREVE_OK) status = breve_list_push(p->world, &list, &element);
  if (status == BREVE_OK) status = breve_list_get(p->world, &list, 0, &element);
  if (status == BREVE_OK) status = breve_list_size(p->world, &list, &size);
  CHECK(status != BREVE_OK || size == 1);
  return status;
}
static breve_status do_hash_value(place* p) {
  const breve_value key = breve_value_string("k");
  breve_value hash, keys, element = breve_value_double(7);
  size_t size = 0;
  breve_status status = breve_hash_create(p->world, &hash);
  if (status == BREVE_OK) status = breve_hash_set(p->world, &hash, &key, &element);
  if (status == BREVE_OK) status = breve_hash_get(p->world, &hash, &key, &element);
  if (status == BREVE_OK) status = breve_hash_keys(p->world, &hash, &keys);
  if (status == BREVE_OK) status = breve_hash_size(p->world, &hash, &size);
  CHECK(status != BREVE_OK || size == 1);
  return status;
}
static breve_status do_get_and_set(place* p) {
  breve_value value;
  const breve_status status = breve_object_get(p->world, p->controller, "level", &value);
  return status != BREVE_OK ? status : breve_object_set(p->world, p->controller, "level", &value);
}
static breve_status do_call(place* p) { return breve_object_call(p->world, p->controller, "touch", NULL, 0, NULL); }
static breve_status do_prepare(place* p) {
  breve_selector selector;
  return breve_world_prepare(p->world, "touch", NULL, 0, &selector);
}
static breve_status do_call_prepared(place* p) {
  return breve_object_call_prepared(p->world, p->controller, p->touch, NULL, 0, NULL);
}
static breve_status do_key(place* p) { return breve_world_queue_key(p->world, "q", true); }
static breve_status do_click(place* p) { return breve_world_queue_click(p->world, nobody); }
static breve_status do_menu(place* p) {
  breve_menu_item items[1];
  size_t count = 0;
  const breve_status status = breve_world_menu_items(p->world, items, 1, &count);
  return status != BREVE_OK || count == 0 ? status : breve_world_queue_choice(p->world, items[0].item);
}
static breve_status do_hash(place* p) {
  uint64_t hash;
  return breve_world_hash(p->world, &hash);
}
static breve_status do_snapshot(place* p) {
  size_t size;
  return breve_world_snapshot(p->world, NULL, 0, &size);
}
static breve_status do_restore(place* p) { return breve_world_restore(p->world, p->image, p->image_size); }
static breve_status do_effects(place* p) {
  size_t count;
  return breve_world_effects(p->world, NULL, 0, &count);
}
static breve_status do_stats(place* p) {
  breve_stats stats = breve_stats_default();
  return breve_world_stats(p->world, &stats);
}
static breve_status do_profile_start(place* p) { return breve_world_profile_start(p->world, NULL, NULL); }
static breve_status do_profile_stop(place* p) { return breve_world_profile_stop(p->world); }
static breve_status do_profile_count(place* p) {
  size_t count;
  return breve_world_profile_node_count(p->world, &count);
}
static breve_status do_profile_node(place* p) {
  breve_profile_node node;
  return breve_world_profile_node(p->world, 0, &node);
}
static breve_status do_profile_cost(place* p) {
  double seconds;
  return breve_world_profile_cost(p->world, &seconds);
}
static breve_status do_profile_enter(place* p) {
  static const breve_place ship = {"turn", "ship.c", 7};
  CHECK(!breve_world_is_profiled(NULL));
  TRY(breve_world_profile_line(p->world, 3));
  TRY(breve_world_profile_enter(p->world, "Ship", &ship));
  return breve_world_profile_leave(p->world);
}
static breve_status do_reload(place* p) { return breve_world_reload(p->world, p->program); }
static breve_status do_evaluate(place* p) { return breve_world_evaluate(p->world, nobody, "calls += 0", 10, NULL); }
static breve_status do_session(place* p) {
  breve_value hash;
  return breve_world_session(p->world, &hash);
}

static breve_status do_library_program(place* p) {
  breve_program* made = NULL;
  const breve_status status = breve_program_create_library(p->runtime, NULL, &made);
  breve_program_destroy(made);
  return status;
}
/* The first that does not work, or BREVE_OK. */
static breve_status do_bodies(place* p) {
  breve_world* w = p->world;
  breve_geometry geometry = breve_geometry_default();
  breve_object body, shape, links[2];
  const breve_material material = {0.5, 0.5, 0.5, 0, 0};
  breve_pose pose;
  double mass;
  bool is;
  size_t count;
  breve_energy energy = breve_energy_default();
  TRY(breve_object_create(w, "Mobile", &body));
  TRY(breve_shape_create(w, &geometry, &shape));
  TRY(breve_object_set_shape(w, body, shape));
  TRY(breve_object_set_physics(w, body, true));
  TRY(breve_object_physics(w, body, &is));
  TRY(breve_object_mass(w, body, &mass));
  TRY(breve_object_set_force(w, body, NULL, NULL));
  TRY(breve_object_set_material(w, body, &material));
  TRY(breve_object_asleep(w, body, &is));
  TRY(breve_object_links(w, body, links, 2, &count));
  TRY(breve_object_joints(w, body, links, 2, &count));
  TRY(breve_object_pose(w, body, &pose));
  TRY(breve_object_set_assembly_pose(w, body, &pose));
  TRY(breve_object_set_self_collisions(w, body, false));
  TRY(breve_object_energy(w, body, &energy));
  TRY(breve_object_set_accuracy(w, body, NULL));
  return breve_object_free(w, body);
}
static breve_status do_joints(place* p) {
  breve_world* w = p->world;
  breve_joint_description description = breve_joint_description_default(BREVE_JOINT_REVOLUTE);
  breve_joint_info info;
  breve_drive drive = breve_drive_default();
  breve_object joint;
  const double still[3] = {0};
  TRY(breve_object_create(w, "Mobile", &description.child));
  TRY(breve_joint_create(w, &description, &joint));
  TRY(breve_joint_state(w, joint, &info));
  TRY(breve_joint_drive(w, joint, &drive));
  TRY(breve_joint_set_drive(w, joint, &drive));
  TRY(breve_joint_set_state(w, joint, still, still));
  TRY(breve_joint_break(w, joint));
  TRY(breve_object_free(w, joint));
  return breve_object_free(w, description.child);
}
static breve_status do_springs(place* p) {
  breve_world* w = p->world;
  breve_spring description = breve_spring_default();
  breve_object spring;
  double length, force;
  TRY(breve_object_create(w, "Mobile", &description.from));
  TRY(breve_object_create(w, "Mobile", &description.to));
  TRY(breve_spring_create(w, &description, &spring));
  TRY(breve_spring_set_description(w, spring, &description));
  TRY(breve_spring_state(w, spring, &length, &force));
  TRY(breve_object_free(w, spring));
  TRY(breve_object_free(w, description.from));
  return breve_object_free(w, description.to);
}
static breve_status do_many(place* p) {
  double place[3], count;
  const breve_array places = {place, 0, BREVE_NUMBER_DOUBLE, 3}, counts = {&count, 0, BREVE_NUMBER_DOUBLE, 1};
  TRY(breve_objects_property(p->world, &p->ball, 1, BREVE_PROPERTY_LOCATION, &places));
  TRY(breve_objects_set_property(p->world, &p->ball, 1, BREVE_PROPERTY_LOCATION, &places));
  TRY(breve_objects_get(p->world, &p->controller, 1, "count", &counts));
  TRY(breve_objects_set(p->world, &p->controller, 1, "count", &counts));
  return breve_objects_call_prepared(p->world, &p->controller, 1, p->touch, NULL, 0, NULL);
}
static breve_status do_grids(place* p) { /* the controller is not a grid */
  uint32_t counts[3];
  double value = 0;
  size_t count;
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_grid_size(p->world, p->controller, counts));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_grid_concentrations(p->world, p->controller, p->ball, &value, 1, &count));
  return breve_grid_set_concentrations(p->world, p->controller, p->ball, &value, 1);
}
static breve_status do_accuracy(place* p) {
  breve_world* w = p->world;
  breve_accuracy accuracy = breve_accuracy_default();
  breve_rung rung;
  breve_energy energy = breve_energy_default();
  breve_physics_counters counters = breve_physics_counters_default();
  const char* text;
  size_t count;
  double gravity[3];
  TRY(breve_rung_find("balanced", &rung));
  TRY(breve_rung_accuracy(rung, &accuracy));
  TRY(breve_world_accuracy(w, &accuracy));
  TRY(breve_world_set_accuracy(w, &accuracy));
  TRY(breve_world_accuracy_text(w, &text));
  TRY(breve_world_gravity(w, gravity));
  TRY(breve_world_set_gravity(w, gravity));
  TRY(breve_world_space(w, 0, NULL, NULL, NULL));
  TRY(breve_world_set_space(w, 0, BREVE_EDGE_OPEN, 0, 0));
  TRY(breve_world_set_sleeping(w, false));
  TRY(breve_world_set_workers(w, 1));
  TRY(breve_world_set_guard(w, breve_world_guard(w)));
  TRY(breve_world_interventions(w, NULL, 0, &count));
  TRY(breve_world_impacts(w, NULL, 0, &count));
  TRY(breve_world_energy(w, &energy));
  return breve_world_physics_counters(w, &counters);
}

static breve_status do_queries(place* p) {
  const breve_world* w = p->world;
  const double start[3] = {-50, 0, 0}, way[3] = {100, 0, 0};
  const breve_geometry ball = breve_geometry_default();
  const breve_pose pose = {{0, 0, 0}, {1, 0, 0, 0}};
  breve_hit hit;
  size_t count;
  bool found;
  TRY(breve_world_ray_first(w, start, way, NULL, &found, &hit));
  TRY(breve_world_ray_all(w, start, way, NULL, &hit, 1, &count));
  TRY(breve_world_overlap(w, &ball, &pose, NULL, &hit, 1, &count));
  TRY(breve_world_cast(w, &ball, &pose, way, NULL, &found, &hit));
  TRY(breve_world_closest(w, start, 1000, NULL, &found, &hit));
  return breve_world_near(w, start, 1000, NULL, &hit, 1, &count);
}
static breve_status do_filters(place* p) {
  breve_collision_filter filter = breve_collision_filter_default();
  bool collides;
  TRY(breve_object_collision_filter(p->world, p->ball, &filter));
  TRY(breve_object_set_collision_filter(p->world, p->ball, &filter));
  TRY(breve_object_collides(p->world, p->ball, p->controller, &collides));
  return breve_object_set_collides(p->world, p->ball, p->controller, true);
}
static breve_status do_may_collide(place* p) { return breve_world_set_may_collide(p->world, NULL, NULL); }
static breve_status do_forces(place* p) {
  const double push[3] = {0, 0, 0};
  TRY(breve_object_set_physics(p->world, p->ball, true));
  TRY(breve_object_add_force(p->world, p->ball, push, NULL, NULL));
  TRY(breve_object_add_impulse(p->world, p->ball, push, NULL));
  TRY(breve_object_wake(p->world, p->ball));
  return breve_object_set_physics(p->world, p->ball, false);
}
static breve_status do_click_ray(place* p) {
  const double start[3] = {0, 0, 50}, way[3] = {0, 0, -100};
  return breve_world_queue_click_ray(p->world, start, way);
}
static breve_status do_getters(place* p) {
  const breve_world* w = p->world;
  breve_material material;
  breve_accuracy accuracy = breve_accuracy_default();
  breve_spring spring = breve_spring_default();
  double force[3];
  bool on;
  CHECK(!breve_world_sleeping(w) && breve_world_workers(w) == 1);
  TRY(breve_object_material(w, p->ball, &material));
  TRY(breve_object_force(w, p->ball, force, NULL));
  TRY(breve_object_accuracy(w, p->ball, &accuracy));
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_spring_description(w, p->ball, &spring));
  return breve_object_self_collisions(w, p->ball, &on);
}
static breve_status do_batch(place* p) {
  breve_batch batch = breve_batch_default();
  batch.count = 2;
  batch.iterations = 1;
  batch.workers = 1;
  return breve_batch_run(p->runtime, p->program, &batch, NULL);
}
static breve_status do_stepping(place* p) {
  double numbers[3];
  const breve_array places = {numbers, 0, BREVE_NUMBER_DOUBLE, 3};
  TRY(breve_world_set_iteration_step(p->world, breve_world_iteration_step(p->world)));
  TRY(breve_world_set_integration_step(p->world, breve_world_integration_step(p->world)));
  TRY(breve_world_set_time_scale(p->world, breve_world_time_scale(p->world)));
  TRY(breve_world_set_interpolated(p->world, true));
  CHECK(breve_world_interpolated(p->world));
  TRY(breve_objects_interpolated(p->world, &p->ball, 1, 0.5, BREVE_PROPERTY_LOCATION, &places));
  return breve_world_set_interpolated(p->world, false);
}
static breve_status do_events(place* p) {
  size_t count;
  TRY(breve_world_set_events(p->world, breve_world_events(p->world) | BREVE_EVENT_CONTACT));
  TRY(breve_world_watch_contacts(p->world, "Ball", true));
  TRY(breve_object_watch_contacts(p->world, p->ball, false));
  bool watched;
  TRY(breve_object_contacts_watched(p->world, p->ball, &watched));
  TRY(breve_world_contacts(p->world, NULL, 0, &count));
  TRY(breve_world_lives(p->world, NULL, 0, &count));
  TRY(breve_world_announcements(p->world, NULL, 0, &count));
  return breve_world_naps(p->world, NULL, 0, &count);
}
static void discard(void* sink, const char* bytes, size_t size) { (void)sink, (void)bytes, (void)size; }
static breve_status do_record(place* p) {
  TRY(breve_world_record_start(p->world, discard, NULL));
  CHECK(breve_world_recording(p->world));
  return breve_world_record_stop(p->world);
}
static breve_status do_record_stop(place* p) { return breve_world_record_stop(p->world); }
static breve_status do_record_input(place* p) {
  char byte = 1;
  return breve_world_record_input(p->world, &byte, 1);
}
static breve_status do_replay(place* p) {
  breve_replay replay;
  const breve_status status = breve_world_replay(p->world, "", 0, NULL, NULL, &replay);
  return status == BREVE_ERROR_IMAGE ? BREVE_OK : status;
}
static breve_status do_debug_draw(place* p) {
  const breve_debug_draw draw = breve_debug_draw_default();
  return breve_world_debug_draw(p->world, &draw);
}
static breve_status do_sound(place* p) {
  float samples[2];
  return breve_world_sound(p->world, 0, 44100, samples, 1);
}
static breve_status do_plugin_open(place* p) {
  breve_plugin plugin;
  (void)p;
  return breve_plugin_open("/nowhere/plugin.so", "start", &plugin, NULL, NULL);
}

/* Works, is busy, or finds nothing: what each function may do in each kind of callback. */
enum { WORKS = 1, BUSY = 2, NOTHING = 4 };
static const struct {
  const char* name;
  breve_status (*call)(place* p);
  int in_script, in_compilation; /* callbacks of a world that runs; callbacks of a compilation, its worlds being idle */
} functions[] = {
    {"breve_runtime_allow_lint", do_runtime_allow, WORKS, WORKS | BUSY},
    {"breve_runtime_add_function", do_add_function, WORKS, BUSY},
    {"breve_program_load", do_load, NOTHING, BUSY},
    {"breve_program_compile", do_compile, WORKS, BUSY},
    {"breve_analysis_create", do_analyse, WORKS, BUSY},
    {"breve_world_create", do_world_create, WORKS, WORKS | BUSY},
    {"breve_world_step", do_step, BUSY, WORKS},
    {"breve_world_advance", do_advance, BUSY, WORKS},
    {"breve_world_set_paused", do_set_paused, WORKS, WORKS},
    {"breve_world_draw_random", do_random, WORKS, WORKS},
    {"breve_world_charge", do_charge, WORKS, WORKS},
    {"breve_world_record_start and _recording", do_record, BUSY, WORKS},
    {"breve_world_record_stop", do_record_stop, BUSY, WORKS},
    {"breve_world_record_input", do_record_input, WORKS, WORKS},
    {"breve_world_replay", do_replay, BUSY, WORKS},
    {"breve_world_debug_draw", do_debug_draw, WORKS, WORKS},
    {"breve_world_sound", do_sound, WORKS, WORKS},
    {"breve_plugin_open", do_plugin_open, NOTHING, NOTHING},
    {"breve_runtime_add_class", do_add_class, WORKS, BUSY},
    {"breve_world_prepare_super", do_prepare_super, WORKS, WORKS},
    {"breve_world_methods", do_methods, WORKS, WORKS},
    {"breve_world_random", do_draw, WORKS, WORKS},
    {"breve_world_print", do_print, WORKS, WORKS},
    {"breve_world_set_user and those of objects", do_user, WORKS, WORKS},
    {"breve_world_set_state", do_state, WORKS, WORKS},
    {"breve_world_allocate and _release", do_allocate, WORKS, WORKS},
    {"breve_list_read", do_list_read, WORKS, WORKS},
    {"breve_world_objects", do_objects, WORKS, WORKS},
    {"breve_object_is_a", do_is_a, WORKS, WORKS},
    {"breve_object_create and _free", do_create_and_free, WORKS, WORKS},
    {"breve_object_pose", do_pose, WORKS, WORKS},
    {"breve_object_set_target", do_target, WORKS, WORKS},
    {"breve_object_velocity", do_velocity, WORKS, WORKS},
    {"breve_object_contact_force", do_contact_force, WORKS, WORKS},
    {"breve_world_set_listener", do_listener, BUSY, WORKS},
    {"breve_object_rotational_velocity", do_rotation, WORKS, WORKS},
    {"breve_object_color", do_color, WORKS, WORKS},
    {"breve_object_shape", do_shape, WORKS, WORKS},
    {"breve_program_create_library", do_library_program, WORKS, BUSY},
    {"breve_object_set_physics and so on", do_bodies, WORKS, WORKS},
    {"breve_joint_create and so on", do_joints, WORKS, WORKS},
    {"breve_spring_create and so on", do_springs, WORKS, WORKS},
    {"breve_grid_size and so on", do_grids, NOTHING, NOTHING},
    {"breve_world_accuracy and so on", do_accuracy, WORKS, WORKS},
    {"breve_world_ray_first and so on", do_queries, WORKS, WORKS},
    {"breve_object_collision_filter and so on", do_filters, WORKS, WORKS},
    {"breve_world_set_may_collide", do_may_collide, BUSY, WORKS},
    {"breve_object_add_force and so on", do_forces, WORKS, WORKS},
    {"breve_world_events and so on", do_events, WORKS, WORKS},
    {"breve_world_queue_click_ray", do_click_ray, WORKS, WORKS},
    {"breve_object_material and so on", do_getters, WORKS, WORKS},
    {"breve_batch_run", do_batch, WORKS, WORKS},
    {"breve_world_set_iteration_step and so on", do_stepping, WORKS, WORKS},
    {"breve_value_text", do_text, WORKS, WORKS},
    {"breve_list_create and so on", do_list, WORKS, WORKS},
    {"breve_hash_create and so on", do_hash_value, WORKS, WORKS},
    {"breve_object_get and _set", do_get_and_set, WORKS, WORKS},
    {"breve_object_call", do_call, WORKS, WORKS},
    {"breve_world_prepare", do_prepare, WORKS, WORKS},
    {"breve_object_call_prepared", do_call_prepared, WORKS, WORKS},
    {"breve_objects_property and so on", do_many, WORKS, WORKS},
    {"breve_world_queue_key", do_key, WORKS, WORKS},
    {"breve_world_queue_click", do_click, WORKS, WORKS},
    {"breve_world_menu_items and _choose", do_menu, WORKS, WORKS},
    {"breve_world_hash", do_hash, BUSY, WORKS},
    {"breve_world_snapshot", do_snapshot, BUSY, WORKS},
    {"breve_world_restore", do_restore, BUSY, WORKS},
    {"breve_world_effects", do_effects, WORKS, WORKS},
    {"breve_world_stats", do_stats, WORKS, WORKS},
    {"breve_world_profile_start", do_profile_start, BUSY, WORKS},
    {"breve_world_profile_node_count", do_profile_count, WORKS | BUSY | NOTHING, WORKS | NOTHING},
    {"breve_world_profile_node", do_profile_node, WORKS | BUSY | NOTHING, WORKS | NOTHING},
    {"breve_world_profile_cost", do_profile_cost, WORKS | BUSY | NOTHING, WORKS | NOTHING},
    {"breve_world_profile_stop", do_profile_stop, WORKS | BUSY | NOTHING, WORKS | NOTHING},
    {"breve_world_profile_enter, _leave and _line, breve_world_is_profiled", do_profile_enter, WORKS, WORKS},
    {"breve_world_reload", do_reload, BUSY, WORKS},
    {"breve_world_evaluate", do_evaluate, WORKS, WORKS},
    {"breve_world_session", do_session, WORKS, WORKS},
    {"breve_world_destroy", do_destroy, BUSY, BUSY /* not called there: it would work */},
    {"breve_files_add_directory", do_files_within, WORKS, WORKS},
    {"breve_files_release", do_files_release, WORKS, WORKS},
    {"breve_runtime_destroy", do_runtime_destroy, BUSY /* only while the runtime itself works */, BUSY},
};

/* Those that cannot fail, and those that know no world: they only have to return. */
static void look_around(place* p) {
  breve_runtime_config runtime_config = breve_runtime_config_default();
  breve_world_config config = breve_world_config_default();
  breve_diagnostic diagnostic;
  breve_class_info info;
  breve_source module;
  breve_lint_info lint;
  breve_runtime* other = NULL;
  const double rows[9] = {0};
  CHECK(breve_version() != NULL && breve_abi() == BREVE_ABI && breve_status_name(BREVE_OK) != NULL);
  CHECK(config.struct_size != 0);
  CHECK_STATUS(BREVE_ERROR_UNSUPPORTED, breve_runtime_create_for(BREVE_ABI + 1, &runtime_config, &other));
  CHECK_STATUS(BREVE_OK, breve_runtime_create(&runtime_config, &other));
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(other));
  breve_runtime_last_error(p->runtime);
  breve_world_last_error(p->world);
  if (breve_runtime_diagnostic_count(p->runtime) != 0)
    CHECK_STATUS(BREVE_OK, breve_runtime_diagnostic(p->runtime, 0, &diagnostic));
  CHECK(breve_lint_count() != 0);
  CHECK_STATUS(BREVE_OK, breve_lint(0, &lint));
  CHECK(breve_library_module_count() != 0);
  CHECK_STATUS(BREVE_OK, breve_library_module(0, &module));
  CHECK(breve_program_class_count(p->program) != 0);
  CHECK_STATUS(BREVE_OK, breve_program_class(p->program, 0, &info));
  CHECK(breve_statements_complete("a = 1.", 6));
  CHECK(breve_world_user(p->world) == NULL);
  CHECK(breve_world_time(p->world) >= 0 && breve_world_iteration_step(p->world) > 0);
  (void)breve_world_iteration(p->world);
  (void)breve_world_seed(p->world);
  CHECK(!breve_world_ended(p->world) && !breve_world_paused(p->world));
  CHECK(breve_world_controller(p->world).generation == p->controller.generation);
  CHECK(breve_object_alive(p->world, p->ball));
  CHECK_TEXT("Ball", breve_object_class(p->world, p->ball));
  CHECK(breve_value_null().type == BREVE_TYPE_NULL && breve_value_vector(1, 2, 3).type == BREVE_TYPE_VECTOR);
  CHECK(breve_value_matrix(rows).type == BREVE_TYPE_MATRIX);
}

static void call_one(place* p, size_t number, int allowed) {
  const breve_status status = functions[number].call(p);
  const bool fits = (status == BREVE_OK && (allowed & WORKS)) || (status == BREVE_ERROR_BUSY && (allowed & BUSY)) ||
                    ((status == BREVE_ERROR_NOT_FOUND || status == BREVE_ERROR_FILE) && (allowed & NOTHING));
  if (!CHECK(fits)) printf("  %s: %s\n", functions[number].name, breve_status_name(status));
}

/* --- the callbacks -------------------------------------------------------------------------------------------------
 */

typedef struct visitor {
  place at;
  bool active; /* only one level: what the calls here print is not visited */
  int in_channel[3], files, commands, modules, releases, paths;
} visitor;

static void visit_script(visitor* v) {
  if (v->active) return;
  v->active = true;
  look_around(&v->at);
  for (size_t i = 0; i < sizeof functions / sizeof *functions; ++i)
    if (functions[i].call != do_runtime_destroy) call_one(&v->at, i, functions[i].in_script);
  v->active = false;
}

static void visit_compilation(visitor* v) {
  if (v->active || !v->at.world) return;
  v->active = true;
  look_around(&v->at);
  for (size_t i = 0; i < sizeof functions / sizeof *functions; ++i)
    if (functions[i].call != do_destroy) call_one(&v->at, i, functions[i].in_compilation);
  v->active = false;
}

static void on_print(void* user, breve_world* world, breve_channel channel, const char* text, size_t size) {
  visitor* v = user;
  (void)text;
  (void)size;
  if (world != v->at.world) return;
  ++v->in_channel[channel];
  visit_script(v);
}

static bool on_open(void* user, breve_world* world, const char* name, breve_file* file, breve_write_fn reason,
                    void* sink) {
  visitor* v = user;
  (void)world;
  (void)name;
  (void)file;
  ++v->files;
  reason(sink, "not today", 9);
  visit_script(v);
  return false;
}

static bool on_open_for_writing(void* user, breve_world* world, const char* name, bool append, breve_file* file,
                                breve_write_fn reason, void* sink) {
  (void)append;
  return on_open(user, world, name, file, reason, sink);
}

static bool on_system(void* user, breve_world* world, const char* command, breve_write_fn write, void* sink) {
  visitor* v = user;
  (void)world;
  (void)command;
  ++v->commands;
  visit_script(v);
  write(sink, "done", 4);
  return true;
}

static bool on_resolve(void* user, const char* name, const char* from, breve_module* module) {
  visitor* v = user;
  (void)from;
  if (strcmp(name, "Extra.tz") != 0) return false;
  ++v->modules;
  visit_compilation(v);
  module->text = "@path \"somewhere\".\nNULL : Extra { }\n";
  module->size = strlen(module->text);
  return true;
}

static void on_release(void* user, const breve_module* module) {
  visitor* v = user;
  (void)module;
  ++v->releases;
  visit_compilation(v);
}

static void on_path(void* user, const char* directory) {
  visitor* v = user;
  (void)directory;
  ++v->paths;
  visit_compilation(v);
}

/* A world of `extended_text`, with every callback set. */
static bool open_visited(visitor* v) {
  static char text[16384];
  memset(v, 0, sizeof *v);
  v->active = true;
  const char* methods =
      "  + to be-loud:\n    print \"loud\".\n    free blank.\n    sqrt(-1.0).\n"
      "    print findFile(\"a\"), system(\"b\"), !openFileForWriting(\"c\").\n";
  const char* at = strstr(scene_text, "  + to touch:");
  snprintf(text, sizeof text, "%.*s%s%s", (int)(at - scene_text), scene_text, methods, at);
  breve_runtime_config config = breve_runtime_config_default();
  config.user = v;
  config.print = on_print;
  config.files.user = v;
  config.files.open_for_reading = on_open;
  config.files.open_for_writing = on_open_for_writing;
  config.system = on_system;
  config.resolve_module = on_resolve;
  config.release_module = on_release;
  config.add_path = on_path;
  place* p = &v->at;
  breve_value ball;
  if (!CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &p->runtime)) ||
      !CHECK_STATUS(BREVE_OK, breve_program_compile(p->runtime, "visited.tz", text, strlen(text), &p->program)) ||
      !CHECK_STATUS(BREVE_OK, breve_world_create(p->runtime, p->program, NULL, &p->world)))
    return false;
  p->controller = breve_world_controller(p->world);
  CHECK_STATUS(BREVE_OK, breve_object_get(p->world, p->controller, "ball", &ball));
  p->ball = ball.as.object;
  CHECK_STATUS(BREVE_OK, breve_world_prepare(p->world, "touch", NULL, 0, &p->touch));
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(p->world, NULL, 0, &p->image_size));
  p->image = malloc(p->image_size);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(p->world, p->image, p->image_size, &p->image_size));
  v->active = false;
  return p->image != NULL;
}

static void close_visited(visitor* v) {
  CHECK_STATUS(BREVE_OK, breve_world_step(v->at.world));
  v->active = true;
  free(v->at.image);
  CHECK_STATUS(BREVE_OK, breve_world_destroy(v->at.world));
  breve_program_destroy(v->at.program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(v->at.runtime));
}

static void every_function_works_or_is_busy_inside_callbacks_of_a_script(void) {
  visitor v;
  if (!open_visited(&v)) return;
  place* p = &v.at;
  CHECK_STATUS(BREVE_OK, breve_object_call(p->world, p->controller, "be-loud", NULL, 0, NULL));
  CHECK(v.in_channel[BREVE_CHANNEL_PRINT] > 0 && v.in_channel[BREVE_CHANNEL_WARNING] > 0);
  CHECK(v.files == 2 && v.commands == 1);
  /* A handler that fails: its report is also a callback. */
  const char* fails =
      "self observe instance self for-notification \"x\" with-method \"fail-now\". self announce message \"x\".";
  CHECK_STATUS(BREVE_OK, breve_world_evaluate(p->world, p->controller, fails, strlen(fails), NULL));
  CHECK(v.in_channel[BREVE_CHANNEL_ERROR] > 0);
  close_visited(&v);
}

static void every_function_works_or_is_busy_inside_callbacks_of_a_compilation(void) {
  visitor v;
  if (!open_visited(&v)) return;
  breve_program* other = NULL;
  const char* text = "@use Control.\n@use Extra.\nController Other.\nControl : Other { }\n";
  CHECK_STATUS(BREVE_OK, breve_program_compile(v.at.runtime, "other.tz", text, strlen(text), &other));
  CHECK(v.modules == 1 && v.releases == 1 && v.paths == 1);
  breve_program_destroy(other);
  close_visited(&v);
}

static void set_to_stop(breve_world* world, void* context) {
  (void)context;
  breve_world_interrupt(world);
}

static void a_callback_may_interrupt_its_script(void) {
  scene s;
  if (!scene_open(&s)) return;
  s.said.on_print = set_to_stop;
  CHECK_STATUS(BREVE_ERROR_INTERRUPTED,
               breve_world_evaluate(s.world, nobody, "print 1. while 1: calls += 1.", 29, NULL));
  s.said.on_print = NULL;
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "touch", NULL, 0, NULL));
  scene_close(&s);
}

static breve_status deepest_status;
static int depth_now, depth_most;

static void go_deeper(breve_world* world, void* context) {
  (void)context;
  const breve_keyword text = {"text", breve_value_string("deeper")};
  if (++depth_now > depth_most) depth_most = depth_now;
  const breve_status status = breve_object_call(world, breve_world_controller(world), "say", &text, 1, NULL);
  if (status != BREVE_OK) deepest_status = status;
  --depth_now;
}

static void calls_nest_to_the_depth_that_is_set(void) {
  static const uint32_t limits[] = {1, 2, 7, 64, 200};
  for (size_t i = 0; i < sizeof limits / sizeof *limits; ++i) {
    scene s;
    breve_world_config config = breve_world_config_default();
    config.nesting_limit = limits[i];
    if (!scene_open_text(&s, scene_text, &config)) return;
    s.said.on_print = go_deeper;
    deepest_status = BREVE_OK;
    depth_now = depth_most = 0;
    const breve_keyword text = {"text", breve_value_string("down")};
    CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "say", &text, 1, NULL));
    CHECK_STATUS(BREVE_ERROR_DEPTH, deepest_status);
    CHECK(depth_most == (int)limits[i]);
    s.said.on_print = NULL;
    scene_close(&s);
  }
  breve_runtime* runtime;
  breve_program* program;
  breve_world* world = NULL;
  breve_world_config config = breve_world_config_default();
  config.nesting_limit = 201;
  CHECK_STATUS(BREVE_OK, breve_runtime_create(NULL, &runtime));
  CHECK_STATUS(BREVE_OK, breve_program_compile(runtime, "small.tz", small_text, strlen(small_text), &program));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_create(runtime, program, &config, &world));
  breve_program_destroy(program);
  CHECK_STATUS(BREVE_OK, breve_runtime_destroy(runtime));
}

void reentry_all_suite(void) {
  RUN(every_function_works_or_is_busy_inside_callbacks_of_a_script);
  RUN(every_function_works_or_is_busy_inside_callbacks_of_a_compilation);
  RUN(a_callback_may_interrupt_its_script);
  RUN(calls_nest_to_the_depth_that_is_set);
}
