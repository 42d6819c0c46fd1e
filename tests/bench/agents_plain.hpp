// The models of bench_agents in plain C++: arrays, a uniform grid, and nothing general.
#pragma once

namespace plain {

/// What a run gives: a number that a steve program of the same model also gives, and the time of its steps.
struct Outcome {
  double result = 0;
  double seconds = 0;  // processor time of the steps
};

Outcome flocking(int steps);
Outcome segregation(int steps);
Outcome wolf_sheep(int steps);
Outcome life(int steps);
Outcome gray_scott(int steps);

/// Processor time of this thread, s.
double now();

}  // namespace plain
