// Natives of NeuralNetwork: layers, parameters, running.
#include <cmath>

#include "steve/library/neural_resource.hpp"
#include "steve/library/number_lists.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using learn::Activation;
using learn::Layer;
using learn::LayerKind;

// --- layers ----------------------------------------------------------------------------------------------------------

void append(Machine& machine, Instance& self, LayerKind kind, std::int32_t neurons, Activation activation) {
  NeuralNetworkResource& resource = own_network(machine, self);
  learn::Network& network = resource.network;
  const std::uint64_t n = static_cast<std::uint64_t>(std::max(neurons, 0));
  machine.charge_for(network.parameters().size() + n * (static_cast<std::uint64_t>(network.outputs()) + n));
  network.add_layer(kind, neurons, activation);
  resource.optimizer.reset();
}

/// Weights of 1.5 and an output of 1 / (1 + exp(1.5 - sum)), as programs without training expect.
void add_layer(Machine& machine, Instance& self, std::int32_t neurons) {
  constexpr double kFirstWeight = 1.5;
  if (neurons < 1) {
    machine.print("add-layer: a layer of " + decimal(neurons) + " neurons is ignored; it needs 1 or more\n");
    return;
  }
  append(machine, self, LayerKind::FeedForward, neurons, Activation::Logistic);
  learn::Network& network = own_network(machine, self).network;
  const Layer& layer = network.layers().back();
  if (layer.inputs == 0) return;
  double* const first = network.parameters().data();
  std::fill(first + layer.weights, first + layer.biases, kFirstWeight);
  std::fill(first + layer.biases, first + network.parameters().size(), -kFirstWeight);
}

template <LayerKind Kind>
void add_layer_with(Machine& machine, Instance& self, std::int32_t neurons, StringCell* activation) {
  const std::optional<Activation> found = learn::activation_named(view(activation));
  if (!found)
    refuse_argument("there is no activation '" + std::string(view(activation)) +
                    "'; there are linear, logistic, tanh, relu, leaky-relu and softplus");
  append(machine, self, Kind, neurons, *found);
}

double checked_time_constant(double value, std::string_view what) {
  // The bounds keep the logarithm and its exponential finite, also after training has moved it.
  constexpr double kLeast = 1e-100, kMost = 1e100;
  if (!(value >= kLeast && value <= kMost))
    refuse_argument(std::string(what) + ": a time constant must be > 0 and finite");
  return value;
}

void add_continuous_layer(Machine& machine, Instance& self, std::int32_t neurons, StringCell* activation,
                          double time_constant) {
  checked_time_constant(time_constant, "add-continuous-time-layer");
  add_layer_with<LayerKind::ContinuousTime>(machine, self, neurons, activation);
  learn::Network& network = own_network(machine, self).network;
  const Layer& layer = network.layers().back();
  std::fill_n(network.parameters().data() + layer.time_constants, neurons, std::log(time_constant));
}

std::int32_t get_layer_count(Machine& machine, Instance& self) {
  return static_cast<std::int32_t>(own_network(machine, self).network.layers().size());
}

std::int32_t get_neuron_count(Machine& machine, Instance& self, std::int32_t layer) {
  const auto& layers = own_network(machine, self).network.layers();
  if (layer < 0 || static_cast<std::size_t>(layer) >= layers.size())
    refuse_argument("a network of " + decimal(static_cast<std::int64_t>(layers.size())) + " layers has no layer " +
                    decimal(layer));
  return static_cast<std::int32_t>(layers[static_cast<std::size_t>(layer)].neurons);
}

// --- parameters ------------------------------------------------------------------------------------------------------

/// A layer with weights.
const Layer& weighted_layer(const learn::Network& network, std::int32_t number) {
  const auto count = static_cast<std::int32_t>(network.layers().size());
  if (number < 1 || number >= count)
    refuse_argument("a network of " + decimal(count) + " layers has no weights on layer " + decimal(number));
  return network.layers()[static_cast<std::size_t>(number)];
}

std::size_t node_of(Eigen::Index count, std::int32_t node, std::int32_t layer) {
  if (node < 0 || node >= count)
    refuse_argument("node " + decimal(node) + " does not exist: layer " + decimal(layer) + " has " + decimal(count));
  return static_cast<std::size_t>(node);
}

