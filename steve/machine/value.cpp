// Names of types, and the strings that live in programs.
#include "steve/machine/value.hpp"

#include <array>

#include "runtime/base/hasher.hpp"
#include "steve/machine/cells.hpp"

namespace breve::steve {

std::string_view type_name(Tag tag) {
  static constexpr std::array<std::string_view, 11> kNames = {"NULL",   "int",  "double", "vector",  "matrix", "string",
                                                              "object", "list", "hash",   "pointer", "data"};
  return kNames[static_cast<std::size_t>(tag)];
}

std::uint32_t string_hash(std::string_view text) {
  Hasher hasher;
  hasher.add(text);
  const auto folded = static_cast<std::uint32_t>(hasher.value() >> 32);
  return folded == 0 || folded == HashCell::kRemoved ? 1 : folded;
}

}  // namespace breve::steve
