// Every selector of the table is called, with each of its optional keywords once, by some program of tests/steve that
// has objects of the class: a name that several classes share counts for those that the program knows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/library/selector_table.hpp"

namespace {

using Names = std::vector<std::string>;

bool of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_'; }

Names names_in(std::string_view line) {
  Names names;
  std::string name;
  for (const char c : line) {
    if (of_name(c)) {
      name += c;
      continue;
    }
    if (!name.empty()) names.push_back(name);
    name.clear();
  }
  if (!name.empty()) names.push_back(name);
  return names;
}

bool is_heading(const std::string& line) {
  const std::size_t sign = line.find_first_not_of(" \t");
  return sign != std::string::npos && (line.compare(sign, 5, "+ to ") == 0 || line.compare(sign, 5, "- to ") == 0);
}

/// Parents of classes by name, and classes by their aliases.
struct Classes {
  std::map<std::string, std::string> parents, named;

  /// A line such as "Mobile : Bird (aka Birds) {".
  void take_declaration(const std::string& line) {
    const std::size_t colon = line.find(" : ");
    const Names names = names_in(line);
    if (colon == std::string::npos || !of_name(line.front()) || names.size() < 2 || line.find(' ') != colon) return;
    parents.emplace(names[1], names[0]);
    if (names.size() > 3 && names[2] == "aka") named.emplace(names[3], names[1]);
  }
  /// A class and its ancestors, for a name or an alias; empty for any other name.
  Names with_ancestors(const std::string& name) const {
    const auto alias = named.find(name);
    std::string cls = alias == named.end() ? name : alias->second;
    Names all;
    while (parents.contains(cls) && std::find(all.begin(), all.end(), cls) == all.end()) {
      all.push_back(cls);
      const std::string& parent = parents.at(cls);
      cls = named.contains(parent) ? named.at(parent) : parent;
    }
    return all;
  }
};

/// Objects that objects of a class make, or that are in every program that has one.
const std::map<std::string, Names> kMakes = {
    {"PatchGrid", {"Patch"}},
    {"PatchToroid", {"Patch"}},
    {"BraitenbergVehicle", {"BraitenbergSensor", "BraitenbergWheel"}},
    {"GADirectedGraph", {"GADirectedGraphNode", "GADirectedGraphConnection"}},
    {"Control", {"Camera"}},
};

/// The lines of a program that call something, as names, and the classes that it has objects of.
struct Program {
  std::vector<Names> lines;
  std::set<std::string> classes;
};

Program read_program(const std::filesystem::path& file, Classes classes) {
  Program program;
  std::set<std::string> mentioned;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    line = line.substr(0, std::min(line.find('#'), line.find('%')));
    if (!line.empty()) classes.take_declaration(line);
    Names names = names_in(line);
    mentioned.insert(names.begin(), names.end());
    if (!is_heading(line)) program.lines.push_back(std::move(names));
  }
  for (const std::string& name : mentioned)
    for (const std::string& cls : classes.with_ancestors(name)) {
      program.classes.insert(cls);
      if (const auto made = kMakes.find(cls); made != kMakes.end())
        program.classes.insert(made->second.begin(), made->second.end());
    }
  return program;
}

std::vector<Program> read_programs(const Classes& library) {
  std::vector<Program> programs;
  for (const char* folder : {BREVE_STEVE_TESTS "/library", BREVE_STEVE_TESTS "/old_programs"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".tz") programs.push_back(read_program(entry.path(), library));
  return programs;
}

Classes library_classes() {
  Classes classes;
  for (const auto& entry : std::filesystem::directory_iterator(BREVE_SOURCES "/steve/library")) {
    if (entry.path().extension() != ".tz") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);)
      if (!line.empty()) classes.take_declaration(line);
  }
  return classes;
}

/// Does a program with objects of that class call the selector, with that keyword behind it? Empty: with any.
bool is_called(const std::vector<Program>& programs, const breve::SelectorRow& row, const std::string& keyword) {
  for (const Program& program : programs) {
    if (!program.classes.contains(row.cls)) continue;
    for (const Names& names : program.lines) {
      const auto selector = std::find(names.begin(), names.end(), row.selector);
      if (selector != names.end() && (keyword.empty() || std::find(selector, names.end(), keyword) != names.end()))
        return true;
    }
  }
  return false;
}

TEST(Coverage, EverySelectorOfTheTableIsCalledWithEachOptionalKeyword) {
  // Called by the machine itself.
  const std::set<std::string> by_machine = {"init", "destroy", "delete", "iterate"};
  const std::vector<Program> programs = read_programs(library_classes());
  ASSERT_GT(programs.size(), 300U);
  for (const breve::SelectorRow& row : breve::selector_rows(BREVE_SELECTORS)) {
    if (by_machine.contains(row.selector)) continue;
    EXPECT_TRUE(is_called(programs, row, {})) << row.cls << " " << row.selector;
    for (const std::string& keyword : row.keywords) {
      const std::string name = keyword.substr(0, keyword.find(':'));
      if (keyword.find('=') == std::string::npos) continue;
      EXPECT_TRUE(is_called(programs, row, name)) << row.cls << " " << row.selector << " " << name;
    }
  }
}

}  // namespace
