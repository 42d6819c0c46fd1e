// What a program is made of, as the host reads it: symbols, names at places, completions; and the class library's
// texts.
#include "breve/analysis.h"

#include <set>

#include "modules.hpp"
#include "steve/analysis/analysis.hpp"
#include "steve/library/library.hpp"

namespace breve::host {

/// A name that may stand somewhere, with texts of its own.
struct CompletionTexts {
  steve::Completions given;
  std::vector<breve_completion> views;
};

namespace {

static_assert(static_cast<int>(steve::NameKind::Module) == BREVE_NAME_MODULE);
static_assert(static_cast<int>(steve::NameKind::Word) == BREVE_NAME_WORD);
static_assert(steve::kNoIndex == BREVE_NO_SYMBOL);

breve_name_kind kind_of(steve::NameKind kind) { return static_cast<breve_name_kind>(kind); }

}  // namespace
}  // namespace breve::host

struct breve_analysis {
  std::unique_ptr<breve::steve::Analysis> analysis;
  std::vector<breve::host::DiagnosticText> diagnostics;
  // What the functions that look at it have given last.
  mutable breve::host::CompletionTexts completions;
  mutable std::string keyword;                       // of breve_analysis_callees
  mutable std::set<std::string, std::less<>> texts;  // given with references

  const char* text(std::string_view view) const {
    const auto known = texts.find(view);
    return (known != texts.end() ? known : texts.emplace(view).first)->c_str();
  }
};

namespace breve::host {
namespace {

breve_span span_of(const steve::Sources& sources, const steve::Span& span) {
  if (span.line == 0) return {"", 0, 0, 0, 0, 0, 0};
  const steve::Span end = sources.span_at(span.file, span.offset + span.length, 0);
  return {sources.file(span.file).name.c_str(), span.line, span.column, end.line, end.column, span.offset, span.length};
}

/// A place in one of the files. BREVE_ERROR_NOT_FOUND if there is no such file or place.
struct Position {
  std::uint32_t file, offset;
};

Position position_of(const breve_analysis& a, const char* file, uint32_t line, uint32_t column) {
  need(file, "file");
  const auto number = a.analysis->file_named(file);
  if (!number) fail(BREVE_ERROR_NOT_FOUND, "the program has no file '" + std::string(file) + "'");
  const auto offset = a.analysis->offset_of(*number, line, column);
  if (!offset) fail(BREVE_ERROR_NOT_FOUND, "the file has no such line or column");
  return {*number, *offset};
}

template <class From, class To, class Convert>
void copy_out(const From& from, To* to, size_t capacity, size_t* count, Convert&& convert) {
  for (std::size_t i = 0; i < from.size() && i < capacity; ++i) to[i] = convert(from[i]);
  *count = from.size();
}

void need_room(const void* room, size_t capacity, const void* count, const char* what) {
  if (capacity != 0) need(room, what);
  need(count, "count");
}

void give(const breve_analysis& a, steve::Completions found, uint32_t* typed, breve_completion* items, size_t capacity,
          size_t* count) {
  CompletionTexts& kept = a.completions;
  kept.given = std::move(found);
  kept.views.clear();
  for (const auto& item : kept.given.items)
    kept.views.push_back({kind_of(item.kind), item.name.c_str(), item.detail.c_str(), item.owner.c_str(),
                          item.doc.c_str(), item.symbol});
  if (typed) *typed = kept.given.typed;
  copy_out(kept.views, items, capacity, count, [](const breve_completion& item) { return item; });
}

}  // namespace
}  // namespace breve::host

using namespace breve::host;

size_t breve_library_module_count(void) { return breve::steve::library_files().size(); }

breve_status breve_library_module(size_t index, breve_source* module) {
  return guard([&] {
    need(module, "module");
    const auto files = breve::steve::library_files();
    if (index >= files.size()) fail(BREVE_ERROR_NOT_FOUND, "there is no such module");
    *module = {files[index].name.data(), files[index].text.data(), files[index].text.size(), true, false};
  });
}

breve_status breve_analysis_create(breve_runtime* runtime, const char* name, const char* text, size_t size,
                                   breve_analysis** analysis) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(name, "name");
    need(analysis, "analysis");
    if (size != 0) need(text, "text");
    const BusyScope busy(*runtime);
    HostModules modules(*runtime);
    breve::steve::ModuleSource main =
        text ? breve::steve::ModuleSource{name, std::string(text, size)} : main_module(*runtime, modules, name);
    auto made = std::make_unique<breve_analysis>();
    made->analysis = std::make_unique<breve::steve::Analysis>(std::move(main), modules, runtime->allowed,
                                                              runtime->functions, runtime->classes);
    for (const auto& d : made->analysis->diagnostics())
      made->diagnostics.push_back(text_of(d, made->analysis->sources()));
    *analysis = made.release();
  });
}

void breve_analysis_destroy(breve_analysis* analysis) { delete analysis; }

size_t breve_analysis_diagnostic_count(const breve_analysis* analysis) {
  return analysis ? analysis->diagnostics.size() : 0;
}

breve_status breve_analysis_diagnostic(const breve_analysis* analysis, size_t index, breve_diagnostic* diagnostic) {
  return guard([&] {
    need(analysis, "analysis");
    need(diagnostic, "diagnostic");
    if (index >= analysis->diagnostics.size()) fail(BREVE_ERROR_NOT_FOUND, "there is no such diagnostic");
    *diagnostic = view_of(analysis->diagnostics[index]);
  });
}

size_t breve_analysis_file_count(const breve_analysis* analysis) {
  return analysis ? analysis->analysis->sources().size() : 0;
}

