// Where the lines of `breve repl` come from: a terminal, with editing, history and completion, or a pipe.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace breve::command {

/// Completions at the cursor: names that begin with `typed`.
class NameSource {
 public:
  virtual ~NameSource() = default;
  /// @param line   what has been typed so far, lines before this one included
  /// @param typed  the part of a name just before the cursor, the end of `line`
  virtual std::vector<std::string> names(const std::string& line, const std::string& typed) = 0;
};

enum class Reading { Line, Abandoned, End };  // Abandoned: by Ctrl-C

class LineReader {
 public:
  virtual ~LineReader() = default;
  /// @param more  the line goes on an entry that has begun
  virtual Reading read(bool more, std::string& line) = 0;
  /// A whole entry, for the history.
  virtual void remember(const std::string& entry) = 0;
};

std::unique_ptr<LineReader> make_line_reader(NameSource& names);

/// Has Ctrl-C been pressed since the last time this was asked? Nothing else is known of it here.
bool take_interrupt();
/// While a statement runs, Ctrl-C is for it: `interrupt(context)` is called in the signal handler. Null: no more.
void interrupts_go_to(void (*interrupt)(void* context), void* context);

}  // namespace breve::command
