// `breve doc`: reference pages out of the documentation comments of programs.
#pragma once

#include <string>
#include <vector>

#include "output.hpp"

namespace breve::command {

struct DocOptions {
  std::vector<std::string> files, paths;
  bool library = false;  // also the class library's classes
  std::string out = "reference";
  std::string format = "both";  // markdown, html, both
};

/// @return  the exit status: 0, 1 if a file has an error or a page cannot be written, 2 if a file is missing
int doc(const DocOptions& options, Output& output);

}  // namespace breve::command
