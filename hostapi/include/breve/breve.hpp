// breve.hpp: breve.h for C++17. Handles that clean up after themselves, results that carry their status.
//
//     auto runtime = breve::Runtime::create().or_throw();
//     auto program = runtime.compile("hello.tz", text).or_throw();
//     auto world = runtime.world(program).or_throw();
//     while (!world.ended() && world.step()) draw(world);
//
// Everything that breve.h says about units, threads, callbacks and the life of values holds here too. Nothing throws
// unless it is asked to: or_throw() turns a failure into breve::Failure. A handle that was moved from, or not made yet,
// gives BREVE_ERROR_ARGUMENT.
#ifndef BREVE_BREVE_HPP
#define BREVE_BREVE_HPP

#include <array>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "breve/analysis.h"
#include "breve/breve.h"

inline bool operator==(breve_object a, breve_object b) { return a.index == b.index && a.generation == b.generation; }
inline bool operator!=(breve_object a, breve_object b) { return !(a == b); }

namespace breve {
inline namespace abi1 {

/// What or_throw() throws. what() is the library's text: place, message, chain of calls.
class Failure : public std::runtime_error {
 public:
  Failure(breve_status status, const std::string& text) : std::runtime_error(text), status_(status) {}
  breve_status status() const { return status_; }

 private:
  breve_status status_;
};

/// Success, or why not.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(breve_status code, const breve_error* error) : code_(code) {
    if (code != BREVE_OK) text_ = error && error->status == static_cast<std::uint32_t>(code) ? error->text : breve_status_name(code);
  }
  explicit operator bool() const { return code_ == BREVE_OK; }
  breve_status code() const { return code_; }
  const std::string& text() const { return text_; }  // "" on success
  void or_throw() const {
    if (code_ != BREVE_OK) throw Failure(code_, text_);
  }

 private:
  breve_status code_ = BREVE_OK;
  std::string text_;
};

/// A value, or why there is none.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(Status status, T value) : status_(std::move(status)), value_(std::move(value)) {}
  explicit operator bool() const { return static_cast<bool>(status_); }
  const Status& status() const { return status_; }
  const std::string& text() const { return status_.text(); }
  /// Default-made after a failure.
  T& value() & { return value_; }
  const T& value() const& { return value_; }
  T&& value() && { return std::move(value_); }
  T or_throw() && {
    status_.or_throw();
    return std::move(value_);
  }
  T or_else(T other) && { return status_ ? std::move(value_) : std::move(other); }

 private:
  Status status_;
  T value_;
};

using Vector = std::array<double, 3>;
using Object = breve_object;

/// Arguments of calls: any of these converts to a script value. Strings are referred to, not copied.
class Value : public breve_value {
 public:
  Value() : breve_value(breve_value_null()) {}
  Value(const breve_value& v) : breve_value(v) {}
  Value(int v) : breve_value(breve_value_int(v)) {}
  Value(double v) : breve_value(breve_value_double(v)) {}
  Value(const Vector& v) : breve_value(breve_value_vector(v[0], v[1], v[2])) {}
  Value(const char* v) : breve_value(breve_value_string(v)) {}
  Value(std::string_view v) : breve_value(breve_value_string("")) {
    if (v.empty()) return;
    as.string.bytes = v.data();
    as.string.size = v.size();
  }
  Value(const std::string& v) : Value(std::string_view(v)) {}
  Value(Object v) : breve_value(breve_value_object(v)) {}

  // The value as a C++ one; the default where it is of another type. A string is copied.
  int integer(int other = 0) const { return type == BREVE_TYPE_INT ? as.integer : other; }
  double number(double other = 0) const {
    return type == BREVE_TYPE_DOUBLE ? as.number : type == BREVE_TYPE_INT ? static_cast<double>(as.integer) : other;
  }
  Vector vector(Vector other = {}) const {
    return type == BREVE_TYPE_VECTOR ? Vector{as.vector[0], as.vector[1], as.vector[2]} : other;
  }
  std::string string() const {
    return type == BREVE_TYPE_STRING || type == BREVE_TYPE_DATA ? std::string(as.string.bytes, as.string.size) : std::string();
  }
  Object object() const { return type == BREVE_TYPE_OBJECT ? as.object : Object{}; }
};

