// Completion and signature help: what may be written at a place.
#include <algorithm>

#include "lsp_features.hpp"
#include "lsp_text.hpp"

namespace breve::command {

using nlohmann::json;

namespace {

/// The protocol's CompletionItemKind.
int item_kind(std::uint32_t kind) {
  switch (kind) {
    case BREVE_NAME_MODULE: return 9;
    case BREVE_NAME_CLASS: return 7;
    case BREVE_NAME_METHOD: return 2;
    case BREVE_NAME_KEYWORD: return 10;
    case BREVE_NAME_PARAMETER:
    case BREVE_NAME_LOCAL: return 6;
    case BREVE_NAME_VARIABLE: return 5;
    case BREVE_NAME_FUNCTION: return 3;
    case BREVE_NAME_CONSTANT: return 21;
    case BREVE_NAME_TYPE: return 25;
    case BREVE_NAME_DIRECTIVE:
    case BREVE_NAME_WORD: return 14;
  }
  return 1;
}

/// Keywords of a method that have no default, as they are written behind its name, with places for their values.
std::string keyword_snippet(const breve_analysis* analysis, std::size_t method) {
  std::string text;
  int field = 0;
  for (std::size_t i = method + 1; i < breve_analysis_symbol_count(analysis); ++i) {
    breve_symbol symbol;
    if (breve_analysis_symbol(analysis, i, &symbol) != BREVE_OK || symbol.parent != method) break;
    if (symbol.kind != BREVE_NAME_KEYWORD || *symbol.value) continue;
    breve_symbol parameter;
    if (breve_analysis_symbol(analysis, i + 1, &parameter) != BREVE_OK) break;
    text += std::string(" ") + symbol.name + " ${" + std::to_string(++field) + ":" + parameter.name + "}";
  }
  return text;
}

// A blank asks everywhere; it is meant only where a name of one kind must follow.
bool worth_showing_after_blank(const std::vector<breve_completion>& items) {
  if (items.empty()) return false;
  const std::uint32_t kind = items.front().kind;
  return items.size() == 1 || kind == BREVE_NAME_METHOD || kind == BREVE_NAME_KEYWORD || kind == BREVE_NAME_CLASS ||
         kind == BREVE_NAME_MODULE;
}

}  // namespace

json LspFeatures::completion_item(const ProgramView& program, const breve_completion& item) const {
  json entry = {{"label", item.name}, {"kind", item_kind(item.kind)}};
  std::string detail = item.detail;
  if (*item.owner) detail += std::string(" - ") + item.owner;
  if (!detail.empty()) entry["detail"] = detail;
  if (*item.documentation) entry["documentation"] = {{"kind", "markdown"}, {"value", item.documentation}};
  if (snippets_ && item.kind == BREVE_NAME_METHOD && item.symbol != BREVE_NO_SYMBOL) {
    const std::string keywords = keyword_snippet(program.analysis.get(), item.symbol);
    if (!keywords.empty()) {
      entry["insertText"] = item.name + keywords;
      entry["insertTextFormat"] = 2;
    }
  }
  return entry;
}

json LspFeatures::completion(const json& params) {
  const LspPosition where = position_of(params);
  json result = {{"isIncomplete", false}, {"items", json::array()}};
  if (where.file.program == nullptr) return result;
  const ProgramView& program = *where.file.program;
  breve_analysis* analysis = program.analysis.get();
  const char* name = where.file.name.c_str();
  std::size_t count = 0;
  std::uint32_t typed = 0;
  if (breve_analysis_completions(analysis, name, where.line, where.column, &typed, nullptr, 0, &count) != BREVE_OK)
    return result;
  std::vector<breve_completion> items(count);
  breve_analysis_completions(analysis, name, where.line, where.column, &typed, items.data(), count, &count);
  const json context = params.value("context", json::object());
  if (context.value("triggerCharacter", "") == " " && !worth_showing_after_blank(items)) return result;
  const breve_span span{name, where.line, where.column - typed, where.line, where.column, 0, 0};
  const json typed_range = range(program, span);
  std::size_t order = 0;
  for (const breve_completion& item : items) {
    json entry = completion_item(program, item);
    std::string rank = std::to_string(order++);
    entry["sortText"] = std::string(6 - std::min<std::size_t>(rank.size(), 6), '0') + rank;
    const std::string text = entry.value("insertText", std::string(item.name));
    entry["textEdit"] = {{"range", typed_range}, {"newText", text}};
    entry.erase("insertText");
    result["items"].push_back(std::move(entry));
  }
  return result;
}

json LspFeatures::signature_help(const json& params) {
  const LspPosition where = position_of(params);
  if (where.file.program == nullptr) return nullptr;
  breve_analysis* analysis = where.file.program->analysis.get();
  constexpr std::size_t kMost = 10;
  std::vector<std::size_t> methods(kMost);
  std::size_t count = 0;
  const char* keyword = "";
  if (breve_analysis_callees(analysis, where.file.name.c_str(), where.line, where.column, methods.data(), kMost, &count,
                             &keyword) != BREVE_OK ||
      count == 0)
    return nullptr;
  methods.resize(std::min(count, kMost));
  json signatures = json::array();
  for (const std::size_t method : methods) {
    breve_symbol symbol;
    if (breve_analysis_symbol(analysis, method, &symbol) != BREVE_OK) continue;
    json signature = {{"label", symbol.signature}, {"parameters", json::array()}};
    if (*symbol.documentation) signature["documentation"] = {{"kind", "markdown"}, {"value", symbol.documentation}};
    std::size_t active = 0;
    bool found = false;
    for (std::size_t i = method + 1; i < breve_analysis_symbol_count(analysis); ++i) {
      breve_symbol part;
      if (breve_analysis_symbol(analysis, i, &part) != BREVE_OK || part.parent != method) break;
      if (part.kind != BREVE_NAME_KEYWORD) continue;
      if (std::string_view(part.name) == keyword) active = signature["parameters"].size(), found = true;
      signature["parameters"].push_back({{"label", part.signature}});
    }
    // A number beyond the last marks none.
    signature["activeParameter"] = found ? active : signature["parameters"].size();
    signatures.push_back(std::move(signature));
  }
  if (signatures.empty()) return nullptr;
  return {
      {"signatures", signatures}, {"activeSignature", 0}, {"activeParameter", signatures.front()["activeParameter"]}};
}

}  // namespace breve::command
