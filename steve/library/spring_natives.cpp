// Natives of Spring: an elastic connection between points of two bodies.
#include <fmt/format.h>

#include "steve/library/joints.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

SpringDescription& description(Machine& machine, Instance& self) {
  return resource_made<SpringResource>(machine, self).is;
}

Instance* spring_connect(Machine& machine, Instance& self, Instance* from, Instance* to, Vector3 from_point,
                         Vector3 to_point, double length, double strength, double damping) {
  SpringDescription is = description(machine, self);
  is.point_a = from_point;
  is.point_b = to_point;
  is.length = length;
  is.strength = strength;
  is.damping = damping;
  connect_spring(machine, self, is, from, to);
  return &self;
}

void spring_disconnect(Machine& machine, Instance& self) {
  const SpringIndex spring = spring_of(machine, self);
  if (spring != kNoSpring) machine.world().mechanics().remove_spring(spring);
}

void spring_dearchive(Machine& machine, Instance& self) { relink_spring(machine, self); }

double spring_current_length(Machine& machine, Instance& self) {
  const SpringIndex spring = spring_of(machine, self);
  return spring == kNoSpring ? 0 : machine.world().mechanics().spring_length(spring);
}

double spring_get_force(Machine& machine, Instance& self) {
  const SpringIndex spring = spring_of(machine, self);
  return spring == kNoSpring ? 0 : machine.world().mechanics().spring_force(spring);
}

double spring_get_length(Machine& machine, Instance& self) { return description(machine, self).length; }

/// The names that messages give to the numbers of a spring.
template <double SpringDescription::*Member>
void spring_set(Machine& machine, Instance& self, double value) {
  if (!(std::isfinite(value) && value >= 0))
    throw Error(ErrorCode::Argument, "a number of " + name_of(self) + " is " + fmt::to_string(value) +
                                         " (length, strength, damping and maximum force are 0 or more)");
  SpringDescription changed = description(machine, self);
  changed.*Member = value;
  change_spring(machine, self, changed);
}

template <SpringMode Mode>
void spring_set_mode(Machine& machine, Instance& self) {
  SpringDescription changed = description(machine, self);
  changed.mode = Mode;
  change_spring(machine, self, changed);
}

constexpr Native kSpringNatives[] = {
    native<spring_connect>("spring.connect"),
    native<spring_disconnect>("spring.disconnect"),
    native<spring_dearchive>("spring.dearchive"),
    native<spring_current_length>("spring.get-current-length"),
    native<spring_get_force>("spring.get-force"),
    native<spring_get_length>("spring.get-length"),
    native<spring_set<&SpringDescription::length>>("spring.set-length"),
    native<spring_set<&SpringDescription::strength>>("spring.set-strength"),
    native<spring_set<&SpringDescription::damping>>("spring.set-damping"),
    native<spring_set<&SpringDescription::maximum_force>>("spring.set-maximum-force"),
    native<spring_set_mode<SpringMode::Both>>("spring.set-expand-and-contract"),
    native<spring_set_mode<SpringMode::ExpandOnly>>("spring.set-expand-only"),
    native<spring_set_mode<SpringMode::ContractOnly>>("spring.set-contract-only"),
};

}  // namespace

std::span<const Native> spring_natives() { return kSpringNatives; }

}  // namespace breve::steve
