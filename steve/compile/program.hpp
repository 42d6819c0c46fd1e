// A compiled program: classes, methods, bytecode, constants. Never changes once made; shared by any number of worlds.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "runtime/base/ids.hpp"
#include "steve/compile/lint_table.hpp"
#include "steve/machine/foreign.hpp"
#include "steve/machine/native.hpp"
#include "steve/machine/value.hpp"
#include "steve/syntax/diagnostic.hpp"
#include "steve/syntax/parser.hpp"

namespace breve::steve {

/// For tables of names that are asked with any text, also one of megabytes.
struct NameHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view name) const {
    constexpr std::size_t kMost = 1000;
    return std::hash<std::string_view>()(name.substr(0, kMost));
  }
};
template <class T>
using NameTable = std::unordered_map<std::string, T, NameHash, std::equal_to<>>;

using Symbol = std::uint32_t;
inline constexpr Symbol kNoSymbol = 0xffffffffU;

/// Names to numbers, in order of first use.
class SymbolTable {
 public:
  SymbolTable() = default;
  SymbolTable(const SymbolTable& other);
  SymbolTable& operator=(const SymbolTable&) = delete;
  Symbol intern(std::string_view name);
  Symbol find(std::string_view name) const;  // kNoSymbol if it was never interned
  const std::string& name(Symbol symbol) const { return *names_[symbol]; }
  std::size_t size() const { return names_.size(); }
  void truncate(std::size_t count);  // forget the names behind the first `count`

 private:
  NameTable<Symbol> by_name_;
  std::vector<const std::string*> names_;
};

struct ClassInfo;
struct CodeTables;

/// A type as the compiler knows it. Any: a dynamic value with its tag.
enum class StaticType : std::uint8_t {
  Null,
  Int,
  Double,
  Vector,
  Matrix,
  String,
  Object,
  List,
  Hash,
  Pointer,
  Data,
  Any
};

int slot_count(StaticType type);
inline StaticType static_type(ast::TypeKind kind) {
  return static_cast<StaticType>(static_cast<int>(kind) + 1);  // KEEP IN STEP: ast::TypeKind, StaticType
}
static_assert(static_cast<int>(ast::TypeKind::Int) + 1 == static_cast<int>(StaticType::Int));
static_assert(static_cast<int>(ast::TypeKind::Data) + 1 == static_cast<int>(StaticType::Data));

/// In place of an array's size: the declaration is broken, and that is reported already.
inline constexpr std::int32_t kBrokenType = -2;

struct VariableInfo {
  Symbol name = kNoSymbol;
  StaticType type = StaticType::Int;
  std::int32_t array_size = -1;   // >= 0: an array
  Symbol class_name = kNoSymbol;  // (ClassName object): instances of that class or a descendant only
  std::uint32_t slot = 0;         // first slot in the instance
  Span span;
};

struct ParameterInfo {
  Symbol keyword = kNoSymbol, variable = kNoSymbol;
  StaticType type = StaticType::Int;
  Symbol class_name = kNoSymbol;
  std::uint32_t slot = 0;  // first slot in the frame
  bool has_default = false;
  bool default_fails = false;  // a default that cannot be converted to the type: an error when it is needed
  std::array<double, 9> default_numbers{};  // int, double, vector, matrix; references start as null
  std::uint32_t default_string = 0;         // string: number of the constant + 1; 0 = empty
};

struct Function;  // bytecode; steve/compile/bytecode.hpp

struct MethodInfo {
  Symbol name = kNoSymbol;
  const ClassInfo* owner = nullptr;
  std::vector<ParameterInfo> parameters;
  std::unique_ptr<Function> function;  // null for a native method
  NativeFunction native = nullptr;
  const ForeignMethod* foreign = nullptr;       // what its function calls, for one of a ForeignClass
  StaticType native_result = StaticType::Null;  // of a native or foreign method
  std::string doc;
  Span span;  // of the header
  MethodInfo();
  ~MethodInfo();
  MethodInfo(MethodInfo&&) noexcept;
};

struct ClassInfo {
  ClassId id = kNoClass;
  std::string name, alias, doc;
  const ClassInfo* parent = nullptr;
  std::uint32_t depth = 0;  // ancestors
  double version = 1.0;
  std::vector<VariableInfo> variables;               // its own; ancestors' come before in the instance; add_variable
  std::uint32_t slot_count = 0;                      // with ancestors
  std::vector<std::uint16_t> reference_slots;        // with ancestors: slots that hold a Cell*
  std::vector<std::unique_ptr<MethodInfo>> methods;  // its own; add_method
  std::vector<const MethodInfo*> init_chain, delete_chain;  // root first
  const MethodInfo* iterate = nullptr;                      // inherited ones too; null if there is none
  const MethodInfo* post_iterate = nullptr;
  const MethodInfo* destroy = nullptr;
  const MethodInfo* get_description = nullptr;
  Span span;

