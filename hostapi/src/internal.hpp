// What the handles of breve.h are made of.
#pragma once

#include <deque>
#include <exception>
#include <memory>
#include <memory_resource>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "guard.hpp"
#include "previous.hpp"
#include "runtime/base/memory.hpp"
#include "runtime/world/pair_rules.hpp"
#include "runtime/world/world.hpp"
#include "steve/compile/compile.hpp"
#include "steve/machine/machine.hpp"
#include "steve/machine/profiler.hpp"
#include "tape.hpp"

namespace breve::host {

/// The host's allocation callbacks as a memory resource.
class HostAllocator final : public std::pmr::memory_resource {
 public:
  explicit HostAllocator(const breve_runtime_config& config) : config_(config) {}

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override;
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  const breve_runtime_config& config_;
};

/// The library of a plugin. The functions and classes of the plugin keep it open, and so do all worlds of the runtime:
/// they may hold data with a destroy callback that the plugin gave.
struct PluginLibrary {
  explicit PluginLibrary(const breve_plugin& o) : opened(o) {}
  ~PluginLibrary() {
    if (opened.close) opened.close(opened.library);
  }
  PluginLibrary(const PluginLibrary&) = delete;
  PluginLibrary& operator=(const PluginLibrary&) = delete;
  const breve_plugin opened;
};

/// A plugin as the programs of a runtime spell it, with what its entry added.
struct Plugin {
  std::string file, entry;
  std::shared_ptr<const PluginLibrary> library;
  steve::ForeignFunctions functions;
  steve::ForeignClasses classes;
};

/// What programs and worlds keep of a runtime after its handle is gone.
struct RuntimeState {
  explicit RuntimeState(const breve_runtime_config& c) : config(c), allocator(config) {
    if (config.files.retain) config.files.retain(config.files.user);
    if (config.network.retain) config.network.retain(config.network.user);
  }
  ~RuntimeState() {
    if (config.files.release) config.files.release(config.files.user);
    if (config.network.release) config.network.release(config.network.user);
  }
  RuntimeState(const RuntimeState&) = delete;
  RuntimeState& operator=(const RuntimeState&) = delete;
  std::pmr::memory_resource* memory() {
    return config.allocate ? static_cast<std::pmr::memory_resource*>(&allocator) : std::pmr::new_delete_resource();
  }

  const breve_runtime_config config;
  HostAllocator allocator;
  breve::Workers workers;    // of its worlds
  std::uint32_t worlds = 0;  // that were made, or begun
  std::vector<std::shared_ptr<const PluginLibrary>> libraries;
};

/// Generations of the host's ids are numbers modulo this, plus 1.
inline constexpr std::uint64_t kGenerations = 0xffffffffU;

/// Places on the circle of generations that are far from each other, by the golden ratio: of n worlds no two are closer
/// than a third of its n-th part (Knuth 1998, The Art of Computer Programming 3, section 6.4). The first is 0.
inline std::uint32_t spread(std::uint32_t number) {
  return static_cast<std::uint32_t>(number * 2654435769U % kGenerations);
}

struct DiagnosticText {
  breve_severity severity = BREVE_SEVERITY_ERROR;
  std::string code, message, help, file, text;
  std::uint32_t line = 0, column = 0, length = 0;
};

/// Lists and hashes that the host refers to. Only valid between two runs of script: the heap does not know of them.
class References {
 public:
  explicit References(std::pmr::memory_resource* memory) : cells_(memory) {}
  breve_ref add(steve::Cell* cell);                        // the null cell is the all-zero reference
  steve::Cell* find(breve_ref ref, steve::Tag tag) const;  // BREVE_ERROR_STALE, BREVE_ERROR_TYPE
  void forget_all();

