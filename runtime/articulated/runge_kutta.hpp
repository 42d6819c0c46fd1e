// Explicit Runge-Kutta schemes on curved spaces: the stages are tangents at the step's start, corrected by the inverse
// differential of the exponential map, so that attitude has the full order.
// Source: Munthe-Kaas 1999; Hairer, Lubich, Wanner 2006, IV.8.
#pragma once

#include <array>
#include <vector>

#include "runtime/articulated/method.hpp"

namespace breve::articulated {

constexpr int kMostStages = 6;

/// A Butcher tableau; row i of `a` has i numbers.
struct Tableau {
  int stages;
  std::array<double, kMostStages> c;
  std::array<std::array<double, kMostStages - 1>, kMostStages> a;
};
using Weights = std::array<double, kMostStages>;

extern const Tableau kClassic;
extern const Weights kClassicWeights;
extern const Tableau kFehlberg;
extern const Weights kFehlbergWeights4, kFehlbergWeights5;

/// The stages of one step, and sums of them.
class Stages {
 public:
  Stages(System& system, const Tableau& tableau);

  /// Calls evaluate(t, q, v, a) for each stage of a step from q, v at t.
  template <class F>
  void run(double t, const Vector& q, const Vector& v, double h, F evaluate) {
    for (int i = 0; i < tableau_.stages; ++i) {
      const auto at = static_cast<std::size_t>(i);
      sum(tableau_.a[at].data(), i, h, d_, v_);
      v_ += v;
      system_.move(q, d_, q_);
      evaluate(t + tableau_.c[at] * h, q_, v_, rates_v_[at]);
      system_.rate_of_move(d_, v_, rates_d_[at]);
    }
  }

  /// Tangent and change of velocity by h times the weighted sum of the first `count` stages.
  void sum(const double* weights, int count, double h, Vector& d, Vector& dv) const;
  void sum(const Weights& weights, double h, Vector& d, Vector& dv) const {
    sum(weights.data(), tableau_.stages, h, d, dv);
  }

  const Vector& acceleration(int stage) const { return rates_v_[static_cast<std::size_t>(stage)]; }

 private:
  System& system_;
  const Tableau& tableau_;
  std::vector<Vector> rates_d_, rates_v_;
  Vector q_, v_, d_;
};

}  // namespace breve::articulated
