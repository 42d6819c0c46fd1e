// Hands integrators' questions to the articulated-body algorithm and to steps on joint coordinates.
#include "runtime/articulated/tree_system.hpp"

#include "runtime/articulated/forward_dynamics.hpp"

namespace breve::articulated {

TreeSystem::TreeSystem(const Model& model, std::pmr::memory_resource* memory)
    : model_(model), data_(model, memory), state_(neutral_state(model)) {
  for (const Body& body : model.bodies())
    for (int k = 0; k < velocity_count(body.type); ++k)
      kinds_.push_back(is_length(body.type, k) ? Kind::Length : Kind::Angle);
}

void TreeSystem::acceleration(double t, const Vector& q, const Vector& v, double step, Vector& a) {
  state_.q = q;
  state_.v = v;
  if (update_loads) update_loads(t, state_, loads);
  a = forward_dynamics(model_, data_, state_, loads, step);
}

void TreeSystem::move(const Vector& q, const Vector& d, Vector& out) { articulated::move(model_, q, d, out); }

void TreeSystem::rate_of_move(const Vector& d, const Vector& v, Vector& out) {
  articulated::rate_of_move(model_, d, v, out);
}

void TreeSystem::bend_to_cayley(Vector& d) { articulated::bend_to_cayley(model_, d); }

}  // namespace breve::articulated
