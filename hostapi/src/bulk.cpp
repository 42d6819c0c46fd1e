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
      return rows.single() ? bodies.write_poses<float>(all, rows.bytes(), rows.stride())
                           : bodies.write_poses<double>(all, rows.bytes(), rows.stride());
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

/// As unit_quaternion and what a body makes of it, without the roots and divisions where they cannot fail: in space any
/// finite quaternion is a rotation unless it is zero.
void check_rotation(const Bodies& bodies, const double* in) {
  const bool zero = in[0] == 0 && in[1] == 0 && in[2] == 0 && in[3] == 0;
  if (zero || bodies.flat()) bodies.allowed_orientation(unit_quaternion(in, "a rotation"));
}

/// @throws  Error{Argument} if a body cannot have these numbers; no body is asked for
void check_property(const Bodies& bodies, std::uint32_t property, const double* in) {
  const std::size_t width = width_of(property);
  need_finite(in, width, "array.numbers");
  if (has_location(property)) bodies.allowed_location(Vector3(in[0], in[1], in[2]));
  if (has_rotation(property)) check_rotation(bodies, in + width - 4);
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

/// An error names the row that it is about.
template <class Work>
void at_row(std::size_t row, Work&& work) {
  const auto text = [row](const std::exception& e) { return "objects[" + std::to_string(row) + "]: " + e.what(); };
  try {
    work();
  } catch (const StatusError& e) {
    fail(e.status(), text(e));
  } catch (const Error& e) {
    throw Error(e.code(), text(e));
  }
}

/// Looks up one object after the other. What a later one needs is on its way from memory meanwhile.
class Handles {
 public:
  static constexpr std::size_t kAhead = 12;

  explicit Handles(const breve_world& world)
      : all_(world.world->handles()), shift_(kGenerations - 1 - world.first_generation) {}

  /// Null if nobody lives who has it.
  const ObjectHandle* of(breve_object object) const {
    const std::uint64_t ordinal = object.generation + shift_;  // as ticket_of, without a division
    const std::uint64_t ticket = (ordinal >= kGenerations ? ordinal - kGenerations : ordinal) + 1;
    const bool lives = object.generation != 0 && object.index < all_.size() && all_[object.index].ticket == ticket;
    return lives ? &all_[object.index] : nullptr;
  }
  /// Script data of the object, from this byte on, will be read soon.
  void expect(breve_object object, std::size_t offset) const {
    if (object.index < all_.size())
      __builtin_prefetch(reinterpret_cast<const char*>(all_[object.index].user) + offset);  // NOLINT(*-int-to-ptr)
  }

 private:
  const std::span<const ObjectHandle> all_;
  const std::uint64_t shift_;
};

// --- variables ------------------------------------------------------------------------------------------------------

/// The first slot of a variable in one object after the other; the name is looked up once for each class in a row.
class VariableSlots {
 public:
  VariableSlots(const breve_world& world, const char* name) : world_(world), name_(name), handles_(world) {}

  steve::Slot* of(std::size_t row, breve_object object) {
    const ObjectHandle* const handle = handles_.of(object);
    if (!handle || handle->cls != cls_)
      at_row(row, [&] {
        const steve::Instance& instance = live_instance(world_, object);  // or says why not
        use(*handle, instance);
      });
    // The slots are right behind the head, which is not read.
    return reinterpret_cast<steve::Slot*>(handle->user + sizeof(steve::Instance)) + slot_;
  }
  void expect(breve_object object) const {
    handles_.expect(object, sizeof(steve::Instance) + slot_ * sizeof(steve::Slot));
  }
  steve::StaticType type() const { return type_; }
  std::size_t width() const { return type_ == steve::StaticType::Vector ? 3 : 1; }

 private:
  void use(const ObjectHandle& handle, const steve::Instance& instance) {
    const steve::VariableInfo& variable = variable_named(world_, instance, name_);
    const steve::StaticType type = variable.type;
    const auto text = [&] { return "variable '" + std::string(name_) + "' of class " + instance.cls->name; };
    if (type != steve::StaticType::Int && type != steve::StaticType::Double && type != steve::StaticType::Vector)
      fail(BREVE_ERROR_TYPE, text() + " is neither an int, a float nor a vector");
    if (cls_ != kNoClass && type != type_)
      fail(BREVE_ERROR_TYPE, text() + " has another type than in the objects before it");
    cls_ = handle.cls;
    type_ = type;
    slot_ = variable.slot;
  }

  const breve_world& world_;
  const char* name_;
  const Handles handles_;
  ClassId cls_ = kNoClass;
  steve::StaticType type_ = steve::StaticType::Double;
  std::uint32_t slot_ = 0;
};

/// Hands the slots of all of them to `take`, or gives an error. Without objects nothing is known of the variable, and
/// nothing has to be.
template <class Take>
void each_slot(const breve_object* objects, std::size_t count, VariableSlots& variable, Take&& take) {
  if (count != 0) need(objects, "objects");
  for (std::size_t i = 0; i < count; ++i) {
    if (i + Handles::kAhead < count) variable.expect(objects[i + Handles::kAhead]);
    take(i, variable.of(i, objects[i]));
  }
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
  all.resize(count);
  const Handles handles(world);
  BodyIndex* const to = all.data();
  for (std::size_t i = 0; i < count; ++i) {
    const ObjectHandle* const handle = handles.of(objects[i]);
    if (handle && handle->body != kNoBody)
      to[i] = handle->body;
    else
      at_row(i, [&] { to[i] = live_body(world, objects[i]); });  // which says why not
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
      at_row(i, [&] { check_property(std::as_const(*world->world).bodies(), property, numbers); });
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
    // Aside first: an error leaves the host's array as it is.
    auto& aside = world->bulk_numbers;
    aside.resize(3 * count);
    double* const to = aside.data();
    each_slot(objects, count, variable, [&](std::size_t i, const Slot* slot) {
      if (variable.type() == StaticType::Double)
        to[i] = slot->d;
      else if (variable.type() == StaticType::Int)
        to[i] = slot->i;
      else
        for (std::size_t k = 0; k < 3; ++k) to[3 * i + k] = slot[k].d;
    });
    if (count == 0) return;
    const Rows rows(array, count, variable.width());
    if (variable.width() == 3)
      for (std::size_t i = 0; i < count; ++i) rows.put<3>(i, to + 3 * i);
    else
      for (std::size_t i = 0; i < count; ++i) rows.put<1>(i, to + i);
  });
}

breve_status breve_objects_set(breve_world* world, const breve_object* objects, size_t count, const char* name,
                               const breve_array* array) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(name, "name");
    need(array, "array");
    VariableSlots variable(*world, name);
    auto& slots = world->bulk_slots;
    slots.resize(count);
    each_slot(objects, count, variable, [&](std::size_t i, Slot* slot) { slots[i] = slot; });
    if (count == 0) return;
    const Rows rows(array, count, variable.width());
    double numbers[kMostNumbers];
    if (variable.type() == StaticType::Int)
      for (std::size_t i = 0; i < count; ++i) rows.get(i, numbers), at_row(i, [&] { need_whole(numbers[0]); });
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
    for (std::size_t i = 0; i < count; ++i) at_row(i, [&] { live_id(*world, objects[i]); });
    for (std::size_t i = 0; i < count; ++i) {
      if (results) results[i] = breve_value_null();
      // One that an earlier call freed is passed over.
      if (!id_of(*world, objects[i])) continue;
      const breve::steve::Value value = call_prepared(*world, live_instance(*world, objects[i]), prepared, arguments);
      if (results && lasts(value)) results[i] = to_host(*world, value);
    }
  });
}
