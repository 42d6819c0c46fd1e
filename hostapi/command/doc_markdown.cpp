// Pages in Markdown, for readers of a repository.
#include <string_view>

#include "doc_pages.hpp"

namespace breve::command {

namespace {

constexpr std::string_view kMade = "<!-- Made by `breve doc`. Changes belong into the comments of the program. -->\n\n";

/// A comment's text: what Markdown would take for markup is text, but for `code`, which is meant so.
std::string escaped(std::string_view text, bool in_table = false) {
  std::string result;
  bool code = false;
  for (const char c : text) {
    if (c == '`') code = !code;
    if (c == '\n' && in_table) {
      result += ' ';
      continue;
    }
    const bool sign = std::string_view("*_<>[]#\\").find(c) != std::string_view::npos;
    if ((sign && !code) || (c == '|' && in_table)) result += '\\';
    result += c;
  }
  return result;
}

std::string code(const std::string& text, bool in_table = false) {
  const std::string fence = text.find('`') == std::string::npos ? "`" : "``";
  std::string shown = text;
  for (std::size_t at = 0; in_table && (at = shown.find('|', at)) != std::string::npos; at += 2) shown.insert(at, "\\");
  return fence + (fence.size() > 1 ? " " : "") + shown + (fence.size() > 1 ? " " : "") + fence;
}

std::string link(const DocModel& model, const std::string& cls, const std::string& anchor = "",
                 const std::string& shown = "") {
  const std::string text = shown.empty() ? cls : shown;
  if (!model.chosen(cls)) return text;
  return "[" + text + "](" + cls + ".md" + (anchor.empty() ? "" : "#" + anchor) + ")";
}

std::string method_text(const DocMethod& method) {
  std::string text = "### " + method.title() + "\n\n" + code(method.signature);
  if (!method.type.empty()) text += " yields " + method.type;
  text += "\n\n";
  if (!method.text.empty()) text += escaped(method.text) + "\n\n";
  if (method.keywords.empty()) return text;
  text += "| keyword | value | type | default |\n| --- | --- | --- | --- |\n";
  for (const DocKeyword& k : method.keywords)
    text += "| " + code(k.name) + " | " + code(k.variable) + " | " + escaped(k.type, true) + " | " +
            (k.value.empty() ? "" : code(k.value, true)) + " |\n";
  return text + "\n";
}

std::string methods_text(const DocClass& cls, bool hidden) {
  std::string text;
  for (const DocMethod& method : cls.methods)
    if (method.hidden == hidden) text += method_text(method);
  if (text.empty()) return text;
  return (hidden ? "## Further methods\n\n" : "## Methods\n\n") + text;
}

void tree(const DocModel& model, const DocClass& cls, std::size_t depth, std::string& text) {
  if (depth > model.classes().size()) return;  // classes that are each other's parents
  text += std::string(2 * depth, ' ') + "- " + link(model, cls.name);
  if (!cls.text.empty()) text += ": " + escaped(first_sentence(cls.text), true);
  text += "\n";
  for (const DocClass* child : model.children(cls.name)) tree(model, *child, depth + 1, text);
}

}  // namespace

std::string MarkdownPages::index(const DocModel& model) const {
  std::string text = std::string(kMade) + "# Classes\n\n";
  for (const auto& [name, cls] : model.classes())
    if (model.chosen(name) && !model.chosen(cls.parent)) tree(model, cls, 0, text);
  return text;
}

std::string MarkdownPages::page(const DocModel& model, const DocClass& cls) const {
  std::string text = std::string(kMade) + "# " + cls.name + "\n\n";
  std::string line;
  for (const DocClass* ancestor : model.ancestors(cls)) line = link(model, ancestor->name) + " > " + line;
  text += line + "**" + cls.name + "**";
  if (!cls.alias.empty()) text += ", also called " + code(cls.alias);
  text += "; in " + code(cls.module) + (cls.library ? " of the class library\n\n" : "\n\n");
  if (!cls.text.empty()) text += escaped(cls.text) + "\n\n";
  std::string children;
  for (const DocClass* child : model.children(cls.name))
    children += (children.empty() ? "" : ", ") + link(model, child->name);
  if (!children.empty()) text += "Children: " + children + "\n\n";
  text += methods_text(cls, false) + methods_text(cls, true);
  if (!cls.variables.empty()) {
    text += "## Variables\n\n| variable | type | |\n| --- | --- | --- |\n";
    for (const DocVariable& v : cls.variables)
      text += "| " + code(v.name) + " | " + escaped(v.type, true) + " | " + escaped(v.text, true) + " |\n";
    text += "\n";
  }
  for (const DocClass* ancestor : model.ancestors(cls)) {
    std::string names;
    for (const DocMethod* method : model.inherited(cls, *ancestor))
      names += (names.empty() ? "" : ", ") + link(model, ancestor->name, method->anchor(), method->title());
    if (!names.empty()) text += "## Inherited from " + ancestor->name + "\n\n" + names + "\n\n";
  }
  while (text.size() > 1 && text[text.size() - 2] == '\n') text.pop_back();
  return text;
}

}  // namespace breve::command
