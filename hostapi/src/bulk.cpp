// Many objects in one call: their places, motion, colours and variables as arrays of the host, and calls of all of
// them.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include "internal.hpp"
#include "rows.hpp"

namespace breve::host {

namespace {

// --- properties -----------------------------------------------------------------------------------------------------

std::size_t width_of(std::uint32_t property) {
  switch (property) {
    case BREVE_PROPERTY_LOCATION:
    case BREVE_PROPERTY_VELOCITY:
    case BREVE_PROPERTY_ROTATIONAL_VELOCITY: return 3;
    case BREVE_PROPERTY_ROTATION:
    case BREVE_PROPERTY_COLOR: return 4;
    case BREVE_PROPERTY_POSE: return 7;
    default: fail(BREVE_ERROR_ARGUMENT, "property is " + std::to_string(property) + ", which is not a breve_property");
  }
}

bool has_location(std::uint32_t property) {
  return property == BREVE_PROPERTY_LOCATION || property == BREVE_PROPERTY_POSE;
}
bool has_rotation(std::uint32_t property) {
  return property == BREVE_PROPERTY_ROTATION || property == BREVE_PROPERTY_POSE;
}

/// The rows of all bodies; `read` gives the W numbers of one.
template <std::size_t W, class Read>
void read_rows(std::span<const BodyIndex> all, const Rows& rows, Read&& read) {
  double numbers[W];
  for (std::size_t i = 0; i < all.size(); ++i) {
    read(all[i], numbers);
    rows.put<W>(i, numbers);
  }
}

void read_all(const Bodies& bodies, std::span<const BodyIndex> all, std::uint32_t property, const Rows& rows) {
  const auto copy = [](const Vector3& v, double* to) { std::copy_n(v.data(), 3, to); };
  const auto orientation = [&bodies](BodyIndex body, double* to) {
    const Quaternion q = bodies.orientation(body);
    to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
  };
  switch (property) {
    case BREVE_PROPERTY_LOCATION:
      return read_rows<3>(all, rows, [&](BodyIndex body, double* to) { copy(bodies.location(body), to); });
    case BREVE_PROPERTY_ROTATION: return read_rows<4>(all, rows, orientation);
    case BREVE_PROPERTY_POSE:
      return read_rows<7>(all, rows, [&](BodyIndex body, double* to) {
        copy(bodies.location(body), to);
        orientation(body, to + 3);
      });
    case BREVE_PROPERTY_VELOCITY:
      return read_rows<3>(all, rows, [&](BodyIndex body, double* to) { copy(bodies.velocity(body), to); });
    case BREVE_PROPERTY_ROTATIONAL_VELOCITY:
      return read_rows<3>(all, rows, [&](BodyIndex body, double* to) { copy(bodies.rotational_velocity(body), to); });
    default:
      return read_rows<4>(all, rows, [&](BodyIndex body, double* to) {
        const Appearance& appearance = bodies.appearance(body);
        copy(appearance.color, to);
        to[3] = appearance.alpha;
      });
  }
}

/// @throws  Error{Argument} if a body cannot have these numbers; no body is asked for
void check_property(const Bodies& bodies, std::uint32_t property, const double* in) {
  const std::size_t width = width_of(property);
  need_finite(in, width, "array.numbers");
  if (has_location(property)) bodies.allowed_location(Vector3(in[0], in[1], in[2]));
  if (has_rotation(property)) bodies.allowed_orientation(unit_quaternion(in + width - 4, "a rotation"));
  if (property == BREVE_PROPERTY_VELOCITY) bodies.allowed_velocity(Vector3(in[0], in[1], in[2]));
  if (property == BREVE_PROPERTY_ROTATIONAL_VELOCITY) bodies.allowed_spin(Vector3(in[0], in[1], in[2]));
}

void write_pose(World& world, BodyIndex body, std::uint32_t property, const double* in) {
  Bodies& bodies = world.bodies();
  if (has_location(property)) {
    world.leave(body);
    bodies.set_location(body, world.space().inside(Vector3(in[0], in[1], in[2])));
    in += 3;
  }
  if (has_rotation(property)) bodies.set_orientation(body, unit_quaternion(in, "a rotation"));
}

void write_property(World& world, BodyIndex body, std::uint32_t property, const double* in) {
  Bodies& bodies = world.bodies();
  if (has_location(property) || has_rotation(property)) {
    write_pose(world, body, property, in);
  } else if (property == BREVE_PROPERTY_COLOR) {
    Appearance& appearance = bodies.appearance(body);
    appearance.color = Vector3(in[0], in[1], in[2]);
    appearance.alpha = in[3];
  } else if (property == BREVE_PROPERTY_ROTATIONAL_VELOCITY) {
    bodies.set_rotational_velocity(body, Vector3(in[0], in[1], in[2]));
  } else {
    bodies.set_velocity(body, Vector3(in[0], in[1], in[2]));
  }
}

World::Holding holding(const breve_world& world, breve_object object) {
  return is_null(object) ? World::Holding() : world.world->holding(object.index, ticket_of(world, object));
}

// --- variables ------------------------------------------------------------------------------------------------------

/// The first slot of a variable in one object after the other; the name is looked up once for each class in a row.
class VariableSlots {
 public:
  VariableSlots(const breve_world& world, const char* name) : world_(world), name_(name) {}