struct Keyword {
  const char* name;
  Value value;
};

/// Can these statements be evaluated as they are, or must another line follow?
inline bool statements_complete(std::string_view text) { return breve_statements_complete(text.data(), text.size()); }

struct Snapshot {
  std::vector<unsigned char> image;
};

class Program {
 public:
  Program() = default;
  explicit Program(breve_program* handle) : handle_(handle) {}  // takes it over
  breve_program* get() const { return handle_.get(); }

 private:
  struct Destroy {
    void operator()(breve_program* p) const { breve_program_destroy(p); }
  };
  std::unique_ptr<breve_program, Destroy> handle_;
};

/// One running simulation. Must not be destroyed from one of its own callbacks: it would then live on, lost.
class World {
 public:
  World() = default;
  explicit World(breve_world* handle) : handle_(handle) {}  // takes it over
  breve_world* get() const { return handle_.get(); }

  Status step() { return status(breve_world_step(get())); }
  /// The fraction of the next iteration that is kept, for interpolation.
  Result<double> advance(double seconds) {
    double fraction = 0;
    const breve_status s = breve_world_advance(get(), seconds, &fraction);
    return {status(s), fraction};
  }
  double time() const { return breve_world_time(get()); }
  std::uint64_t iteration() const { return breve_world_iteration(get()); }
  double iteration_step() const { return breve_world_iteration_step(get()); }
  bool ended() const { return breve_world_ended(get()); }
  bool paused() const { return breve_world_paused(get()); }
  Status set_paused(bool paused) { return status(breve_world_set_paused(get(), paused)); }
  std::uint64_t seed() const { return breve_world_seed(get()); }
  Result<double> random() {
    double number = 0;
    const breve_status s = breve_world_draw_random(get(), &number);
    return {status(s), number};
  }

  Object controller() const { return breve_world_controller(get()); }
  Result<std::vector<Object>> objects(const char* class_name = nullptr) const {
    std::vector<Object> all;
    std::size_t count = 0;
    breve_status s = breve_world_objects(get(), class_name, nullptr, 0, &count);
    if (s == BREVE_OK) {
      all.resize(count);
      s = breve_world_objects(get(), class_name, all.data(), all.size(), &count);
    }
    return {status(s), std::move(all)};
  }
  bool alive(Object object) const { return breve_object_alive(get(), object); }
  std::string class_of(Object object) const {
    const char* name = breve_object_class(get(), object);
    return name ? name : "";
  }
  bool is_a(Object object, const char* class_name) const {
    bool result = false;
    return breve_object_is_a(get(), object, class_name, &result) == BREVE_OK && result;
  }
  Result<Object> create(const char* class_name) {
    Object made{};
    const breve_status s = breve_object_create(get(), class_name, &made);
    return {status(s), made};
  }
  Status free(Object object) { return status(breve_object_free(get(), object)); }

