// The search: creatures drawn at random, then children of the worst of each kind.
#pragma once

#include <functional>

#include "trial.hpp"

namespace adversary {

struct Found {
  Case one;
  Verdict verdict;
  int number = -1;  // of the evaluation; -1: none
};

/// The worst of each measure.
using Worst = std::array<Found, kMeasures>;

struct Search {
  Setting setting;
  Family family = Family::Drift;
  std::uint64_t seed = 1;
  int evaluations = 100;
  bool random = false;  // no mutations
};

/// @param begin, look  called before and after each evaluation
Worst search(const Search& is, const std::function<void(const Found&)>& begin,
             const std::function<void(const Found&)>& look);

/// The smallest creature that still exceeds the bound of a measure, by as much as a tenth of what this one does.
Case shrink(const Case& one, const Setting& setting, Measure measure, double& seconds);

}  // namespace adversary
