// Natives of CMAEvolutionStrategy, MultiObjectiveSearch, and of the selection and variation of a GeneticAlgorithm.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/learn/evolution/pareto.hpp"
#include "runtime/learn/evolution/selection.hpp"
#include "runtime/learn/evolution/variation.hpp"
#include "steve/library/evolution_resource.hpp"
#include "steve/library/number_lists.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

learn::CmaEs& search_of(Machine& machine, Instance& self) { return resource_made<CmaEsResource>(machine, self).search; }

/// The candidates that a search asks to be judged, as a list of lists.
template <class Search>
ListCell* list_candidates(Machine& machine, Search& search) {
  machine.charge(search.work() / 2);
  const std::span<const double> numbers = search.ask(machine.world().random(), machine.poller());
  const auto n = static_cast<std::size_t>(search.dimension());
  ListCell* const all = machine.heap().list();
  const Pin pin(machine, Value::of(Tag::List, all));
  for (std::size_t at = 0; at < numbers.size(); at += n)
    machine.heap().push(*all, Value::of(Tag::List, make_list(machine, numbers.data() + at, n)));
  return all;
}

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
  return list_candidates(machine, search_of(machine, self));
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

// --- NSGA-II ---------------------------------------------------------------------------------------------------------

/// Is there memory to sort so many individuals? It is outside of the meter: their fronts, how many dominate each of
/// them, their distances and their order, with what sorting takes for itself.
void need_room_to_sort(Machine& machine, std::size_t individuals) {
  constexpr std::size_t kOfIndividual = 4 * sizeof(std::uint32_t) + 2 * sizeof(double);
  machine.heap().check_room(kOfIndividual * individuals);
}

learn::Nsga2& pareto_search_of(Machine& machine, Instance& self) {
  return resource_made<Nsga2Resource>(machine, self).search;
}

void begin_pareto(Machine& machine, Instance& self, ListCell* lowest, ListCell* highest, std::int32_t objectives,
                  std::int32_t population) {
  const ListCell& low = list_of(Value::of(Tag::List, lowest), "begin: the lowest numbers");
  const ListCell& high = list_of(Value::of(Tag::List, highest), "begin: the highest numbers");
  machine.charge_for(std::uint64_t{low.size} * static_cast<std::uint64_t>(std::max(population, 1)) + high.size);
  std::pmr::vector<double> from(low.size, machine.heap().memory()), to(high.size, machine.heap().memory());
  read_numbers(low, from.size(), from.data(), "begin: the lowest numbers");
  read_numbers(high, to.size(), to.data(), "begin: the highest numbers");
  pareto_search_of(machine, self).begin(from, to, objectives, population);
}

void set_pareto_crossover(Machine& machine, Instance& self, double probability, double index) {
  pareto_search_of(machine, self).set_crossover(probability, index);
}

void set_pareto_mutation(Machine& machine, Instance& self, double probability, double index) {
  pareto_search_of(machine, self).set_mutation(probability, index);
}

ListCell* ask_pareto(Machine& machine, Instance& self) {
  need_room_to_sort(machine, static_cast<std::size_t>(pareto_search_of(machine, self).population()));
  return list_candidates(machine, pareto_search_of(machine, self));
}

/// The numbers of a list of lists, each of `length`.
std::pmr::vector<double> read_rows(Machine& machine, const ListCell& rows, std::size_t length,
                                   const std::string& what) {
  machine.charge_for(rows.size * std::uint64_t{length});
  std::pmr::vector<double> numbers(machine.heap().memory());
  for (std::uint32_t i = 0; i < rows.size; ++i) {
    const ListCell& row = list_of(rows[i], what + " " + decimal(i));
    if (row.size != length)
      refuse_argument(what + " " + decimal(i) + " has " + decimal(row.size) + " values (must be " +
                      decimal(static_cast<std::int64_t>(length)) + ")");
    for (std::uint32_t k = 0; k < row.size; ++k) numbers.push_back(to_double(row[k], what));
  }
  return numbers;
}

void tell_pareto(Machine& machine, Instance& self, ListCell* values) {
  learn::Nsga2& search = pareto_search_of(machine, self);
  const ListCell& rows = list_of(Value::of(Tag::List, values), "tell: the values");
  machine.charge(search.work());
  const auto objectives = static_cast<std::size_t>(search.objectives());
  need_room_to_sort(machine, 2 * static_cast<std::size_t>(search.population()) * (1 + objectives));
  search.tell(read_rows(machine, rows, objectives, "tell: candidate"), machine.poller());
}

/// What `row_of` gives of each survivor that none dominates, as a list of lists.
ListCell* list_front(Machine& machine, Instance& self,
                     std::span<const double> (learn::Nsga2::*row_of)(std::size_t) const) {
  const learn::Nsga2& search = pareto_search_of(machine, self);
  machine.charge(search.work() / 2);
  need_room_to_sort(machine, static_cast<std::size_t>(search.population()));
  ListCell* const all = machine.heap().list();
  const Pin pin(machine, Value::of(Tag::List, all));
  for (const std::uint32_t at : search.front(machine.poller())) {
    const std::span<const double> row = (search.*row_of)(at);
    machine.heap().push(*all, Value::of(Tag::List, make_list(machine, row.data(), row.size())));
  }
  return all;
}
ListCell* get_front(Machine& machine, Instance& self) { return list_front(machine, self, &learn::Nsga2::survivor); }
ListCell* get_front_values(Machine& machine, Instance& self) {
  return list_front(machine, self, &learn::Nsga2::survivor_values);
}
std::int32_t get_pareto_population(Machine& machine, Instance& self) {
  return pareto_search_of(machine, self).population();
}
double get_pareto_evaluations(Machine& machine, Instance& self) {
  return static_cast<double>(pareto_search_of(machine, self).evaluations());
}

