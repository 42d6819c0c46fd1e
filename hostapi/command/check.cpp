// Each file is a program of its own, compiled with a search path of its own, so that files do not see one another's.
#include "check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "session.hpp"

namespace breve::command {

namespace {

using Json = nlohmann::ordered_json;

std::string count(std::size_t n, std::string_view what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

const char* severity_name(std::uint32_t severity) {
  switch (severity) {
    case BREVE_SEVERITY_ERROR: return "error";
    case BREVE_SEVERITY_WARNING: return "warning";
    case BREVE_SEVERITY_NOTE: return "note";
  }
  return "error";
}

// Texts of programs may hold any bytes; bytes that are not UTF-8 are replaced.
Json json_of(const breve_diagnostic& d) {
  return {{"file", d.file},
          {"line", d.line},
          {"column", d.column},
          {"length", d.length},
          {"severity", severity_name(d.severity)},
          {"code", d.code},
          {"message", d.message},
          {"help", d.help}};
}

}  // namespace

int check(const CheckOptions& options, Output& output) {
  int status = kEndedWell;
  std::size_t errors = 0, warnings = 0, notes = 0;
  Json list = Json::array();
  for (const auto& file : options.files) {
    Session session(output, options.paths, false, options.strict, nullptr, options.plugins);
    for (const auto& code : options.allowed) {
      if (session.allow(code)) continue;
      output.complain(fmt::format("breve: --allow: {}\n", breve_runtime_last_error(session.runtime())->message));
      return kWrongUsage;
    }
    session.tell([&](const breve_diagnostic& d) {
      if (d.severity == BREVE_SEVERITY_ERROR) ++errors;
      if (d.severity == BREVE_SEVERITY_WARNING) ++warnings;
      if (d.severity == BREVE_SEVERITY_NOTE) ++notes;
      if (options.json) {
        list.push_back(json_of(d));
      } else {
        output.complain(d.text);
      }
    });
    ProgramHandle program;
    status = std::max<int>(status, session.load(file, program));
  }
  if (options.json) {
    output.print(list.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    return status;
  }
  output.print(fmt::format("{}: {}, {}{}\n", count(options.files.size(), "file"), count(errors, "error"),
                           count(warnings, "warning"), notes == 0 ? "" : ", " + count(notes, "note")));
  return status;
}

}  // namespace breve::command
