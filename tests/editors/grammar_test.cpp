// The TextMate grammar against our own scanner and parser, on every valid program of the repository: what is a comment,
// a string, a number, a reserved word, a class or a method there must have that scope in an editor.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "steve/compile/function_compiler.hpp"
#include "steve/syntax/parser.hpp"
#include "steve/syntax/words.hpp"
#include "tokeniser.hpp"

namespace breve::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using namespace breve::steve;

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

json grammar_definition() { return json::parse(read(BREVE_GRAMMAR)); }

/// Lines that only the parser can tell apart, where an editor's grammar is wrong on purpose; each with its reason.
const std::map<std::string, std::string> kExceptions = {
    {"\t\t\t% 5.", "a remainder, continued from the line before: a grammar does not see that line"},
};

/// As an editor shows bytes that are not UTF-8.
std::string decoded(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t more = lead < 0xC0 ? 0 : lead < 0xE0 ? 1 : lead < 0xF0 ? 2 : 3;
    bool good = lead < 0x80 || (more > 0 && i + more < text.size());
    for (std::size_t k = 1; good && k <= more; ++k) good = (static_cast<unsigned char>(text[i + k]) & 0xC0U) == 0x80U;
    if (good)
      i += more;
    else
      text[i] = '?';
  }
  return text;
}

/// The expected properties of a word.
std::string wanted_of(Word word) {
  if (word >= Word::Int && word <= Word::Hashes) return "storage.type";
  switch (word) {
    case Word::If:
    case Word::Else:
    case Word::While:
    case Word::For:
    case Word::Foreach:
    case Word::Return:
    case Word::Die: return "keyword.control";
    case Word::Self:
    case Word::Super: return "variable.language";
    default: return "keyword";
  }
}

/// One file through both.
class Comparison {
 public:
  Comparison(const Grammar& grammar, std::string name, std::string text, bool embedded) : name_(std::move(name)) {
    file_ = sources_.add(name_, std::move(text), embedded);
    tokens_ = lex(sources_, file_, diagnostics_);
    Defines defines;
    tree_ = parse(tokens_, defines, diagnostics_, sources_, embedded);
    valid_ = diagnostics_.error_count() == 0;
    if (valid_) scopes_ = grammar.scopes(sources_.file(file_).text);
  }

  bool valid() const { return valid_; }

  const std::vector<std::string>& offences() {
    compare_tokens();
    for (const ast::Directive& directive : tree_.directives) compare_directive(directive);
    for (const ast::Class& cls : tree_.classes) compare_class(cls);
    return offences_;
  }

 private:
  void offend(std::size_t offset, const std::string& what) {
    const Span span = sources_.span_at(file_, static_cast<std::uint32_t>(offset), 1);
    const std::string line(sources_.line_text(span));
    if (kExceptions.find(line) != kExceptions.end()) return;
    offences_.push_back(name_ + ":" + std::to_string(span.line) + ":" + std::to_string(span.column) + ": " + what +
                        ", but its scopes are [" + scopes_[offset] + "]: " + line);
  }

  bool has(std::size_t offset, std::string_view scope) const {
    const std::string& scopes = scopes_[offset];
    for (std::size_t at = scopes.find(scope); at != std::string::npos; at = scopes.find(scope, at + 1))
      if (at == 0 || scopes[at - 1] == ' ') return true;
    return false;
  }

  void want(const Span& span, std::size_t length, std::string_view scope, const std::string& what) {
    for (std::size_t i = span.offset; i < span.offset + length; ++i) {
      if (has(i, scope)) continue;
      return offend(i, what + " must have " + std::string(scope));
    }
  }

  void forbid(const Span& span, std::string_view scope, const std::string& what) {
    for (std::size_t i = span.offset; i < span.offset + span.length; ++i)
      if (has(i, scope)) return offend(i, what + " must not have " + std::string(scope));
  }

