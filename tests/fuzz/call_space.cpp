// Calls of queries and of what says who collides with whom.
#include <cmath>

#include "call_functions.hpp"
#include "drawn_geometry.hpp"

namespace breve::fuzz {

namespace call_space {

/// A query, or NULL.
class DrawnQuery {
 public:
  DrawnQuery(Caller& c, const breve_world* world) : null_(c.chance(40)) {
    if (null_) return;
    query_.struct_size = c.struct_size(sizeof query_);
    if (query_.struct_size != sizeof query_) return;  // fields beyond it are not looked at
    if (c.chance(40)) query_.class_name = c.class_name();
    if (c.chance(20)) query_.except = c.object_or_null(world, "Real");
    if (c.chance(30)) query_.mask = c.word();
    query_.solid_only = c.chance(20);
    if (c.chance(3)) query_.reserved[c.word() % 3] = true, c.expect_refusal();
  }
  const breve_query* to() const { return null_ ? nullptr : &query_; }

 private:
  breve_query query_ = breve_query_default();
  bool null_;
};

using Ray = double[3];

/// A function that finds one body.
template <class Call>
breve_status find_one(Caller& c, Call call) {
  Out<bool> found(c);
  Out<breve_hit> hit(c, true);
  const breve_status status = found.after(call(found.to(), hit.to()));
  hit.after(status == BREVE_OK && found && *found ? status : BREVE_ERROR_NOT_FOUND);
  if (hit) {
    require(std::isfinite(hit->distance), "a distance is not finite");
    c.keep(hit->object);
  }
  return status;
}

/// A function that finds all.
template <class Call>
breve_status find_all(Caller& c, Call call) {
  Room<breve_hit> hits(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status = count.after(call(hits.to(), hits.capacity(), count.to()));
  hits.after(status, count ? *count : 0);
  for (std::size_t i = 0; i < hits.written().size(); ++i) {
    c.keep(hits.written()[i].object);
    require(i == 0 || hits.written()[i - 1].distance <= hits.written()[i].distance, "hits are not in order");
  }
  return status;
}

breve_status ray_first(Caller& c) {
  const breve_world* world = c.world();
  const DrawnQuery query(c, world);
  Ray start, way;
  const double *from = c.numbers(start), *along = c.numbers(way);
  return find_one(c, [&](bool* found, breve_hit* hit) {
    return breve_world_ray_first(world, from, along, query.to(), found, hit);
  });
}
breve_status ray_all(Caller& c) {
  const breve_world* world = c.world();
  const DrawnQuery query(c, world);
  Ray start, way;
  const double *from = c.numbers(start), *along = c.numbers(way);
  return find_all(c, [&](breve_hit* hits, std::size_t capacity, std::size_t* count) {
    return breve_world_ray_all(world, from, along, query.to(), hits, capacity, count);
  });
}
breve_status overlap(Caller& c) {
  const breve_world* world = c.world();
  const DrawnQuery query(c, world);
  const DrawnGeometry drawn(c);
  const breve_pose pose = c.pose();
  return find_all(c, [&](breve_hit* hits, std::size_t capacity, std::size_t* count) {
    return breve_world_overlap(world, &drawn.geometry, &pose, query.to(), hits, capacity, count);
  });
}
breve_status cast(Caller& c) {
  const breve_world* world = c.world();
  const DrawnQuery query(c, world);
  const DrawnGeometry drawn(c);
  const breve_pose pose = c.pose();
  Ray way;
  const double* along = c.numbers(way);
  return find_one(c, [&](bool* found, breve_hit* hit) {
    return breve_world_cast(world, &drawn.geometry, &pose, along, query.to(), found, hit);
  });
}
breve_status closest(Caller& c) {
  const breve_world* world = c.world();
  const DrawnQuery query(c, world);
  Ray point;
  const double* at = c.numbers(point);
  const double limit = c.chance(80) ? std::abs(c.finite()) : c.number();
  return find_one(
      c, [&](bool* found, breve_hit* hit) { return breve_world_closest(world, at, limit, query.to(), found, hit); });
}
breve_status near(Caller& c) {
  const breve_world* world = c.world();
  const DrawnQuery query(c, world);
  Ray point;
  const double* at = c.numbers(point);
  const double radius = c.chance(80) ? std::abs(c.finite()) : c.number();
  return find_all(c, [&](breve_hit* hits, std::size_t capacity, std::size_t* count) {
    return breve_world_near(world, at, radius, query.to(), hits, capacity, count);
  });
}

// --- who collides with whom ------------------------------------------------------------------------------------------

breve_status collision_filter(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Out<breve_collision_filter> filter(c);
  filter.set_size(c.struct_size(sizeof(breve_collision_filter)));
  return filter.after(breve_object_collision_filter(world, object, filter.to()));
}
breve_status set_collision_filter(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  breve_collision_filter filter = breve_collision_filter_default();
  filter.struct_size = c.struct_size(sizeof filter);
  if (c.chance(30)) filter.category = c.word();
  if (c.chance(30)) filter.mask = c.word();
  if (c.chance(30)) filter.one_way[c.word() % 3] = c.chance(90) ? c.finite() : c.number();
  filter.sensor = c.chance(20);
  filter.asks = c.chance(40);
  if (c.chance(3)) filter.reserved[c.word() % 6] = true, c.expect_refusal();
  return breve_object_set_collision_filter(world, object, &filter);
}
breve_status collides(Caller& c) {
  const breve_world* world = c.world();
  const breve_object one = c.object(world), other = c.object(world);
  Out<bool> result(c);
  return result.after(breve_object_collides(world, one, other, result.to()));
}
breve_status set_collides(Caller& c) {
  breve_world* world = c.world();
  const breve_object one = c.object(world), other = c.object(world);
  return breve_object_set_collides(world, one, other, c.chance(40));
}

bool may_collide(void* user, breve_world* world, breve_object, breve_object) {
  auto& caller = *static_cast<Caller*>(user);
  caller.call_back(world);
  return caller.chance(50);
}
breve_status set_may_collide(Caller& c) {
  return breve_world_set_may_collide(c.world(), c.chance(70) ? may_collide : nullptr, &c);
}

// --- forces ----------------------------------------------------------------------------------------------------------

breve_status add_force(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Mobile");
  Ray force, torque, point;
  const double *newtons = c.numbers(force, true), *about = c.numbers(torque, true);
  return breve_object_add_force(world, object, newtons, about, c.numbers(point, true));
}
breve_status add_impulse(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Mobile");
  Ray impulse, point;
  const double* push = c.numbers(impulse);
  return breve_object_add_impulse(world, object, push, c.numbers(point, true));
}
breve_status wake(Caller& c) {
  breve_world* world = c.world();
  return breve_object_wake(world, c.object(world, "Real"));
}

constexpr Statuses kQuery = kStale | kNotFound;

constexpr Function kFunctions[] = {
    {"breve_world_ray_first", ray_first, kQuery, 2},
    {"breve_world_ray_all", ray_all, kQuery, 2},
    {"breve_world_overlap", overlap, kQuery, 2},
    {"breve_world_cast", cast, kQuery, 2},
    {"breve_world_closest", closest, kQuery, 2},
    {"breve_world_near", near, kQuery, 2},
    {"breve_object_collision_filter", collision_filter, kBody},
    {"breve_object_set_collision_filter", set_collision_filter, kBody | kScriptError, 2},
    {"breve_object_collides", collides, kStale},
    {"breve_object_set_collides", set_collides, kStale | kScriptError},
    {"breve_world_set_may_collide", set_may_collide, kBusy},
    {"breve_object_add_force", add_force, kBody | kScriptError, 3},
    {"breve_object_add_impulse", add_impulse, kBody | kScriptError, 3},
    {"breve_object_wake", wake, kBody},
};

}  // namespace call_space

std::span<const Function> space_functions() { return call_space::kFunctions; }

}  // namespace breve::fuzz
