// Every scheme against the file of what it must give digit for digit, on a plain equation and on an articulated model
// of it; oscillators and pendulums against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "articulated_reference.hpp"
#include "runtime/articulated/integrator.hpp"
#include "runtime/articulated/tree_system.hpp"
#include "runtime/base/error.hpp"

namespace breve::articulated {
namespace {

using reference::Row;

constexpr double kGravity = 9.81;

// What a step of some ten operations may lose; after N steps errors add up, and a little more on a growing solution.
constexpr double kOneStep = 1e-13;
constexpr double kAllSteps = 1e-12;

const std::map<std::string, Scheme> kSchemes = {{"explicit_euler", Scheme::ExplicitEuler},
                                                {"semi_implicit_euler", Scheme::SemiImplicitEuler},
                                                {"implicit_euler", Scheme::ImplicitEuler},
                                                {"velocity_verlet", Scheme::VelocityVerlet},
                                                {"implicit_midpoint", Scheme::ImplicitMidpoint},
                                                {"rk4", Scheme::RungeKutta4},
                                                {"rkf45_4th", Scheme::Fehlberg4},
                                                {"rkf45_5th", Scheme::Fehlberg5}};

/// x'' = f(x, v) in one dimension.
class Plain final : public System {
 public:
  explicit Plain(double (*f)(double, double)) : f_(f) {}
  int positions() const override { return 1; }
  int velocities() const override { return 1; }
  Kind kind(int) const override { return Kind::Length; }
  void acceleration(double, const Vector& q, const Vector& v, double, Vector& a) override { a[0] = f_(q[0], v[0]); }