  // Text between two tokens that is not blank is a comment.
  void compare_gap(std::size_t begin, std::size_t end) {
    const std::string& text = sources_.file(file_).text;
    for (std::size_t i = begin; i < end; ++i) {
      const bool blank = std::string_view(" \t\r\n").find(text[i]) != std::string_view::npos;
      if (!blank && !has(i, "comment")) return offend(i, "a comment must have comment");
    }
  }

  void compare_tokens() {
    const std::string& text = sources_.file(file_).text;
    std::size_t done = text.rfind("\xEF\xBB\xBF", 0) == 0 ? 3 : 0;
    for (const Token& token : tokens_) {
      compare_gap(done, token.span.offset);
      done = token.span.offset + token.span.length;
      if (token.kind != TokenKind::End) compare(token);
    }
  }

  void compare(const Token& token) {
    const Span& span = token.span;
    const std::string shown = "'" + std::string(token.text.substr(0, 40)) + "'";
    if (token.kind == TokenKind::Doc) return want(span, span.length, "comment", "documentation");
    forbid(span, "comment", shown);
    if (token.kind == TokenKind::String) {
      // A string may reach over lines: its line ends have no scope of their own.
      for (std::size_t i = span.offset; i < span.offset + span.length; ++i)
        if (sources_.file(file_).text[i] != '\n' && !has(i, "string")) return offend(i, "a string must have string");
      return;
    }
    forbid(span, "string", shown);
    const bool number = token.kind == TokenKind::Int || token.kind == TokenKind::Double;
    if (number)
      return want(span, span.length, token.text.front() == '\'' ? "constant.character" : "constant.numeric", shown);
    forbid(span, "constant.numeric", shown);
    if (token.kind == TokenKind::Punctuation) return forbid(span, "variable", shown);
    const Word word = word_of(token.text);
    if (word != Word::None) return want(span, span.length, wanted_of(word), "the reserved word " + shown);
    for (const char* scope : {"keyword.control.", "storage.type.steve", "variable.language", "keyword.operator"}) {
      const bool contextual =
          token.text == "in" || token.text == "each" || token.text == "onto" || token.text == "native";
      if (!contextual) forbid(span, scope, "the name " + shown);
    }
  }

  void want_class(const Span& span, const std::string& name) {
    const std::string& text = sources_.file(file_).text;
    if (text.compare(span.offset, name.size(), name) != 0) return;  // written as a string
    const bool either = has(span.offset, "entity.other.inherited-class") || has(span.offset, "entity.name.type.class");
    if (!either) offend(span.offset, "the class " + name + " must have the scope of classes");
  }

  void want_class_in(const Span& span, const std::string& name) {
    for (const Token& token : tokens_)
      if (token.kind == TokenKind::Name && token.text == name && token.span.offset > span.offset &&
          token.span.offset < span.offset + span.length)
        want_class(token.span, name);
  }

  void compare_directive(const ast::Directive& directive) {
    const bool names_class =
        directive.kind == ast::Directive::Kind::Use || directive.kind == ast::Directive::Kind::Controller;
    if (names_class) want_class_in(directive.span, directive.text);
  }

  void compare_type(const ast::TypeRef& type) {
    if (!type.class_name.empty()) want_class_in(type.span, type.class_name);
  }

  void compare_class(const ast::Class& cls) {
    if (cls.parent != "NULL") want_class(cls.parent_span, cls.parent);
    want_class(cls.name_span, cls.name);
    if (!cls.alias.empty()) want_class(cls.alias_span, cls.alias);
    for (const ast::Variable& v : cls.variables) compare_type(v.type);
    for (const ast::Method& m : cls.methods) {
      want(m.name_span, m.name_span.length, "entity.name.function", "the method " + m.name);
      for (const ast::Parameter& p : m.parameters) {
        want(p.keyword_span, p.keyword_span.length, "entity.other.attribute-name", "the keyword " + p.keyword);
        if (p.variable_span.line == p.keyword_span.line)
          want(p.variable_span, p.variable_span.length, "variable.parameter", "the parameter " + p.variable);
        compare_type(p.type);
      }
      for (const ast::Variable& v : m.locals) compare_type(v.type);
      for (const ast::StmtPtr& statement : m.body)
        walk(*statement, [&](const ast::Expr& e) {
          if (const auto* made = std::get_if<ast::NewExpr>(&e.node)) want_class(made->class_span, made->class_name);
          if (const auto* all = std::get_if<ast::AllExpr>(&e.node)) want_class(all->class_span, all->class_name);
        });
    }
  }

