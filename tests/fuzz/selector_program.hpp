// Makes programs out of choices that call any selector of any library class, with values of the right types and with
// odd ones, from methods, handlers, hooks of natives and whatever else runs script.
#pragma once

#include <cstddef>
#include <string>

#include "choices.hpp"

namespace breve::fuzz {

struct SelectorProgram {
  std::string text;  // it may fail to compile: what the library declares decides that
  /// How many ways there are to run it. The controller's variable `course` says which: each has actions of its own.
  std::size_t courses = 0;
};
SelectorProgram selector_program(Choices& choices);

}  // namespace breve::fuzz