 private:
  double (*f_)(double, double);
};

double force(const std::string& problem, double x, double v) {
  if (problem == "harmonic") return -x;
  if (problem == "pendulum") return -kGravity * std::sin(x);
  return -4 * x - 0.3 * v;
}

std::unique_ptr<System> plain(const std::string& problem) {
  if (problem == "harmonic") return std::make_unique<Plain>([](double x, double v) { return force("harmonic", x, v); });
  if (problem == "pendulum") return std::make_unique<Plain>([](double x, double v) { return force("pendulum", x, v); });
  return std::make_unique<Plain>([](double x, double v) { return force("damped", x, v); });
}

/// A link of 1 kg on a slide along x, with spring and damper.
Model slide(double mass = 1) {
  Link link;
  link.type = JointType::Prismatic;
  link.axis = Vector3::UnitX();
  link.mass = mass;
  return Model({link});
}

/// A pendulum about y with its centre of mass `arm` below the pivot and `inertia` about the pivot.
Model pendulum(double arm, double inertia) {
  Link link;
  link.axis = Vector3::UnitY();
  link.com = Vector3(0, 0, -arm);
  link.inertia = Matrix3::Identity() * (inertia - arm * arm);
  return Model({link});
}

void expect_row(System& system, const Row& row, double one_step, double all_steps) {
  SCOPED_TRACE(row.text("problem") + " " + row.text("method") + " h " + row.text("h"));
  Integrator integrator(system, kSchemes.at(row.text("method")));
  Instant at{0, Vector::Constant(1, row.number("x0")), Vector::Constant(1, row.number("v0")), 0};
  const double h = row.number("h");
  integrator.step(at, h);
  EXPECT_NEAR(at.q[0], row.number("x_after_1"), one_step);
  EXPECT_NEAR(at.v[0], row.number("v_after_1"), one_step);
  for (int i = 1; i < row.integer("steps"); ++i) integrator.step(at, h);
  EXPECT_NEAR(at.q[0], row.number("x_end"), all_steps);
  EXPECT_NEAR(at.v[0], row.number("v_end"), all_steps);
}

TEST(Integrators, GiveTheReferenceDigitForDigitOnAPlainEquation) {
  int rows = 0;
  for (const Row& row : reference::read("integrators")) {
    const auto system = plain(row.text("problem"));
    expect_row(*system, row, kOneStep, kAllSteps);
    ++rows;
  }
  EXPECT_GT(rows, 60);
}

TEST(Integrators, GiveTheReferenceDigitForDigitOnAnArticulatedModel) {
  const Model slide_model = slide(), pendulum_model = pendulum(0.5, 0.5);
  for (const Row& row : reference::read("integrators")) {
    const std::string problem = row.text("problem");
    TreeSystem system(problem == "pendulum" ? pendulum_model : slide_model);
    if (problem == "pendulum") {
      system.loads.gravity = Vector3(0, 0, -kGravity);
    } else {
      system.loads.drives = {Drive{}};
      system.loads.drives[0].stiffness = problem == "harmonic" ? 1 : 4;
      system.loads.drives[0].damping = problem == "harmonic" ? 0 : 0.3;
    }
    expect_row(system, row, kOneStep, kAllSteps);
  }
}

TEST(Integrators, VerletHasOrderTwoWithForcesThatDependOnVelocity) {
  const auto system = plain("damped");
  Integrator verlet(*system, Scheme::VelocityVerlet), exact(*system, Scheme::Fehlberg5);
  double errors[2];
  for (const int fine : {0, 1}) {
    const int steps = fine ? 200 : 100;
    Instant a{0, Vector::Constant(1, 1), Vector::Constant(1, 1), 0}, b = a;
    for (int i = 0; i < steps; ++i) verlet.step(a, 5.0 / steps);
    for (int i = 0; i < 2000; ++i) exact.step(b, 5.0 / 2000);
    errors[fine] = std::abs(a.q[0] - b.q[0]);
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.1);
}

TEST(Integrators, AskForLoadsAtTheTimeAndStateOfEachStage) {
  // x'' = -x + sin(2t) from rest, both forces given by the callback: x = (2 sin t - sin 2t) / 3.
  const Model model = slide();
  TreeSystem system(model);
  system.loads.tau = Vector::Zero(1);
  system.update_loads = [](double t, const State& state, Loads& loads) { loads.tau[0] = std::sin(2 * t) - state.q[0]; };
  Integrator integrator(system, Scheme::RungeKutta4);
  constexpr double kEnd = 2;
  double errors[2];
  for (const int fine : {0, 1}) {
    const int steps = fine ? 80 : 40;
    Instant at{0, Vector::Zero(1), Vector::Zero(1), 0};
    for (int i = 0; i < steps; ++i) integrator.step(at, kEnd / steps);
    errors[fine] = std::abs(at.q[0] - (2 * std::sin(kEnd) - std::sin(2 * kEnd)) / 3);
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 4, 0.15);
}

TEST(Integrators, OscillatorsMeetTheirClosedForm) {
  double worst = 0;
  for (const Row& row : reference::read("oscillator")) {
    const Model model = slide(row.number("mass"));
    TreeSystem system(model);
    system.loads.drives = {Drive{row.number("stiffness"), row.number("damping"), 0, 0}};
    Settings settings;
    settings.tolerance.relative = 1e-13;
    // Units of the motion, or the tolerance would be wide for small ones.
    const double frequency = std::sqrt(row.number("stiffness") / row.number("mass"));
    settings.tolerance.length = std::abs(row.number("x0"));
    settings.tolerance.velocity = settings.tolerance.length * frequency;
    Integrator integrator(system, Scheme::FehlbergAdaptive, settings);
    Instant at{0, Vector::Constant(1, row.number("x0")), Vector::Constant(1, row.number("v0")), 0};
    // In iterations, as worlds do it: what one step may cost is bounded.
    const double fastest = std::max(frequency, row.number("damping") / row.number("mass"));
    const int iterations = static_cast<int>(std::ceil(fastest * row.number("t") / 100));
    for (int i = 0; i < iterations; ++i) integrator.step(at, row.number("t") / iterations);
    const double periods = 1 + frequency * row.number("t");
    const double error = std::max(std::abs(at.q[0] - row.number("x")) / settings.tolerance.length,
                                  std::abs(at.v[0] - row.number("v")) / settings.tolerance.velocity);
    EXPECT_LE(error, 1e-12 * periods) << row.text("case") << " at " << row.text("t");
    worst = std::max(worst, error);
  }
  std::printf("  oscillator: largest error %.1e of the amplitude\n", worst);
}

TEST(Integrators, PendulumsHaveTheirPeriodAtAnyAmplitude) {
  double worst = 0;
  for (const Row& row : reference::read("pendulum_period")) {
    const double length = row.number("dimensions_m");
    // A point on a rod without mass is a limit: the little inertia that a link needs is taken off its arm again.
    const bool rod = row.text("kind") == "rod";
    const Model model =
        rod ? pendulum(0.5 * length, length * length / 3) : pendulum(0.5 * length, 0.5 * length * length);
    TreeSystem system(model);
    system.loads.gravity = Vector3(0, 0, -row.number("g"));
    Settings settings;
    settings.tolerance.relative = 1e-13;
    Integrator integrator(system, Scheme::FehlbergAdaptive, settings);
    const double amplitude = row.number("amplitude_deg") * std::numbers::pi / 180;
    Instant at{0, Vector::Constant(1, amplitude), Vector::Zero(1), 0};
    // From rest at one side to the other and back; near the top the angle is a poor clock, so a quarter is used: there
    // the angle is zero, and the time by which it misses that is angle / rate.
    const double period = row.number("period");
    integrator.step(at, 0.25 * period);
    const double missed = at.q[0] / at.v[0];
    EXPECT_LE(std::abs(missed), 1e-11 * period / std::cos(0.5 * amplitude)) << row.text("kind") << ' ' << amplitude;
    worst = std::max(worst, std::abs(4 * missed / period));
  }
  std::printf("  pendulum_period: largest relative error %.1e\n", worst);
}

TEST(Integrators, StepControlKeepsItsStepInTheState) {
  const auto system = plain("pendulum");
  Settings settings;
  settings.tolerance.relative = 1e-9;
  Integrator one(*system, Scheme::FehlbergAdaptive, settings), other(*system, Scheme::FehlbergAdaptive, settings);
  Instant a{0, Vector::Constant(1, 1), Vector::Zero(1), 0};
  one.step(a, 1);
  EXPECT_GT(a.step, 0);
  EXPECT_LT(a.step, 1);
  Instant b = a;
  one.step(a, 1);
  other.step(b, 1);  // an integrator that has seen nothing goes on alike
  EXPECT_EQ(a.q[0], b.q[0]);
  EXPECT_EQ(a.v[0], b.v[0]);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.t, 2);
}

TEST(Integrators, StepControlEndsInAnErrorWhereNoStepIsSmallEnough) {
  Plain jumps([](double x, double) { return x > 0.5 ? std::nan("") : 1.0; });
  Integrator integrator(jumps, Scheme::FehlbergAdaptive);
  Instant at{0, Vector::Zero(1), Vector::Zero(1), 0};
  try {
    integrator.step(at, 2);
    FAIL() << "passed a wall of NaN";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Numeric);
    EXPECT_NE(std::string(error.what()).find("step size fell"), std::string::npos) << error.what();
  }
  EXPECT_EQ(at.t, 0);
  EXPECT_EQ(at.q[0], 0);
}

