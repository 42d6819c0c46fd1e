// `breve check`: everything that the compiler has to say about some files.
#pragma once

#include <string>
#include <vector>

#include "output.hpp"

namespace breve::command {

struct CheckOptions {
  std::vector<std::string> files, paths;
  std::vector<std::string> allowed;  // codes of lints
  bool strict = false;               // warnings are errors
  bool json = false;
  std::vector<std::string> plugins;  // directories whose libraries may be loaded
};

/// @return  the exit status: 0, 1 if a file has an error, 2 if a file is missing
int check(const CheckOptions& options, Output& output);

}  // namespace breve::command