 private:
  std::pmr::vector<steve::Cell*> cells_;
  std::uint32_t epoch_ = 1;
};

/// What a callback writes as its answer. No exception passes through the host's code.
class Answer {
 public:
  static void add(void* sink, const char* bytes, std::size_t size) noexcept {
    auto& to = *static_cast<Answer*>(sink);
    try {
      if (bytes && size != 0) to.text_.append(bytes, size);
    } catch (...) {
      to.full_ = true;
    }
  }
  /// @throws  std::bad_alloc if there was no memory for it
  std::string text() const {
    if (full_) throw std::bad_alloc();
    return text_;
  }

 private:
  std::string text_;
  bool full_ = false;
};

/// The reason by which breve_files_add_directory says that it ran out of memory.
inline constexpr std::string_view kNoMemory = "there is no memory for it";

/// What the host keeps with a world or an object, and how it goes.
class UserData {
 public:
  UserData() = default;
  UserData(void* data, void (*destroy)(void*)) : data_(data), destroy_(destroy) {}
  UserData(UserData&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), destroy_(std::exchange(other.destroy_, nullptr)) {}
  UserData& operator=(UserData&& other) noexcept {
    if (this == &other) return *this;
    const UserData old(std::move(*this));  // its destroy may replace or move what is here
    data_ = std::exchange(other.data_, nullptr);
    destroy_ = std::exchange(other.destroy_, nullptr);
    return *this;
  }
  ~UserData() { end(); }
  UserData(const UserData&) = delete;
  UserData& operator=(const UserData&) = delete;
  void* get() const { return data_; }

 private:
  void end() noexcept {
    void* const data = std::exchange(data_, nullptr);
    if (const auto destroy = std::exchange(destroy_, nullptr)) destroy(data);
  }

  void* data_ = nullptr;
  void (*destroy_)(void*) = nullptr;
};

/// The data of the object that holds a place in the world's table; `ticket` tells it from those before it.
struct ObjectData {
  std::uint32_t ticket = 0;
  UserData user;
};

/// State of the host that is part of a world.
struct NamedState {
  std::string name;
  breve_state state;
  UserData user;
};

class HostClass;

/// What breve_class.bind gave for one world.
struct Binding {
  explicit Binding(std::shared_ptr<const HostClass> c) : cls(std::move(c)) {}
  ~Binding();
  Binding(const Binding&) = delete;
  Binding& operator=(const Binding&) = delete;

  const std::shared_ptr<const HostClass> cls;
  void* data = nullptr;
  bool bound = false;
};

/// A method of a class of the host that runs; they stand on the C++ stack.
struct ActiveCall {
  const ActiveCall* outer;
  const HostClass* cls;
  const breve_call* call;
  std::size_t depth;  // of the machine
};

/// A method name with keywords, and what they mean for the class that was called last.
struct Selector {
  explicit Selector(std::pmr::memory_resource* memory)
      : method(memory), keywords(memory), order(memory), super_of(memory) {}
  std::pmr::string method;
  std::pmr::vector<std::pmr::string> keywords;
  std::uint32_t check = 0;                        // breve_selector.generation: a digest of the names
  const steve::ClassInfo* cls = nullptr;          // the cache below is for this class
  const steve::MethodInfo* resolved = nullptr;    // takes exactly these keywords; null: ask by keywords
  std::pmr::vector<std::uint32_t> order;          // parameter -> argument
  std::pmr::string super_of;                      // "": a usual call; else one as `super` makes it in that class
  const steve::ClassInfo* super_class = nullptr;  // of that name, while `cls` is set
};

/// The host's answer to which pairs collide.
class MayCollide final : public PairJudge {
 public:
  MayCollide(breve_world& world, breve_may_collide_fn function, void* user)
      : world_(world), function_(function), user_(user) {}
  bool accepts(ObjectId a, ObjectId b) override;

 private:
  breve_world& world_;
  const breve_may_collide_fn function_;
  void* const user_;
};

/// The host's callbacks for events.
class Listener final : public EventListener {
 public:
  Listener(breve_world& world, const breve_listener& functions) : world_(world), functions_(functions) {}
  const breve_listener& functions() const { return functions_; }
  std::uint32_t kinds() const;
  void contact(const ContactEvent& event) override;
  void life(const LifeEvent& event) override;
  void announcement(const AnnouncementEvent& event) override;
  void sleep(const SleepEvent& event) override;
  void intervention(const Intervention& event) override;

