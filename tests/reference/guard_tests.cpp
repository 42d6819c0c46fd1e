// The guard through breve.h: each thing that it watches for, in each of its modes. A finding is an event with
// reason, action and body, is counted, and the world goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "scenes.hpp"

namespace breve::reference {
namespace {

constexpr breve_guard kModes[] = {BREVE_GUARD_OFF, BREVE_GUARD_REPORT, BREVE_GUARD_REFINE, BREVE_GUARD_REST};

int count(const std::vector<breve_intervention>& all, const char* reason, const char* action) {
  int n = 0;
  for (const breve_intervention& one : all) n += !std::strcmp(one.reason, reason) && !std::strcmp(one.action, action);
  return n;
}

struct Watched : World {
  std::vector<breve_intervention> all;
  explicit Watched(breve_guard guard, breve_rung rung = BREVE_RUNG_BALANCED) : World(1.0 / 60, rung) {
    set_guard(guard);
    set_gravity(Vector3::Zero());
  }
  void watch(int steps) {
    for (int i = 0; i < steps; ++i) {
      step();
      const std::vector<breve_intervention> now = interventions();
      EXPECT_EQ(now.size(), counters().interventions);
      all.insert(all.end(), now.begin(), now.end());
    }
  }
  /// Reported in `report`, tried again in `refine` and `rest`, not looked at in `off`; `body` is the one that shows it.
  void expect_refined(breve_guard guard, const char* reason, breve_object body) {
    EXPECT_EQ(count(all, reason, "reported") > 0, guard == BREVE_GUARD_REPORT) << reason;
    EXPECT_EQ(count(all, reason, "refined") > 0, guard >= BREVE_GUARD_REFINE) << reason;
    EXPECT_EQ(count(all, reason, "put to rest"), 0) << reason;
    expect_body(reason, body);
  }
  /// As above, and refining does not help.
  void expect_ended(breve_guard guard, const char* reason, breve_object body) {
    const bool reports = guard == BREVE_GUARD_REPORT || guard == BREVE_GUARD_REFINE;
    EXPECT_EQ(count(all, reason, "reported") > 0, reports) << reason;
    EXPECT_EQ(count(all, reason, "refined") > 0, guard >= BREVE_GUARD_REFINE) << reason;
    EXPECT_EQ(count(all, reason, "put to rest") > 0, guard == BREVE_GUARD_REST) << reason;
    expect_body(reason, body);
  }
  void expect_body(const char* reason, breve_object body) {
    for (const breve_intervention& one : all) {
      if (std::strcmp(one.reason, reason) != 0) continue;
      EXPECT_TRUE(same(one.body, body)) << reason;
      EXPECT_TRUE(std::isfinite(one.value));
    }
  }
};

TEST(Guard, SeesANumberThatIsNotFinite) {
  for (const breve_guard guard : kModes) {
    Watched world(guard);
    const breve_object ball = world.body(sphere(0.5, 1e-3), Vector3::Zero());
    world.body(sphere(0.5, 1), Vector3(100, 0, 0));
    world.set_force(ball, Vector3(1e307, 0, 0));
    world.watch(2);
    world.expect_ended(guard, "a number is not finite", ball);
    if (guard != BREVE_GUARD_OFF) {
      EXPECT_TRUE(world.at(ball).allFinite());
    }
  }
}

TEST(Guard, SeesAnEquationWithoutSolution) {
  for (const breve_guard guard : {BREVE_GUARD_REPORT, BREVE_GUARD_REFINE, BREVE_GUARD_REST}) {
    Watched world(guard, BREVE_RUNG_CONSERVING);
    world.set_gravity(Vector3(0, -1e6, 0));
    const Chain chain = hang(world, {1, 1}, {1, 1});
    start(world, chain, {0.5, 1}, {0, 0});
    world.watch(1);
    world.expect_refined(guard, "no solution was found for an equation of the step", chain.links[0]);
  }
}

/// A rod on a spring that is too stiff for explicit Euler at 1/60 s: k h^2 / I = 10.
Chain hang_what_blows_up(World& world) {
  world.set_integrator(BREVE_INTEGRATOR_EXPLICIT_EULER);
  const Chain chain = hang(world, {1}, {1});
  breve_drive drive = world.drive(chain.joints[0]);
  drive.stiffness = 10 * (1.0 / 3) * 3600;
  world.set_drive(chain.joints[0], drive);
  start(world, chain, {0.1}, {0});
  return chain;
}

TEST(Guard, SeesEnergyFromNowhere) {
  for (const breve_guard guard : kModes) {
    Watched world(guard);
    const Chain chain = hang_what_blows_up(world);
    const double begin = world.mechanical();
    world.watch(10);
    world.expect_refined(guard, "unexplained energy gain", chain.links[0]);
    EXPECT_EQ(world.mechanical() > 2 * begin, guard <= BREVE_GUARD_REPORT);
  }
}

/// Ten sweeps do not find what holds a million kilograms on one: a plate on it sinks in. Refined they do; but nothing
/// finds it where the masses differ by more than the digits of a number.
TEST(Guard, SeesAnOverlapThatGrows) {
  for (const breve_guard guard : kModes)
    for (const double mass : {1e6, 1e16}) {
      Watched world(guard, BREVE_RUNG_FAST);
      world.set_gravity(Vector3(0, -9.81, 0));
      world.fixed(box(Vector3(10, 1, 10), 1), Vector3(0, -0.5, 0));
      const breve_object lower = world.body(box(Vector3(1, 1, 1), 1), Vector3(0, 0.5, 0));
      world.body(box(Vector3(2, 1, 1), mass), Vector3(0, 1.5, 0));
      world.watch(20);
      if (mass < 1e15) {  // a small island is solved directly: a million times the mass is held
        EXPECT_TRUE(world.all.empty());
        EXPECT_NEAR(world.at(lower).y(), 0.5, 0.01);
      } else {
        world.expect_ended(guard, "an overlap grows", lower);
      }
      EXPECT_TRUE(world.at(lower).allFinite());
    }
}

TEST(Guard, SeesABodyThatRotatesTooFar) {
  for (const breve_guard guard : kModes) {
    Watched world(guard);
    const breve_object fast = world.body(box(Vector3(1, 2, 3), 1), Vector3::Zero());
    world.set_spin(fast, Vector3(1, 900, 2));
    const breve_object slow = world.body(box(Vector3(1, 2, 3), 1), Vector3(10, 0, 0));
    world.set_spin(slow, Vector3(1, 29, 2));
    const breve_object round = world.body(sphere(1, 1), Vector3(20, 0, 0));
    world.set_spin(round, Vector3(1, 400, 2));
    world.watch(1);
    world.expect_refined(guard, "a body rotates too far in one sub-step", fast);
    // Sixteen sub-steps are as many as there are without the guard; it takes four times as many.
    EXPECT_EQ(world.counters().sub_steps, guard >= BREVE_GUARD_REFINE ? 66U : 18U);
    if (guard != BREVE_GUARD_OFF) {
      EXPECT_NEAR(world.all.front().value, std::hypot(1, 900, 2) / 60 / 16, 1e-12);
    }
  }
}

TEST(Guard, IsNotNeededWhereSubStepsFollowTheRotation) {
  for (const breve_guard guard : kModes) {
    Watched world(guard);
    const breve_object fast = world.body(box(Vector3(1, 2, 3), 1), Vector3::Zero());
    world.set_spin(fast, Vector3(1, 100, 2));
    world.watch(1);
    EXPECT_TRUE(world.all.empty());
    EXPECT_EQ(world.counters().sub_steps, 4U) << "100 / 60 rad in parts of at most 0.5";
  }
}

TEST(Guard, SeesADamperThatIsTooStrong) {
  for (const breve_guard guard : kModes) {
    for (const double strength : {0.9, 4.0}) {
      Watched world(guard);
      world.set_integrator(BREVE_INTEGRATOR_VELOCITY_VERLET);
      const Chain chain = hang(world, {1}, {1});
      breve_drive drive = world.drive(chain.joints[0]);
      drive.damping = strength * (1.0 / 3) * 60;  // c h / I for the rod about its end
      world.set_drive(chain.joints[0], drive);
      start(world, chain, {0}, {1});
      world.watch(1);
      if (strength < 1) {
        for (const breve_intervention& one : world.all)
          EXPECT_STRNE(one.reason, "a damper is too strong for the sub-step");
        continue;
      }
      world.expect_refined(guard, "a damper is too strong for the sub-step", chain.links[0]);
      if (guard != BREVE_GUARD_OFF) {
        EXPECT_NEAR(world.all.front().value, strength, 1e-9);
      }
      if (guard >= BREVE_GUARD_REFINE) {
        EXPECT_NEAR(world.read(chain.joints[0]).velocity[0], std::exp(-strength), 0.02);
      }
    }
  }
}

TEST(Guard, SeesMoreImpactsThanAreLocated) {
  for (const breve_guard guard : kModes) {
    Watched world(guard);
    breve_accuracy accuracy = world.accuracy();
    accuracy.impacts = 1;
    world.set_accuracy(accuracy);
    for (const double x : {-1.01, 1.01})
      world.set_material(world.fixed(box(Vector3(1, 1, 1), 1), Vector3(x, 0, 0)), 0, 1);
    const breve_object ball = world.body(sphere(0.5, 1), Vector3::Zero());
    world.set_material(ball, 0, 1);
    world.set_velocity(ball, Vector3(5, 0, 0));
    world.watch(1);
    EXPECT_EQ(count(world.all, "more impacts in one sub-step than can be located", "reported"), guard ? 1 : 0);
    world.expect_body("more impacts in one sub-step than can be located", ball);
  }
}

/// The ledger also has what the guard takes.
TEST(Guard, RestIsInTheLedger) {
  Watched world(BREVE_GUARD_REST);
  const breve_object ball = world.body(sphere(0.5, 1e-3), Vector3::Zero());
  world.set_velocity(ball, Vector3(0, 3, 0));
  const breve_energy before = world.energy();
  world.set_force(ball, Vector3(1e307, 0, 0));
  world.watch(1);
  const breve_energy after = world.energy();
  EXPECT_EQ(world.velocity(ball), Vector3::Zero());
  EXPECT_NEAR(after.residual - before.residual, -before.kinetic, 1e-15);
}

constexpr const char* kUnexplained = "unexplained energy gain";

/// A chain of three links that swings, whose end is then joined to a point above: closing the loop lifts the links by
/// hand, however fine the sub-steps.
struct Lifted : Watched {
  Chain chain;
  Hinge hinge;
  double before = 0;
  explicit Lifted(breve_guard guard) : Watched(guard) {
    set_gravity(Vector3(0, -9.81, 0));
    chain = hang(*this, {1, 1, 1}, {1, 1, 1});
    start(*this, chain, {0.3, 0.5, 0.4}, {0.5, -0.2, 0.3});
    hinge.child = chain.links.back();
    hinge.child_point = Vector3(0, -0.5, 0);
    hinge.parent_point = at(hinge.child) + orientation(hinge.child) * hinge.child_point + Vector3(0, 0.3, 0);
    hinge.normal = -Vector3::UnitZ();
    EXPECT_TRUE(read(join(hinge)).loop);
    before = mechanical();
  }
  double fastest() const {
    double most = 0;
    for (const breve_object link : chain.links) most = std::max({most, velocity(link).norm(), spin(link).norm()});
    return most;
  }
};

TEST(Guard, RestEndsEnergyFromNowhereThatRefiningLeaves) {
  for (const breve_guard guard : kModes) {
    Lifted world(guard);
    world.watch(1);
    world.expect_ended(guard, kUnexplained, world.chain.links[0]);
    if (guard >= BREVE_GUARD_REFINE) {
      EXPECT_EQ(count(world.all, kUnexplained, "refined"), 2);  // a quarter of the sub-step, then a 64th
    }
    EXPECT_LE(world.open(world.hinge), 1e-9);
    const double lifted = world.mechanical();
    EXPECT_GT(lifted, world.before + 1);  // J: so it is a lift, and not little
    if (guard != BREVE_GUARD_REST) {
      EXPECT_GT(world.fastest(), 0.01);
      continue;
    }
    std::printf("  lifted by %.3f J, then at rest; told %.3f J\n", lifted - world.before, world.all.back().value);
    EXPECT_EQ(world.fastest(), 0);
    EXPECT_EQ(world.energy().kinetic, 0);
    // Told is what the step gained; the ledger also has that the speeds are gone.
    EXPECT_NEAR(world.energy().residual, lifted - world.before, 1e-9);
    EXPECT_GE(world.all.back().value, world.energy().residual);
    // From there it goes on, and no more unexplained energy is gained.
    const std::size_t told = world.all.size();
    double most = lifted;
    for (int i = 0; i < 120; ++i) {
      world.watch(1);
      most = std::max(most, world.mechanical());
    }
    EXPECT_LE(most - lifted, 0.01 * (lifted - world.before));
    EXPECT_EQ(world.all.size(), told);
    EXPECT_GT(world.fastest(), 0.01);
  }
}

/// A force method may have run script: there is no second try, and what was found at the first ends it.
TEST(Guard, RestEndsEnergyFromNowhereWhereNothingCanBeTriedAgain) {
  constexpr const char* kProgram = R"(
@use Control.
@use Mobile.
@use RevoluteJoint.
Controller Quiet.
Control : Quiet { }
Mobile : Pushed {
  + to init: self set-force-method to "nudge".
  + to nudge: return (0, 0, 0).
}
)";
  for (const breve_guard guard : {BREVE_GUARD_REPORT, BREVE_GUARD_REFINE, BREVE_GUARD_REST}) {
    World world(1.0 / 60, BREVE_RUNG_BALANCED, kProgram);
    world.set_guard(guard);
    world.set_gravity(Vector3::Zero());
    world.body_class = "Pushed";
    const Chain chain = hang_what_blows_up(world);
    const double begin = world.mechanical();
    int rested = 0, reported = 0;
    for (int i = 0; i < 10; ++i) {
      world.step();
      const std::vector<breve_intervention> told = world.interventions();
      EXPECT_EQ(count(told, kUnexplained, "refined"), 0);
      reported += count(told, kUnexplained, "reported");
      rested += count(told, kUnexplained, "put to rest");
      if (guard != BREVE_GUARD_REST) continue;
      EXPECT_EQ(world.velocity(chain.links[0]), Vector3::Zero());
      EXPECT_EQ(world.spin(chain.links[0]), Vector3::Zero());
      EXPECT_LE(world.mechanical(), begin * (1 + 1e-12));
    }
    EXPECT_EQ(rested, guard == BREVE_GUARD_REST ? 10 : 0);
    EXPECT_EQ(reported > 0, guard != BREVE_GUARD_REST);
    EXPECT_EQ(world.mechanical() > 2 * begin, guard != BREVE_GUARD_REST);
  }
}

}  // namespace
}  // namespace breve::reference
