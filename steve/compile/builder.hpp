// Builds a Program: loads files, declares classes, compiles methods, checks the whole.
#pragma once

#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "steve/code/bytecode.hpp"
#include "steve/compile/compile.hpp"
#include "steve/compile/scope.hpp"

namespace breve::steve {

class ProgramBuilder final : public CompileScope {
 public:
  ProgramBuilder(ModuleResolver& resolver, const LibrarySource& library, const ForeignFunctions& foreign,
                 const ForeignClasses& classes);
  CompileResult build(ModuleSource main, const AllowedLints& allowed);

  /// One of the library's is loaded if the program has none of that name.
  const ClassInfo* class_named(std::string_view name) override;
  void report_unknown_class(std::string_view name, const Span& span, Severity severity = Severity::Warning) override;
  bool checks_sums_later() const override { return true; }

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

  // plugins.cpp
  void load_plugin(const ast::Directive& directive, const std::string& from);
  std::string taken_name(const PluginParts& parts) const;  // of a function or class that the program has; or ""

  // classes (declare.cpp)
  void declare(ast::Class tree);
  const ClassInfo* parent_of(ast::Class& tree);
  void declare_variables(const ast::Class& tree, ClassInfo& info);
  void declare_methods(const ast::Class& tree, ClassInfo& info);
  void declare_parameter(const ast::Parameter& tree, MethodInfo& method, std::set<std::string>& variables);
  static StaticType result_of_native(const ast::Method& tree);
  void bind_native(const ast::Method& tree, MethodInfo& method);
  void compile_methods();
  void finish_class(ClassInfo& info);

  // loader.cpp
  void check_versions();
  std::string near_class(std::string_view name) const;
  void choose_controller();

  // declare.cpp
  Symbol checked_class(const ast::TypeRef& type);

  // foreign_classes.cpp
  const ForeignClass* foreign_class(std::string_view name) const;  // name or alias; null if there is none
  bool load_foreign_class(std::string_view name, const ast::Directive* directive, const std::string& from);
  void bind_foreign(const ast::Method& tree, MethodInfo& method, std::size_t first);
  void adopt_keywords(MethodInfo& method, const ClassInfo& cls);

  // foreign_library.cpp
  void gather_foreign_library();

  // whole-program checks (lints.cpp)
  void check_calls();
  void check_call(const ast::Call& call, const ast::Expr& e, const ast::Method& method, const ClassInfo& cls,
                  const std::vector<const MethodInfo*>& named);
  void report_unknown_method(const ast::Call& call, const ClassInfo* cls);
  std::string meant_by_method(const std::string& name) const;
  void check_overrides();
  void check_method_named(const ast::Call& call, const ClassInfo* receiver);
  // lints_sums.cpp
  void check_sums();
  // lints_variables.cpp
  void check_unused_variables();
  void check_unused_parameters(const std::set<std::string>& words);
  void check_implicit_returns();

  // lints.cpp
  void check_iterate();
  void check_special_methods();

  ModuleResolver& resolver_;
  const LibrarySource& library_;
  std::vector<Declared> declared_;
  std::size_t compiled_ = 0;
  std::vector<ast::TypeRef> checked_;  // types of parameters, looked at when all files are read
  std::set<std::string, std::less<>> loaded_;
  std::set<std::pair<std::string, std::string>> plugins_;  // file and entry
  std::vector<ast::Directive> versions_;
  std::string controller_name_;
  Span controller_span_;
  std::unordered_map<std::string_view, const Native*> natives_;
  ForeignClasses foreign_given_;  // and those of the program's plugins
  std::map<std::string, std::size_t, std::less<>>
      foreign_bases_;  // by class: number of its first method in the program
  int depth_ = 0;
  std::size_t bytes_ = 0, tokens_ = 0;  // of the files that are not the library's
  std::size_t unknown_methods_ = 0;
};

}  // namespace breve::steve
