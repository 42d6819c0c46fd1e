// Questions of the host about where bodies are.
#include <cmath>

#include "physical.hpp"

using namespace breve::host;
using breve::ObjectId;
using breve::Pose;
using breve::Queries;
using breve::QueryFilter;
using breve::QueryHit;
using breve::Vector3;

namespace {

/// What a breve_query asks for.
class Asked {
 public:
  Asked(const breve_world& world, const breve_query* given) {
    const breve_query query = read_config(given, breve_query_default(), "breve_query");
    for (const bool reserved : query.reserved)
      if (reserved) fail(BREVE_ERROR_ARGUMENT, "a reserved field is not false");
    filter_.mask = query.mask;
    filter_.sensors = !query.solid_only;
    if (!is_null(query.except)) filter_.except = live_id(world, query.except);
    if (!query.class_name) return;
    context_ = {&world, &class_named(world, query.class_name)};
    filter_.wants = [](const void* context, ObjectId object) {
      const auto& asked = *static_cast<const Context*>(context);
      return asked.world->program->cls(asked.world->world->class_of(object)).derives_from(*asked.cls);
    };
    filter_.context = &context_;
  }
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;
  const QueryFilter& filter() const { return filter_; }

 private:
  struct Context {
    const breve_world* world = nullptr;
    const breve::steve::ClassInfo* cls = nullptr;
  } context_;
  QueryFilter filter_;
};

/// Put a question and count it.
template <class Ask>
decltype(auto) put(const breve_world& world, Ask&& ask) {
  const breve::StageScope stage = world.world->asked_by_host(breve::EffectId::Queries);
  return ask(world.world->queries(), world.world->scene());
}

breve_hit hit_of(const breve_world& world, const QueryHit& hit) {
  breve_hit to{};
  to.object = handle_of(world, hit.object);
  copy_to(to.point, hit.point);
  copy_to(to.normal, hit.normal);
  to.distance = hit.distance;
  return to;
}

void write_first(const breve_world& world, bool met, const QueryHit& hit, bool* found, breve_hit* to) {
  *found = met;
  if (met && to) *to = hit_of(world, hit);
}

void write_all(const breve_world& world, const std::pmr::vector<QueryHit>& all, breve_hit* hits, std::size_t capacity,
               std::size_t* count) {
  copy_list(all, hits, capacity, count, "hits", [&](const QueryHit& hit) { return hit_of(world, hit); });
}

Pose pose_of(const breve_pose* pose) {
  need(pose, "pose");
  return {vector_of(pose->location, "pose.location"), rotation_of(pose->rotation, "pose.rotation")};
}

/// The solid of a question, in the memory of the world.
std::shared_ptr<breve::Shape> solid_of(const breve_world& world, const breve_geometry* geometry) {
  need(geometry, "geometry");
  auto& memory = const_cast<breve::MemoryMeter&>(world.meter);
  return geometry_shape(read_config(geometry, breve_geometry_default(), "breve_geometry"),
                        world.world->dimension() == 2, &memory);
}

/// Nobody counts on room that a function has not got.
void need_room(const breve_hit* hits, std::size_t capacity, const std::size_t* count) {
  if (capacity != 0) need(hits, "hits");
  need(count, "count");
}

Vector3 need_vector(const double* numbers, const char* what) {
  need(numbers, what);
  return vector_of(numbers, what);
}

}  // namespace

breve_status breve_world_ray_first(const breve_world* world, const double start[3], const double way[3],
                                   const breve_query* query, bool* found, breve_hit* hit) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const Vector3 from = need_vector(start, "start"), along = need_vector(way, "way");
    need(found, "found");
    const Asked asked(*world, query);
    QueryHit first;
    const bool met = put(*world, [&](Queries& queries, const Queries::Scene& scene) {
      return queries.ray_first(scene, from, along, asked.filter(), first);
    });
    write_first(*world, met, first, found, hit);
  });
}

breve_status breve_world_ray_all(const breve_world* world, const double start[3], const double way[3],
                                 const breve_query* query, breve_hit* hits, size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const Vector3 from = need_vector(start, "start"), along = need_vector(way, "way");
    need_room(hits, capacity, count);
    const Asked asked(*world, query);
    const auto& all = put(*world, [&](Queries& queries, const Queries::Scene& scene) -> decltype(auto) {
      return queries.ray_all(scene, from, along, asked.filter());
    });
    write_all(*world, all, hits, capacity, count);
  });
}

breve_status breve_world_overlap(const breve_world* world, const breve_geometry* geometry, const breve_pose* pose,
                                 const breve_query* query, breve_hit* hits, size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const Pose at = pose_of(pose);
    need_room(hits, capacity, count);
    const Asked asked(*world, query);
    const auto solid = solid_of(*world, geometry);
    const auto& all = put(*world, [&](Queries& queries, const Queries::Scene& scene) -> decltype(auto) {
      return queries.overlap(scene, *solid, at, asked.filter());
    });
    write_all(*world, all, hits, capacity, count);
  });
}

breve_status breve_world_cast(const breve_world* world, const breve_geometry* geometry, const breve_pose* pose,
                              const double way[3], const breve_query* query, bool* found, breve_hit* hit) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const Pose at = pose_of(pose);
    const Vector3 along = need_vector(way, "way");
    need(found, "found");
    const Asked asked(*world, query);
    const auto solid = solid_of(*world, geometry);
    QueryHit first;
    const bool met = put(*world, [&](Queries& queries, const Queries::Scene& scene) {
      return queries.cast_first(scene, *solid, at, along, asked.filter(), first);
    });
    write_first(*world, met, first, found, hit);
  });
}

breve_status breve_world_closest(const breve_world* world, const double point[3], double limit,
                                 const breve_query* query, bool* found, breve_hit* hit) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const Vector3 at = need_vector(point, "point");
    need(found, "found");
    const Asked asked(*world, query);
    QueryHit first;
    const bool met = put(*world, [&](Queries& queries, const Queries::Scene& scene) {
      return queries.nearest(scene, at, limit, asked.filter(), first);
    });
    write_first(*world, met, first, found, hit);
  });
}

breve_status breve_world_near(const breve_world* world, const double point[3], double radius, const breve_query* query,
                              breve_hit* hits, size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const Vector3 at = need_vector(point, "point");
    need_room(hits, capacity, count);
    const Asked asked(*world, query);
    const auto& all = put(*world, [&](Queries& queries, const Queries::Scene& scene) -> decltype(auto) {
      return queries.near(scene, at, radius, asked.filter());
    });
    write_all(*world, all, hits, capacity, count);
  });
}
