// Texts of declarations: taken from the source where they stand there, so that they read as their author wrote them.
#include "steve/analysis/signatures.hpp"

#include <algorithm>

namespace breve::steve {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view bytes_of(const Sources& sources, const Span& span) {
  if (span.line == 0 || span.file >= sources.size()) return {};
  const std::string_view text = sources.file(span.file).text;
  return span.offset > text.size() ? std::string_view() : text.substr(span.offset, span.length);
}

}  // namespace

std::string text_of(const Sources& sources, const Span& span) {
  std::string result;
  for (const char c : bytes_of(sources, span)) {
    const bool blank = kBlanks.find(c) != std::string_view::npos;
    if (!blank) result += c;
    if (blank && !result.empty() && result.back() != ' ') result += ' ';
  }
  if (!result.empty() && result.back() == ' ') result.pop_back();
  return result;
}

std::string type_text(const Sources& sources, const ast::TypeRef& type) {
  std::string text = text_of(sources, type.span);
  if (!text.empty() && text.back() == ')') text.pop_back();
  if (!text.empty() && text.front() == '(') text.erase(0, 1);
  const std::size_t first = text.find_first_not_of(' ');
  const std::size_t last = text.find_last_not_of(' ');
  return first == std::string::npos ? std::string() : text.substr(first, last + 1 - first);
}

std::string signature_of(const Sources& sources, const ast::Parameter& parameter) {
  std::string text = parameter.keyword + ' ' + parameter.variable;
  if (parameter.default_value) text += " = " + text_of(sources, parameter.default_value->span);
  return text + " (" + type_text(sources, parameter.type) + ')';
}

std::string signature_of(const Sources& sources, const ast::Method& method) {
  std::string text = method.name;
  for (const ast::Parameter& parameter : method.parameters) text += ' ' + signature_of(sources, parameter);
  return text;
}

std::string signature_of(const ast::Class& cls) {
  return cls.parent + " : " + cls.name + (cls.alias.empty() ? "" : " (aka " + cls.alias + ")");
}

std::string comment_behind(const Sources& sources, std::uint32_t file, std::size_t offset) {
  const std::string_view text = sources.file(file).text;
  std::size_t i = text.find_first_not_of(" \t.", std::min(offset, text.size()));
  if (i == std::string_view::npos || text[i] != '#' || text.substr(i, 2) == "#!") return {};
  const std::size_t end = std::min(text.find_first_of("\r\n", i), text.size());
  i = std::min(text.find_first_not_of("# \t", i), end);
  const std::size_t last = text.find_last_not_of(" \t", end - 1);
  return last + 1 > i ? std::string(text.substr(i, last + 1 - i)) : std::string();
}

std::string_view type_of_letter(char letter) {
  switch (letter) {
    case 'i': return "int";
    case 'd': return "float";
    case 'v': return "vector";
    case 'm': return "matrix";
    case 's': return "string";
    case 'o': return "object";
    case 'l': return "list";
    case 'h': return "hash";
    case 'p': return "pointer";
    case 'b': return "data";
    case 'a': return "any";
    default: return "";
  }
}

std::string function_signature(std::string_view name, std::string_view letters, const FunctionNote* note) {
  std::string text(name);
  text += '(';
  std::string_view names = note != nullptr ? note->parameters : std::string_view();
  for (std::size_t i = 0; i < letters.size() && letters[i] != ':'; ++i) {
    if (i > 0) text += ", ";
    const std::size_t blank = std::min(names.find(' '), names.size());
    if (blank > 0) text.append(names.substr(0, blank)) += ' ';
    names.remove_prefix(std::min(blank + 1, names.size()));
    text.append("(").append(type_of_letter(letters[i])) += ')';
  }
  return text + ')';
}

}  // namespace breve::steve
