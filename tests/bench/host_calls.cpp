// What a call from steve into a C function with three doubles costs, beside a call of a steve method with three floats
// that returns one of them. The C function writes its result in place. Both run in one process, in turns; the same loop
// without a call is taken off both. Claim: at most 2.5 times as much. Prints nanoseconds a call; exits 1 if the claim
// does not hold.
#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>

#include "breve/breve.hpp"

namespace {

constexpr const char* kProgram = R"(@use Control.
Controller Calls.
Control : Calls {
  + to add-up x a (float) y b (float) z c (float): return b.
  + to run-empty turns n (int):
    i (int). sum (float).
    for i = 0, i < n, i++: sum = sum + 2.0.
    return sum.
  + to run-method turns n (int):
    i (int). sum (float).
    for i = 0, i < n, i++: sum = sum + (self add-up x 1.0 y 2.0 z 3.0).
    return sum.
  + to run-function turns n (int):
    i (int). sum (float).
    for i = 0, i < n, i++: sum = sum + addUp(1.0, 2.0, 3.0).
    return sum.
}
)";
constexpr int kIterations = 2'000'000;
constexpr int kRounds = 9;  // the fastest counts: the others were disturbed
constexpr double kBound = 2.5;

breve_status second_of_three(void*, const breve_call* call, breve_value* result) {
  result->type = BREVE_TYPE_DOUBLE;
  result->as.number = call->arguments[1].as.number;
  return BREVE_OK;
}

double seconds_of(breve::World& world, const char* method) {
  const std::clock_t start = std::clock();
  const double sum = world.call(world.controller(), method, {{"turns", kIterations}}).or_throw().number();
  if (sum != 2.0 * kIterations) throw breve::Failure(BREVE_ERROR_INTERNAL, "a loop gives another sum");
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace

int main() {
  auto runtime = breve::Runtime::create().or_throw();
  const std::array<std::uint32_t, 3> doubles = {BREVE_TYPE_DOUBLE, BREVE_TYPE_DOUBLE, BREVE_TYPE_DOUBLE};
  breve_function function = breve_function_default();
  function.name = "addUp";
  function.parameters = doubles.data();
  function.parameter_count = doubles.size();
  function.result = BREVE_TYPE_DOUBLE;
  function.call = second_of_three;
  runtime.add_function(function).or_throw();
  auto world = runtime.world(runtime.compile("calls.tz", kProgram).or_throw()).or_throw();
  std::array<double, 3> least = {1e9, 1e9, 1e9};
  constexpr std::array kMethods = {"run-empty", "run-method", "run-function"};
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t i = 0; i < kMethods.size(); ++i) least[i] = std::min(least[i], seconds_of(world, kMethods[i]));
  const double method = (least[1] - least[0]) / kIterations * 1e9, host = (least[2] - least[0]) / kIterations * 1e9;
  std::printf("steve method %.1f ns, function of the host %.1f ns, ratio %.2f (at most %.1f)\n", method, host,
              host / method, kBound);
  return host <= kBound * method ? 0 : 1;
}
