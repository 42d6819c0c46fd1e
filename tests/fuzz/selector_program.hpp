// Makes programs out of choices that call any selector of any library class, with values of the right types and with
// odd ones, from methods, handlers, hooks of natives and whatever else runs script.
#pragma once

#include <string>

#include "choices.hpp"

namespace breve::fuzz {

/// The text of a program. It may fail to compile: what the library declares decides that.
std::string selector_program(Choices& choices);

}  // namespace breve::fuzz
