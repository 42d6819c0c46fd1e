// Motion over seconds against the files of trajectories: chains in space, planar pendulums, tops.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "articulated_reference.hpp"
#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/integrator.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/articulated/tree_system.hpp"

namespace breve::articulated {
namespace {

using reference::Row;

Settings tight() {
  Settings settings;
  settings.tolerance.relative = 1e-10;
  return settings;
}

/// What double precision and the tolerance allow at a time when a tiny change has grown by `amplification`.
double allowed(double amplification) { return std::max(1e-7, 1e-16 * amplification * 1e3); }

/// A quaternion and its negative are one attitude: the sign of `q` that is nearer to `expected`.
void match_signs(const Model& model, const Vector& expected, Vector& q) {
  for (const Body& body : model.bodies()) {
    const int at = body.type == JointType::Ball ? body.q : body.q + 3;
    if (body.type != JointType::Ball && body.type != JointType::Free) continue;
    if (q.segment<4>(at).dot(expected.segment<4>(at)) < 0) q.segment<4>(at) *= -1;
  }
}

struct Moment {
  double t, kinetic, potential, amplification;
  State state;
};

std::vector<Moment> moments_of(const std::string& name) {
  std::vector<Moment> moments;
  for (const Row& row : reference::rows_of(reference::read("mb_trajectory"), name)) {
    if (moments.empty() || moments.back().t != row.number("t"))
      moments.push_back(
          {row.number("t"), row.number("kinetic"), row.number("potential"), row.number("amplification"), {}});
    reference::append(moments.back().state.q, reference::numbers(row, "q", 7));
    reference::append(moments.back().state.v, reference::numbers(row, "u", 6));
  }
  return moments;
}

/// A system of mb_trajectory, without joint forces but its springs.
struct Swinging {
  explicit Swinging(const std::string& name)
      : given(reference::load(name)), model(given.links), system(model), at{0, given.state.q, given.state.v, 0} {
    system.loads = given.loads;
    system.loads.tau.resize(0);
  }
  double energy() {
    forward_kinematics(model, system.data(), {at.q, at.v});
    return kinetic_energy(model, system.data()) + potential_energy(model, system.data(), system.loads.gravity);
  }
  double error(const State& expected) {
    match_signs(model, expected.q, at.q);
    return std::max((at.q - expected.q).cwiseAbs().maxCoeff(), (at.v - expected.v).cwiseAbs().maxCoeff());
  }

  reference::Case given;
  Model model;
  TreeSystem system;
  Instant at;
};

TEST(Trajectories, StepControlFollowsTheReference) {
  for (const std::string& name : reference::case_names("mb_trajectory")) {
    Swinging run(name);
    Integrator integrator(run.system, Scheme::FehlbergAdaptive, tight());
    double worst = 0;
    for (const Moment& moment : moments_of(name)) {
      integrator.step(run.at, moment.t - run.at.t);
      const double error = run.error(moment.state);
      EXPECT_LE(error, allowed(moment.amplification)) << name << " at " << moment.t;
      EXPECT_NEAR(run.energy(), moment.kinetic + moment.potential, 1e-7) << name;
      worst = std::max(worst, error);
    }
    std::printf("  %-14s largest error in q and v %.1e\n", name.c_str(), worst);
  }
}

// The file gives what the textbook's schemes do; they are to be met, neither missed nor beaten by much.
TEST(Trajectories, SchemesErrAsMuchAsTheTextbooks) {
  int rows = 0;
  double worst = 1;
  for (const Row& row : reference::read("expected_errors")) {
    Swinging run(row.text("case"));
    const Scheme scheme = row.text("scheme") == "rk4" ? Scheme::RungeKutta4 : Scheme::SemiImplicitEuler;
    Integrator integrator(run.system, scheme);
    const double h = row.number("h"), end = row.number("t");
    const bool unstable = row.text("max_error_q_and_u") == "unstable";
    // An unstable run grows until the forces are no longer finite, which is an error with a message.
    try {
      while (run.at.t < end - 0.5 * h) integrator.step(run.at, h);
    } catch (const std::exception&) {
      EXPECT_TRUE(unstable) << row.text("case");
    }
    if (unstable) continue;
    const std::vector<Moment> moments = moments_of(row.text("case"));
    const Moment* last = nullptr;
    for (const Moment& moment : moments)
      if (moment.t == end) last = &moment;
    ASSERT_NE(last, nullptr);
    const double expected = row.number("max_error_q_and_u"), got = run.error(last->state);
    EXPECT_LE(got, 2 * expected) << row.text("case") << ' ' << row.text("scheme") << ' ' << h;
    EXPECT_GE(got, 0.5 * expected) << row.text("case") << ' ' << row.text("scheme") << ' ' << h;
    const double energy_error = run.energy() - last->kinetic - last->potential;
    EXPECT_LE(std::abs(energy_error), 2 * std::abs(row.number("energy_error")) + 1e-12);
    worst = std::max({worst, got / expected, expected / got});
    ++rows;
  }
  EXPECT_GT(rows, 20);
  std::printf("  expected_errors: at most %.4f times\n", worst);
}

/// Rods on a line, absolute angles in the file and relative ones in the model.
struct Rods {
  std::vector<Link> links;
  std::vector<double> angle, rate;

