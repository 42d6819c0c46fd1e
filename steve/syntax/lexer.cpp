// Tokens: names, numbers, characters, strings, punctuation. Comments are in comments.cpp.
#include "steve/syntax/lexer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "steve/syntax/scanner.hpp"

namespace breve::steve {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_name_char(char c) { return is_letter(c) || is_digit(c) || c == '-'; }

constexpr std::string_view kPairs[] = {"::", "||", "&&", "==", "!=", "<=", ">=", "++",
                                       "--", "+=", "-=", "*=", "/=", "%=", "^="};
constexpr std::string_view kSingles = ".,:()[]{}|=<>!+-*/%^@?;";
constexpr std::string_view kDebug = "@@DEBUG@@";

// Can a token, a comment or white space begin with this byte?
bool is_expected(char c) {
  return is_letter(c) || is_digit(c) || kSingles.find(c) != std::string_view::npos ||
         std::string_view(" \t\r\n\"'#").find(c) != std::string_view::npos;
}

// Is a number that is out of range too small, rather than too large?
bool is_tiny(std::string_view digits) {
  const std::size_t exponent = digits.find_first_of("eE");
  if (exponent != std::string_view::npos) return digits[exponent + 1] == '-';
  return digits[digits.find_first_not_of('0')] == '.';
}

std::string help_for_byte(std::string_view rest) {
  if (rest.starts_with('\\')) return "division is written /";
  if (rest.starts_with('~')) return "logical not is written !; there are no operators for bits";
  if (rest.starts_with("\xC2\xB0")) return "angles are in radians: 90 degrees are PI / 2";
  if (rest.starts_with('$')) return "variables are written without '$'; '$' belongs inside strings";
  if (rest.starts_with("\xE2\x80\x9C") || rest.starts_with("\xE2\x80\x9D")) return "write straight quotes: \"";
  if (rest.starts_with("\xE2\x80\x98") || rest.starts_with("\xE2\x80\x99")) return "write straight quotes: '";
  if (static_cast<unsigned char>(rest.front()) >= 0x80) {
    return "only ASCII letters, digits, '_' and '-' are allowed outside strings and comments";
  }
  return {};
}

}  // namespace

std::vector<Token> lex(const Sources& sources, std::uint32_t file, Diagnostics& diagnostics) {
  const std::string_view text = sources.file(file).text;
  const std::size_t begin = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  return Scanner(sources, file, begin, text.size(), false, diagnostics).run();
}

std::vector<Token> lex_inside_string(const Sources& sources, std::uint32_t file, std::uint32_t begin, std::uint32_t end,
                                     Diagnostics& diagnostics) {
  return Scanner(sources, file, begin, end, true, diagnostics).run();
}

Scanner::Scanner(const Sources& sources, std::uint32_t file, std::size_t begin, std::size_t end, bool in_string,
                 Diagnostics& diagnostics)
    : text_(sources.file(file).text),
      file_(file),
      pos_(begin),
      end_(end),
      in_string_(in_string),
      diagnostics_(diagnostics) {
  const Span start = sources.span_at(file, static_cast<std::uint32_t>(begin), 0);
  line_ = start.line;
  line_start_ = begin - (start.column - 1);
}

std::vector<Token> Scanner::run() {
  while (pos_ < end_) {
    if (skip_space_or_comment()) continue;
    if (blank_line_so_far_ && !in_string_ && doc_or_section()) continue;
    if (tokens_.size() >= kMaxTokens) {
      error(span(pos_, 1), "file-too-large", fmt::format("the file has more than {} tokens", kMaxTokens),
            "split it into several files, or read the data from a file at run time");
      pos_ = end_;
      break;
    }
    token();
  }
  if (has_last_) tokens_[last_].space_after = true;
  token_span_ = span(pos_, 0);
  push(TokenKind::End, pos_, {});
  return std::move(tokens_);
}

