// Collision filters, as hosts set them, and the host's own answer for pairs.
#include "physical.hpp"

using namespace breve::host;
using breve::BodyIndex;
using breve::CollisionFilter;
using breve::ObjectId;

bool breve::host::MayCollide::accepts(ObjectId a, ObjectId b) {
  const breve_object one = handle_of(world_, a), other = handle_of(world_, b);
  const CallbackScope callback(world_);
  return function_(user_, &world_, one, other);
}

breve_status breve_object_collision_filter(const breve_world* world, breve_object object,
                                           breve_collision_filter* filter) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const CollisionFilter& own = std::as_const(*world->world).bodies().filter(live_body(*world, object));
    breve_collision_filter filled = breve_collision_filter_default();
    filled.category = own.category;
    filled.mask = own.mask;
    copy_to(filled.one_way, own.one_way);
    filled.sensor = own.sensor;
    filled.asks = own.asks;
    write_struct(filter, filled, "breve_collision_filter");
  });
}

breve_status breve_object_set_collision_filter(breve_world* world, breve_object object,
                                               const breve_collision_filter* filter) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(filter, "filter");
    const BodyIndex body = live_body(*world, object);
    const CollisionFilter& own = std::as_const(*world->world).bodies().filter(body);
    breve_collision_filter as_it_is = breve_collision_filter_default();
    as_it_is.category = own.category;
    as_it_is.mask = own.mask;
    copy_to(as_it_is.one_way, own.one_way);
    as_it_is.sensor = own.sensor;
    as_it_is.asks = own.asks;
    const auto wanted = read_config(filter, as_it_is, "breve_collision_filter");
    for (const bool reserved : wanted.reserved)
      if (reserved) fail(BREVE_ERROR_ARGUMENT, "a reserved field is not false");
    CollisionFilter set;
    set.category = wanted.category;
    set.mask = wanted.mask;
    set.sensor = wanted.sensor;
    set.asks = wanted.asks;
    set.one_way = vector_of(wanted.one_way, "filter.one_way");
    world->machine->refuse_in_stage("change whom a body collides with");
    world->world->set_filter(body, set);
  });
}

breve_status breve_object_collides(const breve_world* world, breve_object object, breve_object other, bool* collides) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(collides, "collides");
    const ObjectId a = live_id(*world, object), b = live_id(*world, other);
    *collides = world->world->collides(a, b);
  });
}

breve_status breve_object_set_collides(breve_world* world, breve_object object, breve_object other, bool collides) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const ObjectId a = live_id(*world, object), b = live_id(*world, other);
    world->machine->refuse_in_stage("change whom a body collides with");
    world->world->set_collides(a, b, collides);
  });
}

breve_status breve_world_set_may_collide(breve_world* world, breve_may_collide_fn function, void* user) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need_idle(*world, "breve_world_set_may_collide");
    world->may_collide.reset();
    if (function) world->may_collide.emplace(*world, function, user);
    world->world->set_pair_judge(world->may_collide ? &*world->may_collide : nullptr);
  });
}
