// Implicit Euler and implicit midpoint. The unknown is the velocity that moves the positions.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "runtime/articulated/method.hpp"
#include "runtime/articulated/newton_krylov.hpp"
#include "runtime/base/error.hpp"

namespace breve::articulated {

namespace {

// Parts of a step whose composition has order 4; it is as symmetric as the midpoint rule and keeps the same invariants.
// Source: Suzuki 1990 (fractal decomposition).
constexpr double kOuter = 0.41449077179437573714;  // 1 / (4 - 4^(1/3))
constexpr std::array<double, 5> kParts = {kOuter, kOuter, 1 - 4 * kOuter, kOuter, kOuter};

/// With u the velocity at the step's end (Euler) or its mean (midpoint), and `part` 1 or 1/2 of the step:
/// u = v0 + part h a(q0 moved by part h u, u, t + part h). The midpoint rule moves by Cayley's rotations: with these
/// the angular momentum of a free body stays in the world, not only its size (see bend_to_cayley).
class Implicit final : public Integrator::Method, private Residual {
 public:
  Implicit(System& system, const Settings& settings, bool midpoint)
      : Method(system, settings),
        midpoint_(midpoint),
        part_(midpoint ? 0.5 : 1),
        composed_(midpoint && settings.refine),
        solver_(system.velocities()),
        u_(system.velocities()),
        a_(system.velocities()),
        d_(system.velocities()),
        q_(system.positions()),
        start_q_(system.positions()),
        plain_q_(system.positions()),
        start_v_(system.velocities()),
        plain_v_(system.velocities()) {}

  void step(Instant& at, double h) override {
    const double start = at.t;
    start_q_ = at.q;
    start_v_ = at.v;
    evaluate(at.t, at.q, at.v, part_ * h, a_);
    take(at, h);
    if (!composed_) return;
    plain_q_ = at.q;
    plain_v_ = at.v;
    at.t = start;
    at.q = start_q_;
    at.v = start_v_;
    if (!compose(at, h)) {
      at.q = plain_q_;
      at.v = plain_v_;
    }
    at.t = start + h;
  }

 private:
  /// False where the parts have no solution, or disagree with the plain step: one of them goes back in time, and there
  /// what damps fast grows. Likewise where the work of the step is used up.
  bool compose(Instant& at, double h) {
    try {
      for (const double part : kParts) {
        if (system_.over()) return false;
        a_ = (plain_v_ - start_v_) / h;
        take(at, part * h);
      }
    } catch (const Error& error) {
      if (error.code() != ErrorCode::Numeric) throw;
      return false;
    }
    constexpr double kOwn = 0.25, kAll = 0.05;  // of a number's change, of all
    const double all = kAll * (plain_v_ - start_v_).norm();
    for (int i = 0; i < static_cast<int>(at.v.size()); ++i)
      if (!(std::abs(at.v[i] - plain_v_[i]) <= kOwn * std::abs(plain_v_[i] - start_v_[i]) + all)) return false;
    return true;
  }

  /// One step of the plain rule, from a guess of the acceleration in a_.
  void take(Instant& at, double h) {
    from_ = &at;
    h_ = h;
    u_ = at.v + (part_ * h) * a_;
    const double scale = at.v.norm() + u_.norm();
    if (!solver_.solve(*this, u_, scale + 1e-300))
      throw Error(ErrorCode::Numeric,
                  fmt::format("at {} s Newton's method finds no solution of an implicit step of {} s; a shorter step "
                              "would help",
                              at.t, h));
    tangent(u_);
    system_.move(at.q, d_, q_);
    at.q = q_;
    if (midpoint_)
      at.v = 2 * u_ - at.v;
    else
      at.v = u_;
    at.t += h;
  }

  void tangent(const Vector& u) {
    d_ = h_ * u;
    if (midpoint_) system_.bend_to_cayley(d_);
  }

  void residual(const Vector& u, Vector& f) override {
    tangent(u);
    d_ *= part_;
    system_.move(from_->q, d_, q_);
    evaluate(from_->t + part_ * h_, q_, u, 0, a_);
    f = u - from_->v - (part_ * h_) * a_;
  }

  const bool midpoint_;
  const double part_;
  const bool composed_;
  NewtonKrylov solver_;
  const Instant* from_ = nullptr;
  double h_ = 0;
  Vector u_, a_, d_, q_, start_q_, plain_q_, start_v_, plain_v_;
};

}  // namespace

std::unique_ptr<Integrator::Method> make_implicit(System& system, Scheme scheme, const Settings& settings) {
  return std::make_unique<Implicit>(system, settings, scheme == Scheme::ImplicitMidpoint);
}

}  // namespace breve::articulated
