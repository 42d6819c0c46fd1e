// Pages in HTML that need nothing but themselves.
#include <string_view>

#include "doc_pages.hpp"

namespace breve::command {

namespace {

constexpr std::string_view kStyle = R"(
body { font: 16px/1.5 sans-serif; max-width: 48em; margin: 2em auto; padding: 0 1em; color: #222; background: #fff; }
code { font: 14px/1.4 monospace; background: #f3f3f0; padding: 0 .2em; }
h3 { margin-bottom: .2em; border-top: 1px solid #ddd; padding-top: .8em; }
table { border-collapse: collapse; }
td, th { text-align: left; padding: .1em 1em .1em 0; vertical-align: top; }
a { color: #05a; text-decoration: none; } a:hover { text-decoration: underline; }
@media (prefers-color-scheme: dark) {
  body { color: #ddd; background: #1c1c1c; } code { background: #2a2a2a; } a { color: #8bf; } h3 { border-color: #444; }
}
)";

void escape(char c, std::string& into) {
  switch (c) {
    case '<': into += "&lt;"; break;
    case '>': into += "&gt;"; break;
    case '&': into += "&amp;"; break;
    case '"': into += "&quot;"; break;
    default: into += c; break;
  }
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) escape(c, result);
  return result;
}

/// A comment's text: an empty line parts paragraphs, `code` is code.
std::string prose(const std::string& text) {
  std::string result = "<p>";
  bool code = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool pair = code || text.find('`', i + 1) != std::string::npos;
    if (text[i] == '`' && pair) {
      result += code ? "</code>" : "<code>";
      code = !code;
    } else if (text.compare(i, 2, "\n\n") == 0 && !code) {
      result += "</p>\n<p>";
      ++i;
    } else {
      escape(text[i], result);
    }
  }
  return result + (code ? "</code>" : "") + "</p>\n";
}

std::string code(const std::string& text) { return "<code>" + escaped(text) + "</code>"; }

std::string link(const DocModel& model, const std::string& cls, const std::string& anchor = "",
                 const std::string& shown = "") {
  const std::string text = escaped(shown.empty() ? cls : shown);
  if (!model.chosen(cls)) return text;
  return "<a href=\"" + escaped(cls) + ".html" + (anchor.empty() ? "" : "#" + escaped(anchor)) + "\">" + text + "</a>";
}

std::string whole(const std::string& title, const std::string& body) {
  return "<!doctype html>\n<!-- Made by `breve doc`. Changes belong into the comments of the program. -->\n"
         "<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escaped(title) + "</title>\n<style>" + std::string(kStyle) + "</style>\n</head>\n<body>\n" + body +
         "</body>\n</html>\n";
}

std::string method_text(const DocMethod& method) {
  std::string text =
      "<h3 id=\"" + escaped(method.anchor()) + "\">" + escaped(method.title()) + "</h3>\n<p>" + code(method.signature);
  if (!method.type.empty()) text += " yields " + escaped(method.type);
  text += "</p>\n";
  if (!method.text.empty()) text += prose(method.text);
  if (method.keywords.empty()) return text;
  text += "<table>\n<tr><th>keyword</th><th>value</th><th>type</th><th>default</th></tr>\n";
  for (const DocKeyword& k : method.keywords)
    text += "<tr><td>" + code(k.name) + "</td><td>" + code(k.variable) + "</td><td>" + escaped(k.type) + "</td><td>" +
            (k.value.empty() ? "" : code(k.value)) + "</td></tr>\n";
  return text + "</table>\n";
}

std::string methods_text(const DocClass& cls, bool hidden) {
  std::string text;
  for (const DocMethod& method : cls.methods)
    if (method.hidden == hidden) text += method_text(method);
  if (text.empty()) return text;
  return (hidden ? "<h2>Further methods</h2>\n" : "<h2>Methods</h2>\n") + text;
}

void tree(const DocModel& model, const DocClass& cls, std::size_t depth, std::string& text) {
  if (depth > model.classes().size()) return;  // classes that are each other's parents
  text += "<li>" + link(model, cls.name);
  if (!cls.text.empty()) text += ": " + escaped(first_sentence(cls.text));
  const auto children = model.children(cls.name);
  if (!children.empty()) {
    text += "\n<ul>\n";
    for (const DocClass* child : children) tree(model, *child, depth + 1, text);
    text += "</ul>\n";
  }
  text += "</li>\n";
}

}  // namespace

std::string HtmlPages::index(const DocModel& model) const {
  std::string text = "<h1>Classes</h1>\n<ul>\n";
  for (const auto& [name, cls] : model.classes())
    if (model.chosen(name) && !model.chosen(cls.parent)) tree(model, cls, 0, text);
  return whole("Classes", text + "</ul>\n");
}

std::string HtmlPages::page(const DocModel& model, const DocClass& cls) const {
  std::string text = "<p><a href=\"index.html\">Classes</a></p>\n<h1>" + escaped(cls.name) + "</h1>\n<p>";
  std::string line;
  for (const DocClass* ancestor : model.ancestors(cls)) line = link(model, ancestor->name) + " &gt; " + line;
  text += line + "<strong>" + escaped(cls.name) + "</strong>";
  if (!cls.alias.empty()) text += ", also called " + code(cls.alias);
  text += "; in " + code(cls.module) + (cls.library ? " of the class library</p>\n" : "</p>\n");
  if (!cls.text.empty()) text += prose(cls.text);
  std::string children;
  for (const DocClass* child : model.children(cls.name))
    children += (children.empty() ? "" : ", ") + link(model, child->name);
  if (!children.empty()) text += "<p>Children: " + children + "</p>\n";
  text += methods_text(cls, false) + methods_text(cls, true);
  if (!cls.variables.empty()) {
    text += "<h2>Variables</h2>\n<table>\n";
    for (const DocVariable& v : cls.variables)
      text +=
          "<tr><td>" + code(v.name) + "</td><td>" + escaped(v.type) + "</td><td>" + escaped(v.text) + "</td></tr>\n";
    text += "</table>\n";
  }
  for (const DocClass* ancestor : model.ancestors(cls)) {
    std::string names;
    for (const DocMethod* method : model.inherited(cls, *ancestor))
      names += (names.empty() ? "" : ", ") + link(model, ancestor->name, method->anchor(), method->title());
    if (!names.empty()) text += "<h2>Inherited from " + escaped(ancestor->name) + "</h2>\n<p>" + names + "</p>\n";
  }
  return whole(cls.name, text);
}

}  // namespace breve::command
