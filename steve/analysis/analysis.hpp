// What a program is made of: its symbols, which name stands where and what it means, and which may stand there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "steve/compile/compile.hpp"
#include "steve/syntax/diagnostic.hpp"
#include "steve/syntax/source.hpp"

namespace breve::steve {

// KEEP IN STEP: breve_name_kind in breve.h.
enum class NameKind : std::uint8_t {
  Module,
  Class,
  Method,
  Keyword,
  Parameter,
  Variable,
  Local,
  Function,
  Constant,
  Type,
  Directive,
  Word
};

/// No symbol, no class: the number of nothing.
inline constexpr std::size_t kNoIndex = static_cast<std::size_t>(-1);

/// Something with a name. The texts are as breve_symbol in breve.h describes them.
struct SymbolInfo {
  NameKind kind = NameKind::Module;
  std::string name, signature, type, value, doc, owner, parent_class, alias;
  std::size_t parent = kNoIndex;
  Span name_span, span;  // line 0: no place
  bool library = false, loaded = false, hidden = false;
};

/// A name at a place. Its texts live as long as the analysis that gave it.
struct Reference {
  NameKind kind = NameKind::Word;
  std::string_view name, type, signature, doc;
  Span span;
  std::size_t symbol = kNoIndex;
  bool declaration = false;
};

/// A name that may stand at a place.
struct Completion {
  NameKind kind = NameKind::Word;
  std::string name, detail, owner, doc;
  std::size_t symbol = kNoIndex;
};

struct Completions {
  std::uint32_t typed = 0;  // bytes before the place that the name is to replace
  std::vector<Completion> items;
};

/// The call around a place.
struct CallContext {
  std::vector<std::size_t> methods;  // symbols, best first
  std::string keyword;               // whose value stands there; "" before the first
};

struct Model;
struct Token;
struct Use;

/// One moment's text of a program, looked at from all sides. Never changes.
class Analysis {
 public:
  /// Reads the main module and all that it loads, as `compile` does. Errors of the program are its diagnostics.
  /// @param allowed  codes of lints that are not to be reported
  Analysis(ModuleSource main, ModuleResolver& resolver, const AllowedLints& allowed = {},
           const ForeignFunctions& foreign = {}, const ForeignClasses& classes = {});
  ~Analysis();
  Analysis(const Analysis&) = delete;
  Analysis& operator=(const Analysis&) = delete;

  const Sources& sources() const;
  bool loaded(std::uint32_t file) const;  // by the program; else a module of the class library that it does not use
  const std::vector<Diagnostic>& diagnostics() const;
  const std::vector<SymbolInfo>& symbols() const;

  /// The file of that name; nothing if there is none.
  std::optional<std::uint32_t> file_named(std::string_view name) const;
  /// A place as an offset; nothing if the file has no such line or column. The end of a line is a place.
  std::optional<std::uint32_t> offset_of(std::uint32_t file, std::uint32_t line, std::uint32_t column) const;

  /// The name in which, or just behind which, a place is.
  std::optional<Reference> at(std::uint32_t file, std::uint32_t offset) const;
  /// What that name may mean, best first; nothing if there is no name.
  std::optional<std::vector<std::size_t>> definitions(std::uint32_t file, std::uint32_t offset) const;
  /// Where the program's own files name a symbol, its declaration included, in order.
  std::vector<Span> references(std::size_t symbol) const;
  std::optional<CallContext> call_at(std::uint32_t file, std::uint32_t offset) const;
  Completions completions(std::uint32_t file, std::uint32_t offset) const;
  /// The same for a statement outside of any file. Returns nothing if there is no class of that name; "" means no
  /// class.
  std::optional<Completions> statement_completions(std::string_view class_name, std::string_view text,
                                                   std::uint32_t offset) const;

 private:
  const Use* use_at(std::uint32_t file, std::uint32_t offset) const;
  const Token* name_at(std::uint32_t file, std::uint32_t offset) const;
  std::vector<std::size_t> meanings(const Use& use) const;
  std::size_t first_meaning(const Use& use) const;

  std::unique_ptr<Model> model_;
  std::vector<Use> uses_;  // in order of files and places
};

}  // namespace breve::steve
