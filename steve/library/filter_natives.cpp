// Natives of Real that say whom a body collides with.
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

const CollisionFilter& filter_of(Machine& machine, const Instance& self) {
  return bodies_of(machine).filter(body_of(machine, self));
}

/// Give a body a filter that differs from its own in one thing.
template <class T>
void change(Machine& machine, const Instance& self, T CollisionFilter::*field, const T& value) {
  machine.refuse_in_stage("change whom a body collides with");
  const BodyIndex body = body_of(machine, self);
  CollisionFilter filter = bodies_of(machine).filter(body);
  filter.*field = value;
  machine.world().set_filter(body, filter);
}

void real_set_category(Machine& machine, Instance& self, std::int32_t bits) {
  change(machine, self, &CollisionFilter::category, static_cast<std::uint32_t>(bits));
}
std::int32_t real_get_category(Machine& machine, Instance& self) {
  return static_cast<std::int32_t>(filter_of(machine, self).category);
}
void real_set_mask(Machine& machine, Instance& self, std::int32_t bits) {
  change(machine, self, &CollisionFilter::mask, static_cast<std::uint32_t>(bits));
}
std::int32_t real_get_mask(Machine& machine, Instance& self) {
  return static_cast<std::int32_t>(filter_of(machine, self).mask);
}
void real_make_sensor(Machine& machine, Instance& self) { change(machine, self, &CollisionFilter::sensor, true); }
void real_make_solid(Machine& machine, Instance& self) { change(machine, self, &CollisionFilter::sensor, false); }
std::int32_t real_is_sensor(Machine& machine, Instance& self) { return filter_of(machine, self).sensor ? 1 : 0; }
void real_set_one_way(Machine& machine, Instance& self, Vector3 side) {
  change(machine, self, &CollisionFilter::one_way, finite(side, "set-one-way: the side"));
}
Vector3 real_get_one_way(Machine& machine, Instance& self) { return filter_of(machine, self).one_way; }
void real_ask(Machine& machine, Instance& self) { change(machine, self, &CollisionFilter::asks, true); }
void real_do_not_ask(Machine& machine, Instance& self) { change(machine, self, &CollisionFilter::asks, false); }

void set_collides(Machine& machine, const Instance& self, Instance* other, bool on, const char* what) {
  const Instance& live = must_live(other, what);
  machine.refuse_in_stage("change whom a body collides with");
  body_of(machine, self);
  body_of(machine, live);
  machine.world().set_collides(self.id, live.id, on);
}
void real_disable(Machine& machine, Instance& self, Instance* other) {
  set_collides(machine, self, other, false, "disable-collisions: the other object");
}
void real_enable(Machine& machine, Instance& self, Instance* other) {
  set_collides(machine, self, other, true, "enable-collisions: the other object");
}

constexpr Native kFilterNatives[] = {
    native<real_set_category>("real.set-collision-category"),
    native<real_get_category>("real.get-collision-category"),
    native<real_set_mask>("real.set-collision-mask"),
    native<real_get_mask>("real.get-collision-mask"),
    native<real_make_sensor>("real.make-sensor"),
    native<real_make_solid>("real.make-solid"),
    native<real_is_sensor>("real.is-sensor"),
    native<real_set_one_way>("real.set-one-way"),
    native<real_get_one_way>("real.get-one-way"),
    native<real_disable>("real.disable-collisions"),
    native<real_enable>("real.enable-collisions"),
    native<real_ask>("real.ask-before-collisions"),
    native<real_do_not_ask>("real.collide-without-asking"),
};

}  // namespace

std::span<const Native> filter_natives() { return kFilterNatives; }

}  // namespace breve::steve
