// Calls of analyses: of programs that compile and of texts that do not.
#include <algorithm>

#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_analyses {

constexpr std::size_t kMostAnalyses = 2;

breve_status library_module_count(Caller&) {
  require(breve_library_module_count() != 0, "no modules");
  return BREVE_OK;
}
void read_source(const breve_source& source) {
  read_text(source.name);
  require(source.text && source.text[source.size] == 0, "a source has no end");
}
breve_status library_module(Caller& c) {
  const std::size_t index = c.choose().below(breve_library_module_count() + 2);
  if (index >= breve_library_module_count()) c.expect_refusal();
  Out<breve_source> source(c);
  const breve_status status = source.after(breve_library_module(index, source.to()));
  if (source) read_source(*source);
  return status;
}

breve_status analysis_create(Caller& c) {
  breve_runtime* runtime = c.runtime();
  const bool may = c.analyses().size() < kMostAnalyses && c.chance(50);
  const char* name = c.text_or_null(may ? "scene.tz" : "Nowhere.tz");
  std::string_view text;
  if (may) {
    text = c.choose().one_of(call_programs());
    if (c.chance(40)) text = text.substr(0, c.choose().below(text.size()));
  }
  Out<breve_analysis*> made(c);
  const breve_status status =
      made.after(breve_analysis_create(runtime, name, text.empty() ? nullptr : text.data(), text.size(), made.to()));
  if (made) c.analyses().push_back(*made);
  return status;
}
breve_status analysis_destroy(Caller& c) {
  if (c.analyses().size() < 2 || c.called_back()) return breve_analysis_destroy(nullptr), BREVE_OK;
  breve_analysis* analysis = c.analyses().back();
  c.analyses().pop_back();
  breve_analysis_destroy(analysis);
  return BREVE_OK;
}

// --- what it holds ---------------------------------------------------------------------------------------------------

template <auto kCount>
breve_status count_of(Caller& c) {
  const breve_analysis* analysis = c.analysis();
  const std::size_t count = kCount(analysis);
  require(analysis || count == 0, "no analysis has something");
  return BREVE_OK;
}
/// A function that gives the item at an index.
template <class T, auto kGet, auto kCount, auto kRead>
breve_status item_of(Caller& c) {
  const breve_analysis* analysis = c.analysis();
  const std::size_t count = kCount(analysis);
  const std::size_t index = c.chance(10) ? c.word() : c.choose().below(count + 1);
  if (index >= count) c.expect_refusal();
  Out<T> item(c);
  const breve_status status = item.after(kGet(analysis, index, item.to()));
  if (item) kRead(*item);
  return status;
}
void read_diagnostic(const breve_diagnostic& told) {
  for (const char* text : {told.code, told.message, told.help, told.file, told.text}) read_text(text);
}
void read_symbol(const breve_symbol& symbol) {
  for (const char* text : {symbol.name, symbol.signature, symbol.type, symbol.value, symbol.documentation, symbol.owner,
                           symbol.parent_class, symbol.alias, symbol.name_span.file, symbol.span.file})
    read_text(text);
}

// --- places ----------------------------------------------------------------------------------------------------------

/// A place in a file of an analysis, or rarely any numbers.
struct Place {
  Place(Caller& c, const breve_analysis* analysis) {
    const std::size_t files = breve_analysis_file_count(analysis);
    breve_source source{};
    if (files != 0 && c.chance(90)) {
      // Mostly the text that was given: the first of them.
      const std::size_t index = c.chance(80) ? 0 : c.choose().below(files);
      require(breve_analysis_file(analysis, index, &source) == BREVE_OK, "an analysis has no file");
      const std::string_view before(source.text, c.choose().below(source.size + 1));
      line = 1 + static_cast<std::uint32_t>(std::count(before.begin(), before.end(), '\n'));
      column = static_cast<std::uint32_t>(before.size() - (before.rfind('\n') + 1)) + 1;  // npos + 1 is 0
    } else {
      line = c.word();
      column = c.word();
    }
    file = c.text_or_null(source.name ? source.name : "nowhere.tz");
  }
  const char* file = nullptr;
  std::uint32_t line = 0, column = 0;
};

