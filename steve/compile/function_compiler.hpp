// One method from tree to bytecode. Expressions, assignments, calls and statements are in files of their own.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "steve/code/program.hpp"
#include "steve/compile/emitter.hpp"
#include "steve/syntax/ast.hpp"

namespace breve::steve {

class CompileScope;

class FunctionCompiler {
 public:
  /// @param dynamic  names of further locals, which hold values of any type: nothing in a file declares such
  FunctionCompiler(CompileScope& builder, const ClassInfo& cls, const ast::Method& method, MethodInfo& info,
                   std::vector<std::string> dynamic = {});
  void compile();

 private:
  struct Local {
    StaticType type;
    std::uint16_t slot;
    std::int32_t array_size;
    Symbol class_name;
    Span span;
    bool parameter;
    bool used = false;
  };
  /// A variable by name: a local, or a variable of the instance.
  struct Variable {
    Local* local = nullptr;
    const VariableInfo* member = nullptr;
    StaticType type() const { return local ? local->type : member->type; }
    std::int32_t array_size() const { return local ? local->array_size : member->array_size; }
    Symbol class_name() const { return local ? local->class_name : member->class_name; }
  };
  /// Something that can be assigned to, its parts evaluated once.
  struct Target {
    enum class Kind { Variable, Component, ArrayItem, Index, Member, Value } kind = Kind::Value;
    Variable variable;             // Variable, Component, ArrayItem
    std::string name;              // for messages
    int axis = 0;                  // Component: of a vector variable
    Operand key;                   // ArrayItem: the slot number; Index: the key (any)
    std::unique_ptr<Target> base;  // Index, Member: where the container came from
    Operand value;                 // Index, Member: the container's value (any, or a list)
    std::uint32_t site = 0;        // Member
    const ast::Expr* expr = nullptr;
  };

  // --- names ---------------------------------------------------------------------------------------------------------
  void declare_locals();
  std::optional<Variable> find(std::string_view name);
  std::optional<Variable> need(std::string_view name, const Span& span);  // reports an unknown one
  std::string unknown_name_help(std::string_view name, const Span& span);
  std::string unknown_function_help(const ast::FunctionCall& f, const Span& span);
  std::string argument_count_help(const ast::FunctionCall& f, const Span& span);
  std::int32_t text(std::string what);
  std::int32_t text_for(const Variable& variable, std::string_view name);

  // --- expressions ---------------------------------------------------------------------------------------------------
  /// @param into  a register of exactly the value's type where the result may be put; it is not used before the end
  Operand expr(const ast::Expr& e, const Operand* into = nullptr);
  Operand any(const ast::Expr& e);  // the value as a dynamic one, in a temporary
  Operand boxed(const Operand& value);
  Operand result(StaticType type, const Operand* into);
  /// A register that later code cannot change: a copy if the operand is a variable that `later` assigns.
  Operand stable(const Operand& value, const ast::Expr& later);
  Operand copy(const Operand& value);
  void move(const Operand& to, const Operand& from);  // same type
  Operand convert(const Operand& value, StaticType type, std::int32_t what, const Operand* into = nullptr);
  Operand result_register(StaticType type, const Operand* into);  // the result register, whose type is known
  Operand dynamic_result();
  void zero(const Operand& target);

  Operand literal(const ast::IntLit& n, const Operand* into);
  Operand literal(const ast::DoubleLit& n, const Operand* into);
  Operand constant(const ast::Constant& c, const Operand* into);
  Operand string_constant(std::string_view text, const Operand* into);
  Operand string(const ast::StringLit& s, const ast::Expr& e, const Operand* into);
  Operand vector(const ast::VectorLit& v);
  Operand matrix(const ast::MatrixLit& m);
  Operand list(const ast::ListLit& l);
  Operand name(const ast::Name& n, const ast::Expr& e);
  Operand read(const Variable& variable);
  Operand array_item(const ast::ArrayItem& a, const ast::Expr& e);
  Operand array_slot(const Variable& variable, const ast::Expr& index, std::string_view name);
  Operand read_array(const Variable& variable, const Operand& slot);
  Operand index(const ast::IndexExpr& i, const ast::Expr& e);
  Operand index_of(const Operand& base, const ast::Expr& key);
  Operand member(const ast::Member& m, const ast::Expr& e);
  Operand member_of(const Operand& base, std::uint32_t site);
  std::uint32_t member_site(std::string_view name);
  /// An operator with one operand: the instruction for its type, or the one for dynamic values.
  Operand one_operand(const Operand& value, Op of_int, Op of_double, Op of_vector, StaticType vector_gives, Op of_any,
                      const Operand* into);
  Operand unary(const ast::Unary& u, const ast::Expr& e, const Operand* into);
  Operand chain(const ast::Chain& c, const ast::Expr& e, const Operand* into);
  Operand binary(ast::BinaryOp op, Operand a, Operand b, const Operand* into);
  Operand link(Operand left, ast::BinaryOp op, const ast::Expr& right, const Span& span, const Operand* into);
  Operand operand(const ast::Expr& e);
  Operand number_first(const ast::Expr& first, ast::BinaryOp op, const ast::Expr& right, const Span& span,
                       const Operand* into);
  std::optional<Operand> with_number(ast::BinaryOp op, Operand left, double number, bool integer, const Operand* into);
  std::optional<Operand> with_constant(Op code, const Operand& left, double number, const Operand* into);
  Operand emit_binary(Op code, StaticType type, const Operand& x, const Operand& y, const Operand* into);
  Operand product_and(const Instruction& product, ast::BinaryOp op, bool product_first, const Operand& made,
                      const Operand& other, const Operand* into);
  std::optional<Operand> multiply_add(ast::BinaryOp op, const Operand& a, const Operand& b, const Operand* into);
  std::optional<Operand> vector_binary(ast::BinaryOp op, Operand a, Operand b, const Operand* into);
  void lint_operands(ast::BinaryOp op, StaticType a, StaticType b);
  Operand generic_binary(ast::BinaryOp op, const Operand& a, const Operand& b, const Operand* into);
  Operand logical(const ast::Expr& e, const Operand* into);
  Operand magnitude(const ast::Magnitude& m, const Operand* into);
  Operand function_call(const ast::FunctionCall& f, const ast::Expr& e, const Operand* into);
  Operand product(const ast::FunctionCall& f, const ast::Expr& e, const Operand* into);
  Operand random(const ast::RandomExpr& r);
  Operand unknown_class(const std::string& name, const Span& span);
  Operand make_new(const ast::NewExpr& n);
  Operand all(const ast::AllExpr& a);
  Operand list_operand(const ast::Expr& e, std::string_view what);
  Operand push(const ast::Push& p);
  Operand pop(const ast::Pop& p);
  Operand insert(const ast::Insert& i);
  Operand remove(const ast::Remove& r);
  Operand copy_list(const ast::CopyList& c);
  void sort(const ast::Sort& s);

