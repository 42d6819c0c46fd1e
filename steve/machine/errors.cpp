// Run-time errors on their way out of the interpreter, and what the reporter gets of them.
#include <fmt/format.h>

#include <algorithm>

#include "steve/code/wording.hpp"
#include "steve/machine/machine.hpp"

namespace breve::steve {

Span Machine::span_of(const Frame& frame, const Instruction* pc) const {
  const auto& function = *frame.method->function;
  auto at = pc - function.code.data();
  if (at > 0) --at;  // pc stands behind the instruction that runs
  if (at < 0 || at >= static_cast<std::ptrdiff_t>(function.spans.size())) return frame.method->span;
  return function.spans[static_cast<std::size_t>(at)];
}

// The innermost frame of a call whose arguments are still being converted: its slots hold anything. Such a frame has
// run nothing yet, and the interpreter's place is still that of the call in the caller.
bool Machine::half_made(const Frame& frame, const Instruction* pc) const {
  return &frame == frame_ && frame.caller != nullptr && frame.pc == frame.function->code.data() &&
         pc == frame.caller->pc;
}

std::vector<ActiveCall> Machine::active_calls(const Instruction* pc) const {
  std::vector<ActiveCall> calls;
  for (const Frame* frame = frame_; frame; frame = frame->caller) {
    if (pc && half_made(*frame, pc)) continue;
    const auto* registers = reinterpret_cast<const Slot*>(frame + 1);
    calls.push_back({frame->method, frame->self, registers, span_of(*frame, frame == frame_ && pc ? pc : frame->pc)});
  }
  std::reverse(calls.begin(), calls.end());
  return calls;
}

ErrorReport Machine::report(const RunError& error, const Instruction* pc) const {
  return reporter_.report(error, active_calls(pc), *program_);
}

void Machine::rethrow(std::size_t depth, const Instruction* pc) {
  // Also where there is no memory for the report.
  struct AtTheEnd {
    Machine& machine;
    std::size_t depth;
    ~AtTheEnd() { machine.unwind(depth); }
  } at_the_end{*this, depth};
  const auto wrap = [&](ErrorCode code, const RunError& error) {
    auto r = report(error, pc);
    unwind(depth);
    throw ScriptError(code, std::move(r));
  };
  try {
    throw;
  } catch (const ScriptError&) {
    unwind(depth);
    throw;
  } catch (const RunError& error) {
    const auto code = error.kind() == RunErrorKind::Budget        ? ErrorCode::Budget
                      : error.kind() == RunErrorKind::Depth       ? ErrorCode::Depth
                      : error.kind() == RunErrorKind::Interrupted ? ErrorCode::Interrupted
                                                                  : ErrorCode::Script;
    wrap(code, error);
  } catch (const Error& error) {
    // What the world has no more of, or only a defect of ours makes happen, is not a mistake of the script, which
    // could go on after one.
    const bool kept =
        error.code() == ErrorCode::Memory || error.code() == ErrorCode::Budget || error.code() == ErrorCode::Internal;
    wrap(kept ? error.code() : ErrorCode::Script, RunError(RunErrorKind::World, error.what()));
  } catch (const std::bad_alloc&) {
    throw_out_of_memory(depth, pc);
  }
  throw Error(ErrorCode::Script, "unreachable");
}

// The position is included if there is memory left for it.
void Machine::throw_out_of_memory(std::size_t depth, const Instruction* pc) {
  ErrorReport r;
  try {
    r = report(RunError(RunErrorKind::World, "the world has no more memory",
                        "raise its memory limit, or keep fewer objects and shorter lists"),
               pc);
  } catch (const std::bad_alloc&) {
    r = {};
    r.message = "the world has no more memory";
    r.text = "error: the world has no more memory\n";
  }
  unwind(depth);
  throw ScriptError(ErrorCode::Memory, std::move(r));
}

void Machine::print(std::string_view text) {
  refuse_in_stage("print");
  if (!host_.print) return;
  constexpr std::uint64_t kBytesPerIteration = 16;
  charge(1 + text.size() / kBytesPerIteration);
  reporter_.print(text);
}

namespace {
constexpr std::uint64_t kOfError = 500;  // loop iterations: to leave the calls of one, and to say what is wrong
}

void Machine::survive(const RunError& error) {
  reporter_.tell(Severity::Error, [&] { return report(error, running()).text; });
  charge(kOfError);
}

void Machine::survive(const ScriptError& error) {
  reporter_.tell(Severity::Error, [&] { return error.report().text; });
  charge(kOfError);
}

std::string Machine::stack_trace() const {
  std::string out;
  std::size_t number = 0;
  for (const ActiveCall& call : active_calls())
    out += fmt::format("{}. {} (0x{:x}) {} {}:{}\n", number++, call.self->cls->name, call.self->serial,
                       program_->symbols().name(call.method->name), program_->sources().file(call.span.file).name,
                       call.span.line);
  return out;
}

/// The innermost running statement of the program's own files; line 0: there is none.
Span Machine::location_of_caller() const {
  for (const Frame* frame = frame_; frame; frame = frame->caller)
    if (const auto span = span_of(*frame, frame->pc); !program_->sources().file(span.file).embedded) return span;
  return {};
}

void Machine::warn(std::string_view text) {
  reporter_.tell(Severity::Warning, [&] {
    return format({Severity::Warning, "run-time", std::string(text), {}, location_of_caller()}, program_->sources());
  });
}

void Machine::report_unknown_method(Severity severity, const Instance& self, std::string_view method,
                                    std::string_view consequence) {
  if (severity != Severity::Error && !reporter_.is_first(self.cls->name + " " + std::string(method))) return;
  reporter_.tell(severity, [&] {
    return format(
        {severity, "run-time", fmt::format("class {} has no method '{}': {}", self.cls->name, method, consequence),
         unknown_method_help(method, self.cls, *program_), location_of_caller()},
        program_->sources());
  });
}

}  // namespace breve::steve
