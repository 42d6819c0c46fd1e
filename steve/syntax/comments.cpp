// White space, comments, documentation lines and section headings. A line that starts with '%' is documentation unless
// it plainly continues an expression: old programs put such comments anywhere, even between the items of a list.
#include <algorithm>

#include "steve/syntax/scanner.hpp"
#include "steve/syntax/words.hpp"

namespace breve::steve {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

// Does the text behind a '%' read like an operand and operators, rather than like prose (two words side by side)?
bool reads_like_operand(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size() && is_blank(text[i])) ++i;
  if (i == text.size()) return false;
  if (!is_word(text[i]) && std::string_view("(.|'\"!").find(text[i]) == std::string_view::npos) return false;
  int depth = 0;
  for (; i < text.size(); ++i) {
    if (text[i] == '#') break;
    if (text[i] == '(') ++depth;
    if (text[i] == ')') --depth;
    if (!is_blank(text[i]) || i == 0 || depth > 0) continue;
    std::size_t next = i;
    while (next < text.size() && is_blank(text[next])) ++next;
    if (next < text.size() && is_word(text[i - 1]) && text[next] != '-' && is_word(text[next])) return false;
    i = next - 1;
  }
  return true;
}

}  // namespace

std::size_t Scanner::line_end(std::size_t from) {
  if (from >= known_from_ && from <= known_line_end_) return known_line_end_;
  known_from_ = from;
  known_line_end_ = std::min(text_.find_first_of("\r\n", from), end_);
  return known_line_end_;
}

void Scanner::skip_byte() {
  const char c = text_[pos_++];
  if (c != '\n' && !(c == '\r' && at(pos_) != '\n')) return;
  ++line_;
  line_start_ = pos_;
  blank_line_so_far_ = true;
  token_on_line_ = false;
}

void Scanner::skip_to(std::size_t i) {
  while (pos_ < i) skip_byte();
}

bool Scanner::skip_space_or_comment() {
  const char c = text_[pos_];
  if (is_blank(c) || c == '\n' || c == '\r') {
    skip_byte();
  } else if (c == '#' && !in_string_) {
    blank_line_so_far_ = false;
    if (at(pos_ + 1) == '!') {
      block_comment();
    } else {
      lint_include();
      pos_ = line_end(pos_);
    }
  } else {
    return foreign_comment();
  }
  space_before_ = true;
  return true;
}

// `#! ... !#` over any number of lines; a Unix "shebang" on the first line is a line comment.
void Scanner::block_comment() {
  const std::size_t close = comment_unclosed_ ? std::string_view::npos : text_.find("!#", pos_ + 2);
  const bool closed = close != std::string_view::npos && close + 2 <= end_;
  if (is_shebang(closed ? close : std::string_view::npos)) {
    pos_ = line_end(pos_);
    return;
  }
  if (closed) {
    skip_to(close + 2);
    blank_line_so_far_ = false;
    return;
  }
  if (!comment_unclosed_) {
    error(span(pos_, 2), "unclosed-comment", "this comment is not closed",
          "close it with !#, or begin it with # alone");
  }
  comment_unclosed_ = true;
  pos_ = line_end(pos_);
}

bool Scanner::is_shebang(std::size_t close) const {
  const bool file_start = pos_ == 0 || (pos_ == 3 && text_.starts_with("\xEF\xBB\xBF"));
  if (!file_start) return false;
  if (close == std::string_view::npos) return true;
  // The first `!#` closes another comment if that comment opens before it.
  std::size_t i = pos_ + 2;
  while (is_blank(at(i))) ++i;
  return at(i) == '/' && text_.substr(pos_ + 2, close - pos_ - 2).find("#!") != std::string_view::npos;
}

bool Scanner::doc_or_section() {
  const char c = text_[pos_];
  if (c == '%' && !percent_is_modulo()) {
    token_span_ = span(pos_, 0);
    const std::size_t begin = pos_;
    pos_ = line_end(pos_);
    push(TokenKind::Doc, begin, text_.substr(begin, pos_ - begin));
    space_before_ = true;
    return true;
  }
  if (c != '+') return false;
  std::size_t word = pos_ + 1;
  while (is_blank(at(word))) ++word;
  const bool heading = text_.substr(word, end_ - word).starts_with("section") && !is_word(at(word + 7));
  const Token* const last = last_token();
  const bool at_member = last == nullptr || (last->kind == TokenKind::Punctuation &&
                                             std::string_view(".{}:").find(last->text) != std::string_view::npos);
  if (!heading || !at_member) return false;
  pos_ = line_end(pos_);
  space_before_ = true;
  return true;
}

bool Scanner::after_directive_string() const {
  const Token* const last = last_token();
  if (last->kind != TokenKind::String || last_ == 0) return false;
  const Word word = word_of(tokens_[last_ - 1].text);
  return word == Word::Include || word == Word::Path;
}

// The '%' is the first sign of its line.
bool Scanner::percent_is_modulo() {
  const Token* const last = last_token();
  if (last == nullptr || after_directive_string()) return false;
  bool operand = last->kind == TokenKind::Int || last->kind == TokenKind::Double || last->kind == TokenKind::String;
  if (last->kind == TokenKind::Name) {
    const Word word = word_of(last->text);
    operand = word == Word::None || word == Word::Self || word == Word::Super;
  }
  if (last->kind == TokenKind::Punctuation) operand = last->text == ")" || last->text == "]" || last->text == "|";
  if (!operand) return false;
  const std::size_t rest = pos_ + (at(pos_ + 1) == '=' ? 2U : 1U);
  const bool modulo = reads_like_operand(text_.substr(rest, line_end(pos_) - std::min(rest, line_end(pos_))));
  if (!modulo && ++lints_ <= kMaxErrorsPerFile) {
    diagnostics_.warning(span(pos_, 1), "lint-leading-percent",
                         "this line is read as a comment, though the statement before it is unfinished",
                         "begin comments inside a statement with #; to take a remainder, end the line before with %");
  }
  return modulo;
}

}  // namespace breve::steve
