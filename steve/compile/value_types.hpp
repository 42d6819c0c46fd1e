// What type the value of an expression is known to have, over the whole program: for lints, never for code.
#pragma once

#include <string_view>
#include <unordered_map>
#include <vector>

#include "steve/code/program.hpp"
#include "steve/compile/scope.hpp"
#include "steve/syntax/ast.hpp"

namespace breve::steve {

class ValueTypes {
 public:
  ValueTypes(const Program& program, const CompileScope& scope) : program_(program), scope_(scope) {}
  /// Every method of the program is to be made known before the first question.
  void add(const ClassInfo& cls, const ast::Method& method, const MethodInfo& info);

  /// `Any` if it is not known, Double for a number of either kind.
  StaticType of(const ast::Expr& e, const ast::Method& method, const ClassInfo& cls);
  /// left op right
  static StaticType combined(ast::BinaryOp op, StaticType left, StaticType right);

 private:
  struct Known {
    const ClassInfo* cls;
    const ast::Method* tree;
    const MethodInfo* info;
    enum class State : std::uint8_t { New, Busy, Done } state = State::New;
    StaticType type = StaticType::Any;
  };
  StaticType of_name(std::string_view name, const ast::Method& method, const ClassInfo& cls) const;
  StaticType of_call(const ast::Call& call, const ClassInfo& cls);
  StaticType of_method(Known& method);

  const Program& program_;
  const CompileScope& scope_;
  std::unordered_map<Symbol, std::vector<Known>> methods_;
};

}  // namespace breve::steve
