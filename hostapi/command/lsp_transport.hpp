// Messages of the language server protocol: a header with the length, an empty line, that many bytes of JSON.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace breve::command {

/// What came in.
struct Incoming {
  enum class Kind { Message, Malformed, TooLarge, End } kind = Kind::End;
  std::string text;  // of a Message: its body; else what is wrong
};

class LspTransport {
 public:
  /// A larger message is read over and reported.
  static constexpr std::size_t kLargestMessage = std::size_t{64} << 20;

  /// The next message. Waits for it. After a malformed header reading goes on with the line that follows it.
  Incoming read();
  /// Is there more to read already?
  bool more_waits();
  /// False if the editor is gone.
  bool write(std::string_view body);

 private:
  bool fill();  // false at the end of the input
  std::optional<std::string> line();
  bool skip(std::size_t count);

  std::string buffer_;
  std::size_t taken_ = 0;  // bytes at the front of buffer_ that are used up
};

}  // namespace breve::command