  Result<breve_pose> pose(Object object) const {
    breve_pose pose{};
    const breve_status s = breve_object_pose(get(), object, &pose);
    return {status(s), pose};
  }
  Status set_pose(Object object, const breve_pose& pose) { return status(breve_object_set_pose(get(), object, &pose)); }
  Status set_target(Object object, const breve_pose& pose) {
    return status(breve_object_set_target(get(), object, &pose));
  }
  Result<Vector> velocity(Object object) const {
    Vector v{};
    const breve_status s = breve_object_velocity(get(), object, v.data());
    return {status(s), v};
  }
  Status set_velocity(Object object, const Vector& v) {
    return status(breve_object_set_velocity(get(), object, v.data()));
  }
  Result<Vector> rotational_velocity(Object object) const {
    Vector v{};
    const breve_status s = breve_object_rotational_velocity(get(), object, v.data());
    return {status(s), v};
  }
  Status set_rotational_velocity(Object object, const Vector& v) {
    return status(breve_object_set_rotational_velocity(get(), object, v.data()));
  }
  Result<std::array<double, 4>> color(Object object) const {
    std::array<double, 4> rgba{};
    const breve_status s = breve_object_color(get(), object, rgba.data());
    return {status(s), rgba};
  }
  Status set_color(Object object, const std::array<double, 4>& rgba) {
    return status(breve_object_set_color(get(), object, rgba.data()));
  }
  Result<breve_shape> shape(Object object) const {
    breve_shape shape{};
    const breve_status s = breve_object_shape(get(), object, &shape);
    return {status(s), shape};
  }
  Result<std::vector<Vector>> shape_vertices(Object object) const {
    breve_shape shape{};
    std::vector<Vector> corners;
    breve_status s = breve_object_shape(get(), object, &shape);
    if (s == BREVE_OK && shape.vertex_count != 0) {
      corners.resize(shape.vertex_count);
      s = breve_object_shape_vertices(get(), object, corners.front().data(), corners.size());
    }
    return {status(s), std::move(corners)};
  }
  /// Each face as the numbers of its corners, counter-clockwise from outside.
  Result<std::vector<std::vector<std::uint32_t>>> shape_faces(Object object) const {
    breve_shape shape{};
    std::vector<std::vector<std::uint32_t>> faces;
    breve_status s = breve_object_shape(get(), object, &shape);
    if (s == BREVE_OK && shape.face_count != 0) {
      std::vector<std::uint32_t> sizes(shape.face_count), indices(shape.index_count);
      s = breve_object_shape_faces(get(), object, sizes.data(), sizes.size(), indices.data(), indices.size());
      auto next = indices.begin();
      for (const std::uint32_t size : sizes) {
        faces.emplace_back(next, next + size);
        next += size;
      }
    }
    return {status(s), std::move(faces)};
  }

  // --- bodies with physics -------------------------------------------------------------------------------------------
  Result<Object> create_shape(const breve_geometry& geometry) {
    Object made{};
    const breve_status s = breve_shape_create(get(), &geometry, &made);
    return {status(s), made};
  }
  Status set_shape(Object object, Object shape) { return status(breve_object_set_shape(get(), object, shape)); }
  Status set_physics(Object object, bool on) { return status(breve_object_set_physics(get(), object, on)); }
  Result<double> mass(Object object) const {
    double mass = 0;
    const breve_status s = breve_object_mass(get(), object, &mass);
    return {status(s), mass};
  }
  Status set_force(Object object, const Vector& force, const Vector& torque = {}) {
    return status(breve_object_set_force(get(), object, force.data(), torque.data()));
  }
  Status set_material(Object object, const breve_material& material) {
    return status(breve_object_set_material(get(), object, &material));
  }
  Result<Object> create_joint(const breve_joint_description& description) {
    Object made{};
    const breve_status s = breve_joint_create(get(), &description, &made);
    return {status(s), made};
  }
  Status break_joint(Object joint) { return status(breve_joint_break(get(), joint)); }
  Result<breve_joint_info> joint(Object joint) {
    breve_joint_info info{};
    const breve_status s = breve_joint_state(get(), joint, &info);
    return {status(s), info};
  }
  Result<breve_drive> drive(Object joint) const {
    breve_drive drive = breve_drive_default();
    const breve_status s = breve_joint_drive(get(), joint, &drive);
    return {status(s), drive};
  }
  Status set_drive(Object joint, const breve_drive& drive) {
    return status(breve_joint_set_drive(get(), joint, &drive));
  }
  Result<std::vector<Object>> links(Object object) const {
    return list<Object>([&](Object* out, std::size_t capacity, std::size_t* count) {
      return breve_object_links(get(), object, out, capacity, count);
    });
  }
  Result<std::vector<Object>> joints(Object object) const {
    return list<Object>([&](Object* out, std::size_t capacity, std::size_t* count) {
      return breve_object_joints(get(), object, out, capacity, count);
    });
  }
  Result<Object> create_spring(const breve_spring& description) {
    Object made{};
    const breve_status s = breve_spring_create(get(), &description, &made);
    return {status(s), made};
  }
  Result<breve_accuracy> accuracy() const {
    breve_accuracy accuracy = breve_accuracy_default();
    const breve_status s = breve_world_accuracy(get(), &accuracy);
    return {status(s), accuracy};
  }
  Status set_accuracy(const breve_accuracy& accuracy) { return status(breve_world_set_accuracy(get(), &accuracy)); }
  Status set_gravity(const Vector& gravity) { return status(breve_world_set_gravity(get(), gravity.data())); }
  /// How space goes on along axis 0, 1 or 2; see breve_world_set_space.
  Status set_space(int axis, breve_edge edge, double low, double high) {
    return status(breve_world_set_space(get(), axis, edge, low, high));
  }
  Result<breve_energy> energy() const {
    breve_energy energy = breve_energy_default();
    const breve_status s = breve_world_energy(get(), &energy);
    return {status(s), energy};
  }
  Result<std::vector<breve_impact>> impacts() const {
    return list<breve_impact>([this](breve_impact* out, std::size_t capacity, std::size_t* count) {
      return breve_world_impacts(get(), out, capacity, count);
    });
  }
  Result<std::vector<breve_intervention>> interventions() const {
    return list<breve_intervention>([this](breve_intervention* out, std::size_t capacity, std::size_t* count) {
      return breve_world_interventions(get(), out, capacity, count);
    });
  }

