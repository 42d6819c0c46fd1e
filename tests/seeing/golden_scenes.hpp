// The scenes of the golden pictures.
#pragma once

#include <span>

namespace breve::seeing {

struct GoldenScene {
  const char* name;   // of the file golden/NAME.png
  const char* setup;  // statements of the controller's init
  int dimension = 3;
  bool full = false;  // with BREVE_LOOK_FULL
  int steps = 0;      // iterations before the picture, one drawn after each
};

std::span<const GoldenScene> golden_scenes();

}  // namespace breve::seeing
