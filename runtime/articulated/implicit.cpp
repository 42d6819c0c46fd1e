// Implicit Euler and implicit midpoint. The unknown is the velocity that moves the positions.
#include <fmt/format.h>

#include "runtime/articulated/method.hpp"
#include "runtime/articulated/newton_krylov.hpp"
#include "runtime/base/error.hpp"

namespace breve::articulated {

namespace {

/// With u the velocity at the step's end (Euler) or its mean (midpoint), and `part` 1 or 1/2 of the step:
/// u = v0 + part h a(q0 moved by part h u, u, t + part h). The midpoint rule moves by Cayley's rotations: with these
/// the angular momentum of a free body stays in the world, not only its size (see bend_to_cayley).
class Implicit final : public Integrator::Method, private Residual {
 public:
  Implicit(System& system, const Settings& settings, bool midpoint)
      : Method(system, settings),
        midpoint_(midpoint),
        part_(midpoint ? 0.5 : 1),
        solver_(system.velocities()),
        u_(system.velocities()),
        a_(system.velocities()),
        d_(system.velocities()),
        q_(system.positions()) {}

  void step(Instant& at, double h) override {
    from_ = &at;
    h_ = h;
    evaluate(at.t, at.q, at.v, part_ * h, a_);
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

 private:
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
  NewtonKrylov solver_;
  const Instant* from_ = nullptr;
  double h_ = 0;
  Vector u_, a_, d_, q_;
};

}  // namespace

std::unique_ptr<Integrator::Method> make_implicit(System& system, Scheme scheme, const Settings& settings) {
  return std::make_unique<Implicit>(system, settings, scheme == Scheme::ImplicitMidpoint);
}

}  // namespace breve::articulated
