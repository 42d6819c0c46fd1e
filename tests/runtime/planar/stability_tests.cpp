// Hard scenes in a flat world, with the bounds that it promises.
#include "scene.hpp"

namespace breve::testing {
namespace {

double kinetic(Flat& flat, const std::vector<ObjectId>& all) {
  double sum = 0;
  for (const ObjectId id : all) {
    const double w = flat.bodies().rotational_velocity(flat.index(id)).z();
    sum += 0.5 * flat.bodies().mass(flat.index(id)) * flat.velocity(id).squaredNorm() +
           0.5 * flat.bodies().mass_properties(flat.index(id)).inertia(2, 2) * w * w;
  }
  return sum;
}

TEST(PlanarStability, AnElasticGasKeepsItsEnergyAndMomentum) {
  Flat flat;
  flat.physics().set_gravity(Vector3::Zero());
  constexpr double kHalf = 10;
  for (const int side : {0, 1, 2, 3}) {
    const double x = side == 0 ? -1 : side == 1 ? 1 : 0, y = side == 2 ? -1 : side == 3 ? 1 : 0;
    const Vector3 size = x != 0 ? Vector3(2, 2 * kHalf + 4, 1) : Vector3(2 * kHalf + 4, 2, 1);
    flat.material(flat.fixed(Shape::box(size), x * (kHalf + 1), y * (kHalf + 1)), 0, 1);
  }
  std::vector<ObjectId> discs;
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    discs.push_back(flat.ball(0.3, -9 + 2 * (i % 10), -9 + 2 * (i / 10)));
    flat.material(discs.back(), 0, 1);
    const double angle = 2 * M_PI * random.uniform();
    flat.set_velocity(discs.back(), {3 * std::cos(angle), 3 * std::sin(angle), 0});
  }
  // Momentum leaves through the walls alone: what they gave is counted at each impact.
  const auto momentum = [&] {
    Vector3 sum = Vector3::Zero();
    for (const ObjectId id : discs) sum += flat.bodies().mass(flat.index(id)) * flat.velocity(id);
    return sum;
  };
  const auto moves = [&](ObjectId id) { return flat.bodies().dynamic(flat.index(id)); };
  const double before = kinetic(flat, discs), mass = flat.bodies().mass(flat.index(discs[0]));
  Vector3 wanted = momentum();
  int met = 0;
  for (int i = 0; i < 60 * 60; ++i) {
    flat.world.step();
    for (const Impact& impact : flat.physics().impacts()) {
      if (!moves(impact.a)) wanted -= impact.impulse;
      if (!moves(impact.b)) wanted += impact.impulse;
      met += moves(impact.a) && moves(impact.b) ? 1 : 0;
    }
    ASSERT_NEAR(kinetic(flat, discs), before, 1e-3 * before) << i;
    ASSERT_LT((momentum() - wanted).norm(), 1e-3 * 100 * mass * 3) << i;
  }
  EXPECT_GT(met, 1000);  // of two discs
  for (const ObjectId disc : discs) {
    EXPECT_LT(std::abs(flat.at(disc).x()), kHalf);
    EXPECT_LT(std::abs(flat.at(disc).y()), kHalf);
  }
}

TEST(PlanarStability, ACollisionKeepsMomentum) {
  Flat flat;
  flat.physics().set_gravity(Vector3::Zero());
  const ObjectId a = flat.rigid(Shape::box({1, 1, 1}), -3, 0.2, 0.3), b = flat.rigid(Shape::box({2, 1, 1}), 3, 0, 0.1);
  flat.material(a, 0.5, 0.7);
  flat.material(b, 0.5, 0.7);
  flat.set_velocity(a, {4, 0, 0});
  const double before = flat.bodies().mass(flat.index(a)) * 4;
  flat.run(3);
  const Vector3 p =
      flat.bodies().mass(flat.index(a)) * flat.velocity(a) + flat.bodies().mass(flat.index(b)) * flat.velocity(b);
  EXPECT_NEAR(p.x(), before, 1e-5 * before);
  EXPECT_NEAR(p.y(), 0, 1e-5 * before);
  EXPECT_GT(flat.velocity(b).x(), 0.5);
}

TEST(PlanarStability, NewtonsCradlePassesTheSpeedOnToTheLastBall) {
  Flat flat;
  constexpr double r = 0.25, l = 2;
  std::vector<ObjectId> balls;
  for (int i = 0; i < 5; ++i) {
    const double angle = i == 0 ? -0.6 : 0;
    const double x = 2 * r * i;
    balls.push_back(flat.ball(r, x + l * std::sin(angle), -l * std::cos(angle)));
    flat.material(balls.back(), 0, 1);
    flat.hinge({}, balls.back(), {x, 0, 0}, {-l * std::sin(angle), l * std::cos(angle), 0});
  }
  double most = 0, middle = 0;
  for (int i = 0; i < 90; ++i) {  // through the first swing of the last ball
    flat.world.step();
    most = std::max(most, flat.at(balls[4]).x() - 8 * r);
    for (int k = 1; k < 4; ++k)
      middle = std::max(middle, std::abs(flat.at(balls[static_cast<std::size_t>(k)]).x() - 2 * r * k));
  }
  EXPECT_NEAR(most, l * std::sin(0.6), 0.03 * l * std::sin(0.6));
  EXPECT_LT(middle, 0.02 * l);
}

TEST(PlanarStability, AStackOf20BoxesStandsForAMinuteAndSleeps) {
  Flat flat;
  flat.physics().set_sleeping(true);
  flat.ground();
  std::vector<ObjectId> boxes;
  for (int i = 0; i < 20; ++i) boxes.push_back(flat.box(1, 1, 0, 0.5 + i));
  flat.run(60);
  for (int i = 0; i < 20; ++i) {
    const ObjectId box = boxes[static_cast<std::size_t>(i)];
    EXPECT_NEAR(flat.at(box).x(), 0, 0.02);
    EXPECT_NEAR(flat.at(box).y(), 0.5 + i, 0.02);
    EXPECT_TRUE(flat.physics().asleep(flat.index(box)));
  }
}

TEST(PlanarStability, AStackThatIsSavedAndLoadedAtEveryStepStands) {
  Flat flat;
  flat.ground();
  std::vector<ObjectId> boxes;
  for (int i = 0; i < 20; ++i) boxes.push_back(flat.box(1, 1, 0, 0.5 + i));
  for (int i = 0; i < 60 * 60; ++i) {
    flat.world.step();
    const auto image = flat.world.save(1);
    flat.world.load(image.data(), image.size(), 1);
  }
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_NEAR(flat.at(boxes[i]).x(), 0, 0.02);
    EXPECT_NEAR(flat.at(boxes[i]).y(), 0.5 + static_cast<double>(i), 0.02);
  }
}

