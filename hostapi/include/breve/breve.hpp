// breve.hpp: breve.h and analysis.h for C++17, with handles that release themselves and results that carry their
// status.
//
//     auto runtime = breve::Runtime::create().or_throw();
//     auto program = runtime.compile("hello.tz", text).or_throw();
//     auto world = runtime.world(program).or_throw();
//     while (!world.ended() && world.step()) draw(world);
//
// Everything that the C headers say about units, threads, callbacks and lifetimes of values also applies here. A handle
// that was moved from, or is empty, gives BREVE_ERROR_ARGUMENT.
// - Errors are values: a Status, or a Result that contains one. Nothing throws unless you ask for it: or_throw() turns
//   a failure into breve::Failure. Without exceptions (-fno-exceptions) everything except or_throw() and Failure is
//   available.
// - Borrowed data: texts (const char*, std::string_view) belong to the library. Texts of a Status are valid until the
//   next call on its world or runtime, texts of a Value until script runs in its world again, texts returned by
//   World::text() until its next call, and texts that describe a program, a class or a profile as long as that exists.
//   Copy what you need longer; Value::borrows() tells whether a value has to be. A Value that is made from a text
//   refers to it: the text must live until the call is made.
// - Memory: nothing here allocates except functions that return a std::vector, and or_throw() when it throws. List
//   functions have a second form that fills a Room of the host and returns the total number of elements, even if it
//   exceeds the room.
#ifndef BREVE_BREVE_HPP
#define BREVE_BREVE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#if defined(__cpp_exceptions)
#include <stdexcept>
#endif

#include "breve/analysis.h"
#include "breve/breve.h"
#include "breve/sound.h"
#include "breve/view.h"

inline bool operator==(breve_object a, breve_object b) { return a.index == b.index && a.generation == b.generation; }
inline bool operator!=(breve_object a, breve_object b) { return !(a == b); }

namespace breve {
inline namespace abi4 {

#if defined(__cpp_exceptions)
/// The exception of or_throw(). what() is the library's text: position, message, call chain.
class Failure : public std::runtime_error {
 public:
  Failure(breve_status status, const char* text) : std::runtime_error(text), status_(status) {}
  breve_status status() const { return status_; }

 private:
  breve_status status_;
};
#endif

/// Success, or the reason for a failure.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(breve_status code, const breve_error* error) : code_(code) {
    if (code == BREVE_OK) return;
    text_ = error && error->status == static_cast<std::uint32_t>(code) ? error->text : breve_status_name(code);
  }
  explicit operator bool() const { return code_ == BREVE_OK; }
  breve_status code() const { return code_; }
  const char* name() const { return breve_status_name(code_); }
  std::string_view text() const { return text_; }  // "" on success; borrowed
#if defined(__cpp_exceptions)
  void or_throw() const {
    if (code_ != BREVE_OK) throw Failure(code_, text_);
  }
#endif

 private:
  breve_status code_ = BREVE_OK;
  const char* text_ = "";
};

/// A value, or the reason why there is none.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(Status status, T value) : status_(status), value_(std::move(value)) {}
  explicit operator bool() const { return static_cast<bool>(status_); }
  const Status& status() const { return status_; }
  std::string_view text() const { return status_.text(); }  // borrowed
  /// Default-constructed after a failure.
  T& value() & { return value_; }
  const T& value() const& { return value_; }
  T&& value() && { return std::move(value_); }
  T or_else(T other) && { return status_ ? std::move(value_) : std::move(other); }
#if defined(__cpp_exceptions)
  T or_throw() && {
    status_.or_throw();
    return std::move(value_);
  }
#endif

 private:
  Status status_;
  T value_;
};

using Vector = std::array<double, 3>;
using Object = breve_object;

/// Memory for a list: the first elements are written, as many as fit. A Room<const T> is a list that is read. Either is
/// made of an array, a std::array, a std::vector, a std::span or anything else whose elements lie in one piece.
template <class T>
struct Room {
  Room(T* first, std::size_t size) : data(first), capacity(size) {}
  template <class List,
            std::enable_if_t<
                std::is_convertible_v<std::remove_pointer_t<decltype(std::data(std::declval<List&>()))> (*)[], T (*)[]>,
                int> = 0>
  Room(List&& list) : data(std::data(list)), capacity(std::size(list)) {}

  T* data;
  std::size_t capacity;
};

/// Rows of numbers in the host's memory, one row for each of many objects: `width` numbers, `stride` bytes from one row
/// to the next, 0 if they are contiguous. The memory must be valid during the call.
struct Array : breve_array {
  Array(float* numbers, std::uint32_t width, std::size_t stride = 0)
      : breve_array{numbers, stride, BREVE_NUMBER_FLOAT, width} {}
  Array(double* numbers, std::uint32_t width, std::size_t stride = 0)
      : breve_array{numbers, stride, BREVE_NUMBER_DOUBLE, width} {}
  /// All elements of a list whose elements lie in one piece, as the rows of `count` objects: floats or doubles, the
  /// same number for each object, or one std::array for each, such as Vector. The width of a list of another size is 0,
  /// which the library refuses.
  template <class List>
  static Array of(List&& list, std::size_t count) {
    return rows(std::data(list), std::size(list), count);
  }
  /// Whether the elements of such a list may be written.
  template <class List>
  static constexpr bool writes = !std::is_const_v<std::remove_pointer_t<decltype(std::data(std::declval<List&>()))>>;

 private:
  template <class T>
  static Array rows(T* first, std::size_t size, std::size_t count) {
    using Element = std::remove_const_t<T>;
    auto* const elements = const_cast<Element*>(first);  // whoever reads the rows does not write them
    if constexpr (std::is_floating_point_v<Element>) {
      return Array(elements, count != 0 && size % count == 0 ? static_cast<std::uint32_t>(size / count) : 0U);
    } else {
      typename Element::value_type* const numbers = size != 0 ? elements->data() : nullptr;
      return Array(numbers, size == count ? static_cast<std::uint32_t>(std::tuple_size_v<Element>) : 0U);
    }
  }
};

/// An argument of a call: any of these types converts to a script value. Texts are referenced, not copied.
class Value : public breve_value {
 public:
  Value() : breve_value(breve_value_null()) {}
  Value(const breve_value& v) : breve_value(v) {}
  /// From any integer type; bool gives 0 or 1. A number that does not fit into an int of a script becomes a double.
  template <class T, std::enable_if_t<std::is_integral_v<T>, int> = 0>
  Value(T v) : breve_value(fits(v) ? breve_value_int(static_cast<std::int32_t>(v)) : breve_value_double(double(v))) {}
  template <class T, std::enable_if_t<std::is_floating_point_v<T>, int> = 0>
  Value(T v) : breve_value(breve_value_double(static_cast<double>(v))) {}
  Value(const Vector& v) : breve_value(breve_value_vector(v[0], v[1], v[2])) {}
  Value(const char* v) : breve_value(breve_value_string(v)) {}
  Value(std::string_view v) : breve_value(breve_value_string("")) {
    if (v.empty()) return;
    as.string.bytes = v.data();
    as.string.size = v.size();
  }
  /// From a std::string or anything else that converts to a std::string_view.
  template <class T, std::enable_if_t<std::is_class_v<T> && std::is_convertible_v<const T&, std::string_view>, int> = 0>
  Value(const T& v) : Value(static_cast<std::string_view>(v)) {}
  Value(Object v) : breve_value(breve_value_object(v)) {}
  /// Row by row.
  static Value matrix(const std::array<double, 9>& rows) { return breve_value_matrix(rows.data()); }

