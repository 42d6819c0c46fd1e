// Reads the tokens of a statement that has no end yet, and says what may follow. Private to this folder.
#pragma once

#include "steve/analysis/context.hpp"

namespace breve::steve {

/// @param context  its `count` is set; the rest is filled
/// @param start    where the statement begins at the latest
void read_statement(const std::vector<Token>& tokens, std::size_t start, Context& context);

inline bool is_sign(const Token& token, std::string_view text) {
  return token.kind == TokenKind::Punctuation && token.text == text;
}
inline bool is_name(const Token& token, std::string_view text) {
  return token.kind == TokenKind::Name && token.text == text;
}

}  // namespace breve::steve
