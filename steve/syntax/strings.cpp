// String expressions: escapes, and the references after '$'.
//
// A reference is `$name`, `$name{3}`, `$name[3]`, the same in braces (`${name}`), or an expression in braces. Old
// programs know no expressions: where the braces hold a name and something that is not an expression, the name alone is
// the reference and the rest is text, as ever.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "steve/syntax/parser_nodes.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kLongestExpression = 500;  // bytes in ${...}: keeps reading any string linear

bool is_reference_char(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

// The end of `{12}` or `[12]` at `i`, and its number; npos if the brackets hold anything else.
std::size_t literal_index(std::string_view raw, std::size_t i, std::int32_t& value) {
  const char close = raw[i] == '{' ? '}' : ']';
  std::size_t first = i + 1;
  while (first < raw.size() && (raw[first] == ' ' || raw[first] == '\t')) ++first;
  const auto [end, problem] = std::from_chars(raw.data() + first, raw.data() + raw.size(), value);
  if (problem != std::errc{} || value < 0 || raw[first] == '-') return std::string_view::npos;
  auto last = static_cast<std::size_t>(end - raw.data());
  while (last < raw.size() && (raw[last] == ' ' || raw[last] == '\t')) ++last;
  return last < raw.size() && raw[last] == close ? last + 1 : std::string_view::npos;
}

// For each '{' of the text the position of its '}', or 0.
std::vector<std::uint32_t> match_braces(std::string_view raw) {
  std::vector<std::uint32_t> match(raw.size(), 0);
  std::vector<std::uint32_t> open;
  for (std::uint32_t i = 0; i < raw.size(); ++i) {
    if (raw[i] == '{') open.push_back(i);
    if (raw[i] != '}' || open.empty()) continue;
    match[open.back()] = i;
    open.pop_back();
  }
  return match;
}

}  // namespace

// The reading position in a string, and what it has given so far.
class Interpolation {
 public:
  Interpolation(Parser& parser, const Token& token) : parser_(parser), raw_(token.text) {
    const std::string_view source = parser.sources_.file(token.span.file).text;
    file_ = token.span.file;
    base_ = static_cast<std::uint32_t>(raw_.data() - source.data());
    node_.texts.emplace_back();
  }

  ast::StringLit run() {
    while (i_ < raw_.size()) {
      if (raw_[i_] == '\\' && i_ + 1 < raw_.size()) {
        escape();
      } else if (raw_[i_] == '$') {
        dollar();
      } else {
        node_.texts.back() += raw_[i_++];
      }
    }
    return std::move(node_);
  }

 private:
  Span location_of(std::size_t begin, std::size_t length) const {
    return parser_.sources_.span_at(file_, base_ + static_cast<std::uint32_t>(begin),
                                    static_cast<std::uint32_t>(length));
  }

  // Pairs that mean nothing are kept, both characters.
  void escape() {
    const char c = raw_[i_ + 1];
    std::string& text = node_.texts.back();
    switch (c) {
      case 'n': text += '\n'; break;
      case 't': text += '\t'; break;
      case '"':
      case '\\': text += c; break;
      case '$':
        parser_.lint(location_of(i_, 2), "lint-escaped-dollar", "'\\$' keeps its backslash in the text",
                     "a '$' before a space or a character other than '{' is printed without a backslash");
        [[fallthrough]];
      default:
        text += '\\';
        text += c;
        break;
    }
    i_ += 2;
  }

  void dollar() {
    const std::size_t start = i_++;
    if (i_ == raw_.size()) {
      parser_.lint(location_of(start, 1), "lint-lone-dollar", "a '$' at the end of a string is dropped",
                   "write the name of a variable after it, or a space to print it");
      return;
    }
    const bool braces = raw_[i_] == '{' && i_ + 1 < raw_.size();
    if (braces && braced_expression(start)) return;
    if (braces) ++i_;
    const std::size_t name = i_;
    while (i_ < raw_.size() && is_reference_char(raw_[i_])) ++i_;
    if (i_ == name) {
      parser_.lint(
          location_of(start, 1), "lint-lone-dollar", "this '$' has no name after it and is printed unchanged",
          "write the name of a variable directly after it, or state that it is intended: # allow: lint-lone-dollar");
      node_.texts.back() += '$';
      i_ = start + 1;
      return;
    }
    ast::StringLit::Part part;
    part.name = raw_.substr(name, i_ - name);
    if (part.name == "super") part.name = "self";
    index(part);
    if (braces && i_ < raw_.size() && raw_[i_] == '}') {
      ++i_;
    } else if (braces) {
      parser_.lint(location_of(start, i_ - start), "lint-interpolation",
                   fmt::format("this is read as '${{{}}}'; the rest is text", part.name),
                   "close the braces directly after the name, or write a whole expression in them");
    }
    part.span = location_of(start, i_ - start);
    add(std::move(part));
  }

