// The chain of calls of a run-time error: who called whom from where, with the values of receivers and arguments.
#include "steve/machine/trace.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "steve/machine/brief.hpp"
#include "steve/machine/native.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kLongestArgument = 60;     // bytes
constexpr std::size_t kLongestArguments = 160;   // bytes
constexpr std::size_t kDescribedAtEachEnd = 64;  // calls whose values are shown: the ends of a deep recursion
constexpr std::size_t kLongestCycle = 4;         // methods that call one another without end
constexpr std::size_t kShownOfRun = 3;           // rounds of a recursion that are shown before the fold
constexpr std::size_t kShownLines = 24;

bool same_call(const TraceLine& a, const TraceLine& b) {
  return a.method == b.method && a.class_name == b.class_name && a.line == b.line && a.file == b.file;
}

std::string counted(std::size_t n) {
  std::string digits = std::to_string(n);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

/// How often the `period` calls that begin at `at` come in a row.
std::size_t rounds(const std::vector<const TraceLine*>& calls, std::size_t at, std::size_t period) {
  std::size_t end = at + period;
  while (end < calls.size() && same_call(*calls[end], *calls[end - period])) ++end;
  return (end - at) / period;
}

std::string location_text(const TraceLine& line) {
  const std::string location = fmt::format("{}:{}", line.file, line.line);
  return line.column == 0 ? location : fmt::format("{}:{}", location, line.column);
}

std::string line_of(const TraceLine& call, const TraceLine* caller) {
  std::string text =
      call.class_name.empty() ? "  in " + call.method : fmt::format("  in {}.{}", call.class_name, call.method);
  if (!call.arguments.empty()) text += ' ' + call.arguments;
  if (!call.receiver.empty()) text += fmt::format(" [self: {}]", call.receiver);
  if (caller != nullptr) text += ", called at " + location_text(*caller);
  return text + '\n';
}

// The last line is that of a foreign method: its place in its own source, and what it has called there itself.
void add_places(std::vector<TraceLine>& lines, const std::vector<ForeignPlace>& places) {
  if (places.empty()) return;
  lines.back().file = places.back().file;
  lines.back().line = places.back().line;
  lines.back().column = 0;
  lines.back().foreign = true;
  for (std::size_t i = places.size() - 1; i-- > 0;) {
    TraceLine& line = lines.emplace_back();
    line.method = places[i].function;
    line.file = places[i].file;
    line.line = places[i].line;
    line.foreign = true;
  }
}

// Values as they are now: a method may have assigned to its parameters.
void describe_call(TraceLine& line, const ActiveCall& call, const SymbolTable& symbols) {
  line.receiver = brief(call.self);
  std::string all;
  for (const auto& p : call.method->parameters) {
    if (symbols.name(p.keyword).starts_with('%')) continue;  // of no method that somebody wrote
    const Slot* slot = call.registers + p.slot;
    std::string value;
    switch (p.type) {
      case StaticType::Int: value = brief(Value::of(slot->i)); break;
      case StaticType::Double: value = brief(Value::of(slot->d)); break;
      case StaticType::Vector: value = brief(SlotType<Vector3>::from(slot)); break;
      case StaticType::Matrix: value = "a matrix"; break;
      case StaticType::Any:
      case StaticType::Null: value = brief(SlotType<Value>::from(slot)); break;
      default: value = brief(Value::of(static_cast<Tag>(p.type), slot->ref)); break;
    }
    all += (all.empty() ? "" : " ") + symbols.name(p.keyword) + ' ' + cut(value, kLongestArgument);
  }
  line.arguments = cut(all, kLongestArguments);
}

}  // namespace

std::vector<TraceLine> trace_of(std::span<const ActiveCall> calls, const Program& program,
                                const std::function<std::vector<ForeignPlace>(std::size_t depth)>& places) {
  std::vector<TraceLine> lines;
  lines.reserve(calls.size());
  for (std::size_t i = 0; i < calls.size(); ++i) {
    const ActiveCall& call = calls[i];
    TraceLine& line = lines.emplace_back();
    line.class_name = call.self->cls->name;
    line.method = program.symbols().name(call.method->name);
    line.file = program.sources().file(call.span.file).name;
    line.line = call.span.line;
    line.column = call.span.column;
    if (i < kDescribedAtEachEnd || i + kDescribedAtEachEnd >= calls.size())
      describe_call(line, call, program.symbols());
    if (call.method->foreign && places) add_places(lines, places(i + 1));
  }
  return lines;
}

std::string trace_text(const std::vector<TraceLine>& trace) {
  std::vector<const TraceLine*> calls;  // innermost first
  for (auto line = trace.rbegin(); line != trace.rend(); ++line) calls.push_back(&*line);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < calls.size();) {
    const auto show = [&] {
      lines.push_back(line_of(*calls[at], at + 1 < calls.size() ? calls[at + 1] : nullptr));
      ++at;
    };
    std::size_t period = 1;
    while (period <= kLongestCycle && rounds(calls, at, period) <= kShownOfRun + 1) ++period;
    if (period > kLongestCycle) {
      show();
      continue;
    }
    // The first rounds and the last one are shown: in the last one the arguments are those that it began with.
    const std::size_t end = at + rounds(calls, at, period) * period;
    const std::size_t fold = at + kShownOfRun * period;
    while (at < fold) show();
    lines.push_back(fmt::format("  … {} more of the same\n", counted(end - period - fold)));
    at = end - period;
    while (at < end) show();
  }
  std::string text;
  const std::size_t half = kShownLines / 2;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool hidden = lines.size() > kShownLines && i >= half && i + half < lines.size();
    if (!hidden) text += lines[i];
    if (hidden && i == half) text += fmt::format("  … {} more calls\n", counted(lines.size() - 2 * half));
  }
  return text;
}

}  // namespace breve::steve
