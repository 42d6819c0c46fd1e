// Questions about places, answered from the list of uses: what stands there, what it means, where else it stands.
#include "steve/analysis/analysis.hpp"

#include <algorithm>

#include "steve/analysis/completions.hpp"
#include "steve/analysis/model.hpp"
#include "steve/analysis/types.hpp"
#include "steve/analysis/uses.hpp"
#include "steve/analysis/word_notes.hpp"

namespace breve::steve {

Analysis::Analysis(ModuleSource main, ModuleResolver& resolver, const AllowedLints& allowed,
                   const ForeignFunctions& foreign, const ForeignClasses& classes)
    : model_(std::make_unique<Model>(read_model(std::move(main), resolver, allowed, foreign, classes))),
      uses_(find_uses(*model_)) {}

Analysis::~Analysis() = default;

const Sources& Analysis::sources() const { return model_->sources; }
bool Analysis::loaded(std::uint32_t file) const { return model_->files[file].loaded; }
const std::vector<Diagnostic>& Analysis::diagnostics() const { return model_->diagnostics; }
const std::vector<SymbolInfo>& Analysis::symbols() const { return model_->symbols; }

std::optional<std::uint32_t> Analysis::file_named(std::string_view name) const {
  for (std::uint32_t i = 0; i < model_->sources.size(); ++i)
    if (model_->sources.file(i).name == name) return i;
  return std::nullopt;
}

std::optional<std::uint32_t> Analysis::offset_of(std::uint32_t file, std::uint32_t line, std::uint32_t column) const {
  const SourceFile& source = model_->sources.file(file);
  if (line == 0 || column == 0 || line > source.lines.size()) return std::nullopt;
  const Span at{file, 0, 0, line, column};
  if (column - 1 > model_->sources.line_text(at).size()) return std::nullopt;
  return source.lines[line - 1] + column - 1;
}

// Names touch one another only at a point where the later one begins: that one is meant.
const Use* Analysis::use_at(std::uint32_t file, std::uint32_t offset) const {
  const auto after = std::upper_bound(uses_.begin(), uses_.end(), offset, [&](std::uint32_t position, const Use& use) {
    return use.span.file != file ? file < use.span.file : position < use.span.offset;
  });
  // A keyword and its parameter may be one word, declared twice at one place.
  const Use* found = nullptr;
  for (auto at = after; at != uses_.begin();) {
    --at;
    if (at->span.file != file || (found != nullptr && at->span.offset != found->span.offset)) break;
    if (offset > at->span.offset + at->span.length) break;
    found = &*at;
  }
  return found;
}

std::optional<Reference> Analysis::at(std::uint32_t file, std::uint32_t offset) const {
  Reference result;
  if (const Use* use = use_at(file, offset)) {
    result = {use->kind, use->name, use->type, {}, {}, use->span, first_meaning(*use), use->declaration};
  } else if (const Token* token = name_at(file, offset)) {
    const Use guess = guess_use(*model_, *token);
    result = {guess.kind, token->text, {}, {}, {}, token->span, first_meaning(guess), false};
    if (guess.symbol != kNoIndex) result.type = model_->symbols[guess.symbol].type;
  } else {
    return std::nullopt;
  }
  if (result.symbol != kNoIndex) {
    result.signature = model_->symbols[result.symbol].signature;
    result.doc = model_->symbols[result.symbol].doc;
  } else if (const WordNote* note = word_note(result.name); note != nullptr && result.kind >= NameKind::Type) {
    result.signature = note->usage;
    result.doc = note->note;
  }
  return result;
}

// For a name that the trees do not have, because its statement is broken.
const Token* Analysis::name_at(std::uint32_t file, std::uint32_t offset) const {
  const std::vector<Token>& tokens = model_->files[file].tokens;
  const auto after = std::partition_point(tokens.begin(), tokens.end(),
                                          [&](const Token& token) { return token.span.offset <= offset; });
  for (auto at = after; at != tokens.begin() && after - at < 2;) {
    --at;
    if (at->kind == TokenKind::Name && offset <= at->span.offset + at->span.length) return &*at;
  }
  return nullptr;
}

std::size_t Analysis::first_meaning(const Use& use) const {
  const std::vector<std::size_t> symbols = meanings(use);
  return symbols.empty() ? kNoIndex : symbols.front();
}

std::optional<std::vector<std::size_t>> Analysis::definitions(std::uint32_t file, std::uint32_t offset) const {
  if (const Use* use = use_at(file, offset)) return meanings(*use);
  if (const Token* token = name_at(file, offset)) return meanings(guess_use(*model_, *token));
  return std::nullopt;
}

// A receiver's guessed class may be too general: if it does not answer, any class may.
std::vector<std::size_t> Analysis::meanings(const Use& use) const {
  if (use.symbol != kNoIndex) return {use.symbol};
  const bool keyword = use.kind == NameKind::Keyword;
  if (use.kind != NameKind::Method && !keyword) return {};
  const std::string_view selector = keyword ? use.selector : use.name;
  std::vector<MethodIndex> found = methods_of_call(*model_, use.receiver, selector, use.keywords);
  if (found.empty()) found = methods_of_call(*model_, {}, selector, use.keywords);
  std::vector<std::size_t> result;
  for (const MethodIndex& index : found) {
    const MethodModel& method = model_->method(index);
    if (!keyword) {
      result.push_back(method.symbol);
      continue;
    }
    for (std::size_t i = 0; i < method.tree->parameters.size(); ++i)
      if (method.tree->parameters[i].keyword == use.name) result.push_back(method.parameters + 2 * i);
  }
  return result;
}

std::vector<Span> Analysis::references(std::size_t symbol) const {
  std::vector<Span> result;
  const SymbolInfo& wanted = model_->symbols[symbol];
  for (const Use& use : uses_) {
    const bool own = model_->files[use.span.file].loaded && !model_->sources.file(use.span.file).embedded;
    if (!own || use.kind != wanted.kind || (use.name != wanted.name && use.name != wanted.alias)) continue;
    const std::vector<std::size_t> symbols = meanings(use);
    if (std::find(symbols.begin(), symbols.end(), symbol) != symbols.end()) result.push_back(use.span);
  }
  return result;
}

std::optional<CallContext> Analysis::call_at(std::uint32_t file, std::uint32_t offset) const {
  return find_call(*model_, file, offset);
}

Completions Analysis::completions(std::uint32_t file, std::uint32_t offset) const {
  return complete(*model_, file, offset);
}

std::optional<Completions> Analysis::statement_completions(std::string_view class_name, std::string_view text,
                                                           std::uint32_t offset) const {
  const std::size_t cls = model_->class_named(class_name);
  if (cls == kNoIndex && !class_name.empty()) return std::nullopt;
  return complete_statement(*model_, cls, text, offset);
}

}  // namespace breve::steve