TEST(PlanarStability, AStackFallsAsleepAlsoIfItIsSavedAndLoadedAtEveryStep) {
  int asleep_at[2] = {0, 0};
  for (const bool saved : {false, true}) {
    Flat flat;
    flat.physics().set_sleeping(true);
    flat.ground();
    for (int i = 0; i < 20; ++i) flat.box(1, 1, 0, 0.5 + i);
    int& steps = asleep_at[saved];
    std::uint64_t sleeping = 0;
    for (; steps < 60 * 60 && sleeping < 20; ++steps) {
      flat.world.step();
      sleeping = flat.physics().counters().sleeping;
      if (!saved) continue;
      const auto image = flat.world.save(1);
      flat.world.load(image.data(), image.size(), 1);
    }
    EXPECT_EQ(sleeping, 20U);
  }
  EXPECT_NEAR(asleep_at[1], asleep_at[0], 60);  // within a second of each other
}

TEST(PlanarStability, WhatRollsOrSlidesSlowlyGoesOnWhereOthersMaySleep) {
  Flat flat;
  flat.physics().set_sleeping(true);
  constexpr double v = 0.05;  // m/s: five times the speed at which Box2D lets things sleep
  flat.material(flat.ground(), 0.5, 0);
  flat.material(flat.fixed(Shape::box({1000, 10, 1}), 0, -105), 0, 0);
  // A disc that rolls; boxes on each other that slide without friction on the lower ground.
  const ObjectId disc = flat.ball(0.5, 0, 0.5);
  flat.material(disc, 0.5, 0);
  flat.set_velocity(disc, {v, 0, 0});
  flat.bodies().set_rotational_velocity(flat.index(disc), {0, 0, -v / 0.5});
  std::vector<ObjectId> boxes;
  for (int i = 0; i < 3; ++i) {
    boxes.push_back(flat.box(1, 1, 0, -99.5 + i));
    flat.material(boxes.back(), i == 0 ? 0 : 0.5, 0);
    flat.set_velocity(boxes.back(), {v, 0, 0});
  }
  flat.run(20);
  EXPECT_NEAR(flat.at(disc).x(), 20 * v, 0.01 * 20 * v);
  EXPECT_NEAR(flat.velocity(disc).x(), v, 0.01 * v);
  for (const ObjectId box : boxes) {
    EXPECT_NEAR(flat.at(box).x(), 20 * v, 0.01 * 20 * v);
    EXPECT_NEAR(flat.velocity(box).x(), v, 0.01 * v);
  }
}

