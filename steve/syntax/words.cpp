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

}  // namespace

Word word_of(std::string_view text) {
  const auto found = std::lower_bound(kWords.begin(), kWords.end(), text,
                                      [](const Entry& entry, std::string_view key) { return entry.first < key; });
  return found != kWords.end() && found->first == text ? found->second : Word::None;
}

}  // namespace breve::steve
