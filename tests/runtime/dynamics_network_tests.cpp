// Bodies that only springs connect: moved without what joints need, and equal to the way in which all others are
// moved.
#include <gtest/gtest.h>

#include "dynamics_scene.hpp"

namespace breve::testing {
namespace {

/// Three turning boxes in a chain on a post, whose springs end off their centres; each spring is of another kind.
struct Chain : Physics {
  std::vector<ObjectId> boxes;
  std::vector<SpringIndex> springs;

  /// @param asked  a script is asked for the force on a box, and says none: then the cluster is moved as one with
  /// joints
  Chain(Rung rung, bool asked) : Physics(1.0 / 240) {
    mechanics().set_accuracy(rung);
    const ObjectId post = body(2, Vector3(0, 3, 0), BodyKind::Stationary, Shape::sphere(0.1));
    for (int i = 0; i < 3; ++i) {
      const Vector3 size(0.3 + 0.1 * i, 0.4, 0.2);
      std::shared_ptr<Shape> shape = Shape::box(size);
      shape->set_mass(1 + i);
      boxes.push_back(rigid(shape, Vector3(0.4 * i, 2 - i, 0.2 * i)));
      world.bodies().set_rotational_velocity(index(boxes.back()), Vector3(1, -2, 0.5 + i));
    }
    SpringDescription is;
    is.strength = 40;
    is.damping = 0.2;
    is.length = 0.8;
    is.a = index(post);
    is.b = index(boxes[0]);
    is.point_b = Vector3(0.1, 0.2, 0);
    add(is);
    is.a = index(boxes[0]);
    is.b = index(boxes[1]);
    is.point_a = Vector3(0, -0.2, 0.05);
    is.mode = SpringMode::ContractOnly;
    add(is);
    is.a = index(boxes[1]);
    is.b = index(boxes[2]);
    is.point_a = is.point_b = Vector3::Zero();
    is.mode = SpringMode::Both;
    add(is);
    is.maximum_force = 6;
    is.a = index(boxes[0]);
    add(is);
    if (asked) mechanics().set_force_method(index(boxes[1]), true);
  }
  void add(const SpringDescription& is) { springs.push_back(mechanics().add_spring(is, boxes[0])); }
};

TEST(SpringNetworks, MoveAsTheyDoWhereScriptsAreAsked) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise, Rung::Reference, Rung::Conserving}) {
    Chain own(rung, false), general(rung, true);
    for (int i = 0; i < 240; ++i) {
      own.world.step();
      general.world.step();
      if (i != 120) continue;
      // Values that are set meanwhile count from there.
      for (Chain* chain : {&own, &general}) {
        SpringDescription is = chain->mechanics().spring(chain->springs[2]);
        is.strength = 70;
        is.point_b = Vector3(0, 0.1, 0.1);
        chain->mechanics().set_spring(chain->springs[2], is);
      }
    }
    // Equations that are solved by repetition end where they are near enough.
    const double slack = rung == Rung::Conserving ? 1000 : 1;
    for (std::size_t i = 0; i < own.boxes.size(); ++i) {
      const ObjectId one = own.boxes[i], other = general.boxes[i];
      EXPECT_LT((own.at(one) - general.at(other)).norm(), slack * 1e-8) << name_of(rung) << ", box " << i;
      EXPECT_LT((own.velocity(one) - general.velocity(other)).norm(), slack * 1e-7) << name_of(rung) << ", box " << i;
    }
    for (std::size_t i = 0; i < own.springs.size(); ++i)
      EXPECT_NEAR(own.mechanics().spring_force(own.springs[i]), general.mechanics().spring_force(general.springs[i]),
                  slack * 1e-6)
          << name_of(rung) << ", spring " << i;
    const Energy one = own.mechanics().energy(), other = general.mechanics().energy();
    EXPECT_NEAR(one.total(), other.total(), slack * 1e-6) << name_of(rung);
    EXPECT_NEAR(one.drag_loss, other.drag_loss, slack * 1e-7) << name_of(rung);
    EXPECT_NEAR(one.script_work, other.script_work, slack * 1e-7) << name_of(rung);
    EXPECT_GT(one.drag_loss, 0.01) << name_of(rung);
  }
}

}  // namespace
}  // namespace breve::testing
