// The steps towards the centre of what is left, ever nearer to the edge, in velocities: I + R D J as for Newton's.
#include "runtime/contact/interior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/contact/direct.hpp"

namespace breve::contact {

namespace {

constexpr int kMostSteps = 30;
constexpr int kPatience = 8;            // steps without a better iterate
constexpr double kNearest = 0.93;       // of the way to the edge of a cone
constexpr double kFollowed = 0.9;       // of how mu |u_t| changes in a step: all of it goes round in circles at times
constexpr double kSlippery = 1e-9;      // a smaller coefficient of friction counts as 0 here
constexpr double kSoftEquation = 1e-9;  // of a row's own response: how much an unbounded row gives in one step

enum class Kind { Idle, Slippery, Cone };

Kind kind_of(const Point& c) {
  if (!(c.response.nn > 0)) return Kind::Idle;
  return c.friction > kSlippery && tangential_response(c) > 0 ? Kind::Cone : Kind::Slippery;
}

bool bounded(double limit) { return std::abs(limit) < 1e100; }

double determinant(const double x[3]) {
  const double across = std::sqrt(x[1] * x[1] + x[2] * x[2]);
  return (x[0] - across) * (x[0] + across);
}

/// The determinant of a point that is inside the cone except for round-off.
double inner_determinant(const double x[3]) {
  constexpr double kRoundOff = 1e-15;
  return std::max(determinant(x), kRoundOff * x[0] * x[0]);
}

/// The speed of sliding, and how it follows the velocities along the tangents.
struct Lift {
  double speed, d1 = 0, d2 = 0;
  explicit Lift(const double u[3]) : speed(std::sqrt(u[1] * u[1] + u[2] * u[2])) {
    if (!(speed > 0)) return;
    d1 = kFollowed * u[1] / speed;
    d2 = kFollowed * u[2] / speed;
  }
};

void shorten(double& length, double x, double dx) {
  if (dx < 0) length = std::min(length, -x / dx);
}

/// How far x + length dx stays in the second-order cone.
void shorten(double& length, const double x[3], const double dx[3]) {
  const double a = determinant(dx), b = x[0] * dx[0] - x[1] * dx[1] - x[2] * dx[2], c = determinant(x);
  const double root = std::sqrt(std::max(b * b - a * c, 0.0));
  if (a < 0)
    length = std::min(length, (-b - root) / a);
  else if (b < 0 && b * b >= a * c)
    length = std::min(length, c / (-b + root));
  shorten(length, x[0], dx[0]);
}

/// G with G y = x, symmetric and positive: Nesterov and Todd's scaling.
void scaling(const double x[3], const double y[3], double G[3][3]) {
  const double sx = std::sqrt(inner_determinant(x)), sy = std::sqrt(inner_determinant(y));
  double dot = 0, w[3];
  for (int k = 0; k < 3; ++k) dot += x[k] / sx * (y[k] / sy);
  const double half = 0.5 / std::sqrt(0.5 * (1 + dot));
  for (int k = 0; k < 3; ++k) w[k] = half * (x[k] / sx + (k == 0 ? 1 : -1) * y[k] / sy);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) G[i][k] = sx / sy * (2 * w[i] * w[k] - (i != k ? 0 : i == 0 ? 1 : -1));
}

}  // namespace

Interior::Interior(Workspace& work, Equations& equations, double* room)
    : work_(work), equations_(equations), rows_(equations.rows()), scalars_(3 * work.points.size()) {
  for (double** numbers : {&x_, &y_, &z_, &dx_, &dy_, &dz_, &q_, &r_, &u_}) {
    *numbers = room;
    room += rows_;
  }
  work.slopes.assign(work.points.size() + work.scalars.size(), Slope{});
  begin();
}

/// Where all products are equal, and as large as what the rows have to stop.
void Interior::begin() {
  std::fill_n(x_, 9 * rows_, 0.0);
  equations_.read_free(u_);
  double& speed = speed_ = 1e-9;  // m/s
  for (std::size_t i = 0; i < work_.points.size(); ++i)
    speed = std::max(speed, std::abs(u_[3 * i] - work_.points[i].bias));
  for (std::size_t i = 0; i < work_.scalars.size(); ++i)
    speed = std::max(speed, std::abs(u_[scalars_ + i] - work_.scalars[i].bias));
  pairs_ = 0;
  for (std::size_t i = 0; i < work_.points.size(); ++i) {
    const Point& c = work_.points[i];
    const Kind kind = kind_of(c);
    if (kind == Kind::Idle) continue;
    ++pairs_;
    const double mu = kind == Kind::Cone ? c.friction : 1;
    x_[3 * i] = mu * speed / c.response.nn;
    y_[3 * i] = speed / mu;
  }
  for (std::size_t i = 0; i < work_.scalars.size(); ++i) {
    const PackedScalar& row = work_.scalars[i];
    if (!(row.response > 0)) continue;
    double& x = x_[scalars_ + i] = bounded(row.lo) && !bounded(row.hi) ? row.lo + speed / row.response : 0;
    const double product = speed * speed / row.response;
    if (bounded(row.hi)) {
      const double low = bounded(row.lo) ? row.lo : row.hi - 2 * speed / row.response;
      x = std::clamp(x, low + 0.25 * (row.hi - low), low + 0.75 * (row.hi - low));
      z_[scalars_ + i] = product / (row.hi - x);
      ++pairs_;
    }
    if (!bounded(row.lo)) continue;
    y_[scalars_ + i] = product / (x - row.lo);
    ++pairs_;
  }
}