  // --- conditions ----------------------------------------------------------------------------------------------------
  /// Jump to `target` if the truth of `e` is `when`; else fall through.
  void condition(const ast::Expr& e, bool when, Label& target);
  void jump_on(const Operand& value, bool when, Label& target);
  bool comparison_jump(const ast::Chain& c, bool when, Label& target);

  // --- calls ---------------------------------------------------------------------------------------------------------
  void call(const ast::Call& c, const ast::Expr& e);  // the value is in the result register
  void arguments_and_call(const ast::Call& c, Op op, const Operand& receiver, std::int32_t site);

  // --- assignment ----------------------------------------------------------------------------------------------------
  Operand assign(const ast::Assign& a, const ast::Expr& e);
  Operand changed(ast::BinaryOp op, const Operand& current, const Operand& value, const Operand* into);
  Operand step(const ast::Step& s, const ast::Expr& e);
  Operand assign_to_variable(const Variable& variable, std::string_view name, const ast::Expr& value);
  Target target_of(const ast::Expr& target);
  void target_variable(Target& p, const ast::Name& n);
  void target_array_item(Target& p, const ast::ArrayItem& a);
  void target_member(Target& p, const ast::Member& m);
  void target_index(Target& p, const ast::IndexExpr& i);
  Operand load(Target& target);
  Operand store(Target& target, const Operand& value);  // yields the converted value
  Operand store_variable(const Variable& variable, std::string_view name, const Operand& value);
  void write_member(const VariableInfo& member, const Operand& value);
  Operand store_array(const Target& target, const Operand& value);
  void release(Target& target);
  void check_class(const Operand& object, Symbol class_name, std::int32_t what);

  // --- statements ----------------------------------------------------------------------------------------------------
  /// @param keep  the value of the last expression statement may be the method's: keep it
  void statements(const std::vector<ast::StmtPtr>& list, bool keep);
  void statement(const ast::Stmt& s, bool keep);
  void expression_statement(const ast::Expr& e, bool keep);
  void tail(const ast::Expr& e);
  void if_statement(const ast::If& s, bool keep);
  void while_statement(const ast::While& s, bool keep);
  void for_statement(const ast::For& s, bool keep);
  bool counting_for(const ast::For& s, Label& body);
  void foreach_statement(const ast::Foreach& s, const Span& span, bool keep);
  void print(const ast::Print& p);
  void return_statement(const ast::Return& r);
  void emit_return(const Operand& value);
  void keep_value(const Operand& value);
  void keep_result();

  CompileScope& builder_;
  const ClassInfo& class_;
  const ast::Method& method_;
  MethodInfo& info_;
  Emitter emit_;
  std::unordered_map<std::string, Local> locals_;
  std::vector<std::string> dynamic_;
  Operand last_;  // the value of the last expression statement, if some path needs it
  bool has_last_ = false;
};

// What an expression does, asked of its tree (effects.cpp).
bool has_effects(const ast::Expr& e);                      // may change something, draw or call
bool assigns(const ast::Expr& e);                          // may assign a local variable
std::optional<double> written_number(const ast::Expr& e);  // the value of a number written out, with its sign
bool is_written_int(const ast::Expr& e);
bool always_has_value(const ast::Stmt& s);  // every path through it runs an expression statement
bool contains_return(const ast::Stmt& s);
/// Calls `visit` for every expression in a tree, outermost first.
void walk(const ast::Expr& e, const std::function<void(const ast::Expr&)>& visit);
void walk(const ast::Stmt& s, const std::function<void(const ast::Expr&)>& visit);
/// Calls `visit` for a statement and every statement inside it.
void walk_statements(const ast::Stmt& s, const std::function<void(const ast::Stmt&)>& visit);

}  // namespace breve::steve
