// The tree that the parser makes and the compiler reads. Nodes own their children; nesting is bounded by the parser
// (kMaxNesting), so that walking and destroying a tree may recurse.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "steve/syntax/source.hpp"

namespace breve::steve::ast {

inline constexpr int kMaxNesting = 200;

enum class TypeKind : std::uint8_t { Int, Double, Vector, Matrix, String, Object, List, Hash, Pointer, Data };

struct TypeRef {
  TypeKind kind = TypeKind::Int;
  std::string class_name;        // Object only: "" = any class
  std::int32_t array_size = -1;  // >= 0: an array of that many
  bool broken = false;           // not what was written, which is reported: nothing more is said about it
  bool dynamic = false;          // `(?)`: any value; parameters of classes that the host gives only
  Span span;
};

/// A literal usable in @define, defaults and nowhere else: int, double, string (outer quotes removed, escapes kept as
/// written), vector (3) or matrix (9, rows first).
struct Constant {
  using Value = std::variant<std::int32_t, double, std::string, std::array<double, 3>, std::array<double, 9>>;

  Constant() = default;
  Constant(Value v, Span s) : value(std::move(v)), span(s) {}
  // Not the variant's own copy: in libstdc++ 12 one that runs out of memory for the string destroys what is not there.
  Constant(const Constant& other) : value(copy(other.value)), span(other.span) {}
  Constant(Constant&&) = default;
  Constant& operator=(Constant other) noexcept {
    value = std::move(other.value);
    span = other.span;
    return *this;
  }

  Value value;
  Span span;

