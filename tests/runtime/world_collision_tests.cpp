// Collision handlers of kinematic and stationary bodies: when, where, in which order, and what happens next.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/runtime/fake_behaviour.hpp"

namespace breve {
namespace {

using testing::Scene;
using Calls = std::vector<std::string>;

constexpr ClassId kBall = 1, kWall = 2, kOther = 3;
constexpr double kExact = 1e-9;  // s or length units: spheres have a closed form

Calls collisions(const Scene& s) {
  Calls result;
  for (const std::string& call : s.script.calls) {
    if (call.starts_with("collided")) result.push_back(call);
  }
  return result;
}

TEST(Collision, TheFirstTouchComesAtItsTimeOfImpactWithBothStandingThere) {
  Scene s;
  const ObjectId a = s.body(kBall, Vector3(0, 0, 0));
  const ObjectId b = s.body(kBall, Vector3(2.05, 0, 0));
  s.set_velocity(a, Vector3(1, 0, 0));
  s.world.handle_collisions(kBall, kBall, "hit", a);
  bool seen = false;
  s.script.on_collided = [&](ObjectId me, ObjectId other, const Vector3& point, const Vector3& normal) {
    if (seen) return true;
    seen = true;
    EXPECT_EQ(me, a) << "the one created earlier is first";
    EXPECT_EQ(other, b);
    EXPECT_NEAR(s.world.time(), 0.05, kExact);
    EXPECT_NEAR(s.at(a).x(), 0.05, kExact);
    EXPECT_LT((point - Vector3(1.05, 0, 0)).norm(), kExact);
    EXPECT_LT((normal - Vector3(-1, 0, 0)).norm(), kExact) << "from the other toward me";
    return true;
  };
  s.world.step();
  EXPECT_TRUE(seen);
  EXPECT_NEAR(s.at(a).x(), 0.06, 1e-15) << "a handler that changes nothing leaves the motion exactly as it was";
  EXPECT_EQ(s.world.time(), 0.06);
}

TEST(Collision, AMotionThatNoHandlerTouchesIsBitEqualToOneWithoutHandlers) {
  const auto run = [](bool handled) {
    Scene s(3);
    std::vector<ObjectId> balls;
    for (int i = 0; i < 40; ++i) {
      Random& r = s.world.random();
      balls.push_back(s.body(kBall, Vector3(r.uniform(), r.uniform(), r.uniform()) * 8));
      const BodyIndex b = s.world.body(balls.back());
      s.world.bodies().set_velocity(b, Vector3(r.gauss(), r.gauss(), r.gauss()) * 5);
      s.world.bodies().set_acceleration(b, Vector3(r.gauss(), r.gauss(), r.gauss()));
      s.world.bodies().set_rotational_velocity(b, Vector3(r.gauss(), r.gauss(), r.gauss()) * 3);
    }
    if (handled) s.world.handle_collisions(kBall, kBall, "hit", {});
    for (int i = 0; i < 20; ++i) s.world.step();
    Hasher hasher;
    for (const ObjectId id : balls) s.world.bodies().hash(hasher, s.world.body(id));
    EXPECT_EQ(collisions(s).empty(), !handled);
    return hasher.value();
  };
  EXPECT_EQ(run(true), run(false));
}

TEST(Collision, AParticleThatStopsOnTouchEndsAtTheSumOfTheRadii) {
  Scene s(2);
  const auto grain = Shape::sphere(0.5);
  const ObjectId seed = s.body(kOther, Vector3::Zero(), BodyKind::Stationary, grain);
  std::vector<ObjectId> particles;
  for (int i = 0; i < 50; ++i) {
    Random& r = s.world.random();
    const Vector3 from = Vector3(r.gauss(), r.gauss(), r.gauss()).normalized() * 10;
    const ObjectId id = s.body(kBall, from, BodyKind::Mobile, grain);
    s.set_velocity(id, -from.normalized() * (5 + 40 * r.uniform()));
    particles.push_back(id);
  }
  s.world.handle_collisions(kBall, kOther, "stick", {});
  s.script.on_collided = [&](ObjectId me, ObjectId, const Vector3&, const Vector3&) {
    s.set_velocity(me, Vector3::Zero());
    return false;
  };
  for (int i = 0; i < 60; ++i) s.world.step();
  for (const ObjectId id : particles) EXPECT_NEAR((s.at(id) - s.at(seed)).norm(), 1.0, kExact);
}

TEST(Collision, AParticleThatStoppedKeepsTouching) {
  Scene s;
  const ObjectId wall = s.body(kWall, Vector3(5, 0, 0), BodyKind::Stationary, Shape::box(Vector3(1, 10, 10)));
  const ObjectId ball = s.body(kBall, Vector3::Zero());
  s.set_velocity(ball, Vector3(10, 0.3, 0.1));
  s.world.handle_collisions(kBall, kWall, "stick", {});
  s.script.on_collided = [&](ObjectId me, ObjectId, const Vector3&, const Vector3&) {
    s.set_velocity(me, Vector3::Zero());
    return false;
  };
  for (int i = 0; i < 10; ++i) s.world.step();
  EXPECT_NEAR(s.at(ball).x(), 3.5, 1e-8);
  s.script.calls.clear();
  s.world.step();
  EXPECT_EQ(collisions(s).size(), 3U) << "once per sub-step";
  s.set_velocity(ball, Vector3(-1, 0, 0));
  s.script.calls.clear();
  s.world.step();
  EXPECT_TRUE(collisions(s).empty()) << "and one that moves away is separated";
  static_cast<void>(wall);
}

TEST(Collision, AHandlerThatReversesTheVelocityBouncesExactly) {
  Scene s;
  s.body(kWall, Vector3(5, 0, 0), BodyKind::Stationary, Shape::box(Vector3(1, 10, 10)));
  s.body(kWall, Vector3(-5, 0, 0), BodyKind::Stationary, Shape::box(Vector3(1, 10, 10)));
  const ObjectId ball = s.body(kBall, Vector3::Zero());
  s.set_velocity(ball, Vector3(7, 0, 0));
  s.world.handle_collisions(kBall, kWall, "bounce", {});
  int bounces = 0;
  s.script.on_collided = [&](ObjectId me, ObjectId, const Vector3&, const Vector3& normal) {
    ++bounces;
    const Vector3 v = s.velocity(me);
    EXPECT_LT(v.dot(normal), 0) << "it approaches";
    s.set_velocity(me, v - 2 * v.dot(normal) * normal);
    return false;
  };
  constexpr int kIterations = 200;  // 12 s, 84 length units between walls 7 apart
  for (int i = 0; i < kIterations; ++i) s.world.step();
  EXPECT_EQ(bounces, 12);
  // A zigzag of period 14 between -3.5 and 3.5.
  double phase = std::fmod(7 * s.world.time() + 3.5, 14.0);
  const double expected = phase <= 7 ? phase - 3.5 : 10.5 - phase;
  EXPECT_NEAR(s.at(ball).x(), expected, 1e-7);
}

TEST(Collision, ManyBouncesWithinOneSubstepAllHappen) {
  Scene s;
  s.body(kWall, Vector3(1.6, 0, 0), BodyKind::Stationary, Shape::box(Vector3(1, 10, 10)));
  s.body(kWall, Vector3(-1.6, 0, 0), BodyKind::Stationary, Shape::box(Vector3(1, 10, 10)));
  const ObjectId ball = s.body(kBall, Vector3::Zero());
  s.set_velocity(ball, Vector3(100, 0, 0));  // 2 length units a sub-step in a gap of 0.2
  s.world.handle_collisions(kBall, kWall, "bounce", {});
  int bounces = 0;
  s.script.on_collided = [&](ObjectId me, ObjectId, const Vector3&, const Vector3& normal) {
    ++bounces;
    s.set_velocity(me, s.velocity(me) - 2 * s.velocity(me).dot(normal) * normal);
    return false;
  };
  s.world.step();
  EXPECT_NEAR(bounces, 30, 1);
  EXPECT_LT(std::abs(s.at(ball).x()), 0.1 + 1e-8);
  EXPECT_EQ(s.world.effects()[EffectId::TimeOfImpact].held, 0U);
}

TEST(Collision, ABodyWithTooManyImpactsInASubstepIsHeldAndCounted) {
  Scene s;
  s.body(kWall, Vector3(1.501, 0, 0), BodyKind::Stationary, Shape::box(Vector3(1, 10, 10)));
  s.body(kWall, Vector3(-1.501, 0, 0), BodyKind::Stationary, Shape::box(Vector3(1, 10, 10)));
  const ObjectId ball = s.body(kBall, Vector3::Zero());
  s.set_velocity(ball, Vector3(1000, 0, 0));
  s.world.handle_collisions(kBall, kWall, "bounce", {});
  s.script.on_collided = [&](ObjectId me, ObjectId, const Vector3&, const Vector3& normal) {
    s.set_velocity(me, s.velocity(me) - 2 * s.velocity(me).dot(normal) * normal);
    return false;
  };
  s.world.step();
  EXPECT_EQ(s.world.effects()[EffectId::TimeOfImpact].held, 3U);
  EXPECT_LT(std::abs(s.at(ball).x()), 0.0011);
}

TEST(Collision, HeadOnEqualPairsSwapVelocitiesInTheMiddle) {
  Scene s;
  const ObjectId a = s.body(kBall, Vector3(-3, 0, 0));
  const ObjectId b = s.body(kBall, Vector3(3, 0, 0));
  s.set_velocity(a, Vector3(50, 0, 0));
  s.set_velocity(b, Vector3(-50, 0, 0));
  s.world.handle_collisions(kBall, kBall, "swap", {});
  s.script.on_collided = [&](ObjectId x, ObjectId y, const Vector3& point, const Vector3&) {
    EXPECT_LT(point.norm(), kExact);
    const Vector3 v = s.velocity(x);
    s.set_velocity(x, s.velocity(y));
    s.set_velocity(y, v);
    return true;  // once for the pair
  };
  s.world.step();
  EXPECT_EQ(collisions(s).size(), 1U);
  EXPECT_NEAR(s.at(a).x(), -s.at(b).x(), kExact);
  EXPECT_NEAR(s.at(a).x(), -1 - 50 * (0.06 - 0.04), 1e-7);
}

TEST(Collision, AFastSmallBallNeverPassesAThinWallUnnoticed) {
  for (int i = 0; i < 200; ++i) {
    Scene s(static_cast<std::uint64_t>(i) + 1);
    Random& r = s.world.random();
    s.body(kWall, Vector3::Zero(), BodyKind::Stationary, Shape::box(Vector3(0.001, 10, 10)));
    const ObjectId ball =
        s.body(kBall, Vector3(-3 - r.uniform(), r.uniform(), r.uniform()), BodyKind::Mobile, Shape::sphere(0.01));
    s.set_velocity(ball, Vector3(300 + 700 * r.uniform(), r.gauss(), r.gauss()));
    s.world.bodies().set_rotational_velocity(s.world.body(ball), Vector3(r.gauss(), r.gauss(), r.gauss()) * 20);
    s.world.handle_collisions(kWall, kBall, "hit", {});
    s.world.step();
    EXPECT_EQ(collisions(s).size(), 1U) << i;
  }
}

TEST(Collision, HandlersOfBothClassesRunTheEarlierParticipantFirst) {
  Scene s;
  const ObjectId late = s.world.create(kBall, 0, false, false);
  const ObjectId wall = s.body(kWall, Vector3(2.01, 0, 0), BodyKind::Stationary);
  s.world.embody(late, BodyKind::Mobile);  // the body is younger, the object older
  s.set_velocity(late, Vector3(1, 0, 0));
  s.world.handle_collisions(kBall, kWall, "ball", {});
  s.world.handle_collisions(kWall, kBall, "wall", {});
  s.world.handle_collisions(kWall, kBall, "second", {});
  s.world.ignore_collisions(kBall, kWall);
  s.world.set_iteration_step(0.02);
  s.world.step();
  ASSERT_EQ(late.index, 1U);
  ASSERT_EQ(wall.index, 2U);
  EXPECT_EQ(collisions(s), (Calls{"collided 1 2 ball", "collided 2 1 wall"}));
}

TEST(Collision, TheRestIsSkippedIfAHandlerReturnsTrueOrFreesEither) {
  for (const int what : {0, 1, 2}) {
    Scene s;
    const ObjectId a = s.body(kBall, Vector3::Zero());
    const ObjectId b = s.body(kBall, Vector3(2.01, 0, 0));
    s.set_velocity(a, Vector3(1, 0, 0));
    s.world.handle_collisions(kBall, kBall, "hit", {});
    s.script.on_collided = [&](ObjectId, ObjectId, const Vector3&, const Vector3&) {
      if (what == 1) s.world.release(a);
      if (what == 2) s.world.release(b);
      return what == 0;
    };
    s.world.set_iteration_step(0.02);
    s.world.step();
    EXPECT_EQ(collisions(s).size(), 1U) << what;
    s.world.step();
  }
}

TEST(Collision, FreeingAndCreatingInsideHandlersIsSafe) {
  Scene s(9);
  Random& r = s.world.random();
  s.world.handle_collisions(kBall, kBall, "hit", {});
  const auto make = [&] {
    const ObjectId id =
        s.body(kBall, Vector3(r.uniform(), r.uniform(), r.uniform()) * 6, BodyKind::Mobile, Shape::sphere(0.4));
    s.set_velocity(id, Vector3(r.gauss(), r.gauss(), r.gauss()) * 10);
  };
  for (int i = 0; i < 60; ++i) make();
  s.script.on_collided = [&](ObjectId me, ObjectId other, const Vector3&, const Vector3&) {
    s.world.release(r.uniform() < 0.5 ? me : other);
    make();
    return false;
  };
  for (int i = 0; i < 100; ++i) s.world.step();
  EXPECT_EQ(s.world.bodies().size(), 60U);
  EXPECT_GT(collisions(s).size(), 50U);
}

TEST(Collision, WhileAnOverlapLastsThereIsOneCallPerSubstep) {
  Scene s;
  const ObjectId a = s.body(kBall, Vector3::Zero());
  s.body(kWall, Vector3(2.03, 0, 0), BodyKind::Stationary);
  s.set_velocity(a, Vector3(1, 0, 0));  // touches at 0.03: in the second sub-step
  s.world.handle_collisions(kBall, kWall, "hit", {});
  std::vector<double> times;
  s.script.on_collided = [&](ObjectId, ObjectId, const Vector3&, const Vector3&) {
    times.push_back(s.world.time());
    return false;
  };
  s.world.step();
  s.world.step();
  ASSERT_EQ(times.size(), 5U);
  const double expected[] = {0.03, 0.06, 0.08, 0.10, 0.12};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(times[i], expected[i], kExact);
}

TEST(Collision, BodiesMovedIntoEachOtherAreReportedAtTheEndOfTheSubstep) {
  Scene s;
  const ObjectId a = s.body(kBall, Vector3(10, 0, 0));
  s.body(kBall, Vector3::Zero());
  s.world.handle_collisions(kBall, kBall, "hit", {});
  s.world.step();
  EXPECT_TRUE(collisions(s).empty());
  s.world.bodies().set_location(s.world.body(a), Vector3(0.5, 0, 0));
  s.world.step();
  EXPECT_EQ(collisions(s).size(), 6U) << "both sides, three sub-steps";
  s.script.calls.clear();
  s.world.bodies().set_location(s.world.body(a), Vector3(50, 0, 0));
  s.world.step();
  EXPECT_TRUE(collisions(s).empty());
}

TEST(Collision, ImpactTimingStepCallsAtTheEndOfTheSubstepOnly) {
  Scene s;
  s.world.set_impact_timing(false);
  const ObjectId a = s.body(kBall, Vector3::Zero());
  s.body(kWall, Vector3(2.03, 0, 0), BodyKind::Stationary);
  s.set_velocity(a, Vector3(1, 0, 0));
  s.world.handle_collisions(kBall, kWall, "hit", {});
  std::vector<double> positions;
  s.script.on_collided = [&](ObjectId, ObjectId, const Vector3&, const Vector3&) {
    positions.push_back(s.at(a).x());
    return false;
  };
  s.world.step();
  ASSERT_EQ(positions.size(), 2U);
  EXPECT_NEAR(positions[0], 0.04, 1e-12);
  EXPECT_FALSE(s.world.effects()[EffectId::TimeOfImpact].active);
}

TEST(Collision, MatchesExactClassesNeedsAMobileAndFollowsLaterRegistrations) {
  Scene s;
  s.body(kWall, Vector3::Zero(), BodyKind::Stationary);
  s.body(kWall, Vector3(0.5, 0, 0), BodyKind::Stationary);
  s.body(kOther, Vector3(0.2, 0, 0));
  s.world.handle_collisions(kWall, kWall, "walls", {});
  s.world.step();
  EXPECT_TRUE(collisions(s).empty());
  s.world.handle_collisions(kOther, kWall, "other", {});
  s.world.step();
  EXPECT_EQ(collisions(s).size(), 6U) << "two walls, three sub-steps";
}

TEST(Collision, AHandlerThatPushesAThirdBodySendsItOnFromThatMoment) {
  Scene s;
  const ObjectId a = s.body(kBall, Vector3::Zero());
  s.body(kWall, Vector3(2.01, 0, 0), BodyKind::Stationary);
  const ObjectId third = s.body(kBall, Vector3(100, 0, 0));
  const ObjectId still = s.body(kBall, Vector3(200, 0, 0));
  s.set_velocity(a, Vector3(1, 0, 0));
  s.set_velocity(third, Vector3(1, 0, 0));
  s.world.handle_collisions(kBall, kWall, "hit", {});
  bool first = true;
  s.script.on_collided = [&](ObjectId, ObjectId, const Vector3&, const Vector3&) {
    if (first) {
      s.set_velocity(third, Vector3(0, 10, 0));
      s.set_velocity(still, Vector3(0, 10, 0));
    }
    first = false;
    return false;
  };
  s.world.set_iteration_step(0.02);
  s.world.step();
  EXPECT_LT((s.at(third) - Vector3(100.01, 0.1, 0)).norm(), kExact);
  EXPECT_LT((s.at(still) - Vector3(200, 0.1, 0)).norm(), kExact);
}

TEST(Collision, AnErrorInAHandlerLeavesTheWorldUsableAndTheClockRight) {
  Scene s;
  const ObjectId a = s.body(kBall, Vector3::Zero());
  s.body(kBall, Vector3(2.01, 0, 0));
  s.set_velocity(a, Vector3(1, 0, 0));
  s.world.handle_collisions(kBall, kBall, "hit", {});
  s.script.on_collided = [](ObjectId, ObjectId, const Vector3&, const Vector3&) -> bool {
    throw Error(ErrorCode::Budget, "too long");
  };
  EXPECT_THROW(s.world.step(), Error);
  EXPECT_EQ(s.world.time(), 0.0);
  s.script.on_collided = nullptr;
  s.world.step();
  EXPECT_EQ(s.world.time(), 0.06);
}

TEST(Collision, AdvancingTheBodiesFromAHandlerIsRefused) {
  Scene s;
  s.body(kBall, Vector3::Zero());
  s.body(kBall, Vector3(1, 0, 0));
  s.world.handle_collisions(kBall, kBall, "hit", {});
  int refused = 0;
  s.script.on_collided = [&](ObjectId, ObjectId, const Vector3&, const Vector3&) {
    EXPECT_THROW(s.world.advance_bodies(), Error);
    ++refused;
    return false;
  };
  s.world.step();
  EXPECT_EQ(refused, 6);
}

TEST(Collision, AnElasticGasKeepsItsEnergyAndNothingEscapes) {
  Scene s(4);
  s.script.recording = false;
  Random& r = s.world.random();
  constexpr double kHalf = 5;
  const auto slab = Shape::box(Vector3(1, 20, 20));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const ObjectId wall = s.body(kWall, Vector3::Unit(axis) * side * (kHalf + 0.5), BodyKind::Stationary, slab);
      const Quaternion rotation = Quaternion::FromTwoVectors(Vector3::UnitX(), Vector3::Unit(axis));
      s.world.bodies().set_orientation(s.world.body(wall), rotation);
    }
  }
  std::vector<ObjectId> gas;
  for (int i = 0; i < 125; ++i) {
    const Vector3 cell(i % 5, i / 5 % 5, i / 25);
    gas.push_back(s.body(kBall, (cell - Vector3(2, 2, 2)) * 1.9, BodyKind::Mobile, Shape::sphere(0.3)));
    s.set_velocity(gas.back(), Vector3(r.gauss(), r.gauss(), r.gauss()) * 10);
  }
  s.world.handle_collisions(kBall, kWall, "wall", {});
  s.world.handle_collisions(kBall, kBall, "ball", {});
  s.script.on_collided = [&](ObjectId me, ObjectId other, const Vector3&, const Vector3& normal) {
    const bool wall = s.world.class_of(other) == kWall;
    const Vector3 mine = s.velocity(me), theirs = s.velocity(other);
    const double approach = (mine - theirs).dot(normal);
    if (approach >= 0) return true;
    s.set_velocity(me, mine - (wall ? 2 : 1) * approach * normal);
    if (!wall) s.set_velocity(other, theirs + approach * normal);
    return true;
  };
  const auto energy = [&] {
    double sum = 0;
    for (const ObjectId id : gas) sum += s.velocity(id).squaredNorm();
    return sum;
  };
  const double before = energy();
  for (int i = 0; i < 300; ++i) s.world.step();
  EXPECT_NEAR(energy() / before, 1, 1e-10);
  for (const ObjectId id : gas) EXPECT_LT(s.at(id).cwiseAbs().maxCoeff(), kHalf - 0.3 + 1e-6);
}

