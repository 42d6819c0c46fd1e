// Natives that yield a vector and are called for every neighbour of every agent: the result is written word by word, as
// it will be read. A copy of the whole value would be read in wider pieces than it was written, and wait for the cache.
#pragma once

#include <bit>

#include "steve/machine/native.hpp"

namespace breve::steve {

namespace detail {

template <auto F, class... A>
void call_for_vector(Machine& machine, Instance& self, const Slot* args, Value& result) {
  const Vector3 v = Binder<F, Vector3, A...>::apply(machine, self, args, std::index_sequence_for<A...>());
  result.head = Value::head_of(Tag::Vector);
  for (int i = 0; i < 3; ++i) result.bits[i] = std::bit_cast<std::uint64_t>(v[i]);
}

template <auto F, class... A>
constexpr Native bind_vector(std::string_view name, Vector3 (*f)(Machine&, Instance&, A...)) {
  return {name, &call_for_vector<F, A...>, bind<F>(name, Reach::World, f).signature, Reach::World};
}

}  // namespace detail

/// As native<F>, for a function that returns a Vector3.
template <auto F>
constexpr Native vector_native(std::string_view name) {
  return detail::bind_vector<F>(name, F);
}

}  // namespace breve::steve