/// Of individuals with several values of fitness, which are maximised: the indices, the preferred ones first, the front
/// and the crowding distance of each.
ListCell* pareto_order(Machine& machine, Instance&, ListCell* fitness) {
  const ListCell& rows = list_of(Value::of(Tag::List, fitness), "selection: the fitness values");
  const std::size_t objectives = rows.size == 0 ? 0 : list_of(rows[0], "selection: the fitness values of 0").size;
  std::pmr::vector<double> values = read_rows(machine, rows, objectives, "selection: individual");
  if (rows.size != 0 && objectives == 0) refuse_argument("selection: an individual has no fitness values");
  for (double& value : values) value = std::isnan(value) ? learn::comparable(value) : learn::comparable(-value);
  constexpr std::uint64_t kOfOrder = 8;  // loop iterations: of the order of a few
  machine.charge(kOfOrder);
  machine.charge_for(std::uint64_t{rows.size} * values.size());
  need_room_to_sort(machine, rows.size);
  const learn::CrowdedOrder order({values, objectives}, machine.poller());
  ListCell* const result = machine.heap().list();
  const Pin pin(machine, Value::of(Tag::List, result));
  const auto push = [&](const std::vector<double>& numbers) {
    machine.heap().push(*result, Value::of(Tag::List, make_list(machine, numbers.data(), numbers.size())));
  };
  const std::vector<std::uint32_t> sorted = order.sorted();
  push({sorted.begin(), sorted.end()});
  push({order.fronts.begin(), order.fronts.end()});
  push(order.distances);
  return result;
}

// --- variation of reals ----------------------------------------------------------------------------------------------

/// A range for each of some numbers, and the numbers, which are brought into it.
struct Ranged {
  std::pmr::vector<double> lowest, highest;
  Ranged(Machine& machine, std::size_t size, double low, double high)
      : lowest(size, low, machine.heap().memory()), highest(size, high, machine.heap().memory()) {}
  learn::Box box() const { return {lowest, highest}; }
  std::pmr::vector<double> read(Machine& machine, const ListCell& list) const {
    constexpr std::uint64_t kOfVariation = 2;  // iterations
    machine.charge(kOfVariation);
    machine.charge_for(list.size);
    std::pmr::vector<double> numbers(lowest.size(), machine.heap().memory());
    read_numbers(list, numbers.size(), numbers.data(), "variation: the genes");
    for (double& number : numbers) number = std::clamp(number, lowest[0], highest[0]);
    return numbers;
  }
};

ListCell* mutate_in_range(Machine& machine, Instance&, ListCell* genes, double low, double high, double index) {
  const ListCell& list = list_of(Value::of(Tag::List, genes), "variation: the genes");
  if (list.size == 0) return machine.heap().list();
  const Ranged range(machine, list.size, low, high);
  std::pmr::vector<double> numbers = range.read(machine, list);
  learn::polynomial_mutation(numbers, range.box(), 1.0 / list.size, index, machine.world().random());
  return make_list(machine, numbers.data(), numbers.size());
}

/// One of the two children.
ListCell* cross_in_range(Machine& machine, Instance&, ListCell* first, ListCell* second, double low, double high,
                         double index) {
  const ListCell& one = list_of(Value::of(Tag::List, first), "variation: the genes");
  const ListCell& other = list_of(Value::of(Tag::List, second), "variation: the genes");
  if (one.size == 0) return machine.heap().list();
  const Ranged range(machine, one.size, low, high);
  std::pmr::vector<double> a = range.read(machine, one), b = range.read(machine, other);
  Random& random = machine.world().random();
  learn::simulated_binary_crossover(a, b, range.box(), index, random);
  const std::pmr::vector<double>& child = random.below(2) == 0 ? a : b;
  return make_list(machine, child.data(), child.size());
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
    native<pareto_order>("genetic-algorithm.pareto-order"),
    native<mutate_in_range>("real-vector.mutate-in-range"),
    native<cross_in_range>("real-vector.cross-in-range"),
    native<begin_pareto>("multi-objective-search.begin"),
    native<set_pareto_crossover>("multi-objective-search.set-crossover"),
    native<set_pareto_mutation>("multi-objective-search.set-mutation"),
    native<ask_pareto>("multi-objective-search.ask"),
    native<tell_pareto>("multi-objective-search.tell"),
    native<get_front>("multi-objective-search.get-front"),
    native<get_front_values>("multi-objective-search.get-front-values"),
    native<get_pareto_population>("multi-objective-search.get-population-size"),
    native<get_pareto_evaluations>("multi-objective-search.get-evaluations"),
};

}  // namespace

std::span<const Native> evolution_natives() { return kEvolutionNatives; }

}  // namespace breve::steve
