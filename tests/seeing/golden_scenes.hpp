// The scenes of the golden pictures.
#pragma once

#include <cstdint>
#include <span>

namespace breve::seeing {

struct GoldenScene {
  const char* name;   // of the file golden/NAME.png
  const char* setup;  // statements of the controller's init
  int dimension = 3;
  bool full = false;             // with BREVE_LOOK_FULL
  int steps = 0;                 // iterations before the picture, one drawn after each
  std::uint32_t arrows = 0;      // of breve_arrows
  const char* parent = nullptr;  // class of the controller; null: Control, or PlanarControl in 2D
};

std::span<const GoldenScene> golden_scenes();

}  // namespace breve::seeing
