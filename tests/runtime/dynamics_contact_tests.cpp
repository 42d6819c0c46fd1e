// Bodies that touch, in a world: falling, resting, bouncing, limits, rings, assemblies among others.
#include <gtest/gtest.h>

#include <cstdio>

#include "dynamics_scene.hpp"

namespace breve::testing {
namespace {

struct Ground : Physics {
  explicit Ground(Rung rung, double step = 1.0 / 60) : Physics(step) {
    mechanics().set_accuracy(rung);
    body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(1000, 5, 1000)));
  }
  void bounce(ObjectId id, double e) {
    Material& material = world.bodies().material(index(id));
    material.normal_restitution = e;
    material.static_friction = material.dynamic_friction = 0.5;
  }
};

TEST(DynamicsContact, ABoxComesToRestOnTheFloor) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise}) {
    Ground s(rung);
    const ObjectId box = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0, 1, 0));
    s.run(3);
    EXPECT_NEAR(s.at(box).y(), 0.5, 1e-3) << name_of(rung);
    EXPECT_LT(s.velocity(box).norm(), 1e-6) << name_of(rung);
    std::printf("  %-9s y - 0.5 = %.2e  |v| = %.1e  substeps %lu  loss %.4f\n", std::string(name_of(rung)).c_str(),
                s.at(box).y() - 0.5, s.velocity(box).norm(), s.mechanics().counters().sub_steps,
                s.mechanics().energy().contact_loss);
  }
}

TEST(DynamicsContact, WhatLiesTakesItsStepAsOneAndWhatIsPushedDoesNot) {
  Ground s(Rung::Balanced);
  const ObjectId low = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.5, 0)),
                 high = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0.1, 1.5, 0));
  s.run(2);
  EXPECT_EQ(s.mechanics().counters().sub_steps, 1U);
  const Vector3 before = s.at(high);
  s.run(10);
  EXPECT_EQ(s.mechanics().counters().sub_steps, 1U);
  EXPECT_LT((s.at(high) - before).norm(), 1e-7);
  EXPECT_LT(s.velocity(low).norm() + s.velocity(high).norm(), 1e-7);
  // Nothing moves as yet, and will.
  s.world.bodies().set_force(s.index(high), Vector3(20'000, 0, 0));
  s.world.step();
  EXPECT_GE(s.mechanics().counters().sub_steps, 4U);
  EXPECT_GT(s.velocity(high).x(), 0.01);
  s.world.bodies().set_force(s.index(high), Vector3::Zero());
  s.world.bodies().set_velocity(s.index(high), Vector3(0.5, 0, 0));
  s.world.step();
  EXPECT_GE(s.mechanics().counters().sub_steps, 4U);
}

TEST(DynamicsContact, AnElasticBallKeepsItsHeight) {
  for (const Rung rung : {Rung::Balanced, Rung::Precise}) {
    Ground s(rung);
    const ObjectId ball = s.rigid(Shape::sphere(0.5), Vector3(0, 1.5, 0));
    s.bounce(ball, 1);
    for (const ObjectId id : s.world.objects())
      if (s.world.has_body(id)) s.bounce(id, 1);
    double top = 0;
    for (int i = 0; i < 600; ++i) {
      s.world.step();
      const double v = s.velocity(ball).y();
      top = std::max(top, std::abs(s.at(ball).y() + v * v / (2 * 9.81) - 1.5));
    }
    std::printf("  %s: apex off by at most %.1e\n", std::string(name_of(rung)).c_str(), top);
    EXPECT_LT(top, 1e-6);
  }
}

TEST(DynamicsContact, StackedBoxesStand) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced}) {
    Ground s(rung);
    std::vector<ObjectId> boxes;
    for (int i = 0; i < 10; ++i) boxes.push_back(s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.5 + i, 0)));
    s.run(5);
    std::printf("  %s: top at %.6f, drift %.1e\n", std::string(name_of(rung)).c_str(), s.at(boxes.back()).y(),
                std::hypot(s.at(boxes.back()).x(), s.at(boxes.back()).z()));
    EXPECT_NEAR(s.at(boxes.back()).y(), 9.5, 0.1);
    // What `fast` does is published, not promised.
    if (rung != Rung::Fast) {
      EXPECT_LT(std::hypot(s.at(boxes.back()).x(), s.at(boxes.back()).z()), 0.01);
    }
    EXPECT_NEAR(s.at(boxes.back()).y(), 9.5, 0.1);
  }
}

