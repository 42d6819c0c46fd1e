// Natives of Control, Real and IRSensor that ask where bodies are: rays, shapes, nearest ones.
#include <algorithm>
#include <cmath>
#include <span>

#include "steve/library/resources.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;
using Hits = std::pmr::vector<QueryHit>;

/// Which objects a question is about, as its keywords say.
class Asked {
 public:
  Asked(Machine& machine, std::string_view selector, Text type, std::int32_t bits) {
    filter_.mask = static_cast<std::uint32_t>(bits);
    if (view(type).empty()) return;
    context_ = {&machine, class_named(machine, type, selector)};
    filter_.wants = [](const void* context, ObjectId object) {
      const auto& asked = *static_cast<const Context*>(context);
      if (!asked.cls) return false;  // a class of the library that the program does not use
      const World& world = asked.machine->world();
      return asked.machine->program().cls(world.class_of(object)).derives_from(*asked.cls);
    };
    filter_.context = &context_;
  }
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;
  const QueryFilter& filter() const { return filter_; }

 private:
  struct Context {
    Machine* machine = nullptr;
    const ClassInfo* cls = nullptr;
  } context_;
  QueryFilter filter_;
};

/// Put a question, count it as an effect, and its work as the script's.
template <class Ask>
decltype(auto) put(Machine& machine, const Instance& self, Ask&& ask) {
  World& world = machine.world();
  const StageScope stage = world.work(EffectId::Queries, self.id, 1);
  Queries::Scene scene = world.scene_of_script();
  if (!machine.bounded()) scene.work = nullptr;
  decltype(auto) answer = ask(world.queries(), scene);
  machine.poll();  // an answer that was cut short is not used
  return static_cast<decltype(answer)>(answer);
}

Value object_value(Machine& machine, ObjectId id) { return Value::of(Tag::Object, machine.instance(id)); }

ListCell* objects_of(Machine& machine, const Hits& hits) {
  ListCell* list = machine.heap().list(static_cast<std::uint32_t>(hits.size()));
  const Pin pin(machine, Value::of(Tag::List, list));
  for (const QueryHit& hit : hits) machine.heap().push(*list, object_value(machine, hit.object));
  return list;
}

/// { object, point, normal, distance }, or an empty list.
ListCell* answer_of(Machine& machine, bool found, const QueryHit& hit) {
  ListCell* list = machine.heap().list(found ? 4 : 0);
  if (!found) return list;
  const Pin pin(machine, Value::of(Tag::List, list));
  for (const Value& value :
       {object_value(machine, hit.object), Value::of(hit.point), Value::of(hit.normal), Value::of(hit.distance)})
    machine.heap().push(*list, value);
  return list;
}

const Shape& shape_of(Machine& machine, Instance* shape, const char* selector) {
  const Instance& live = must_live(shape, std::string(selector) + ": the shape");
  const ShapeResource* resource = resource_of<ShapeResource>(machine, &live);
  if (!resource || !resource->shape)
    Machine::fail(RunErrorKind::NullObject, std::string(selector) + ": " + name_of(live) +
                                                " has no geometry (give it some with init-with first)");
  return *resource->shape;
}

ListCell* control_cast_ray(Machine& machine, Instance& self, Vector3 start, Vector3 way, Text type, std::int32_t bits) {
  const Asked asked(machine, "cast-ray", type, bits);
  QueryHit hit;
  const bool found = put(machine, self, [&](Queries& queries, const Queries::Scene& scene) {
    return queries.ray_first(scene, start, way, asked.filter(), hit);
  });
  return answer_of(machine, found, hit);
}

ListCell* control_find_on_ray(Machine& machine, Instance& self, Vector3 start, Vector3 way, Text type,
                              std::int32_t bits) {
  const Asked asked(machine, "find-on-ray", type, bits);
  return objects_of(machine, put(machine, self, [&](Queries& queries, const Queries::Scene& scene) -> const Hits& {
                      return queries.ray_all(scene, start, way, asked.filter());
                    }));
}

