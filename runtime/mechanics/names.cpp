// Names of what can be chosen or told: rungs, guard modes, reasons, kinds of joints.
#include <fmt/format.h>

#include <array>

#include "runtime/base/error.hpp"
#include "runtime/mechanics/accuracy.hpp"
#include "runtime/mechanics/joint.hpp"
#include "runtime/mechanics/ledger.hpp"

namespace breve {

namespace {

using Words = std::string_view;

// KEEP IN STEP: the enumerations.
constexpr std::array<Words, 5> kKinds{"revolute", "prismatic", "fixed", "universal", "ball"};
constexpr std::array<Words, 5> kRungs{"fast", "balanced", "precise", "reference", "conserving"};
constexpr std::array<Words, 4> kModes{"off", "report", "refine", "rest"};
constexpr std::array<Words, 4> kActions{"reported", "refined", "put to rest", "finished coarsely"};
constexpr std::array<Words, 10> kReasons{"a number is not finite",
                                         "unexplained energy gain",
                                         "an overlap grows",
                                         "a body rotates too far in one sub-step",
                                         "a damper is too strong for the sub-step",
                                         "more impacts in one sub-step than can be located",
                                         "no solution was found for an equation of the step",
                                         "the work budget of the step is used up",
                                         "a link moves too fast for step control",
                                         "a joint opens"};

template <class Enum, std::size_t N>
Enum named(const std::array<Words, N>& names, Words name, Words what) {
  std::string list;
  for (std::size_t i = 0; i < N; ++i) {
    if (names[i] == name) return static_cast<Enum>(i);
    list += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 == N ? " or " : ", ", names[i]);
  }
  throw Error(ErrorCode::Argument, fmt::format("unknown {} \"{}\": must be {}", what, name, list));
}

template <class Enum, std::size_t N>
Words word(const std::array<Words, N>& names, Enum value) {
  return names[static_cast<std::size_t>(value)];
}

}  // namespace

Words name_of(JointKind kind) { return word(kKinds, kind); }
Words name_of(Rung rung) { return word(kRungs, rung); }
Words name_of(GuardMode mode) { return word(kModes, mode); }
Words name_of(GuardAction action) { return word(kActions, action); }
Words words_for(GuardReason reason) { return word(kReasons, reason); }
Rung rung_named(Words name) { return named<Rung>(kRungs, name, "accuracy"); }
GuardMode guard_named(Words name) { return named<GuardMode>(kModes, name, "guard mode"); }

}  // namespace breve
