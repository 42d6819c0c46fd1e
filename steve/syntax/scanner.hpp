// The scanner behind lex(): one pass over the bytes, longest match, every error reported. Private to this folder.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "steve/syntax/lexer.hpp"

namespace breve::steve {

/// At most this many errors of one file are reported by the scanner, and as many by the parser.
inline constexpr std::size_t kMaxErrorsPerFile = 1000;

class Scanner {
 public:
  /// @param in_string  bytes [begin, end) stand inside a string literal (see lex_inside_string)
  Scanner(const Sources& sources, std::uint32_t file, std::size_t begin, std::size_t end, bool in_string,
          Diagnostics& diagnostics);
  std::vector<Token> run();

 private:
  char at(std::size_t i) const { return i < end_ ? text_[i] : '\0'; }
  bool starts_with(std::string_view prefix) const { return text_.substr(pos_, end_ - pos_).starts_with(prefix); }
  std::size_t line_end(std::size_t from);  // where the line of byte `from` ends; remembered, so that asking is cheap

  void skip_byte();  // one byte of white space, comment or string; counts lines
  void skip_to(std::size_t i);
  bool skip_space_or_comment();
  void block_comment();
  bool is_shebang(std::size_t close) const;
  bool doc_or_section();
  bool percent_is_modulo();
  bool after_directive_string() const;
  const Token* last_token() const { return has_last_ ? &tokens_[last_] : nullptr; }

  // what was written for another language (pasted.cpp)
  bool foreign_comment();
  bool divides() const;
  void lint_include();
  bool pasted();
  void note_long_string(std::size_t begin, std::size_t close);
  bool blame_long_string();

  // lexer.cpp
  void token();
  void name();
  void number();
  bool exponent_at(std::size_t i) const;
  void string();
  void character();
  bool punctuation();
  void unexpected_bytes();
  void push(TokenKind kind, std::size_t begin, std::string_view text);
  Span span(std::size_t begin, std::size_t length) const;
  void error(const Span& where, std::string code, std::string message, std::string help = {});

  std::string_view text_;
  std::uint32_t file_;
  std::size_t pos_, end_;
  bool in_string_;
  Diagnostics& diagnostics_;
  std::vector<Token> tokens_;
  std::size_t last_ = 0;  // index of the last token that is not documentation
  bool has_last_ = false;
  std::uint32_t line_ = 1;
  std::size_t line_start_ = 0;
  std::size_t known_line_end_ = 0;
  std::size_t known_from_ = 1;     // [known_from_, known_line_end_] holds no line end
  Span token_span_;                // of the token being scanned; a string may end on a later line
  bool blank_line_so_far_ = true;  // nothing but blanks since the line began
  bool token_on_line_ = false;
  bool space_before_ = false;
  bool search_to_line_end_ = false;  // some string had no closing quote: later ones are not searched beyond their line
  bool comment_unclosed_ = false;
  bool foreign_comment_reported_ = false;
  struct {  // where to go back to if a quote is missing
    bool known = false;
    std::size_t tokens = 0, begin = 0, last = 0;
    bool has_last = false;
    std::uint32_t line = 0;
    std::size_t line_start = 0;
    Span location;
    bool space_before = false, on_line = false, used = false;
  } suspect_;
  std::size_t errors_ = 0;
  std::size_t lints_ = 0;
};

}  // namespace breve::steve
