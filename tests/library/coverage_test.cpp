// Every selector of the table is called, not only declared, by some program of tests/steve/library.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "tests/library/selector_table.hpp"

namespace {

/// Names that programs mention outside comments and that are not the name of a method being defined.
std::set<std::string> names_called() {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(BREVE_STEVE_TESTS)) {
    if (entry.path().extension() != ".tz") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      line = line.substr(0, line.find('#'));
      std::string name, previous;
      for (const char c : line + " ") {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_') {
          name += c;
          continue;
        }
        if (!name.empty() && !(previous == "to" && line.find("+ to " + name) != std::string::npos)) names.insert(name);
        if (!name.empty()) previous = name;
        name.clear();
      }
    }
  }
  return names;
}

TEST(Coverage, EverySelectorOfTheTableIsCalledByAProgram) {
  // Called by the machine itself.
  const std::set<std::string> by_machine = {"init", "destroy"};
  const std::set<std::string> called = names_called();
  ASSERT_GT(called.size(), 300U);
  for (const breve::SelectorRow& row : breve::selector_rows(BREVE_SELECTORS))
    EXPECT_TRUE(by_machine.contains(row.selector) || called.contains(row.selector)) << row.cls << " " << row.selector;
}

}  // namespace
