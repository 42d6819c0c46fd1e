// Variation of vectors of reals that stay within bounds: simulated binary crossover and polynomial mutation.
// Source: Deb and Agrawal, Simulated Binary Crossover for Continuous Search Space, Complex Systems 9 (1995); the forms
// with bounds are those of the program that Deb published with NSGA-II (2002).
#pragma once

#include <span>

#include "runtime/base/random.hpp"

namespace breve::learn {

/// The box of all vectors: lowest[i] < highest[i], with a finite difference.
struct Box {
  std::span<const double> lowest, highest;
};

/// Crosses two vectors in place: each pair of numbers, with probability 1/2, becomes two numbers that have the same
/// mean where bounds are far, and are near the parents' for a high index.
/// @param index   of the distribution, >= 0; 20 is usual
void simulated_binary_crossover(std::span<double> first, std::span<double> second, const Box& box, double index,
                                Random& random);

/// Changes each number with this probability, by less for a higher index.
void polynomial_mutation(std::span<double> numbers, const Box& box, double probability, double index, Random& random);

}  // namespace breve::learn