  // The value as a C++ value; the default if it has another type.
  int integer(int other = 0) const { return type == BREVE_TYPE_INT ? as.integer : other; }
  double number(double other = 0) const {
    return type == BREVE_TYPE_DOUBLE ? as.number : type == BREVE_TYPE_INT ? static_cast<double>(as.integer) : other;
  }
  Vector vector(Vector other = {}) const {
    return type == BREVE_TYPE_VECTOR ? Vector{as.vector[0], as.vector[1], as.vector[2]} : other;
  }
  std::string_view string() const {  // borrowed
    const bool bytes = type == BREVE_TYPE_STRING || type == BREVE_TYPE_DATA;
    return bytes ? std::string_view(as.string.bytes, as.string.size) : std::string_view();
  }
  Object object() const { return type == BREVE_TYPE_OBJECT ? as.object : Object{}; }

  /// Whether the value refers to something that it does not contain and that may end before it: the bytes of a text or
  /// of data, a list, a hash or a pointer. Numbers, vectors, matrices and objects are contained.
  bool borrows() const {
    return type == BREVE_TYPE_STRING || type == BREVE_TYPE_DATA || type == BREVE_TYPE_LIST || type == BREVE_TYPE_HASH ||
           type == BREVE_TYPE_POINTER;
  }

 private:
  template <class T>
  static constexpr bool fits(T v) {
    using Wide = std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t>;
    using Int = std::numeric_limits<std::int32_t>;
    if constexpr (std::is_signed_v<T>) return Wide{v} >= Int::min() && Wide{v} <= Int::max();
    return static_cast<std::uint64_t>(v) <= static_cast<std::uint64_t>(Int::max()) || std::is_signed_v<T>;
  }
};

struct Keyword {
  const char* name;
  Value value;
};

inline const char* version() { return breve_version(); }
inline std::uint32_t abi() { return breve_abi(); }

/// Whether these statements can be evaluated as they are; otherwise another line must follow.
inline bool statements_complete(std::string_view text) { return breve_statements_complete(text.data(), text.size()); }

inline std::size_t lint_count() { return breve_lint_count(); }
inline Result<breve_lint_info> lint(std::size_t index) {
  breve_lint_info info{};
  const breve_status s = breve_lint(index, &info);
  return {{s, nullptr}, info};
}

inline std::size_t library_module_count() { return breve_library_module_count(); }
inline Result<breve_source> library_module(std::size_t index) {
  breve_source module{};
  const breve_status s = breve_library_module(index, &module);
  return {{s, nullptr}, module};
}

/// The settings of a rung, and the rung of a name.
inline Result<breve_accuracy> accuracy_of(breve_rung rung) {
  breve_accuracy accuracy = breve_accuracy_default();
  const breve_status s = breve_rung_accuracy(rung, &accuracy);
  return {{s, nullptr}, accuracy};
}
inline Result<breve_rung> find_rung(const char* name) {
  breve_rung rung = BREVE_RUNG_FAST;
  const breve_status s = breve_rung_find(name, &rung);
  return {{s, nullptr}, rung};
}

struct Snapshot {
  std::vector<unsigned char> image;
};

class Program {
 public:
  Program() = default;
  explicit Program(breve_program* handle) : handle_(handle) {}  // takes ownership
  breve_program* get() const { return handle_.get(); }

  std::size_t class_count() const { return breve_program_class_count(get()); }
  Result<breve_class_info> class_at(std::size_t index) const {
    breve_class_info info{};
    const breve_status s = breve_program_class(get(), index, &info);
    return {{s, nullptr}, info};
  }

 private:
  struct Destroy {
    void operator()(breve_program* p) const { breve_program_destroy(p); }
  };
  std::unique_ptr<breve_program, Destroy> handle_;
};

/// One running simulation. Must not be destroyed from one of its own callbacks: the world would not be freed.
class World {
 public:
  World() = default;
  explicit World(breve_world* handle) : handle_(handle) {}  // takes ownership
  breve_world* get() const { return handle_.get(); }

  Status step() { return status(breve_world_step(get())); }
  /// Returns the remaining fraction of the next iteration, for interpolation.
  Result<double> advance(double seconds) { return read<double>(breve_world_advance, seconds); }
  double time() const { return breve_world_time(get()); }
  std::uint64_t iteration() const { return breve_world_iteration(get()); }
  Status set_iteration_step(double seconds) { return status(breve_world_set_iteration_step(get(), seconds)); }
  double integration_step() const { return breve_world_integration_step(get()); }
  Status set_integration_step(double seconds) { return status(breve_world_set_integration_step(get(), seconds)); }
  double time_scale() const { return breve_world_time_scale(get()); }
  Status set_time_scale(double scale) { return status(breve_world_set_time_scale(get(), scale)); }
  bool interpolated() const { return breve_world_interpolated(get()); }
  Status set_interpolated(bool on) { return status(breve_world_set_interpolated(get(), on)); }
  double iteration_step() const { return breve_world_iteration_step(get()); }
  bool ended() const { return breve_world_ended(get()); }
  bool paused() const { return breve_world_paused(get()); }
  Status set_paused(bool paused) { return status(breve_world_set_paused(get(), paused)); }
  std::uint64_t seed() const { return breve_world_seed(get()); }
  Result<double> random() { return read<double>(breve_world_draw_random); }
  void* user() const { return breve_world_user(get()); }
  Status set_user(void* user, void (*destroy)(void* user) = nullptr) {
    return status(breve_world_set_user(get(), user, destroy));
  }
  /// Prints like `print` in a script.
  Status print(std::string_view text) { return status(breve_world_print(get(), text.data(), text.size())); }
  /// The result of random[bound] in a script.
  Result<Value> random(const Value& bound) { return read_value(breve_world_random, &bound); }
  bool has_budget() const { return breve_world_has_budget(get()); }
  const breve_error* last_error() const { return breve_world_last_error(get()); }

  // --- objects -------------------------------------------------------------------------------------------------------
  Object controller() const { return breve_world_controller(get()); }
  Result<std::vector<Object>> objects(const char* class_name = nullptr) const {
    return list<Object>(breve_world_objects, class_name);
  }
  Result<std::size_t> objects(const char* class_name, Room<Object> room) const {
    return fill(room, breve_world_objects, class_name);
  }
  bool alive(Object object) const { return breve_object_alive(get(), object); }
  /// "" for an object that is null or no longer exists.
  std::string_view class_of(Object object) const {
    const char* name = breve_object_class(get(), object);
    return name ? name : "";
  }
  bool is_a(Object object, const char* class_name) const {
    return read<bool>(breve_object_is_a, object, class_name).or_else(false);
  }
  Result<Object> create(const char* class_name) { return read<Object>(breve_object_create, class_name); }
  Status free(Object object) { return status(breve_object_free(get(), object)); }

