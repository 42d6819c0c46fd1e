// Networks in images and hashes. An image may come from anywhere: layers are built again from their sizes, with every
// check that add_layer makes, before their parameters are read.
#include <cmath>

#include "runtime/learn/network/network.hpp"
#include "runtime/learn/network/numbers_image.hpp"

namespace breve::learn {

void Network::save(ByteWriter& out) const {
  out.put(static_cast<std::uint64_t>(layers_.size()));
  for (const Layer& layer : layers_) {
    out.put(layer.kind);
    out.put(layer.activation);
    out.put(static_cast<std::uint32_t>(layer.neurons));
  }
  out.put(time_step_);
  put_numbers(out, parameters_);
}

void Network::load(ByteReader& in) {
  constexpr std::size_t kLayerBytes = 6;
  layers_.clear();
  parameters_.resize(0);
  neurons_ = 0;
  std::size_t parameters = 0, before = 0;
  for (std::size_t left = in.get_count(kLayerBytes); left > 0; --left) {
    const auto kind = in.get<std::uint8_t>(), activation = in.get<std::uint8_t>();
    const std::size_t neurons = in.get<std::uint32_t>();
    const bool recurrent = kind != static_cast<std::uint8_t>(LayerKind::FeedForward);
    if (kind >= kLayerKinds || activation >= kActivations || neurons < 1 || neurons > kMaxNeurons ||
        layers_.size() >= kMaxLayers || (before == 0 && recurrent))
      ByteReader::fail();
    if (before > 0) parameters += neurons * (before + 1 + (recurrent ? neurons : 0) + (kind == 2 ? 1 : 0));
    if (parameters > kMaxParameters || parameters > in.left() / sizeof(double)) ByteReader::fail();
    add_layer(static_cast<LayerKind>(kind), static_cast<Eigen::Index>(neurons), static_cast<Activation>(activation));
    before = neurons;
  }
  time_step_ = in.get<double>();
  if (!std::isfinite(time_step_) || time_step_ <= 0) ByteReader::fail();
  const std::size_t expected = parameters_.size();
  get_numbers(in, parameters_);
  if (parameters_.size() != expected || !all_finite(parameters_)) ByteReader::fail();
}

void Network::hash(Hasher& hasher) const {
  for (const Layer& layer : layers_) {
    hasher.add(static_cast<std::uint64_t>(layer.kind));
    hasher.add(static_cast<std::uint64_t>(layer.activation));
    hasher.add(static_cast<std::uint64_t>(layer.neurons));
  }
  hasher.add(time_step_);
  hash_numbers(hasher, parameters_);
}

}  // namespace breve::learn