void Scanner::token() {
  blank_line_so_far_ = false;
  token_span_ = span(pos_, 0);
  const char c = text_[pos_];
  if (is_letter(c)) {
    name();
  } else if (is_digit(c) || (c == '.' && is_digit(at(pos_ + 1)))) {
    number();
  } else if (c == '"' || (in_string_ && starts_with("\\\""))) {
    string();
  } else if (c == '\'') {
    character();
  } else if (!punctuation() && !pasted()) {
    unexpected_bytes();
  }
}

// A name may hold dashes, even doubled, but never ends with one.
void Scanner::name() {
  const std::size_t begin = pos_;
  while (is_name_char(at(pos_))) ++pos_;
  while (text_[pos_ - 1] == '-') --pos_;
  push(TokenKind::Name, begin, text_.substr(begin, pos_ - begin));
}

// 'e', a sign or none, and digits?
bool Scanner::exponent_at(std::size_t i) const {
  if (at(i) != 'e' && at(i) != 'E') return false;
  return is_digit(at(at(i + 1) == '-' || at(i + 1) == '+' ? i + 2 : i + 1));
}

// Unsigned. Digits, a period and no digit after it are an integer and a period: the parser knows whether it ends a
// statement or belongs to the number.
void Scanner::number() {
  const std::size_t begin = pos_;
  bool integer = true;
  while (is_digit(at(pos_))) ++pos_;
  if (at(pos_) == '.' && is_digit(at(pos_ + 1))) {
    integer = false;
    for (++pos_; is_digit(at(pos_));) ++pos_;
  } else if (at(pos_) == '.' && pos_ > begin && exponent_at(pos_ + 1)) {
    ++pos_;
  }
  if (at(pos_) == 'e' || at(pos_) == 'E') {
    std::size_t digits = pos_ + 1;
    if (at(digits) == '-' || at(digits) == '+') ++digits;
    if (is_digit(at(digits))) {
      integer = false;
      for (pos_ = digits; is_digit(at(pos_));) ++pos_;
    }
  }
  const std::string_view digits = text_.substr(begin, pos_ - begin);
  const bool negated = has_last_ && tokens_[last_].text == "-" && tokens_[last_].kind == TokenKind::Punctuation;
  push(integer ? TokenKind::Int : TokenKind::Double, begin, digits);
  Token& token = tokens_.back();
  const char* const last = digits.data() + digits.size();
  if (!integer) {
    if (std::from_chars(digits.data(), last, token.double_value).ec != std::errc{}) {
      if (is_tiny(digits)) {
        token.double_value = 0.0;
      } else {
        error(token.span, "number-too-large", "this number is out of the range of a float (about 1.8e308)");
      }
    }
    return;
  }
  std::int64_t value = 0;
  const bool fits = std::from_chars(digits.data(), last, value).ec == std::errc{};
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (fits && value <= kMost) {
    token.int_value = static_cast<std::int32_t>(value);
  } else if (fits && value == kMost + 1 && negated) {
    token.int_value = std::numeric_limits<std::int32_t>::min();  // the parser checks that the minus is a sign
  } else {
    error(token.span, "integer-too-large",
          fmt::format("{} does not fit in an int of 32 bits (at most {})", digits.substr(0, 40), kMost),
          "write a float, for example with '.0' after it");
  }
}

// Left to right, a backslash always taking the next byte with it.
void Scanner::string() {
  const std::size_t open = in_string_ && text_[pos_] == '\\' ? 2 : 1;
  const std::size_t begin = pos_, inner = pos_ + open;
  const std::size_t limit = search_to_line_end_ ? line_end(pos_) : end_;
  std::size_t i = inner;
  const std::string_view close = open == 2 ? "\\\"" : "\"";
  while (i < limit && text_.substr(i, close.size()) != close) i += text_[i] == '\\' && i + 1 < limit ? 2 : 1;
  if (i + close.size() <= limit) {
    note_long_string(begin, i + close.size());
    skip_to(i + close.size());
    push(TokenKind::String, begin, text_.substr(inner, i - inner));
    return;
  }
  if (blame_long_string()) return;
  error(span(begin, 1), "unterminated-string", "this string has no closing quote",
        "put a '\"' where the text ends; inside a string write \\\" for a quote");
  search_to_line_end_ = true;
  const std::size_t end = line_end(begin);
  skip_to(end);
  push(TokenKind::String, begin, text_.substr(std::min(inner, end), end - std::min(inner, end)));
}

