// Sizes the workspace of a model.
#include "runtime/articulated/data.hpp"

#include <cstring>

namespace breve::articulated {

Data::Data(const Model& model, std::pmr::memory_resource* memory)
    : work(static_cast<std::size_t>(model.size()) + 1, memory),
      wide(static_cast<std::size_t>(model.wide_joints()) + 1, memory),
      motion(static_cast<std::size_t>(model.size()) + 1, memory),
      tau(Vector::Zero(model.velocities())),
      diagonal(Vector::Zero(model.velocities())),
      acceleration(Vector::Zero(model.velocities())),
      rest(neutral_state(model).q),
      deflection(Vector::Zero(model.velocities())),
      held(Vector::Zero(model.velocities())),
      at_limit(static_cast<std::size_t>(model.velocities()), memory),
      at_(neutral_state(model)) {}

bool Data::same_bits(const Vector& a, const Vector& b) {
  return a.size() == 0 || std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

void Data::stand_at(const State& state) {
  at_.q = state.q;
  at_.v = state.v;
  stands_ = true;
  ++standing_;
}

}  // namespace breve::articulated