  Result<breve_pose> pose(Object object) const { return read<breve_pose>(breve_object_pose, object); }
  Status set_pose(Object object, const breve_pose& pose) { return status(breve_object_set_pose(get(), object, &pose)); }
  Status set_target(Object object, const breve_pose& pose) {
    return status(breve_object_set_target(get(), object, &pose));
  }
  struct Target {
    bool moves = false;  // if false, the pose is not set
    breve_pose pose{};
  };
  Result<Target> target(Object object) const {
    Target is;
    const breve_status s = breve_object_target(get(), object, &is.moves, &is.pose);
    return {status(s), is};
  }
  Result<Vector> velocity(Object object) const { return read_array<3>(breve_object_velocity, object); }
  Status set_velocity(Object object, const Vector& v) {
    return status(breve_object_set_velocity(get(), object, v.data()));
  }
  Result<Vector> rotational_velocity(Object object) const {
    return read_array<3>(breve_object_rotational_velocity, object);
  }
  Status set_rotational_velocity(Object object, const Vector& v) {
    return status(breve_object_set_rotational_velocity(get(), object, v.data()));
  }
  Result<std::array<double, 4>> color(Object object) const { return read_array<4>(breve_object_color, object); }
  Status set_color(Object object, const std::array<double, 4>& rgba) {
    return status(breve_object_set_color(get(), object, rgba.data()));
  }
  Result<breve_shape> shape(Object object) const { return read<breve_shape>(breve_object_shape, object); }
  Result<std::vector<Vector>> shape_vertices(Object object) const {
    const Result<breve_shape> shape = this->shape(object);
    std::vector<Vector> corners(shape.value().vertex_count);
    if (corners.empty()) return {shape.status(), {}};
    const breve_status s = breve_object_shape_vertices(get(), object, corners.front().data(), corners.size());
    return {status(s), std::move(corners)};
  }
  /// Each face as the numbers of its vertices, counter-clockwise from outside.
  Result<std::vector<std::vector<std::uint32_t>>> shape_faces(Object object) const {
    const Result<breve_shape> shape = this->shape(object);
    std::vector<std::vector<std::uint32_t>> faces;
    std::vector<std::uint32_t> sizes(shape.value().face_count), indices(shape.value().index_count);
    if (sizes.empty()) return {shape.status(), {}};
    const Status given = shape_faces(object, sizes, indices);
    auto next = indices.begin();
    for (const std::uint32_t size : sizes) {
      faces.emplace_back(next, next + size);
      next += size;
    }
    return {given, std::move(faces)};
  }
  Status shape_vertices(Object object, Room<Vector> room) const {
    return status(breve_object_shape_vertices(get(), object, &(*room.data)[0], room.capacity));
  }
  Status shape_faces(Object object, Room<std::uint32_t> sizes, Room<std::uint32_t> indices) const {
    return status(breve_object_shape_faces(get(), object, sizes.data, sizes.capacity, indices.data, indices.capacity));
  }

  // --- bodies --------------------------------------------------------------------------------------------------------
  Result<Object> create_shape(const breve_geometry& geometry) { return read<Object>(breve_shape_create, &geometry); }
  Status set_shape(Object object, Object shape) { return status(breve_object_set_shape(get(), object, shape)); }
  Result<bool> physics(Object object) const { return read<bool>(breve_object_physics, object); }
  Status set_physics(Object object, bool on) { return status(breve_object_set_physics(get(), object, on)); }
  Result<double> mass(Object object) const { return read<double>(breve_object_mass, object); }
  Status set_force(Object object, const Vector& force, const Vector& torque = {}) {
    return status(breve_object_set_force(get(), object, force.data(), torque.data()));
  }
  Status set_material(Object object, const breve_material& material) {
    return status(breve_object_set_material(get(), object, &material));
  }
  Status set_sleeping(bool on) { return status(breve_world_set_sleeping(get(), on)); }
  Result<bool> asleep(Object object) const { return read<bool>(breve_object_asleep, object); }

  Result<breve_collision_filter> collision_filter(Object object) const {
    return read_struct(breve_collision_filter_default(), breve_object_collision_filter, object);
  }
  Status set_collision_filter(Object object, const breve_collision_filter& filter) {
    return status(breve_object_set_collision_filter(get(), object, &filter));
  }
  Result<bool> collides(Object object, Object other) const { return read<bool>(breve_object_collides, object, other); }
  Status set_collides(Object object, Object other, bool on) {
    return status(breve_object_set_collides(get(), object, other, on));
  }
  /// Sets the function that decides about pairs in which a filter has `asks`; null: only the objects decide.
  Status set_may_collide(breve_may_collide_fn function, void* user = nullptr) {
    return status(breve_world_set_may_collide(get(), function, user));
  }
  /// Acts in the next iteration only, at a point in the world frame or, without one, at the centre of mass.
  Status add_force(Object object, const Vector& force, const Vector* point = nullptr, const Vector& torque = {}) {
    return status(breve_object_add_force(get(), object, force.data(), torque.data(), point ? point->data() : nullptr));
  }
  Status add_impulse(Object object, const Vector& impulse, const Vector* point = nullptr) {
    return status(breve_object_add_impulse(get(), object, impulse.data(), point ? point->data() : nullptr));
  }
  Status wake(Object object) { return status(breve_object_wake(get(), object)); }

  // --- queries: the first body that was found, if any was, or all of them --------------------------------------------
  struct Found {
    bool found = false;
    breve_hit hit{};
    explicit operator bool() const { return found; }
    const breve_hit* operator->() const { return &hit; }
  };
  Result<Found> ray_first(const Vector& start, const Vector& way, const breve_query* query = nullptr) const {
    Found first;
    const breve_status s = breve_world_ray_first(get(), start.data(), way.data(), query, &first.found, &first.hit);
    return {status(s), first};
  }
  Result<std::vector<breve_hit>> ray_all(const Vector& start, const Vector& way,
                                         const breve_query* query = nullptr) const {
    return list<breve_hit>(breve_world_ray_all, start.data(), way.data(), query);
  }
  Result<std::size_t> ray_all(const Vector& start, const Vector& way, const breve_query* query,
                              Room<breve_hit> room) const {
    return fill(room, breve_world_ray_all, start.data(), way.data(), query);
  }
  Result<std::vector<breve_hit>> overlap(const breve_geometry& geometry, const breve_pose& pose,
                                         const breve_query* query = nullptr) const {
    return list<breve_hit>(breve_world_overlap, &geometry, &pose, query);
  }
  Result<std::size_t> overlap(const breve_geometry& geometry, const breve_pose& pose, const breve_query* query,
                              Room<breve_hit> room) const {
    return fill(room, breve_world_overlap, &geometry, &pose, query);
  }
  Result<Found> cast(const breve_geometry& geometry, const breve_pose& pose, const Vector& way,
                     const breve_query* query = nullptr) const {
    Found first;
    const breve_status s = breve_world_cast(get(), &geometry, &pose, way.data(), query, &first.found, &first.hit);
    return {status(s), first};
  }
  Result<Found> closest(const Vector& point, double limit = std::numeric_limits<double>::infinity(),
                        const breve_query* query = nullptr) const {
    Found first;
    const breve_status s = breve_world_closest(get(), point.data(), limit, query, &first.found, &first.hit);
    return {status(s), first};
  }
  Result<std::vector<breve_hit>> near(const Vector& point, double radius, const breve_query* query = nullptr) const {
    return list<breve_hit>(breve_world_near, point.data(), radius, query);
  }
  Result<std::size_t> near(const Vector& point, double radius, const breve_query* query, Room<breve_hit> room) const {
    return fill(room, breve_world_near, point.data(), radius, query);
  }

  // --- events of the last iteration ----------------------------------------------------------------------------------
  std::uint32_t events() const { return breve_world_events(get()); }
  Status set_events(std::uint32_t kinds) { return status(breve_world_set_events(get(), kinds)); }
  Status watch_contacts(const char* class_name, bool on = true) {
    return status(breve_world_watch_contacts(get(), class_name, on));
  }
  Status watch_contacts(Object object, bool on = true) {
    return status(breve_object_watch_contacts(get(), object, on));
  }
  Result<std::vector<breve_contact>> contacts() const { return list<breve_contact>(breve_world_contacts); }
  Result<std::size_t> contacts(Room<breve_contact> room) const { return fill(room, breve_world_contacts); }
  Result<std::vector<breve_life>> lives() const { return list<breve_life>(breve_world_lives); }
  Result<std::size_t> lives(Room<breve_life> room) const { return fill(room, breve_world_lives); }
  Result<std::vector<breve_announcement>> announcements() const {
    return list<breve_announcement>(breve_world_announcements);
  }
  Result<std::size_t> announcements(Room<breve_announcement> room) const {
    return fill(room, breve_world_announcements);
  }
  Result<std::vector<breve_nap>> naps() const { return list<breve_nap>(breve_world_naps); }
  Result<std::size_t> naps(Room<breve_nap> room) const { return fill(room, breve_world_naps); }
  Result<bool> contacts_watched(Object object) const { return read<bool>(breve_object_contacts_watched, object); }
  /// The force on `object` from all bodies that touch it, or from one of them.
  Result<Vector> contact_force(Object object, Object other = {}) const {
    return read_array<3>(breve_object_contact_force, object, other);
  }
  /// Sets the callbacks that get the events during an iteration; null: none.
  Status set_listener(const breve_listener* listener) { return status(breve_world_set_listener(get(), listener)); }
  Result<breve_listener> listener() const { return read_struct(breve_listener_default(), breve_world_listener); }

