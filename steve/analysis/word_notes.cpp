// Notes on reserved words, for completion and hover texts.
#include "steve/analysis/word_notes.hpp"

#include <algorithm>

namespace breve::steve {

namespace {

constexpr WordNote kTopLevel[] = {
    {"Controller", "Controller Name.", "The class that runs the simulation."},
};

constexpr NameKind kDirective = NameKind::Directive;
constexpr WordNote kDirectives[] = {
    {"use", "@use Name.", "Load the file Name.tz, or a class of the class library.", kDirective},
    {"include", "@include \"file.tz\"", "Load a file by its name.", kDirective},
    {"path", "@path \"directory\"", "Also search a directory for files.", kDirective},
    {"define", "@define NAME literal.", "Give a name to a number, string, vector or matrix.", kDirective},
    {"plugin", "@plugin \"file\"(entry).",
     "Adds the functions and classes of a shared library, if the host allows plugins.", kDirective},
    {"nib_file", "@nib_file \"file\".", "Ignored: an interface file of another system.", kDirective},
};

constexpr WordNote kStatements[] = {
    {"if", "if condition: statement", "Followed by `else statement` for the other case."},
    {"else", "else statement", "After the statement of an `if`."},
    {"while", "while condition: statement", "Repeat as long as the condition holds."},
    {"for", "for start, condition, step: statement", "Repeat, counting."},
    {"foreach", "foreach item in list: statement", "For each element of a list."},
    {"return", "return value.", "End the method, with a value or without."},
    {"print", "print item, item.", "Write items and end the line."},
    {"printf", "printf item, item.", "Write items without ending the line."},
    {"free", "free object.", "Free an object, or all objects of a list."},
    {"die", "die \"message\".", "End the call with an error."},
    {"sort", "sort list with method.",
     "Sort by a method of this object that compares two elements: negative, 0 or positive."},
};

constexpr WordNote kOperands[] = {
    {"self", "self", "The object whose method runs."},
    {"super", "super", "The same object, but with its parent class's methods."},
    {"new", "new Name", "A new object; `5 new Names` is a list of five."},
    {"all", "all Names", "A list of the objects of a class and its descendants."},
    {"random", "random[bound]", "A random number from 0 to the bound, of its type."},
    {"push", "push value onto list", "Append an element."},
    {"pop", "pop list", "Remove the last element; yields it."},
    {"prepend", "prepend value onto list", "Put an element before the first."},
    {"unprepend", "unprepend list", "Remove the first element; yields it."},
    {"insert", "insert value at list{index}", "Put an element before another."},
    {"remove", "remove list{index}", "Remove an element from a list or hash; yields it."},
    {"copylist", "copylist list", "A copy of a list, with the same elements."},
};

constexpr NameKind kType = NameKind::Type;
constexpr WordNote kTypes[] = {
    {"int", "(int)", "A whole number of 32 bits; starts as 0.", kType},
    {"float", "(float)", "A number of double precision; starts as 0.", kType},
    {"double", "(double)", "The same as float.", kType},
    {"vector", "(vector)", "Three floats (x, y, z); starts as zeros.", kType},
    {"matrix", "(matrix)", "Three by three floats; starts as zeros.", kType},
    {"string", "(string)", "Text; starts empty.", kType},
    {"list", "(list)", "Values of any type in order; starts empty.", kType},
    {"hash", "(hash)", "Values by keys; starts empty.", kType},
    {"object", "(object)", "Any object, or null.", kType},
    {"pointer", "(pointer)", "A value that only functions can use, such as an open file.", kType},
    {"data", "(data)", "Bytes.", kType},
};

constexpr WordNote kArrayTypes[] = {
    {"ints", "(5 ints)", "An array of whole numbers.", kType},
    {"floats", "(5 floats)", "An array of floats.", kType},
    {"doubles", "(5 doubles)", "The same as floats.", kType},
    {"vectors", "(5 vectors)", "An array of vectors.", kType},
    {"matrices", "(5 matrices)", "An array of matrices.", kType},
    {"strings", "(5 strings)", "An array of strings.", kType},
    {"lists", "(5 lists)", "An array of lists.", kType},
    {"hashes", "(5 hashes)", "An array of hashes.", kType},
    {"objects", "(5 objects)", "An array of objects.", kType},
    {"pointers", "(5 pointers)", "An array of pointers.", kType},
};

constexpr NameKind kMethod = NameKind::Method;
constexpr WordNote kSpecialMethods[] = {
    {"init", "+ to init:", "Runs when an object is created, the root class's first.", kMethod},
    {"iterate", "+ to iterate:", "Runs in each iteration; a controller's calls `super iterate`.", kMethod},
    {"post-iterate", "+ to post-iterate:", "Runs at the end of each iteration.", kMethod},
    {"destroy", "+ to destroy:", "Runs when the object is freed.", kMethod},
    {"delete", "+ to delete:", "Runs when the object is freed, for its class and every ancestor.", kMethod},
    {"get-description", "+ to get-description:", "Yields the text that print shows for the object.", kMethod},
};

}  // namespace

std::span<const WordNote> top_level_words() { return kTopLevel; }
std::span<const WordNote> directive_words() { return kDirectives; }
std::span<const WordNote> statement_words() { return kStatements; }
std::span<const WordNote> operand_words() { return kOperands; }
std::span<const WordNote> type_words() { return kTypes; }
std::span<const WordNote> array_type_words() { return kArrayTypes; }
std::span<const WordNote> special_methods() { return kSpecialMethods; }

const WordNote* word_note(std::string_view word) {
  for (const std::span<const WordNote> words :
       {top_level_words(), directive_words(), statement_words(), operand_words(), type_words(), array_type_words()}) {
    const auto found =
        std::find_if(words.begin(), words.end(), [&](const WordNote& note) { return note.word == word; });
    if (found != words.end()) return &*found;
  }
  return nullptr;
}

}  // namespace breve::steve
