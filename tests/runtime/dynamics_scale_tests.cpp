// A scene moves as the same scene does with its lengths, its length unit and its gravity multiplied by a number: no
// hidden threshold knows metres.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics_scene.hpp"

namespace breve {
namespace {

using testing::Physics;

constexpr double kStep = 1.0 / 60;

/// A world whose lengths are multiples of `unit`. Masses and times are as they are.
struct Scaled : Physics {
  double unit;
  std::vector<ObjectId> bodies;

  Scaled(double length, Rung rung) : Physics(kStep), unit(length) {
    mechanics().set_length_unit(unit);
    mechanics().set_gravity({0, -9.81 * unit, 0});
    mechanics().set_accuracy(rung);
    mechanics().set_sleeping(true);
  }

  void floor() {
    const ObjectId id = body(0, {0, -unit, 0}, BodyKind::Stationary, Shape::box(unit * Vector3(40, 2, 40)));
    bounce(id);
  }

  void bounce(ObjectId id) { world.bodies().material(index(id)).restitution = 0.5; }

  ObjectId add(const std::shared_ptr<Shape>& shape, const Vector3& at, double mass, const Vector3& axis = {0, 0, 1},
               double angle = 0) {
    shape->set_mass(mass);
    bodies.push_back(rigid(shape, unit * at, Quaternion(Eigen::AngleAxisd(angle, axis.normalized()))));
    bounce(bodies.back());
    return bodies.back();
  }
  ObjectId box(const Vector3& size, const Vector3& at, double mass) { return add(Shape::box(unit * size), at, mass); }

  JointIndex join(JointKind kind, BodyIndex parent, ObjectId child, const Vector3& on_parent, const Vector3& on_child,
                  const Vector3& normal) {
    JointDescription is;
    is.kind = kind;
    is.parent = parent;
    is.child = index(child);
    is.parent_point = unit * on_parent;
    is.child_point = unit * on_child;
    is.normal = normal;
    return mechanics().link(is, child);
  }
  /// A torque, or the stiffness or damping of one.
  double torque(double x) const { return unit * unit * x; }
};

void pour(Scaled& s) {
  s.floor();
  for (int i = 0; i < 6; ++i) {
    const double x = 0.1 * i, y = 1 + 1.5 * i;
    s.add(i % 2 == 0 ? Shape::box(s.unit * Vector3(1, 0.8, 0.6)) : Shape::sphere(0.5 * s.unit), {x, y, -0.5 * x}, 1 + i,
          Vector3(1, i, 2), 0.3 * i);
  }
}

void walk(Scaled& s) {
  s.floor();
  const ObjectId trunk = s.box({2, 0.3, 1}, {0, 1.5, 0}, 4);
  for (int i = 0; i < 4; ++i) {
    const Vector3 hip(i < 2 ? -0.8 : 0.8, -0.15, i % 2 == 0 ? -0.4 : 0.4);
    const ObjectId leg = s.box({0.2, 0.8, 0.2}, Vector3(0, 1.5, 0) + hip, 0.5);
    const JointIndex joint = s.join(JointKind::Revolute, s.index(trunk), leg, hip, {0, 0.4, 0}, {0, 0, 1});
    JointDrive drive;
    drive.low[0] = -0.5;
    drive.high[0] = 0.8;
    drive.limit_restitution = i == 0 ? 0.3 : 0;
    drive.motor_speed[0] = i % 2 == 0 ? 2 : -1.5;
    drive.strength_limit = s.torque(8);
    s.mechanics().set_drive(joint, drive);
  }
  const ObjectId head = s.box({0.3, 0.3, 0.3}, {0, 2.2, 0}, 0.7);
  const JointIndex neck = s.join(JointKind::Ball, s.index(trunk), head, {0.9, 0.15, 0}, {0, -0.4, 0}, {0, 1, 0});
  JointDrive drive;
  drive.stiffness = s.torque(20);
  drive.damping = s.torque(0.5);
  s.mechanics().set_drive(neck, drive);
  const ObjectId weight = s.box({0.4, 0.4, 0.4}, {0, 2.5, 0}, 1);
  const JointIndex slide = s.join(JointKind::Prismatic, s.index(trunk), weight, {-0.5, 0.6, 0}, {0, 0, 0}, {0, 1, 0});
  drive = {};
  drive.low[0] = -0.2;
  drive.high[0] = 0.3;
  drive.stiffness = 40;
  drive.rest[0] = 0.1 * s.unit;
  drive.low[0] *= s.unit;
  drive.high[0] *= s.unit;
  s.mechanics().set_drive(slide, drive);
}

/// Four bars that hang on the world and close a loop.
void swing(Scaled& s) {
  const ObjectId left = s.box({0.1, 1, 0.1}, {0, 0, 0}, 1), bar = s.box({1.5, 0.1, 0.1}, {0, 0, 0}, 1.5),
                 right = s.box({0.1, 1, 0.1}, {0, 0, 0}, 1);
  s.join(JointKind::Revolute, kNoBody, left, {-0.75, 2, 0}, {0, 0.5, 0}, {0, 0, 1});
  s.join(JointKind::Revolute, s.index(left), bar, {0, -0.5, 0}, {-0.75, 0, 0}, {0, 0, 1});
  s.join(JointKind::Revolute, s.index(bar), right, {0.75, 0, 0}, {0, -0.5, 0}, {0, 0, 1});
  s.join(JointKind::Revolute, kNoBody, right, {0.75, 2, 0}, {0, 0.5, 0}, {0, 0, 1});
  s.world.bodies().set_velocity(s.index(bar), {2 * s.unit, 0, 0});
}

using Build = void (*)(Scaled&);
struct Case {
  const char* name;
  Build build;
  double most;  // unit: the strength of motors is bounded by their masses, whatever the unit
  double differs;
  Rung rung;
};

class ScaleTest : public ::testing::TestWithParam<Case> {};

TEST_P(ScaleTest, LengthsDoNotMatterButForTheUnit) {
  const Case& is = GetParam();
  const auto run = [&is](double unit, double seconds) {
    Scaled scene(unit, is.rung);
    is.build(scene);
    scene.run(seconds);
    std::vector<Vector3> at;
    for (const ObjectId id : scene.bodies) at.push_back(scene.at(id) / unit);
    return at;
  };
  // Powers of two, so that no digit is rounded otherwise.
  for (const double unit : {std::ldexp(1, -10), std::ldexp(1, 10)}) {
    if (unit > is.most) continue;
    for (const double seconds : {0.5, 1.0}) {
      const std::vector<Vector3> expected = run(1, seconds), found = run(unit, seconds);
      double worst = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) worst = std::max(worst, (found[i] - expected[i]).norm());
      EXPECT_LE(worst, is.differs) << "length units, at a unit of " << unit << " m after " << seconds << " s";
    }
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise, Rung::Reference}) {
    all.push_back({"pour", pour, 1e9, 1e-7, rung});
    all.push_back({"swing", swing, 1e9, 1e-9, rung});
    // The solver compares rad/s as well as m/s with one tolerance, so that joints are solved to other digits.
    all.push_back({"walk", walk, 1, rung == Rung::Fast ? 0.05 : 1e-3, rung});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, ScaleTest, ::testing::ValuesIn(cases()), [](const auto& of) {
  return std::string(of.param.name).append("_").append(name_of(of.param.rung));
});

}  // namespace
}  // namespace breve