  // --- settings and appearance of bodies -----------------------------------------------------------------------------
  Result<breve_material> material(Object object) const { return read<breve_material>(breve_object_material, object); }
  struct Force {
    Vector force, torque;
  };
  Result<Force> force(Object object) const {
    Force is{};
    const breve_status s = breve_object_force(get(), object, is.force.data(), is.torque.data());
    return {status(s), is};
  }
  bool sleeping() const { return breve_world_sleeping(get()); }
  std::uint32_t workers() const { return breve_world_workers(get()); }
  Result<breve_accuracy> accuracy(Object object) const {
    return read_struct(breve_accuracy_default(), breve_object_accuracy, object);
  }
  Result<bool> self_collisions(Object object) const { return read<bool>(breve_object_self_collisions, object); }
  Result<breve_spring> spring_description(Object spring) const {
    return read_struct(breve_spring_default(), breve_spring_description, spring);
  }

  // --- joints and springs --------------------------------------------------------------------------------------------
  Result<Object> create_joint(const breve_joint_description& description) {
    return read<Object>(breve_joint_create, &description);
  }
  Status break_joint(Object joint) { return status(breve_joint_break(get(), joint)); }
  Result<breve_joint_info> joint(Object joint) const { return read<breve_joint_info>(breve_joint_state, joint); }
  Status set_joint(Object joint, const Vector& position, const Vector& velocity) {
    return status(breve_joint_set_state(get(), joint, position.data(), velocity.data()));
  }
  Result<breve_drive> drive(Object joint) const { return read_struct(breve_drive_default(), breve_joint_drive, joint); }
  Status set_drive(Object joint, const breve_drive& drive) {
    return status(breve_joint_set_drive(get(), joint, &drive));
  }
  Result<std::vector<Object>> links(Object object) const { return list<Object>(breve_object_links, object); }
  Result<std::size_t> links(Object object, Room<Object> room) const { return fill(room, breve_object_links, object); }
  Result<std::vector<Object>> joints(Object object) const { return list<Object>(breve_object_joints, object); }
  Result<std::size_t> joints(Object object, Room<Object> room) const { return fill(room, breve_object_joints, object); }
  Status set_assembly_pose(Object object, const breve_pose& pose) {
    return status(breve_object_set_assembly_pose(get(), object, &pose));
  }
  Status set_self_collisions(Object object, bool on) {
    return status(breve_object_set_self_collisions(get(), object, on));
  }
  Result<Object> create_spring(const breve_spring& description) {
    return read<Object>(breve_spring_create, &description);
  }
  Status set_spring(Object spring, const breve_spring& description) {
    return status(breve_spring_set_description(get(), spring, &description));
  }
  struct SpringState {
    double length, force;
  };
  Result<SpringState> spring(Object spring) const {
    SpringState state{};
    const breve_status s = breve_spring_state(get(), spring, &state.length, &state.force);
    return {status(s), state};
  }

  // --- accuracy, space, grids, threads -------------------------------------------------------------------------------
  Result<breve_accuracy> accuracy() const { return read_struct(breve_accuracy_default(), breve_world_accuracy); }
  Status set_accuracy(const breve_accuracy& accuracy) { return status(breve_world_set_accuracy(get(), &accuracy)); }
  /// The accuracy of a body's assembly; null: the world's.
  Status set_accuracy(Object object, const breve_accuracy* accuracy) {
    return status(breve_object_set_accuracy(get(), object, accuracy));
  }
  Result<std::string_view> accuracy_text() const { return read_text(breve_world_accuracy_text); }
  Result<Vector> gravity() const { return read_array<3>(breve_world_gravity); }
  Status set_gravity(const Vector& gravity) { return status(breve_world_set_gravity(get(), gravity.data())); }
  struct Edge {
    breve_edge edge;
    double low, high;
  };
  /// The extent of space along axis 0, 1 or 2; see breve_world_set_space.
  Result<Edge> space(int axis) const {
    Edge is{};
    const breve_status s = breve_world_space(get(), axis, &is.edge, &is.low, &is.high);
    return {status(s), is};
  }
  Status set_space(int axis, breve_edge edge, double low, double high) {
    return status(breve_world_set_space(get(), axis, edge, low, high));
  }
  Result<std::array<std::uint32_t, 3>> grid_size(Object grid) const {
    std::array<std::uint32_t, 3> counts{};
    const breve_status s = breve_grid_size(get(), grid, counts.data());
    return {status(s), counts};
  }
  Result<std::vector<double>> concentrations(Object grid, Object chemical) const {
    return list<double>(breve_grid_concentrations, grid, chemical);
  }
  Result<std::size_t> concentrations(Object grid, Object chemical, Room<double> room) const {
    return fill(room, breve_grid_concentrations, grid, chemical);
  }
  Status set_concentrations(Object grid, Object chemical, const double* values, std::size_t count) {
    return status(breve_grid_set_concentrations(get(), grid, chemical, values, count));
  }
  Status set_workers(std::uint32_t workers) { return status(breve_world_set_workers(get(), workers)); }

  // --- physics events and counters -----------------------------------------------------------------------------------
  breve_guard guard() const { return breve_world_guard(get()); }
  Status set_guard(breve_guard mode) { return status(breve_world_set_guard(get(), mode)); }
  Result<std::vector<breve_intervention>> interventions() const {
    return list<breve_intervention>(breve_world_interventions);
  }
  Result<std::size_t> interventions(Room<breve_intervention> room) const {
    return fill(room, breve_world_interventions);
  }
  Result<std::vector<breve_impact>> impacts() const { return list<breve_impact>(breve_world_impacts); }
  Result<std::size_t> impacts(Room<breve_impact> room) const { return fill(room, breve_world_impacts); }
  Result<breve_energy> energy() const { return read_struct(breve_energy_default(), breve_world_energy); }
  Result<breve_energy> energy(Object object) const {
    return read_struct(breve_energy_default(), breve_object_energy, object);
  }
  Result<breve_physics_counters> physics_counters() const {
    return read_struct(breve_physics_counters_default(), breve_world_physics_counters);
  }

