// Where the time of a run goes: a tree of calls. A node is a method, a native, a built-in act or a stage of the world,
// below the node that called it, and apart for each line it was called from. Every entry and every exit reads the clock
// once, and what passed since the last reading belongs to the node that ran meanwhile: so the nodes add up to the whole
// by construction. What passes while nothing is entered is the host's and counts nowhere. A node for what is active
// already is not made: recursion counts in the first one, and the tree stays as small as the program.
//
// Nothing here is state of the simulation: the machine only tells what it does, and takes no decision by it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <memory_resource>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "runtime/world/stage_observer.hpp"
#include "steve/code/program.hpp"
#include "steve/machine/native.hpp"

namespace breve::steve {

/// What a node of a profile stands for.
enum class ProfileKind : std::uint8_t {
  World,     // the root: everything
  Stage,     // of the world's step, and the garbage collection: engine time
  Method,    // written in steve
  Native,    // a method of the class library, written in C++
  Function,  // a built-in function
  Act        // `new`, `free`, `sort`, `print`
};

/// Code of whoever embeds the language, such as a function of another language, as the profiler keeps it.
struct ForeignCode {
  std::pmr::string class_name, name, file;
  std::uint32_t line = 0;
};

/// Something that can be called.
struct Callee {
  ProfileKind kind = ProfileKind::World;
  const void* key = nullptr;
  std::string_view name;               // of what is neither method nor native; a literal, or the program keeps it
  const ClassInfo* cls = nullptr;      // whose method it is; of Act: the class that `new` or `free` is about, or null
  const MethodInfo* method = nullptr;  // Method, Native
  const ForeignCode* code = nullptr;   // of what enter_code entered: a Method, or a Function without a class
  bool foreign = false;                // its calls have the line that set_foreign_line gave

  static Callee of(const MethodInfo& m) {
    return {m.native ? ProfileKind::Native : ProfileKind::Method, &m, {}, m.owner, &m, nullptr, m.foreign != nullptr};
  }
  static Callee of(const breve::steve::Native& f) { return {ProfileKind::Function, &f, f.name, nullptr, nullptr}; }
  static Callee of(const ForeignFunction& f) {
    return {ProfileKind::Function, &f, f.name(), nullptr, nullptr, nullptr, true};
  }
  static Callee of(const ForeignCode& c) {
    return {c.class_name.empty() ? ProfileKind::Function : ProfileKind::Method, &c, c.name, nullptr, nullptr, &c, true};
  }
  bool same_as(const Callee& other) const {
    return key == other.key && kind == other.kind && name.data() == other.name.data();
  }
  /// @param name  a literal
  static Callee act(std::string_view name, const ClassInfo* cls = nullptr) {
    return {ProfileKind::Act, cls ? static_cast<const void*>(cls) : name.data(), name, cls, nullptr};
  }
  static Callee stage(std::string_view name) { return {ProfileKind::Stage, name.data(), name, nullptr, nullptr}; }
};

/// One node as it is read. Texts belong to the programs that the profiler keeps, or are literals.
struct ProfileNode {
  std::size_t parent = 0;  // the root is its own
  ProfileKind kind = ProfileKind::World;
  const char* class_name = "";  // "" for what has no class
  const char* name = "";        // method, function, act or stage
  const char* file = "";        // where a method is declared; "" for the rest
  std::uint32_t line = 0;       // of that declaration
  std::uint32_t call_line = 0;  // of the call, in the file of the calling method; 0 if no script called
  std::uint64_t calls = 0;
  double self_seconds = 0, total_seconds = 0;  // wall time, less what the profiler itself took
};

/// A call begins or ends.
struct TraceEvent {
  bool begins = false;
  double seconds = 0;  // since the profile started, less the time spent in the receiver of these events
  ProfileNode callee;  // its counts and times are 0
};

class Profiler final : public StageObserver {
 public:
  using Trace = std::function<void(const TraceEvent&)>;

  /// Measures what it costs itself, then starts. @throws std::bad_alloc if there is no memory to begin with
  /// @param memory  where the tree takes its bytes. At its end the profile stops, and what runs goes on
  /// @param trace   may be empty; what it throws ends the trace
  Profiler(std::shared_ptr<const Program> program, std::pmr::memory_resource* memory, Trace trace);

  /// The program may have been replaced: nodes refer to what they were made for, and keep it.
  void use(const std::shared_ptr<const Program>& program) {
    if (programs_.back() != program) add_program(program);
  }

  // --- told by the machine ------------------------------------------------------------------------------------------
  /// @param line  of the call in the method that runs, 0 if it was not called by script
  void enter(const Callee& callee, std::uint32_t line) noexcept { enter(callee, line, Clock::now()); }
  void leave() noexcept { leave(Clock::now()); }
  std::size_t depth() const { return depth_; }
  /// Leave whatever was entered since this depth: an exception ended it.
  void unwind(std::size_t depth) noexcept {
    while (depth_ > depth) leave();
  }
  void stage_begins(std::string_view stage, Clock::time_point now) noexcept override {
    enter(Callee::stage(stage), 0, now);
  }
  void stage_ends(Clock::time_point now) noexcept override {
    while (in_code()) leave(now);
    leave(now);
  }

