// Natives of NeuralNetwork: batches, training, operators of evolution.
#include <algorithm>
#include <cmath>

#include "runtime/learn/network/training.hpp"
#include "steve/library/neural_resource.hpp"
#include "steve/library/number_lists.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using learn::Numbers;
using learn::Samples;

// --- samples ---------------------------------------------------------------------------------------------------------

/// Is this sample a sequence, a list of lists?
bool is_sequence(const Value& sample) {
  return sample.tag == Tag::List && sample.list() && sample.list()->size > 0 && (*sample.list())[0].tag == Tag::List;
}

/// Reads a list of samples, each a list of `width` numbers, or a list of such lists: a sequence. All have as many
/// steps.
/// @param steps  of each sample; 0: whatever the first has, which is stored
void read_samples(Machine& machine, ListCell* list, Eigen::Index width, Numbers& numbers, Eigen::Index& steps,
                  std::string_view what) {
  const ListCell& all = list_of(Value::of(Tag::List, list), what);
  if (all.size == 0) refuse_argument(std::string(what) + " is empty");
  const bool sequences = is_sequence(all[0]);
  if (steps == 0) steps = sequences ? static_cast<Eigen::Index>(all[0].list()->size) : 1;
  const auto size = static_cast<std::uint64_t>(width * steps);
  machine.charge_for(size);
  const std::string one = std::string(what) + ": a sample";
  // Sample by sample: a list may hold the same sample many times, and each is charged before it takes memory.
  for (std::uint32_t s = 0; s < all.size; ++s) {
    list_of(all[s], one);
    machine.charge_for(size);
  }
  numbers.assign_zeros(size * all.size, [&machine] { machine.poll(); });
  double* next = numbers.data();
  for (std::uint32_t s = 0; s < all.size; ++s) {
    const ListCell& sample = list_of(all[s], one);
    const std::size_t rows = sequences ? sample.size : 1;
    if (rows != static_cast<std::size_t>(steps))
      refuse_argument(one + " has " + std::to_string(rows) + " steps (must be " + std::to_string(steps) +
                      ", as the others)");
    for (std::uint32_t step = 0; step < rows; ++step, next += width)
      read_numbers(sequences ? list_of(sample[step], one) : sample, static_cast<std::size_t>(width), next, one);
    machine.poll();
  }
}

Samples inputs_of(Machine& machine, const learn::Network& network, ListCell* inputs, std::string_view what) {
  Samples samples(machine.heap().memory());
  samples.steps = 0;
  read_samples(machine, inputs, network.inputs(), samples.inputs, samples.steps, std::string(what) + ": the inputs");
  samples.count = static_cast<Eigen::Index>(inputs->size);
  return samples;
}

Samples samples_of(Machine& machine, const learn::Network& network, ListCell* inputs, ListCell* targets,
                   std::string_view what) {
  Samples samples = inputs_of(machine, network, inputs, what);
  if (!targets || targets->size != inputs->size)
    refuse_argument(std::string(what) + ": " + std::to_string(inputs->size) + " inputs have " +
                    std::to_string(targets ? targets->size : 0) + " targets (must be as many)");
  read_samples(machine, targets, network.outputs(), samples.targets, samples.steps,
               std::string(what) + ": the targets");
  return samples;
}

// --- batches ---------------------------------------------------------------------------------------------------------

ListCell* run_batch(Machine& machine, Instance& self, ListCell* inputs) {
  const learn::Network& network = layered_network(machine, self, "run-batch").network;
  const Samples samples = inputs_of(machine, network, inputs, "run-batch");
  const bool sequences = is_sequence((*inputs)[0]);
  charge_for_network(machine, learn::evaluation_work(network, samples));
  Numbers outputs(machine.heap().memory());
  learn::evaluate(network, samples, outputs, machine.poller());
  Heap& heap = machine.heap();
  ListCell* const all = heap.list();
  const Pin pin(machine, Value::of(Tag::List, all));
  const auto width = static_cast<std::size_t>(network.outputs());
  const double* next = outputs.data();
  for (Eigen::Index s = 0; s < samples.count; ++s) {
    ListCell* const sample = sequences ? heap.list() : all;
    if (sequences) heap.push(*all, Value::of(Tag::List, sample));
    for (Eigen::Index step = 0; step < samples.steps; ++step, next += width)
      heap.push(*sample, Value::of(Tag::List, make_list(machine, next, width)));
  }
  return all;
}

// --- training --------------------------------------------------------------------------------------------------------