  // --- values --------------------------------------------------------------------------------------------------------
  /// As `print` shows it.
  Result<std::string_view> text(const Value& value) {
    const char* text = "";
    const breve_status s = breve_value_text(get(), &value, &text);
    return {status(s), text};
  }
  Result<Value> create_list() { return read_value(breve_list_create); }
  Result<std::size_t> list_size(const Value& list) const { return read<std::size_t>(breve_list_size, &list); }
  Result<Value> element(const Value& list, std::size_t index) { return read_value(breve_list_get, &list, index); }
  /// As many elements as fit, from `first` on.
  Status read_elements(const Value& list, std::size_t first, Room<breve_value> room) {
    return status(breve_list_read(get(), &list, first, room.data, room.capacity));
  }
  Status push(const Value& list, const Value& element) { return status(breve_list_push(get(), &list, &element)); }
  /// The elements of a list value.
  Result<std::vector<Value>> elements(const Value& list) {
    const Result<std::size_t> size = list_size(list);
    std::vector<Value> all;
    for (std::size_t i = 0; i < size.value(); ++i) {
      const Result<Value> one = element(list, i);
      if (!one) return {one.status(), std::move(all)};
      all.push_back(one.value());
    }
    return {size.status(), std::move(all)};
  }
  Result<Value> create_hash() { return read_value(breve_hash_create); }
  Result<std::size_t> hash_size(const Value& hash) const { return read<std::size_t>(breve_hash_size, &hash); }
  Result<Value> hash_get(const Value& hash, const Value& key) {
    const breve_value& name = key;
    return read_value(breve_hash_get, &hash, &name);
  }
  Status hash_set(const Value& hash, const Value& key, const Value& element) {
    return status(breve_hash_set(get(), &hash, &key, &element));
  }
  Result<Value> hash_keys(const Value& hash) { return read_value(breve_hash_keys, &hash); }

  // --- variables and calls -------------------------------------------------------------------------------------------
  Result<Value> get(Object object, const char* variable) { return read_value(breve_object_get, object, variable); }
  Status set(Object object, const char* variable, const Value& value) {
    return status(breve_object_set(get(), object, variable, &value));
  }
  Result<Value> call(Object object, const char* method) {
    return read_value(breve_object_call, object, method, nullptr, std::size_t{0});
  }
  /// Calls a method by its keywords, in any order: call(bird, "move", {{"to", target}, {"speed", 3}}).
  template <std::size_t N>
  Result<Value> call(Object object, const char* method, const Keyword (&keywords)[N]) {
    breve_keyword given[N];
    for (std::size_t i = 0; i < N; ++i) given[i] = {keywords[i].name, keywords[i].value};
    return read_value(breve_object_call, object, method, given, N);
  }
  /// For many fast calls: looks the names up once.
  Result<breve_selector> prepare(const char* method) {
    return read<breve_selector>(breve_world_prepare, method, nullptr, std::size_t{0});
  }
  template <std::size_t N>
  Result<breve_selector> prepare(const char* method, const char* const (&keywords)[N]) {
    return read<breve_selector>(breve_world_prepare, method, keywords, N);
  }
  /// The same for calls as `super` makes them in a class; `keywords` may be null if there are none.
  Result<breve_selector> prepare_super(const char* class_name, const char* method,
                                       const char* const* keywords = nullptr, std::size_t count = 0) {
    return read<breve_selector>(breve_world_prepare_super, class_name, method, keywords, count);
  }
  /// The methods of a class. The keywords are valid until the next call.
  Result<std::vector<breve_method_info>> methods(const char* class_name) {
    std::size_t count = 0;
    breve_status s = breve_world_methods(get(), class_name, nullptr, 0, &count);
    std::vector<breve_method_info> all(s == BREVE_OK ? count : 0);
    if (s == BREVE_OK) s = breve_world_methods(get(), class_name, all.data(), all.size(), &count);
    return {status(s), std::move(all)};
  }
  Result<Value> call(Object object, breve_selector selector) {
    return read_value(breve_object_call_prepared, object, selector, nullptr, std::size_t{0});
  }
  /// Arguments in the order of the prepared keywords.
  template <std::size_t N>
  Result<Value> call(Object object, breve_selector selector, const Value (&arguments)[N]) {
    breve_value given[N];
    for (std::size_t i = 0; i < N; ++i) given[i] = arguments[i];
    return read_value(breve_object_call_prepared, object, selector, given, N);
  }

  // --- many objects at once: rows of the host's memory; see breve_objects_property -----------------------------------
  Status get_all(const Object* objects, std::size_t count, breve_property property, const Array& rows) const {
    return status(breve_objects_property(get(), objects, count, property, &rows));
  }
  Status set_all(const Object* objects, std::size_t count, breve_property property, const Array& rows) {
    return status(breve_objects_set_property(get(), objects, count, property, &rows));
  }
  /// Locations, rotations or poses between the last two iterations.
  Status interpolate_all(const Object* objects, std::size_t count, double fraction, breve_property property,
                         const Array& rows) const {
    return status(breve_objects_interpolated(get(), objects, count, fraction, property, &rows));
  }
  /// An int, float or vector variable of each.
  Status get_all(const Object* objects, std::size_t count, const char* variable, const Array& rows) const {
    return status(breve_objects_get(get(), objects, count, variable, &rows));
  }
  Status set_all(const Object* objects, std::size_t count, const char* variable, const Array& rows) {
    return status(breve_objects_set(get(), objects, count, variable, &rows));
  }
  // The same with lists that know their sizes: objects in one piece, and numbers for Array::of.
  template <class Numbers>
  Status get_all(Room<const Object> objects, breve_property property, Numbers&& numbers) const {
    static_assert(Array::writes<Numbers>, "the numbers are const");
    if (nothing(objects, numbers)) return {};
    return get_all(objects.data, objects.capacity, property, Array::of(numbers, objects.capacity));
  }
  template <class Numbers>
  Status set_all(Room<const Object> objects, breve_property property, const Numbers& numbers) {
    if (nothing(objects, numbers)) return {};
    return set_all(objects.data, objects.capacity, property, Array::of(numbers, objects.capacity));
  }
  template <class Numbers>
  Status interpolate_all(Room<const Object> objects, double fraction, breve_property property,
                         Numbers&& numbers) const {
    static_assert(Array::writes<Numbers>, "the numbers are const");
    if (nothing(objects, numbers)) return {};
    return interpolate_all(objects.data, objects.capacity, fraction, property, Array::of(numbers, objects.capacity));
  }
  template <class Numbers>
  Status get_all(Room<const Object> objects, const char* variable, Numbers&& numbers) const {
    static_assert(Array::writes<Numbers>, "the numbers are const");
    if (nothing(objects, numbers)) return {};
    return get_all(objects.data, objects.capacity, variable, Array::of(numbers, objects.capacity));
  }
  template <class Numbers>
  Status set_all(Room<const Object> objects, const char* variable, const Numbers& numbers) {
    if (nothing(objects, numbers)) return {};
    return set_all(objects.data, objects.capacity, variable, Array::of(numbers, objects.capacity));
  }
  /// The same call for each object; `results` has room for one result each, or is null.
  Status call_all(const Object* objects, std::size_t count, breve_selector selector, breve_value* results = nullptr) {
    return status(breve_objects_call_prepared(get(), objects, count, selector, nullptr, 0, results));
  }
  template <std::size_t N>
  Status call_all(const Object* objects, std::size_t count, breve_selector selector, const Value (&arguments)[N],
                  breve_value* results = nullptr) {
    breve_value given[N];
    for (std::size_t i = 0; i < N; ++i) given[i] = arguments[i];
    return status(breve_objects_call_prepared(get(), objects, count, selector, given, N, results));
  }

  // --- evaluate and reload -------------------------------------------------------------------------------------------
  /// Runs statements as if they were in a method of `self`; the null object is the controller.
  Result<Value> evaluate(std::string_view text, Object self = {}) {
    return read_value(breve_world_evaluate, self, text.data(), text.size());
  }
  /// The session variables, created by evaluated statements: a hash.
  Result<Value> session() { return read_value(breve_world_session); }
  /// Replaces the program with a changed one, all or nothing.
  Status reload(const Program& program) { return status(breve_world_reload(get(), program.get())); }
  /// Stops the running script; may be called from any thread, or a signal handler.
  void interrupt() noexcept { breve_world_interrupt(get()); }
  /// Charges the work of a host function to the budget, as a number of loop iterations.
  Status charge(std::uint64_t iterations) { return status(breve_world_charge(get(), iterations)); }

