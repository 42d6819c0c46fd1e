// Pushes of the host: forces of one iteration, impulses, waking.
#include "physical.hpp"

using namespace breve::host;
using breve::BodyIndex;
using breve::Vector3;

breve_status breve_object_add_force(breve_world* world, breve_object object, const double force[3],
                                    const double torque[3], const double point[3]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const BodyIndex body = live_body(*world, object);
    const Vector3 newtons = force ? vector_of(force, "force") : Vector3(0, 0, 0);
    const Vector3 about = torque ? vector_of(torque, "torque") : Vector3(0, 0, 0);
    const Vector3 at = point ? vector_of(point, "point") : Vector3(0, 0, 0);
    world->machine->refuse_in_stage("push a body");
    world->world->add_force(body, newtons, about, point ? &at : nullptr);
  });
}

breve_status breve_object_add_impulse(breve_world* world, breve_object object, const double impulse[3],
                                      const double point[3]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(impulse, "impulse");
    const BodyIndex body = live_body(*world, object);
    const Vector3 push = vector_of(impulse, "impulse");
    const Vector3 at = point ? vector_of(point, "point") : Vector3(0, 0, 0);
    world->machine->refuse_in_stage("push a body");
    world->world->add_impulse(body, push, point ? &at : nullptr);
  });
}

breve_status breve_object_wake(breve_world* world, breve_object object) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] { world->world->wake(live_body(*world, object)); });
}
