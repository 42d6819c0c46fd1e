// Statements that are typed in while a program runs, compiled as though they stood in a method of one of its classes.
//
// A program never changes, and its code refers to strings, call sites and other tables by number. So a world that
// evaluates has a copy of the program's tables with room behind them (the classes and their code are shared); a
// fragment's entries stand at the end while it is needed and are cut off again. Fragments end in the reverse order of
// their beginning.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "steve/compile/scope.hpp"
#include "steve/syntax/ast.hpp"

namespace breve::steve {

/// How much the tables of a program hold.
struct TableSizes {
  std::size_t strings = 0, texts = 0, sites = 0, members = 0, interpolations = 0, symbols = 0, sources = 0;
};

struct Fragment {
  std::shared_ptr<MethodInfo> method;  // one parameter: the hash that holds the variables of the session
  Diagnostics diagnostics;
  bool uses_session = false;
  bool gives_value = false;  // ends with an expression, or returns
  TableSizes before;
  bool compiled() const { return diagnostics.error_count() == 0; }
};

class Fragments {
 public:
  explicit Fragments(const Program& base);

  /// The program with the entries of the fragments that exist now. Another object after `compile` if there was no more
  /// room; the earlier one then lives on until `all_ended`, because running code may refer into it.
  const std::shared_ptr<Program>& program() const { return program_; }
  /// @param self   the class in whose method the statements stand
  /// @param known  variables of the session; a name that is assigned and is not a variable of `self` becomes one
  std::unique_ptr<Fragment> compile(std::string_view text, const ClassInfo& self,
                                    const std::vector<std::string_view>& known);
  /// Cut its entries off. It must be the last one that was made.
  void end(const Fragment& fragment);
  void all_ended() { retired_.clear(); }

  static constexpr const char* kSourceName = "input";  // as places in errors show it

 private:
  TableSizes sizes() const;
  std::shared_ptr<MethodInfo> method_of(const ClassInfo& self);
  void make_room(std::size_t entries);

  std::shared_ptr<Program> program_;
  std::vector<std::shared_ptr<Program>> retired_;
  std::shared_ptr<const CompileScope::FunctionTable> functions_;
};

/// Do brackets, strings and comments close, and can the text end here? False asks for another line.
bool statements_complete(std::string_view text);

struct SessionUse {
  bool used = false;
  std::vector<std::string> loop_variables;  // hidden dynamic locals that stand for them in `foreach`
};
/// Turn the names of session variables into elements of the hash `%session`: those that are `known` or assigned, and
/// are not variables of `self`.
SessionUse use_session(ast::Method& method, const ClassInfo& self, const SymbolTable& symbols,
                       const std::vector<std::string_view>& known);
inline constexpr const char* kSessionVariable = "%session";  // a name that nobody can write

}  // namespace breve::steve