  // --- user data and state of the host -------------------------------------------------------------------------------
  Result<void*> user(Object object) const { return read<void*>(breve_object_user, object); }
  Status set_user(Object object, void* user, void (*destroy)(void* user) = nullptr) {
    return status(breve_object_set_user(get(), object, user, destroy));
  }
  /// State of the host that is part of snapshots and of the hash; null: removes the state with that name.
  Status set_state(const char* name, const breve_state* state) {
    return status(breve_world_set_state(get(), name, state));
  }
  void* state(const char* name) const { return breve_world_state(get(), name); }
  /// Allocates memory that counts against the world's limit; null if memory runs out.
  void* allocate(std::size_t size) { return breve_world_allocate(get(), size); }
  void release(void* memory, std::size_t size) { breve_world_release(get(), memory, size); }

  // --- input, snapshots, costs ---------------------------------------------------------------------------------------
  Status key(const char* key, bool down = true) { return status(breve_world_queue_key(get(), key, down)); }
  Status click_ray(const Vector& start, const Vector& way) {
    return status(breve_world_queue_click_ray(get(), start.data(), way.data()));
  }
  Status click(Object object = {}) { return status(breve_world_queue_click(get(), object)); }
  Status choose(Object menu_item) { return status(breve_world_queue_choice(get(), menu_item)); }
  Result<std::vector<breve_menu_item>> menu_items() const { return list<breve_menu_item>(breve_world_menu_items); }
  Result<std::size_t> menu_items(Room<breve_menu_item> room) const { return fill(room, breve_world_menu_items); }

  Result<std::uint64_t> hash() const { return read<std::uint64_t>(breve_world_hash); }
  Result<Snapshot> snapshot() const {
    Snapshot snapshot;
    std::size_t size = 0;
    breve_status s = breve_world_snapshot(get(), nullptr, 0, &size);
    if (s == BREVE_OK) {
      snapshot.image.resize(size);
      s = breve_world_snapshot(get(), snapshot.image.data(), snapshot.image.size(), &size);
    }
    return {status(s), std::move(snapshot)};
  }
  /// Returns the size of the image; it is written if there is room for all of it.
  Result<std::size_t> snapshot(Room<unsigned char> room) const {
    return read<std::size_t>(breve_world_snapshot, room.data, room.capacity);
  }
  /// Records the world from now on; `write` gets `sink` and the bytes of the log.
  Status record_start(breve_write_fn write, void* sink) { return status(breve_world_record_start(get(), write, sink)); }
  Status record_stop() { return status(breve_world_record_stop(get())); }
  bool recording() const { return breve_world_recording(get()); }
  /// Records the bytes that a host function read from outside, or replaces them by the recorded ones in a replay.
  Status record_input(void* bytes, std::size_t size) { return status(breve_world_record_input(get(), bytes, size)); }
  Result<breve_replay> replay(const void* log, std::size_t size, bool (*after)(void*, breve_world*) = nullptr,
                              void* user = nullptr) {
    breve_replay result{};
    const breve_status s = breve_world_replay(get(), log, size, after, user, &result);
    return {status(s), result};
  }
  /// Computes the sound of the world from `time` on: left and right of each frame.
  Status sound(double time, double rate, float* samples, std::size_t frames) const {
    return status(breve_world_sound(get(), time, rate, samples, frames));
  }
  /// Draws the world with the host's functions; see breve_debug_draw_default().
  Status debug_draw(const breve_debug_draw& draw) const { return status(breve_world_debug_draw(get(), &draw)); }
  Status restore(const Snapshot& snapshot) { return restore(snapshot.image.data(), snapshot.image.size()); }
  Status restore(const void* image, std::size_t size) { return status(breve_world_restore(get(), image, size)); }

  Result<std::vector<breve_effect>> effects() const { return list<breve_effect>(breve_world_effects); }
  Result<std::size_t> effects(Room<breve_effect> room) const { return fill(room, breve_world_effects); }
  Result<breve_stats> stats() const { return read_struct(breve_stats_default(), breve_world_stats); }

  Status start_profile(breve_trace_fn trace = nullptr, void* user = nullptr) {
    return status(breve_world_profile_start(get(), trace, user));
  }
  Status stop_profile() { return status(breve_world_profile_stop(get())); }
  Result<std::size_t> profile_node_count() const { return read<std::size_t>(breve_world_profile_node_count); }
  Result<breve_profile_node> profile_node(std::size_t index) const {
    return read<breve_profile_node>(breve_world_profile_node, index);
  }
  Result<double> profile_cost() const { return read<double>(breve_world_profile_cost); }
  bool is_profiled() const noexcept { return breve_world_is_profiled(get()); }
  Status profile_enter(const char* class_name, const breve_place& place) {
    return status(breve_world_profile_enter(get(), class_name, &place));
  }
  Status profile_leave() { return status(breve_world_profile_leave(get())); }
  Status profile_line(std::uint32_t line) { return status(breve_world_profile_line(get(), line)); }
  /// All nodes; the root is the first.
  Result<std::vector<breve_profile_node>> profile() const {
    std::size_t count = 0;
    breve_status s = breve_world_profile_node_count(get(), &count);
    std::vector<breve_profile_node> nodes(count);
    for (std::size_t i = 0; i < count && s == BREVE_OK; ++i) s = breve_world_profile_node(get(), i, &nodes[i]);
    return {status(s), std::move(nodes)};
  }

 private:
  struct Destroy {
    void operator()(breve_world* w) const { breve_world_destroy(w); }
  };
  Status status(breve_status s) const { return {s, s == BREVE_OK ? nullptr : breve_world_last_error(get())}; }
  /// The value that a C function returns through its last parameter.
  template <class T, class F, class... A>
  Result<T> read(F function, A... arguments) const {
    T value{};
    const breve_status s = function(get(), arguments..., &value);
    return {status(s), value};
  }
  /// No objects and no numbers: their width does not matter.
  template <class Numbers>
  bool nothing(Room<const Object> objects, const Numbers& numbers) const {
    return get() && objects.capacity == 0 && std::size(numbers) == 0;
  }
  template <class T, class F, class... A>
  Result<T> read_struct(T value, F function, A... arguments) const {
    const breve_status s = function(get(), arguments..., &value);
    return {status(s), value};
  }
  template <std::size_t N, class F, class... A>
  Result<std::array<double, N>> read_array(F function, A... arguments) const {
    std::array<double, N> numbers{};
    const breve_status s = function(get(), arguments..., numbers.data());
    return {status(s), numbers};
  }
  template <class F, class... A>
  Result<Value> read_value(F function, A... arguments) const {
    breve_value value = breve_value_null();
    const breve_status s = function(get(), arguments..., &value);
    return {status(s), value};
  }
  template <class F>
  Result<std::string_view> read_text(F function) const {
    const char* text = "";
    const breve_status s = function(get(), &text);
    return {status(s), text};
  }
  template <class T, class F, class... A>
  Result<std::size_t> fill(Room<T> room, F function, A... arguments) const {
    return read<std::size_t>(function, arguments..., room.data, room.capacity);
  }
  template <class T, class F, class... A>
  Result<std::vector<T>> list(F function, A... arguments) const {
    std::vector<T> all;
    Result<std::size_t> count = fill(Room<T>(nullptr, 0), function, arguments...);
    if (count) {
      all.resize(count.value());
      count = fill(Room<T>(all), function, arguments...);
    }
    return {count.status(), std::move(all)};
  }

  std::unique_ptr<breve_world, Destroy> handle_;
};

/// The structure of a program. Texts that it returns live as long as it does.
class Analysis {
 public:
  Analysis() = default;
  explicit Analysis(breve_analysis* handle) : handle_(handle) {}  // takes ownership
  breve_analysis* get() const { return handle_.get(); }

