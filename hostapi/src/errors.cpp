// From exceptions to breve_error.
#include <cmath>
#include <new>

#include "guard.hpp"
#include "steve/machine/value.hpp"

namespace breve::host {

namespace {

breve_status status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::Argument: return BREVE_ERROR_ARGUMENT;
    case ErrorCode::Stale: return BREVE_ERROR_STALE;
    case ErrorCode::Busy: return BREVE_ERROR_BUSY;
    case ErrorCode::Memory: return BREVE_ERROR_MEMORY;
    case ErrorCode::Script: return BREVE_ERROR_SCRIPT;
    case ErrorCode::Compile: return BREVE_ERROR_COMPILE;
    case ErrorCode::Budget: return BREVE_ERROR_BUDGET;
    case ErrorCode::Depth: return BREVE_ERROR_DEPTH;
    case ErrorCode::Image: return BREVE_ERROR_IMAGE;
    case ErrorCode::File: return BREVE_ERROR_FILE;
    case ErrorCode::Unsupported: return BREVE_ERROR_UNSUPPORTED;
    case ErrorCode::Interrupted: return BREVE_ERROR_INTERRUPTED;
    case ErrorCode::Reload: return BREVE_ERROR_RELOAD;
    case ErrorCode::Internal: return BREVE_ERROR_INTERNAL;
    case ErrorCode::Numeric: return BREVE_ERROR_SCRIPT;  // only with the world's guard off
  }
  return BREVE_ERROR_INTERNAL;
}

breve_status status_of(steve::RunErrorKind kind) {
  if (kind == steve::RunErrorKind::Depth) return BREVE_ERROR_DEPTH;
  if (kind == steve::RunErrorKind::Budget) return BREVE_ERROR_BUDGET;
  if (kind == steve::RunErrorKind::Interrupted) return BREVE_ERROR_INTERRUPTED;
  return BREVE_ERROR_SCRIPT;
}

}  // namespace

void need_finite(const double* numbers, std::size_t count, const char* what) {
  need(numbers, what);
  for (std::size_t i = 0; i < count; ++i)
    if (!std::isfinite(numbers[i]))
      fail(BREVE_ERROR_ARGUMENT, std::string(what) + "[" + std::to_string(i) + "] is not a finite number");
}

breve_status ErrorRecord::keep(breve_status status, std::string message) {
  message_ = without_zeros(std::move(message));
  help_.clear();
  file_.clear();
  frames_.clear();
  frame_views_.clear();
  view_ = {};
  view_.status = status;
  text_ = message_ + "\n";
  point();
  return status;
}

breve_status ErrorRecord::keep(breve_status status, const steve::ErrorReport& report) {
  keep(status, report.message);
  help_ = without_zeros(report.help);
  file_ = report.file;
  text_ = without_zeros(report.text);
  view_.line = report.line;
  view_.column = report.column;
  view_.length = report.length;
  for (auto line = report.trace.rbegin(); line != report.trace.rend(); ++line)
    frames_.push_back(
        {line->class_name, line->method, line->file, line->receiver, line->arguments, line->line, line->column});
  for (const auto& f : frames_)
    frame_views_.push_back({f.class_name.c_str(), f.method.c_str(), f.file.c_str(), f.line, f.column,
                            f.receiver.c_str(), f.arguments.c_str()});
  point();
  return status;
}

void ErrorRecord::point() {
  view_.message = message_.c_str();
  view_.help = help_.c_str();
  view_.file = file_.c_str();
  view_.text = text_.c_str();
  view_.frame_count = frame_views_.size();
  view_.frames = frame_views_.empty() ? nullptr : frame_views_.data();
}

breve_status ErrorRecord::keep_current() noexcept {
  ++count_;
  try {
    try {
      throw;
    } catch (const StatusError& e) {
      return keep(e.status(), e.what());
    } catch (const steve::ScriptError& e) {
      return keep(status_of(e.code()), e.report());
    } catch (const steve::RunError& e) {
      const breve_status status = keep(status_of(e.kind()), e.what());
      help_ = e.help();
      text_ = "error: " + message_ + "\n" + (help_.empty() ? "" : "help: " + help_ + "\n");
      point();
      return status;
    } catch (const Error& e) {
      return keep(status_of(e.code()), e.what());
    } catch (const std::bad_alloc&) {
      return keep(BREVE_ERROR_MEMORY,
                  "out of memory: the world's memory limit was reached, or the allocator returned NULL");
    } catch (const std::exception& e) {
      return keep(BREVE_ERROR_INTERNAL, e.what());
    } catch (...) {
      return keep(BREVE_ERROR_INTERNAL, "an unknown exception");
    }
  } catch (...) {
    // No memory even for the text.
    view_ = {};
    view_.status = BREVE_ERROR_MEMORY;
    view_.message = "out of memory";
    view_.help = view_.file = "";
    view_.text = "out of memory\n";
    return BREVE_ERROR_MEMORY;
  }
}

void ErrorRecord::take(ErrorRecord&& other) noexcept {
  message_ = std::move(other.message_);
  help_ = std::move(other.help_);
  file_ = std::move(other.file_);
  text_ = std::move(other.text_);
  frames_ = std::move(other.frames_);
  frame_views_ = std::move(other.frame_views_);
  view_ = other.view_;
  if (!message_.empty()) point();  // else the view is of constants
}

}  // namespace breve::host