  // --- told by foreign code: what it calls in its own language. A call of a foreign method or function takes back what
  // --- it has entered and not left.
  bool recording() const { return recording_; }
  /// Nothing while nothing is entered. @param key  stands for the code in this profile: texts are copied once
  void enter_code(const void* key, std::string_view class_name, std::string_view name, std::string_view file,
                  std::uint32_t line) noexcept;
  /// Leave what was entered by enter_code last; nothing if something else was entered since.
  void leave_code() noexcept {
    if (in_code()) leave();
  }
  /// Where the running foreign code makes its next call.
  void set_foreign_line(std::uint32_t line) { foreign_line_ = line; }

  // --- read when nothing runs ---------------------------------------------------------------------------------------
  void stop() noexcept { recording_ = false; }
  bool out_of_memory() const { return out_of_memory_; }
  bool full() const { return full_; }  // kMostNodes were reached: what needs a new one counts in its caller
  /// The nodes in the order of a walk from the root: parents first. @throws std::bad_alloc
  std::size_t node_count();
  ProfileNode node(std::size_t index);
  /// What the profiler itself took, s: kept out of the nodes, estimated from what an empty call costs.
  double overhead_seconds();
  std::uint64_t events() const { return events_; }  // entries and exits so far

  static constexpr std::size_t kMostNodes = 100'000;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;
  struct Node {
    Callee callee;
    const Program* program = nullptr;
    std::uint32_t line = 0;  // of the call
    std::uint32_t parent = kNone, first_child = kNone, last_child = kNone, next = kNone;
    std::uint32_t hint = kNone;    // the child entered last
    std::uint32_t target = kNone;  // itself; for a call of what is active already: that node
    std::uint64_t calls = 0;
    std::int64_t own = 0;  // ns
  };
  struct Row {  // of the result: one for each node that is its own target
    std::uint32_t node = 0;
    std::size_t parent = 0;
    std::uint64_t calls = 0;
    double self = 0, total = 0;  // s
  };

  bool in_code() const { return recording_ && !stack_.empty() && nodes_[stack_.back()].callee.code; }
  void enter(const Callee& callee, std::uint32_t line, Clock::time_point now) noexcept;
  void leave(Clock::time_point now) noexcept;
  void charge(Clock::time_point now) {
    nodes_[current_].own += std::chrono::duration_cast<std::chrono::nanoseconds>(now - last_).count();
    last_ = now;
  }
  std::uint32_t child(const Callee& callee, std::uint32_t line);
  std::uint32_t add_child(const Callee& callee, std::uint32_t line);
  std::uint32_t active(const Callee& callee) const;
  bool renew(Node& node, const Callee& callee) const;
  void add_program(const std::shared_ptr<const Program>& program);
  void tell(bool begins, std::uint32_t node, Clock::time_point now) noexcept;
  void measure_itself();
  void clear();
  void work_out();
  ProfileNode describe(const Node& node) const;

  Trace trace_;
  std::pmr::vector<std::shared_ptr<const Program>> programs_;
  std::pmr::vector<Node> nodes_;
  std::pmr::vector<std::uint32_t> stack_;  // entered nodes
  std::pmr::unordered_map<const void*, ForeignCode> code_;
  std::uint32_t foreign_line_ = 0;
  std::uint32_t current_ = 0;
  std::size_t depth_ = 0;  // entries without their exit, also while nothing is recorded
  Clock::time_point start_, last_;
  Clock::duration receiving_{};  // time spent in trace_
  bool recording_ = true, telling_ = false, out_of_memory_ = false, full_ = false;
  std::uint64_t events_ = 0;
  // ns that an empty call adds to its own node and to its caller's
  double inner_cost_ = 0, outer_cost_ = 0;
  // the result as last worked out
  std::pmr::vector<Row> rows_;
  std::uint64_t worked_out_at_ = 0;  // events_ then, plus 1; 0: never
  double overhead_ = 0;
};

/// Enters for a scope; nothing without a profiler.
class ProfileScope {
 public:
  ProfileScope(Profiler* profiler, const Callee& callee, std::uint32_t line) : profiler_(profiler) {
    if (!profiler_) return;
    depth_ = profiler_->depth();
    profiler_->enter(callee, line);
  }
  /// For a foreign call: what its code enters is left with it. @param function  null: it is entered already
  ProfileScope(Profiler* profiler, const ForeignFunction* function, std::uint32_t line) : profiler_(profiler) {
    if (!profiler_) return;
    depth_ = profiler_->depth();
    if (function) profiler_->enter(Callee::of(*function), line);
  }
  ~ProfileScope() {
    if (profiler_) profiler_->unwind(depth_);
  }
  ProfileScope(const ProfileScope&) = delete;
  ProfileScope& operator=(const ProfileScope&) = delete;

 private:
  Profiler* profiler_;
  std::size_t depth_ = 0;
};

}  // namespace breve::steve
