// Calls of shapes, bodies with physics, the settings of physics, and grids.
#include <cmath>

#include "call_functions.hpp"
#include "drawn_geometry.hpp"

namespace breve::fuzz {

namespace call_bodies {

// --- shapes ----------------------------------------------------------------------------------------------------------

breve_status shape_create(Caller& c) {
  breve_world* world = c.world();
  DrawnGeometry drawn(c);
  drawn.geometry.struct_size = c.struct_size(sizeof drawn.geometry);
  const bool null = c.chance(3);
  if (null) c.expect_refusal();
  Out<breve_object> made(c);
  const breve_status status = made.after(breve_shape_create(world, null ? nullptr : &drawn.geometry, made.to()));
  if (made) c.keep(*made);
  return status;
}
breve_status object_set_shape(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  return breve_object_set_shape(world, object, c.object(world, "Shape"));
}

// --- bodies ----------------------------------------------------------------------------------------------------------

/// A function that gives one thing of a body.
template <class T, auto kGet>
breve_status get(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Out<T> result(c);
  return result.after(kGet(world, object, result.to()));
}
template <auto kSet>
breve_status switch_on_or_off(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  return kSet(world, object, c.chance(75));
}
breve_status object_set_force(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  double force[3], torque[3];
  const double* first = c.numbers(force, true);
  return breve_object_set_force(world, object, first, c.numbers(torque, true));
}
breve_status object_set_material(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  breve_material material = {0.5, 0.4, 0.3, 0, 0};
  switch (c.choose().below(8)) {
    case 0: material.static_friction = c.number(); break;
    case 1: material.dynamic_friction = c.number(); break;
    case 2: material.restitution = c.number(); break;
    case 3: material.tangential_restitution = c.number(); break;
    case 4: material.threshold = c.number(); break;
    default: break;
  }
  const bool null = c.chance(3);
  if (null) c.expect_refusal();
  return breve_object_set_material(world, object, null ? nullptr : &material);
}

// --- accuracy --------------------------------------------------------------------------------------------------------

breve_status accuracy_of_rung(Caller& c) {
  const std::size_t rung = c.choose().below(7);
  if (rung > BREVE_RUNG_CONSERVING) c.expect_refusal();
  Out<breve_accuracy> accuracy(c);
  accuracy.set_size(c.struct_size(sizeof(breve_accuracy)));
  return accuracy.after(breve_rung_accuracy(static_cast<breve_rung>(rung), accuracy.to()));
}
breve_status rung_named(Caller& c) {
  static constexpr const char* kNames[] = {"fast", "balanced", "precise", "reference", "conserving", "slow", ""};
  const char* name = c.text_or_null(c.choose().one_of(kNames));
  Out<breve_rung> rung(c);
  return rung.after(breve_rung_find(name, rung.to()));
}
breve_status world_accuracy(Caller& c) {
  const breve_world* world = c.world();
  Out<breve_accuracy> accuracy(c);
  accuracy.set_size(c.struct_size(sizeof(breve_accuracy)));
  return accuracy.after(breve_world_accuracy(world, accuracy.to()));
}

/// Settings that do not take long, and one that may be wrong.
breve_accuracy draw_accuracy(Caller& c) {
  constexpr double kSteps[] = {0, 0.01, -1, NAN, 1e300}, kTolerances[] = {1e-3, 0, -1, NAN};
  breve_accuracy accuracy = breve_accuracy_default();
  const breve_rung rung = c.chance(80) ? BREVE_RUNG_FAST : static_cast<breve_rung>(c.choose().below(5));
  require(breve_rung_accuracy(rung, &accuracy) == BREVE_OK, "a rung has no settings");
  switch (c.choose().below(14)) {
    case 0: accuracy.integrator = static_cast<breve_integrator>(c.choose().below(12)); break;
    case 1: accuracy.iterations = static_cast<std::int32_t>(c.choose().below(30)) - 2; break;
    case 2: accuracy.step = c.choose().one_of(kSteps); break;
    case 3: accuracy.contact_step = c.choose().one_of(kSteps); break;
    case 4: accuracy.tolerance = c.choose().one_of(kTolerances); break;
    case 5: accuracy.contact_stiffness = c.number(); break;
    case 6: accuracy.contact_damping = c.number(); break;
    case 7: accuracy.direct = !accuracy.direct; break;
    case 8: accuracy.implicit_joints = !accuracy.implicit_joints; break;
    case 9: accuracy.locate_impacts = !accuracy.locate_impacts; break;
    case 10: accuracy.impacts = static_cast<std::int32_t>(c.choose().below(30)) - 2; break;
    case 11: accuracy.reserved[1] = true, c.expect_refusal(); break;
    case 12: accuracy.rung = static_cast<breve_rung>(c.choose().below(7)); break;
    default: accuracy.struct_size = c.struct_size(sizeof accuracy); break;
  }
  return accuracy;
}
breve_status world_set_accuracy(Caller& c) {
  breve_world* world = c.world();
  const breve_accuracy accuracy = draw_accuracy(c);
  const bool null = c.chance(3);
  if (null) c.expect_refusal();
  return breve_world_set_accuracy(world, null ? nullptr : &accuracy);
}
breve_status object_set_accuracy(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  if (c.chance(20)) return breve_object_set_accuracy(world, object, nullptr);
  const breve_accuracy accuracy = draw_accuracy(c);
  return breve_object_set_accuracy(world, object, &accuracy);
}
breve_status world_describe_accuracy(Caller& c) {
  breve_world* world = c.world();
  Out<const char*> text(c);
  const breve_status status = text.after(breve_world_accuracy_text(world, text.to()));
  if (text) read_text(*text);
  return status;
}

// --- all bodies ------------------------------------------------------------------------------------------------------

breve_status world_gravity(Caller& c) {
  const breve_world* world = c.world();
  Room<double> gravity(c, 3);
  return gravity.after(breve_world_gravity(world, gravity.to()), 3);
}
breve_status world_set_gravity(Caller& c) {
  breve_world* world = c.world();
  double gravity[3];
  const double* given = c.numbers(gravity);
  for (const double x : gravity)
    if (!std::isfinite(x)) c.expect_refusal();
  return breve_world_set_gravity(world, given);
}
breve_status world_set_space(Caller& c) {
  breve_world* world = c.world();
  const int axis = static_cast<int>(c.choose().below(5)) - 1;
  const auto edge = static_cast<breve_edge>(c.choose().below(4));
  const double low = c.chance(70) ? -5 : c.number(), high = c.chance(70) ? 5 : c.number();
  const bool wrong = edge != BREVE_EDGE_OPEN && !(low < high && std::isfinite(low) && std::isfinite(high));
  if (axis < 0 || axis > 2 || edge > BREVE_EDGE_WALL || wrong) c.expect_refusal();
  return breve_world_set_space(world, axis, edge, low, high);
}
breve_status world_space(Caller& c) {
  const breve_world* world = c.world();
  const int axis = static_cast<int>(c.choose().below(5)) - 1;
  if (axis < 0 || axis > 2) c.expect_refusal();
  Out<breve_edge> edge(c, true);
  Out<double> low(c, true);
  Out<double> high(c, true);
  const breve_status status = edge.after(breve_world_space(world, axis, edge.to(), low.to(), high.to()));
  return low.after(status), high.after(status);
}
breve_status world_set_sleeping(Caller& c) {
  breve_world* world = c.world();
  return breve_world_set_sleeping(world, c.chance(50));
}
breve_status world_set_workers(Caller& c) {
  breve_world* world = c.world();
  const std::uint32_t workers = c.chance(80) ? static_cast<std::uint32_t>(1 + c.choose().below(3)) : c.word();
  if (workers == 0 || workers > 256) c.expect_refusal();
  return breve_world_set_workers(world, workers);
}
breve_status world_set_guard(Caller& c) {
  breve_world* world = c.world();
  const std::size_t mode = c.choose().below(6);
  if (mode > BREVE_GUARD_REST) c.expect_refusal();
  return breve_world_set_guard(world, static_cast<breve_guard>(mode));
}
breve_status world_guard(Caller& c) {
  const breve_world* world = c.world();
  const breve_guard mode = breve_world_guard(world);
  require(world ? mode <= BREVE_GUARD_REST : mode == BREVE_GUARD_OFF, "a guard is wrong");
  return BREVE_OK;
}
breve_status world_interventions(Caller& c) {
  const breve_world* world = c.world();
  Room<breve_intervention> room(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status = count.after(breve_world_interventions(world, room.to(), room.capacity(), count.to()));
  room.after(status, count ? *count : 0);
  for (const breve_intervention& one : room.written()) read_text(one.reason), read_text(one.action);
  return status;
}
breve_status world_impacts(Caller& c) {
  const breve_world* world = c.world();
  Room<breve_impact> room(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status = count.after(breve_world_impacts(world, room.to(), room.capacity(), count.to()));
  return room.after(status, count ? *count : 0);
}
breve_status world_energy(Caller& c) {
  const breve_world* world = c.world();
  Out<breve_energy> energy(c);
  energy.set_size(c.struct_size(sizeof(breve_energy)));
  return energy.after(breve_world_energy(world, energy.to()));
}
breve_status object_energy(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Out<breve_energy> energy(c);
  energy.set_size(c.struct_size(sizeof(breve_energy)));
  return energy.after(breve_object_energy(world, object, energy.to()));
}
breve_status world_physics_counters(Caller& c) {
  const breve_world* world = c.world();
  Out<breve_physics_counters> counters(c);
  counters.set_size(c.struct_size(sizeof(breve_physics_counters)));
  return counters.after(breve_world_physics_counters(world, counters.to()));
}

// --- grids -----------------------------------------------------------------------------------------------------------

breve_status grid_size(Caller& c) {
  const breve_world* world = c.world();
  const breve_object grid = c.object(world, "PatchGrid");
  Room<std::uint32_t> counts(c, 3);
  return counts.after(breve_grid_size(world, grid, counts.to()), 3);
}
breve_status grid_read(Caller& c) {
  const breve_world* world = c.world();
  const breve_object grid = c.object(world, "PatchGrid");
  const breve_object chemical = c.object(world, "PatchChemical");
  Room<double> values(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status =
      count.after(breve_grid_concentrations(world, grid, chemical, values.to(), values.capacity(), count.to()));
  return values.after(status, count ? *count : 0);
}
breve_status grid_write(Caller& c) {
  breve_world* world = c.world();
  const breve_object grid = c.object(world, "PatchGrid");
  const breve_object chemical = c.object(world, "PatchChemical");
  std::size_t count = c.choose().below(40);
  if (c.chance(70)) breve_grid_concentrations(world, grid, chemical, nullptr, 0, &count);
  std::vector<double> values(std::min<std::size_t>(count, 4096));
  for (double& x : values) x = 0.5;
  if (c.chance(30) && !values.empty()) c.choose().one_of(values) = c.number();
  for (const double x : values)
    if (!std::isfinite(x)) c.expect_refusal();
  return breve_grid_set_concentrations(world, grid, chemical, values.data(), values.size());
}

constexpr Statuses kGrid = kStale | kNotFound;

constexpr Function kFunctions[] = {
    {"breve_shape_create", shape_create, kScript | kNotFound, 3},
    {"breve_object_set_shape", object_set_shape, kScript | kBody, 2},
    {"breve_object_physics", get<bool, breve_object_physics>, kBody},
    {"breve_object_set_physics", switch_on_or_off<breve_object_set_physics>, kBody | kScriptError, 2},
    {"breve_object_mass", get<double, breve_object_mass>, kBody},
    {"breve_object_set_force", object_set_force, kBody},
    {"breve_object_set_material", object_set_material, kBody},
    {"breve_object_asleep", get<bool, breve_object_asleep>, kBody},
    {"breve_rung_accuracy", accuracy_of_rung},
    {"breve_rung_find", rung_named, kNotFound},
    {"breve_world_accuracy", world_accuracy},
    {"breve_world_set_accuracy", world_set_accuracy},
    {"breve_object_set_accuracy", object_set_accuracy, kBody | kScriptError},
    {"breve_world_accuracy_text", world_describe_accuracy},
    {"breve_world_gravity", world_gravity},
    {"breve_world_set_gravity", world_set_gravity},
    {"breve_world_set_space", world_set_space},
    {"breve_world_space", world_space},
    {"breve_world_set_sleeping", world_set_sleeping},
    {"breve_world_set_workers", world_set_workers},
    {"breve_world_set_guard", world_set_guard},
    {"breve_world_guard", world_guard, kPlain},
    {"breve_world_interventions", world_interventions},
    {"breve_world_impacts", world_impacts},
    {"breve_world_energy", world_energy, kScriptError},
    {"breve_object_energy", object_energy, kBody | kScriptError},
    {"breve_world_physics_counters", world_physics_counters},
    {"breve_grid_size", grid_size, kGrid},
    {"breve_grid_concentrations", grid_read, kGrid},
    {"breve_grid_set_concentrations", grid_write, kGrid},
};

}  // namespace call_bodies

std::span<const Function> body_functions() { return call_bodies::kFunctions; }

}  // namespace breve::fuzz
