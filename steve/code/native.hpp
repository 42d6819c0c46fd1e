// What a program knows of a function in C++: its name, its signature and its address. steve/machine/native.hpp makes
// them out of ordinary functions.
#pragma once

#include <cstdint>
#include <string_view>

namespace breve::steve {

class Machine;
struct Instance;
union Slot;
struct Value;

/// @param self    the receiver (methods) or the calling instance (functions); never null
/// @param args    the parameters in declaration order, each in as many slots as its type takes
/// @param result  NULL on entry
using NativeFunction = void (*)(Machine& machine, Instance& self, const Slot* args, Value& result);

/// What of the outside a native touches, if the host lets it.
enum class Reach : std::uint8_t { World, Reads, Writes, Sleeps, RealTime, Entropy, Commands, Network };

struct Native {
  std::string_view name;  // "real.get-location" (class file, selector) or, for functions, "dot"
  NativeFunction function;
  std::string_view
      signature;  // one letter a parameter, then ':' and that of the result; see SlotType in steve/machine/native.hpp
  Reach reach;
};

}  // namespace breve::steve
