// Newton's method for the gains of all motors of ball joints that are at their limit, together.
#include "runtime/articulated/ball_motors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/articulated/data.hpp"
#include "runtime/articulated/impulse.hpp"

namespace breve::articulated {

namespace {

/// Notes in data.balls.direction the rest of the speed that a motor aims at, as the last solve leaves it.
/// @return  its size
double left_of(const Loads& loads, const State& state, double lag, int first, Data& data) {
  auto left = data.balls.direction.segment<3>(first);
  left = -state.v.segment<3>(first) - lag * data.acceleration.segment<3>(first);
  if (loads.motor_speed.size()) left += loads.motor_speed.segment<3>(first);
  return left.norm();
}

/// 1 N m too much or too little of so many is as good as it gets.
double unseen_force(const Loads& loads, const State& state, double lag, int first, double gain, const Data& data) {
  constexpr double kRoundOff = 16 * std::numeric_limits<double>::epsilon();
  double most = state.v.segment<3>(first).norm() + lag * data.acceleration.segment<3>(first).norm();
  if (loads.motor_speed.size()) most += loads.motor_speed.segment<3>(first).norm();
  return kRoundOff * gain * most;
}

/// Takes a motor not to be at its limit.
void leave_limit(int first, Data& data) {
  for (int k = first; k < first + 3; ++k) data.at_limit[static_cast<std::size_t>(k)] = 0;
}

}  // namespace

double error_of_ball_motors(const Model& model, const Loads& loads, const State& state, double lag, Data& data) {
  constexpr double kExact = 1e-13;  // of the limit
  BallMotors& balls = data.balls;
  balls.at.clear();
  double worst = 0;
  if (balls.gains.size() == 0) return worst;
  for_each_motor(model, loads, [&](const Drive& drive, int first, int count) {
    if (count == 1 || data.at_limit[static_cast<std::size_t>(first)] == 0) return;
    const double gain = balls.gains[first], left = left_of(loads, state, lag, first, data), force = gain * left;
    if (!(force > 0)) {
      leave_limit(first, data);
      worst = std::max(worst, 1.0);
      return;
    }
    const double most = kExact * drive.motor_limit + unseen_force(loads, state, lag, first, gain, data);
    const double beyond = force / drive.motor_limit - 1;
    if (!(std::abs(force - drive.motor_limit) <= most)) worst = std::max(worst, std::abs(beyond));
    balls.steps[balls.at.size()] = left * beyond;
    balls.direction.segment<3>(first) /= left;
    balls.at.push_back(first);
  });
  return worst;
}

void correct_ball_motors(const Model& model, const Loads& loads, const State& state, double lag, Data& data) {
  BallMotors& balls = data.balls;
  // How the rest of each answers what each other gives: symmetric and positive definite.
  const auto count = static_cast<Eigen::Index>(balls.at.size());
  Eigen::Map<Eigen::MatrixXd> responses(balls.responses.data(), count, count);
  Eigen::Map<Vector> steps(balls.steps.data(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const int from = balls.at[static_cast<std::size_t>(k)];
    balls.answer.setZero();
    balls.answer.segment<3>(from) = balls.direction.segment<3>(from);
    apply_inverse_mass(model, data, balls.answer, balls.answer);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int to = balls.at[static_cast<std::size_t>(i)];
      responses(i, k) = -lag * balls.direction.segment<3>(to).dot(balls.answer.segment<3>(to));
    }
    responses(k, k) += 1 / balls.gains[from];
  }
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(responses);
  const bool solved = factor.info() == Eigen::Success;
  if (solved) factor.solveInPlace(steps);

  // Not far beyond what the limit over the rest would be, which always comes nearer.
  constexpr double kBeyond = 4;
  Eigen::Index k = 0;
  for_each_motor(model, loads, [&](const Drive& drive, int first, int shared) {
    if (shared == 1 || data.at_limit[static_cast<std::size_t>(first)] == 0) return;
    auto gains = balls.gains.segment<3>(first);
    const double old = gains[0], force = old * left_of(loads, state, lag, first, data);
    const double part = force / drive.motor_limit;
    const double newton = solved ? 1 + steps[k] / force : part;
    const double yields = std::clamp(newton, std::min(1.0, part) / kBeyond, std::max(1.0, part) * kBeyond);
    ++k;
    gains.setConstant(old / yields);
    if (!(gains[0] < drive.motor_gain)) leave_limit(first, data);
  });
}

}  // namespace breve::articulated
