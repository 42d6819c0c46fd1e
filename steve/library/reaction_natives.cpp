// Natives of Reaction: reaction and diffusion of matrices.
#include <vector>

#include "steve/library/field_natives.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

ReactionResource& reaction_of(Machine& machine, Instance& self) {
  ReactionResource* resource = resource_of<ReactionResource>(machine, &self);
  if (!resource || !resource->reaction)
    Machine::fail(RunErrorKind::NullObject, name_of(self) + " has no matrices yet; init-with names them");
  return *resource;
}

Reaction& own(Machine& machine, Instance& self) { return *reaction_of(machine, self).reaction; }

std::size_t field_number(const Reaction& reaction, std::int32_t number) {
  if (number < 0 || static_cast<std::size_t>(number) >= reaction.fields())
    throw Error(ErrorCode::Argument, "this matrix does not belong to the reaction; init-with names its matrices");
  return static_cast<std::size_t>(number);
}

void reaction_make(Machine& machine, Instance& self, std::int32_t count) {
  std::pmr::memory_resource* memory = machine.heap().memory();
  Reaction made(static_cast<std::size_t>(std::max(count, 0)), memory);
  resource_made<ReactionResource>(machine, self).reaction.emplace(std::move(made));
}

void reaction_set_diffusion(Machine& machine, Instance& self, std::int32_t field, double rate) {
  Reaction& reaction = own(machine, self);
  reaction.set_diffusion(field_number(reaction, field), rate);
}

void reaction_add_term(Machine& machine, Instance& self, std::int32_t field, double rate, ListCell* powers) {
  Reaction& reaction = own(machine, self);
  Reaction::Powers exact{};
  std::size_t i = 0;
  if (powers) {
    for (const Value& power : *powers) {
      if (power.tag != Tag::Int || power.i < 0 || power.i > Reaction::kMaxPower || i >= reaction.fields())
        throw Error(ErrorCode::Argument, "add-term: powers must list one int from 0 to " +
                                             std::to_string(Reaction::kMaxPower) + " for each of the reaction's " +
                                             std::to_string(reaction.fields()) + " matrices");
      exact[i++] = static_cast<std::uint8_t>(power.i);
    }
  }
  reaction.add_term(field_number(reaction, field), rate, exact);
}

void reaction_clear_terms(Machine& machine, Instance& self) { own(machine, self).clear_terms(); }

void reaction_step(Machine& machine, Instance& self, ListCell* fields, double dt, std::int32_t times,
                   std::int32_t periodic) {
  Reaction& reaction = own(machine, self);
  std::vector<Field*> all;
  if (fields)
    for (const Value& field : *fields)
      all.push_back(
          &field_of(machine, field.tag == Tag::Object ? field.object() : nullptr, "a matrix of the reaction"));
  constexpr std::size_t kElementsPerIteration = 16;  // what takes about as long as an iteration of a script's loop
  const std::uint64_t elements = all.empty() ? 0 : all.size() * all[0]->size();
  for (std::int32_t i = 0; i < times; ++i) {
    if (!all.empty()) machine.charge(1 + elements / kElementsPerIteration);
    const StageScope timed = machine.world().work(EffectId::Diffusion, self.id, elements);
    reaction.step(all, dt, periodic != 0);
  }
}

constexpr Native kReactionNatives[] = {
    native<reaction_make>("reaction.make"),         native<reaction_set_diffusion>("reaction.set-diffusion"),
    native<reaction_add_term>("reaction.add-term"), native<reaction_clear_terms>("reaction.clear-terms"),
    native<reaction_step>("reaction.step"),
};

}  // namespace

std::span<const Native> reaction_natives() { return kReactionNatives; }

}  // namespace breve::steve
