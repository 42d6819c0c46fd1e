// Measures one scene: breve on its rungs and the peers, in turns within one run.
#pragma once

#include <breve/breve.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/scenes/scene.hpp"

namespace breve::bench {

struct Effort {
  int iterations = 1000;
  double most_seconds = 20;  // of CPU for one side; what is slower is cut short
};

/// A side of a scene and what its iterations cost.
struct Contender {
  std::string name;
  std::optional<breve_rung> rung;  // of breve; none: a peer
  std::vector<double> times;       // s of CPU, of each iteration that it came to
  std::vector<double> rounds;      // s of CPU an iteration, the mean of each round
  bool cut = false;
  std::string refusal;  // why there are no times; empty: there are
  std::uint64_t interventions = 0;
  int lost = 0;                                      // bodies that fell out of the scene
  scenes::Vector3 middle = scenes::Vector3::Zero();  // mean location of the bodies that are left

  double milliseconds() const;  // of an iteration: the median of the rounds
  double slowest() const;       // iteration, over the median one
};

/// The peers' times are first, those of breve on `rungs` follow.
std::vector<Contender> measure(const scenes::Scene& scene, const std::vector<breve_rung>& rungs, const Effort& effort);

/// The median over the rounds of the quotient of two sides' times.
double ratio(const Contender& one, const Contender& other);

const char* name_of(breve_rung rung);

}  // namespace breve::bench
