// `breve replay`: runs the iterations of a log again, and says where they differ.
#pragma once

#include <string>
#include <vector>

#include "output.hpp"

namespace breve::command {

struct ReplayOptions {
  std::string file;
  std::vector<std::string> plugins;  // directories
  bool quiet = false, hash = false;
};

/// @return  the exit status
int replay(const ReplayOptions& options, Output& output);

}  // namespace breve::command
