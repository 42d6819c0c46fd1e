// The names that a program knows, for completion and description.
#pragma once

#include <string>
#include <vector>

#include "breve/analysis.h"
#include "breve/breve.h"
#include "repl_input.hpp"

namespace breve::command {

class ProgramNames final : public NameSource {
 public:
  explicit ProgramNames(breve_runtime* runtime) : runtime_(runtime) {}
  ~ProgramNames() override { breve_analysis_destroy(analysis_); }
  ProgramNames(const ProgramNames&) = delete;
  ProgramNames& operator=(const ProgramNames&) = delete;

  /// From now on the names are those of this program, and of what runs in this world.
  /// @param text  NULL: the module is looked for by its name
  void use(const std::string& module, const std::string* text, breve_world* world);
  std::vector<std::string> names(const std::string& line, const std::string& typed) override;
  /// The instance variables that a class declares itself, in the order of its text.
  std::vector<std::string> variables(const std::string& class_name) const;
  /// A class and its ancestors, the root last.
  std::vector<std::string> line_of(const std::string& class_name) const;

 private:
  std::vector<std::string> session_names() const;

  breve_runtime* runtime_;
  breve_analysis* analysis_ = nullptr;
  breve_world* world_ = nullptr;
};

/// The commands of the repl, without their colon.
extern const std::vector<std::string> kReplCommands;

}  // namespace breve::command
