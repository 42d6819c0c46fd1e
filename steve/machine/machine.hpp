// One program running in one world: heap, frames, interpreter, and the calls between scripts and native code.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/poll.hpp"
#include "runtime/world/world.hpp"
#include "steve/code/bytecode.hpp"
#include "steve/code/program.hpp"
#include "steve/machine/budget.hpp"
#include "steve/machine/handler_methods.hpp"
#include "steve/machine/heap.hpp"
#include "steve/machine/machine_host.hpp"
#include "steve/machine/native.hpp"
#include "steve/machine/reporter.hpp"

namespace breve::steve {

class Fragments;
class Profiler;

class Machine final : public Behaviour, public RootSource, public InMemory {
 public:
  Machine(std::shared_ptr<const Program> program, World& world, std::pmr::memory_resource* memory, MachineHost host);
  ~Machine() override;

  World& world() { return world_; }
  Heap& heap() { return *heap_; }
  const Program& program() const { return *program_; }
  MachineHost& host() { return host_; }

  /// Make the controller and run its `init` chain. Once, before the first step.
  void start();
  Instance* controller() const { return controller_; }
  /// From now on tell `profiler` what runs, or nobody (null). Only while nothing runs; not owned. See profiler.hpp.
  void set_profiler(Profiler* profiler);

  // --- while it runs ------------------------------------------------------------------------------------------------
  /// Run statements as though they stood in a method of `self`'s class (evaluate.cpp). The value is that of the last
  /// one if it is an expression, or what `return` gives. ScriptError{Compile} with all errors.
  Value evaluate(Instance& self, std::string_view text);
  /// The variables that evaluated statements have made, by name; null: none yet.
  HashCell* session() const { return session_; }
  HashCell* make_session();
  /// Let another program take the place of this one, all or nothing; only while nothing runs (reload.hpp).
  /// @return  warnings about values that could not be kept
  std::vector<std::string> reload(std::shared_ptr<const Program> program);
  /// Stop what runs, at the next call or loop iteration that is checked. For signal handlers and other threads.
  void interrupt() noexcept { interrupted_.store(true, std::memory_order_relaxed); }
  /// The host calls, or an iteration begins: what runs from now on shares one budget, and old interrupts are forgotten.
  void begin_run();
  /// Count the work of native code as this many loop iterations. RunError{Budget} if the budget is used up,
  /// {Interrupted} by the host.
  void charge(std::uint64_t iterations) override;
  void expect(std::uint64_t iterations) override;
  /// Is there a budget at all?
  bool bounded() const { return host_.budget != 0 || host_.call_budget != 0; }
  /// `poll` for the work of the runtime.
  const Poll& poller() const { return poller_; }
  /// Within long work that is charged already: RunError{Interrupted} if the host wants the end.
  void poll() {
    if (interrupted_.load(std::memory_order_relaxed)) fail_interrupted();
  }
  /// The same, of work that looks at so many elements (numbers, pixels, cells, values of a list): about sixteen take
  /// as long as a loop iteration. Before the work, where it is known, so that what exceeds the budget does not begin.
  void charge_for(std::uint64_t elements) {
    constexpr std::uint64_t kElementsPerIteration = 16;
    if (elements >= kElementsPerIteration) charge(elements / kElementsPerIteration);
  }

  // --- objects ------------------------------------------------------------------------------------------------------
  /// A new instance with its `init` chain run. RunError if `init` fails or frees it.
  Instance* create(const ClassInfo& cls);
  /// What `free` does. A null, freed or being-freed instance: nothing.
  void free_instance(Instance& instance);
  /// The same without script: of an instance that the program has never met.
  void discard_instance(Instance& instance);
  Instance* instance(ObjectId id) const;  // null if the id is null or stale
  ObjectId id_of(const Instance* instance) const { return instance && instance->live() ? instance->id : ObjectId{}; }

