// Hover, definitions, references, outlines, diagnostics.
#include "lsp_features.hpp"

#include <algorithm>

#include "lsp_text.hpp"

namespace breve::command {

using nlohmann::json;

namespace {

std::uint32_t number(const json& position, const char* name) {
  const auto value = position.at(name).get<std::int64_t>();
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(value, 0, 0x7fffffff));
}

json position(std::size_t line, std::size_t character) { return {{"line", line}, {"character", character}}; }

/// The protocol's SymbolKind.
int symbol_kind(std::uint32_t kind) {
  switch (kind) {
    case BREVE_NAME_MODULE: return 1;
    case BREVE_NAME_CLASS: return 5;
    case BREVE_NAME_METHOD: return 6;
    case BREVE_NAME_FUNCTION: return 12;
    case BREVE_NAME_CONSTANT: return 14;
    case BREVE_NAME_VARIABLE: return 8;
    default: return 13;
  }
}

std::vector<std::size_t> definitions_at(const LspPosition& position) {
  std::size_t count = 0;
  const breve_analysis* analysis = position.file.program->analysis.get();
  const char* name = position.file.name.c_str();
  if (breve_analysis_definitions(analysis, name, position.line, position.column, nullptr, 0, &count) != BREVE_OK)
    return {};
  std::vector<std::size_t> symbols(count);
  breve_analysis_definitions(analysis, name, position.line, position.column, symbols.data(), count, &count);
  return symbols;
}

std::string described(const breve_symbol& symbol) {
  std::string text = std::string("```steve\n") + symbol.signature;
  const bool typed = symbol.kind == BREVE_NAME_METHOD || symbol.kind == BREVE_NAME_FUNCTION;
  if (typed && *symbol.type) text += std::string(" -> ") + symbol.type;
  text += "\n```\n";
  if (*symbol.owner) text += std::string("of class ") + symbol.owner + (symbol.library ? " (class library)\n" : "\n");
  if (*symbol.documentation) text += std::string("\n") + symbol.documentation + "\n";
  return text;
}

}  // namespace

std::string_view text_of(const ProgramView& program, std::string_view name) {
  for (std::size_t i = 0; i < breve_analysis_file_count(program.analysis.get()); ++i) {
    breve_source file;
    if (breve_analysis_file(program.analysis.get(), i, &file) == BREVE_OK && name == file.name)
      return {file.text, file.size};
  }
  return {};
}

LspPosition LspFeatures::position_of(const json& params) {
  LspPosition result;
  const json& where = params.at("position");
  const std::uint32_t line = number(where, "line"), character = number(where, "character");
  result.file = workspace_.view(params.at("textDocument").at("uri").get<std::string>());
  if (result.file.program == nullptr) return result;
  const std::string_view text = text_of(*result.file.program, result.file.name);
  const std::vector<std::size_t> starts = line_starts(text);
  result.line = line + 1;
  result.column = static_cast<std::uint32_t>(byte_column(line_of(text, starts, line), character)) + 1;
  return result;
}

json LspFeatures::range(const ProgramView& program, const breve_span& span) const {
  const std::string_view text = text_of(program, span.file);
  const std::vector<std::size_t> starts = line_starts(text);
  const auto converted = [&](std::uint32_t line, std::uint32_t column) {
    if (line == 0) return position(0, 0);
    return position(line - 1, utf16_column(line_of(text, starts, line - 1), column - 1));
  };
  return {{"start", converted(span.line, span.column)}, {"end", converted(span.end_line, span.end_column)}};
}

json LspFeatures::location(const ProgramView& program, const breve_span& span) {
  const std::string uri = span.line == 0 ? std::string() : workspace_.uri_of(program, span.file);
  if (uri.empty()) return nullptr;
  return {{"uri", uri}, {"range", range(program, span)}};
}

json LspFeatures::hover(const json& params) {
  const LspPosition where = position_of(params);
  if (where.file.program == nullptr) return nullptr;
  const breve_analysis* analysis = where.file.program->analysis.get();
  breve_reference reference;
  if (breve_analysis_name_at(analysis, where.file.name.c_str(), where.line, where.column, &reference) != BREVE_OK)
    return nullptr;
  constexpr std::size_t kMost = 5;  // of methods that a call may mean
  std::string text;
  const std::vector<std::size_t> symbols = definitions_at(where);
  for (std::size_t i = 0; i < std::min(symbols.size(), kMost); ++i) {
    breve_symbol symbol;
    if (breve_analysis_symbol(analysis, symbols[i], &symbol) != BREVE_OK) continue;
    text += (text.empty() ? "" : "\n---\n") + described(symbol);
    breve_symbol method;
    const bool part = symbol.kind == BREVE_NAME_KEYWORD || symbol.kind == BREVE_NAME_PARAMETER;
    if (part && breve_analysis_symbol(analysis, symbol.parent, &method) == BREVE_OK)
      text += std::string("in `") + method.signature + "`\n";
    const bool guessed = symbol.kind == BREVE_NAME_VARIABLE || symbol.kind == BREVE_NAME_LOCAL;
    if (guessed && *reference.type && std::string_view(reference.type) != symbol.type)
      text += std::string("seems to hold: ") + reference.type + "\n";
  }
  if (symbols.size() > kMost) text += "\n---\nand " + std::to_string(symbols.size() - kMost) + " more\n";
  if (text.empty() && *reference.signature)
    text = std::string("```steve\n") + reference.signature + "\n```\n" + reference.documentation + "\n";
  if (text.empty()) return nullptr;
  return {{"contents", {{"kind", "markdown"}, {"value", text}}}, {"range", range(*where.file.program, reference.span)}};
}

