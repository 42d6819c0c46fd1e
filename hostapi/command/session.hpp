// A runtime set up for the command: modules from the file system, texts to standard output and standard error.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "breve/breve.h"
#include "module_loader.hpp"
#include "output.hpp"

namespace breve::command {

/// Exit statuses of the command.
enum ExitStatus { kEndedWell = 0, kFailed = 1, kWrongUsage = 2, kLimitHit = 3 };

struct ProgramDeleter {
  void operator()(breve_program* program) const { breve_program_destroy(program); }
};
using ProgramHandle = std::unique_ptr<breve_program, ProgramDeleter>;

struct WorldDeleter {
  void operator()(breve_world* world) const { breve_world_destroy(world); }
};
using WorldHandle = std::unique_ptr<breve_world, WorldDeleter>;

class Session {
 public:
  Session(Output& output, const std::vector<std::string>& paths, bool quiet);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  breve_runtime* runtime() const { return runtime_; }
  /// Compile a file. Every diagnostic is shown, warnings unless quiet.
  /// @param program  set on success
  /// @return         kEndedWell, kFailed if it does not compile, kWrongUsage if there is no such file to read
  ExitStatus load(const std::string& file, ProgramHandle& program);
  std::size_t errors() const { return errors_; }  // shown by `load` so far
  std::size_t warnings() const { return warnings_; }

 private:
  void show_diagnostics();
  static void print(void* user, breve_world* world, breve_channel channel, const char* text, std::size_t size);

  Output& output_;
  ModuleLoader loader_;
  bool quiet_;
  std::size_t errors_ = 0, warnings_ = 0;
  breve_runtime* runtime_ = nullptr;
};

}  // namespace breve::command