ListCell* control_cast_shape(Machine& machine, Instance& self, Instance* shape, Vector3 start, Vector3 way, Text type,
                             std::int32_t bits) {
  const Asked asked(machine, "cast-shape", type, bits);
  const Shape& geometry = shape_of(machine, shape, "cast-shape");
  QueryHit hit;
  const bool found = put(machine, self, [&](Queries& queries, const Queries::Scene& scene) {
    return queries.cast_first(scene, geometry, {start, Quaternion::Identity()}, way, asked.filter(), hit);
  });
  return answer_of(machine, found, hit);
}

ListCell* find_in(Machine& machine, const Instance& self, const Shape& shape, const Vector3& location,
                  const Asked& asked) {
  constexpr std::uint64_t kOfShape = 32;  // iterations: a shape and its list take as long, however little is near
  machine.charge(kOfShape);
  return objects_of(machine, put(machine, self, [&](Queries& queries, const Queries::Scene& scene) -> const Hits& {
                      return queries.overlap(scene, shape, {location, Quaternion::Identity()}, asked.filter());
                    }));
}

ListCell* control_find_in_shape(Machine& machine, Instance& self, Instance* shape, Vector3 location, Text type,
                                std::int32_t bits) {
  const Asked asked(machine, "find-in-shape", type, bits);
  return find_in(machine, self, shape_of(machine, shape, "find-in-shape"), location, asked);
}

ListCell* control_find_in_sphere(Machine& machine, Instance& self, Vector3 location, double radius, Text type,
                                 std::int32_t bits) {
  const Asked asked(machine, "find-in-sphere", type, bits);
  return find_in(machine, self, *Shape::sphere(radius, machine.heap().memory()), location, asked);
}

ListCell* control_find_in_box(Machine& machine, Instance& self, Vector3 location, Vector3 size, Text type,
                              std::int32_t bits) {
  const Asked asked(machine, "find-in-box", type, bits);
  return find_in(machine, self, *Shape::box(size, machine.heap().memory()), location, asked);
}

ListCell* control_find_closest(Machine& machine, Instance& self, Vector3 location, double limit, Text type,
                               std::int32_t bits) {
  const Asked asked(machine, "find-closest", type, bits);
  QueryHit hit;
  const bool found = put(machine, self, [&](Queries& queries, const Queries::Scene& scene) {
    return queries.nearest(scene, location, finite(limit, "find-closest: the limit"), asked.filter(), hit);
  });
  return answer_of(machine, found, hit);
}

ListCell* control_find_near(Machine& machine, Instance& self, Vector3 location, double radius, Text type,
                            std::int32_t bits) {
  const Asked asked(machine, "find-near", type, bits);
  return objects_of(machine, put(machine, self, [&](Queries& queries, const Queries::Scene& scene) -> const Hits& {
                      return queries.near(scene, location, finite(radius, "find-near: the radius"), asked.filter());
                    }));
}

/// The neighbours of one body, as a filter.
struct NeighborsAsked {
  explicit NeighborsAsked(Machine& machine, const Instance& owner)
      : machine(&machine), neighbors(machine.world().neighbor_users(owner.id)) {
    filter.context = this;
    filter.wants = [](const void* context, ObjectId object) {
      constexpr std::size_t kNeighborsPerIteration = 64;
      const auto& asked = *static_cast<const NeighborsAsked*>(context);
      asked.machine->charge(asked.neighbors.size() / kNeighborsPerIteration);
      const auto user = reinterpret_cast<std::uint64_t>(asked.machine->instance(object));
      return std::find(asked.neighbors.begin(), asked.neighbors.end(), user) != asked.neighbors.end();
    };
  }
  NeighborsAsked(const NeighborsAsked&) = delete;
  NeighborsAsked& operator=(const NeighborsAsked&) = delete;

  Machine* machine;
  std::span<const std::uint64_t> neighbors;
  QueryFilter filter;
};

/// { normal, distance }, or an empty list.
ListCell* sensor_cast_ray(Machine& machine, Instance& self, Instance* owner, Vector3 start, Vector3 way) {
  const Instance& live = must_live(owner, "get-data: the owner of the sensor");
  body_of(machine, live);
  const NeighborsAsked asked(machine, live);
  machine.charge_for(asked.neighbors.size());
  QueryHit hit;
  const bool found = put(machine, self, [&](Queries& queries, const Queries::Scene& scene) {
    return queries.ray_first(scene, start, way, asked.filter, hit);
  });
  ListCell* list = machine.heap().list(found ? 2 : 0);
  if (!found) return list;
  const Pin pin(machine, Value::of(Tag::List, list));
  for (const Value& value : {Value::of(hit.normal), Value::of(hit.distance)}) machine.heap().push(*list, value);
  return list;
}

