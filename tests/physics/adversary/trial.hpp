// One run of a creature, judged by the searcher's own books.
#pragma once

#include <string>

#include "creature.hpp"
#include "genes.hpp"

namespace adversary {

/// The errors of a run; each is relative to the scale of its kind and 0 where all is right.
enum Measure {
  kEnergy,    // rise of energy less the works of motors and forces above its lowest value so far
  kMomentum,  // drift of momentum, without gravity
  kSpin,      // drift of angular momentum about the centre of mass, without gravity
  kCenter,    // the centre of mass leaves its straight line, without gravity
  kBooks,     // the ledger's residual against the searcher's own balance, beyond round-off of what is stored
  kLosses,    // the losses together fall, where nothing drives
  kMotors,    // the ledger books more work of motors than strength times way
  kForces,    // the ledger books another work of the host's forces than force times way
  kTold,      // positions that joints tell against those of the poses, rad or m
  kFar,       // how far a body gets from where it began, m, where nothing throws it
  kMeasures
};
const char* name_of(Measure measure);
bool measure_named(const std::string& name, Measure& measure);
/// What a measure must stay below.
double bound_of(Measure measure, breve_rung rung);

struct Verdict {
  std::array<double, kMeasures> found{};  // of the whole run; 1e30 for what is not finite
  double scale = 0;                       // J
  double gained = 0;                      // J above the start, less the works
  std::uint64_t interventions = 0;
  double work = 0;      // counted by the library
  double cut = 0;       // s at the end that were not run, since the work was too much
  double cpu = 0;       // s; told only
  std::string refused;  // what the library said where it refused the creature or a step

  double excess(Measure measure, breve_rung rung) const { return found[measure] / bound_of(measure, rung); }
  Measure worst(breve_rung rung) const;
};

struct Setting {
  breve_rung rung = BREVE_RUNG_BALANCED;
  double seconds = 10, step = 1.0 / 60;
  bool tell = false;  // print the balance as it goes
  double work = 3e7;  // a run that takes more is cut short
};

Verdict run_case(const Case& one, const Setting& setting);

}  // namespace adversary
