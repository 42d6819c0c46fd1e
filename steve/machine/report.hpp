// A run-time error in full: the place, the remedy, and the calls that led there.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "steve/machine/value.hpp"

namespace breve::steve {

/// One active method, for reports.
struct TraceLine {
  std::string class_name, method, file;  // class of the receiver
  std::string receiver;                  // "Bird 0xc"; "" if it could not be described
  std::string arguments;                 // "target (3, 0, 1) weight 2"
  std::uint32_t line = 0, column = 0;    // of what was running
  bool foreign = false;                  // the place is one in a source of the host's own
};

/// A run-time error with everything that is known about it.
struct ErrorReport {
  RunErrorKind kind = RunErrorKind::Internal;
  std::string message, help, file;
  std::uint32_t line = 0, column = 0, length = 0;
  std::vector<TraceLine> trace;  // outermost first
  std::string text;              // all of it, formatted for people: ends with a newline
};

/// A run-time error on its way out of the interpreter.
class ScriptError : public Error {
 public:
  ScriptError(ErrorCode code, ErrorReport report) : Error(code, report.message), report_(std::move(report)) {}
  const ErrorReport& report() const { return report_; }

 private:
  ErrorReport report_;
};

}  // namespace breve::steve
