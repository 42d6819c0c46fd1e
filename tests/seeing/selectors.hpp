// The drawing selectors of the class library, each with a scene in which it is seen.
#pragma once

#include <span>

namespace breve::seeing {

struct Selector {
  const char* name;    // "Class selector", as the table of selectors has them
  const char* setup;   // statements of the controller's init
  const char* effect;  // statements that use the selector, and make another picture
  int steps = 0;       // iterations between the effect and the picture
};

std::span<const Selector> control_selectors();
std::span<const Selector> body_selectors();
std::span<const Selector> other_selectors();

}  // namespace breve::seeing
