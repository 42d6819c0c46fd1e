// The energy ledger, interventions and counters as hashes.
#include "steve/library/ledger_values.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace breve::steve {

namespace {

void put(Machine& machine, HashCell& hash, std::string_view key, const Value& value) {
  machine.heap().set(hash, Value::of(Tag::String, machine.heap().string(key)), value);
}

Value text(Machine& machine, std::string_view words) { return Value::of(Tag::String, machine.heap().string(words)); }

/// A script's int has 32 bits.
Value count(std::uint64_t number) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  return Value::of(static_cast<std::int32_t>(std::min(number, kMost)));
}

}  // namespace

HashCell* ledger_value(Machine& machine, const Energy& energy) {
  HashCell* hash = machine.heap().hash();
  const std::pair<std::string_view, double> numbers[] = {
      {"kinetic", energy.kinetic},           {"potential", energy.potential},
      {"springs", energy.springs},           {"total", energy.total()},
      {"motor-work", energy.motor_work},     {"script-work", energy.script_work},
      {"contact-loss", energy.contact_loss}, {"friction-loss", energy.friction_loss},
      {"drag-loss", energy.drag_loss},       {"limit-loss", energy.limit_loss},
      {"residual", energy.residual}};
  for (const auto& [key, number] : numbers) put(machine, *hash, key, Value::of(number));
  return hash;
}

HashCell* counters_value(Machine& machine, const DynamicsCounters& c) {
  HashCell* hash = machine.heap().hash();
  const std::pair<std::string_view, std::uint64_t> numbers[] = {{"sub-steps", c.sub_steps},
                                                                {"evaluations", c.evaluations},
                                                                {"rejected", c.rejected},
                                                                {"islands", c.islands},
                                                                {"pairs", c.pairs},
                                                                {"manifolds", c.manifolds},
                                                                {"contacts", c.contacts},
                                                                {"warm", c.warm},
                                                                {"impacts", c.impacts},
                                                                {"searches", c.searches},
                                                                {"solver-iterations", c.solver_iterations},
                                                                {"direct", c.direct},
                                                                {"limits", c.limits},
                                                                {"rebuilt", c.rebuilt},
                                                                {"sleeping", c.sleeping},
                                                                {"interventions", c.interventions},
                                                                {"work", c.work}};
  for (const auto& [key, number] : numbers) put(machine, *hash, key, count(number));
  put(machine, *hash, "residual", Value::of(c.residual));
  return hash;
}

ListCell* interventions_value(Machine& machine, std::span<const Intervention> interventions) {
  ListCell* list = machine.heap().list(static_cast<std::uint32_t>(interventions.size()));
  for (const Intervention& one : interventions) {
    HashCell* hash = machine.heap().hash();
    put(machine, *hash, "iteration", count(one.iteration));
    put(machine, *hash, "time", Value::of(one.time));
    put(machine, *hash, "body", Value::of(Tag::Object, machine.instance(one.body)));
    put(machine, *hash, "reason", text(machine, words_for(one.reason)));
    put(machine, *hash, "action", text(machine, name_of(one.action)));
    put(machine, *hash, "value", Value::of(one.value));
    machine.heap().push(*list, Value::of(Tag::Hash, hash));
  }
  return list;
}

}  // namespace breve::steve
