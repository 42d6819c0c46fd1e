// Run-time errors: where they happened, through which calls, and what the reader can do about it.
#include <fmt/format.h>

#include <algorithm>

#include "steve/code/wording.hpp"
#include "steve/machine/machine.hpp"
#include "steve/machine/trace.hpp"

namespace breve::steve {

Span Machine::span_of(const Frame& frame, const Instruction* pc) const {
  const auto& function = *frame.method->function;
  auto at = pc - function.code.data();
  if (at > 0) --at;  // pc stands behind the instruction that runs
  if (at < 0 || at >= static_cast<std::ptrdiff_t>(function.spans.size())) return frame.method->span;
  return function.spans[static_cast<std::size_t>(at)];
}

namespace {

bool of_library(const TraceLine& line, const Sources& sources) {
  for (std::uint32_t i = 0; i < sources.size(); ++i)
    if (sources.file(i).name == line.file) return sources.file(i).embedded;
  return false;
}

/// If the innermost call of the user's own stands in a source of the host's, the error names that line.
void tell_foreign_place(ErrorReport& r, const Sources& sources) {
  const auto own = std::find_if(r.trace.rbegin(), r.trace.rend(),
                                [&](const TraceLine& line) { return line.foreign || !of_library(line, sources); });
  if (own == r.trace.rend() || !own->foreign) return;
  r.file = own->file;
  r.line = own->line;
  r.column = r.length = 0;
  r.text = fmt::format("{}:{}: error: {}\n", r.file, r.line, r.message) +
           (r.help.empty() ? "" : "help: " + r.help + '\n') + trace_text(r.trace);
}

}  // namespace

ErrorReport Machine::report(const RunError& error, const Instruction* pc) const {
  ErrorReport r;
  r.kind = error.kind();
  r.message = cut(error.what(), kLongestMessage);
  r.help = error.help();
  const auto& sources = program_->sources();
  auto frames = active_frames();
  if (frame_ != nullptr && pc != nullptr && half_made(*frame_, pc)) frames.pop_back();
  r.trace = trace(frames, pc);
  // The place shown is the innermost in the user's own files: an error inside the class library is the caller's.
  Span place;
  for (const auto* frame : frames) {
    const auto span = span_of(*frame, frame == frame_ && pc ? pc : frame->pc);
    const bool narrowed = frame == frames.back() && error.place().line != 0;
    if (!sources.file(span.file).embedded || place.line == 0) place = narrowed ? error.place() : span;
  }
  if (place.line != 0) {
    r.file = sources.file(place.file).name;
    r.line = place.line;
    r.column = place.column;
    r.length = place.length;
  }
  r.text = format({Severity::Error, "run-time", r.message, r.help, place}, sources) + trace_text(r.trace);
  tell_foreign_place(r, sources);
  return r;
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
  constexpr std::uint64_t kMost = std::uint64_t{64} << 20, kBytesPerTurn = 16;
  charge(text.size() / kBytesPerTurn);
  printed_ += text.size();
  if (printed_ > kMost)
    throw RunError(RunErrorKind::Bounds, "more than 64 MB are printed in one iteration or call by the host",
                   "print less, or write to a file");
  host_.print(text);
}

/// Counts each, and makes the text only of those that are reported.
template <class Text>
void Machine::tell(Severity severity, Text&& text) {
  const auto& to = severity == Severity::Error ? host_.error : host_.warn;
  if (!to) return;
  constexpr std::uint32_t kMost = 1000;
  if (told_ <= kMost) ++told_;
  if (told_ <= kMost) return to(text());
  if (told_ == kMost + 1) {
    host_.warn(fmt::format(
        "{} warnings and errors in one iteration or call by the host: further ones are counted, but not shown", kMost));
    ++told_;
  }
  to({});
}

void Machine::survive(const RunError& error) {
  tell(Severity::Error, [&] { return report(error, running()).text; });
}

void Machine::survive(const ScriptError& error) {
  tell(Severity::Error, [&] { return error.report().text; });
}

std::string Machine::stack_trace() const {
  std::string out;
  std::size_t number = 0;
  for (const auto* active : active_frames()) {
    const auto& frame = *active;
    const auto span = span_of(frame, frame.pc);
    out +=
        fmt::format("{}. {} (0x{:x}) {} {}:{}\n", number++, frame.self->cls->name, frame.self->serial,
                    program_->symbols().name(frame.method->name), program_->sources().file(span.file).name, span.line);
  }
  return out;
}

/// The innermost running statement of the program's own files; line 0: there is none.
Span Machine::place_of_caller() const {
  for (const Frame* frame = frame_; frame; frame = frame->caller)
    if (const auto span = span_of(*frame, frame->pc); !program_->sources().file(span.file).embedded) return span;
  return {};
}

void Machine::warn(std::string_view text) {
  tell(Severity::Warning, [&] {
    return format({Severity::Warning, "run-time", std::string(text), {}, place_of_caller()}, program_->sources());
  });
}

void Machine::report_unknown_method(Severity severity, const Instance& self, std::string_view method,
                                    std::string_view consequence) {
  if (severity != Severity::Error && !warned_.emplace(self.cls->name + " " + std::string(method)).second) return;
  tell(severity, [&] {
    return format(
        {severity, "run-time", fmt::format("class {} has no method '{}': {}", self.cls->name, method, consequence),
         unknown_method_help(method, self.cls, *program_), place_of_caller()},
        program_->sources());
  });
}

void Machine::warn_once(std::string_view key, std::string_view text) {
  if (warned_.emplace(key).second) warn(text);
}

}  // namespace breve::steve
