// What the compiler has to say: errors and warnings with their place and their remedy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "steve/syntax/source.hpp"

namespace breve::steve {

enum class Severity : std::uint8_t { Error, Warning, Note };

struct Diagnostic {
  Severity severity = Severity::Error;
  std::string code;     // stable, kebab-case: "unknown-variable", "lint-precedence"
  std::string message;  // what is wrong, lower case, no full stop
  std::string help;     // what to do; may be empty
  Span span;
};

class Diagnostics {
 public:
  void error(const Span& span, std::string code, std::string message, std::string help = {});
  void warning(const Span& span, std::string code, std::string message, std::string help = {});
  /// A thousand errors are kept, and a thousand of the rest; one of each kind says that there are more.
  void add(Diagnostic diagnostic);
  /// Will no more errors be kept? What would help with them need not be looked for.
  bool full() const { return errors_ >= kMost; }
  const std::vector<Diagnostic>& all() const { return all_; }
  std::size_t error_count() const { return errors_; }

 private:
  std::vector<Diagnostic> all_;
  static constexpr std::size_t kMost = 1000;
  std::size_t errors_ = 0, others_ = 0;
};

/// At most `bytes` of a text, cut between characters and ended by `…`.
std::string cut(std::string_view text, std::size_t bytes);

/// How much of a message is shown.
inline constexpr std::size_t kLongestMessage = 4000;  // bytes

/// "file:line:col: error: message", the source line with a caret under the span, and "help: ..." on a line of its own.
std::string format(const Diagnostic& diagnostic, const Sources& sources);

/// The candidate nearest to `name` (edit distance at most a third of its length), or "" if none is near.
std::string nearest(std::string_view name, const std::vector<std::string_view>& candidates);

}  // namespace breve::steve
