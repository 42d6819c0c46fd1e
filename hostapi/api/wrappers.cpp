// Which function of the C headers each wrapper of breve.hpp is for, as a table: breve_wrappers breve.hpp wrappers.md
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>

namespace {

/// The functions that each wrapper names, by the name of the C function.
std::map<std::string, std::set<std::string>> wrappers_of(std::istream& in) {
  // Members stand two columns in, functions of the namespace at the start of a line; bodies are further in.
  static const std::regex cls(R"((?:class|struct)(?: \[\[nodiscard\]\])? (\w+)[^;]*)");
  static const std::regex member(R"((?:  |inline |template )(?:[^ /].*?[ *&])??~?(\w+)\(.*)");
  static const std::regex called(R"(\bbreve_[a-z0-9_]+(?=[(),]))");
  std::map<std::string, std::set<std::string>> found;
  std::string line, within, name;
  while (std::getline(in, line)) {
    std::smatch match;
    if (std::regex_match(line, match, cls)) within = std::string(match[1]) + "::";
    if (line == "};") within.clear();
    const bool begins =
        within.empty() ? line.starts_with("inline ") : line.starts_with("  ") && line.size() > 2 && line[2] != ' ';
    if (begins && std::regex_match(line, match, member)) name = match[1];
    if (line.find("//") < line.find("breve_")) continue;
    for (std::sregex_iterator it(line.begin(), line.end(), called), end; it != end; ++it)
      if (!name.empty() && name != it->str()) found[it->str()].insert(within + name);
  }
  return found;
}

}  // namespace

int main(int argc, char** argv) {
  std::ifstream in(argc == 3 ? argv[1] : "");
  std::ofstream out(argc == 3 ? argv[2] : "");
  out << "# breve.hpp, by the functions of the C headers\n\n| function | wrapper |\n| --- | --- |\n";
  for (const auto& [function, wrappers] : wrappers_of(in)) {
    out << "| `" << function << "` |";
    const char* before = " ";
    for (const auto& wrapper : wrappers) out << before << '`' << wrapper << '`', before = ", ";
    out << " |\n";
  }
  if (in.bad() || !out.flush()) {
    std::cerr << "usage: breve_wrappers breve.hpp OUTPUT\n";
    return 1;
  }
  return 0;
}
