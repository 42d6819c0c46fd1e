// The contents of a source file of C or C++: functions, names that are used, comments. A reader of tokens and braces,
// not a compiler: it knows the forms that this repository is written in, and needs no build.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace breve::house {

struct Token {
  enum class Kind { Word, Number, Text, Sign } kind;
  std::string text;
  std::size_t line;
};

struct Comment {
  std::size_t line;
  std::string text;  // with its slashes
  bool alone;        // nothing stands before it on its line
};

/// An entity with a name in a namespace or a class: a function, or something else that could meet another of that name.
struct Name {
  std::string name;
  std::string owner;  // of a method: its class, as it is spelled there ("Core", "Dynamics::Core"); else empty
  std::string space;  // the namespaces around it, "breve::contact"; an unnamed one is "{}"
  std::size_t first_line = 0, last_line = 0;
  bool function = false;
  bool defined = false;   // here; else declared
  bool in_class = false;  // within the braces of its class
  bool is_static = false;
  bool overrides = false;  // or is virtual: called through another name
  bool is_template = false;
};

/// An identifier where it is not being declared: `inside` names the function around it, if there is one.
struct Use {
  std::string name;
  std::string inside;
};

struct Source {
  std::vector<Name> names;
  std::vector<Use> uses;
  std::vector<Comment> comments;
  std::vector<std::size_t> breaks;  // lines at which a section of a class ends: access specifiers and closing braces
};

Source read_source(const std::filesystem::path& path);

}  // namespace breve::house
