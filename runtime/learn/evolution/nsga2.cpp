// NSGA-II: candidates by tournaments, crossover and mutation; survivors.
#include "runtime/learn/evolution/nsga2.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/base/error.hpp"

namespace breve::learn {

namespace {

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorCode::Argument, why); }

std::string range(std::int64_t low, std::int64_t high) {
  return " (must be " + std::to_string(low) + " to " + std::to_string(high) + ")";
}

}  // namespace

Nsga2::Nsga2(std::pmr::memory_resource* memory)
    : lowest_(memory), highest_(memory), candidates_(memory), survivors_(memory), values_(memory) {}

void Nsga2::begin(std::span<const double> lowest, std::span<const double> highest, std::int32_t objectives,
                  std::int32_t population) {
  if (lowest.empty() || lowest.size() > kMaxDimension)
    refuse("a search in " + std::to_string(lowest.size()) + " dimensions" + range(1, kMaxDimension));
  if (highest.size() != lowest.size())
    refuse("the highest numbers are " + std::to_string(highest.size()) + " (must be as many as the lowest, " +
           std::to_string(lowest.size()) + ")");
  for (std::size_t i = 0; i < lowest.size(); ++i)
    if (!(lowest[i] < highest[i]) || !std::isfinite(highest[i] - lowest[i]))
      refuse("the range of number " + std::to_string(i) + " is empty or not finite");
  if (objectives < 1 || objectives > kMaxObjectives)
    refuse("a search with " + std::to_string(objectives) + " objectives" + range(1, kMaxObjectives));
  if (population < 4 || population > kMaxPopulation)
    refuse("a population of " + std::to_string(population) + range(4, kMaxPopulation));

  dimension_ = 0;  // until all is there
  lowest_.resize(lowest.size());
  highest_.resize(highest.size());
  candidates_.resize(lowest.size() * static_cast<std::size_t>(population));
  survivors_.resize(0);
  values_.resize(0);
  std::copy(lowest.begin(), lowest.end(), lowest_.begin());
  std::copy(highest.begin(), highest.end(), highest_.begin());
  dimension_ = static_cast<std::int32_t>(lowest.size());
  objectives_ = objectives;
  population_ = population;
  crossover_ = {0.9, 20};
  mutation_ = {1.0 / dimension_, 20};
  asked_ = false;
  generation_ = 0;
}

Nsga2::Operator Nsga2::checked(const char* name, double probability, double index) const {
  if (dimension_ == 0) refuse("there is no search: begin one first");
  if (!(probability >= 0 && probability <= 1)) refuse(std::string("the probability of ") + name + " must be 0 to 1");
  if (!(index >= 0 && index <= kMaxIndex)) refuse(std::string("the index of ") + name + " must be 0 to 1000");
  return {probability, index};
}

void Nsga2::set_crossover(double probability, double index) { crossover_ = checked("crossover", probability, index); }

void Nsga2::set_mutation(double probability, double index) { mutation_ = checked("mutation", probability, index); }

std::span<const double> Nsga2::ask(Random& random, const Poll& poll) {
  if (dimension_ == 0) refuse("there is no search: begin one first");
  if (survivors_.size() != 0) {
    breed(random, poll);
  } else {
    const std::size_t n = lowest_.size();
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const double low = lowest_[i % n], high = highest_[i % n];
      candidates_[i] = std::clamp(low + (high - low) * random.uniform(), low, high);
    }
  }
  asked_ = true;
  return {candidates_.data(), candidates_.size()};
}

/// Parents by binary tournaments; of each pair two children, of the last one only the first if there is an odd number.
void Nsga2::breed(Random& random, const Poll& poll) {
  const CrowdedOrder order(values(), poll);
  const auto n = static_cast<std::size_t>(dimension_), size = static_cast<std::size_t>(population_);
  const auto winner = [&] {
    const std::size_t a = random.below(size), b = random.below(size);
    return survivor(order.prefers(b, a) ? b : a);
  };
  std::vector<double> spare(n);
  for (std::size_t child = 0; child < size; child += 2) {
    const std::span<double> first(candidates_.data() + child * n, n);
    const std::span<double> second = child + 1 < size ? std::span(candidates_.data() + (child + 1) * n, n) : spare;
    std::ranges::copy(winner(), first.begin());
    std::ranges::copy(winner(), second.begin());
    if (random.uniform() <= crossover_.probability)
      simulated_binary_crossover(first, second, box(), crossover_.index, random);
    polynomial_mutation(first, box(), mutation_.probability, mutation_.index, random);
    polynomial_mutation(second, box(), mutation_.probability, mutation_.index, random);
    if (poll) poll();
  }
}

void Nsga2::tell(std::span<const double> told, const Poll& poll) {
  if (!asked_) refuse("there are no candidates: ask for them first");
  const auto n = static_cast<std::size_t>(dimension_), m = static_cast<std::size_t>(objectives_);
  const auto size = static_cast<std::size_t>(population_);
  if (told.size() != m * size)
    refuse(std::to_string(told.size()) + " values (must be " + std::to_string(m * size) +
           ", one for each objective and candidate)");

  std::vector<double> all(values_.begin(), values_.end());
  for (const double value : told) all.push_back(comparable(value));
  const std::size_t before = values_.size() / m;
  const std::vector<std::uint32_t> order = CrowdedOrder({all, m}, poll).sorted();

  Numbers survivors(survivors_.memory(), n * size), values(values_.memory(), m * size);
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t at = order[i];
    std::ranges::copy(at < before ? survivor(at) : row(candidates_, at - before, dimension_), survivors.data() + i * n);
    std::copy_n(all.data() + at * m, m, values.data() + i * m);
  }
  survivors_.swap(survivors);
  values_.swap(values);
  asked_ = false;
  ++generation_;
}

std::vector<std::uint32_t> Nsga2::front(const Poll& poll) const {
  std::vector<std::uint32_t> result;
  const std::vector<std::uint32_t> fronts = sort_fronts(values(), poll);
  for (std::uint32_t i = 0; i < fronts.size(); ++i)
    if (fronts[i] == 0) result.push_back(i);
  return result;
}

std::uint64_t Nsga2::work() const {
  const auto n = static_cast<std::uint64_t>(dimension_), m = static_cast<std::uint64_t>(objectives_);
  const auto size = static_cast<std::uint64_t>(population_);
  // Sorting compares each pair of survivors, and of twice as many, at most twice.
  return size * (n * 8 + size * m) / 2;
}

}  // namespace breve::learn
