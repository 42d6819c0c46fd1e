// Errors at the border: whatever is thrown inside a C function becomes a status and a kept text. Nothing gets past.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "breve/breve.h"
#include "runtime/base/error.hpp"
#include "steve/machine/machine.hpp"

namespace breve::host {

/// An error that belongs to the C interface itself, with its status.
class StatusError : public std::runtime_error {
 public:
  StatusError(breve_status status, const std::string& what) : std::runtime_error(what), status_(status) {}
  breve_status status() const { return status_; }

 private:
  breve_status status_;
};

[[noreturn]] inline void fail(breve_status status, const std::string& message) { throw StatusError(status, message); }

/// BREVE_ERROR_ARGUMENT unless `pointer` is something. `what` names the argument.
inline void need(const void* pointer, const char* what) {
  if (!pointer) fail(BREVE_ERROR_ARGUMENT, std::string(what) + " is NULL");
}

/// For texts that hosts read up to their zero byte: one that stands in a program's text must not end them.
inline std::string without_zeros(std::string text) {
  std::replace(text.begin(), text.end(), '\0', '?');
  return text;
}

/// BREVE_ERROR_ARGUMENT unless every number is finite.
void need_finite(const double* numbers, std::size_t count, const char* what);

/// One active method, as kept for breve_frame.
struct FrameText {
  std::string class_name, method, file, receiver, arguments;
  std::uint32_t line = 0, column = 0;
};

/// The last error of a runtime or a world, and the view of it that hosts read.
class ErrorRecord {
 public:
  /// Keep the error that is being handled; call inside a catch block. Never throws.
  breve_status keep_current() noexcept;
  const breve_error* view() const noexcept { return view_.status == BREVE_OK ? nullptr : &view_; }
  /// How many errors were kept so far.
  std::uint64_t count() const noexcept { return count_; }
  /// Take over another record: the error of a world that is being given up becomes its runtime's.
  void take(ErrorRecord&& other) noexcept;

 private:
  breve_status keep(breve_status status, std::string message);
  breve_status keep(breve_status status, const steve::ErrorReport& report);
  void point();

  std::string message_, help_, file_, text_;
  std::vector<FrameText> frames_;
  std::vector<breve_frame> frame_views_;
  breve_error view_{};
  std::uint64_t count_ = 0;
};

/// Run the body of a C function. BREVE_OK, or the status of what it threw, kept in `record`.
template <class Body>
breve_status guard(ErrorRecord& record, Body&& body) noexcept {
  try {
    std::forward<Body>(body)();
    return BREVE_OK;
  } catch (...) {
    return record.keep_current();
  }
}

/// The same where there is nobody to keep the text.
template <class Body>
breve_status guard(Body&& body) noexcept {
  ErrorRecord nobody;
  return guard(nobody, std::forward<Body>(body));
}

}  // namespace breve::host
