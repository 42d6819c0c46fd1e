// Selection of parents by their fitness, which is maximised: probabilities, and draws from them.
// Source: Eiben and Smith, Introduction to Evolutionary Computing, 2nd edition 2015, section 5.2.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "runtime/base/random.hpp"

namespace breve::learn {

/// Probabilities by linear ranking: the fittest of n has pressure / n, the least fit (2 - pressure) / n, the others lie
/// evenly between. Those that are equally fit share what their ranks have.
/// @param pressure   1 to 2
/// @param result     one for each of `fitness`
void rank_probabilities(std::span<const double> fitness, double pressure, std::span<double> result);

/// Probabilities proportional to the fitness above that of the least fit (windowing); equal ones if all are equally
/// fit.
void proportional_probabilities(std::span<const double> fitness, std::span<double> result);

/// An index drawn with these probabilities.
std::size_t draw_index(std::span<const double> probabilities, Random& random);

}  // namespace breve::learn
