// What the scanner finds in texts that were written for another language or pasted from a web page: it is reported
// and read as what was meant.
#include <fmt/format.h>

#include "steve/syntax/scanner.hpp"

namespace breve::steve {

namespace {

constexpr std::string_view kOpenQuotes[] = {"\xE2\x80\x9C", "\xE2\x80\x9E", "\xC2\xAB"};
constexpr std::string_view kCloseQuotes[] = {"\xE2\x80\x9D", "\xE2\x80\x9C", "\xC2\xBB"};
constexpr std::string_view kDashes[] = {"\xE2\x80\x92", "\xE2\x80\x93", "\xE2\x80\x94", "\xE2\x88\x92"};
constexpr std::string_view kBlanks[] = {"\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89", "\xE2\x80\x8B"};

}  // namespace

// Does `//` stand behind a value, as an operator would?
bool Scanner::divides() const {
  if (!has_last_ || tokens_[last_].span.line != line_) return false;
  const Token& before = tokens_[last_];
  return before.kind == TokenKind::Name || before.kind == TokenKind::Int || before.kind == TokenKind::Double ||
         (before.kind == TokenKind::Punctuation && (before.text == ")" || before.text == "|"));
}

// `// ...` and `/* ... */`.
bool Scanner::foreign_comment() {
  if (in_string_ || !(starts_with("//") || starts_with("/*"))) return false;
  const bool line = starts_with("//");
  if (!foreign_comment_reported_)
    error(span(pos_, 2), "foreign-comment", fmt::format("'{}' does not begin a comment", line ? "//" : "/*"),
          line && divides() ? "a comment begins with #; a quotient without fraction is written floor(a / b)"
          : line            ? "a comment begins with #"
                            : "a comment of several lines is written #! ... !#");
  foreign_comment_reported_ = true;
  const std::size_t close = line ? line_end(pos_) : text_.find("*/", pos_ + 2);
  skip_to(line || (close != std::string_view::npos && close + 2 <= end_) ? close + (line ? 0 : 2) : line_end(pos_));
  space_before_ = true;
  return true;
}

// `#include "file"` is a comment here, and surely meant otherwise.
void Scanner::lint_include() {
  const std::string_view rest = text_.substr(pos_ + 1, 12);
  if (!rest.starts_with("include \"") && !rest.starts_with("include <")) return;
  if (++lints_ > kMaxErrorsPerFile) return;
  diagnostics_.warning(span(pos_, 8), "lint-include-comment", "this line is a comment and loads nothing",
                       "a file is loaded with @include \"file\", a class of the library with @use Name.");
}

// Typographic quotes, dashes and blanks; and a single '&'.
bool Scanner::pasted() {
  const std::size_t begin = pos_;
  for (std::size_t i = 0; i < std::size(kOpenQuotes); ++i) {
    if (!starts_with(kOpenQuotes[i])) continue;
    const std::size_t inner = pos_ + kOpenQuotes[i].size();
    std::size_t close = inner, width = 0;
    const std::size_t limit = line_end(pos_);
    for (; close < limit && width == 0; ++close)
      for (const std::string_view quote : kCloseQuotes)
        if (text_.substr(close).starts_with(quote)) width = quote.size();
    if (width == 0) return false;
    --close;
    error(span(begin, kOpenQuotes[i].size()), "curly-quotes", "typographic quotes do not begin a string",
          "write straight quotes: \"...\"");
    skip_to(close + width);
    push(TokenKind::String, begin, text_.substr(inner, close - inner));
    return true;
  }
  for (const std::string_view dash : kDashes) {
    if (!starts_with(dash)) continue;
    error(span(begin, dash.size()), "unexpected-byte", "this dash is not a minus sign", "write the ordinary one: -");
    skip_to(begin + dash.size());
    push(TokenKind::Punctuation, begin, "-");
    return true;
  }
  for (const std::string_view blank : kBlanks) {
    if (!starts_with(blank)) continue;
    error(span(begin, blank.size()), "unexpected-byte", "this is not an ordinary space",
          "it was pasted from elsewhere, perhaps a web page: type it again");
    skip_to(begin + blank.size());
    space_before_ = true;
    return true;
  }
  if (starts_with("`")) {
    const std::size_t limit = line_end(pos_);
    const std::size_t close = std::min(text_.find('`', pos_ + 1), limit);
    error(span(begin, 1), "curly-quotes", "a string does not begin with '`'",
          "write straight quotes, and a value by its name and a '$': \"n is $n\"");
    skip_to(close < limit ? close + 1 : limit);
    push(TokenKind::String, begin, text_.substr(begin + 1, close - begin - 1));
    return true;
  }
  if (!starts_with("&")) return false;
  error(span(begin, 1), "unexpected-byte", "a single '&' is not an operator", "logical and is written &&");
  ++pos_;
  push(TokenKind::Punctuation, begin, "&&");
  return true;
}

// A quote that closes nothing at the end of a file often means that one is missing far above: where a string goes on
// over the end of its line, and a word follows directly on it.
void Scanner::note_long_string(std::size_t begin, std::size_t close) {
  if (suspect_.known || in_string_ || line_end(begin) >= close) return;
  const char after = at(close);
  const bool word = (after >= 'a' && after <= 'z') || (after >= 'A' && after <= 'Z') || (after >= '0' && after <= '9');
  if (!word) return;
  suspect_ = {true,  tokens_.size(), begin,       last_,         has_last_,
              line_, line_start_,    token_span_, space_before_, token_on_line_};
}

// Go back to that string and end it with its line. Once in a file, so that reading stays linear.
bool Scanner::blame_long_string() {
  if (!suspect_.known || suspect_.used) return false;
  suspect_.used = true;
  tokens_.resize(suspect_.tokens);
  pos_ = suspect_.begin;
  last_ = suspect_.last;
  has_last_ = suspect_.has_last;
  line_ = suspect_.line;
  line_start_ = suspect_.line_start;
  token_span_ = suspect_.location;
  space_before_ = suspect_.space_before;
  token_on_line_ = suspect_.on_line;
  blank_line_so_far_ = false;
  known_from_ = 1;
  known_line_end_ = 0;
  const std::size_t end = line_end(pos_);
  const std::size_t begin = pos_;
  error(span(begin, 1), "unterminated-string", "this string has no closing quote on its line",
        "put a '\"' where the text ends; inside a string write \\\" for a quote");
  skip_to(end);
  push(TokenKind::String, begin, text_.substr(begin + 1, end - begin - 1));
  return true;
}

}  // namespace breve::steve