  // --- calls from native code ----------------------------------------------------------------------------------------
  /// The method of `cls` or an ancestor with this name and exactly `count` parameters; null if there is none.
  const MethodInfo* find_method(const ClassInfo& cls, std::string_view name, std::size_t count) const;
  bool responds(const ClassInfo& cls, std::string_view name) const;  // any number of parameters
  /// Call by position; arguments are converted to the parameters' types. RunError passes through.
  Value call(Instance& receiver, const MethodInfo& method, std::span<const Value> arguments = {});
  /// As above; RunError{UnknownMethod} if there is none with that many parameters.
  Value call(Instance& receiver, std::string_view method, std::span<const Value> arguments = {});
  /// Call, report an error as one that does not stop the run, and go on. False if there was an error.
  bool call_guarded(Instance& receiver, const MethodInfo& method, std::span<const Value> arguments, Value& result);
  /// Call with keywords, as a script would.
  /// @param super_of  not null: as `super` does in a method of that class, which is the receiver's or an ancestor
  Value call_with_keywords(Instance& receiver, std::string_view method,
                           std::span<const std::pair<std::string_view, Value>> keywords,
                           const ClassInfo* super_of = nullptr);
  std::size_t depth() const { return depth_; }  // active methods

  /// What `random[bound]` gives (slow_paths.cpp).
  Value random(const Value& bound);

  // --- variables of instances ----------------------------------------------------------------------------------------
  Value get_variable(const Instance& instance, const VariableInfo& variable) const;
  void set_variable(Instance& instance, const VariableInfo& variable, const Value& value);  // converts, checks class

  // --- talking -------------------------------------------------------------------------------------------------------
  /// RunError{Bounds} where an iteration or a call by the host has printed too much.
  void print(std::string_view text);
  /// A warning with the place of the running statement in front. Of warnings and errors that do not stop the run the
  /// first thousand of an iteration, or of a call by the host, are reported.
  void warn(std::string_view text);
  /// The same, at most once per world for each `key`.
  /// @param text  the text, or a function that makes it: called only where it is reported, since programs do what they
  ///              are warned of in each iteration
  template <class Text>
  void warn_once(std::string_view key, const Text& text) {
    if (!reporter_.is_first(key)) return;
    if constexpr (std::is_invocable_v<Text>)
      warn(text());
    else
      warn(text);
  }
  /// Say, at the place of the running statement, that `self` has no such method and which may be meant. An error
  /// is reported each time, a warning once for each class.
  /// @param consequence  "nothing is registered"
  void report_unknown_method(Severity severity, const Instance& self, std::string_view method,
                             std::string_view consequence);
  [[noreturn]] static void fail(RunErrorKind kind, const std::string& message) { throw RunError(kind, message); }
  std::string text(const Value& v);  // as `print` shows it, asking objects for their get-description
  std::string stack_trace() const;   // one line per active method, outermost first
  /// Report an error that does not stop the run, with the place of the running statement.
  void survive(const RunError& error);
  [[noreturn]] void fail_unknown_class(std::string_view name) const;
  /// RunError{World} inside a force method, which runs at stages that may be tried again. `what` is what it does.
  void refuse_in_stage(std::string_view what) const {
    if (in_stage_) [[unlikely]]
      fail_in_stage(what);
  }

  // --- Behaviour, RootSource -----------------------------------------------------------------------------------------
  void iterate(ObjectId agent) override;
  void post_iterate(ObjectId agent) override;
  void scheduled(ObjectId agent, std::string_view method) override;
  bool collided(ObjectId agent, ObjectId other, std::string_view method, const Vector3& point,
                const Vector3& normal) override;
  bool may_collide(ObjectId agent, ObjectId other) override;
  void notified(ObjectId observer, std::string_view method, ObjectId announcer, std::string_view message) override;
  Vector3 stage_force(ObjectId agent, double time, std::uint64_t draw) override;
  void input(const InputEvent& event) override;
  void end_of_iteration() override;
  void save(ByteWriter& out) const override;
  void load(ByteReader& in) override;
  void hash(Hasher& hasher) const override;
  void visit_frames(const std::function<void(Cell*)>& visit) override;
  void visit_roots(const std::function<void(Cell*)>& visit) override;
  void free_unreachable(Instance& instance) override;

 private:
  friend class Pin;
  friend class Reload;
  class FragmentScope;