  Result<Value> get(Object object, const char* variable) {
    breve_value value = breve_value_null();
    const breve_status s = breve_object_get(get(), object, variable, &value);
    return {status(s), value};
  }
  Status set(Object object, const char* variable, const Value& value) {
    return status(breve_object_set(get(), object, variable, &value));
  }
  Result<Value> call(Object object, const char* method, std::initializer_list<Keyword> keywords = {}) {
    std::vector<breve_keyword> list;
    list.reserve(keywords.size());
    for (const Keyword& k : keywords) list.push_back({k.name, k.value});
    breve_value value = breve_value_null();
    const breve_status s = breve_object_call(get(), object, method, list.data(), list.size(), &value);
    return {status(s), value};
  }
  Result<breve_selector> prepare(const char* method, std::initializer_list<const char*> keywords = {}) {
    breve_selector selector{};
    const breve_status s = breve_world_prepare(get(), method, keywords.begin(), keywords.size(), &selector);
    return {status(s), selector};
  }
  /// Run statements as though they stood in a method of `self`; the null object: of the controller.
  Result<Value> evaluate(std::string_view text, Object self = {}) {
    breve_value value = breve_value_null();
    const breve_status s = breve_world_evaluate(get(), self, text.data(), text.size(), &value);
    return {status(s), value};
  }
  /// The variables that evaluated statements have made: a hash.
  Result<Value> session() {
    breve_value value = breve_value_null();
    const breve_status s = breve_world_session(get(), &value);
    return {status(s), value};
  }
  /// Go on with a changed program, all or nothing.
  Status reload(const Program& program) { return status(breve_world_reload(get(), program.get())); }
  /// Stop the script that runs; from any thread, or a signal handler.
  void interrupt() noexcept { breve_world_interrupt(get()); }
  Result<Value> call(Object object, breve_selector selector, std::initializer_list<Value> arguments = {}) {
    std::vector<breve_value> list(arguments.begin(), arguments.end());
    breve_value value = breve_value_null();
    const breve_status s = breve_object_call_prepared(get(), object, selector, list.data(), list.size(), &value);
    return {status(s), value};
  }
  /// The elements of a list value.
  Result<std::vector<Value>> elements(const Value& list) {
    std::vector<Value> all;
    std::size_t size = 0;
    breve_status s = breve_list_size(get(), &list, &size);
    for (std::size_t i = 0; s == BREVE_OK && i < size; ++i) {
      Value element;
      s = breve_list_get(get(), &list, i, &element);
      all.push_back(element);
    }
    return {status(s), std::move(all)};
  }
  /// As `print` shows it.
  Result<std::string> text(const Value& value) {
    const char* text = "";
    const breve_status s = breve_value_text(get(), &value, &text);
    return {status(s), std::string(s == BREVE_OK ? text : "")};
  }

