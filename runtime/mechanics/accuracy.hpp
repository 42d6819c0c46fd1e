// The ladder of accuracy: a rung is a name for plain settings, each of which can be set alone.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "runtime/articulated/integrator.hpp"

namespace breve {

enum class Rung : std::uint8_t { Fast, Balanced, Precise, Reference, Conserving };

struct Accuracy {
  Rung rung = Rung::Balanced;  // where the settings came from; `custom` is on once one of them was set alone
  bool custom = false;
  articulated::Scheme scheme = articulated::Scheme::FehlbergAdaptive;  // smooth motion of trees
  bool implicit_joints = false;    // springs, dampers and motors of joints linearly implicit (Euler's schemes)
  bool implicit_spin = true;       // a free body's spin by the implicit midpoint rule, whatever the scheme
  double step = 0;                 // s, the longest sub-step of motion and contact; 0: the world's integration step
  double tolerance = 1e-2;         // of FehlbergAdaptive; see articulated::Tolerance
  double contact_step = 0;         // s, the longest sub-step of an island that has contacts; 0: `step`
  int iterations = 40;             // at most, of the contact solver where it is iterative
  bool direct = true;              // small islands of contacts are solved directly
  bool locate_impacts = true;      // impacts at their time of impact; off: at the end of the sub-step
  int impacts = 100;               // at most, located in one island and sub-step; the rest without restitution
  bool contact_springs = false;    // contacts with restitution that come slower than its threshold are springs
  bool link_springs = true;        // ... also in islands with articulated bodies
  double contact_stiffness = 1e4;  // N/m per kg of what they push apart
  double contact_damping = 0;      // their ratio of damping, at most 0.9; 0: that of the restitution
};

constexpr int kMostIterations = 10'000;  // that may be asked for

/// The settings of a rung.
Accuracy accuracy_of(Rung rung);
/// "fast", "balanced", "precise", "reference", "conserving".
std::string_view name_of(Rung rung);
/// Error{Argument} that lists the names if there is no such rung.
Rung rung_named(std::string_view name);
/// What the settings mean, in words, for people.
std::string describe(const Accuracy& accuracy);
/// Error{Argument} naming the setting: not finite, negative, zero where there must be something.
void check(const Accuracy& accuracy);

}  // namespace breve
