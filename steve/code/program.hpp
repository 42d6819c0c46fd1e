// A compiled program: classes, methods, bytecode, constants. Never changes once made; shared by any number of worlds.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "runtime/base/ids.hpp"
#include "steve/code/foreign.hpp"
#include "steve/code/native.hpp"
#include "steve/code/types.hpp"
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
class LibrarySource;

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

struct Function;  // bytecode; steve/code/bytecode.hpp

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
  const MethodInfo* iterate = nullptr;                      // may be inherited; null if there is none
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
  std::unordered_map<Symbol, std::size_t> variable_indices_;       // in `variables`: of several, the first
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
  const LibrarySource& library() const { return *library_; }  // that it was compiled with
  const ForeignFunctions& foreign() const { return foreign_; }
  const ForeignClasses& foreign_classes() const { return foreign_classes_; }  // those that it took in, parents first

 private:
  friend class CompileScope;
  friend class ProgramBuilder;
  friend class Fragments;
  explicit Program(const LibrarySource& library);
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
  const LibrarySource* library_;
  ForeignFunctions foreign_;  // and the methods of foreign_classes_
  ForeignClasses foreign_classes_;
  std::vector<std::shared_ptr<MethodInfo>> fragment_methods_;  // outlive their code: profiles name them
};

}  // namespace breve::steve