TEST(PlanarStability, DiscsThatRollOnEachOtherSlowDownAndTheLedgerSaysSo) {
  Flat flat;
  flat.physics().set_sleeping(true);
  // Two discs in a trough turn against each other, without friction on its walls.
  flat.material(flat.fixed(Shape::box({4, 1, 1}), 0, -0.5), 0, 0);
  for (const double x : {-1.5, 1.5}) flat.material(flat.fixed(Shape::box({1, 4, 1}), x, 1), 0, 0);
  const ObjectId a = flat.ball(0.55, -0.45, 0.55), b = flat.ball(0.55, 0.45, 0.55 + 0.6325);
  for (const ObjectId id : {a, b}) flat.material(id, 0.5, 0);
  flat.run(5);
  flat.bodies().set_rotational_velocity(flat.index(a), {0, 0, 0.2});
  flat.bodies().set_rotational_velocity(flat.index(b), {0, 0, -0.2});
  flat.world.step();
  const Energy start = flat.physics().energy();
  flat.run(10);
  const Energy end = flat.physics().energy();
  EXPECT_NEAR(flat.bodies().rotational_velocity(flat.index(a)).z(), 0, 0.02);
  EXPECT_NEAR(end.residual, start.residual, 0.02 * start.kinetic);
  EXPECT_NEAR(end.friction_loss, start.friction_loss + start.kinetic, 0.02 * start.kinetic);
}

TEST(PlanarStability, ABoxAThousandTimesHeavierStandsOnALightOne) {
  Flat flat(Rung::Precise);
  flat.ground();
  const ObjectId light = flat.box(1, 1, 0, 0.5);
  auto shape = Shape::box({1, 1, 1});
  shape->set_mass(1000);
  const ObjectId heavy = flat.rigid(shape, 0, 1.5);
  double least = 10;
  for (int i = 0; i < 60 * 20; ++i) {
    flat.world.step();
    least = std::min(least, flat.at(heavy).y());
  }
  EXPECT_GT(least, 1.5 - 0.05);
  EXPECT_GT(flat.at(light).y(), 0.45);
}

/// Twenty links with a weight a thousand times theirs, released level. The widest gap of a joint, in lengths of a link.
double chain(Rung rung, std::size_t& interventions) {
  Flat flat(rung);
  constexpr double kLength = 0.5;
  ObjectId last;
  std::vector<ObjectId> links;
  for (int i = 0; i < 20; ++i) {
    auto shape = Shape::box({kLength, 0.1, 0.1});
    shape->set_mass(0.1);
    links.push_back(flat.rigid(shape, kLength * (i + 0.5), 0));
    flat.hinge(last, links.back(), i == 0 ? Vector3(0, 0, 0) : Vector3(kLength / 2, 0, 0), {-kLength / 2, 0, 0});
    last = links.back();
  }
  auto shape = Shape::sphere(0.5);
  shape->set_mass(100);
  const ObjectId weight = flat.rigid(shape, kLength * 20 + 0.5, 0);
  flat.hinge(last, weight, {kLength / 2, 0, 0}, {-0.5, 0, 0});
  double widest = 0;
  interventions = 0;
  for (int i = 0; i < 60 * 10; ++i) {
    flat.world.step();
    interventions += flat.physics().interventions().size();
    const auto end = [&](ObjectId id, double way) {
      return Vector3(flat.at(id) + flat.bodies().orientation(flat.index(id)) * Vector3(way, 0, 0));
    };
    Vector3 before = Vector3::Zero();
    for (const ObjectId link : links) {
      widest = std::max(widest, (before - end(link, -kLength / 2)).norm() / kLength);
      before = end(link, kLength / 2);
    }
    widest = std::max(widest, (before - end(weight, -0.5)).norm() / kLength);
  }
  return widest;
}

TEST(PlanarStability, AChainWithAThousandfoldWeightHoldsOnEachRung) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise}) {
    std::size_t interventions = 0;
    EXPECT_LT(chain(rung, interventions), 1e-3) << static_cast<int>(rung);
    EXPECT_EQ(interventions, 0U) << static_cast<int>(rung);
  }
}

TEST(PlanarStability, AThousandBodiesPouredIntoABoxStayInAndFallAsleepWithoutGain) {
  Flat flat;
  flat.physics().set_sleeping(true);
  flat.ground();
  flat.fixed(Shape::box({2, 80, 1}), -11, 38);
  flat.fixed(Shape::box({2, 80, 1}), 11, 38);
  std::vector<ObjectId> all;
  for (int i = 0; i < 1000; ++i) {
    const double x = -9 + 0.6 * (i % 31), y = 1 + 0.7 * (i / 31) + 0.01 * (i % 7);
    all.push_back(i % 2 == 0 ? flat.box(0.5, 0.5, x, y) : flat.ball(0.25, x, y));
  }
  flat.world.step();
  const double start = flat.physics().energy().total();
  double least = start;
  for (int i = 0; i < 60 * 60 && flat.physics().counters().sleeping < 1000; ++i) {
    flat.world.step();
    const double now = flat.physics().energy().total();
    ASSERT_LT(now, least + 1e-4 * start) << "at step " << i;
    least = std::min(least, now);
  }
  EXPECT_EQ(flat.physics().counters().sleeping, 1000U);
  for (const ObjectId id : all) {
    ASSERT_LT(std::abs(flat.at(id).x()), 10);
    ASSERT_GT(flat.at(id).y(), 0);
  }
}

}  // namespace
}  // namespace breve::testing
