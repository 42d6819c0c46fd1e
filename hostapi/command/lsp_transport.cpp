// Framing by hand on file descriptors, so that waiting input can be seen without reading it.
#include "lsp_transport.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>

namespace breve::command {

namespace {

constexpr std::size_t kLongestHeaderLine = 4096;

/// The number behind "Content-Length:", whatever its capitals; nothing if the line is another header.
std::optional<std::string_view> length_header(std::string_view line) {
  constexpr std::string_view kName = "content-length:";
  if (line.size() < kName.size()) return std::nullopt;
  for (std::size_t i = 0; i < kName.size(); ++i) {
    const char c = line[i] >= 'A' && line[i] <= 'Z' ? static_cast<char>(line[i] - 'A' + 'a') : line[i];
    if (c != kName[i]) return std::nullopt;
  }
  line.remove_prefix(kName.size());
  const std::size_t first = line.find_first_not_of(" \t");
  const std::size_t last = line.find_last_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : line.substr(first, last + 1 - first);
}

}  // namespace

bool LspTransport::fill() {
  buffer_.erase(0, taken_);
  taken_ = 0;
  std::array<char, 1 << 16> chunk;
  for (;;) {
    const ssize_t size = ::read(STDIN_FILENO, chunk.data(), chunk.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    buffer_.append(chunk.data(), static_cast<std::size_t>(size));
    return true;
  }
}

// Without its end. A line that never ends is given in pieces.
std::optional<std::string> LspTransport::line() {
  std::size_t searched = taken_;
  for (;;) {
    const std::size_t end = buffer_.find('\n', searched);
    if (end != std::string::npos || buffer_.size() - taken_ > kLongestHeaderLine) {
      const std::size_t stop = end == std::string::npos ? buffer_.size() : end;
      std::string text = buffer_.substr(taken_, stop - taken_);
      taken_ = end == std::string::npos ? stop : end + 1;
      if (!text.empty() && text.back() == '\r') text.pop_back();
      return text;
    }
    searched = buffer_.size() - taken_;
    if (!fill()) return std::nullopt;
  }
}

bool LspTransport::skip(std::size_t count) {
  while (count > 0) {
    if (taken_ == buffer_.size() && !fill()) return false;
    const std::size_t part = std::min(count, buffer_.size() - taken_);
    taken_ += part;
    count -= part;
  }
  return true;
}

Incoming LspTransport::read() {
  std::optional<std::size_t> length;
  bool any = false;
  for (;;) {
    const std::optional<std::string> header = line();
    if (!header) return {};
    if (header->empty()) {
      if (length) break;
      if (!any) continue;
      return {Incoming::Kind::Malformed, "a message begins with a Content-Length header"};
    }
    any = true;
    const std::optional<std::string_view> digits = length_header(*header);
    if (!digits) {
      // Any other header has a name, a colon and a value; what has none is not the beginning of a message.
      if (header->find(':') == std::string::npos || header->front() == '{')
        return {Incoming::Kind::Malformed, "a message begins with a Content-Length header"};
      continue;
    }
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(digits->data(), digits->data() + digits->size(), value);
    if (error != std::errc() || end != digits->data() + digits->size() || digits->empty())
      return {Incoming::Kind::Malformed, "Content-Length must be a number of bytes"};
    length = value;
  }
  if (*length > kLargestMessage) {
    if (!skip(*length)) return {};
    return {Incoming::Kind::TooLarge, "the message is larger than 64 MiB"};
  }
  while (buffer_.size() - taken_ < *length)
    if (!fill()) return {};
  std::string body = buffer_.substr(taken_, *length);
  taken_ += *length;
  return {Incoming::Kind::Message, std::move(body)};
}

bool LspTransport::more_waits() {
  if (taken_ < buffer_.size()) return true;
  pollfd input{STDIN_FILENO, POLLIN, 0};
  return ::poll(&input, 1, 0) > 0;
}

bool LspTransport::write(std::string_view body) {
  std::string text = "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n";
  text += body;
  std::string_view rest = text;
  while (!rest.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace breve::command