  explicit Rods(const std::vector<Row>& rows) {
    for (const Row& row : rows) {
      Link link;
      link.parent = static_cast<int>(links.size()) - 1;
      link.axis = -Vector3::UnitY();  // positive angles swing towards +x
      const double length = row.number("length");
      if (!links.empty()) link.position = 2 * links.back().com;
      link.com = Vector3(0, 0, -0.5 * length);
      link.mass = row.number("mass");
      link.inertia = Matrix3::Identity() * (link.mass * length * length / 12);
      links.push_back(link);
      angle.push_back(row.number("theta0"));
      rate.push_back(row.number("omega0"));
    }
  }
};

TEST(Trajectories, PlanarPendulumsFollowTheReference) {
  for (const std::string& name : reference::case_names("planar_pendulum")) {
    std::vector<std::vector<Row>> times;
    for (const Row& row : reference::rows_of(reference::read("planar_pendulum"), name)) {
      if (times.empty() || times.back().front().number("t") != row.number("t")) times.emplace_back();
      times.back().push_back(row);
    }
    const Rods rods(times.front());
    const Model model(rods.links);
    TreeSystem system(model);
    system.loads.gravity = Vector3(0, 0, -9.81);
    Integrator integrator(system, Scheme::FehlbergAdaptive, tight());
    Instant at{0, Vector(model.positions()), Vector(model.velocities()), 0};
    for (int i = 0; i < model.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      at.q[i] = rods.angle[k] - (i ? rods.angle[k - 1] : 0);
      at.v[i] = rods.rate[k] - (i ? rods.rate[k - 1] : 0);
    }
    double worst = 0;
    for (const std::vector<Row>& rows : times) {
      integrator.step(at, rows.front().number("t") - at.t);
      double angle = 0, rate = 0;
      for (int i = 0; i < model.size(); ++i) {
        const Row& row = rows[static_cast<std::size_t>(i)];
        angle += at.q[i];
        rate += at.v[i];
        const double error = std::max(std::abs(angle - row.number("theta")), std::abs(rate - row.number("omega")));
        EXPECT_LE(error, allowed(row.number("amplification"))) << name << " rod " << i << " at " << at.t;
        worst = std::max(worst, error);
      }
      forward_kinematics(model, system.data(), {at.q, at.v});
      const double energy =
          kinetic_energy(model, system.data()) + potential_energy(model, system.data(), system.loads.gravity);
      EXPECT_NEAR(energy, rows.front().number("energy"), 1e-7) << name << " at " << at.t;
    }
    std::printf("  %-14s largest error of angles and rates %.1e\n", name.c_str(), worst);
  }
}

Model top(const Vector3& inertia) {
  Link link;
  link.type = JointType::Free;
  link.inertia = inertia.asDiagonal();
  return Model({link});
}

/// Attitude error as an angle, between quaternions of either sign.
double angle_between(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  return 2 * std::min((a - b).norm(), (a + b).norm());
}

Eigen::Vector4d attitude(const Row& row) {
  return {row.number("qw"), row.number("qx"), row.number("qy"), row.number("qz")};
}

TEST(Trajectories, FreeTopsFollowTheReference) {
  for (const std::string& name : reference::case_names("top_free")) {
    const std::vector<Row> rows = reference::rows_of(reference::read("top_free"), name);
    const Model model = top(rows[0].vector("I1", "I2", "I3"));
    TreeSystem system(model);
    Integrator integrator(system, Scheme::FehlbergAdaptive, tight());
    const State start = neutral_state(model);
    Instant at{0, start.q, start.v, 0};
    at.v.tail<3>() = rows[0].vector("w1_0", "w2_0", "w3_0");
    const double size = at.v.norm();
    double worst = 0;
    std::map<double, const Row*> by_time;  // the file's last row may be earlier than the one before it
    for (const Row& row : rows) by_time[row.number("t")] = &row;
    for (const auto& [t, row] : by_time) {
      integrator.step(at, t - at.t);
      const double error = std::max((Vector3(at.v.tail<3>()) - row->vector("w1", "w2", "w3")).norm() / size,
                                    angle_between(at.q.tail<4>(), attitude(*row)));
      // Turns and growth of errors: the flat top turns fifty radians, the tennis racket leaves its middle axis.
      EXPECT_LE(error, 1e-9) << name << " at " << t;
      worst = std::max(worst, error);
    }
    std::printf("  %-14s largest error of spin (relative) and attitude %.1e\n", name.c_str(), worst);
  }
}

TEST(Trajectories, HeavyTopsFollowTheReference) {
  for (const std::string& name : reference::case_names("top_heavy")) {
    const std::vector<Row> rows = reference::rows_of(reference::read("top_heavy"), name);
    const Row& first = rows[0];
    Link link;
    link.type = JointType::Ball;
    link.mass = first.number("mass");
    const double l = first.number("l"), across = first.number("I1_pivot") - link.mass * l * l;
    link.com = Vector3(0, 0, l);
    link.inertia = Vector3(across, across, first.number("I3")).asDiagonal();
    const Model model({link});
    TreeSystem system(model);
    system.loads.gravity = Vector3(0, 0, -9.81);
    Integrator integrator(system, Scheme::FehlbergAdaptive, tight());
    const double tilt = first.number("theta0");
    Instant at{0, Vector(4), Vector(3), 0};
    at.q << std::cos(0.5 * tilt), 0, std::sin(0.5 * tilt), 0;
    at.v << -first.number("phidot0") * std::sin(tilt), first.number("thetadot0"), first.number("omega3");
    const double size = at.v.norm();
    double worst = 0;
    for (const Row& row : rows) {
      integrator.step(at, row.number("t") - at.t);
      forward_kinematics(model, system.data(), {at.q, at.v});
      const double axis = (pose(system.data(), 0).rotation.col(2) - row.vector("e")).norm();
      const double error = std::max(
          {(Vector3(at.v) - row.vector("w1", "w2", "w3")).norm() / size, axis, angle_between(at.q, attitude(row))});
      EXPECT_LE(error, 1e-9) << name << " at " << at.t;
      worst = std::max(worst, error);
    }
    std::printf("  %-14s largest error of spin (relative), axis and attitude %.1e\n", name.c_str(), worst);
  }
}

}  // namespace
}  // namespace breve::articulated