  std::vector<breve_diagnostic> diagnostics() const {
    return all<breve_diagnostic>(breve_analysis_diagnostic_count(get()), breve_analysis_diagnostic);
  }
  std::vector<breve_source> files() const {
    return all<breve_source>(breve_analysis_file_count(get()), breve_analysis_file);
  }
  /// The symbol with a number from definitions().
  std::vector<breve_symbol> symbols() const {
    return all<breve_symbol>(breve_analysis_symbol_count(get()), breve_analysis_symbol);
  }
  Result<breve_reference> at(const char* file, std::uint32_t line, std::uint32_t column) const {
    breve_reference reference{};
    const breve_status s = breve_analysis_name_at(get(), file, line, column, &reference);
    return {{s, nullptr}, reference};
  }
  Result<std::vector<std::size_t>> definitions(const char* file, std::uint32_t line, std::uint32_t column) const {
    return list<std::size_t>([&](std::size_t* out, std::size_t capacity, std::size_t* count) {
      return breve_analysis_definitions(get(), file, line, column, out, capacity, count);
    });
  }
  Result<std::vector<breve_span>> references(std::size_t symbol) const {
    return list<breve_span>([&](breve_span* out, std::size_t capacity, std::size_t* count) {
      return breve_analysis_references(get(), symbol, out, capacity, count);
    });
  }
  /// @param keyword  may be null; valid until the next call
  Result<std::vector<std::size_t>> callees(const char* file, std::uint32_t line, std::uint32_t column,
                                           const char** keyword = nullptr) const {
    return list<std::size_t>([&](std::size_t* out, std::size_t capacity, std::size_t* count) {
      return breve_analysis_callees(get(), file, line, column, out, capacity, count, keyword);
    });
  }
  /// Valid until the next call of this or the next function.
  Result<std::vector<breve_completion>> completions(const char* file, std::uint32_t line, std::uint32_t column,
                                                    std::uint32_t* typed = nullptr) const {
    return list<breve_completion>([&](breve_completion* out, std::size_t capacity, std::size_t* count) {
      return breve_analysis_completions(get(), file, line, column, typed, out, capacity, count);
    });
  }
  /// For a statement that is being typed, as if it were in a method of a class; null: of no class.
  Result<std::vector<breve_completion>> statement_completions(const char* class_name, std::string_view text,
                                                              std::size_t offset,
                                                              std::uint32_t* typed = nullptr) const {
    return list<breve_completion>([&](breve_completion* out, std::size_t capacity, std::size_t* count) {
      return breve_analysis_statement_completions(get(), class_name, text.data(), text.size(), offset, typed, out,
                                                  capacity, count);
    });
  }

 private:
  struct Destroy {
    void operator()(breve_analysis* a) const { breve_analysis_destroy(a); }
  };
  template <class T, class F>
  std::vector<T> all(std::size_t count, F get_one) const {
    std::vector<T> list(count);
    for (std::size_t i = 0; i < count; ++i) (void)get_one(get(), i, &list[i]);
    return list;
  }
  template <class T, class F>
  Result<std::vector<T>> list(F fill) const {
    std::vector<T> all;
    std::size_t count = 0;
    breve_status s = fill(nullptr, 0, &count);
    if (s == BREVE_OK) {
      all.resize(count);
      s = fill(all.data(), all.size(), &count);
    }
    return {{s, nullptr}, std::move(all)};
  }

  std::unique_ptr<breve_analysis, Destroy> handle_;
};

/// Rows of a scene; see breve_rows. Valid until the scene is read again.
template <class Row>
class Rows {
 public:
  explicit Rows(const breve_rows& rows) : rows_(rows) {}
  std::size_t size() const { return rows_.count; }
  const Row& operator[](std::size_t i) const {
    return *reinterpret_cast<const Row*>(static_cast<const char*>(rows_.data) + i * rows_.stride);
  }

 private:
  breve_rows rows_;
};

/// The visible scene of a world; see breve/view.h.
class Scene {
 public:
  Scene() = default;
  explicit Scene(breve_scene* handle) : handle_(handle) {}  // takes it over
  static Result<Scene> create() {
    breve_scene* made = nullptr;
    const breve_status s = breve_scene_create(&made);
    return {{s, nullptr}, Scene(made)};
  }
  breve_scene* get() const { return handle_.get(); }
  Status read(World& world) {
    const breve_status s = breve_scene_read(get(), world.get());
    return {s, s == BREVE_OK ? nullptr : breve_world_last_error(world.get())};
  }
  /// The rows of a kind, which must have that type: rows<breve_instance>(BREVE_SCENE_INSTANCES).
  template <class Row>
  Rows<Row> rows(breve_scene_kind kind) const {
    breve_rows found{};
    (void)breve_scene_rows(get(), static_cast<std::uint32_t>(kind), &found);
    return Rows<Row>(found);
  }
  breve_backdrop backdrop() const {
    breve_backdrop filled = breve_backdrop_default();
    (void)breve_scene_backdrop(get(), &filled);
    return filled;
  }
  Result<breve_camera> camera(std::uint32_t width, std::uint32_t height) {
    breve_camera found{};
    const breve_status s = breve_scene_camera(get(), width, height, &found);
    return {{s, nullptr}, found};
  }

 private:
  struct Destroy {
    void operator()(breve_scene* s) const { breve_scene_destroy(s); }
  };
  std::unique_ptr<breve_scene, Destroy> handle_;
};

/// Projects a point into a picture: pixels from the left and the top, and the distance.
inline Result<Vector> project(const breve_camera& camera, std::uint32_t width, std::uint32_t height, Vector point) {
  Vector seen{};
  const breve_status s = breve_camera_project(&camera, width, height, point.data(), seen.data());
  return {{s, nullptr}, seen};
}

/// A picture as a PNG file; its rows are contiguous.
inline Result<std::vector<std::uint8_t>> png(std::uint32_t width, std::uint32_t height, const std::uint8_t* rgba) {
  std::vector<std::uint8_t> bytes;
  std::size_t size = 0;
  breve_status s = breve_png(width, height, rgba, 0, nullptr, 0, &size);
  if (s == BREVE_OK) {
    bytes.resize(size);
    s = breve_png(width, height, rgba, 0, bytes.data(), bytes.size(), &size);
  }
  return {{s, nullptr}, std::move(bytes)};
}

/// A plot as the bytes of a file; see breve_plot_config_default().
inline Result<std::vector<std::uint8_t>> plot_file(const breve_plot_config& config, breve_plot_format format) {
  std::vector<std::uint8_t> bytes;
  std::size_t size = 0;
  breve_status s = breve_plot_file(&config, format, nullptr, 0, &size);
  if (s == BREVE_OK) {
    bytes.resize(size);
    s = breve_plot_file(&config, format, bytes.data(), bytes.size(), &size);
  }
  return {{s, nullptr}, std::move(bytes)};
}

/// Packs pictures into a movie file; see breve/view.h. Created by Runtime::movie.
class Movie {
 public:
  Movie() = default;
  explicit Movie(breve_movie* handle) : handle_(handle) {}  // takes it over
  breve_movie* get() const { return handle_.get(); }
  /// @param rgba  rows from the top; see breve_movie_add
  Status add(const std::uint8_t* rgba, std::size_t stride = 0) {
    return {breve_movie_add(get(), rgba, stride), nullptr};
  }
  Status finish() { return {breve_movie_finish(get()), nullptr}; }

 private:
  struct Destroy {
    void operator()(breve_movie* m) const { breve_movie_destroy(m); }
  };
  std::unique_ptr<breve_movie, Destroy> handle_;
};