  void add_variable(const VariableInfo& variable);
  void add_method(std::unique_ptr<MethodInfo> method);
  const MethodInfo* own_method(Symbol name, std::size_t count) const;
  bool derives_from(const ClassInfo& other) const {
    for (const ClassInfo* c = this; c; c = c->parent)
      if (c == &other) return true;
    return false;
  }
  const VariableInfo* find_variable(Symbol name) const;                 // own or inherited; the most derived wins
  const MethodInfo* find_method(Symbol name, std::size_t count) const;  // own or inherited, exactly `count` parameters
  bool responds(Symbol name) const;                                     // any number of parameters

 private:
  std::unordered_map<Symbol, std::size_t> variable_places_;        // in `variables`: of several, the first
  std::unordered_map<std::uint64_t, const MethodInfo*> by_count_;  // by name and number of parameters, likewise
  std::unordered_set<Symbol> responds_;
};

class Program {
 public:
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  const ClassInfo* find_class(std::string_view name_or_alias) const;  // null if there is none
  const ClassInfo& cls(ClassId id) const { return *classes_[id]; }
  const std::vector<std::shared_ptr<ClassInfo>>& classes() const { return classes_; }
  const ClassInfo* controller_class() const { return controller_; }
  const SymbolTable& symbols() const { return symbols_; }
  const Sources& sources() const { return sources_; }
  std::uint64_t fingerprint() const { return fingerprint_; }                   // of all sources, for snapshots
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }  // warnings
  const CodeTables& code() const { return *code_; }
  const ForeignFunctions& foreign() const { return foreign_; }
  const ForeignClasses& foreign_classes() const { return foreign_classes_; }  // those that it took in, parents first

 private:
  friend class CompileScope;
  friend class ProgramBuilder;
  friend class Fragments;
  Program();
  Program(const Program& base, std::size_t room);    // with room behind the tables for fragments (evaluate.cpp)
  std::vector<std::shared_ptr<ClassInfo>> classes_;  // shared with the programs that extend this one by fragments
  NameTable<ClassInfo*> class_names_;                // names and aliases
  const ClassInfo* controller_ = nullptr;
  SymbolTable symbols_;
  Sources sources_;
  Defines defines_;
  std::unique_ptr<CodeTables> code_;
  std::vector<Diagnostic> diagnostics_;
  std::uint64_t fingerprint_ = 0;
  ForeignFunctions foreign_;  // the methods of foreign_classes_ too
  ForeignClasses foreign_classes_;
  std::vector<std::shared_ptr<MethodInfo>> fragment_methods_;  // outlive their code: profiles name them
};

/// Finds the text of a module for the compiler. The command reads files; a host decides for itself.
struct ModuleSource {
  std::string name;  // as messages show it; two directives that give the same name mean the same file
  std::string text;
};
class ModuleResolver {
 public:
  virtual ~ModuleResolver() = default;
  /// @param name      as spelled in the directive ("Control.tz" for `@use Control.`)
  /// @param from      name of the file that asks, "" for the main file
  virtual std::optional<ModuleSource> resolve(std::string_view name, std::string_view from) = 0;
  virtual void add_path(std::string_view) {}  // @path
};

struct CompileResult {
  std::shared_ptr<const Program> program;  // null if there were errors
  Diagnostics diagnostics;
  Sources sources;  // for formatting diagnostics when there is no program
};

/// Compile a main file and all that it loads. The class library is always there for @use, without a search path.
/// @param allowed  codes of lints that are not to be reported
/// @param foreign  functions besides those of the language, each with a name of its own
/// @param classes  classes besides those of the class library; one that a file of the program defines wins
CompileResult compile(ModuleSource main, ModuleResolver& resolver, const AllowedLints& allowed = {},
                      const ForeignFunctions& foreign = {}, const ForeignClasses& classes = {});

/// The fault in the text of a ForeignClass by itself; "" if there is none.
std::string fault_of_foreign_class(const std::string& text);

/// A file of the embedded class library: the one named "NAME.tz", or the one that defines class NAME. Null if none.
struct LibraryFile {
  std::string_view name;  // "Shape.tz"
  std::string_view text;
  std::string_view classes;  // names and aliases defined in it, space-separated
};
const LibraryFile* find_library_file(std::string_view name);

}  // namespace breve::steve
