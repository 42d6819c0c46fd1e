// `breve run --watch`: sees that a program's files have changed, and puts the changed program in the running one's
// place.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "session.hpp"

namespace breve::command {

/// Looks at files now and then. Polling works on every file system, and with editors that write a new file and rename.
class Watch {
 public:
  /// From now on these are watched; how they are now is what later looks are compared with.
  void files(const std::vector<std::string>& paths);
  /// Have they changed, and then come to rest? True once for each change. Looks ten times a second at most.
  bool changed();

 private:
  struct Stamp {
    std::int64_t seconds = 0, nanoseconds = 0;  // of the last change
    std::uint64_t size = 0, inode = 0;
    bool exists = false;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  static Stamp look_at(const std::string& path);

  std::map<std::string, Stamp> known_, seen_;  // as of the last `changed` that was true, as of the last look
  std::chrono::steady_clock::time_point next_;
};

/// Compiles a program again and hands it to its world.
class Reloader {
 public:
  Reloader(Session& session, Output& output, std::string file);
  /// If the files have changed: reload. True if the world runs another program now.
  bool look(breve_world* world);
  /// Now, changed or not. The outcome is reported on standard error.
  bool reload(breve_world* world);

 private:
  Session& session_;
  Output& output_;
  std::string file_;
  Watch watch_;
};

}  // namespace breve::command
