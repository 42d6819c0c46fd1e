// One program running in one world: heap, frames, interpreter, and the calls between scripts and native code.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/world/world.hpp"
#include "steve/compile/program.hpp"
#include "steve/machine/heap.hpp"
#include "steve/machine/native.hpp"

namespace breve::steve {

/// What a machine needs from whoever embeds it. Every member may be empty.
struct MachineHost {
  std::function<void(std::string_view text)> print;            // what scripts print, as written
  std::function<void(std::string_view text)> warn;             // one warning, one or more whole lines
  std::function<void(std::string_view text)> error;            // a run-time error that did not stop the run (F27)
  std::function<std::string(std::string_view name)> find_file; // path of a data file (images, sounds), "" if none
  std::vector<std::string> arguments;                          // [0] is the program file
  bool verbose = false;                                        // say once when an obsolete selector is used
  bool strict = false;
  std::uint32_t depth_limit = 5000;                            // nested calls
  std::uint64_t budget = 0;  // loop back-edges and calls per call from the host or iteration; 0 = none
};

class Machine final : public Behaviour, public RootSource {
 public:
  Machine(std::shared_ptr<const Program> program, World& world, std::pmr::memory_resource* memory, MachineHost host);
  ~Machine() override;

  World& world() { return world_; }
  Heap& heap() { return heap_; }
  const Program& program() const { return *program_; }
  MachineHost& host() { return host_; }

  /// Make the controller and run its `init` chain. Once, before the first step.
  void start();
  Instance* controller() const { return controller_; }

  // --- objects ------------------------------------------------------------------------------------------------------
  /// A new instance with its `init` chain run. RunError if `init` fails or frees it.
  Instance* create(const ClassInfo& cls);
  /// What `free` does (language, 10.1). A null, freed or being-freed instance: nothing.
  void free_instance(Instance& instance);
  Instance* instance(ObjectId id) const;  // null if the id is null or stale
  ObjectId id_of(const Instance* instance) const { return instance && instance->live() ? instance->id : ObjectId{}; }

  // --- calls from native code -----------------------------------------------------------------------------------------
  /// The method of `cls` or an ancestor with this name and exactly `count` parameters; null if there is none.
  const MethodInfo* find_method(const ClassInfo& cls, std::string_view name, std::size_t count) const;
  bool responds(const ClassInfo& cls, std::string_view name) const;  // any number of parameters
  /// Call by position; arguments are converted to the parameters' types. RunError passes through.
  Value call(Instance& receiver, const MethodInfo& method, std::span<const Value> arguments = {});
  /// As above; RunError{UnknownMethod} if there is none with that many parameters.
  Value call(Instance& receiver, std::string_view method, std::span<const Value> arguments = {});
  /// Call, report an error as one that does not stop the run, and go on (F27). False if there was an error.
  bool call_guarded(Instance& receiver, const MethodInfo& method, std::span<const Value> arguments, Value& result);
  /// Call with keywords, as a script would.
  Value call_with_keywords(Instance& receiver, std::string_view method,
                           std::span<const std::pair<std::string_view, Value>> keywords);

  // --- variables of instances ------------------------------------------------------------------------------------------
  Value get_variable(const Instance& instance, const VariableInfo& variable) const;
  void set_variable(Instance& instance, const VariableInfo& variable, const Value& value);  // converts, checks class

  // --- talking ---------------------------------------------------------------------------------------------------------
  void print(std::string_view text) {
    if (host_.print) host_.print(text);
  }
  /// A warning with the place of the running statement in front.
  void warn(std::string_view text);
  /// The same, at most once per world for each `key`.
  void warn_once(std::string_view key, std::string_view text);
  [[noreturn]] static void fail(RunErrorKind kind, const std::string& message) { throw RunError(kind, message); }
  std::string text(const Value& v);  // as `print` shows it, asking objects for their get-description
  std::string stack_trace() const;   // one line per active method, outermost first

  // --- Behaviour, RootSource ---------------------------------------------------------------------------------------------
  void iterate(ObjectId agent) override;
  void post_iterate(ObjectId agent) override;
  void scheduled(ObjectId agent, std::string_view method) override;
  bool collided(ObjectId agent, ObjectId other, std::string_view method, const Vector3& point,
                const Vector3& normal) override;
  void notified(ObjectId observer, std::string_view method, ObjectId announcer, std::string_view message) override;
  void input(const InputEvent& event) override;
  void end_of_iteration() override;
  void save(ByteWriter& out) const override;
  void load(ByteReader& in) override;
  void hash(Hasher& hasher) const override;
  void visit_frames(const std::function<void(Cell*)>& visit) override;
  void visit_roots(const std::function<void(Cell*)>& visit) override;
  void free_unreachable(Instance& instance) override;

 private:
  std::shared_ptr<const Program> program_;
  World& world_;
  MachineHost host_;
  Heap heap_;
  Instance* controller_ = nullptr;
};

}  // namespace breve::steve
