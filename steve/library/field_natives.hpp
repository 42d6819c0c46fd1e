// Natives that Vector, Matrix2D and Matrix3D have in common: all of them are fields of numbers.
#pragma once

#include "steve/library/resources.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

/// The field of an object that must have been given a size.
/// @throws RunError{NullObject} if it has none, or if it is not an object with a field
inline Field& field_of(Machine& machine, Instance* object, std::string_view what) {
  Instance& live = must_live(object, what);
  FieldResource* resource = resource_of<FieldResource>(machine, &live);
  if (!resource || !resource->field)
    Machine::fail(RunErrorKind::NullObject, std::string(what) + ": " + name_of(live) + " has no size yet");
  return *resource->field;
}

inline Field& own_field(Machine& machine, Instance& self) { return field_of(machine, &self, "this object"); }

/// Before a field of these sides is made, whether they are good or not.
template <class... Sides>
void charge_for_making(Machine& machine, Sides... sides) {
  constexpr double kOfElement = 2, kMost = 1e18;
  const double elements = (1.0 * ... * std::max<double>(sides, 0));
  machine.charge_for(static_cast<std::uint64_t>(std::min(kOfElement * elements, kMost)));
}

/// The same, for work on all its elements.
inline Field& whole_field(Machine& machine, Instance& self) {
  Field& field = own_field(machine, self);
  machine.charge_for(field.size());
  return field;
}

namespace fields {

/// Counts and times one pass over a field as the effect `diffusion`.
inline StageScope diffusing(Machine& machine, const Instance& self, const Field& field) {
  return machine.world().work(EffectId::Diffusion, self.id, field.size());
}

inline void set_all_values(Machine& machine, Instance& self, double value) {
  whole_field(machine, self).fill(value, machine.poller());
}
inline double get_absolute_sum(Machine& machine, Instance& self) {
  return whole_field(machine, self).absolute_sum(machine.poller());
}
inline void add_scalar(Machine& machine, Instance& self, double value) {
  whole_field(machine, self).add_scalar(value, machine.poller());
}
inline void scale(Machine& machine, Instance& self, double factor) {
  whole_field(machine, self).scale(factor, machine.poller());
}

inline void add_values(Machine& machine, Instance& self, Instance* other, double factor) {
  whole_field(machine, self).add(field_of(machine, other, "add-values"), factor, machine.poller());
}

inline void subtract_values(Machine& machine, Instance& self, Instance* other, double factor) {
  whole_field(machine, self).subtract(field_of(machine, other, "subtract-values"), factor, machine.poller());
}

inline void multiply_with_values(Machine& machine, Instance& self, Instance* other) {
  whole_field(machine, self).multiply(field_of(machine, other, "multiply-with-values"), machine.poller());
}

inline void add_product(Machine& machine, Instance& self, Instance* first, Instance* second, double factor) {
  const Field& a = field_of(machine, first, "add-product");
  whole_field(machine, self).add_product(a, field_of(machine, second, "add-product"), factor, machine.poller());
}

inline void diffuse_in_place(Machine& machine, Instance& self, double factor) {
  Field& field = whole_field(machine, self);
  const StageScope timed = diffusing(machine, self, field);
  field.spread(factor, machine.poller());
}

inline void diffuse_periodically(Machine& machine, Instance& self, double factor) {
  Field& field = whole_field(machine, self);
  machine.charge_for(field.size());  // as in compute_periodic_diffusion
  const StageScope timed = diffusing(machine, self, field);
  field.spread_periodic(factor, machine.poller());
}

/// Also takes the other's size.
inline void copy(Machine& machine, Instance& self, Instance* other) {
  const Field& source = field_of(machine, other, "copy");
  machine.charge_for(source.size());
  FieldResource* const own = resource_of<FieldResource>(machine, &self);
  if (own && own->field && own->field->same_size(source)) return own->field->copy(source, machine.poller());
  Field made(source, machine.heap().memory());
  resource_made<FieldResource>(machine, self).field = std::move(made);
}

inline void compute_diffusion(Machine& machine, Instance& self, Instance* source, double factor) {
  Field& field = whole_field(machine, self);
  const StageScope timed = diffusing(machine, self, field);
  field.diffuse(field_of(machine, source, "compute-diffusion-matrix"), factor, machine.poller());
}

inline void compute_periodic_diffusion(Machine& machine, Instance& self, Instance* source, double factor) {
  Field& field = whole_field(machine, self);
  machine.charge_for(field.size());  // neighbours at the other ends take as long again
  const StageScope timed = diffusing(machine, self, field);
  field.diffuse_periodic(field_of(machine, source, "compute-periodic-diffusion-matrix"), factor, machine.poller());
}

inline void transform(Machine& machine, Instance& self, Instance* matrix, Instance* result) {
  const Field& left = field_of(machine, matrix, "transform: the matrix");
  machine.charge_for(left.size() * static_cast<std::uint64_t>(own_field(machine, self).nx()));  // a product of matrices
  whole_field(machine, self).transform(left, field_of(machine, result, "transform: the result"), machine.poller());
}

inline void print_matlab_style(Machine& machine, Instance& self) {
  constexpr std::uint64_t kOfText = 16;  // a number's digits
  const Field& field = whole_field(machine, self);
  machine.charge_for(kOfText * field.size());
  machine.print(field.matlab(machine.poller()) + "\n");
}

}  // namespace fields

}  // namespace breve::steve