  /// What a call site does with its arguments for one class of receiver.
  struct PlanStep {
    enum class Kind : std::uint8_t { Copy1, Copy3, Copy9, IntToDouble, DoubleToInt, Convert, Default } kind;
    StaticType from_type;
    std::uint16_t from, to;
    bool checked;  // the parameter names a class
    const ParameterInfo* parameter;
  };
  struct Plan : InMemory {
    explicit Plan(std::pmr::memory_resource* memory) : moves(memory), steps(memory), order(memory) {}
    const ClassInfo* cls = nullptr;
    const MethodInfo* method = nullptr;  // null: `iterate`, which nobody has to have
    struct Move {
      std::uint16_t from, to;
      bool widens;  // an int becomes a double
    };
    std::pmr::vector<Move> moves;           // one slot each
    std::pmr::vector<PlanStep> steps;       // the rest
    std::pmr::vector<std::uint16_t> order;  // arguments in the order of the parameters
    std::unique_ptr<Plan> next;             // of the same site, for another class
  };
  struct SiteCache {
    const ClassInfo* cls = nullptr;
    const Plan* plan = nullptr;
    std::unique_ptr<Plan> plans;
  };
  /// One active method. It stands in the slots right below its registers, so that a call allocates nothing.
  struct Frame {
    Frame* caller;
    const MethodInfo* method;
    const Function* function;
    const Instruction* pc;  // as of the last call or slow instruction
    Instance* self;
    Slot* saved_top;
    std::uint64_t saved_segment;
    Slot* base() { return reinterpret_cast<Slot*>(this + 1); }
  };
  static constexpr std::size_t kNativeRoom = 64;  // slots for a native's arguments

  /// Restores the top of the stack and the pins at the end of a call into native code.
  class StackMark {
   public:
    explicit StackMark(Machine& m)
        : machine_(m), top_(m.top_), limit_(m.limit_), segment_(m.segment_), pins_(m.pins_.size()) {}
    ~StackMark() {
      machine_.top_ = top_;
      machine_.limit_ = limit_;
      machine_.segment_ = segment_;
      machine_.pins_.resize(pins_);
    }
    StackMark(const StackMark&) = delete;
    StackMark& operator=(const StackMark&) = delete;

   private:
    Machine& machine_;
    Slot* top_;
    Slot* limit_;
    std::uint32_t segment_;
    std::size_t pins_;
  };

  /// One interpreter loop more on the C++ stack.
  struct Nest {
    std::uint32_t& nesting;
    explicit Nest(std::uint32_t& n) : nesting(n) { ++nesting; }
    ~Nest() { --nesting; }
    Nest(const Nest&) = delete;
    Nest& operator=(const Nest&) = delete;
  };
  static constexpr std::uint32_t kMaxNesting = 400;

  // frames (frames.cpp)
  /// A new frame; parameters are still to be written.
  Frame* enter(const MethodInfo& method, Instance& self) {
    if (depth_ >= host_.depth_limit) [[unlikely]]
      fail_depth(method);
    const auto& function = *method.function;
    Slot* const saved_top = top_;
    const auto saved_segment = segment_;
    need_room(sizeof(Frame) / sizeof(Slot) + function.frame_slots + kNativeRoom);
    auto* frame = new (static_cast<void*>(top_))
        Frame{frame_, &method, &function, function.code.data(), &self, saved_top, saved_segment};
    frame_ = frame;
    ++depth_;
    Slot* base = frame->base();
    for (std::uint32_t i = function.parameter_slots; i < function.zeroed_slots; ++i) base[i].bits = 0;
    top_ = base + function.frame_slots;
    return frame;
  }
  void leave() {
    const Frame* frame = frame_;
    frame_ = frame->caller;
    --depth_;
    top_ = frame->saved_top;
    if (frame->saved_segment != segment_) [[unlikely]] {
      segment_ = static_cast<std::uint32_t>(frame->saved_segment);
      limit_ = segments_[segment_].first + segments_[segment_].second;
    }
  }
  void need_room(std::size_t slots) {
    if (static_cast<std::size_t>(limit_ - top_) < slots) [[unlikely]]
      next_segment(slots);
  }
  void next_segment(std::size_t slots);
  [[noreturn]] void fail_depth(const MethodInfo& method) const;
  void unwind(std::size_t depth);

  // interpreter.cpp
  template <bool kProfiled>
  void execute(std::size_t depth);  // run the top frame until `depth` frames are left

  // frames.cpp
  Value invoke(Instance& receiver, const MethodInfo& method, std::span<const Value> arguments);
  void write_parameter(Slot* base, const ParameterInfo& parameter, const Value& value, std::string_view what);
  void write_default(Slot* to, const ParameterInfo& parameter);
  void write_value(Slot* to, StaticType type, const Value& value, std::string_view what);