void set_optimizer(Machine& machine, Instance& self, StringCell* name, double rate, double momentum) {
  const auto kind = learn::optimizer_named(view(name));
  if (!kind)
    refuse_argument("set-optimizer: there is no optimizer '" + std::string(view(name)) +
                    "'; there are gradient-descent, momentum and adam");
  if (!std::isfinite(rate) || rate <= 0) refuse_argument("set-optimizer: the learning rate must be > 0 and finite");
  if (!(momentum >= 0 && momentum < 1)) refuse_argument("set-optimizer: the momentum must be from 0 to less than 1");
  learn::Optimizer& optimizer = own_network(machine, self).optimizer;
  optimizer.set_kind(*kind);
  optimizer.rate = rate;
  optimizer.momentum = momentum;
}

void set_gradient_limit(Machine& machine, Instance& self, double limit) {
  if (!(limit >= 0)) refuse_argument("set-gradient-limit: the limit must be 0 or more");
  own_network(machine, self).optimizer.gradient_limit = finite(limit, "set-gradient-limit: the limit");
}

void set_batch_size(Machine& machine, Instance& self, std::int32_t size) {
  if (size < 0) refuse_argument("set-batch-size: " + std::to_string(size) + " samples (must be 0 or more)");
  own_network(machine, self).batch = size;
}

double train(Machine& machine, Instance& self, ListCell* inputs, ListCell* targets, std::int32_t epochs) {
  NeuralNetworkResource& resource = layered_network(machine, self, "train");
  if (epochs < 0) refuse_argument("train: " + std::to_string(epochs) + " epochs (must be 0 or more)");
  const Samples samples = samples_of(machine, resource.network, inputs, targets, "train");
  learn::Gradient gradient(machine.heap().memory());
  double error = 0;
  // An epoch at a time, so that a budget that is used up ends the work and keeps what was learned.
  for (std::int32_t epoch = 0; epoch < epochs; ++epoch) {
    charge_for_network(machine, learn::gradient_work(resource.network, samples) +
                                    resource.network.parameters().size() * learn::updates_of(samples, resource.batch));
    error = learn::train_epoch(resource.network, samples, resource.optimizer, gradient, resource.batch,
                               machine.world().random(), machine.poller());
  }
  return error;
}

double get_error(Machine& machine, Instance& self, ListCell* inputs, ListCell* targets) {
  const learn::Network& network = layered_network(machine, self, "get-error").network;
  const Samples samples = samples_of(machine, network, inputs, targets, "get-error");
  charge_for_network(machine, learn::evaluation_work(network, samples));
  return learn::error_of(network, samples, machine.poller());
}

// --- evolution -------------------------------------------------------------------------------------------------------

constexpr std::size_t kBetweenPolls = 1 << 16;  // draws: some 3 ms

void mutate(Machine& machine, Instance& self, double deviation, double probability) {
  Numbers& parameters = own_network(machine, self).network.parameters();
  finite(deviation, "mutate-weights: the deviation");
  if (!(probability >= 0 && probability <= 1)) refuse_argument("mutate-weights: the probability must be from 0 to 1");
  machine.charge_for(kOfDraw * parameters.size());
  Random& random = machine.world().random();
  std::size_t seen = 0;
  for (double& parameter : parameters) {
    if (++seen % kBetweenPolls == 0) machine.poll();
    if (random.uniform() >= probability && probability < 1) continue;
    const double moved = parameter + deviation * random.gauss();
    if (std::isfinite(moved)) parameter = moved;
  }
}

void crossover(Machine& machine, Instance& self, Instance* first, Instance* second) {
  const learn::Network& a = neural_network_of(machine, first, "crossover-weights: the first parent").network;
  const learn::Network& b = neural_network_of(machine, second, "crossover-weights: the second parent").network;
  learn::Network& child = own_network(machine, self).network;
  if (!a.same_shape(b)) refuse_argument("crossover-weights: the parents have different layers");
  machine.charge_for(kOfDraw * a.parameters().size());
  Numbers mixed(machine.heap().memory(), a.parameters().size());
  Random& random = machine.world().random();
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    if (i % kBetweenPolls == 0) machine.poll();
    mixed[i] = random.below(2) == 0 ? a.parameters()[i] : b.parameters()[i];
  }
  if (!child.same_shape(a)) child.assign(a);
  child.parameters() = std::move(mixed);
  own_network(machine, self).optimizer.reset();
}

constexpr Native kNeuralTrainingNatives[] = {
    native<run_batch>("neural-network.run-batch"),
    native<set_optimizer>("neural-network.set-optimizer"),
    native<set_gradient_limit>("neural-network.set-gradient-limit"),
    native<set_batch_size>("neural-network.set-batch-size"),
    native<train>("neural-network.train"),
    native<get_error>("neural-network.get-error"),
    native<mutate>("neural-network.mutate-weights"),
    native<crossover>("neural-network.crossover-weights"),
};

}  // namespace

std::span<const Native> neural_training_natives() { return kNeuralTrainingNatives; }

}  // namespace breve::steve
