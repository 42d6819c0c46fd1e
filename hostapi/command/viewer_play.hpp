// Input from a file in place of a person's, for tests and demonstrations.
#pragma once

#include <string>
#include <vector>

namespace breve::command {

/// A line of the file: "FRAME ACTION ARGUMENTS". Actions: `key NAME` as SDL names keys, `click X Y`,
/// `drag X Y X2 Y2 left|right`, `wheel STEPS`, `shot FILE.png`, `say TEXT`, `quit`.
struct PlayedAction {
  int frame = 0;
  std::string action;
  std::vector<std::string> arguments;
};

class Play {
 public:
  /// @throws std::runtime_error naming the file and line that cannot be read
  explicit Play(const std::string& file);
  /// Queues the input of a frame as the window would. @return  what is not input: `shot`, `say`, `quit`
  std::vector<PlayedAction> begin_frame(int frame) const;

 private:
  std::vector<PlayedAction> actions_;
};

}  // namespace breve::command