  // calls (calls.cpp)
  const Plan& plan_for(std::uint32_t site, const ClassInfo& cls) {
    const auto& cache = caches_[site];
    return cache.cls == &cls ? *cache.plan : find_plan(site, cls);
  }
  const Plan& find_plan(std::uint32_t site, const ClassInfo& cls);
  const Plan& make_plan(std::uint32_t site, const ClassInfo& cls);
  const MethodInfo* choose(const CallSite& site, const ClassInfo& cls) const;
  static bool accepts(const MethodInfo& method, const CallSite& site);

  // foreign.cpp
  void call_foreign(std::size_t number, Instance& self, const Slot* args);  // leaves the result register

  // call_errors.cpp
  [[noreturn]] void fail_call(const CallSite& site, const ClassInfo& cls, const MethodInfo* best) const;
  [[noreturn]] void fail_unknown_method(const CallSite& site, const ClassInfo* start) const;
  /// The expression before a selector, as it is written, and where it comes from if it is a variable.
  struct Receiver {
    std::string text;
    Span span;
    enum class Kind { Variable, Parameter, Expression } kind = Kind::Expression;
    const VariableInfo* member = nullptr;  // Variable of the instance
  };
  Receiver receiver_of_site(const Span& selector) const;
  std::optional<std::string> where_assigned(const Receiver& receiver) const;
  mutable std::uint64_t searched_ = 0;  // bytes of text, by where_assigned
  const CallSite* broadcast_site() const;
  void apply(const Plan& plan, const Slot* caller, Slot* callee) {
    for (const auto& move : plan.moves) {
      if (move.widens)
        callee[move.to].d = caller[move.from].i;
      else
        callee[move.to].bits = caller[move.from].bits;
    }
    if (!plan.steps.empty()) apply_steps(plan, caller, callee);
  }

  // calls.cpp
  void apply_steps(const Plan& plan, const Slot* caller, Slot* callee);
  void convert_argument(const PlanStep& step, const Slot* caller, Slot* callee);
  void call_native(const Plan& plan, Instance& receiver, const Slot* caller);
  void check_class(Instance* object, const ClassInfo& cls, std::string_view what);

  // call_errors.cpp
  [[noreturn]] void fail_receiver(const Instance* receiver, std::uint32_t site) const;

  // slow instructions (slow_paths.cpp)
  Value null_default(StaticType type, std::uint32_t what, const Instruction* pc);
  Slot converted_reference(StaticType type, const Value& value, std::uint32_t what, bool strict, const Instruction* pc);
  Value read_member(const Value& base, const MemberSite& site);
  bool write_member(Value& base, const MemberSite& site, const Value& value);  // true: a container, changed in place
  bool write_index(Value& base, const Value& key, const Value& value);
  Value read_index(const Value& base, const Value& key);
  Value guarded_index(const Value& base, const Value& key);
  std::string describe(Instance& instance);
  Value make_many(const Value& count, const ClassInfo& cls);
  ListCell* all_of(const ClassInfo& cls);
  void make_cells_of(const ClassInfo& cls);

  // machine.cpp
  void end_native(Instance& instance) noexcept;

  // slow_paths.cpp
  void free_value(const Value& value);
  void sort(ListCell& list, Symbol method, Instance& self);
  bool comes_before(Instance& self, const MethodInfo& method, const Value& a, const Value& b);
  void write_argument(Slot* base, const ParameterInfo& parameter, const Value& value);
  StringCell* interpolate(const std::vector<std::string>& texts, const Value* values, std::size_t count);
  void print_value(const Value& value, int ending);
  const VariableInfo* member_variable(const Instance& instance, Symbol name) const;
  Instance& need_live(const Value& base, std::string_view name) const;

  // what is running, and errors in it (errors.cpp)
  /// @param pc  where the innermost call is; null: as of its last call or slow instruction
  std::vector<ActiveCall> active_calls(const Instruction* pc = nullptr) const;
  bool half_made(const Frame& frame, const Instruction* pc) const;
  ErrorReport report(const RunError& error, const Instruction* pc) const;
  [[noreturn]] void rethrow(std::size_t depth, const Instruction* pc);  // from inside a catch block
  [[noreturn]] void throw_out_of_memory(std::size_t depth, const Instruction* pc);
  void survive(const ScriptError& error);
  Span span_of(const Frame& frame, const Instruction* pc) const;
  Span location_of_caller() const;
  const Instruction* running() const { return frame_ ? frame_->pc : nullptr; }