  steve::Slot* of(breve_object object) {
    const World::Holding held = holding(world_, object);
    const steve::Instance& instance =
        held.id ? *reinterpret_cast<steve::Instance*>(held.user) : live_instance(world_, object);  // which says why not
    if (instance.cls != cls_) {
      const steve::VariableInfo& variable = variable_named(world_, instance, name_);
      const steve::StaticType type = variable.type;
      if (type != steve::StaticType::Int && type != steve::StaticType::Double && type != steve::StaticType::Vector)
        fail(BREVE_ERROR_TYPE, text_of(instance) + " is neither an int, a float nor a vector");
      if (cls_ && type != type_)
        fail(BREVE_ERROR_TYPE, text_of(instance) + " has another type than in the objects before it");
      cls_ = instance.cls;
      type_ = type;
      slot_ = variable.slot;
    }
    return instance.slots + slot_;
  }
  steve::StaticType type() const { return type_; }
  std::size_t width() const { return type_ == steve::StaticType::Vector ? 3 : 1; }

 private:
  std::string text_of(const steve::Instance& instance) const {
    return "variable '" + std::string(name_) + "' of class " + instance.cls->name;
  }

  const breve_world& world_;
  const char* name_;
  const steve::ClassInfo* cls_ = nullptr;
  steve::StaticType type_ = steve::StaticType::Double;
  std::uint32_t slot_ = 0;
};

/// The slots of all of them, or an error. Without objects nothing is known of the variable, and nothing has to be.
std::span<steve::Slot* const> slots_of(const breve_world& world, const breve_object* objects, std::size_t count,
                                       VariableSlots& variable) {
  if (count != 0) need(objects, "objects");
  auto& all = world.bulk_slots;
  all.clear();
  all.reserve(count);
  for (std::size_t i = 0; i < count; ++i) all.push_back(variable.of(objects[i]));
  return all;
}

void need_whole(double number) {
  if (number != std::trunc(number) || number < std::numeric_limits<std::int32_t>::min() ||
      number > std::numeric_limits<std::int32_t>::max())
    fail(BREVE_ERROR_TYPE, "an int cannot represent " + std::to_string(number));
}

// --- calls ----------------------------------------------------------------------------------------------------------

/// Whether a result outlives the calls that follow: numbers, vectors, matrices and objects do.
bool lasts(const steve::Value& value) {
  using steve::Tag;
  return value.tag == Tag::Int || value.tag == Tag::Double || value.tag == Tag::Vector || value.tag == Tag::Matrix ||
         value.tag == Tag::Object;
}

}  // namespace

std::span<const BodyIndex> bodies_of(const breve_world& world, const breve_object* objects, std::size_t count) {
  if (count != 0) need(objects, "objects");
  auto& all = world.bulk_bodies;
  all.clear();
  all.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const World::Holding held = holding(world, objects[i]);
    all.push_back(held.body != kNoBody ? held.body : live_body(world, objects[i]));  // which says why not
  }
  return all;
}

}  // namespace breve::host

