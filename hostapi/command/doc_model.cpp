// From symbols to classes with methods with keywords.
#include "doc_model.hpp"

#include <algorithm>
#include <set>

namespace breve::command {

namespace {

/// "library:Real.tz" as "Real.tz".
std::string module_name(const breve_symbol& symbol) {
  const std::string file = symbol.span.file;
  return symbol.library ? file.substr(file.find(':') + 1) : file;
}

std::string key_of(const DocMethod& method) { return method.name + ' ' + std::to_string(method.keywords.size()); }

/// The parts of one class, which follow its symbol.
DocClass read_class(const breve_analysis* analysis, std::size_t number, const breve_symbol& symbol) {
  DocClass cls{
      symbol.name, symbol.alias, symbol.parent_class, module_name(symbol), symbol.documentation, symbol.library, {},
      {}};
  std::size_t method = BREVE_NO_SYMBOL;
  for (std::size_t i = number + 1; i < breve_analysis_symbol_count(analysis); ++i) {
    breve_symbol part;
    if (breve_analysis_symbol(analysis, i, &part) != BREVE_OK) break;
    if (part.parent != number && part.parent != method) break;
    switch (part.kind) {
      case BREVE_NAME_VARIABLE: cls.variables.push_back({part.name, part.type, part.documentation}); break;
      case BREVE_NAME_METHOD:
        method = i;
        cls.methods.push_back({part.name, part.signature, part.type, part.documentation, part.hidden, {}});
        break;
      case BREVE_NAME_KEYWORD: cls.methods.back().keywords.push_back({part.name, "", part.type, part.value}); break;
      case BREVE_NAME_PARAMETER: cls.methods.back().keywords.back().variable = part.name; break;
      default: break;
    }
  }
  return cls;
}

}  // namespace

std::string DocMethod::title() const {
  std::string text = name;
  for (const DocKeyword& keyword : keywords) text += ' ' + keyword.name;
  return text;
}

std::string DocMethod::anchor() const {
  std::string text = title();
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c == ' ' ? '-' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

std::vector<std::string> DocModel::add(const breve_analysis* analysis, bool library) {
  std::vector<std::string> twice;
  for (std::size_t i = 0; i < breve_analysis_symbol_count(analysis); ++i) {
    breve_symbol symbol;
    if (breve_analysis_symbol(analysis, i, &symbol) != BREVE_OK || symbol.kind != BREVE_NAME_CLASS) continue;
    if (!*symbol.name || (symbol.library && classes_.find(symbol.name) != classes_.end() && !library)) continue;
    DocClass cls = read_class(analysis, i, symbol);
    const std::string name = cls.name;
    if (!cls.library || library) chosen_[name] = true;
    const auto before = classes_.find(name);
    if (before != classes_.end() && before->second.module != cls.module && !cls.library && !before->second.library)
      twice.push_back(name);
    if (before == classes_.end() || before->second.library) classes_[name] = std::move(cls);
  }
  return twice;
}

std::vector<const DocClass*> DocModel::ancestors(const DocClass& cls) const {
  std::vector<const DocClass*> line;
  for (auto at = classes_.find(cls.parent); at != classes_.end(); at = classes_.find(at->second.parent)) {
    if (&at->second == &cls || std::find(line.begin(), line.end(), &at->second) != line.end()) break;
    line.push_back(&at->second);
  }
  return line;
}

std::vector<const DocClass*> DocModel::children(const std::string& name) const {
  std::vector<const DocClass*> result;
  for (const auto& [child, cls] : classes_)
    if (cls.parent == name && chosen(child)) result.push_back(&cls);
  return result;
}

std::vector<const DocMethod*> DocModel::inherited(const DocClass& cls, const DocClass& ancestor) const {
  std::set<std::string> hidden;
  const auto hide = [&](const DocClass& below) {
    for (const DocMethod& method : below.methods) hidden.insert(key_of(method));
  };
  hide(cls);
  for (const DocClass* between : ancestors(cls)) {
    if (between == &ancestor) break;
    hide(*between);
  }
  std::vector<const DocMethod*> result;
  for (const DocMethod& method : ancestor.methods)
    if (hidden.find(key_of(method)) == hidden.end()) result.push_back(&method);
  return result;
}

std::string first_sentence(const std::string& text) {
  std::string line = text;
  std::replace(line.begin(), line.end(), '\n', ' ');
  const std::size_t end = std::min(line.find(". "), line.find(": "));
  if (end == std::string::npos) return line;
  return line.substr(0, end) + ".";
}

}  // namespace breve::command