/// Draws worlds; see breve/view.h. Created by Runtime::view.
class View {
 public:
  View() = default;
  explicit View(breve_view* handle) : handle_(handle) {}  // takes it over
  breve_view* get() const { return handle_.get(); }
  /// @param rgba  rows from the top; see breve_view_render
  Status render(World& world, std::uint8_t* rgba, std::size_t stride = 0) {
    const breve_status s = breve_view_render(get(), world.get(), rgba, stride);
    return {s, s == BREVE_OK ? nullptr : breve_world_last_error(world.get())};
  }
  Status depth(float* to, std::size_t stride = 0) const { return {breve_view_depth(get(), to, stride), nullptr}; }
  Status set_camera(const breve_camera& camera) { return {breve_view_set_camera(get(), &camera), nullptr}; }
  /// Uses the program's camera again.
  Status reset_camera() { return {breve_view_set_camera(get(), nullptr), nullptr}; }
  /// Shows arrows in the following pictures. @param arrows  sum of breve_arrows
  Status set_arrows(std::uint32_t arrows, double scale = 1) {
    return {breve_view_set_arrows(get(), arrows, scale), nullptr};
  }
  /// The sum of breve_arrows, and their scale.
  Result<std::pair<std::uint32_t, double>> arrows() const {
    std::pair<std::uint32_t, double> found{};
    const breve_status s = breve_view_arrows(get(), &found.first, &found.second);
    return {{s, nullptr}, found};
  }
  Result<breve_camera> camera() const {
    breve_camera found{};
    const breve_status s = breve_view_camera(get(), &found);
    return {{s, nullptr}, found};
  }
  breve_view_counters counters() const {
    breve_view_counters filled = breve_view_counters_default();
    (void)breve_view_counts(get(), &filled);
    return filled;
  }

 private:
  struct Destroy {
    void operator()(breve_view* v) const { breve_view_destroy(v); }
  };
  std::unique_ptr<breve_view, Destroy> handle_;
};

/// The files below some directories, for breve_runtime_config.files. Runtimes created with them keep them alive.
class Files {
 public:
  Files() = default;
  Files(Files&& other) noexcept : files_(std::exchange(other.files_, breve_files{})) {}
  Files& operator=(Files&& other) noexcept {
    std::swap(files_, other.files_);
    return *this;
  }
  ~Files() { breve_files_release(&files_); }

  /// Searched after the directories of earlier calls.
  Status add(const char* directory, bool may_write = false, std::uint64_t most_bytes = 0) {
    return {breve_files_add_directory(directory, may_write, most_bytes, &files_), nullptr};
  }
  const breve_files& get() const { return files_; }

 private:
  breve_files files_{};
};

/// The network, for breve_runtime_config.network. Runtimes created with it keep it alive.
class Network {
 public:
  Network() = default;
  static Result<Network> open(const breve_network_config& config = breve_network_config_default()) {
    Network network;
    const breve_status s = breve_network_open(&config, &network.network_);
    return {Status(s, nullptr), std::move(network)};
  }
  Network(Network&& other) noexcept : network_(std::exchange(other.network_, breve_network{})) {}
  Network& operator=(Network&& other) noexcept {
    std::swap(network_, other.network_);
    return *this;
  }
  ~Network() { breve_network_release(&network_); }
  const breve_network& get() const { return network_; }

 private:
  breve_network network_{};
};

/// Opens the shared library of a plugin, for a breve_open_plugin_fn; `reason` gets `sink` and why it cannot be opened.
inline Result<breve_plugin> open_plugin(const char* path, const char* entry, breve_write_fn reason = nullptr,
                                        void* sink = nullptr) {
  breve_plugin opened{};
  const breve_status s = breve_plugin_open(path, entry, &opened, reason, sink);
  return {Status(s, nullptr), opened};
}

class Runtime {
 public:
  Runtime() = default;
  static Result<Runtime> create(const breve_runtime_config& config = breve_runtime_config_default()) {
    breve_runtime* made = nullptr;
    const breve_status s = breve_runtime_create_for(BREVE_ABI, &config, &made);
    return {Status(s, nullptr), Runtime(made)};
  }
  breve_runtime* get() const { return handle_.get(); }

  Result<Program> compile(const char* name, std::string_view text) {
    breve_program* made = nullptr;
    const breve_status s = breve_program_compile(get(), name, text.data(), text.size(), &made);
    return {status(s), Program(made)};
  }
  Result<Program> load(const char* name) {
    breve_program* made = nullptr;
    const breve_status s = breve_program_load(get(), name, &made);
    return {status(s), Program(made)};
  }
  /// A program that consists of the class library alone, with one of its controllers.
  Result<Program> library_program(const char* controller = nullptr) {
    breve_program* made = nullptr;
    const breve_status s = breve_program_create_library(get(), controller, &made);
    return {status(s), Program(made)};
  }
  /// Analyses a program without running it, even if it has errors.
  Result<Analysis> analyse(const char* name, std::string_view text) {
    breve_analysis* made = nullptr;
    const char* given = text.data() ? text.data() : "";  // NULL would request the module
    const breve_status s = breve_analysis_create(get(), name, given, text.size(), &made);
    return {status(s), Analysis(made)};
  }
  Result<World> world(const Program& program, const breve_world_config& config = breve_world_config_default()) {
    breve_world* made = nullptr;
    const breve_status s = breve_world_create(get(), program.get(), &config, &made);
    return {status(s), World(made)};
  }
  /// Creates a view, which draws worlds without a screen; see breve_view_config_default().
  Result<View> view(const breve_view_config& config = breve_view_config_default()) {
    breve_view* made = nullptr;
    const breve_status s = breve_view_create(get(), &config, &made);
    return {status(s), View(made)};
  }
  /// Begins a movie; see breve_movie_config_default(). Use it in the thread that uses the runtime.
  Result<Movie> movie(const breve_movie_config& config) {
    breve_movie* made = nullptr;
    const breve_status s = breve_movie_create(get(), &config, &made);
    return {status(s), Movie(made)};
  }
  /// Runs many worlds of a program; see breve_batch_default(). The outcome of each, by index.
  Result<std::vector<breve_outcome>> run(const Program& program, const breve_batch& batch) {
    std::vector<breve_outcome> outcomes(batch.count);
    const breve_status s = breve_batch_run(get(), program.get(), &batch, outcomes.data());
    return {status(s), std::move(outcomes)};
  }
  /// The same without a list.
  Status run_quietly(const Program& program, const breve_batch& batch) {
    return status(breve_batch_run(get(), program.get(), &batch, nullptr));
  }
  /// Adds a function for programs that are compiled from now on; see breve_function_default().
  Status add_function(const breve_function& function) { return status(breve_runtime_add_function(get(), &function)); }
  /// Adds a class for programs that are compiled from now on; see breve_class_default().
  Status add_class(const breve_class& description) { return status(breve_runtime_add_class(get(), &description)); }
  /// Turns a lint off: "lint-unused-variable".
  Status allow(const char* code) { return status(breve_runtime_allow_lint(get(), code)); }
  /// The diagnostics of the last compilation; valid until the next one.
  std::vector<breve_diagnostic> diagnostics() const {
    std::vector<breve_diagnostic> all(breve_runtime_diagnostic_count(get()));
    for (std::size_t i = 0; i < all.size(); ++i) (void)breve_runtime_diagnostic(get(), i, &all[i]);
    return all;
  }
  const breve_error* last_error() const { return breve_runtime_last_error(get()); }

 private:
  struct Destroy {
    void operator()(breve_runtime* r) const { breve_runtime_destroy(r); }
  };
  explicit Runtime(breve_runtime* handle) : handle_(handle) {}
  Status status(breve_status s) const { return {s, s == BREVE_OK ? nullptr : breve_runtime_last_error(get())}; }

  std::unique_ptr<breve_runtime, Destroy> handle_;
};

}  // namespace abi4
}  // namespace breve

#endif
