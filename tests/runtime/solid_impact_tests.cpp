// First touch of moving solids against closed forms, reference values and dense sampling.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numbers>
#include <string>

#include "runtime/solid/contact.hpp"
#include "tests/runtime/solid_oracle.hpp"

namespace breve {
namespace {

constexpr double kPromise = 1e-9;  // of the interval

/// case -> time as text, from the reference file.
std::map<std::string, std::string> reference_times() {
  std::ifstream file(std::string(BREVE_TEST_DATA) + "/reference/time_of_impact.csv");
  std::map<std::string, std::string> times;
  for (std::string line; std::getline(file, line);) {
    const auto first = line.find(','), second = line.find(',', first + 1);
    if (second != std::string::npos) times[line.substr(0, first)] = line.substr(first + 1, second - first - 1);
  }
  return times;
}

double reference(const std::string& name) {
  const auto times = reference_times();
  const auto found = times.find(name);
  EXPECT_NE(found, times.end()) << name << " is not in the reference file";
  return found == times.end() ? 0 : std::strtod(found->second.c_str(), nullptr);
}

Motion still(const Vector3& at) { return {{at, Quaternion::Identity()}, Vector3::Zero(), Vector3::Zero()}; }
Motion moving(const Vector3& at, const Vector3& velocity) {
  return {{at, Quaternion::Identity()}, velocity, Vector3::Zero()};
}

TEST(TimeOfImpact, SpheresMatchTheReference) {
  double t = 0;
  Contact contact;
  ASSERT_TRUE(time_of_impact(*Shape::sphere(0.4), moving(Vector3::Zero(), Vector3(3, 1, 0)), *Shape::sphere(0.6),
                             still(Vector3(10, 3.8, 0)), 10, t, contact));
  const double expected = reference("sphere_sphere");
  EXPECT_NEAR(t, expected, 4e-16 * expected * 4);
  EXPECT_NEAR(contact.distance, 0, 1e-14);
}

TEST(TimeOfImpact, AGrazeHitsAndANearMissMisses) {
  const auto ball = Shape::sphere(0.5);
  const Motion a = moving(Vector3::Zero(), Vector3(7, 0, 0));
  double t = 0;
  Contact contact;
  ASSERT_TRUE(time_of_impact(*ball, a, *ball, still(Vector3(10, 0.9999999, 0)), 2, t, contact));
  // 0.9999999 itself is rounded: its last bit moves this time by 4e-14.
  EXPECT_NEAR(t, reference("graze_hit"), 1e-12);
  ASSERT_EQ(reference_times()["graze_miss"], "miss");
  EXPECT_FALSE(time_of_impact(*ball, a, *ball, still(Vector3(10, 1.0000001, 0)), 2, t, contact));
}

TEST(TimeOfImpact, IsANumberWhereSquaresOfDistancesAreNone) {
  const auto ball = Shape::sphere(0.5);
  const auto box = Shape::box(Vector3(1, 1, 1));
  double t = 0;
  Contact contact;
  ASSERT_TRUE(time_of_impact(*ball, moving(Vector3::Zero(), Vector3(4e200, 0, 0)), *ball, still(Vector3(1e200, 0, 0)),
                             1, t, contact));
  EXPECT_NEAR(t, 0.25, 1e-12);
  EXPECT_FALSE(time_of_impact(*ball, moving(Vector3::Zero(), Vector3(4e200, 0, 0)), *ball,
                              still(Vector3(1e200, 1e190, 0)), 1, t, contact));
  const double speeds[] = {1, 1e160, 1e301, 1.5e308}, places[] = {1e160, 1e300, 1.5e308};
  for (const Shape* shape : {ball.get(), box.get()})
    for (const double speed : speeds)
      for (const double place : places)
        for (const double aside : {0.0, 0.3, 1e155, 1e300}) {
          t = 0.5;
          const Motion a = moving(Vector3(-place, 0, 0), Vector3(speed, -aside, 0));
          const Motion b = moving(Vector3(place, aside, 0), Vector3(-speed, 0, aside));
          time_of_impact(*shape, a, *ball, b, 1, t, contact);
          EXPECT_TRUE(t >= 0 && t <= 1) << t << ' ' << speed << ' ' << place << ' ' << aside;
        }
}

TEST(TimeOfImpact, ABulletMeetsAThinWall) {
  double t = 0;
  Contact contact;
  ASSERT_TRUE(time_of_impact(*Shape::sphere(0.01), moving(Vector3::Zero(), Vector3(1000, 0, 0)),
                             *Shape::box(Vector3(0.001, 4, 4)), still(Vector3(5, 0, 0)), 1.0 / 60, t, contact));
  EXPECT_NEAR(t, reference("bullet"), kPromise / 60);
  EXPECT_LE((contact.normal - Vector3(-1, 0, 0)).norm(), 1e-12);
}

/// A body that falls freely for `from` seconds and then, until the reference time, follows the chord of its parabola:
/// at the reference time it is exactly where the falling body is.
Motion falling(const Vector3& start, double speed, const Quaternion& rotated, const Vector3& spin, double from,
               double to) {
  const auto at = [&](double t) { return Vector3(start + Vector3(0, 0, speed * t - 9.81 * t * t / 2)); };
  const Pose pose = pose_at({{at(from), rotated}, Vector3::Zero(), spin}, from);
  return {{at(from), pose.orientation}, (at(to) - at(from)) / (to - from), spin};
}

void expect_fall_hits(const Shape& shape, const Vector3& start, double speed, const Quaternion& rotated,
                      const Vector3& spin, double expected, double accuracy) {
  const auto floor = Shape::box(Vector3(100, 100, 2));
  const double from = expected - 0.02;
  Motion motion = falling(start, speed, rotated, spin, from, expected);
  motion.start.orientation = pose_at({{start, rotated}, Vector3::Zero(), spin}, from).orientation;
  double t = 0;
  Contact contact;
  ASSERT_TRUE(time_of_impact(shape, motion, *floor, still(Vector3(0, 0, -1)), 0.04, t, contact));
  EXPECT_NEAR(from + t, expected, accuracy);
  EXPECT_LE((contact.normal - Vector3::UnitZ()).norm(), 1e-9);
}

TEST(TimeOfImpact, FallingBodiesMatchTheReference) {
  expect_fall_hits(*Shape::sphere(0.5), Vector3(0, 0, 10), 0, Quaternion::Identity(), Vector3::Zero(),
                   reference("sphere_drop"), kPromise * 0.04);
  expect_fall_hits(*Shape::box(Vector3(1, 0.6, 0.4)), Vector3(0, 0, 1.5), -2,
                   Quaternion(Eigen::AngleAxisd(0.2, Vector3::UnitY())), Vector3(0, 15, 0), reference("spinning_box"),
                   kPromise * 0.04);
  // The reference rod has no thickness; 1e-9 of thickness over a speed of some 8 m/s is 1e-10 s.
  expect_fall_hits(*Shape::box(Vector3(1e-9, 1e-9, 1)), Vector3(0, 0, 2), 0,
                   Quaternion(Eigen::AngleAxisd(0.3, Vector3::UnitY())), Vector3(0, 10, 0), reference("spinning_rod"),
                   2e-10);
}

TEST(TimeOfImpact, ATurningArmMeetsAPeg) {
  // The reference arm rotates about its end: here a rod of twice the length rotates about its middle.
  double t = 0;
  Contact contact;
  Motion arm = still(Vector3::Zero());
  arm.rotational_velocity_world = Vector3(0, 0, 4);
  const double thickness = 1e-10;
  ASSERT_TRUE(time_of_impact(*Shape::box(Vector3(2, thickness, thickness)), arm, *Shape::sphere(0.05),
                             still(Vector3(0, 0.8, 0)), 1, t, contact));
  EXPECT_NEAR(t, reference("arm_on_peg"), 1e-9);
}

TEST(TimeOfImpact, BoxesInTranslationInClosedForm) {
  oracle::Dice dice(11);
  for (int i = 0; i < 500; ++i) {
    const Vector3 ha(dice.between(0.1, 1), dice.between(0.1, 1), dice.between(0.1, 1));
    const Vector3 hb(dice.between(0.1, 1), dice.between(0.1, 1), dice.between(0.1, 1));
    const Vector3 at = dice.vector(5), v = -at + dice.vector(2);
    // Slabs: the ray from `at` along v against the box of half size ha + hb.
    double first = 0, last = 1e9;
    for (int k = 0; k < 3; ++k) {
      const double h = ha[k] + hb[k], t0 = (-h - at[k]) / v[k], t1 = (h - at[k]) / v[k];
      first = std::max(first, std::min(t0, t1));
      last = std::min(last, std::max(t0, t1));
    }
    const bool inside = (at.cwiseAbs() - ha - hb).maxCoeff() <= 0;
    const bool hits = !inside && first < last && first < 3;
    double t = 0;
    Contact contact;
    ASSERT_EQ(
        time_of_impact(*Shape::box(2 * ha), still(Vector3::Zero()), *Shape::box(2 * hb), moving(at, v), 3, t, contact),
        hits)
        << "case " << i;
    if (!hits) continue;
    ASSERT_NEAR(t, first, kPromise * 3) << "case " << i;
  }
}

struct Scene {
  std::shared_ptr<Shape> a, b;
  Motion ma, mb;
  double gap(double t) const { return closest(*a, pose_at(ma, t), *b, pose_at(mb, t)).distance; }
};

/// The first time of zero gap: dense sampling, then bisection. Negative if no sample overlaps.
double sampled_impact(const Scene& scene, double h, int samples) {
  for (int i = 1; i <= samples; ++i) {
    double high = h * i / samples;
    if (scene.gap(high) > 0) continue;
    double low = h * (i - 1) / samples;
    for (int k = 0; k < 60; ++k) (scene.gap((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
    return high;
  }
  return -1;
}

TEST(TimeOfImpact, TumblingSolidsNeverTunnelAndStopAtTheFirstTouch) {
  oracle::Dice dice(12);
  constexpr double h = 0.5;
  constexpr int kSamples = 400;
  int hits = 0, sharper = 0;
  for (int i = 0; i < 600; ++i) {
    Scene s{dice.polyhedron(i), i % 6 == 5 ? Shape::sphere(dice.between(0.1, 1)) : dice.polyhedron(i / 4), {}, {}};
    s.ma = {{Vector3::Zero(), dice.rotation()}, Vector3::Zero(), dice.vector(20)};
    const Vector3 at = dice.between(1.2, 5) * dice.direction();
    s.mb = {{at, dice.rotation()}, -at * dice.between(0, 5) + dice.vector(3), dice.vector(20)};
    double t = 0;
    Contact contact;
    const bool start_apart = s.gap(0) > 1e-9;
    const bool hit = time_of_impact(*s.a, s.ma, *s.b, s.mb, h, t, contact);
    if (!start_apart) {
      ASSERT_FALSE(hit);
      continue;
    }
    const double expected = sampled_impact(s, h, kSamples);
    ASSERT_TRUE(hit || expected < 0) << "missed a touch in case " << i;
    if (!hit) continue;
    ++hits;
    ASSERT_NEAR(s.gap(t), 0, 1e-11) << "case " << i;
    ASSERT_TRUE(expected < 0 || t <= expected + kPromise * h) << "case " << i;
    // Earlier than the samples say is right only for a touch that falls between two samples.
    if (expected >= 0 && t > expected - kPromise * h) continue;
    ++sharper;
    bool open = true;
    for (int k = 0; k < kSamples; ++k) open = open && s.gap(t * k / kSamples) > 0;
    ASSERT_TRUE(open) << "case " << i;
  }
  EXPECT_GT(hits, 200);
  EXPECT_LT(sharper, hits / 5);
}

TEST(TimeOfImpact, WhatStaysApartAlongAnAxisIsNeverHit) {
  oracle::Dice dice(13);
  int apart = 0, far = 0;
  for (int i = 0; i < 2000; ++i) {
    const double h = dice.between(0.01, 0.2);
    Scene s{dice.polyhedron(i), i % 6 == 5 ? Shape::sphere(dice.between(0.1, 1)) : dice.polyhedron(i / 4), {}, {}};
    s.ma = {{Vector3::Zero(), dice.rotation()}, Vector3::Zero(), dice.vector(5)};
    const Vector3 at = dice.between(1.2, 5) * dice.direction();
    s.mb = {{at, dice.rotation()}, -at * dice.between(0, 5) + dice.vector(3), dice.vector(5)};
    // The axis of the closest points at the start, or any.
    const Contact start = closest(*s.a, s.ma.start, *s.b, s.mb.start);
    const Vector3 world = i % 5 == 0 ? dice.direction() : start.normal;
    double t = 0;
    Contact contact;
    const bool hit = time_of_impact(*s.a, s.ma, *s.b, s.mb, h, t, contact);
    far += start.distance > 0 && !hit;
    if (!stay_apart(*s.a, s.ma, *s.b, s.mb, h, s.ma.start.orientation.conjugate() * world)) continue;
    ++apart;
    ASSERT_FALSE(hit) << "case " << i;
    ASSERT_GT(s.gap(0), 0) << "case " << i;
    ASSERT_GT(s.gap(h), 0) << "case " << i;
  }
  EXPECT_GT(apart, far / 2);  // worth asking
}

TEST(TimeOfImpact, RotationAloneBringsATouch) {
  // A rod turning at 4 rad/s next to a wall at distance 0.3 from its middle: the tip arrives at asin(0.3/0.5).
  const auto rod = Shape::box(Vector3(1, 1e-9, 1e-9)), wall = Shape::box(Vector3(4, 1, 4));
  Motion rotating = still(Vector3::Zero());
  rotating.rotational_velocity_world = Vector3(0, 0, 4);
  double t = 0;
  Contact contact;
  ASSERT_TRUE(time_of_impact(*rod, rotating, *wall, still(Vector3(0, 0.8, 0)), 1, t, contact));
  EXPECT_NEAR(t, std::asin(0.6) / 4, 1e-9);
}

TEST(TimeOfImpact, AStartInTouchOrOverlapIsNoImpact) {
  const auto box = Shape::box(Vector3(1, 1, 1)), ball = Shape::sphere(0.5);
  double t = -1;
  Contact contact;
  const Vector3 toward(-1, 0, 0);
  EXPECT_FALSE(time_of_impact(*box, still(Vector3::Zero()), *box, moving(Vector3(1, 0, 0), toward), 1, t, contact));
  EXPECT_FALSE(time_of_impact(*ball, still(Vector3::Zero()), *ball, moving(Vector3(1, 0, 0), toward), 1, t, contact));
  EXPECT_FALSE(time_of_impact(*ball, still(Vector3::Zero()), *box, moving(Vector3(1, 0, 0), toward), 1, t, contact));
  EXPECT_FALSE(time_of_impact(*ball, still(Vector3::Zero()), *box, moving(Vector3(0.3, 0, 0), toward), 1, t, contact));
  EXPECT_EQ(t, -1);
}

TEST(TimeOfImpact, AfterAnImpactThePairCountsAsTouching) {
  oracle::Dice dice(13);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const auto a = i % 3 == 0 ? Shape::sphere(0.5) : dice.polyhedron(i),
               b = i % 2 == 0 ? Shape::sphere(0.3) : dice.polyhedron(i / 4);
    const Vector3 position = dice.vector(100), at = 3 * dice.direction();
    Motion ma{{position, dice.rotation()}, Vector3::Zero(), dice.vector(5)};
    Motion mb{{position + at, dice.rotation()}, -at * 2, dice.vector(5)};
    double t = 0, again = 0;
    Contact contact;
    if (!time_of_impact(*a, ma, *b, mb, 1, t, contact)) continue;
    ++hits;
    ma.start = pose_at(ma, t);
    mb.start = pose_at(mb, t);
    ASSERT_FALSE(time_of_impact(*a, ma, *b, mb, 1 - t, again, contact)) << "case " << i << " again after " << again;
  }
  EXPECT_GT(hits, 200);
}

TEST(TimeOfImpact, GrazingAndSlidingContactEnds) {
  const auto box = Shape::box(Vector3(1, 1, 1));
  double t = 0;
  Contact contact;
  // Faces slide past one another at 1e-9: no touch. Corners of a spinning box pass a wall at a hair's breadth.
  EXPECT_FALSE(time_of_impact(*box, still(Vector3::Zero()), *box, moving(Vector3(-3, 1 + 1e-9, 0), Vector3(6, 0, 0)), 1,
                              t, contact));
  Motion spinning = still(Vector3::Zero());
  spinning.rotational_velocity_world = Vector3(0, 0, 10);
  const double corner = std::numbers::sqrt2 / 2;
  for (const double gap : {1e-4, 1e-7, 1e-10}) {
    EXPECT_FALSE(time_of_impact(*box, spinning, *Shape::box(Vector3(4, 1, 4)), still(Vector3(0, corner + 0.5 + gap, 0)),
                                1, t, contact))
        << gap;
    EXPECT_TRUE(time_of_impact(*box, spinning, *Shape::box(Vector3(4, 1, 4)), still(Vector3(0, corner + 0.5 - gap, 0)),
                               1, t, contact))
        << gap;
    EXPECT_NEAR(t, (std::numbers::pi / 4 - std::acos((corner - gap) / corner)) / 10, kPromise) << gap;
  }
}

TEST(TimeOfImpact, BodiesAtRestNeverTouch) {
  double t = 0;
  Contact contact;
  const auto box = Shape::box(Vector3(1, 1, 1));
  EXPECT_FALSE(time_of_impact(*box, still(Vector3::Zero()), *box, still(Vector3(0, 2, 0)), 1, t, contact));
  EXPECT_FALSE(
      time_of_impact(*box, still(Vector3::Zero()), *box, moving(Vector3(0, 2, 0), Vector3(0, 1, 0)), 1, t, contact));
}

TEST(TimeOfImpact, ATouchExactlyAtTheEndIsDelivered) {
  double t = 0;
  Contact contact;
  const auto box = Shape::box(Vector3(1, 1, 1)), ball = Shape::sphere(0.5);
  for (const auto& other : {box, ball}) {
    ASSERT_TRUE(time_of_impact(*ball, still(Vector3::Zero()), *other, moving(Vector3(2, 0, 0), Vector3(-1, 0, 0)), 1, t,
                               contact));
    EXPECT_NEAR(t, 1, 1e-11);
  }
}

}  // namespace
}  // namespace breve
