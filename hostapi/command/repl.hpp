// `breve repl`: statements against a running world.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "access.hpp"
#include "output.hpp"

namespace breve::command {

struct ReplOptions {
  std::string file;  // "": a world with an empty controller and the whole class library
  std::vector<std::string> paths;
  std::optional<std::uint64_t> seed;  // 1 if not given: what is tried out can be tried again
  AccessOptions access;
  bool strict = false, quiet = false;
};

/// @return  the exit status: 0 unless the program cannot be loaded or its world not be made
int repl(const ReplOptions& options, Output& output);

}  // namespace breve::command
