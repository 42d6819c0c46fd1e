// Builds a Program: loads files, declares classes, compiles methods, checks the whole.
#pragma once

#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "steve/compile/bytecode.hpp"
#include "steve/compile/program.hpp"

namespace breve::steve {

class ProgramBuilder {
 public:
  ProgramBuilder(ModuleResolver& resolver);
  CompileResult build(ModuleSource main);

  // --- for the compiler of functions
  // --------------------------------------------------------------------------------------
  Diagnostics& diagnostics() { return diagnostics_; }
  Symbol symbol(std::string_view name) { return program_->symbols_.intern(name); }
  const std::string& symbol_name(Symbol symbol) const { return program_->symbols_.name(symbol); }
  /// The class of that name or alias; one of the library's is loaded if the program has none. Null if there is none.
  const ClassInfo* class_named(std::string_view name);
  /// @param severity  a warning where the program may never get there, an error where a type names the class
  void report_unknown_class(std::string_view name, const Span& span, Severity severity = Severity::Warning);
  std::uint32_t string_number(std::string_view text);
  std::uint32_t text_number(std::string_view text);
  CodeTables& code() { return *program_->code_; }
  bool embedded(const Span& span) const { return program_->sources_.file(span.file).embedded; }
  struct FunctionEntry {
    std::uint32_t number;
    const Native* native;
  };
  std::optional<FunctionEntry> find_function(std::string_view name, std::size_t arguments) const;
  bool function_exists(std::string_view name) const { return functions_.contains(name); }
  std::vector<std::string_view> function_names() const;
  void lint(const Span& span, std::string code, std::string message, std::string help = {});

 private:
  struct Declared {
    ast::Class tree;
    ClassInfo* info;
  };

  // loading (loader.cpp)
  void load(ModuleSource module, bool embedded);
  bool load_library(std::string_view name);
  void load_directive(const ast::Directive& directive, const std::string& from, bool embedded);
  void load_named(const std::string& name, const ast::Directive& directive, const std::string& from, bool embedded);
  void late_directive(const ast::Directive& directive);

  // classes (declare.cpp)
  void declare(ast::Class tree);
  void declare_variables(const ast::Class& tree, ClassInfo& info);
  void declare_methods(const ast::Class& tree, ClassInfo& info);
  void declare_parameter(const ast::Parameter& tree, MethodInfo& method, std::set<std::string>& variables);
  void bind_native(const ast::Method& tree, MethodInfo& method);
  void compile_methods();
  void finish_class(ClassInfo& info);
  void check_versions();
  void choose_controller();
  Symbol checked_class(const ast::TypeRef& type);

  // whole-program checks (lints.cpp)
  void check_calls();
  void check_site(const CallSite& site, const std::vector<std::string_view>& selectors);
  void check_unused_variables();
  void check_iterate();
  void check_special_methods();

  std::shared_ptr<Program> program_;
  ModuleResolver& resolver_;
  Diagnostics diagnostics_;
  std::vector<Declared> declared_;
  std::size_t compiled_ = 0;
  std::vector<ast::TypeRef> checked_;  // types of parameters, looked at when all files are read
  std::set<std::string, std::less<>> loaded_;
  std::vector<ast::Directive> versions_;
  std::string controller_name_;
  Span controller_span_;
  std::map<std::string, std::uint32_t, std::less<>> strings_, texts_;
  std::multimap<std::string_view, FunctionEntry> functions_;
  std::unordered_map<std::string_view, const Native*> natives_;
  int depth_ = 0;
};

}  // namespace breve::steve
