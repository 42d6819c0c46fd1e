// Four-bar linkages through breve.h: for seconds on end, through positions in which they may fold either way, and as
// loops that no world holds, which fall on a floor and come to rest there.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "scenes.hpp"

namespace breve::reference {
namespace {

constexpr double kClosed = 1e-9;  // m, what a ring may be open at the end of a step

/// What a run of a linkage showed.
struct Followed {
  double open = 0;                 // m, at most
  double gained = 0, lost = 0;     // J, at most
  double moving = 0;               // J, the most kinetic energy
  double rotated = 0, spread = 0;  // rad: of the crank, at the end and between its ends
};

/// A crank of 0.4 m, a coupler of 1 m and a rocker of 0.8 m on pivots that are 1 m apart: by Grashof's rule the crank
/// can turn all the way round, and no position is singular. Each is a uniform rod of 1 kg.
struct CrankRocker : World {
  Hinge loop;
  breve_object crank{};
  CrankRocker(breve_rung rung, double angle, double rate) : World(1.0 / 60, rung) {
    set_guard(BREVE_GUARD_REPORT);
    constexpr double kCrank = 0.4, kCoupler = 1, kRocker = 0.8;
    const Vector3 pivot = Vector3::Zero(), far = Vector3::UnitX();
    const Vector3 tip = kCrank * Vector3(std::cos(angle), std::sin(angle), 0);
    const double way = (far - tip).norm(), along = (kCoupler * kCoupler - kRocker * kRocker + way * way) / (2 * way);
    const Vector3 u = (far - tip) / way, across(-u.y(), u.x(), 0);
    const Vector3 knee = tip + along * u + std::sqrt(kCoupler * kCoupler - along * along) * across;
    const Bar first(*this, pivot, tip, 1), second(*this, tip, knee, 1), third(*this, far, knee, 1);
    crank = join(pin(nullptr, pivot, first, first.begin()));
    const breve_object rocker = join(pin(nullptr, far, third, third.begin()));
    const breve_object coupler = join(pin(&first, first.end(), second, second.begin()));
    loop = pin(&second, second.end(), third, third.end());
    EXPECT_TRUE(read(join(loop)).loop);
    // The velocity of the knee, seen from both sides, gives the rates of coupler and rocker.
    const auto rotated = [](const Vector3& arm) { return Vector3(-arm.y(), arm.x(), 0); };
    const Vector3 by_crank = rotated(tip - pivot), by_coupler = rotated(knee - tip), by_rocker = rotated(knee - far);
    const double whole = by_coupler.cross(by_rocker).z();
    const double second_rate = -rate * by_crank.cross(by_rocker).z() / whole;
    const double third_rate = rate * by_coupler.cross(by_crank).z() / whole;
    set_joint(crank, 0, rate);
    set_joint(coupler, 0, second_rate - rate);
    set_joint(rocker, 0, third_rate);
  }
};

/// Three bars of 1 m on pivots that are 1 m apart: where they lie in one line, twice a turn, they may fold either way.
struct Parallelogram : World {
  Hinge loop;
  breve_object crank{};
  Parallelogram(breve_rung rung, double angle) : World(1.0 / 60, rung) {
    set_guard(BREVE_GUARD_REPORT);
    const Vector3 pivot = Vector3::Zero(), far = Vector3::UnitX(), arm(std::cos(angle), std::sin(angle), 0);
    const Bar first(*this, pivot, pivot + arm, 1), second(*this, pivot + arm, far + arm, 1),
        third(*this, far, far + arm, 1);
    crank = join(pin(nullptr, pivot, first, first.begin()));
    join(pin(nullptr, far, third, third.begin()));
    join(pin(&first, first.end(), second, second.begin()));
    loop = pin(&second, second.end(), third, third.end());
    EXPECT_TRUE(read(join(loop)).loop);
  }
};

template <class Linkage>
Followed follow_linkage(Linkage& linkage, double seconds) {
  Followed out;
  const double begin = linkage.mechanical();
  double low = linkage.read(linkage.crank).position[0], high = low;
  linkage.run(seconds, [&] {
    const double change = linkage.mechanical() - begin;
    out.gained = std::max(out.gained, change);
    out.lost = std::max(out.lost, -change);
    out.open = std::max(out.open, linkage.open(linkage.loop));
    out.moving = std::max(out.moving, linkage.energy().kinetic);
    out.rotated = linkage.read(linkage.crank).position[0];
    low = std::min(low, out.rotated);
    high = std::max(high, out.rotated);
  });
  out.spread = high - low;
  std::printf("  %3.0f s: open %.0e, energy %+.1e and %+.1e of %.1f J, crank over %.2f rad, %.1f sub-steps, %lu told\n",
              seconds, out.open, out.gained, -out.lost, out.moving, out.spread, linkage.toll().per_iteration(),
              linkage.toll().interventions);
  EXPECT_LE(out.open, kClosed);
  return out;
}

struct Promise {
  breve_rung rung;
  double energy;  // of the most that was in motion
};
constexpr Promise kPromises[] = {
    {BREVE_RUNG_FAST, 0.01}, {BREVE_RUNG_BALANCED, 1e-4}, {BREVE_RUNG_PRECISE, 1e-4}, {BREVE_RUNG_CONSERVING, 0.05}};

TEST(Linkages, AFourBarKeepsItsEnergyForTenSeconds) {
  for (const Promise& promise : kPromises) {
    CrankRocker linkage(promise.rung, 1, 8);
    const Followed seen = follow_linkage(linkage, 10);
    EXPECT_LE(std::max(seen.gained, seen.lost), promise.energy * seen.moving);
    EXPECT_EQ(linkage.toll().interventions, 0U);
    EXPECT_GT(seen.spread, 10 * kPi);  // all the way round, again and again
  }
}

/// Hanging, it swings through 1.2 rad to either side and folds nowhere.
TEST(Linkages, AParallelogramThatSwingsKeepsItsEnergyForTenSeconds) {
  for (const Promise& promise : kPromises) {
    Parallelogram linkage(promise.rung, -kPi / 2 + 1.2);
    const Followed seen = follow_linkage(linkage, 10);
    EXPECT_LE(std::max(seen.gained, seen.lost), promise.energy * seen.moving);
    EXPECT_NEAR(seen.spread, 2.4, 0.01);
  }
}

/// Where it lies in one line the impulse that would keep it closed has no bound. It may lose energy there, but it may
/// not gain any.
TEST(Linkages, AParallelogramGainsNothingWhereItMayFoldEitherWay) {
  for (const Promise& promise : kPromises) {
    for (const double lean : {0.05, 0.1, 0.2}) {
      Parallelogram linkage(promise.rung, kPi / 2 - lean);
      const Followed seen = follow_linkage(linkage, 60);
      EXPECT_EQ(linkage.toll().interventions, 0U);
      EXPECT_LE(seen.gained, 0.01 * seen.moving);
      EXPECT_GT(seen.moving, 35);  // J, as it hangs straight down: it went through
      EXPECT_GT(seen.spread, kPi);
    }
  }
}

/// `reference` steps up to the pose in which the forces that hold the loop have a pole, and leaps over it.
TEST(Linkages, ReferencePassesThePoseInWhichALoopMayFoldEitherWay) {
  for (const double lean : {0.05, 0.1, 0.2, 0.3}) {
    Parallelogram linkage(BREVE_RUNG_REFERENCE, kPi / 2 - lean);
    const Followed seen = follow_linkage(linkage, 10);
    EXPECT_EQ(linkage.toll().interventions, 0U);
    EXPECT_LE(std::max(seen.gained, seen.lost), 1e-4 * seen.moving);
    EXPECT_GT(seen.moving, 35);
    EXPECT_GT(seen.spread, kPi);
  }
}

/// Four bars of 1 m, 1 kg and 5 cm in a rhombus that hangs on nothing.
struct Loop : World {
  std::array<breve_object, 4> bars{};
  std::array<Hinge, 4> hinges;
  Loop(breve_rung rung, const Quaternion& orientation, double height, double restitution) : World(1.0 / 60, rung) {
    set_guard(BREVE_GUARD_REPORT);
    set_material(incline(*this, 0), 0.5, restitution);
    constexpr double kLean = 0.3, kThick = 0.05;
    const Vector3 across(std::sin(kLean), std::cos(kLean), 0);
    const Vector3 corners[] = {Vector3::Zero(), Vector3::UnitX(), Vector3::UnitX() + across, across};
    std::array<Quaternion, 4> orientations;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector3 &from = corners[i], &to = corners[(i + 1) % 4], way = to - from;
      const double angle = std::atan2(way.y(), way.x()) - kPi / 2;
      orientations[i] = orientation * Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
      bars[i] = body(box(Vector3(kThick, 1, kThick), 1), orientation * (0.5 * (from + to)) + Vector3(0, height, 0),
                     orientations[i]);
      set_material(bars[i], 0.5, restitution);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t next = (i + 1) % 4;
      hinges[i].parent = bars[i];
      hinges[i].child = bars[next];
      hinges[i].parent_point = Vector3(0, 0.5, 0);
      hinges[i].child_point = Vector3(0, -0.5, 0);
      hinges[i].normal = -Vector3::UnitZ();
      hinges[i].rotation = orientations[i].conjugate() * orientations[next];
      EXPECT_EQ(read(join(hinges[i])).loop, i == 3);
    }
  }
  double widest() const {
    double most = 0;
    for (const Hinge& hinge : hinges) most = std::max(most, open(hinge));
    return most;
  }
  /// Sines of the angles between the bars' axes, which the hinges keep parallel.
  double bent() const {
    double most = 0;
    for (const Hinge& hinge : hinges) {
      const Vector3 a = World::orientation(hinge.parent) * Vector3::UnitZ(),
                    b = World::orientation(hinge.child) * Vector3::UnitZ();
      most = std::max(most, a.cross(b).norm());
    }
    return most;
  }
  double fastest() const {
    double most = 0;
    for (const breve_object bar : bars) most = std::max({most, velocity(bar).norm(), spin(bar).norm()});
    return most;
  }
  double lowest() const {
    double least = INFINITY;
    for (const breve_object bar : bars) least = std::min(least, at(bar).y());
    return least;
  }
};

void drop_loop(const char* name, breve_rung rung, const Quaternion& orientation, double restitution) {
  Loop loop(rung, orientation, 0.7, restitution);
  const double begin = loop.mechanical(), lying = 4 * 9.81 * 0.025;
  double most = 0, open = 0, bent = 0, rested = 0;
  loop.run(4, [&] {
    most = std::max(most, loop.mechanical() - begin);
    open = std::max(open, loop.widest());
    bent = std::max(bent, loop.bent());
    if (loop.fastest() > 0.01) rested = loop.time();
  });
  std::printf(
      "  %-6s e %.1f: at rest after %.2f s, open %.0e, bent %.0e, energy %+.1e of %.1f J, at the end %.4f, %lu told\n",
      name, restitution, rested, open, bent, most, begin, loop.mechanical(), loop.toll().interventions);
  EXPECT_LE(open, kClosed);
  EXPECT_LE(bent, kClosed);
  EXPECT_LE(most, 0.01 * (begin - lying));
  EXPECT_LT(rested, 3);
  EXPECT_LE(loop.fastest(), 1e-3);
  // All of it lies on the floor, half of a bar's thickness above it, within a millimetre.
  EXPECT_NEAR(loop.lowest(), 0.025, 1e-3);
  EXPECT_NEAR(loop.mechanical(), lying, 4 * 9.81 * 1e-3);
}

TEST(Linkages, ALoopThatFallsOnAFloorStaysClosedAndComesToRest) {
  const Quaternion flat(Eigen::AngleAxisd(kPi / 2, Vector3::UnitX()));
  const Quaternion tilted(Eigen::AngleAxisd(0.7, Vector3(1, 0.3, 0.2).normalized()));
  for (const breve_rung rung : {BREVE_RUNG_FAST, BREVE_RUNG_BALANCED, BREVE_RUNG_PRECISE, BREVE_RUNG_CONSERVING}) {
    for (const double restitution : {0.0, 0.5}) {
      drop_loop("lying", rung, flat, restitution);
      drop_loop("upright", rung, Quaternion::Identity(), restitution);
      drop_loop("tilted", rung, tilted, restitution);
    }
  }
}

}  // namespace
}  // namespace breve::reference
