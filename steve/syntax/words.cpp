// The table of reserved words.
#include "steve/syntax/words.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace breve::steve {

namespace {

using Entry = std::pair<std::string_view, Word>;

// In the order of the spelling, for the binary search.
constexpr std::array kWords{
    Entry{"Controller", Word::Controller},
    Entry{"aka", Word::Aka},
    Entry{"all", Word::All},
    Entry{"copylist", Word::Copylist},
    Entry{"data", Word::Data},
    Entry{"define", Word::Define},
    Entry{"die", Word::Die},
    Entry{"double", Word::Double},
    Entry{"doubles", Word::Doubles},
    Entry{"else", Word::Else},
    Entry{"float", Word::Float},
    Entry{"floats", Word::Floats},
    Entry{"for", Word::For},
    Entry{"foreach", Word::Foreach},
    Entry{"free", Word::Free},
    Entry{"hash", Word::Hash},
    Entry{"hashes", Word::Hashes},
    Entry{"if", Word::If},
    Entry{"include", Word::Include},
    Entry{"insert", Word::Insert},
    Entry{"int", Word::Int},
    Entry{"ints", Word::Ints},
    Entry{"list", Word::List},
    Entry{"lists", Word::Lists},
    Entry{"matrices", Word::Matrices},
    Entry{"matrix", Word::Matrix},
    Entry{"new", Word::New},
    Entry{"nib_file", Word::NibFile},
    Entry{"object", Word::Object},
    Entry{"objects", Word::Objects},
    Entry{"path", Word::Path},
    Entry{"plugin", Word::Plugin},
    Entry{"pointer", Word::Pointer},
    Entry{"pointers", Word::Pointers},
    Entry{"pop", Word::Pop},
    Entry{"prepend", Word::Prepend},
    Entry{"print", Word::Print},
    Entry{"printf", Word::Printf},
    Entry{"push", Word::Push},
    Entry{"random", Word::Random},
    Entry{"remove", Word::Remove},
    Entry{"return", Word::Return},
    Entry{"self", Word::Self},
    Entry{"sort", Word::Sort},
    Entry{"string", Word::String},
    Entry{"strings", Word::Strings},
    Entry{"super", Word::Super},
    Entry{"unprepend", Word::Unprepend},
    Entry{"use", Word::Use},
    Entry{"vector", Word::Vector},
    Entry{"vectors", Word::Vectors},
    Entry{"version", Word::Version},
    Entry{"while", Word::While},
};
static_assert(std::is_sorted(kWords.begin(), kWords.end()));

/// @param words  with a blank before and behind each
bool is_one_of(std::string_view word, std::string_view words) {
  return !word.empty() && words.find(" " + std::string(word) + " ") != std::string_view::npos;
}

}  // namespace

Word word_of(std::string_view text) {
  const auto found = std::lower_bound(kWords.begin(), kWords.end(), text,
                                      [](const Entry& entry, std::string_view key) { return entry.first < key; });
  return found != kWords.end() && found->first == text ? found->second : Word::None;
}

std::string_view foreign_type(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kTypes{{
      {" bool boolean Bool Boolean ", "there is no boolean type: write int, where 0 is false and 1 is true"},
      {" integer Integer Int long short unsigned char uint ", "whole numbers are int"},
      {" number real Float Double decimal ", "numbers with a fraction are float, whole numbers int"},
      {" str String text ", "texts are string"},
      {" dict map Hash dictionary ", "write hash"},
  }};
  if (word == "array") return "write list, or for an array its number of elements: (5 floats)";
  for (const auto& [words, help] : kTypes)
    if (is_one_of(word, words)) return help;
  return {};
}

bool names_a_size(std::string_view word) { return is_one_of(word, " length size count len strlen "); }

bool names_a_push(std::string_view word) {
  return is_one_of(word, " add append push-back push_back add-item put enqueue ");
}

bool names_a_print(std::string_view word) { return is_one_of(word, " println echo puts writeln write say log show "); }

std::string reserved_in_small(std::string_view word) {
  std::string small(word);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small != word && word_of(small) != Word::None ? small : std::string();
}

}  // namespace breve::steve
