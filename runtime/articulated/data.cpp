// Sizes the workspace of a model.
#include "runtime/articulated/data.hpp"

#include <algorithm>
#include <cstring>

namespace breve::articulated {

namespace {

BallMotors ball_motors_of(const Model& model, std::pmr::memory_resource* memory) {
  const auto is_ball = [](const Body& body) { return body.type == JointType::Ball; };
  const auto count = static_cast<std::size_t>(std::count_if(model.bodies().begin(), model.bodies().end(), is_ball));
  const Vector none = Vector::Zero(count > 0 ? model.velocities() : 0);
  BallMotors balls{none,
                   none,
                   none,
                   std::pmr::vector<int>(memory),
                   std::pmr::vector<double>(count * count, memory),
                   std::pmr::vector<double>(count, memory)};
  balls.at.reserve(count);
  return balls;
}

}  // namespace

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
      balls(ball_motors_of(model, memory)),
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