TEST(DynamicsContact, AFloorPushesNoLongerWhatAScriptHasMovedAway) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise, Rung::Reference}) {
    Ground s(rung);
    const ObjectId a = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.5, 0)),
                   b = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(1, 0.5, 0));
    JointDescription is;
    is.kind = JointKind::Fixed;
    is.parent = s.index(a);
    is.child = s.index(b);
    is.parent_point = Vector3(0.5, 0, 0);
    is.child_point = Vector3(-0.5, 0, 0);
    s.mechanics().link(is, b);
    s.run(1);
    s.mechanics().move_assembly(s.index(a), Vector3(0, 10, 0), Quaternion::Identity());
    const double before = s.velocity(a).y();
    s.run(0.5);
    const double fall = s.mechanics().gravity().y() * 0.5;
    EXPECT_NEAR(s.velocity(a).y() - before, fall, 1e-9) << name_of(rung);
    EXPECT_NEAR(s.at(a).y() - 10, 0.5 * 0.5 * fall, 1e-2) << name_of(rung);
  }
}

TEST(DynamicsContact, JointLimitsGiveBackWhatTheyShould) {
  Physics s;
  const ObjectId rod = s.rigid(Shape::box(Vector3(0.1, 1, 0.1)), Vector3::Zero());
  JointDescription is;
  is.child = s.index(rod);
  is.child_point = Vector3(0, 0.5, 0);
  is.normal = Vector3::UnitZ();
  const JointIndex joint = s.mechanics().link(is, rod);
  JointDrive drive = s.mechanics().drive(joint);
  drive.low = Vector3(-0.5, 0, 0);
  drive.high = Vector3(0.3, 0, 0);
  drive.limit_restitution = 1;
  s.mechanics().set_drive(joint, drive);
  s.mechanics().set_velocity(joint, Vector3(3, 0, 0));
  const double start = s.mechanics().energy().total();
  double worst = 0, low = 0, high = 0;
  for (int i = 0; i < 600; ++i) {
    s.world.step();
    worst = std::max(worst, std::abs(s.mechanics().energy().total() - start));
    low = std::min(low, s.mechanics().position(joint)[0]);
    high = std::max(high, s.mechanics().position(joint)[0]);
  }
  EXPECT_GE(low, -0.5 - 1e-9);
  EXPECT_LE(high, 0.3 + 1e-9);
  std::printf("  limits: energy off by at most %.1e J of %.2f\n", worst, start);
  EXPECT_LT(worst, 1e-4);
}

TEST(DynamicsContact, ARingStaysClosed) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced}) {
    Physics s;
    s.mechanics().set_accuracy(rung);
    // Four links in a square that hangs by one corner; the last joint closes the loop.
    std::vector<ObjectId> rods;
    std::vector<JointIndex> joints;
    const Vector3 corners[] = {{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {0, -1, 0}};
    for (int i = 0; i < 4; ++i) {
      const Vector3 a = corners[i], b = corners[(i + 1) % 4];
      const Quaternion rotation = Quaternion::FromTwoVectors(Vector3::UnitY(), b - a);
      rods.push_back(s.rigid(Shape::box(Vector3(0.1, 1, 0.1)), 0.5 * (a + b), rotation));
    }
    const auto pin = [&](int parent, int child, const Vector3& at) {
      JointDescription is;
      is.child = s.index(rods[static_cast<std::size_t>(child)]);
      is.keep_rotation = true;
      const Bodies& bodies = s.world.bodies();
      const auto local = [&](BodyIndex body) -> Vector3 {
        return bodies.orientation(body).conjugate() * (at - bodies.location(body));
      };
      is.child_point = local(is.child);
      Quaternion from = Quaternion::Identity();
      is.parent_point = at;
      if (parent >= 0) {
        is.parent = s.index(rods[static_cast<std::size_t>(parent)]);
        is.parent_point = local(is.parent);
        from = bodies.orientation(is.parent);
      }
      is.normal = from.conjugate() * Vector3::UnitZ();
      is.relative_rotation = from.conjugate() * bodies.orientation(is.child);
      joints.push_back(s.mechanics().link(is, rods[static_cast<std::size_t>(child)]));
    };
    pin(-1, 0, corners[0]);
    for (int i = 1; i < 4; ++i) pin(i - 1, i, corners[i]);
    pin(3, 0, corners[0]);
    EXPECT_TRUE(s.mechanics().closes_loop(joints.back()));
    const double start = s.mechanics().energy().total();
    double open = 0, highest = 0;  // J in motion: what turns over
    for (int i = 0; i < 300; ++i) {
      s.world.step();
      highest = std::max(highest, s.mechanics().energy().kinetic);
      const Bodies& bodies = s.world.bodies();
      const JointDescription& is = s.mechanics().joint(joints.back());
      const Vector3 gap = bodies.location(is.child) + bodies.orientation(is.child) * is.child_point -
                          bodies.location(is.parent) - bodies.orientation(is.parent) * is.parent_point;
      open = std::max(open, gap.norm());
    }
    std::printf("  ring on %s: open by at most %.1e, energy %.3f -> %.3f\n", std::string(name_of(rung)).c_str(), open,
                start, s.mechanics().energy().total());
    EXPECT_LT(open, 1e-9);
    if (rung != Rung::Fast) {
      EXPECT_NEAR(s.mechanics().energy().total(), start, 1e-3 * highest);
    }
  }
}

}  // namespace
}  // namespace breve::testing
