// Run-time errors: where they happened, through which calls, and what the reader can do about it.
#include <fmt/format.h>

#include <algorithm>

#include "steve/machine/machine.hpp"

namespace breve::steve {

Span Machine::span_of(const Frame& frame, const Instruction* pc) const {
  const auto& function = *frame.method->function;
  auto at = pc - function.code.data();
  if (at > 0) --at;  // pc stands behind the instruction that runs
  if (at < 0 || at >= static_cast<std::ptrdiff_t>(function.spans.size())) return frame.method->span;
  return function.spans[static_cast<std::size_t>(at)];
}

std::vector<const Machine::Frame*> Machine::active_frames() const {
  std::vector<const Frame*> frames;
  for (const Frame* frame = frame_; frame; frame = frame->caller) frames.push_back(frame);
  std::reverse(frames.begin(), frames.end());
  return frames;
}

ErrorReport Machine::report(RunErrorKind kind, const std::string& message, const Instruction* pc) const {
  ErrorReport r;
  r.kind = kind;
  r.message = message;
  const auto& sources = program_->sources();
  // The place shown is the innermost in the user's own files: an error inside the class library is the caller's.
  Span place;
  for (const auto* active : active_frames()) {
    const auto& frame = *active;
    const auto span = span_of(frame, active == frame_ && pc ? pc : frame.pc);
    const auto& file = sources.file(span.file);
    if (!file.embedded || place.line == 0) place = span;
    r.trace.push_back({frame.self->cls->name, program_->symbols().name(frame.method->name), file.name,
                       frame.self->serial, span.line});
  }
  if (place.line != 0) {
    r.file = sources.file(place.file).name;
    r.line = place.line;
    r.column = place.column;
    r.text = format({Severity::Error, "run-time", message, {}, place}, sources);
  } else {
    r.text = "error: " + message + "\n";
  }
  if (!r.text.empty() && r.text.back() != '\n') r.text += '\n';
  for (auto line = r.trace.rbegin(); line != r.trace.rend(); ++line) {
    if (line - r.trace.rbegin() >= 12 && r.trace.rend() - line > 4) {
      if (line - r.trace.rbegin() == 12) r.text += fmt::format("  ... {} more calls ...\n", r.trace.rend() - line - 4);
      continue;
    }
    r.text += fmt::format("  in {} of {} (0x{:x}), {}:{}\n", line->method, line->class_name, line->address, line->file,
                          line->line);
  }
  return r;
}

void Machine::rethrow(std::size_t depth, const Instruction* pc) {
  const auto wrap = [&](ErrorCode code, RunErrorKind kind, const std::string& message) {
    auto r = report(kind, message, pc);
    unwind(depth);
    throw ScriptError(code, std::move(r));
  };
  try {
    throw;
  } catch (const ScriptError&) {
    unwind(depth);
    throw;
  } catch (const RunError& error) {
    const auto code = error.kind() == RunErrorKind::Budget  ? ErrorCode::Budget
                      : error.kind() == RunErrorKind::Depth ? ErrorCode::Depth
                                                            : ErrorCode::Script;
    wrap(code, error.kind(), error.what());
  } catch (const Error& error) {
    wrap(error.code() == ErrorCode::Memory ? ErrorCode::Memory : ErrorCode::Script, RunErrorKind::World, error.what());
  } catch (const std::bad_alloc&) {
    unwind(depth);
    ErrorReport r;
    r.message = "the world has no more memory";
    r.text = "error: the world has no more memory: raise its limit, or make fewer objects\n";
    throw ScriptError(ErrorCode::Memory, std::move(r));
  }
  throw Error(ErrorCode::Script, "unreachable");
}

void Machine::survive(const ScriptError& error) {
  ++survived_errors_;
  if (host_.error) host_.error(error.report().text);
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

void Machine::warn(std::string_view text) {
  if (!host_.warn) return;
  for (const Frame* frame = frame_; frame; frame = frame->caller) {
    const auto span = span_of(*frame, frame->pc);
    if (program_->sources().file(span.file).embedded) continue;
    host_.warn(format({Severity::Warning, "run-time", std::string(text), {}, span}, program_->sources()));
    return;
  }
  host_.warn("warning: " + std::string(text) + "\n");
}

void Machine::warn_once(std::string_view key, std::string_view text) {
  if (warned_.insert(std::string(key)).second) warn(text);
}

}  // namespace breve::steve