// --- light exposure --------------------------------------------------------------------------------------------------

/// What a light far away sees: 200 x 200 parallel rays, 310 length units wide, towards the origin.
struct LightView {
  static constexpr int kPixels = 200;
  static constexpr double kPixel = 310.0 / kPixels;
  Vector3 source, forward, right, up;

  explicit LightView(const Vector3& from) : source(from) {
    forward = from.norm() > 0 ? Vector3(-from.normalized()) : Vector3(-Vector3::UnitY());
    const bool steep = std::abs(forward.y()) > 0.999;
    right = forward.cross(steep ? Vector3::UnitZ() : Vector3::UnitY()).normalized();
    up = right.cross(forward);
  }
  Vector3 start_of(int column, int row) const { return source + place_of(column) * right + place_of(row) * up; }
  static double place_of(int pixel) { return (pixel + 0.5 - 0.5 * kPixels) * kPixel; }
  static int pixel_at(double place) {
    return static_cast<int>(std::clamp(std::floor(place / kPixel + 0.5 * kPixels), 0.0, kPixels - 1.0));
  }
};

/// How many of the rays meet this body before any other.
std::int32_t get_light_exposure(Machine& machine, Instance& self) {
  World& world = machine.world();
  const LightExposureState& light = world.view().light_exposure;
  const BodyIndex body = body_of(machine, self);
  if (!light.detection || world.dimension() == 2) return 0;
  const LightView view(light.source);
  Eigen::AlignedBox3d seen;  // right, up, forward
  const Eigen::AlignedBox3d bounds = world.bodies().bounds(body);
  if (bounds.isEmpty() || !bounds.sizes().allFinite()) return 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 at = bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)) - view.source;
    seen.extend(Vector3(at.dot(view.right), at.dot(view.up), at.dot(view.forward)));
  }
  const double edge = 0.5 * LightView::kPixels * LightView::kPixel;
  if (seen.max().z() <= 0 || (seen.min().head<2>().array() > edge).any() ||
      (seen.max().head<2>().array() < -edge).any())
    return 0;
  const Vector3 way = seen.max().z() * view.forward;
  std::int32_t count = 0;
  for (int row = LightView::pixel_at(seen.min().y()); row <= LightView::pixel_at(seen.max().y()); ++row)
    for (int column = LightView::pixel_at(seen.min().x()); column <= LightView::pixel_at(seen.max().x()); ++column)
      count += put(machine, self, [&](Queries& queries, const Queries::Scene& scene) {
        QueryHit hit;
        return queries.ray_first(scene, view.start_of(column, row), way, QueryFilter{}, hit) && hit.object == self.id;
      });
  return count;
}

/// A method of that name with other keywords cannot be given a message.
std::int32_t sensor_is_receiver(Machine& machine, Instance&, Instance* agent) {
  const MethodInfo* method = agent && agent->live() ? machine.find_method(*agent->cls, "receive", 1) : nullptr;
  return method && machine.program().symbols().name(method->parameters[0].keyword) == "message";
}

constexpr Native kQueryNatives[] = {
    native<control_cast_ray>("control.cast-ray"),
    native<control_find_on_ray>("control.find-on-ray"),
    native<control_cast_shape>("control.cast-shape"),
    native<control_find_in_shape>("control.find-in-shape"),
    native<control_find_in_sphere>("control.find-in-sphere"),
    native<control_find_in_box>("control.find-in-box"),
    native<control_find_closest>("control.find-closest"),
    native<control_find_near>("control.find-near"),
    native<sensor_cast_ray>("ir-sensor.cast-ray-among"),
    native<sensor_is_receiver>("ir-sensor.is-receiver"),
    native<get_light_exposure>("real.get-light-exposure"),
};

}  // namespace

std::span<const Native> query_natives() { return kQueryNatives; }

}  // namespace breve::steve
