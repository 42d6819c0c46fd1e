// Neural networks in snapshots and hashes.
#include "steve/library/neural_resource.hpp"

#include "runtime/learn/network/numbers_image.hpp"

namespace breve::steve {

void NeuralNetworkResource::save(ByteWriter& out) const {
  network.save(out);
  optimizer.save(out);
  out.put(batch);
  const bool fits = activity.samples == 1 && network.fits(activity);
  out.put(fits);
  if (!fits) return;
  for (const learn::Numbers& outputs : activity.outputs) learn::put_numbers(out, outputs);
  for (const learn::Numbers& potentials : activity.potentials) learn::put_numbers(out, potentials);
}

void NeuralNetworkResource::hash(Hasher& hasher) const {
  network.hash(hasher);
  optimizer.hash(hasher);
  hasher.add(static_cast<std::uint64_t>(batch));
  if (activity.samples != 1 || !network.fits(activity)) return;
  for (const learn::Numbers& outputs : activity.outputs) learn::hash_numbers(hasher, outputs);
  for (const learn::Numbers& potentials : activity.potentials) learn::hash_numbers(hasher, potentials);
}

std::unique_ptr<Resource> NeuralNetworkResource::load(ByteReader& in) {
  auto resource = make_in<NeuralNetworkResource>(in.memory(), in.memory());
  resource->network.load(in);
  resource->optimizer.load(in, resource->network.parameters().size());
  resource->batch = in.get<std::int32_t>();
  if (resource->batch < 0) ByteReader::fail();
  if (!in.get_bool()) return resource;
  resource->network.rest(resource->activity, 1);
  for (std::pmr::vector<learn::Numbers>* all : {&resource->activity.outputs, &resource->activity.potentials})
    for (learn::Numbers& numbers : *all) learn::get_numbers(in, numbers);
  if (!resource->network.fits(resource->activity)) ByteReader::fail();
  return resource;
}

NeuralNetworkResource& neural_network_of(Machine& machine, Instance* object, std::string_view what) {
  Instance& live = must_live(object, what);
  if (!is_of_class(live, "NeuralNetwork"))
    Machine::fail(RunErrorKind::Type, std::string(what) + ": " + name_of(live) + " is not a NeuralNetwork");
  return own_network(machine, live);
}

NeuralNetworkResource& layered_network(Machine& machine, Instance& self, std::string_view what) {
  NeuralNetworkResource& resource = own_network(machine, self);
  if (resource.network.layers().empty())
    throw Error(ErrorCode::Argument, std::string(what) + ": the network has no layers; call add-layer first");
  return resource;
}

}  // namespace breve::steve