enum class Parameter : std::uint8_t { Weight, Feedback, Bias, TimeConstant };

/// The parameter of a layer from one node to another; biases and time constants have only one, `to`.
template <Parameter P>
double& parameter_of(Machine& machine, Instance& self, std::int32_t number, std::int32_t from, std::int32_t to) {
  learn::Network& network = own_network(machine, self).network;
  const Layer& layer = weighted_layer(network, number);
  const std::size_t target = node_of(layer.neurons, to, number), rows = static_cast<std::size_t>(layer.neurons);
  std::size_t at = layer.biases + target;
  if constexpr (P == Parameter::Weight) at = layer.weights + node_of(layer.inputs, from, number - 1) * rows + target;
  if constexpr (P == Parameter::Feedback) {
    if (!layer.recurrent())
      refuse_argument("layer " + decimal(number) + " is not recurrent: it has no feedback weights");
    at = layer.feedback + node_of(layer.neurons, from, number) * rows + target;
  }
  if constexpr (P == Parameter::TimeConstant) {
    if (layer.kind != LayerKind::ContinuousTime)
      refuse_argument("layer " + decimal(number) + " is not one of continuous time: it has no time constants");
    at = layer.time_constants + target;
  }
  return network.parameters()[at];
}

template <Parameter P>
void set_between(Machine& machine, Instance& self, std::int32_t layer, std::int32_t from, std::int32_t to,
                 double value) {
  parameter_of<P>(machine, self, layer, from, to) = finite(value, "the weight");
}
template <Parameter P>
double get_between(Machine& machine, Instance& self, std::int32_t layer, std::int32_t from, std::int32_t to) {
  return parameter_of<P>(machine, self, layer, from, to);
}

void set_bias(Machine& machine, Instance& self, std::int32_t layer, std::int32_t node, double value) {
  parameter_of<Parameter::Bias>(machine, self, layer, 0, node) = finite(value, "set-bias: the bias");
}
double get_bias(Machine& machine, Instance& self, std::int32_t layer, std::int32_t node) {
  return parameter_of<Parameter::Bias>(machine, self, layer, 0, node);
}
void set_time_constant(Machine& machine, Instance& self, std::int32_t layer, std::int32_t node, double value) {
  parameter_of<Parameter::TimeConstant>(machine, self, layer, 0, node) =
      std::log(checked_time_constant(value, "set-time-constant"));
}
double get_time_constant(Machine& machine, Instance& self, std::int32_t layer, std::int32_t node) {
  return std::exp(parameter_of<Parameter::TimeConstant>(machine, self, layer, 0, node));
}

void set_time_step(Machine& machine, Instance& self, double step) {
  if (!std::isfinite(step) || step <= 0) refuse_argument("set-time-step: the step must be > 0 and finite");
  own_network(machine, self).network.set_time_step(step);
}
double get_time_step(Machine& machine, Instance& self) { return own_network(machine, self).network.time_step(); }

void randomize_weights(Machine& machine, Instance& self) {
  learn::Network& network = own_network(machine, self).network;
  machine.charge_for(kOfDraw * network.parameters().size());
  network.randomize(machine.world().random());
}

std::int32_t get_parameter_count(Machine& machine, Instance& self) {
  return static_cast<std::int32_t>(own_network(machine, self).network.parameters().size());
}

ListCell* get_parameters(Machine& machine, Instance& self) {
  const learn::Numbers& parameters = own_network(machine, self).network.parameters();
  return make_list(machine, parameters.data(), parameters.size());
}

void set_parameters(Machine& machine, Instance& self, ListCell* list) {
  learn::Network& network = own_network(machine, self).network;
  const ListCell& numbers = list_of(Value::of(Tag::List, list), "set-parameters: the argument");
  machine.charge_for(numbers.size);
  learn::Numbers read(machine.heap().memory(), network.parameters().size());
  read_numbers(numbers, read.size(), read.data(), "set-parameters: the list");
  network.parameters() = std::move(read);
}

void copy_from(Machine& machine, Instance& self, Instance* other) {
  const NeuralNetworkResource& source = neural_network_of(machine, other, "copy-from: the network");
  machine.charge_for(source.network.parameters().size());
  NeuralNetworkResource& target = own_network(machine, self);
  if (&source == &target) return;
  target.network.assign(source.network);
  target.optimizer.reset();
}

