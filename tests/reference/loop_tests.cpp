// Rings against closed_loop.csv: parallelograms of cranks and couplers, and a slider-crank, each with one degree of
// freedom that the file follows by its energy.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "scenes.hpp"
#include "table.hpp"

namespace breve::reference {
namespace {

/// What there is to know of a ring with one degree of freedom.
struct Mechanism : World {
  breve_object crank{};
  double sign = 1, zero = 0;
  std::vector<Hinge> loops;
  explicit Mechanism(breve_rung rung) : World(1.0 / 60, rung) { set_guard(BREVE_GUARD_REPORT); }
  double angle() const { return zero + sign * read(crank).position[0]; }
  double rate() const { return sign * read(crank).velocity[0]; }
};

struct FourBar : Mechanism {
  explicit FourBar(breve_rung rung) : Mechanism(rung) {
    sign = -1;  // the file's angle goes toward +x
    Bar cranks[3], couplers[2];
    std::vector<breve_object> joints;
    for (int i = 0; i < 3; ++i) {
      cranks[i] = Bar(*this, Vector3(i, 0, 0), Vector3(i, 1, 0), 1);
      joints.push_back(join(pin(nullptr, Vector3(i, 0, 0), cranks[i], cranks[i].begin())));
    }
    std::vector<breve_object> rotated;
    for (int i = 0; i < 2; ++i) {
      couplers[i] = Bar(*this, Vector3(i, 1, 0), Vector3(i + 1, 1, 0), 1);
      rotated.push_back(join(pin(&cranks[i], cranks[i].end(), couplers[i], couplers[i].begin())));
      loops.push_back(pin(&couplers[i], couplers[i].end(), cranks[i + 1], cranks[i + 1].end()));
      EXPECT_TRUE(read(join(loops.back())).loop);
    }
    crank = joints[0];
    for (const breve_object joint : joints) set_joint(joint, 0, -1);
    for (const breve_object joint : rotated) set_joint(joint, 0, 1);
  }
};

struct SliderCrank : Mechanism {
  Bar arm, link;
  breve_object slider{}, rail{};
  explicit SliderCrank(breve_rung rung) : Mechanism(rung) {
    zero = 0.5;
    const Vector3 tip(0.2 * std::cos(zero), 0.2 * std::sin(zero), 0);
    const Vector3 far(tip.x() + std::sqrt(0.25 - tip.y() * tip.y()), 0, 0);
    arm = Bar(*this, Vector3::Zero(), tip, 1);
    link = Bar(*this, tip, far, 1.5);
    Bar block;
    block.body = slider = body(lump(2, 1e-3 * Matrix3::Identity()), far);
    crank = join(pin(nullptr, Vector3::Zero(), arm, arm.begin()));
    join(pin(&arm, arm.end(), link, link.begin()));
    join(pin(&link, link.end(), block, Vector3::Zero()));
    Hinge on_rail;
    on_rail.child = slider;
    on_rail.kind = BREVE_JOINT_PRISMATIC;
    on_rail.normal = Vector3::UnitX();
    rail = join(on_rail);
    EXPECT_TRUE(read(rail).loop);
  }
};

template <class Machine>
void follow(const std::string& name, breve_rung rung, double until, double bound) {
  Machine machine(rung);
  const double start = machine.mechanical();
  for (const Row& row : read(std::string("closed_loop"))) {
    if (row.text("case") != name || row.text("row") != "state" || row.number("t") > until) continue;
    machine.run(row.number("t") - machine.time());
    const double off = machine.angle() - row.number("angle"), rate = machine.rate() - row.number("rate");
    double open = 0;
    for (const Hinge& loop : machine.loops) open = std::max(open, machine.open(loop));
    std::printf("  %-12s t %4.2f: angle off by %+.1e, rate by %+.1e, open %.0e, energy %+.1e J\n", name.c_str(),
                row.number("t"), off, rate, open, machine.mechanical() - start);
    EXPECT_LE(std::abs(off), bound) << name << " at " << row.number("t");
    EXPECT_LE(std::abs(rate), bound * std::max(1.0, std::abs(row.number("rate")))) << name << " at " << row.number("t");
    EXPECT_LE(open, 1e-9);
  }
}

TEST(ClosedLoops, ReferenceFollowsTheParallelograms) { follow<FourBar>("fourbar_N2", BREVE_RUNG_REFERENCE, 0.5, 1e-7); }

TEST(ClosedLoops, ReferenceFollowsTheSliderCrank) { follow<SliderCrank>("slidercrank", BREVE_RUNG_REFERENCE, 3, 1e-7); }

TEST(ClosedLoops, PreciseFollowsBoth) {
  follow<FourBar>("fourbar_N2", BREVE_RUNG_PRECISE, 0.5, 1e-5);
  follow<SliderCrank>("slidercrank", BREVE_RUNG_PRECISE, 3, 1e-3);
}

/// At rest, held by the rail and nothing else under the slider: statics gives what each joint holds.
TEST(ClosedLoops, ReactionsIncludeTheLoop) {
  for (const breve_rung rung : {BREVE_RUNG_BALANCED, BREVE_RUNG_REFERENCE}) {
    SliderCrank machine(rung);
    // The crank's torque holds all: work of weights along the one freedom, by differences of the geometry.
    const auto height = [](double angle) { return 9.81 * (1 * 0.1 + 1.5 * 0.1) * std::sin(angle); };
    const double torque = (height(0.5 + 1e-6) - height(0.5 - 1e-6)) / 2e-6;
    breve_drive drive = machine.drive(machine.crank);
    drive.force[0] = torque;
    machine.set_drive(machine.crank, drive);
    const breve_joint_info held = machine.read(machine.crank), rail = machine.read(machine.rail);
    // The pivot and the rail hold the weights upward; along x nothing acts but the two.
    EXPECT_NEAR(held.force[1] + rail.force[1], 9.81 * 4.5, 1e-6);
    EXPECT_NEAR(held.force[0], 0, 9.81 * 4.5);
    EXPECT_NEAR(rail.force[0], 0, 1e-9);
    machine.run(0.1);
    // The rule of `balanced` is of second order, and this balance is not stable.
    EXPECT_NEAR(machine.rate(), 0, rung == BREVE_RUNG_BALANCED ? 1e-4 : 1e-8);
  }
}

}  // namespace
}  // namespace breve::reference