  void index(ast::StringLit::Part& part) {
    if (i_ >= raw_.size() || (raw_[i_] != '{' && raw_[i_] != '[')) return;
    std::int32_t value = 0;
    const std::size_t end = literal_index(raw_, i_, value);
    if (end == std::string_view::npos) {
      parser_.lint(location_of(i_, 1), "lint-interpolation",
                   fmt::format("'{}' after '${}' does not contain a literal number and is text", raw_[i_], part.name),
                   fmt::format("for an element write an expression in braces: ${{{}{{i}}}}", part.name));
      return;
    }
    part.index = value;
    part.array = raw_[i_] == '[';
    i_ = end;
  }

  // `${` with more than a name before its '}'. False: read it as a name in braces.
  bool braced_expression(std::size_t start) {
    const std::size_t open = i_;
    std::size_t after = open + 1;
    while (after < raw_.size() && is_reference_char(raw_[after])) ++after;
    const bool named = after > open + 1;
    if (named && after < raw_.size() && raw_[after] == '}') return false;
    std::int32_t value = 0;
    if (named && after < raw_.size() && (raw_[after] == '{' || raw_[after] == '[')) {
      const std::size_t end = literal_index(raw_, after, value);
      if (end < raw_.size() && raw_[end] == '}') return false;
    }
    if (match_.empty()) match_ = match_braces(raw_);
    const std::size_t close = match_[open];
    if (close <= open + 1 || close - open > kLongestExpression) return false;
    const std::string_view inside = raw_.substr(open + 1, close - open - 1);
    if (inside.find('$') < inside.find("\\\"")) return false;
    Diagnostics trial;
    const auto at = [&](std::size_t i) { return base_ + static_cast<std::uint32_t>(i); };
    const std::vector<Token> tokens = lex_inside_string(parser_.sources_, file_, at(open + 1), at(close), trial);
    ast::ExprPtr expr;
    if (trial.error_count() == 0) {
      Parser inner(tokens, parser_.defines_, nullptr, trial, parser_.sources_, parser_.embedded_);
      inner.depth_ = parser_.depth_;
      expr = inner.lone_expression();
      parser_.deepest_ = std::max(parser_.deepest_, inner.deepest_);
    }
    if (trial.error_count() > 0 && named) return false;
    for (const Diagnostic& diagnostic : trial.all()) {
      if (diagnostic.severity == Severity::Error) {
        parser_.report(diagnostic);
      } else {
        parser_.diagnostics_.add(diagnostic);
      }
    }
    i_ = close + 1;
    if (expr == nullptr) return true;
    ast::StringLit::Part part;
    part.expr = std::move(expr);
    part.span = location_of(start, i_ - start);
    add(std::move(part));
    return true;
  }

  void add(ast::StringLit::Part part) {
    node_.parts.push_back(std::move(part));
    node_.texts.emplace_back();
  }

  Parser& parser_;
  std::string_view raw_;
  std::uint32_t file_ = 0;
  std::uint32_t base_ = 0;  // offset of raw_ in the file
  std::size_t i_ = 0;
  std::vector<std::uint32_t> match_;
  ast::StringLit node_;
};

ast::ExprPtr Parser::string_literal() {
  const std::size_t start = pos_;
  ast::StringLit node = Interpolation(*this, token()).run();
  advance();
  return make(start, std::move(node));
}

// All the text is one expression; null, and an error reported, if it is not.
ast::ExprPtr Parser::lone_expression() {
  try {
    ast::ExprPtr result = expression();
    if (!at_end()) fail(token().span, "syntax", fmt::format("unexpected {} in the expression of a string", describe()));
    return result;
  } catch (const SyntaxError& problem) {
    report(problem.diagnostic);
    return nullptr;
  }
}

}  // namespace breve::steve
