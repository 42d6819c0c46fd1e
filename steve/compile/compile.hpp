// The compiler as its users see it: from the text of a program and of all that it loads to a Program.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "steve/code/library_source.hpp"
#include "steve/code/program.hpp"
#include "steve/compile/lint_table.hpp"

namespace breve::steve {

/// Finds the text of a module for the compiler. The command reads files; a host decides for itself.
struct ModuleSource {
  std::string name;  // as messages show it; two directives that give the same name mean the same file
  std::string text;
};
/// What a plugin adds to the programs that name it, or why it adds nothing.
struct PluginParts {
  ForeignFunctions functions;
  ForeignClasses classes;
  std::string fault, help;  // a plugin with a fault adds nothing
};
class ModuleResolver {
 public:
  virtual ~ModuleResolver() = default;
  /// @param name      as spelled in the directive ("Control.tz" for `@use Control.`)
  /// @param from      name of the file that asks, "" for the main file
  virtual std::optional<ModuleSource> resolve(std::string_view name, std::string_view from) = 0;
  virtual void add_path(std::string_view) {}  // @path
  /// @param file, entry  as spelled in `@plugin "file"(entry)`. The same parts whenever it is asked for the same plugin
  virtual PluginParts load_plugin(const std::string& file, const std::string& entry, const std::string& from);
};

struct CompileResult {
  std::shared_ptr<const Program> program;  // null if there were errors
  Diagnostics diagnostics;
  Sources sources;  // for formatting diagnostics when there is no program
};

/// Compiles a main file and all that it loads.
/// @param library  what programs may use without a search path; outlives the program
/// @param allowed  codes of lints that are not to be reported
/// @param foreign  functions besides those of the language, each with a name of its own
/// @param classes  classes besides those of the class library; one that a file of the program defines wins
CompileResult compile(ModuleSource main, ModuleResolver& resolver, const LibrarySource& library,
                      const AllowedLints& allowed = {}, const ForeignFunctions& foreign = {},
                      const ForeignClasses& classes = {});

/// The fault in the text of a ForeignClass by itself; "" if there is none.
std::string fault_of_foreign_class(const std::string& text);

}  // namespace breve::steve
