// How bodies with physics are computed, from C: accuracy, guard, workers; and what came of it: energy, events,
// counters.
#include <iterator>

#include "physical.hpp"

namespace breve::host {
namespace {

constexpr unsigned kRungs = 5, kIntegrators = 9, kGuards = 4;

/// The settings that both structs call by the same name.
template <class From, class To>
void copy_settings(const From& from, To& to) {
  to.implicit_joints = from.implicit_joints;
  to.implicit_spin = from.implicit_spin;
  to.direct = from.direct;
  to.locate_impacts = from.locate_impacts;
  to.contact_springs = from.contact_springs;
  to.link_springs = from.link_springs;
  to.step = from.step;
  to.contact_step = from.contact_step;
  to.tolerance = from.tolerance;
  to.iterations = from.iterations;
  to.impacts = from.impacts;
  to.contact_stiffness = from.contact_stiffness;
  to.contact_damping = from.contact_damping;
}

breve_accuracy accuracy_from(const Accuracy& from) {
  breve_accuracy to{};
  to.struct_size = sizeof to;
  to.rung = static_cast<breve_rung>(from.rung);
  to.integrator = static_cast<breve_integrator>(from.scheme);
  copy_settings(from, to);
  return to;
}

Rung rung_of(std::uint32_t rung) {
  if (rung >= kRungs) fail(BREVE_ERROR_ARGUMENT, "there is no rung " + std::to_string(rung));
  return static_cast<Rung>(rung);
}

/// @param now  what is set: it stays in the fields that an older header does not have
Accuracy accuracy_of_struct(const breve_accuracy* given, const Accuracy& now) {
  need(given, "accuracy");
  const breve_accuracy from = read_config(given, accuracy_from(now), "breve_accuracy");
  const Rung rung = rung_of(from.rung);
  if (static_cast<unsigned>(from.integrator) >= kIntegrators)
    fail(BREVE_ERROR_ARGUMENT, "breve_accuracy.integrator is not a breve_integrator");
  for (const bool reserved : from.reserved)
    if (reserved) fail(BREVE_ERROR_ARGUMENT, "a reserved field is not false");
  Accuracy to = accuracy_of(rung);
  to.scheme = static_cast<articulated::Scheme>(from.integrator);
  copy_settings(from, to);
  const breve_accuracy plain = accuracy_from(accuracy_of(rung)), wanted = accuracy_from(to);
  to.custom = std::memcmp(&plain, &wanted, sizeof plain) != 0;
  check(to);
  return to;
}

breve_energy energy_from(const Energy& from) {
  breve_energy to{};
  to.kinetic = from.kinetic;
  to.potential = from.potential;
  to.springs = from.springs;
  to.motor_work = from.motor_work;
  to.script_work = from.script_work;
  to.contact_loss = from.contact_loss;
  to.friction_loss = from.friction_loss;
  to.drag_loss = from.drag_loss;
  to.limit_loss = from.limit_loss;
  to.residual = from.residual;
  return to;
}

const Mechanics& dynamics_of(const breve_world& world) { return std::as_const(*world.world).mechanics(); }

}  // namespace
}  // namespace breve::host

using namespace breve::host;

// --- accuracy -------------------------------------------------------------------------------------------------------

breve_status breve_rung_accuracy(breve_rung rung, breve_accuracy* accuracy) {
  return guard([&] { write_struct(accuracy, accuracy_from(breve::accuracy_of(rung_of(rung))), "breve_accuracy"); });
}

breve_status breve_rung_find(const char* name, breve_rung* rung) {
  return guard([&] {
    need(name, "name");
    need(rung, "rung");
    for (unsigned i = 0; i < kRungs; ++i) {
      if (breve::name_of(static_cast<breve::Rung>(i)) != name) continue;
      *rung = static_cast<breve_rung>(i);
      return;
    }
    fail(BREVE_ERROR_NOT_FOUND, "unknown rung");
  });
}

breve_status breve_world_accuracy(const breve_world* world, breve_accuracy* accuracy) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error,
               [&] { write_struct(accuracy, accuracy_from(dynamics_of(*world).accuracy()), "breve_accuracy"); });
}

breve_status breve_world_set_accuracy(breve_world* world, const breve_accuracy* accuracy) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    world->world->mechanics().set_accuracy(accuracy_of_struct(accuracy, dynamics_of(*world).accuracy()));
  });
}

breve_status breve_world_accuracy_text(const breve_world* world, const char** text) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(text, "text");
    world->accuracy_text = dynamics_of(*world).describe_accuracy();
    *text = world->accuracy_text.c_str();
  });
}

breve_status breve_object_set_accuracy(breve_world* world, breve_object object, const breve_accuracy* accuracy) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const breve::BodyIndex body = live_body(*world, object);
    if (!accuracy) return world->world->mechanics().clear_accuracy(body);
    world->world->mechanics().set_accuracy(body, accuracy_of_struct(accuracy, dynamics_of(*world).accuracy(body)));
  });
}

