/* A host that is compiled with an older or a later header than the library's. Each struct stands in a block of memory
   of just its size, so that a sanitizer sees a byte that is written behind it. */
#include <breve/breve.h>
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
  if (whole.known.damping != 3 || whole.limit_restitution != 0.25) {
    ++failures;
    fprintf(stderr, "a setter changed a field that the host does not have: %g\n", whole.limit_restitution);
  }
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
  breve_program* program = NULL;
  EXPECT(BREVE_OK, breve_program_compile(runtime, "growth.tz", text, strlen(text), &program));
  MADE(breve_world_config, world_config, breve_world_config_default());
  breve_world* world = NULL;
  EXPECT(EXPECTED, breve_world_create(runtime, program, world_config, &world));
  free(world_config);
  if (world == NULL) EXPECT(BREVE_OK, breve_world_create(runtime, program, NULL, &world));
  bodies(world);
  results(world);
  breve_world_destroy(world);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return failures == 0 ? 0 : 1;
}
