// Files of `breve run --record`: a line of JSON that says how the program was run, and behind it the log of its world.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "run.hpp"

namespace breve::command {

/// Writes the log of a world to a file as it comes.
class LogFile {
 public:
  /// Starts the recording. Throws std::runtime_error if the file cannot be written.
  LogFile(const RunOptions& options, std::uint64_t seed, breve_world* world);
  /// The run is over. Throws std::runtime_error if the log is not whole.
  void finish(breve_world* world);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  static void write(void* sink, const char* bytes, std::size_t size);

  std::string name_;
  std::unique_ptr<std::FILE, Close> file_;
  bool failed_ = false;
};

/// A log as it was read.
struct ReadLog {
  RunOptions options;  // of the recorded run, as far as they change what its world does
  std::uint64_t seed = 0;
  std::string folder;  // where it was run
  std::string log;
};

/// Throws std::runtime_error if there is no such file, or if it is not of --record.
ReadLog read_log(const std::string& file);

}  // namespace breve::command
