// The calls of a host that builds and steps bodies with physics: the part "physics".
#include <array>
#include <cstdint>

#include "everything.hpp"
#include "try.hpp"

namespace limits {

namespace {

/// What the part has made, for its later calls.
struct Scene {
  breve_object floor, trunk, leg, foot, hip, knee, spring;
};

bool make_shapes(Run& run, Scene& scene) {
  breve_world* world = run.world;
  static const double corners[] = {-1, -0.5, -1, 1, -0.5, -1, 1, -0.5, 1, -1, -0.5, 1, 0, 0.5, 0};
  static const std::uint32_t sizes[] = {4, 3, 3, 3, 3}, indices[] = {0, 1, 2, 3, 0, 4, 1, 1, 4, 2, 2, 4, 3, 3, 4, 0};
  static const double heights[] = {0, 0.1, 0, 0, 0.2, 0, 0, 0, 0};
  breve_object shape;
  for (const breve_shape_kind kind :
       {BREVE_SHAPE_SPHERE, BREVE_SHAPE_CONVEX, BREVE_SHAPE_MESH, BREVE_SHAPE_HEIGHT_FIELD, BREVE_SHAPE_BOX}) {
    breve_geometry geometry = breve_geometry_default();
    geometry.kind = kind;
    geometry.radius = 0.5;
    geometry.vertices = corners, geometry.vertex_count = 5;
    geometry.face_sizes = sizes, geometry.face_count = 5;
    geometry.indices = indices, geometry.index_count = 16;
    geometry.heights = heights, geometry.columns = geometry.rows = 3;
    TRY(breve_shape_create(world, &geometry, &shape));
  }
  TRY(breve_object_create(world, "Stationary", &scene.floor));
  TRY(breve_object_set_shape(world, scene.floor, shape));
  for (breve_object* one : {&scene.trunk, &scene.leg, &scene.foot}) {
    TRY(breve_object_create(world, "Link", one));
    TRY(breve_object_set_shape(world, *one, shape));
  }
  return true;
}

bool make_joints(Run& run, Scene& scene) {
  breve_world* world = run.world;
  const breve_pose above = {{0, 1, 0}, {1, 0, 0, 0}};
  TRY(breve_object_set_pose(world, scene.trunk, &above));
  breve_joint_description hinge = breve_joint_description_default(BREVE_JOINT_REVOLUTE);
  hinge.parent = scene.trunk, hinge.child = scene.leg;
  hinge.parent_point[0] = 0.7, hinge.child_point[0] = -0.7;
  TRY(breve_joint_create(world, &hinge, &scene.hip));
  hinge.kind = BREVE_JOINT_BALL;
  hinge.parent = scene.leg, hinge.child = scene.foot;
  TRY(breve_joint_create(world, &hinge, &scene.knee));
  breve_drive drive = breve_drive_default();
  TRY(breve_joint_drive(world, scene.hip, &drive));
  drive.motor_speed[0] = 1, drive.strength_limit = 5;
  drive.low[0] = -0.5, drive.high[0] = 0.1;
  TRY(breve_joint_set_drive(world, scene.hip, &drive));
  const double place[3] = {0.1, 0, 0};
  TRY(breve_joint_set_state(world, scene.hip, place, place));
  breve_spring spring = breve_spring_default();
  spring.from = scene.trunk, spring.to = scene.foot;
  TRY(breve_spring_create(world, &spring, &scene.spring));
  spring.strength = 50;
  TRY(breve_spring_set_description(world, scene.spring, &spring));
  return true;
}

bool set_what_can_be_set(Run& run, const Scene& scene) {
  breve_world* world = run.world;
  breve_accuracy accuracy = breve_accuracy_default();
  TRY(breve_rung_accuracy(BREVE_RUNG_PRECISE, &accuracy));
  TRY(breve_object_set_accuracy(world, scene.foot, &accuracy));
  const double down[3] = {0, -9, 0}, push[3] = {0, 0, 0.1};
  TRY(breve_world_set_gravity(world, down));
  TRY(breve_world_set_sleeping(world, true));
  TRY(breve_world_set_guard(world, BREVE_GUARD_REST));
  TRY(breve_object_set_force(world, scene.trunk, push, push));
  TRY(breve_object_set_velocity(world, scene.leg, push));
  TRY(breve_object_set_self_collisions(world, scene.leg, true));
  const breve_material material = {0.5, 0.4, 0.5, 0, 10};  // slow enough for contact springs
  for (const breve_object one : {scene.floor, scene.trunk, scene.leg, scene.foot})
    TRY(breve_object_set_material(world, one, &material));
  return true;
}

bool look(Run& run, const Scene& scene) {
  breve_world* world = run.world;
  breve_object found[8];
  std::size_t count = 0;
  const char* text = nullptr;
  TRY(breve_object_links(world, scene.leg, found, 8, &count));
  TRY(breve_object_joints(world, scene.leg, found, 8, &count));
  TRY(breve_world_accuracy_text(world, &text));
  std::array<breve_impact, 64> impacts;
  std::array<breve_intervention, 8> interventions;
  TRY(breve_world_impacts(world, impacts.data(), impacts.size(), &count));
  TRY(breve_world_interventions(world, interventions.data(), interventions.size(), &count));
  breve_joint_info info;
  TRY(breve_joint_state(world, scene.knee, &info));
  double length = 0, force = 0;
  TRY(breve_spring_state(world, scene.spring, &length, &force));
  breve_energy energy = breve_energy_default();
  TRY(breve_world_energy(world, &energy));
  TRY(breve_object_energy(world, scene.foot, &energy));
  breve_physics_counters counters = breve_physics_counters_default();
  TRY(breve_world_physics_counters(world, &counters));
  return true;
}

bool steps(Run& run, int count) {
  for (int i = 0; i < count; ++i) TRY(breve_world_step(run.world));
  return true;
}

/// Saved and restored with contacts under way, taken apart and stepped on.
bool take_apart(Run& run, const Scene& scene) {
  breve_world* world = run.world;
  static std::array<unsigned char, 1 << 20> image;
  std::size_t size = 0;
  TRY(breve_world_snapshot(world, image.data(), image.size(), &size));
  TRY(breve_joint_break(world, scene.knee));
  TRY(breve_world_restore(world, image.data(), size));
  TRY(breve_joint_break(world, scene.knee));
  const breve_pose aside = {{5, 3, 0}, {1, 0, 0, 0}};
  TRY(breve_object_set_assembly_pose(world, scene.trunk, &aside));
  TRY(breve_object_set_physics(world, scene.foot, false));
  TRY(breve_object_free(world, scene.leg));
  return true;
}

}  // namespace

bool load_library(Run& run) {
  TRY(breve_program_create_library(run.runtime, nullptr, &run.loaded));
  run.program = run.loaded;
  return true;
}

bool make_library_world(Run& run) {
  breve_world_config config = breve_world_config_default();
  config.iteration_step = config.integration_step = 0.02;
  TRY(breve_world_create(run.runtime, run.program, &config, &run.world));
  return true;
}

bool use_physics(Run& run) {
  Scene scene{};
  if (!make_shapes(run, scene) || !make_joints(run, scene) || !set_what_can_be_set(run, scene)) return false;
  return steps(run, 5) && look(run, scene) && take_apart(run, scene) && steps(run, 2);
}

}  // namespace limits