  Status key(const char* key, bool down = true) { return status(breve_world_queue_key(get(), key, down)); }
  Status click(Object object = {}) { return status(breve_world_queue_click(get(), object)); }
  Status choose(Object menu_item) { return status(breve_world_queue_choice(get(), menu_item)); }
  Result<std::vector<breve_menu_item>> menu_items() {
    return list<breve_menu_item>([this](breve_menu_item* out, std::size_t capacity, std::size_t* count) {
      return breve_world_menu_items(get(), out, capacity, count);
    });
  }

  Result<std::uint64_t> hash() const {
    std::uint64_t hash = 0;
    const breve_status s = breve_world_hash(get(), &hash);
    return {status(s), hash};
  }
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
  Status restore(const Snapshot& snapshot) {
    return status(breve_world_restore(get(), snapshot.image.data(), snapshot.image.size()));
  }

  Result<std::vector<breve_effect>> effects() const {
    return list<breve_effect>([this](breve_effect* out, std::size_t capacity, std::size_t* count) {
      return breve_world_effects(get(), out, capacity, count);
    });
  }
  Result<breve_stats> stats() const {
    breve_stats stats = breve_stats_default();
    const breve_status s = breve_world_stats(get(), &stats);
    return {status(s), stats};
  }

  Status start_profile(breve_trace_fn trace = nullptr, void* user = nullptr) {
    return status(breve_world_profile_start(get(), trace, user));
  }
  Status stop_profile() { return status(breve_world_profile_stop(get())); }
  /// All nodes; the root is the first.
  Result<std::vector<breve_profile_node>> profile() {
    std::size_t count = 0;
    breve_status s = breve_world_profile_node_count(get(), &count);
    std::vector<breve_profile_node> nodes(count);
    for (std::size_t i = 0; i < count && s == BREVE_OK; ++i) s = breve_world_profile_node(get(), i, &nodes[i]);
    return {status(s), std::move(nodes)};
  }
  const breve_error* last_error() const { return breve_world_last_error(get()); }

 private:
  struct Destroy {
    void operator()(breve_world* w) const { breve_world_destroy(w); }
  };
  Status status(breve_status s) const { return {s, s == BREVE_OK ? nullptr : breve_world_last_error(get())}; }
  template <class T, class F>
  Result<std::vector<T>> list(F fill) const {
    std::vector<T> all;
    std::size_t count = 0;
    breve_status s = fill(nullptr, 0, &count);
    if (s == BREVE_OK) {
      all.resize(count);
      s = fill(all.data(), all.size(), &count);
    }
    return {status(s), std::move(all)};
  }

  std::unique_ptr<breve_world, Destroy> handle_;
};

/// What a program is made of. Texts that it gives live as long as it does.
class Analysis {
 public:
  Analysis() = default;
  explicit Analysis(breve_analysis* handle) : handle_(handle) {}  // takes it over
  breve_analysis* get() const { return handle_.get(); }

