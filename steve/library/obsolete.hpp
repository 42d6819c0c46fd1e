// Selectors that exist so that old programs run, and do nothing. Asked to be verbose, the machine says so once for
// each.
#pragma once

#include <algorithm>
#include <string>

#include "steve/library/support.hpp"

namespace breve::steve {

/// A selector as a template argument.
template <std::size_t N>
struct Selector {
  char text[N];
  constexpr Selector(const char (&literal)[N]) { std::copy_n(literal, N, text); }
  constexpr std::string_view view() const { return {text, N - 1}; }
};

/// The native of an obsolete selector: yields the zero of R (false for int, null for references, nothing for void).
template <Selector S, class R = void, class... Arguments>
R obsolete(Machine& machine, Instance&, Arguments...) {
  if (machine.host().verbose)
    machine.warn_once("obsolete:" + std::string(S.view()),
                      [] { return "'" + std::string(S.view()) + "' is obsolete: it does nothing"; });
  if constexpr (!std::is_void_v<R>) return R{};
}

}  // namespace breve::steve