/// The impulses are x in the axes of the rows; velocities follow.
void Interior::read() {
  std::copy_n(x_, rows_, q_);
  for (std::size_t i = 0; i < work_.points.size(); ++i)
    if (kind_of(work_.points[i]) == Kind::Cone) q_[3 * i] /= work_.points[i].friction;
  equations_.take(q_);
  equations_.read_rows(u_);
}

double Interior::gap() const {
  double sum = 0;
  for (std::size_t k = 0; k < scalars_; ++k) sum += x_[k] * y_[k];
  for (std::size_t i = 0; i < work_.scalars.size(); ++i) {
    const PackedScalar& row = work_.scalars[i];
    const std::size_t k = scalars_ + i;
    if (y_[k] > 0) sum += y_[k] * (x_[k] - row.lo);
    if (z_[k] > 0) sum += z_[k] * (row.hi - x_[k]);
  }
  return sum;
}

/// dq = r - D du: r and D of a point.
void Interior::prepare_point(std::size_t i, double target) {
  const Point& c = work_.points[i];
  const double *x = x_ + 3 * i, *y = y_ + 3 * i, *u = u_ + 3 * i;
  double* r = r_ + 3 * i;
  Slope& D = work_.slopes[i] = {};
  r[0] = r[1] = r[2] = 0;
  const Kind kind = kind_of(c);
  if (kind == Kind::Idle) return;
  const double error = u[0] - c.bias + c.softness * q_[3 * i];
  if (kind == Kind::Slippery) {
    const double G = x[0] / y[0];
    D.nn = G / (1 + c.softness * G);
    r[0] = (target / y[0] - x[0] - G * (error - y[0])) / (1 + c.softness * G);
    return;
  }
  prepare_cone(i, target, error);
}

void Interior::prepare_cone(std::size_t i, double target, double error) {
  const Point& c = work_.points[i];
  const double *x = x_ + 3 * i, *y = y_ + 3 * i, *u = u_ + 3 * i;
  double* r = r_ + 3 * i;
  const double mu = c.friction;
  const Lift lift(u);
  const double off[3] = {error / mu + lift.speed - y[0], u[1] - y[1], u[2] - y[2]};
  double G[3][3];
  scaling(x, y, G);
  const double share = target / inner_determinant(y);
  for (int k = 0; k < 3; ++k)
    r[k] = (k == 0 ? share : -share) * y[k] - x[k] - (G[k][0] * off[0] + G[k][1] * off[1] + G[k][2] * off[2]);
  // Softness: the impulse moves its own velocity.
  const double soft = c.softness / (mu * mu), top[3] = {G[0][0], G[0][1], G[0][2]}, give = 1 / (1 + soft * top[0]);
  const double r0 = soft * give * r[0];
  for (int k = 0; k < 3; ++k) {
    r[k] -= top[k] * r0;
    for (int m = 0; m < 3; ++m) G[k][m] -= soft * give * top[k] * top[m];
  }
  r[0] /= mu;
  work_.slopes[i] = {G[0][0] / (mu * mu),
                     (G[0][0] * lift.d1 + G[0][1]) / mu,
                     (G[0][0] * lift.d2 + G[0][2]) / mu,
                     G[1][0] / mu,
                     G[2][0] / mu,
                     G[1][0] * lift.d1 + G[1][1],
                     G[1][0] * lift.d2 + G[1][2],
                     G[2][0] * lift.d1 + G[2][1],
                     G[2][0] * lift.d2 + G[2][2]};
}