// --- settings of the world ------------------------------------------------------------------------------------------

breve_status breve_world_gravity(const breve_world* world, double gravity[3]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(gravity, "gravity");
    copy_to(gravity, world->world->gravity());
  });
}

breve_status breve_world_set_gravity(breve_world* world, const double gravity[3]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] { world->world->set_gravity(vector_of(gravity, "gravity")); });
}

breve_status breve_world_set_space(breve_world* world, int axis, breve_edge edge, double low, double high) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (static_cast<unsigned>(edge) > BREVE_EDGE_WALL)
      fail(BREVE_ERROR_ARGUMENT, "there is no edge " + std::to_string(static_cast<unsigned>(edge)));
    world->world->set_space(axis, static_cast<breve::Ending>(edge), low, high);
  });
}

breve_status breve_world_space(const breve_world* world, int axis, breve_edge* edge, double* low, double* high) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (axis < 0 || axis > 2) fail(BREVE_ERROR_ARGUMENT, "space has no axis " + std::to_string(axis) + " (0 to 2)");
    const breve::Extent::Axis& of = world->world->space().axis(axis);
    if (edge) *edge = static_cast<breve_edge>(of.edge);
    if (low) *low = of.low;
    if (high) *high = of.high;
  });
}

breve_status breve_world_set_sleeping(breve_world* world, bool on) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] { world->world->mechanics().set_sleeping(on); });
}

breve_status breve_world_set_workers(breve_world* world, uint32_t workers) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    constexpr uint32_t kMost = 256;
    if (workers < 1 || workers > kMost) fail(BREVE_ERROR_ARGUMENT, "workers must be 1 to 256");
    world->world->mechanics().set_workers(static_cast<int>(workers));
  });
}

breve_status breve_world_set_guard(breve_world* world, breve_guard mode) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (static_cast<unsigned>(mode) >= kGuards) fail(BREVE_ERROR_ARGUMENT, "unknown guard mode");
    world->world->mechanics().set_guard(static_cast<breve::GuardMode>(mode));
  });
}

breve_guard breve_world_guard(const breve_world* world) {
  return world ? static_cast<breve_guard>(dynamics_of(*world).guard()) : BREVE_GUARD_OFF;
}

// --- what came of it ------------------------------------------------------------------------------------------------

breve_intervention breve::host::to_host(const breve_world& world, const Intervention& one) {
  // Names are literals: they end with a zero byte.
  return {one.iteration, one.time, handle_of(world, one.body), words_for(one.reason).data(), name_of(one.action).data(),
          one.value};
}

breve_status breve_world_interventions(const breve_world* world, breve_intervention* interventions, size_t capacity,
                                       size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    copy_list(dynamics_of(*world).interventions(), interventions, capacity, count, "interventions",
              [&](const breve::Intervention& one) { return to_host(*world, one); });
  });
}

breve_status breve_world_impacts(const breve_world* world, breve_impact* impacts, size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    copy_list(dynamics_of(*world).impacts(), impacts, capacity, count, "impacts", [&](const breve::Impact& one) {
      breve_impact impact{};
      impact.a = handle_of(*world, one.a);
      impact.b = handle_of(*world, one.b);
      impact.time = one.time;
      copy_to(impact.point, one.point);
      copy_to(impact.normal, one.normal);
      copy_to(impact.impulse, one.impulse);
      return impact;
    });
  });
}

breve_status breve_world_energy(const breve_world* world, breve_energy* energy) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] { write_struct(energy, energy_from(dynamics_of(*world).energy()), "breve_energy"); });
}

breve_status breve_object_energy(const breve_world* world, breve_object object, breve_energy* energy) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const breve::BodyIndex body = live_body(*world, object);
    write_struct(energy, energy_from(dynamics_of(*world).energy(body)), "breve_energy");
  });
}

breve_status breve_world_physics_counters(const breve_world* world, breve_physics_counters* counters) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const breve::DynamicsCounters& c = dynamics_of(*world).counters();
    const breve_physics_counters filled{
        0,         c.sub_steps, c.evaluations,       c.rejected, c.islands,  c.pairs,         c.contacts, c.warm,
        c.impacts, c.searches,  c.solver_iterations, c.direct,   c.sleeping, c.interventions, c.residual, c.work};
    write_struct(counters, filled, "breve_physics_counters");
  });
}

uint32_t breve_world_workers(const breve_world* world) {
  return world ? static_cast<uint32_t>(dynamics_of(*world).workers()) : 0;
}

breve_status breve_object_accuracy(const breve_world* world, breve_object object, breve_accuracy* accuracy) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const breve::BodyIndex body = live_body(*world, object);
    write_struct(accuracy, accuracy_from(dynamics_of(*world).accuracy(body)), "breve_accuracy");
  });
}
