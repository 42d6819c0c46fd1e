// The native data behind NeuralNetwork objects.
#pragma once

#include "runtime/learn/network/network.hpp"
#include "runtime/learn/network/optimizer.hpp"
#include "runtime/world/resource.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

/// A NeuralNetwork object: the network, its present activity, and how it is trained.
class NeuralNetworkResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "neural-network";
  explicit NeuralNetworkResource(std::pmr::memory_resource* memory)
      : network(memory), activity(memory), optimizer(memory) {}
  learn::Network network;
  learn::Activity activity;  // of one sample; made anew where it does not fit the layers
  learn::Optimizer optimizer;
  std::int32_t batch = 0;  // samples an update; 0: all

  /// The activity, at rest if the layers have changed.
  learn::Activity& present() {
    if (activity.samples != 1 || !network.fits(activity)) network.rest(activity, 1);
    return activity;
  }

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

inline NeuralNetworkResource& own_network(Machine& machine, Instance& self) {
  return resource_made<NeuralNetworkResource>(machine, self);
}

/// The network of an object argument. @throws RunError{NullObject, FreedObject, Type}
NeuralNetworkResource& neural_network_of(Machine& machine, Instance* object, std::string_view what);

/// The same of a network with layers. @throws Error{Argument} if it has none
NeuralNetworkResource& layered_network(Machine& machine, Instance& self, std::string_view what);

/// What the draw of a random number takes, in elements of charge_for.
constexpr std::uint64_t kOfDraw = 16;

/// Count so many multiplications and activations of neurons as work.
inline void charge_for_network(Machine& machine, std::uint64_t multiplications) {
  constexpr std::uint64_t kPerIteration = 32;
  machine.charge(1 + multiplications / kPerIteration);
}

}  // namespace breve::steve