json LspFeatures::definition(const json& params) {
  const LspPosition where = position_of(params);
  json result = json::array();
  if (where.file.program == nullptr) return result;
  for (const std::size_t number : definitions_at(where)) {
    breve_symbol symbol;
    if (breve_analysis_symbol(where.file.program->analysis.get(), number, &symbol) != BREVE_OK) continue;
    json found = location(*where.file.program, symbol.name_span);
    if (!found.is_null()) result.push_back(std::move(found));
  }
  return result;
}

json LspFeatures::references(const json& params) {
  const LspPosition where = position_of(params);
  json result = json::array();
  if (where.file.program == nullptr) return result;
  const std::vector<std::size_t> symbols = definitions_at(where);
  if (symbols.empty()) return result;
  const bool declarations = params.value("context", json::object()).value("includeDeclaration", true);
  const breve_analysis* analysis = where.file.program->analysis.get();
  breve_symbol symbol;
  std::size_t count = 0;
  if (breve_analysis_symbol(analysis, symbols.front(), &symbol) != BREVE_OK) return result;
  breve_analysis_references(analysis, symbols.front(), nullptr, 0, &count);
  std::vector<breve_span> spans(count);
  breve_analysis_references(analysis, symbols.front(), spans.data(), count, &count);
  for (const breve_span& span : spans) {
    const bool declaration =
        span.offset == symbol.name_span.offset && std::string_view(span.file) == symbol.name_span.file;
    if (declaration && !declarations) continue;
    json found = location(*where.file.program, span);
    if (!found.is_null()) result.push_back(std::move(found));
  }
  return result;
}

json LspFeatures::document_symbols(const json& params) {
  const FileView file = workspace_.view(params.at("textDocument").at("uri").get<std::string>());
  json result = json::array();
  if (file.program == nullptr) return result;
  const breve_analysis* analysis = file.program->analysis.get();
  std::size_t parent = BREVE_NO_SYMBOL;
  for (std::size_t i = 0; i < breve_analysis_symbol_count(analysis); ++i) {
    breve_symbol symbol;
    if (breve_analysis_symbol(analysis, i, &symbol) != BREVE_OK || file.name != symbol.name_span.file) continue;
    const bool top = symbol.kind == BREVE_NAME_CLASS || symbol.kind == BREVE_NAME_CONSTANT;
    const bool member = symbol.kind == BREVE_NAME_METHOD || symbol.kind == BREVE_NAME_VARIABLE;
    if (!top && !member) continue;
    json entry = {{"name", symbol.name},
                  {"detail", symbol.kind == BREVE_NAME_VARIABLE ? symbol.type : symbol.signature},
                  {"kind", symbol_kind(symbol.kind)},
                  {"range", range(*file.program, symbol.span)},
                  {"selectionRange", range(*file.program, symbol.name_span)}};
    if (entry["name"].get<std::string>().empty()) continue;
    if (symbol.kind == BREVE_NAME_CLASS) entry["children"] = json::array();
    if (top) {
      parent = symbol.kind == BREVE_NAME_CLASS ? i : BREVE_NO_SYMBOL;
      result.push_back(std::move(entry));
    } else if (symbol.parent == parent && !result.empty()) {
      result.back()["children"].push_back(std::move(entry));
    }
  }
  return result;
}

json LspFeatures::diagnostic(const ProgramView& program, const breve_diagnostic& d) const {
  const std::string_view text = text_of(program, d.file);
  const std::vector<std::size_t> starts = line_starts(text);
  const std::size_t line = d.line == 0 ? 0 : d.line - 1;
  const std::string_view shown = line_of(text, starts, line);
  const std::size_t column = d.column == 0 ? 0 : d.column - 1;
  const std::size_t end = std::min<std::size_t>(column + std::max<std::uint32_t>(d.length, 1), shown.size());
  const std::string help = *d.help ? std::string("\n") + d.help : std::string();
  return {{"range",
           {{"start", position(line, utf16_column(shown, column))},
            {"end", position(line, utf16_column(shown, std::max(end, column)))}}},
          {"severity", d.severity == BREVE_SEVERITY_ERROR     ? 1
                       : d.severity == BREVE_SEVERITY_WARNING ? 2
                                                              : 3},
          {"code", d.code},
          {"source", "breve"},
          {"message", d.message + help}};
}

// A file that names no controller is a part of a program that is not open: what it lacks on its own is not an error.
std::map<std::string, json> LspFeatures::diagnostics() {
  std::map<std::string, json> result;
  std::set<const ProgramView*> seen;
  for (const std::string& uri : workspace_.open_uris()) {
    result.emplace(uri, json::array());
    const FileView file = workspace_.view(uri);
    if (file.program == nullptr || !seen.insert(file.program).second) continue;
    const breve_analysis* analysis = file.program->analysis.get();
    for (std::size_t i = 0; i < breve_analysis_diagnostic_count(analysis); ++i) {
      breve_diagnostic d;
      if (breve_analysis_diagnostic(analysis, i, &d) != BREVE_OK) continue;
      if (!file.program->whole && std::string_view(d.code) == "missing-controller") continue;
      const auto where = file.program->uris.find(*d.file ? d.file : file.name.c_str());
      if (where == file.program->uris.end()) continue;
      json& list = result.emplace(where->second, json::array()).first->second;
      list.push_back(diagnostic(*file.program, d));
    }
  }
  return result;
}

}  // namespace breve::command