  std::vector<breve_diagnostic> diagnostics() const {
    return all<breve_diagnostic>(breve_analysis_diagnostic_count(get()), breve_analysis_diagnostic);
  }
  /// As numbered by breve_analysis_definitions.
  std::vector<breve_symbol> symbols() const {
    return all<breve_symbol>(breve_analysis_symbol_count(get()), breve_analysis_symbol);
  }
  Result<breve_reference> at(const char* file, std::uint32_t line, std::uint32_t column) const {
    breve_reference reference{};
    return {{breve_analysis_name_at(get(), file, line, column, &reference), nullptr}, reference};
  }
  /// Good until the next call.
  Result<std::vector<breve_completion>> completions(const char* file, std::uint32_t line, std::uint32_t column) {
    std::size_t count = 0;
    breve_status s = breve_analysis_completions(get(), file, line, column, nullptr, nullptr, 0, &count);
    std::vector<breve_completion> items(s == BREVE_OK ? count : 0);
    if (s == BREVE_OK)
      s = breve_analysis_completions(get(), file, line, column, nullptr, items.data(), items.size(), &count);
    return {{s, nullptr}, std::move(items)};
  }

 private:
  struct Destroy {
    void operator()(breve_analysis* a) const { breve_analysis_destroy(a); }
  };
  template <class T, class F>
  std::vector<T> all(std::size_t count, F get_one) const {
    std::vector<T> list(count);
    for (std::size_t i = 0; i < count; ++i) get_one(get(), i, &list[i]);
    return list;
  }

  std::unique_ptr<breve_analysis, Destroy> handle_;
};

/// The files below some directories, for breve_runtime_config.files. Runtimes that were made with them keep them.
class Files {
 public:
  Files() = default;
  Files(Files&& other) noexcept : files_(std::exchange(other.files_, breve_files{})) {}
  Files& operator=(Files&& other) noexcept {
    std::swap(files_, other.files_);
    return *this;
  }
  ~Files() { breve_files_release(&files_); }

  /// As breve_files_add_directory: after those of earlier calls.
  Status add(const char* directory, bool may_write = false, std::uint64_t most_bytes = 0) {
    return {breve_files_add_directory(directory, may_write, most_bytes, &files_), nullptr};
  }
  const breve_files& get() const { return files_; }

 private:
  breve_files files_{};
};

class Runtime {
 public:
  Runtime() = default;
  static Result<Runtime> create(const breve_runtime_config& config = breve_runtime_config_default()) {
    breve_runtime* made = nullptr;
    const breve_status s = breve_runtime_create(&config, &made);
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
  /// A program without a text: the whole class library, and one of its controllers.
  Result<Program> library_program(const char* controller = nullptr) {
    breve_program* made = nullptr;
    const breve_status s = breve_program_create_library(get(), controller, &made);
    return {status(s), Program(made)};
  }
  /// Look at a program without running it, also if it has errors.
  Result<Analysis> analyse(const char* name, std::string_view text) {
    breve_analysis* made = nullptr;
    const char* given = text.data() ? text.data() : "";  // NULL would ask for the module
    const breve_status s = breve_analysis_create(get(), name, given, text.size(), &made);
    return {status(s), Analysis(made)};
  }
  Result<World> world(const Program& program, const breve_world_config& config = breve_world_config_default()) {
    breve_world* made = nullptr;
    const breve_status s = breve_world_create(get(), program.get(), &config, &made);
    return {status(s), World(made)};
  }
  /// Do not report lints of that code: "lint-unused-variable".
  Status allow(const char* code) { return status(breve_runtime_allow_lint(get(), code)); }
  /// What the last compilation had to say; good until the next one.
  std::vector<breve_diagnostic> diagnostics() const {
    std::vector<breve_diagnostic> all(breve_runtime_diagnostic_count(get()));
    for (std::size_t i = 0; i < all.size(); ++i) (void)breve_runtime_diagnostic(get(), i, &all[i]);
    return all;
  }

 private:
  struct Destroy {
    void operator()(breve_runtime* r) const { breve_runtime_destroy(r); }
  };
  explicit Runtime(breve_runtime* handle) : handle_(handle) {}
  Status status(breve_status s) const { return {s, s == BREVE_OK ? nullptr : breve_runtime_last_error(get())}; }

  std::unique_ptr<breve_runtime, Destroy> handle_;
};

}  // namespace abi1
}  // namespace breve

#endif