void Interior::prepare_scalar(std::size_t i, double target) {
  const PackedScalar& row = work_.scalars[i];
  const std::size_t k = scalars_ + i;
  Slope& D = work_.slopes[work_.points.size() + i] = {};
  r_[k] = 0;
  if (!(row.response > 0)) return;
  double stiff = row.softness + kSoftEquation * row.response, error = u_[k] - row.bias + row.softness * x_[k];
  if (y_[k] > 0) {
    stiff += y_[k] / (x_[k] - row.lo);
    error -= target / (x_[k] - row.lo);
  }
  if (z_[k] > 0) {
    stiff += z_[k] / (row.hi - x_[k]);
    error += target / (row.hi - x_[k]);
  }
  D.nn = 1 / stiff;
  r_[k] = -error / stiff;
}

/// The steps of a point's pair, r_ being its impulse's and dx_ the change of its velocity.
void Interior::finish_point(std::size_t i, Lengths& lengths) {
  const Point& c = work_.points[i];
  const Kind kind = kind_of(c);
  if (kind == Kind::Idle) return;
  double *dx = dx_ + 3 * i, *dy = dy_ + 3 * i;
  const double *x = x_ + 3 * i, *y = y_ + 3 * i, *u = u_ + 3 * i, *dq = r_ + 3 * i;
  const double error = u[0] + dx[0] - c.bias + c.softness * (q_[3 * i] + dq[0]);
  if (kind == Kind::Slippery) {
    dy[0] = error - y[0];
    dx[0] = dq[0];
    dx[1] = dx[2] = 0;
    shorten(lengths.x, x[0], dx[0]);
    shorten(lengths.y, y[0], dy[0]);
    return;
  }
  const Lift lift(u);
  dy[0] = error / c.friction + lift.speed + lift.d1 * dx[1] + lift.d2 * dx[2] - y[0];
  dy[1] = u[1] + dx[1] - y[1];
  dy[2] = u[2] + dx[2] - y[2];
  dx[0] = c.friction * dq[0];
  dx[1] = dq[1];
  dx[2] = dq[2];
  shorten(lengths.x, x, dx);
  shorten(lengths.y, y, dy);
}

void Interior::finish_scalar(std::size_t i, double target, Lengths& lengths) {
  const PackedScalar& row = work_.scalars[i];
  const std::size_t k = scalars_ + i;
  dx_[k] = r_[k];
  if (y_[k] > 0) {
    const double room = x_[k] - row.lo;
    dy_[k] = target / room - y_[k] - y_[k] / room * dx_[k];
    shorten(lengths.x, room, dx_[k]);
    shorten(lengths.y, y_[k], dy_[k]);
  }
  if (z_[k] > 0) {
    const double room = row.hi - x_[k];
    dz_[k] = target / room - z_[k] + z_[k] / room * dx_[k];
    shorten(lengths.x, room, -dx_[k]);
    shorten(lengths.y, z_[k], dz_[k]);
  }
}

bool Interior::step(double target, Lengths& lengths) {
  const std::size_t points = work_.points.size();
  equations_.clear();
  for (std::size_t i = 0; i < points; ++i) {
    prepare_point(i, target);
    equations_.add_point(i, work_.slopes[i]);
  }
  for (std::size_t i = 0; i < work_.scalars.size(); ++i) {
    prepare_scalar(i, target);
    equations_.add_scalar(i, work_.slopes[points + i].nn);
  }
  double* const du = dx_;
  if (!equations_.factorize() || !equations_.solve(r_, du)) return false;
  for (std::size_t i = 0; i < points; ++i) {
    apply_slope(work_.slopes[i], du + 3 * i, r_ + 3 * i);
    finish_point(i, lengths);
  }
  for (std::size_t i = 0; i < work_.scalars.size(); ++i) {
    r_[scalars_ + i] -= work_.slopes[points + i].nn * du[scalars_ + i];
    finish_scalar(i, target, lengths);
  }
  return true;
}

double Interior::solve(double goal, LinearSolves& solves) {
  double best = std::numeric_limits<double>::infinity();
  int since = 0;
  while (true) {
    read();
    const double left = violation(work_);
    since = left < best ? 0 : since + 1;
    best = std::min(best, left);
    if (left <= goal || since > kPatience || steps_ == kMostSteps || solves.spent() || !std::isfinite(left))
      return left;
    // The shorter the last step was, the more towards the centre this one.
    const double target = 0.5 * std::clamp(1 - last_, 0.01, 0.9) * gap() / std::max(pairs_, 1.0);
    Lengths lengths;
    if (!step(target, lengths)) return left;
    solves.make();
    ++steps_;
    const double x = std::min(1.0, kNearest * lengths.x), y = std::min(1.0, kNearest * lengths.y);
    last_ = std::min(x, y);
    for (std::size_t k = 0; k < rows_; ++k) {
      x_[k] += x * dx_[k];
      y_[k] += y * dy_[k];
      z_[k] += y * dz_[k];
    }
  }
}

}  // namespace breve::contact
