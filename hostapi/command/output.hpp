// Standard output and standard error in one order: buffered output, flushed before anything goes to standard error.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

namespace breve::command {

class Output {
 public:
  Output();
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void print(std::string_view text);     // standard output
  void complain(std::string_view text);  // standard error, at once
  /// Also hand what goes to standard error to `listener`; an empty one ends that.
  void listen(std::function<void(std::string_view)> listener) { listener_ = std::move(listener); }
  void flush();
  /// Flush if the last time was long enough ago that somebody may be waiting.
  void flush_sometimes();
  /// False once the reader of standard output has gone away: there is no point in going on.
  bool open() const { return open_; }

  /// Lines on the terminal that replace those before; does nothing if standard error is not a terminal.
  void progress(std::string_view lines);
  /// These lines stay.
  void keep_progress();
  bool shows_progress() const { return error_terminal_; }

 private:
  void clear_progress();

  std::string buffer_;
  std::function<void(std::string_view)> listener_;
  std::chrono::steady_clock::time_point flushed_;
  bool open_ = true;
  bool terminal_, error_terminal_;
  bool progress_shown_ = false;
  std::size_t progress_breaks_ = 0;  // line breaks in what is shown
};

}  // namespace breve::command
