// Each file is a program of its own, compiled with a search path of its own, so that files do not see one another's.
#include "check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "session.hpp"

namespace breve::command {

namespace {

std::string count(std::size_t n, std::string_view what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

}  // namespace

int check(const CheckOptions& options, Output& output) {
  int status = kEndedWell;
  std::size_t errors = 0, warnings = 0;
  for (const auto& file : options.files) {
    Session session(output, options.paths, false);
    ProgramHandle program;
    status = std::max<int>(status, session.load(file, program));
    errors += session.errors();
    warnings += session.warnings();
  }
  output.print(fmt::format("{}: {}, {}\n", count(options.files.size(), "file"), count(errors, "error"),
                           count(warnings, "warning")));
  return status;
}

}  // namespace breve::command
