// Reports of run-time errors: where they happened, through which calls, and what the reader can do about it.
#include "steve/machine/reporter.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace breve::steve {

namespace {

bool of_library(const TraceLine& line, const Sources& sources) {
  for (std::uint32_t i = 0; i < sources.size(); ++i)
    if (sources.file(i).name == line.file) return sources.file(i).embedded;
  return false;
}

/// If the innermost call of the user's own stands in a source of the host's, the error names that line.
void name_foreign_place(ErrorReport& r, const Sources& sources) {
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

ErrorReport Reporter::report(const RunError& error, std::span<const ActiveCall> calls, const Program& program) const {
  ErrorReport r;
  r.kind = error.kind();
  r.message = cut(error.what(), kLongestMessage);
  r.help = error.help();
  const auto& sources = program.sources();
  r.trace = trace_of(calls, program, host_.places);
  // The place shown is the innermost in the user's own files: an error inside the class library is the caller's.
  Span location;
  for (const ActiveCall& call : calls) {
    const bool narrowed = &call == &calls.back() && error.location().line != 0;
    if (!sources.file(call.span.file).embedded || location.line == 0)
      location = narrowed ? error.location() : call.span;
  }
  if (location.line != 0) {
    r.file = sources.file(location.file).name;
    r.line = location.line;
    r.column = location.column;
    r.length = location.length;
  }
  r.text = format({Severity::Error, "run-time", r.message, r.help, location}, sources) + trace_text(r.trace);
  name_foreign_place(r, sources);
  return r;
}

void Reporter::print(std::string_view text) {
  constexpr std::uint64_t kMost = std::uint64_t{64} << 20;
  printed_ += text.size();
  if (printed_ > kMost)
    throw RunError(RunErrorKind::Bounds, "more than 64 MB are printed in one iteration or call by the host",
                   "print less, or write to a file");
  host_.print(text);
}

void Reporter::warn_of_silence() const {
  if (host_.warn)
    host_.warn(fmt::format(
        "{} warnings and errors in one iteration or call by the host: further ones are counted, but not shown",
        kMostTold));
}

void Reporter::forget_locations(std::span<const Instruction> code) {
  std::erase_if(warned_locations_,
                [&](const Instruction* at) { return at >= code.data() && at < code.data() + code.size(); });
}

}  // namespace breve::steve
