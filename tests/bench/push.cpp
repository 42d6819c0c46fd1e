// What a step of Push costs: a loop of additions by the interpreter, beside plain C++ that calls as simple operations
// on a stack of integers through a table. Claims: at least 20 million steps a second, and at most 8 times as
// much a step, for code that is data and is counted. Prints steps a second; exits 1 if a claim does not hold.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <vector>

#include "runtime/learn/push/interpreter.hpp"
#include "runtime/learn/push/text.hpp"

namespace {

using breve::push::Interpreter;

constexpr std::int32_t kIterations = 2'000'000;
constexpr int kRounds = 7;  // the fastest counts: the others were disturbed
constexpr double kBound = 8;
constexpr double kLeastMillions = 20;  // steps a second

struct Measured {
  double seconds;  // CPU time
  std::uint64_t steps;
  std::int32_t sum;
};

Measured interpreted(const breve::push::Code& program) {
  Interpreter interpreter(std::pmr::get_default_resource());
  breve::Random random(1);
  interpreter.push(interpreter.integers, 0);
  interpreter.push(interpreter.integers, kIterations);
  interpreter.begin(program);
  std::uint64_t left = 100ULL * kIterations;
  const std::clock_t start = std::clock();
  while (interpreter.advance(left, random) == breve::push::Outcome::Paused) interpreter.take_work();
  return {static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, interpreter.effort, interpreter.integers.back()};
}

using Integers = std::vector<std::int32_t>;
using Operation = void (*)(Integers& stack);

void push_one(Integers& stack) { stack.push_back(1); }
void add(Integers& stack) {
  const std::int32_t top = stack.back();
  stack.pop_back();
  stack.back() += top;
}

Measured plain() {
  static const volatile Operation kProgram[] = {push_one,
                                                add};  // volatile: calls that the compiler does not see through
  Integers stack{0};
  const std::clock_t start = std::clock();
  for (std::int32_t iteration = 0; iteration < kIterations; ++iteration)
    for (const volatile Operation& operation : kProgram) operation(stack);
  return {static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 2ULL * kIterations, stack.back()};
}

}  // namespace

int main() {
  const auto program = breve::push::parse("EXEC.DO*TIMES (1 INTEGER.+)", std::pmr::get_default_resource());
  Measured ours{1e30, 0, 0}, theirs{1e30, 0, 0};
  for (int round = 0; round < kRounds; ++round) {
    const Measured first = interpreted(program), second = plain();
    if (first.seconds < ours.seconds) ours = first;
    if (second.seconds < theirs.seconds) theirs = second;
  }
  if (ours.sum != kIterations || theirs.sum != kIterations) return std::puts("the sums differ"), 1;
  const auto nanoseconds = [](const Measured& of) { return 1e9 * of.seconds / static_cast<double>(of.steps); };
  const double ratio = nanoseconds(ours) / nanoseconds(theirs);
  const double millions = 1e3 / nanoseconds(ours);
  std::printf(
      "push: %.1f million steps a second (at least %.0f), %.2f ns a step; plain C++ %.2f ns; ratio %.1f (at most "
      "%.0f)\n",
      millions, kLeastMillions, nanoseconds(ours), nanoseconds(theirs), ratio, kBound);
  return ratio <= kBound && millions >= kLeastMillions ? 0 : 1;
}
