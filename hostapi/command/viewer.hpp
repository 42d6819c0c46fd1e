// `breve view`: a program in a window.
#pragma once

#include "run.hpp"

namespace breve::command {

struct ViewOptions {
  RunOptions run;               // its file, arguments, seed, accuracy ...; no limits of a run
  std::optional<double> speed;  // simulated seconds in a second; 1 if not given
  bool paused = false;          // at first
  bool software = false;        // draws in main memory even where the machine has OpenGL
  std::string play;             // a file with input to be played, "" for none
};

/// @return  the exit status
int view(const ViewOptions& options, Output& output);

}  // namespace breve::command