 private:
  template <class Event>
  void call(void (*function)(void*, breve_world*, const Event*), const Event& event);

  breve_world& world_;
  const breve_listener functions_;
};

/// A copy of a versioned struct that an older header may have made smaller: fields that it lacks take the defaults.
/// @throws  StatusError if its struct_size is not one that this header or an older one gave
template <class Config>
Config read_config(const Config* given, const Config& defaults, const char* name) {
  if (!given) return defaults;
  const std::size_t size = given->struct_size;
  const auto refuse = [&](const std::string& why) {
    fail(BREVE_ERROR_ARGUMENT, std::string(name) + ".struct_size is " + std::to_string(size) + why);
  };
  if (size < 2 * sizeof(std::size_t) || size % alignof(Config) != 0)
    refuse(" (must be as " + std::string(name) + "_default gives it)");
  if (size > sizeof(Config))
    refuse(", more than this library knows (" + std::to_string(sizeof(Config)) +
           "): the host was compiled with the header of a later one");
  Config config = defaults;
  std::memcpy(&config, given, size);
  config.struct_size = sizeof(Config);
  return config;
}

}  // namespace breve::host

struct breve_runtime {
  std::shared_ptr<breve::host::RuntimeState> state;
  std::vector<breve::host::DiagnosticText> diagnostics;
  breve::steve::AllowedLints allowed;
  breve::steve::ForeignFunctions
      functions;                         // of breve_runtime_add_function; programs keep those they were compiled with
  breve::steve::ForeignClasses classes;  // of breve_runtime_add_class, likewise
  std::vector<breve::host::Plugin> plugins;
  breve::host::Plugin* loading = nullptr;  // whose entry runs
  mutable breve::host::ErrorRecord error;
  int busy = 0;  // compilations and world creations in progress
};

struct breve_program {
  std::shared_ptr<const breve::steve::Program> program;
};

/// Stands in the runtime's memory, and all that it holds in its own. Destroy it while a runtime's state is held.
struct breve_world : breve::InMemory {
  std::shared_ptr<breve::host::RuntimeState> runtime;
  std::shared_ptr<const breve::steve::Program> program;
  breve_world_config config{};
  const std::uint32_t first_generation;  // of its ids, less 1: each world of a runtime begins elsewhere
  breve::MemoryMeter meter;
  mutable std::optional<breve::steve::Profiler> profiler;  // kept when it has stopped, until the next one starts
  bool tracing = false;                                    // a breve_trace_fn runs
  std::unique_ptr<breve::World> world;
  std::unique_ptr<breve::steve::Machine> machine;      // goes before the world
  std::optional<breve::host::MayCollide> may_collide;  // of breve_world_set_may_collide
  std::optional<breve::host::Listener> listener;       // of breve_world_set_listener
  mutable breve::host::ErrorRecord error;
  breve::host::References references;
  std::pmr::deque<breve::host::Selector> selectors;  // a callback may add some while one is in use
  std::pmr::string text;                             // of breve_value_text
  mutable std::pmr::string accuracy_text;            // of breve_world_accuracy_text
  mutable std::pmr::vector<std::pair<std::pmr::string, std::pmr::string>> menu_texts;
  mutable std::pmr::vector<std::pair<std::pmr::string, std::pmr::string>> effect_texts;
  mutable std::pmr::vector<breve::BodyIndex> bulk_bodies;    // of the objects of a call for many; room that is kept
  mutable std::pmr::vector<breve::steve::Slot*> bulk_slots;  // likewise
  mutable std::pmr::vector<double> bulk_numbers;             // likewise
  breve::host::PreviousPoses previous;
  double time_scale = 1;  // of breve_world_advance
  breve::host::UserData user;
  std::vector<std::unique_ptr<breve::host::Binding>> bindings;  // of the program's classes of the host
  std::pmr::vector<breve::host::ObjectData> object_data;        // by index of the object
  std::vector<breve::host::NamedState> states;                  // of the host
  std::pmr::vector<const char*> method_keywords;                // of breve_world_methods, and the two below
  std::pmr::vector<std::uint32_t> method_types;
  std::unique_ptr<bool[]> method_defaults;
  const breve::host::ActiveCall* active = nullptr;  // the innermost
  std::unique_ptr<breve::host::Recorder> recorder;  // of breve_world_record_start
  breve::host::Inputs* inputs = nullptr;            // in an iteration that is recorded or replayed
  std::size_t failed_depth = 0;                     // of the method of the host that failed last
  std::vector<breve::steve::ForeignPlace> failed_places;
  double remainder = 0;   // s, kept by breve_world_advance; in [0, iteration step)
  int running = 0;        // calls of the host that run script, one inside the other
  bool in_state = false;  // a callback of a breve_state runs
  bool in_batch = false;  // breve_batch_run destroys it, and its callbacks may not
  std::uint64_t errors = 0, warnings = 0;