// --- running ---------------------------------------------------------------------------------------------------------

void run_with(Machine& machine, Instance& self, ListCell* list) {
  NeuralNetworkResource& resource = layered_network(machine, self, "run-with");
  const learn::Network& network = resource.network;
  const std::size_t given = list ? list->size : 0, expected = static_cast<std::size_t>(network.inputs());
  if (given != expected)
    refuse_argument("run-with: " + std::to_string(given) + " inputs for a first layer of " + std::to_string(expected));
  charge_for_network(machine, network.work());
  learn::Numbers inputs(machine.heap().memory(), expected);
  for (std::uint32_t i = 0; i < expected; ++i) inputs[i] = to_double((*list)[i], "run-with: an input");
  network.step(resource.present(), inputs.matrix(0, network.inputs(), 1));
}

/// Whether the activity fits each layer is looked at.
void charge_for_layers(Machine& machine, const NeuralNetworkResource& resource) {
  constexpr std::size_t kLayersPerElement = 8;
  machine.charge_for(resource.network.layers().size() / kLayersPerElement);
}

double get_output(Machine& machine, Instance& self, std::int32_t position) {
  NeuralNetworkResource& resource = layered_network(machine, self, "get-output");
  const auto count = static_cast<std::int32_t>(resource.network.outputs());
  if (position < 0 || position >= count)
    refuse_argument("get-output: node " + decimal(position) + " does not exist: the last layer has " + decimal(count));
  charge_for_layers(machine, resource);
  return resource.present().outputs.back()[static_cast<std::size_t>(position)];
}

ListCell* get_outputs(Machine& machine, Instance& self) {
  NeuralNetworkResource& resource = own_network(machine, self);
  if (resource.network.layers().empty()) return machine.heap().list();
  charge_for_layers(machine, resource);
  const learn::Numbers& outputs = resource.present().outputs.back();
  return make_list(machine, outputs.data(), outputs.size());
}

void reset_state(Machine& machine, Instance& self) {
  NeuralNetworkResource& resource = own_network(machine, self);
  std::uint64_t neurons = 0;
  for (const Layer& layer : resource.network.layers()) neurons += static_cast<std::uint64_t>(layer.neurons);
  machine.charge_for(resource.network.layers().size() + neurons);
  resource.network.rest(resource.activity, 1);
}

constexpr Native kNeuralNatives[] = {
    native<add_layer>("neural-network.add-layer"),
    native<add_layer_with<LayerKind::FeedForward>>("neural-network.add-feed-forward-layer"),
    native<add_layer_with<LayerKind::Elman>>("neural-network.add-elman-layer"),
    native<add_continuous_layer>("neural-network.add-continuous-time-layer"),
    native<get_layer_count>("neural-network.get-layer-count"),
    native<get_neuron_count>("neural-network.get-neuron-count"),
    native<set_between<Parameter::Weight>>("neural-network.set-weight"),
    native<get_between<Parameter::Weight>>("neural-network.get-weight"),
    native<set_between<Parameter::Feedback>>("neural-network.set-feedback-weight"),
    native<get_between<Parameter::Feedback>>("neural-network.get-feedback-weight"),
    native<set_bias>("neural-network.set-bias"),
    native<get_bias>("neural-network.get-bias"),
    native<set_time_constant>("neural-network.set-time-constant"),
    native<get_time_constant>("neural-network.get-time-constant"),
    native<set_time_step>("neural-network.set-time-step"),
    native<get_time_step>("neural-network.get-time-step"),
    native<randomize_weights>("neural-network.randomize-weights"),
    native<get_parameter_count>("neural-network.get-parameter-count"),
    native<get_parameters>("neural-network.get-parameters"),
    native<set_parameters>("neural-network.set-parameters"),
    native<copy_from>("neural-network.copy-from"),
    native<run_with>("neural-network.run-with"),
    native<get_output>("neural-network.get-output"),
    native<get_outputs>("neural-network.get-outputs"),
    native<reset_state>("neural-network.reset-state"),
};

}  // namespace

std::span<const Native> neural_natives() { return kNeuralNatives; }

}  // namespace breve::steve
