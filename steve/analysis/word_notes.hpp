// Reserved words by where they may stand, each with how it is used. Private to this folder.
#pragma once

#include <span>
#include <string_view>

#include "steve/analysis/analysis.hpp"

namespace breve::steve {

struct WordNote {
  std::string_view word, usage, note;
  NameKind kind = NameKind::Word;
};

std::span<const WordNote> top_level_words();
std::span<const WordNote> directive_words();
std::span<const WordNote> statement_words();  // that nothing but a statement begins with
std::span<const WordNote> operand_words();
std::span<const WordNote> type_words();
std::span<const WordNote> array_type_words();
std::span<const WordNote> special_methods();  // that are called by themselves

/// The note on a reserved word or directive; null if there is none.
const WordNote* word_note(std::string_view word);

}  // namespace breve::steve
