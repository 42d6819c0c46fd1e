// The top level of a file: directives, constants, classes; and the body of a class down to its methods.
#include <fmt/format.h>

#include <algorithm>

#include "steve/syntax/parser_nodes.hpp"

namespace breve::steve {

namespace {

constexpr auto kNoItem = static_cast<std::size_t>(-1);  // the item before the first

const std::vector<std::string_view> kDirectives{"include", "use", "path", "define", "plugin", "nib_file"};

std::optional<ast::Directive::Kind> directive_kind(Word word) {
  switch (word) {
    case Word::Include: return ast::Directive::Kind::Include;
    case Word::Use: return ast::Directive::Kind::Use;
    case Word::Path: return ast::Directive::Kind::Path;
    case Word::Plugin: return ast::Directive::Kind::Plugin;
    case Word::NibFile: return ast::Directive::Kind::NibFile;
    default: return std::nullopt;
  }
}

// One documentation line, without its '%' and the blanks around the text.
void append_line(std::string& text, std::string_view line) {
  constexpr std::string_view kBlank = " \t";
  const std::size_t first = line.find_first_not_of(kBlank, std::min(line.find_first_not_of('%'), line.size()));
  const std::size_t last = line.find_last_not_of(kBlank);
  if (!text.empty()) text += '\n';
  if (first != std::string_view::npos) text += line.substr(first, last + 1 - first);
}

void append_docs(std::string& text, const std::string& more) {
  if (!text.empty() && !more.empty()) text += '\n';
  text += more;
}

}  // namespace

ast::File Parser::file() {
  ast::File result;
  if (!at_class_header()) result.doc = docs(kNoItem, 0);
  while (!at_end()) {
    const std::size_t start = pos_;
    try {
      top_level(result);
    } catch (const SyntaxError& problem) {
      report(problem.diagnostic);
      if (pos_ == start) advance();
      skip_to_top_level();
    }
    if (pos_ == start) advance();
  }
  return result;
}

ast::Method Parser::interactive() {
  interactive_ = true;
  ast::Method result;
  try {
    for (read_statements(result.body); at("}"); read_statements(result.body)) {
      error(token().span, "stray-brace", "unmatched '}'", "remove it, or look for a missing '{'");
      advance();
    }
    if (!at_end()) error(token().span, "syntax", fmt::format("expected a statement, got {}", describe()));
  } catch (const SyntaxError& problem) {
    report(problem.diagnostic);
  }
  result.span = span_from(0);
  return result;
}

void Parser::top_level(ast::File& file) {
  if (at("@")) return directive(file);
  if (at_word(Word::Controller)) return controller(file);
  if (at_kind(TokenKind::Name) && at(":", 1)) return class_declaration(file);
  if (at_member_header() || at_variables_header()) {
    error(token().span, "syntax", "a method is outside of a class", "look for a surplus '}' above");
    ast::Class stray;
    members(file.classes.empty() ? stray : file.classes.back());
    accept("}");
    return;
  }
  if (at("}")) {
    error(token().span, "stray-brace", "unmatched '}'", "remove it, or look for a missing '{' above");
    advance();
    if (!at_member_header()) return;
    ast::Class stray;
    members(file.classes.empty() ? stray : file.classes.back());
    accept("}");
    return;
  }
  if (foreign_class(file)) return;
  if (at_name() &&
      (at_text("import") || at_text("using") || at_text("require") || at_text("from") || at_text("include")))
    fail(token().span, "foreign-statement", fmt::format("there is no '{}'", token().text),
         "a class of the library is loaded with @use Name. and a file with @include \"file.tz\"");
  fail_expected("a class or a directive", "a class begins with: Parent : Name {");
}

void Parser::skip_to_top_level() {
  while (!at_end()) {
    if (at("@") || at_word(Word::Controller) || at_class_header()) return;
    if (token().starts_line && (at_member_header() || (at_kind(TokenKind::Name) && at(":", 1)))) return;
    advance();
  }
}

void Parser::directive(ast::File& file) {
  const std::size_t start = pos_;
  advance();
  if (at_word(Word::Define)) return define();
  const std::optional<ast::Directive::Kind> kind = directive_kind(item().word);
  if (!kind) {
    const std::string near = at_kind(TokenKind::Name) ? nearest(token().text, kDirectives) : "";
    fail(token().span, "unknown-directive", fmt::format("unknown directive '@{}'", token().text),
         near.empty() ? "known are @include, @use, @path, @define, @plugin and @nib_file"
                      : fmt::format("did you mean '@{}'?", near));
  }
  advance();
  ast::Directive result;
  result.kind = *kind;
  if (*kind == ast::Directive::Kind::Use) {
    if (at_kind(TokenKind::String))
      fail_expected("the name of a class after '@use'", "write the name without quotes; for a file write @include");
    Span span;
    result.text = expect_name("a class", span);
    if (at("[")) use_version(result);
  } else {
    if (!at_kind(TokenKind::String)) fail_expected("a name in double quotes");
    result.text = token().text;
    advance();
  }
  if (*kind == ast::Directive::Kind::Plugin) {
    expect("(", "and the entry point of the plugin");
    Span span;
    result.entry = expect_name("the plugin's entry point", span);
    expect(")", "after the entry point");
  }
  const bool optional_period = *kind == ast::Directive::Kind::Include || *kind == ast::Directive::Kind::Path;
  if (!accept(".") && !optional_period) directive_period();
  result.span = span_from(start);
  file.directives.push_back(std::move(result));
}

void Parser::directive_period() {
  if (accept(".")) return;
  if (at(";")) return semicolon();
  if (!(token().starts_line || at("@") || at_end())) fail_expected("'.' after this directive");
  missing(".", "this directive");
}

// [version OP f]
void Parser::use_version(ast::Directive& directive) {
  advance();
  if (!at_word(Word::Version)) fail_expected("'version'", "write: @use Name [version >= 1.0].");
  advance();
  switch (item().sign) {
    case sign("=="):
    case sign("!="):
    case sign("<"):
    case sign("<="):
    case sign(">"):
    case sign(">="): break;
    default: fail_expected("a comparison", "write: @use Name [version >= 1.0].");
  }
  directive.version_op = token().text;
  advance();
  directive.version = version_number();
  expect("]", "after the version");
}

double Parser::version_number() {
  if (!at_kind(TokenKind::Double)) fail_expected("a version with a decimal point", "for example 1.0");
  const double version = token().double_value;
  advance();
  return version;
}

// @define NAME literal. Repeating the same definition is not an error, and a definition of the program hides one of the
// library.
void Parser::define() {
  const Span location = items_[pos_ - 1].token->span;
  advance();
  const std::string name(token().text);
  const ast::Constant* before = at_name() ? constant_named(name) : nullptr;
  Span span = token().span;
  if (before != nullptr) {
    advance();
  } else {
    expect_name("a constant", span);
  }
  ast::Constant value = constant();
  value.span = span;
  directive_period();
  if (before != nullptr && before->value == value.value) return;
  if (before != nullptr && (embedded_ || !sources_.file(before->span.file).embedded)) {
    error(span, "redefinition", fmt::format("the constant '{}' is defined already, with another value", name),
          fmt::format("the other definition is in {}, line {}", sources_.file(before->span.file).name,
                      before->span.line));
  } else if (new_defines_ == nullptr) {
    error(location, "syntax", "'@define' is not possible here");
  } else {
    new_defines_->add(name, value, embedded_);
  }
}

void Parser::controller(ast::File& file) {
  const std::size_t start = pos_;
  advance();
  ast::Directive result;
  result.kind = ast::Directive::Kind::Controller;
  Span span;
  result.text = expect_name("the controller's class", span);
  directive_period();
  result.span = span_from(start);
  file.directives.push_back(std::move(result));
}

void Parser::class_declaration(ast::File& file) {
  const std::size_t start = pos_;
  ast::Class& result = file.classes.emplace_back();
  result.doc = docs(start - 1, start);
  result.parent = expect_name("the parent class", result.parent_span);
  advance();
  try {
    result.name = expect_name("a class", result.name_span);
    class_clauses(result);
    if (!at("{")) fail_expected("'{' after the name of the class");
  } catch (const SyntaxError& problem) {
    report(problem.diagnostic);
    while (!at_end() && !at("{") && !at_member_header() && !at_variables_header()) advance();
  }
  class_body(result);
  result.span = span_from(start);
}

// (aka Alias) [version 1.5]
void Parser::class_clauses(ast::Class& result) {
  bool version = false;
  for (;;) {
    const Span location = token().span;
    if (accept("(")) {
      if (!at_word(Word::Aka)) fail_expected("'aka' and an alias of the class");
      advance();
      result.alias = expect_name("a class", result.alias_span);
      expect(")", "after the class's alias");
      if (version) error(location, "syntax", "the alias of a class comes before its version");
    } else if (accept("[")) {
      if (!at_word(Word::Version)) fail_expected("'version'");
      advance();
      result.version = version_number();
      expect("]", "after the version");
      version = true;
    } else {
      return;
    }
  }
}

void Parser::class_body(ast::Class& result) {
  const std::size_t open = pos_;
  const bool opened = at("{");
  class_close_ = opened ? item().match : 0;
  accept("{");
  members(result);
  if (accept("}")) return;
  if (!opened) return;
  if (open_brace_reported_) return;
  const std::string reached =
      at_end() ? "the file ends" : fmt::format("another class begins at line {}", token().span.line);
  error(items_[open].token->span, "missing-brace", fmt::format("the '{{' of class '{}' has no '}}'", result.name),
        reached + " while it is open: write '}' where the class ends");
}

// The variables and methods of a class, up to its '}', to the next class or to the end.
void Parser::members(ast::Class& result) {
  const std::size_t first = pos_;
  bool any_method = !result.methods.empty();
  std::size_t pending_docs = first > 0 ? first - 1 : 0;  // documentation before items after this one has no owner yet
  while (!at("}") || stray_brace()) {
    if (at_end() || (token().starts_line && at_class_header())) break;
    if (at("}") && pos_ == class_close_ && !more_braces_close()) {
      error(token().span, "stray-brace", fmt::format("this '}}' ends class '{}', and a method follows", result.name),
            "remove it, and write '}' after the last method");
      open_brace_reported_ = true;
      advance();
    } else if (at("}")) {
      error(token().span, "stray-brace", "unmatched '}'", "remove it, or look for a missing '{' above");
      advance();
    } else if (at_text("variables") && at(":", 1)) {
      error(token().span, "method-header", "the '+' is missing in front of 'variables'", "write: + variables:");
      --pos_;
      variables(result);
      append_docs(result.doc, docs(pending_docs, pos_ - 1));
      pending_docs = pos_ - 1;
    } else if (at_variables_header()) {
      if (any_method) {
        error(token().span, "syntax", "the variables of a class come before its methods",
              "move this section to the beginning of the class");
      }
      variables(result);
      append_docs(result.doc, docs(pending_docs, pos_ - 1));
      pending_docs = pos_ - 1;
    } else if (at_member_header() || broken_header() != 0) {
      const std::size_t header = pos_;
      const bool class_docs = !any_method && header == first;
      if (class_docs) append_docs(result.doc, docs(pending_docs, header));
      method(result);
      const bool more = at_member_header();
      ast::Method& made = result.methods.back();
      const bool empty = made.body.empty() && made.locals.empty() && !made.native;
      const std::size_t last = more && !empty ? pos_ - 1 : pos_;
      made.doc = docs(class_docs ? header : pending_docs, last);
      pending_docs = last;
      any_method = true;
    } else {
      stray_member();
    }
  }
  if (!any_method) append_docs(result.doc, docs(pending_docs, pos_));
}

void Parser::variables(ast::Class& result) {
  if (at("-") || at("=")) error(token().span, "syntax", "the variables of a class begin with '+ variables:'");
  advance();
  advance();
  if (!accept(":")) missing(":", "'+ variables'");
  while (!at_end() && !at("}") && !at_member_header() && !at_variables_header() && broken_header() == 0) {
    const std::size_t start = pos_;
    try {
      declaration(result.variables, "an instance variable");
    } catch (const SyntaxError& problem) {
      report(problem.diagnostic);
      skip_statement(start);
      if (pos_ == start) advance();
    }
  }
}

// Is there a '}' beyond the current one that closes nothing, before another class begins?
bool Parser::more_braces_close() const {
  int depth = 0;
  for (std::size_t ahead = 1; !at_kind(TokenKind::End, ahead); ++ahead) {
    if (token(ahead).starts_line && at_class_header(ahead)) return false;
    if (at("{", ahead)) ++depth;
    if (at("}", ahead) && --depth < 0) return true;
  }
  return false;
}

// `class Bird extends Mobile {`, `class Bird : Mobile {`, `Bird {`: reported, and read as the class that was meant.
bool Parser::foreign_class(ast::File& file) {
  const bool word = at_text("class") || at_text("struct");
  const std::size_t name = word ? 1 : 0;
  if (!at_name(name)) return false;
  std::size_t open = name + 1;
  std::size_t parent = 0;
  for (; open < name + 6 && !at("{", open); ++open) {
    if (!at_kind(TokenKind::Name, open) && !at(":", open) && !at("<", open) && !at("(", open) && !at(")", open))
      return false;
    if (at_name(open) && !at_text("extends", open) && !at_text("public", open) && !at_text("inherits", open))
      parent = open;
  }
  if (!at("{", open)) return false;
  const std::string own(token(name).text);
  const std::string base(parent != 0 ? token(parent).text : "Object");
  error(token().span, "class-header",
        word ? fmt::format("'{}' does not begin a class: the parent comes first", token().text)
             : fmt::format("the class '{}' names no parent", own),
        fmt::format("write: {} : {} {{", base, own));
  ast::Class& result = file.classes.emplace_back();
  result.name = own;
  result.name_span = token(name).span;
  result.parent = base;
  result.parent_span = token(parent != 0 ? parent : name).span;
  pos_ += open;
  const std::size_t start = pos_;
  class_body(result);
  result.span = span_from(start);
  return true;
}

// Something between the methods that is neither: skip it.
void Parser::stray_member() {
  if (at("@")) {
    error(token().span, "syntax", "directives must be outside of classes");
  } else {
    error(token().span, "syntax", fmt::format("expected a method or '}}', got {}", describe()),
          "statements must be inside methods, and a method begins with: + to name:");
  }
  advance();
  while (!at_end() && !at("}") && !at_member_header() && !at_variables_header() && !at_class_header() &&
         broken_header() == 0) {
    if (at("{") && item().match != 0) pos_ = item().match;
    advance();
  }
}

// A '}' that what follows shows to be one too many: the class goes on.
bool Parser::stray_brace() const {
  if (!at("}") || at_kind(TokenKind::End, 1) || at("@", 1) || at("}", 1) || at_word(Word::Controller, 1)) return false;
  if (at_member_header(1) || at_variables_header(1)) return true;
  if (at_kind(TokenKind::Name, 1) && at(":", 2)) return false;
  return at_statement_word(1) || at_word(Word::Self, 1) || at_word(Word::Super, 1) ||
         (at_name(1) && at_assignment(2) && !at("{", 2));
}

// Documentation lines that stand before one of the items after `after` up to `last`, without their '%'.
std::string Parser::docs(std::size_t after, std::size_t last) const {
  auto doc = std::lower_bound(docs_.begin(), docs_.end(), after + 1,
                              [](const Doc& entry, std::size_t item) { return entry.before < item; });
  std::string text;
  for (; doc != docs_.end() && doc->before <= last; ++doc) append_line(text, doc->text);
  return text;
}

}  // namespace breve::steve
