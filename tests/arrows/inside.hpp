// What the house asks of the inside of its files: short functions, no uncalled functions, no state of the process,
// headings that are true.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "source.hpp"

namespace breve::house {

struct Offence {
  std::string file;
  std::size_t line;
  std::string what;
};

class Inside {
 public:
  explicit Inside(std::filesystem::path root);
  /// A file of the house, or of its tests, which may call what nobody else does if for_tests.txt has it.
  void add(const std::string& file);
  std::vector<Offence> offences() const;

 private:
  void find_long(const std::string& file, const Source& source, std::vector<Offence>& out) const;
  void find_state(const std::string& file, std::vector<Offence>& out) const;
  void find_dead(std::vector<Offence>& out) const;
  void find_false_headings(const std::string& file, const Source& source, std::vector<Offence>& out) const;

  std::filesystem::path root_;
  std::set<std::string> for_tests_;  // functions that only tests call, with a reason
  std::map<std::string, Source> files_;
};

/// Names in unnamed namespaces that two files of one lot have: CMake's lots are read from the build at `build`.
std::vector<Offence> names_that_meet(const std::filesystem::path& root, const std::filesystem::path& build);

}  // namespace breve::house