TEST(Collision, DoesNotDependOnTheOrderInWhichBodiesWereMade) {
  const auto run = [](bool reversed) {
    Scene s;
    const Vector3 positions[] = {{-3, 0, 0}, {3, 0.3, 0}, {0, 4, 0.2}, {0, -4.5, 0}};
    const Vector3 speeds[] = {{40, 0, 0}, {-35, 0, 0}, {0, -41, 0}, {0, 38, 1}};
    ObjectId ids[4];
    for (int k = 0; k < 4; ++k) {
      const int i = reversed ? 3 - k : k;
      ids[i] = s.body(kBall, positions[i]);
      s.set_velocity(ids[i], speeds[i]);
    }
    s.world.handle_collisions(kBall, kBall, "hit", {});
    s.script.on_collided = [&](ObjectId me, ObjectId other, const Vector3&, const Vector3& normal) {
      const double approach = (s.velocity(me) - s.velocity(other)).dot(normal);
      if (approach < 0) {
        const Vector3 mine = s.velocity(me) - approach * normal;
        s.set_velocity(other, s.velocity(other) + approach * normal);
        s.set_velocity(me, mine);
      }
      return true;
    };
    for (int i = 0; i < 5; ++i) s.world.step();
    std::vector<Vector3> ends;
    for (const ObjectId id : ids) ends.push_back(s.at(id));
    return ends;
  };
  const auto a = run(false), b = run(true);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((a[i] - b[i]).norm(), 1e-9) << i;
}

TEST(Collision, ABodyThatFliesOutOfTheNumbersTouchesNothing) {
  Scene s;
  const ObjectId a = s.body(kBall, Vector3::Zero());
  s.body(kBall, Vector3(5, 0, 0));
  s.set_velocity(a, Vector3(1e308, 1e308, 0));
  s.world.bodies().set_acceleration(s.world.body(a), Vector3(1e308, 0, 0));
  s.world.handle_collisions(kBall, kBall, "hit", {});
  for (int i = 0; i < 20; ++i) s.world.step();
  s.world.update_neighbors();
}

}  // namespace
}  // namespace breve