// 'c': the code of one byte. '\'' and the escapes of strings are also taken; '\' alone is the backslash.
void Scanner::character() {
  const std::size_t begin = pos_;
  const char c = at(pos_ + 1), after = at(pos_ + 2);
  const auto take = [&](char value, std::size_t length) {
    pos_ += length;
    push(TokenKind::Int, begin, text_.substr(begin, length));
    tokens_.back().int_value = static_cast<unsigned char>(value);
  };
  if (c == '\\' && at(pos_ + 3) == '\'' && pos_ + 3 < end_) {
    switch (after) {
      case 'n': return take('\n', 4);
      case 't': return take('\t', 4);
      case '"':
      case '\'':
      case '\\': return take(after, 4);
      default: break;
    }
  }
  if (pos_ + 2 < end_ && after == '\'' && c != '\n' && c != '\r') return take(c, 3);
  std::size_t close = pos_ + 1;
  const std::size_t limit = std::min(line_end(pos_), pos_ + 40);
  while (close < limit && text_[close] != '\'') ++close;
  const std::size_t length = close < limit ? close + 1 - begin : 1;
  error(span(begin, length), "bad-character", "a character literal holds exactly one byte, as in 'a' or '\\n'",
        "text goes in double quotes: \"...\"");
  take('\0', length);
}

bool Scanner::punctuation() {
  const std::size_t begin = pos_;
  if (starts_with(kDebug)) {
    pos_ += kDebug.size();
    push(TokenKind::Punctuation, begin, kDebug);
    return true;
  }
  for (const std::string_view pair : kPairs) {
    if (!starts_with(pair)) continue;
    pos_ += 2;
    push(TokenKind::Punctuation, begin, text_.substr(begin, 2));
    return true;
  }
  if (kSingles.find(text_[pos_]) == std::string_view::npos) return false;
  ++pos_;
  push(TokenKind::Punctuation, begin, text_.substr(begin, 1));
  return true;
}

// A run of bytes that mean nothing is one error.
void Scanner::unexpected_bytes() {
  const std::size_t begin = pos_;
  do skip_byte();
  while (pos_ < end_ && !is_expected(text_[pos_]) && !(in_string_ && starts_with("\\\"")));
  const auto byte = static_cast<unsigned char>(text_[begin]);
  const bool printable = byte > 0x20 && byte < 0x7F;
  const std::string what = printable ? fmt::format("unexpected character '{}'", text_[begin])
                                     : fmt::format("unexpected byte 0x{:02X} outside a string or comment", byte);
  Span where = token_span_;
  where.length = static_cast<std::uint32_t>(pos_ - begin);
  error(where, "unexpected-byte", what, help_for_byte(text_.substr(begin, pos_ - begin)));
}

void Scanner::push(TokenKind kind, std::size_t begin, std::string_view text) {
  if (has_last_ && kind != TokenKind::Doc) tokens_[last_].space_after = space_before_;
  Token token;
  token.kind = kind;
  token.text = text;
  token.space_before = space_before_;
  token.starts_line = !token_on_line_;
  token.span = token_span_;
  token.span.length = static_cast<std::uint32_t>(pos_ - begin);
  tokens_.push_back(token);
  if (kind == TokenKind::Doc) return;
  last_ = tokens_.size() - 1;
  has_last_ = true;
  token_on_line_ = true;
  space_before_ = false;
}

Span Scanner::span(std::size_t begin, std::size_t length) const {
  return {file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(length), line_,
          static_cast<std::uint32_t>(begin - line_start_ + 1)};
}

void Scanner::error(const Span& where, std::string code, std::string message, std::string help) {
  ++errors_;
  if (errors_ < kMaxErrorsPerFile) diagnostics_.error(where, std::move(code), std::move(message), std::move(help));
  if (errors_ == kMaxErrorsPerFile)
    diagnostics_.error(where, "too-many-errors", "too many errors; the rest is not shown");
}

}  // namespace breve::steve