  // machine.cpp
  void input_key(const InputEvent& event);
  void call_if_present(Instance& receiver, std::string_view method, std::span<const Value> arguments = {});

  // stage_force.cpp
  [[noreturn]] static void fail_in_stage(std::string_view what);
  void count_call() {
    if (budget_.count_iteration()) [[unlikely]]
      end_of_piece();
  }

  // machine.cpp
  void end_of_piece();
  void look_at_the_clock();

  // settings.cpp
  void apply_settings(Instance& controller);

  // slow_paths.cpp
  /// A binary operator whose operands have no short way.
  /// @param absent_is_zero  an operand without a value counts as 0, and nothing is said: h{k} += 1
  Value calculate(ast::BinaryOp op, const Value& x, const Value& y, bool absent_is_zero, const Instruction* pc);

  // machine.cpp
  void budget_heap(Heap& heap) {
    heap.set_budget(&budget_, [this] { settle(); });
    heap.set_ended(&interrupted_);
  }
  void settle();
  [[noreturn]] void fail_budget() const;
  [[noreturn]] void fail_interrupted();
  template <class Body>
  void called_by_world(Body&& body);  // with a budget of its own; being cut does not end the iteration

  // told to the profiler, if there is one (profiled.cpp)
  std::uint32_t running_line() const;  // of the innermost frame's call, 0 without one
  std::size_t profile_depth() const;
  void profile_call(const MethodInfo& method);
  void profile_leave();
  void profile_unwind(std::size_t depth);
  void call_native_profiled(const Plan& plan, Instance& receiver, const Slot* caller);
  void call_function_profiled(const Native& function, Instance& self, const Slot* args, Value& result);
  void reclaim_profiled();

  // snapshot.cpp
  void check_loaded(const HashCell* session, const Instance* controller) const;
  void name_objects(std::span<Instance* const> instances);

  // machine.cpp
  static std::pmr::vector<StringCell*> make_constants(Heap& heap, const Program& program);
  void choose_menu(ObjectId item);
  void forget(Instance& instance);
  Value default_value(const ParameterInfo& parameter);

  // call_errors.cpp
  Instance* broadcast_member(const Value& element) const;
  [[noreturn]] void fail_call_on(const Value& value) const;
  [[noreturn]] void fail_null_receiver(const CallSite& site) const;
  [[noreturn]] void fail_member(std::string_view name, const Instance* object) const;

  std::shared_ptr<const Program> program_;
  World& world_;
  MachineHost host_;
  std::pmr::memory_resource* memory_;
  std::unique_ptr<Heap> heap_;
  Instance* controller_ = nullptr;
  Profiler* profiler_ = nullptr;
  Value result_;            // of the last call
  Frame* frame_ = nullptr;  // the innermost
  std::size_t depth_ = 0;
  std::pmr::vector<std::pair<Slot*, std::size_t>> segments_;
  std::uint32_t segment_ = 0;
  Slot* top_ = nullptr;
  Slot* limit_ = nullptr;
  std::pmr::vector<Value> pins_;
  std::pmr::vector<SiteCache> caches_;
  HandlerMethods handler_methods_;         // of the program
  std::pmr::vector<StringCell*> strings_;  // the program's constants
  std::span<const Native> functions_;
  Reporter reporter_;
  bool in_stage_ = false;  // a force method runs
  Budget budget_;
  std::atomic<bool> interrupted_{false};
  const Poll poller_ = [this] { poll(); };
  std::chrono::steady_clock::time_point run_began_{};  // if there is a limit to patience
  std::unique_ptr<Fragments> fragments_;               // once something was evaluated
  HashCell* session_ = nullptr;
  std::uint32_t nesting_ = 0;  // interpreter loops on the C++ stack
};

/// Keeps a value alive while native code that holds it calls back into script.
class Pin {
 public:
  Pin(Machine& machine, const Value& value) : machine_(machine) { machine_.pins_.push_back(value); }
  ~Pin() { machine_.pins_.pop_back(); }
  Pin(const Pin&) = delete;
  Pin& operator=(const Pin&) = delete;

 private:
  Machine& machine_;
};

}  // namespace breve::steve