  /// @param number  of the world among those of its runtime
  breve_world(std::shared_ptr<breve::host::RuntimeState> r, std::uint32_t number)
      : runtime(std::move(r)),
        first_generation(breve::host::spread(number)),
        meter(runtime->memory(), taken(sizeof(breve_world))),
        references(&meter),
        selectors(&meter),
        text(&meter),
        accuracy_text(&meter),
        menu_texts(&meter),
        effect_texts(&meter),
        bulk_bodies(&meter),
        bulk_slots(&meter),
        bulk_numbers(&meter),
        previous(&meter),
        object_data(&meter),
        method_keywords(&meter),
        method_types(&meter) {}
};

namespace breve::host {

/// The network that the runtime gives its worlds.
std::shared_ptr<steve::Network> network_of(breve_world& world);
/// Scripts of the world may draw their view, if this build draws.
void let_draw(breve_world& world, steve::MachineHost& host);

/// While it stands the runtime is not to be destroyed.
class CreationScope {
 public:
  explicit CreationScope(breve_runtime& runtime) : runtime_(runtime) { ++runtime_.busy; }
  ~CreationScope() { --runtime_.busy; }
  CreationScope(const CreationScope&) = delete;
  CreationScope& operator=(const CreationScope&) = delete;

 private:
  breve_runtime& runtime_;
};

/// BREVE_ERROR_ARGUMENT for a configuration of a world that cannot be.
void check_world_config(const breve_world_config& config);

/// A world whose controller's `init` has run. Touches of the runtime what any thread may.
/// @param number  of the world among those of the runtime
/// @param error   why there is none
breve_status make_world(const std::shared_ptr<RuntimeState>& state, std::uint32_t number,
                        std::shared_ptr<const steve::Program> program, const breve_world_config* config,
                        ErrorRecord& error, breve_world** world) noexcept;

/// Script runs while this stands. References that hosts hold die at both ends.
class ScriptScope {
 public:
  explicit ScriptScope(breve_world& world);  // BREVE_ERROR_DEPTH if host and script nest too deeply
  ~ScriptScope();
  ScriptScope(const ScriptScope&) = delete;
  ScriptScope& operator=(const ScriptScope&) = delete;

 private:
  breve_world& world_;
  int exceptions_ = std::uncaught_exceptions();
};

/// A callback of the host runs while this stands: the world is busy even if no script runs, as when a function that
/// runs none has a warning to tell. References die at its end.
class CallbackScope {
 public:
  explicit CallbackScope(breve_world& world);
  ~CallbackScope();
  CallbackScope(const CallbackScope&) = delete;
  CallbackScope& operator=(const CallbackScope&) = delete;