  std::string name_;
  Sources sources_;
  Diagnostics diagnostics_;
  std::uint32_t file_ = 0;
  std::vector<Token> tokens_;
  ast::File tree_;
  bool valid_ = false;
  std::vector<std::string> scopes_, offences_;
};

struct Total {
  std::size_t files = 0;
  std::vector<std::string> offences;
};

Total compare_all(const Grammar& grammar) {
  Total total;
  for (const char* folder : {"tests/steve", "samples/worlds", "steve/library"}) {
    std::set<fs::path> paths;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(BREVE_SOURCE) / folder))
      if (entry.path().extension() == ".tz") paths.insert(entry.path());
    for (const fs::path& path : paths) {
      Comparison one(grammar, fs::relative(path, BREVE_SOURCE).string(), decoded(read(path)),
                     std::string_view(folder) == "steve/library");
      if (!one.valid()) continue;
      ++total.files;
      const std::vector<std::string>& found = one.offences();
      total.offences.insert(total.offences.end(), found.begin(), found.end());
    }
  }
  return total;
}

std::size_t offences_in(const std::string& text, const json& definition) {
  const Grammar grammar(definition);
  Comparison one(grammar, "text", text, false);
  EXPECT_TRUE(one.valid());
  return one.offences().size();
}

TEST(TextMateGrammar, AgreesWithTheScannerAndTheParserOnEveryValidProgram) {
  const Grammar grammar(grammar_definition());
  const Total total = compare_all(grammar);
  EXPECT_GT(total.files, 200U);
  for (std::size_t i = 0; i < std::min<std::size_t>(total.offences.size(), 40); ++i) ADD_FAILURE() << total.offences[i];
  EXPECT_EQ(total.offences.size(), 0U);
}

// Each kind of thing, taken out of the grammar, is missed.
TEST(TextMateGrammar, AnyRuleThatIsMissingIsNoticed) {
  const std::string program =
      "@use Control. # comment\nController A.\n@define N 5.\nControl : A (aka As) {\n  % docs\n  + variables:\n    v "
      "(Mobile "
      "object).\n  + to go at p = \"x\" (string):\n    if 1: print \"$p\", 2.5 - sqrt(3), new Mobile.\n}\n";
  ASSERT_EQ(offences_in(program, grammar_definition()), 0U);
  for (const char* rule :
       {"comments", "directives", "class-header", "method-header", "types", "strings", "numbers", "words"}) {
    json definition = grammar_definition();
    definition["repository"][rule] = {{"patterns", json::array()}};
    EXPECT_GT(offences_in(program, definition), 0U) << rule;
  }
}

TEST(EditorPage, ItsConfigurationsAreJson) {
  const std::string page = read(fs::path(BREVE_SOURCE) / "docs/editors/README.md");
  std::size_t count = 0;
  for (std::size_t at = page.find("```json\n"); at != std::string::npos; at = page.find("```json\n", at + 1)) {
    const std::string text = page.substr(at + 8, page.find("```", at + 8) - at - 8);
    EXPECT_TRUE(json::accept(text)) << text;
    ++count;
  }
  EXPECT_EQ(count, 3U);
}

TEST(TextMateGrammar, WordsInsideNamesAreNoWords) {
  EXPECT_EQ(offences_in("Object : A {\n  + to format if-not x (int):\n    for-each-item, newest, a-for (int).\n\n"
                        "    for-each-item = newest.\n    self push-up.\n}\n",
                        grammar_definition()),
            0U);
}

}  // namespace
}  // namespace breve::test
