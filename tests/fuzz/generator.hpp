// Makes valid, well-typed programs out of choices. What it makes always compiles; what happens when it runs is open.
#pragma once

#include <string>

#include "choices.hpp"

namespace breve::fuzz {

/// The text of a program. Its controller prints from its methods, and understands keys "a" and "b", clicks and a menu.
std::string generate_program(Choices& choices);

}  // namespace breve::fuzz