 private:
  breve_world& world_;
  bool holds_;  // no script runs: it is this callback that makes the world busy
};

/// A callback of a state of the host runs while this stands, and the states must stay as they are.
class StateScope {
 public:
  explicit StateScope(breve_world& world) : world_(world), before_(std::exchange(world.in_state, true)) {}
  ~StateScope() { world_.in_state = before_; }
  StateScope(const StateScope&) = delete;
  StateScope& operator=(const StateScope&) = delete;

 private:
  breve_world& world_;
  const bool before_;
};

/// Bind what of the program's classes of the host the world has not bound yet, before anything of them runs.
/// StatusError with the host's reason: none of them is bound then.
void bind_classes(breve_world& world, const steve::Program& program);
/// Those that the world's program does not have are unbound.
void unbind_others(breve_world& world);
/// Of objects that are no more.
void forget_data(breve_world& world);

/// Begin a profile; an earlier one is gone. Only while nothing runs.
void start_profile(breve_world& world, breve_trace_fn trace, void* user);

/// What of the runtime's breve_files its machine may ask for.
void open_files(breve_world& world, steve::MachineHost& host);

/// One iteration, recorded or not.
void step(breve_world& world);
/// One iteration, as it is.
void iterate(breve_world& world);

/// The state of a world with that of the host. BREVE_ERROR_UNSUPPORTED if the host cannot save its own.
std::string image_of(const breve_world& world);
std::uint64_t hash_of(const breve_world& world);
/// BREVE_ERROR_IMAGE, and nothing is changed.
void restore_image(breve_world& world, std::string_view image);

/// BREVE_ERROR_BUSY if script of `world` runs now.
void need_idle(const breve_world& world, const char* what);

/// Between the world's ids and the host's, whose generation is the ticket, counted from where this world begins.
breve_object handle_of(const breve_world& world, ObjectId id);
ObjectId id_of(const breve_world& world, breve_object object);  // a live one, or null
inline bool is_null(breve_object object) { return object.generation == 0; }

/// The ticket of an object's id, which is not null.
inline std::uint32_t ticket_of(const breve_world& world, breve_object object) {
  const std::uint64_t ordinal = object.generation - 1 + kGenerations - world.first_generation;
  return static_cast<std::uint32_t>(ordinal % kGenerations + 1);
}

/// A live object's id: BREVE_ERROR_ARGUMENT for null, BREVE_ERROR_STALE for one that is gone.
ObjectId live_id(const breve_world& world, breve_object object);
steve::Instance& live_instance(const breve_world& world, breve_object object);
BodyIndex live_body(const breve_world& world, breve_object object);               // also BREVE_ERROR_NO_BODY
const steve::ClassInfo& class_named(const breve_world& world, const char* name);  // BREVE_ERROR_NOT_FOUND

/// The bodies of many objects, in room that the world keeps: all of them, or an error.
std::span<const BodyIndex> bodies_of(const breve_world& world, const breve_object* objects, std::size_t count);

/// (w, x, y, z), of any length but 0: BREVE_ERROR_ARGUMENT, which names it as `what`.
Quaternion unit_quaternion(const double numbers[4], const char* what);

/// BREVE_ERROR_NOT_FOUND, or BREVE_ERROR_UNSUPPORTED for an array.
const steve::VariableInfo& variable_named(const breve_world& world, const steve::Instance& instance, const char* name);

/// The selector of a handle that is called with so many arguments: BREVE_ERROR_STALE, BREVE_ERROR_ARGUMENT.
Selector& selector_of(breve_world& world, breve_selector handle, const breve_value* arguments, std::size_t count);
steve::Value call_prepared(breve_world& world, steve::Instance& receiver, Selector& selector,
                           const breve_value* arguments);

/// Between breve_value and the machine's values. Strings are copied in; lists and hashes become references.
breve_value to_host(breve_world& world, const steve::Value& value);
steve::Value from_host(breve_world& world, const breve_value& value);

}  // namespace breve::host
