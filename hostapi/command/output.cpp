// Writing to file descriptors with a buffer of our own, so that a reader who goes away is a fact and not a signal.
#include "output.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace breve::command {

namespace {

constexpr std::size_t kBufferSize = 1 << 16;
constexpr auto kPatience = std::chrono::milliseconds(100);

/// False if it could not all be written.
bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// As many of the parts of a line, which commas separate, as a line of the terminal has room for: a line that wraps
/// cannot be removed by '\r'.
std::string_view fitting(std::string_view line) {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || line.size() < size.ws_col) return line;
  const std::size_t comma = line.rfind(", ", size.ws_col - 1);
  return line.substr(0, comma == std::string_view::npos ? std::size_t{size.ws_col} - 1 : comma);
}

}  // namespace

Output::Output()
    : flushed_(std::chrono::steady_clock::now()),
      terminal_(::isatty(STDOUT_FILENO) != 0),
      error_terminal_(::isatty(STDERR_FILENO) != 0) {
  buffer_.reserve(kBufferSize);
}

Output::~Output() {
  flush();
  clear_progress();
}

void Output::print(std::string_view text) {
  if (!open_) return;
  buffer_ += text;
  if (buffer_.size() >= kBufferSize || (terminal_ && text.find('\n') != std::string_view::npos)) flush();
}

void Output::complain(std::string_view text) {
  flush();
  clear_progress();
  write_all(STDERR_FILENO, text);
  if (listener_) listener_(text);
}

void Output::flush() {
  if (!buffer_.empty() && open_) {
    if (terminal_) clear_progress();
    open_ = write_all(STDOUT_FILENO, buffer_);
  }
  buffer_.clear();
  flushed_ = std::chrono::steady_clock::now();
}

void Output::flush_sometimes() {
  if (!buffer_.empty() && std::chrono::steady_clock::now() - flushed_ > kPatience) flush();
}

void Output::progress(std::string_view lines) {
  if (!error_terminal_) return;
  flush();
  clear_progress();
  const bool one = lines.find('\n') == std::string_view::npos;  // several are laid out for the terminal's width
  write_all(STDERR_FILENO, one ? fitting(lines) : lines);
  progress_shown_ = true;
  progress_breaks_ = static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n'));
}

void Output::keep_progress() {
  if (progress_shown_) write_all(STDERR_FILENO, "\n");
  progress_shown_ = false;
}

void Output::clear_progress() {
  if (!progress_shown_) return;
  progress_shown_ = false;
  const std::string up = progress_breaks_ > 0 ? "\x1b[" + std::to_string(progress_breaks_) + "A" : std::string();
  write_all(STDERR_FILENO, "\r" + up + "\x1b[J");
}

}  // namespace breve::command
