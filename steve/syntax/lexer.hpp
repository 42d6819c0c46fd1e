// Text to tokens. Numbers are unsigned (the parser decides on signs); names may contain dashes.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "steve/syntax/diagnostic.hpp"
#include "steve/syntax/source.hpp"

namespace breve::steve {

enum class TokenKind : std::uint8_t { Name, Int, Double, String, Punctuation, Doc, End };

struct Token {
  TokenKind kind = TokenKind::End;
  std::string_view text;  // into the source. As written; String: without the quotes, escapes as written
  std::int32_t int_value = 0;
  double double_value = 0;
  bool space_before = false;  // white space or a comment before it
  bool space_after = false;
  bool starts_line = false;
  Span span;
};

/// More tokens than this in one file is an error: it bounds the memory that a hostile file can take.
inline constexpr std::size_t kMaxTokens = 2'000'000;

/// All tokens of a file, an End token last. Reports every error and goes on after it. Linear in the length of the text.
/// The tokens' texts point into `sources`.
std::vector<Token> lex(const Sources& sources, std::uint32_t file, Diagnostics& diagnostics);

/// The tokens of the expression in bytes [begin, end) of the file, which stand inside a string literal: there a string
/// is delimited by backslash-quote pairs, and nothing is a documentation comment.
std::vector<Token> lex_inside_string(const Sources& sources, std::uint32_t file, std::uint32_t begin, std::uint32_t end,
                                     Diagnostics& diagnostics);

}  // namespace breve::steve
