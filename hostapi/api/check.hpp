// A C program that compiles only if the headers are as an Interface says.
#pragma once

#include <ostream>

#include "scanner.hpp"

namespace breve::api {

void write_check(const Interface& interface, std::ostream& out);

}  // namespace breve::api
