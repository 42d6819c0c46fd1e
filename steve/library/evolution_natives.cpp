// Natives of CMAEvolutionStrategy, and of the selection of a GeneticAlgorithm.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/learn/evolution/selection.hpp"
#include "steve/library/evolution_resource.hpp"
#include "steve/library/number_lists.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

learn::CmaEs& search_of(Machine& machine, Instance& self) { return resource_made<CmaEsResource>(machine, self).search; }

// --- CMA-ES ----------------------------------------------------------------------------------------------------------

void begin_search(Machine& machine, Instance& self, ListCell* mean, double step, std::int32_t population) {
  const ListCell& numbers = list_of(Value::of(Tag::List, mean), "begin: the mean");
  const std::uint64_t n = std::min<std::uint64_t>(numbers.size, learn::CmaEs::kMaxDimension);
  machine.charge_for(2 * n * n + n * static_cast<std::uint64_t>(std::max(population, 0)));
  std::pmr::vector<double> start(numbers.size, machine.heap().memory());
  read_numbers(numbers, start.size(), start.data(), "begin: the mean");
  search_of(machine, self).begin(start, step, population);
}

ListCell* ask_candidates(Machine& machine, Instance& self) {
  learn::CmaEs& search = search_of(machine, self);
  machine.charge(search.work() / 2);
  const std::span<const double> numbers = search.ask(machine.world().random(), machine.poller());
  const auto n = static_cast<std::size_t>(search.dimension());
  ListCell* const all = machine.heap().list();
  const Pin pin(machine, Value::of(Tag::List, all));
  for (std::size_t at = 0; at < numbers.size(); at += n)
    machine.heap().push(*all, Value::of(Tag::List, make_list(machine, numbers.data() + at, n)));
  return all;
}

void tell_values(Machine& machine, Instance& self, ListCell* values) {
  learn::CmaEs& search = search_of(machine, self);
  const ListCell& list = list_of(Value::of(Tag::List, values), "tell: the values");
  machine.charge(search.work());
  machine.charge_for(list.size);
  std::pmr::vector<double> numbers(machine.heap().memory());
  for (std::uint32_t i = 0; i < list.size; ++i) numbers.push_back(to_double(list[i], "tell: a value"));
  // The matrices of a decomposition are outside of the meter.
  constexpr std::size_t kMatrices = 3;
  const auto n = static_cast<std::size_t>(search.dimension());
  machine.heap().check_room(kMatrices * n * n * sizeof(double));
  search.tell(numbers, machine.poller());
}

ListCell* get_best(Machine& machine, Instance& self) {
  const std::span<const double> best = search_of(machine, self).best();
  return make_list(machine, best.data(), best.size());
}
ListCell* get_mean(Machine& machine, Instance& self) {
  const std::span<const double> mean = search_of(machine, self).mean();
  return make_list(machine, mean.data(), mean.size());
}
double get_best_value(Machine& machine, Instance& self) { return search_of(machine, self).best_value(); }
double get_step(Machine& machine, Instance& self) { return search_of(machine, self).step(); }
std::int32_t get_population(Machine& machine, Instance& self) { return search_of(machine, self).population(); }
double get_evaluations(Machine& machine, Instance& self) {
  return static_cast<double>(search_of(machine, self).evaluations());
}

// --- selection -------------------------------------------------------------------------------------------------------

/// The probability of each individual by linear ranking, or in proportion to its fitness.
ListCell* selection_shares(Machine& machine, Instance&, ListCell* fitness, std::int32_t by_rank, double pressure) {
  constexpr std::uint64_t kOfSorting = 32;
  const ListCell& list = list_of(Value::of(Tag::List, fitness), "selection: the fitness");
  machine.charge_for(kOfSorting * list.size);
  std::pmr::vector<double> values(list.size, machine.heap().memory()), shares(list.size, machine.heap().memory());
  // A fitness that is not a finite number counts as the least, or the most, that there may be.
  for (std::uint32_t i = 0; i < list.size; ++i) {
    const double value = to_double(list[i], "selection: a fitness");
    constexpr double kMost = std::numeric_limits<double>::max();
    values[i] = std::isnan(value) ? -kMost : std::clamp(value, -kMost, kMost);
  }
  machine.heap().check_room(2 * list.size * sizeof(std::size_t));  // of sorting, which is outside of the meter
  if (by_rank != 0)
    learn::rank_probabilities(values, pressure, shares);
  else
    learn::proportional_probabilities(values, shares);
  return make_list(machine, shares.data(), shares.size());
}

std::int32_t draw_share(Machine& machine, Instance&, ListCell* shares) {
  const ListCell& list = list_of(Value::of(Tag::List, shares), "selection: the shares");
  machine.charge_for(list.size);
  std::pmr::vector<double> values(list.size, machine.heap().memory());
  read_numbers(list, values.size(), values.data(), "selection: the shares");
  return static_cast<std::int32_t>(learn::draw_index(values, machine.world().random()));
}

constexpr Native kEvolutionNatives[] = {
    native<begin_search>("cma-es.begin"),
    native<ask_candidates>("cma-es.ask"),
    native<tell_values>("cma-es.tell"),
    native<get_best>("cma-es.get-best"),
    native<get_mean>("cma-es.get-mean"),
    native<get_best_value>("cma-es.get-best-value"),
    native<get_step>("cma-es.get-step"),
    native<get_population>("cma-es.get-population-size"),
    native<get_evaluations>("cma-es.get-evaluations"),
    native<selection_shares>("genetic-algorithm.selection-shares"),
    native<draw_share>("genetic-algorithm.draw-share"),
};

}  // namespace

std::span<const Native> evolution_natives() { return kEvolutionNatives; }

}  // namespace breve::steve