breve_status analysis_at(Caller& c) {
  const breve_analysis* analysis = c.analysis();
  const Place at(c, analysis);
  Out<breve_reference> found(c);
  const breve_status status = found.after(breve_analysis_name_at(analysis, at.file, at.line, at.column, found.to()));
  if (found)
    for (const char* text : {found->name, found->type, found->signature, found->documentation, found->span.file})
      read_text(text);
  return status;
}
breve_status analysis_definitions(Caller& c) {
  const breve_analysis* analysis = c.analysis();
  const Place at(c, analysis);
  Room<std::size_t> symbols(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status = count.after(
      breve_analysis_definitions(analysis, at.file, at.line, at.column, symbols.to(), symbols.capacity(), count.to()));
  return symbols.after(status, count ? *count : 0);
}
breve_status analysis_references(Caller& c) {
  const breve_analysis* analysis = c.analysis();
  const std::size_t symbols = breve_analysis_symbol_count(analysis);
  const std::size_t symbol = c.chance(10) ? c.word() : c.choose().below(symbols + 1);
  if (symbol >= symbols) c.expect_refusal();
  Room<breve_span> spans(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status =
      count.after(breve_analysis_references(analysis, symbol, spans.to(), spans.capacity(), count.to()));
  spans.after(status, count ? *count : 0);
  for (const breve_span& span : spans.written()) read_text(span.file);
  return status;
}
breve_status analysis_call(Caller& c) {
  breve_analysis* analysis = c.analysis();
  const Place at(c, analysis);
  Room<std::size_t> symbols(c, c.capacity());
  Out<std::size_t> count(c);
  Out<const char*> keyword(c, true);
  const breve_status status = count.after(breve_analysis_callees(analysis, at.file, at.line, at.column, symbols.to(),
                                                                 symbols.capacity(), count.to(), keyword.to()));
  keyword.after(status);
  if (keyword) read_text(*keyword);
  return symbols.after(status, count ? *count : 0);
}

void read_completions(const Room<breve_completion>& items) {
  for (const breve_completion& item : items.written())
    for (const char* text : {item.name, item.detail, item.owner, item.documentation}) read_text(text);
}
breve_status analysis_completions(Caller& c) {
  breve_analysis* analysis = c.analysis();
  const Place at(c, analysis);
  Out<std::uint32_t> typed(c, true);
  Room<breve_completion> items(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status = count.after(breve_analysis_completions(analysis, at.file, at.line, at.column, typed.to(),
                                                                     items.to(), items.capacity(), count.to()));
  typed.after(status);
  items.after(status, count ? *count : 0);
  read_completions(items);
  return status;
}
breve_status analysis_statement_completions(Caller& c) {
  static constexpr std::string_view kTexts[] = {"", "self set-", "(new Mobile) mo", "x = new L", "\"$", "print @"};
  breve_analysis* analysis = c.analysis();
  const char* name = c.chance(40) ? nullptr : c.class_name();
  const std::string_view text = c.choose().one_of(kTexts);
  const std::size_t offset = c.chance(10) ? c.word() : c.choose().below(text.size() + 1);
  if (offset > text.size()) c.expect_refusal();
  Out<std::uint32_t> typed(c, true);
  Room<breve_completion> items(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status = count.after(breve_analysis_statement_completions(
      analysis, name, text.data(), text.size(), offset, typed.to(), items.to(), items.capacity(), count.to()));
  typed.after(status);
  items.after(status, count ? *count : 0);
  read_completions(items);
  return status;
}

constexpr Function kFunctions[] = {
    {"breve_library_module_count", library_module_count},
    {"breve_library_module", library_module, kNotFound},
    {"breve_analysis_create", analysis_create, kFile | kBusy, 3},
    {"breve_analysis_destroy", analysis_destroy},
    {"breve_analysis_diagnostic_count", count_of<breve_analysis_diagnostic_count>, kPlain},
    {"breve_analysis_diagnostic",
     item_of<breve_diagnostic, breve_analysis_diagnostic, breve_analysis_diagnostic_count, read_diagnostic>, kNotFound},
    {"breve_analysis_file_count", count_of<breve_analysis_file_count>, kPlain},
    {"breve_analysis_file", item_of<breve_source, breve_analysis_file, breve_analysis_file_count, read_source>,
     kNotFound},
    {"breve_analysis_symbol_count", count_of<breve_analysis_symbol_count>, kPlain},
    {"breve_analysis_symbol", item_of<breve_symbol, breve_analysis_symbol, breve_analysis_symbol_count, read_symbol>,
     kNotFound},
    {"breve_analysis_name_at", analysis_at, kNotFound, 2},
    {"breve_analysis_definitions", analysis_definitions, kNotFound},
    {"breve_analysis_references", analysis_references, kNotFound},
    {"breve_analysis_callees", analysis_call, kNotFound, 3},
    {"breve_analysis_completions", analysis_completions, kNotFound},
    {"breve_analysis_statement_completions", analysis_statement_completions, kNotFound},
};

}  // namespace call_analyses

std::span<const Function> analysis_functions() { return call_analyses::kFunctions; }

}  // namespace breve::fuzz