breve_status breve_analysis_file(const breve_analysis* analysis, size_t index, breve_source* file) {
  return guard([&] {
    need(analysis, "analysis");
    need(file, "file");
    const auto& sources = analysis->analysis->sources();
    if (index >= sources.size()) fail(BREVE_ERROR_NOT_FOUND, "there is no such file");
    const auto& source = sources.file(static_cast<std::uint32_t>(index));
    *file = {source.name.c_str(), source.text.c_str(), source.text.size(), source.embedded,
             analysis->analysis->loaded(static_cast<std::uint32_t>(index))};
  });
}

size_t breve_analysis_symbol_count(const breve_analysis* analysis) {
  return analysis ? analysis->analysis->symbols().size() : 0;
}

breve_status breve_analysis_symbol(const breve_analysis* analysis, size_t index, breve_symbol* symbol) {
  return guard([&] {
    need(analysis, "analysis");
    need(symbol, "symbol");
    const auto& symbols = analysis->analysis->symbols();
    if (index >= symbols.size()) fail(BREVE_ERROR_NOT_FOUND, "there is no such symbol");
    const breve::steve::SymbolInfo& s = symbols[index];
    const auto& sources = analysis->analysis->sources();
    *symbol = {kind_of(s.kind),
               s.name.c_str(),
               s.signature.c_str(),
               s.type.c_str(),
               s.value.c_str(),
               s.doc.c_str(),
               s.owner.c_str(),
               s.parent_class.c_str(),
               s.alias.c_str(),
               s.parent,
               span_of(sources, s.name_span),
               span_of(sources, s.span),
               s.library,
               s.loaded,
               s.hidden};
  });
}

breve_status breve_analysis_name_at(const breve_analysis* analysis, const char* file, uint32_t line, uint32_t column,
                                    breve_reference* reference) {
  return guard([&] {
    need(analysis, "analysis");
    need(reference, "reference");
    const Position position = position_of(*analysis, file, line, column);
    const auto found = analysis->analysis->at(position.file, position.offset);
    if (!found) fail(BREVE_ERROR_NOT_FOUND, "there is no name");
    *reference = {kind_of(found->kind),
                  analysis->text(found->name),
                  analysis->text(found->type),
                  analysis->text(found->signature),
                  analysis->text(found->doc),
                  span_of(analysis->analysis->sources(), found->span),
                  found->symbol,
                  found->declaration};
  });
}

breve_status breve_analysis_definitions(const breve_analysis* analysis, const char* file, uint32_t line,
                                        uint32_t column, size_t* symbols, size_t capacity, size_t* count) {
  return guard([&] {
    need(analysis, "analysis");
    need_room(symbols, capacity, count, "symbols");
    const Position position = position_of(*analysis, file, line, column);
    const auto found = analysis->analysis->definitions(position.file, position.offset);
    if (!found) fail(BREVE_ERROR_NOT_FOUND, "there is no name");
    copy_out(*found, symbols, capacity, count, [](std::size_t symbol) { return symbol; });
  });
}

breve_status breve_analysis_references(const breve_analysis* analysis, size_t symbol, breve_span* spans,
                                       size_t capacity, size_t* count) {
  return guard([&] {
    need(analysis, "analysis");
    need_room(spans, capacity, count, "spans");
    if (symbol >= analysis->analysis->symbols().size()) fail(BREVE_ERROR_NOT_FOUND, "there is no such symbol");
    copy_out(analysis->analysis->references(symbol), spans, capacity, count,
             [&](const auto& span) { return span_of(analysis->analysis->sources(), span); });
  });
}

breve_status breve_analysis_callees(const breve_analysis* analysis, const char* file, uint32_t line, uint32_t column,
                                    size_t* symbols, size_t capacity, size_t* count, const char** keyword) {
  return guard([&] {
    need(analysis, "analysis");
    need_room(symbols, capacity, count, "symbols");
    const Position position = position_of(*analysis, file, line, column);
    auto found = analysis->analysis->call_at(position.file, position.offset);
    if (!found) fail(BREVE_ERROR_NOT_FOUND, "the position is not in a call");
    analysis->keyword = std::move(found->keyword);
    if (keyword) *keyword = analysis->keyword.c_str();
    copy_out(found->methods, symbols, capacity, count, [](std::size_t symbol) { return symbol; });
  });
}

breve_status breve_analysis_completions(const breve_analysis* analysis, const char* file, uint32_t line,
                                        uint32_t column, uint32_t* typed, breve_completion* items, size_t capacity,
                                        size_t* count) {
  return guard([&] {
    need(analysis, "analysis");
    need_room(items, capacity, count, "items");
    const Position position = position_of(*analysis, file, line, column);
    give(*analysis, analysis->analysis->completions(position.file, position.offset), typed, items, capacity, count);
  });
}

breve_status breve_analysis_statement_completions(const breve_analysis* analysis, const char* class_name,
                                                  const char* text, size_t size, size_t offset, uint32_t* typed,
                                                  breve_completion* items, size_t capacity, size_t* count) {
  return guard([&] {
    need(analysis, "analysis");
    need_room(items, capacity, count, "items");
    if (size != 0) need(text, "text");
    if (offset > size) fail(BREVE_ERROR_ARGUMENT, "the position is beyond the end of the text");
    auto found = analysis->analysis->statement_completions(class_name ? class_name : "", {text ? text : "", size},
                                                           static_cast<std::uint32_t>(offset));
    if (!found) fail(BREVE_ERROR_NOT_FOUND, "there is no class '" + std::string(class_name) + "'");
    give(*analysis, std::move(*found), typed, items, capacity, count);
  });
}