 private:
  static Value copy(const Value& from) {
    return std::visit(
        [](const auto& alternative) {
          auto one = alternative;
          return Value(std::move(one));
        },
        from);
  }
};

struct Expr;
struct Stmt;
using ExprPtr = std::unique_ptr<Expr>;
using StmtPtr = std::unique_ptr<Stmt>;

// --- expressions -----------------------------------------------------------------------------------------------------

enum class BinaryOp : std::uint8_t { Add, Sub, Mul, Div, Mod, Pow, Lt, Le, Gt, Ge, Eq, Ne, And, Or };
enum class UnaryOp : std::uint8_t { Not, Negate };

struct IntLit {
  std::int32_t value;
};  // and character literals
struct DoubleLit {
  double value;
};
/// A string with its escapes processed and its interpolations split off: texts.size() == parts.size() + 1.
struct StringLit {
  struct Part {
    std::string name;                   // "self" for self and super
    std::optional<std::int32_t> index;  // ${name}{n} or [n]
    bool array = false;                 // [n] rather than {n}
    ExprPtr expr;                       // the extension ${expression}; name is then empty
    Span span;
  };
  std::vector<std::string> texts;
  std::vector<Part> parts;
};
struct ConstantExpr {
  Constant constant;
  std::string name;
};  // a name introduced by @define
struct VectorLit {
  ExprPtr x, y, z;
};
struct MatrixLit {
  std::array<ExprPtr, 9> elements;
};  // row by row
struct ListLit {
  std::vector<ExprPtr> elements;
};
struct Name {
  std::string name;
};
struct ArrayItem {
  std::string name;
  ExprPtr index;
};  // name[index]
struct IndexExpr {
  ExprPtr base, index;
};  // base{index}
/// base::name; x, y, z (and X, Y, Z given in lower case) too: then `letter` is the letter as written, else 0.
struct Member {
  ExprPtr base;
  std::string name;
  char letter = 0;
};
struct Self {};
struct Super {};
struct Keyword {
  std::string name;
  Span span;
  ExprPtr value;
};
struct Call {
  ExprPtr receiver;
  std::string selector;
  Span selector_span;
  std::vector<Keyword> keywords;
};
struct FunctionCall {
  std::string name;
  std::vector<ExprPtr> arguments;
};
struct RandomExpr {
  ExprPtr bound;
};
struct NewExpr {
  std::string class_name;
  Span class_span;
  ExprPtr count;
};  // count may be null
struct AllExpr {
  std::string class_name;
  Span class_span;
};
struct Unary {
  UnaryOp op;
  ExprPtr operand;
};
/// first op1 e1 op2 e2 ... of one precedence level, left-associative: a long sum is one node, not a deep tree.
struct Chain {
  ExprPtr first;
  std::vector<std::pair<BinaryOp, ExprPtr>> rest;
  std::vector<Span> operators;
};
struct Magnitude {
  ExprPtr operand;
};  // |e|
/// target = value, or target op= value. The target is a Name, ArrayItem, IndexExpr or Member.
struct Assign {
  ExprPtr target;
  std::optional<BinaryOp> op;
  ExprPtr value;
  bool value_is_bare_call = false;
};
struct Step {
  ExprPtr target;
  int delta;
};  // target++ or target--, yields the new value
struct Push {
  ExprPtr value, list;
  bool front;
};  // push/prepend value onto list
struct Pop {
  ExprPtr list;
  bool front;
};  // pop/unprepend list
struct Insert {
  ExprPtr value, list, index;
};
struct Remove {
  ExprPtr base, index;
};  // of a list or a hash
struct CopyList {
  ExprPtr list;
};
struct Sort {
  ExprPtr list;
  std::string selector;
  Span selector_span;
};

struct Expr {
  std::variant<IntLit, DoubleLit, StringLit, ConstantExpr, VectorLit, MatrixLit, ListLit, Name, ArrayItem, IndexExpr,
               Member, Self, Super, Call, FunctionCall, RandomExpr, NewExpr, AllExpr, Unary, Chain, Magnitude, Assign,
               Step, Push, Pop, Insert, Remove, CopyList, Sort>
      node;
  Span span;
  bool parenthesised = false;
};

// --- statements ------------------------------------------------------------------------------------------------------

struct Block {
  std::vector<StmtPtr> body;
};           // also the empty statement {}
struct If {  // else-if chains are flat
  std::vector<std::pair<ExprPtr, StmtPtr>> branches;
  StmtPtr otherwise;  // may be null
};
struct While {
  ExprPtr condition;
  StmtPtr body;
};
struct For {
  ExprPtr start, condition, step;
  StmtPtr body;
};
struct Foreach {
  std::string variable;
  Span variable_span;
  ExprPtr list;
  StmtPtr body;
};
struct ExprStmt {
  ExprPtr expr;
};
struct Print {
  std::vector<ExprPtr> items;
  bool newline;
};
struct Return {
  ExprPtr value;
};  // may be null
struct Free {
  ExprPtr value;
};
struct Die {
  ExprPtr value;
};

struct Stmt {
  std::variant<Block, If, While, For, Foreach, ExprStmt, Print, Return, Free, Die> node;
  Span span;
};

// --- declarations ----------------------------------------------------------------------------------------------------

struct Variable {
  std::string name;
  TypeRef type;
  Span span;
};

struct Parameter {
  std::string keyword, variable;
  TypeRef type;
  std::optional<Constant> default_value;
  Span keyword_span, variable_span;
};

struct Method {
  std::string name;
  std::vector<Parameter> parameters;
  std::vector<Variable> locals;
  std::vector<StmtPtr> body;
  std::string doc;        // the % lines inside or before it, without the %
  bool is_public = true;  // written with +
  bool broken = false;    // a statement of it could not be read
  /// Embedded library and classes of the host only: `@native "name" (type).` in place of a body. The type is that of
  /// the result; none: no value.
  std::optional<std::string> native;
  std::optional<TypeRef> native_result;
  bool native_dynamic = false;  // `(?)`: the result's type varies
  Span span, name_span;
};

struct Class {
  std::string name, alias, parent;  // parent "NULL": a root class
  double version = 1.0;
  std::vector<Variable> variables;
  std::vector<Method> methods;
  std::string doc;
  Span span, name_span, parent_span, alias_span;
};

/// A directive that loads or configures, in order of appearance.
struct Directive {
  enum class Kind : std::uint8_t { Include, Use, Path, Plugin, NibFile, Controller } kind;
  std::string text;        // file, class, directory
  std::string entry;       // Plugin: the entry point
  std::string version_op;  // Use [version OP f]
  double version = 0;
  Span span;
};

struct File {
  std::vector<Directive> directives;
  std::vector<Class> classes;
  std::string doc;
};

}  // namespace breve::steve::ast