TEST(Integrators, StepControlEndsInAnErrorWhereItTakesTooManyAttempts) {
  Plain fast([](double x, double) { return -1e12 * x; });
  Integrator integrator(fast, Scheme::FehlbergAdaptive);
  Instant at{0, Vector::Ones(1), Vector::Zero(1), 0};
  try {
    integrator.step(at, 1);
    FAIL() << "some 160,000 swings in a step";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Numeric);
    EXPECT_NE(std::string(error.what()).find("after 100000 attempts"), std::string::npos) << error.what();
  }
  EXPECT_EQ(at.t, 0);
  EXPECT_EQ(at.q[0], 1);
  integrator.step(at, 1e-6);  // a shorter one is taken
  EXPECT_NEAR(at.q[0], std::cos(1), 1e-4);
}

TEST(Integrators, StepControlGoesOnAfterASliver) {
  // An event right after the start of a step leaves a first piece of next to nothing, and a tiny size to go on from.
  const auto system = plain("harmonic");
  Integrator integrator(*system, Scheme::FehlbergAdaptive);
  Instant at{0, Vector::Ones(1), Vector::Zero(1), 0};
  integrator.step(at, 1e-17);
  integrator.step(at, 1);
  EXPECT_NEAR(at.q[0], std::cos(1.0), 1e-5);
}

TEST(Integrators, StepControlGrowsByAtMostFive) {
  Plain still([](double, double) { return 0.0; });
  Integrator integrator(still, Scheme::FehlbergAdaptive);
  Instant at{0, Vector::Zero(1), Vector::Ones(1), 1e-3};
  integrator.step(at, 1e-3);
  EXPECT_DOUBLE_EQ(at.step, 5e-3);
}

TEST(Integrators, RefuseBadSteps) {
  const auto system = plain("harmonic");
  Integrator integrator(*system, Scheme::RungeKutta4);
  Instant at{0, Vector::Zero(1), Vector::Zero(1), 0};
  for (const double h : {0.0, -1.0, std::nan(""), HUGE_VAL}) EXPECT_THROW(integrator.step(at, h), Error) << h;
  at.v.resize(2);
  EXPECT_THROW(integrator.step(at, 0.1), Error);
  Settings settings;
  settings.tolerance.relative = 0;
  EXPECT_THROW(Integrator(*system, Scheme::FehlbergAdaptive, settings), Error);
}

}  // namespace
}  // namespace breve::articulated