using namespace breve::host;
using breve::BodyIndex;
using breve::steve::Slot;
using breve::steve::StaticType;

breve_status breve_objects_property(const breve_world* world, const breve_object* objects, size_t count,
                                    uint32_t property, const breve_array* array) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const Rows rows(array, count, width_of(property));
    read_all(std::as_const(*world->world).bodies(), bodies_of(*world, objects, count), property, rows);
  });
}

breve_status breve_objects_set_property(breve_world* world, const breve_object* objects, size_t count,
                                        uint32_t property, const breve_array* array) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const Rows rows(array, count, width_of(property));
    const std::span<const BodyIndex> all = bodies_of(*world, objects, count);
    double numbers[kMostNumbers];
    for (std::size_t i = 0; i < count; ++i) {
      rows.get(i, numbers);
      check_property(std::as_const(*world->world).bodies(), property, numbers);
    }
    for (std::size_t i = 0; i < count; ++i) {
      rows.get(i, numbers);
      write_property(*world->world, all[i], property, numbers);
    }
    if (!has_location(property) && !has_rotation(property)) return;
    for (const BodyIndex body : all) {
      world->previous.forget(body);
      world->world->mechanics().moved(body);
    }
  });
}

breve_status breve_objects_get(const breve_world* world, const breve_object* objects, size_t count, const char* name,
                               const breve_array* array) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(name, "name");
    need(array, "array");
    VariableSlots variable(*world, name);
    const std::span<Slot* const> slots = slots_of(*world, objects, count, variable);
    if (count == 0) return;
    const Rows rows(array, count, variable.width());
    switch (variable.type()) {
      case StaticType::Vector:
        for (std::size_t i = 0; i < count; ++i) {
          const double numbers[] = {slots[i][0].d, slots[i][1].d, slots[i][2].d};
          rows.put<3>(i, numbers);
        }
        return;
      case StaticType::Int:
        for (std::size_t i = 0; i < count; ++i) {
          const double number = slots[i]->i;
          rows.put<1>(i, &number);
        }
        return;
      default:
        for (std::size_t i = 0; i < count; ++i) rows.put<1>(i, &slots[i]->d);
    }
  });
}

breve_status breve_objects_set(breve_world* world, const breve_object* objects, size_t count, const char* name,
                               const breve_array* array) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(name, "name");
    need(array, "array");
    VariableSlots variable(*world, name);
    const std::span<Slot* const> slots = slots_of(*world, objects, count, variable);
    if (count == 0) return;
    const Rows rows(array, count, variable.width());
    double numbers[kMostNumbers];
    if (variable.type() == StaticType::Int)
      for (std::size_t i = 0; i < count; ++i) rows.get(i, numbers), need_whole(numbers[0]);
    for (std::size_t i = 0; i < count; ++i) {
      rows.get(i, numbers);
      if (variable.type() == StaticType::Int)
        slots[i]->i = static_cast<std::int32_t>(numbers[0]);
      else
        for (std::size_t k = 0; k < variable.width(); ++k) slots[i][k].d = numbers[k];
    }
  });
}

breve_status breve_objects_call_prepared(breve_world* world, const breve_object* objects, size_t count,
                                         breve_selector selector, const breve_value* arguments, size_t argument_count,
                                         breve_value* results) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    Selector& prepared = selector_of(*world, selector, arguments, argument_count);
    if (count != 0) need(objects, "objects");
    for (std::size_t i = 0; i < count; ++i) live_id(*world, objects[i]);
    for (std::size_t i = 0; i < count; ++i) {
      if (results) results[i] = breve_value_null();
      // One that an earlier call freed is passed over.
      if (!id_of(*world, objects[i])) continue;
      const breve::steve::Value value = call_prepared(*world, live_instance(*world, objects[i]), prepared, arguments);
      if (results && lasts(value)) results[i] = to_host(*world, value);
    }
  });
}
