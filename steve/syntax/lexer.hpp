// Text to tokens. Numbers are unsigned (the parser decides on signs); names may hold dashes; every fix of the
// language's section 14 that concerns the scanner lives here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "steve/syntax/diagnostic.hpp"
#include "steve/syntax/source.hpp"

namespace breve::steve {

enum class TokenKind : std::uint8_t { Name, Int, Double, String, Punctuation, Doc, End };

struct Token {
  TokenKind kind = TokenKind::End;
  std::string text;  // Name, Punctuation, Doc: as written; String: without the quotes, escapes as written
  std::int32_t int_value = 0;
  double double_value = 0;
  bool space_before = false;   // white space or a comment before it
  bool space_after = false;
  bool starts_line = false;
  Span span;
};

std::vector<Token> lex(const Sources& sources, std::uint32_t file, Diagnostics& diagnostics);

}  // namespace breve::steve
