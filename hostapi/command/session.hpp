// A runtime set up for the command: modules from the file system, texts to standard output and standard error.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "access.hpp"
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
  /// @param strict  warnings of the compiler are errors
  /// @param access   what programs may touch; null: they are not run. Throws std::runtime_error if a path is not a
  /// directory
  /// @param plugins  directories of plugins of programs that are not run
  Session(Output& output, const std::vector<std::string>& paths, bool quiet, bool strict,
          const AccessOptions* access = nullptr, const std::vector<std::string>& plugins = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  breve_runtime* runtime() const { return runtime_; }
  /// Compile a file. Every diagnostic is shown, warnings unless quiet.
  /// @param program  set on success
  /// @return         kEndedWell, kFailed if it does not compile, kWrongUsage if there is no such file to read
  ExitStatus load(const std::string& file, ProgramHandle& program);
  /// Compile it again from the files as they are now. If that fails, data files are looked for as before.
  ExitStatus load_again(const std::string& file, ProgramHandle& program);
  /// Compile a program that stands in no file.
  ExitStatus compile(const std::string& name, const std::string& text, ProgramHandle& program);
  /// The files that the last call of `load` or `load_again` read, also if it failed.
  const std::vector<std::string>& files() const { return files_; }
  /// Do not report lints of that code. False: there is no such lint, and the runtime's last error says so.
  bool allow(const std::string& code);
  /// Hand every diagnostic to `listener` in place of showing errors and warnings.
  void tell(std::function<void(const breve_diagnostic&)> listener) { listener_ = std::move(listener); }

 private:
  bool show_diagnostics();  // false: there is a warning that is an error
  ExitStatus finish(breve_status status, breve_program* compiled, ProgramHandle& program);
  void allow_files(const AccessOptions& access);
  static void allow_network(const AccessOptions& access, breve_runtime_config& config);
  static void print(void* user, breve_world* world, breve_channel channel, const char* text, std::size_t size);

  Output& output_;
  std::vector<std::string> paths_;
  ModuleLoader loader_;
  std::vector<std::string> files_;
  bool quiet_, strict_, no_files_ = true;
  FileAccess access_;
  std::vector<std::string> plugins_;  // directories of libraries that may be loaded
  std::function<void(const breve_diagnostic&)> listener_;
  breve_runtime* runtime_ = nullptr;
};

}  // namespace breve::command
