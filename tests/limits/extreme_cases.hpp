// Statements that ask natives for as much work as one can ask for: every selector of every class of the library, every
// function, and what the language itself does with values, with the largest, the least and the oddest arguments.
#pragma once

#include <string>
#include <vector>

namespace breve::limits {

/// One statement, and what it is about: "Image write", "randomGauss()", "==".
struct ExtremeCase {
  std::string name, statement;
  bool fits = false;  // its arguments are those that the native takes
};

/// Cases that share a world, and the program that has each of them as a method: "case-0", "case-1", ... Before each,
/// `ready` is to be called, which makes what an earlier case has freed.
struct ExtremeProgram {
  std::string about;  // the class of the receiver
  std::string text;
  std::vector<ExtremeCase> cases;
};

std::vector<ExtremeProgram> extreme_programs();

}  // namespace breve::limits
