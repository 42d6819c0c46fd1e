// The parts of an analysed program: texts, tokens, trees, classes and symbols. Trees are those of a parser that goes on
// after errors, so that a program that is being written also has them. Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "steve/analysis/analysis.hpp"
#include "steve/compile/compile.hpp"
#include "steve/syntax/parser.hpp"

namespace breve::steve {

/// A static type, as far as it is known. For a list, `cls` is the class of its elements.
struct KnownType {
  std::optional<ast::TypeKind> kind;
  std::size_t cls = kNoIndex;  // number of the class, not of its symbol
};

struct MethodModel {
  const ast::Method* tree = nullptr;
  std::size_t symbol = 0;
  std::size_t parameters = 0;  // symbol of the first parameter's keyword; keyword, parameter, keyword, ... follow
  std::size_t locals = 0;      // symbol of the first local; the others follow
};

struct ClassModel {
  const ast::Class* tree = nullptr;
  std::size_t symbol = 0;
  std::size_t variables = 0;  // symbol of the first instance variable; the others follow
  std::size_t parent = kNoIndex;
  bool loaded = false;
  std::vector<MethodModel> methods;
};

struct FileModel {
  std::vector<Token> tokens;  // including documentation, End last
  ast::File tree;
  std::size_t symbol = 0;
  bool loaded = false;
};

struct MethodIndex {
  std::size_t cls = kNoIndex, method = 0;
};

struct Model {
  Sources sources;
  std::vector<Diagnostic> diagnostics;
  std::vector<FileModel> files;  // as numbered in `sources`
  Defines defines;
  ForeignFunctions foreign;
  std::vector<SymbolInfo> symbols;
  std::vector<KnownType> types;  // of the symbols that are variables, parameters, keywords
  std::vector<ClassModel> classes;
  std::map<std::string, std::size_t, std::less<>> class_names;  // and aliases; the program's classes before others
  std::multimap<std::string, MethodIndex, std::less<>> selectors;
  std::map<std::string, std::size_t, std::less<>> constants;       // to symbols
  std::multimap<std::string, std::size_t, std::less<>> functions;  // to symbols
  std::size_t controller = kNoIndex;                               // class

  std::size_t class_named(std::string_view name) const;
  bool derives_from(std::size_t cls, std::size_t ancestor) const;
  /// The class itself, then its ancestors. Bounded, also where classes are each other's parents.
  std::vector<std::size_t> line(std::size_t cls) const;
  /// The symbol of a variable as a method sees it: parameter, local, instance variable; kNoIndex if there is none.
  std::size_t find_variable(std::size_t cls, const MethodModel* method, std::string_view name) const;
  /// The symbol of an instance variable, which may be inherited.
  std::size_t find_member(std::size_t cls, std::string_view name) const;
  const MethodModel& method(const MethodIndex& index) const { return classes[index.cls].methods[index.method]; }
};

/// Where in a class's text a place is.
struct Scope {
  std::size_t cls = kNoIndex;
  const MethodModel* method = nullptr;
};

/// Compile the program for its diagnostics, then read all its files and the rest of the class library.
Model read_model(ModuleSource main, ModuleResolver& resolver, const AllowedLints& allowed,
                 const ForeignFunctions& foreign, const ForeignClasses& classes);

/// Symbols of all files and functions, and the tables of names; the trees must have been read (symbols.cpp).
void make_symbols(Model& model);

/// The static types of variables, guessed from what is assigned to them where they are declared as a plain object or as
/// a list (types.cpp).
void guess_types(Model& model);

}  // namespace breve::steve
