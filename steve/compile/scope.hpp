// What the compiler of functions needs of whoever it works for, be it a whole program or a few statements that are
// typed in while a program runs: names and classes, tables to put constants and call sites in, a place for complaints.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "steve/code/bytecode.hpp"
#include "steve/code/library_source.hpp"
#include "steve/code/program.hpp"

namespace breve::steve {

class CompileScope {
 public:
  struct FunctionEntry {
    std::uint32_t number;
    std::string_view signature;  // as Native::signature
    bool foreign = false;        // then `number` counts the program's ForeignFunctions
  };
  using FunctionTable = std::multimap<std::string_view, FunctionEntry>;
  static std::shared_ptr<const FunctionTable> function_table(const LibrarySource& library,
                                                             const ForeignFunctions& foreign);

  CompileScope(std::shared_ptr<Program> program, std::shared_ptr<const FunctionTable> functions)
      : program_(std::move(program)), functions_(std::move(functions)) {}
  virtual ~CompileScope() = default;
  CompileScope(const CompileScope&) = delete;
  CompileScope& operator=(const CompileScope&) = delete;

  /// The class of that name or alias. Null if there is none.
  virtual const ClassInfo* class_named(std::string_view name) = 0;
  /// @param severity  a warning where the program may never get there, an error where a type names the class
  virtual void report_unknown_class(std::string_view name, const Span& span, Severity severity = Severity::Warning) = 0;

  Diagnostics& diagnostics() { return diagnostics_; }
  Symbol symbol(std::string_view name) { return program_->symbols_.intern(name); }
  const std::string& symbol_name(Symbol symbol) const { return program_->symbols_.name(symbol); }
  std::uint32_t string_number(std::string_view text);
  std::uint32_t text_number(std::string_view text);
  CodeTables& code() { return *program_->code_; }
  const Defines& defines() const { return program_->defines_; }
  const std::string& source(std::uint32_t file) const { return program_->sources_.file(file).text; }
  bool embedded(const Span& span) const { return program_->sources_.file(span.file).embedded; }
  std::optional<FunctionEntry> find_function(std::string_view name, std::size_t arguments) const;
  bool function_exists(std::string_view name) const { return functions_->contains(name); }
  std::vector<std::string_view> function_names() const;
  void lint(const Span& span, std::string code, std::string message, std::string help = {});
  /// Are sums looked at when the whole program is known, so that calls have types?
  virtual bool checks_sums_later() const { return false; }
  void lint_text_sum(const Span& span);
  void lint_list_sum(const Span& span);

 protected:
  /// The functions of the program have become more.
  void renew_function_table() { functions_ = function_table(program_->library(), program_->foreign_); }

  std::shared_ptr<Program> program_;
  Diagnostics diagnostics_;

 private:
  std::map<std::string, std::uint32_t, std::less<>> strings_, texts_;  // those that came through this scope
  std::shared_ptr<const FunctionTable> functions_;
};

}  // namespace breve::steve
