// What a flat world is made of and remembers: shapes, handlers, effects, snapshots, equal runs, memory.
#include "scene.hpp"

namespace breve::testing {
namespace {

/// A pile with joints, springs, a motor and handlers.
struct Zoo : Flat {
  std::vector<ObjectId> boxes;
  explicit Zoo(int count = 12) {
    ground();
    for (int i = 0; i < count; ++i)
      boxes.push_back(rigid(Shape::box({1, 0.6, 1}), 0.3 * (i % 3), 1 + 0.8 * i, 0.1 * i));
    const ObjectId wheel = ball(0.5, 6, 3), arm = box(2, 0.2, 7, 3);
    const JointIndex joint = hinge(wheel, arm, {0, 0, 0}, {-1, 0, 0});
    JointDrive drive = physics().drive(joint);
    drive.motor_speed[0] = 4;
    drive.strength_limit = 20;
    physics().set_drive(joint, drive);
    SpringDescription spring;
    spring.a = index(boxes[0]);
    spring.b = index(wheel);
    spring.length = 3;
    physics().add_spring(spring, wheel);
    world.handle_collisions(1, 2, "hit", controller);
  }
};

TEST(PlanarState, TwoWorldsHaveTheSameHashAtEveryStep) {
  // A ball that no friction stops keeps them all moving.
  Zoo a(3), b(3);
  for (Zoo* zoo : {&a, &b}) {
    const ObjectId ball = zoo->ball(0.4, 2, 9);
    zoo->material(ball, 0, 1);
  }
  for (int i = 0; i < 10'000; ++i) {
    a.world.step();
    b.world.step();
    ASSERT_EQ(a.world.hash(), b.world.hash()) << "after " << i << " steps";
  }
}

TEST(PlanarState, SaveAndGoOnIsLoadAndGoOn) {
  for (const int moment : {0, 1, 30, 200}) {
    Zoo live, other;
    for (int i = 0; i < moment; ++i) live.world.step();
    const std::uint64_t before = live.world.hash();
    const auto image = live.world.save(1);
    ASSERT_EQ(live.world.hash(), before);  // taking it changes nothing that can be seen
    other.world.load(image.data(), image.size(), 1);
    ASSERT_EQ(other.world.hash(), before);
    for (int i = 0; i < 200; ++i) {
      live.world.step();
      other.world.step();
      ASSERT_EQ(live.world.hash(), other.world.hash()) << i << " steps after an image at " << moment;
    }
  }
}

/// A ball and a box on a plate, all at rest and asleep.
struct Resting : Flat {
  ObjectId plate, ball, box;

  Resting()
      : plate(fixed(Shape::box({20, 1, 1}), 0, -0.5)),
        ball(this->Flat::ball(0.5, -2, 0.5)),
        box(rigid(Shape::box({1, 1, 1}), 2, 0.5)) {
    physics().set_sleeping(true);
  }
};

TEST(PlanarState, WhatIsSetBetweenAnImageAndTheNextStepIsAChangeInBothWorlds) {
  using Change = void (*)(Resting&);
  const Change changes[] = {
      [](Resting& s) { s.material(s.plate, 0.1, 0.9); },
      [](Resting& s) {
        s.bodies().set_collision_shape(s.index(s.plate), Shape::box({20, 1.5, 1}));
      },
      [](Resting& s) {
        s.bodies().set_collision_shape(s.index(s.box), Shape::box({1.2, 0.8, 1}));
      },
      [](Resting& s) {
        s.bodies().set_force(s.index(s.ball), {5, 0, 0});
      },
      [](Resting& s) {
        s.bodies().set_velocity(s.index(s.box), {1, 2, 0});
      },
      [](Resting& s) {
        s.bodies().set_location(s.index(s.plate), {0, -0.7, 0});
      },
      [](Resting& s) {
        s.hinge(s.plate, s.box, {2, 1, 0}, {0, 0, 0});
      },
  };
  for (const int moment : {5, 300})
    for (const Change change : changes) {
      Resting live, other;
      for (int i = 0; i < moment; ++i) live.world.step();
      const auto image = live.world.save(1);
      other.world.load(image.data(), image.size(), 1);
      for (Resting* world : {&live, &other}) change(*world);
      for (int i = 0; i < 100; ++i) {
        live.world.step();
        other.world.step();
        ASSERT_EQ(live.world.hash(), other.world.hash())
            << "change " << &change - changes << ", step " << i << " after " << moment;
      }
    }
}

TEST(PlanarState, ABodyThatIsGivenItsShapeAgainHasItsNewDensity) {
  Flat live, other;
  const std::shared_ptr<Shape> shape = Shape::box({1, 1, 1});
  const ObjectId box = live.rigid(shape, 0, 100);
  other.rigid(Shape::box({1, 1, 1}), 0, 100);
  live.world.step();
  const double before = live.velocity(box).x();
  shape->set_density(3);
  live.bodies().set_collision_shape(live.index(box), shape);
  live.bodies().set_force(live.index(box), {6, 0, 0});
  const auto image = live.world.save(1);
  other.world.load(image.data(), image.size(), 1);
  double seconds = 0;
  for (int i = 0; i < 60; ++i) {
    live.world.step();
    other.world.step();
    seconds += live.world.iteration_step();
    ASSERT_EQ(live.world.hash(), other.world.hash()) << "step " << i;
  }
  EXPECT_NEAR(live.velocity(box).x() - before, 6 / 3.0 * seconds, 1e-5);
}

TEST(PlanarState, AShapeThatCannotBeIsRefusedInEachStepAndAnImageOfItGoesOnAlikeOnceItCan) {
  struct Wrong {
    ObjectId Resting::*body;
    std::shared_ptr<Shape> (*shape)();
    std::shared_ptr<Shape> (*later)();
  };
  // A mass and a corner that single precision does not hold.
  const Wrong all[] = {{&Resting::box, [] { return Shape::sphere(1e12); }, [] { return Shape::sphere(0.4); }},
                       {&Resting::plate,
                        [] {
                          return Shape::height_field(3, 2, 10, std::vector<double>{0, 1e39, 0, 0, 1e39, 0});
                        },
                        [] {
                          return Shape::box({20, 1, 1});
                        }}};
  for (const Wrong& wrong : all) {
    Resting live, other;
    live.run(0.2);
    const auto set = [&wrong](Resting& world, const std::shared_ptr<Shape>& shape) {
      world.bodies().set_collision_shape(world.index(world.*wrong.body), shape);
    };
    set(live, wrong.shape());
    for (int i = 0; i < 2; ++i) EXPECT_THROW(live.world.step(), Error) << i;
    const auto image = live.world.save(1);
    other.world.load(image.data(), image.size(), 1);
    for (Resting* world : {&live, &other}) {
      EXPECT_THROW(world->world.step(), Error);
      set(*world, wrong.later());  // a shape of its own: it ends with its world
    }
    for (int i = 0; i < 100; ++i) {
      live.world.step();
      other.world.step();
      ASSERT_EQ(live.world.hash(), other.world.hash()) << i;
    }
  }
}

TEST(PlanarState, AgentsWithoutPhysicsCostNoBox2D) {
  Flat flat;
  for (int i = 0; i < 100'000; ++i) flat.set_velocity(flat.body(1, {i * 0.01, 0, 0}), {1, 0, 0});
  flat.world.update_neighbors();
  flat.run(0.1);
  const Effects& effects = flat.world.effects();
  EXPECT_TRUE(effects[EffectId::Motion].active);
  EXPECT_FALSE(effects[EffectId::Rigid].active);
  EXPECT_EQ(effects[EffectId::Rigid].bytes, 0U);
  EXPECT_EQ(flat.physics().bytes(), 0U);
  flat.ball(1, 0, 5);
  flat.run(0.1);
  EXPECT_TRUE(effects[EffectId::Rigid].active);
  EXPECT_GT(effects[EffectId::Rigid].bytes, 0U);
}

TEST(PlanarState, AHandlerIsCalledAtTheTimeOfImpactWithPointAndNormal) {
  for (const Rung rung : {Rung::Fast, Rung::Precise}) {
    Flat flat(rung);
    const ObjectId ground = flat.ground();
    const ObjectId ball = flat.ball(0.5, 1, 5.5);
    flat.material(ground, 0, 1);
    flat.material(ball, 0, 1);
    flat.world.handle_collisions(1, 2, "hit", flat.controller);
    double moment = -1;
    Vector3 point, normal, velocity;
    double height = 0;
    flat.script.on_collided = [&](ObjectId, ObjectId, const Vector3& p, const Vector3& n) {
      if (moment >= 0) return false;
      moment = flat.world.time();
      point = p;
      normal = n;
      velocity = flat.velocity(ball);
      height = flat.at(ball).y();
      return false;
    };
    flat.run(1.2);
    EXPECT_NEAR(moment, std::sqrt(2 * 5 / 9.81), 2e-5);
    EXPECT_NEAR((point - Vector3(1, 0, 0)).norm(), 0, 1e-3);
    EXPECT_NEAR((normal - Vector3(0, 1, 0)).norm(), 0, 1e-6);
    EXPECT_NEAR(velocity.y(), -std::sqrt(2 * 5 * 9.81), 1e-3);  // before the impulse
    EXPECT_NEAR(height, 0.5, 1e-4);
    EXPECT_GT(flat.velocity(ball).y(), 0);
  }
}

TEST(PlanarState, AHandlerIsCalledOncePerStepWhileAContactLasts) {
  Flat flat;
  flat.ground();
  flat.box(1, 1, 0, 0.6);
  flat.world.handle_collisions(1, 2, "hit", flat.controller);
  int calls = 0;
  flat.script.on_collided = [&](ObjectId, ObjectId, const Vector3&, const Vector3&) {
    ++calls;
    return false;
  };
  flat.run(1);
  calls = 0;
  for (int i = 0; i < 10; ++i) flat.world.step();
  EXPECT_EQ(calls, 10);
}

TEST(PlanarState, AHandlerMayFreeBothBodies) {
  Flat flat;
  const ObjectId a = flat.ball(0.5, 0, 3), b = flat.ball(0.5, 0.1, 0);
  flat.set_velocity(a, {0, -50, 0});
  flat.world.handle_collisions(1, 1, "hit", flat.controller);
  flat.script.on_collided = [&](ObjectId, ObjectId, const Vector3&, const Vector3&) {
    flat.world.release(a);
    flat.world.release(b);
    return true;
  };
  flat.run(0.5);
  EXPECT_FALSE(flat.world.alive(a));
  EXPECT_EQ(flat.bodies().rigid(), 0U);
}

TEST(PlanarState, WhatClassesIgnoreFallsThrough) {
  Flat flat;
  flat.ground();
  const ObjectId ball = flat.ball(0.5, 0, 2);
  flat.world.ignore_collisions(1, 2);
  flat.run(2);
  EXPECT_LT(flat.at(ball).y(), -5);
}

TEST(PlanarState, OutlinesOfSolidsPrismsAndConcaveMeshesCarryWhatRollsOnThem) {
  Flat flat;
  flat.ground();
  // A prism of 24 sides lies with its axis along z: it rolls.
  std::vector<std::vector<Vector3>> faces(2);
  for (int i = 0; i < 24; ++i) {
    const double angle = 2 * M_PI * i / 24, next = 2 * M_PI * (i + 1) / 24;
    const auto at = [](double rotation, double z) { return Vector3(std::cos(rotation), std::sin(rotation), z); };
    faces[0].push_back(at(-angle, -0.5));
    faces[1].push_back(at(angle, 0.5));
    faces.push_back({at(angle, -0.5), at(next, -0.5), at(next, 0.5), at(angle, 0.5)});
  }
  const ObjectId wheel = flat.rigid(Shape::convex(faces, 1), 0, 1.05);
  flat.bodies().set_rotational_velocity(flat.index(wheel), {0, 0, -3});
  flat.set_velocity(wheel, {3, 0, 0});
  flat.run(2);
  EXPECT_GT(flat.at(wheel).x(), 3);
  EXPECT_NEAR(flat.at(wheel).y(), 1, 0.03);
  // A cup: a closed mesh whose outline is concave. A ball stays in it.
  const double outline[8][2] = {{-2, 0}, {2, 0}, {2, 2}, {1.5, 2}, {1.5, 0.5}, {-1.5, 0.5}, {-1.5, 2}, {-2, 2}};
  const int ears[6][3] = {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}, {0, 5, 6}, {0, 6, 7}};
  std::vector<Vector3> corners;
  std::vector<std::array<std::int32_t, 3>> triangles;
  for (const double z : {-0.5, 0.5})
    for (const auto& p : outline) corners.emplace_back(p[0], p[1], z);
  for (const auto& t : ears) {
    triangles.push_back({t[2], t[1], t[0]});
    triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  }
  for (int i = 0; i < 8; ++i) {
    const int k = (i + 1) % 8;
    triangles.push_back({i, k, k + 8});
    triangles.push_back({i, k + 8, i + 8});
  }
  const ObjectId cup = flat.rigid(Shape::mesh(corners, triangles), 20, 0.5);
  const ObjectId ball = flat.ball(0.4, 20.3, 3);
  flat.run(4);
  EXPECT_NEAR(flat.at(ball).x(), flat.at(cup).x(), 1.2);
  EXPECT_GT(flat.at(ball).y(), 0.7);
  EXPECT_LT(flat.at(ball).y(), 1.2);
}

TEST(PlanarState, AHeightFieldIsAProfileToStandOn) {
  Flat flat;
  std::vector<double> heights;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 41; ++column) heights.push_back(std::abs(column - 20) * 0.2);
  flat.fixed(Shape::height_field(41, 3, 1, heights), 0, 0);
  const ObjectId ball = flat.ball(0.5, 6, 5);
  flat.material(ball, 0.5, 0);
  flat.run(20);
  EXPECT_NEAR(flat.at(ball).x(), 0, 2);
  EXPECT_GT(flat.at(ball).y(), 0.4);
}

TEST(PlanarState, AnOpenMeshIsAProfileToStandOn) {
  // A valley of two slopes of 1 in 5, one triangle mesh of two rows of corners at z = -1 and 1.
  constexpr int kColumns = 21;
  std::vector<Vector3> corners;
  for (const double z : {-1.0, 1.0})
    for (int column = 0; column < kColumns; ++column) corners.emplace_back(column - 10, 0.2 * std::abs(column - 10), z);
  std::vector<std::array<std::int32_t, 3>> triangles;
  for (int i = 0; i + 1 < kColumns; ++i) {
    triangles.push_back({i, i + kColumns, i + kColumns + 1});
    triangles.push_back({i, i + kColumns + 1, i + 1});
  }
  Flat flat;
  flat.fixed(Shape::mesh(corners, triangles), 0, 0);
  const ObjectId ball = flat.ball(0.5, 3, 2);
  flat.material(ball, 0.5, 0);
  flat.run(2);
  bool crossed = false;
  for (int i = 0; i < 100; ++i) {  // it rolls to and fro, never higher
    flat.run(0.1);
    const Vector3 at = flat.at(ball);
    crossed = crossed || at.x() < 0;
    EXPECT_LT(std::abs(at.x()), 3);
    EXPECT_NEAR(at.y(), 0.2 * std::abs(at.x()) + 0.5 * std::sqrt(1.04), 0.05);
  }
  EXPECT_TRUE(crossed);
}

TEST(PlanarState, EveryRefusedAllocationIsAnErrorAndNothingLeaks) {
  for (std::size_t limit = 0; limit < 400'000; limit += 7001) {
    MemoryMeter memory;
    std::size_t used = 0;
    {
      World world(&memory);
      FakeBehaviour script;
      script.recording = false;
      world.set_behaviour(&script);
      const ObjectId controller = world.create(0, 0, true, false);
      script.on_iterate = [&](ObjectId id) {
        if (id == controller) world.advance_bodies();
      };
      used = memory.used();
      memory.set_limit(used + limit + 1);
      try {
        world.flatten();
        for (int i = 0; i < 20; ++i) {
          const ObjectId id = world.create(1, 0, false, false);
          world.embody(id, BodyKind::Mobile);
          world.bodies().set_location(world.body(id), {0.5 * i, 0.1 * i, 0});
          world.bodies().set_physics(world.body(id), true);
        }
        for (int i = 0; i < 5; ++i) world.step();
      } catch (const std::bad_alloc&) {
      }
      memory.set_limit(0);
      world.step();  // it can be used on
    }
    ASSERT_EQ(memory.used(), 0U);
  }
}

TEST(PlanarState, SettingsGoOverWhenAWorldBecomesFlatAndABodyWithPhysicsIsTooLate) {
  Scene scene;
  scene.world.mechanics().set_gravity({0, -3, 0});
  scene.world.mechanics().set_accuracy(Rung::Precise);
  scene.world.flatten();
  EXPECT_EQ(scene.world.dimension(), 2);
  EXPECT_EQ(scene.world.mechanics().gravity(), Vector3(0, -3, 0));
  EXPECT_EQ(scene.world.mechanics().accuracy().rung, Rung::Precise);
  Scene late;
  late.world.bodies().set_physics(late.world.body(late.body(1, {0, 0, 0})), true);
  EXPECT_THROW(late.world.flatten(), Error);
}

TEST(PlanarState, StepsThatAreSetAloneActAndItsWordsSayWhatHasNoMeaning) {
  const auto sub_steps = [](auto&& set) {
    Flat flat;
    flat.ball(0.5, 0, 0);
    Accuracy accuracy = flat.physics().accuracy();
    accuracy.custom = true;
    set(accuracy);
    flat.physics().set_accuracy(accuracy);
    flat.world.step();
    return flat.physics().counters().sub_steps;
  };
  for (const auto& [rung, wanted] : {std::pair{Rung::Fast, 1U}, {Rung::Balanced, 4U}, {Rung::Precise, 16U}}) {
    Flat flat(rung);
    flat.ball(0.5, 0, 0);
    flat.world.step();
    EXPECT_EQ(flat.physics().counters().sub_steps, wanted);
  }
  EXPECT_EQ(sub_steps([](Accuracy&) {}), 4U);
  EXPECT_EQ(sub_steps([](Accuracy& a) { a.step = 1e-3; }), 17U);
  EXPECT_EQ(sub_steps([](Accuracy& a) { a.contact_step = 1e-3; }), 17U);
  EXPECT_EQ(sub_steps([](Accuracy& a) { a.contact_step = 1e-3, a.step = 1.0 / 3000; }), 50U);
  EXPECT_EQ(sub_steps([](Accuracy& a) { a.tolerance = 1e-9; }), 4U);
  Flat flat;
  const std::string words = flat.physics().describe_accuracy();
  for (const char* what : {"4 sub-steps", "Without effect here", "integrator", "erp and cfm", "workers"})
    EXPECT_NE(words.find(what), std::string::npos) << words;
}

TEST(PlanarState, BodiesThatComeAndGoTakeTheirEnergyAlong) {
  Flat flat;
  const ObjectId first = flat.ball(0.5, 0, 10), second = flat.ball(0.5, 3, 20);
  flat.run(0.2);
  flat.world.save(1);
  flat.ball(0.5, 6, 30);  // while the world is to be made anew
  flat.world.release(first);
  flat.run(0.2);
  flat.bodies().set_physics(flat.index(second), false);
  flat.run(0.2);
  EXPECT_NEAR(flat.physics().energy().residual, 0, 0.1);
}

TEST(PlanarState, WhatScriptsDoToSpringsIsTheirWork) {
  Flat flat(Rung::Precise);
  flat.physics().set_gravity(Vector3::Zero());
  const ObjectId a = flat.fixed(Shape::box({1, 1, 1}), 0, 0), b = flat.box(0.5, 0.5, 3, 0);
  flat.run(0.1);
  SpringDescription spring;
  spring.a = flat.index(a);
  spring.b = flat.index(b);
  spring.length = 2;
  spring.strength = 10;
  spring.damping = 0;
  const SpringIndex made = flat.physics().add_spring(spring, b);
  const auto expect_work = [&](double work) {
    // A first-order rule swings by some thousandths of the energy.
    EXPECT_NEAR(flat.physics().energy().script_work, work, 0.05);
    EXPECT_NEAR(flat.physics().energy().residual, 0, 0.05);
  };
  expect_work(5);  // stretched by 1 m
  flat.run(0.1);
  expect_work(5);
  flat.bodies().set_velocity(flat.index(b), {0, 0, 0});
  flat.bodies().set_location(flat.index(b), {4, 0, 0});
  flat.world.step();
  const double stretched = flat.physics().energy().script_work;
  EXPECT_NEAR(flat.physics().energy().total(), 20, 0.1);  // by 2 m, from rest
  EXPECT_NEAR(stretched, 20, 0.1);
  expect_work(stretched);
  flat.physics().remove_spring(made);
  expect_work(stretched - 20 + flat.physics().energy().kinetic);
}

TEST(PlanarState, TheLedgerExplainsWhereEnergyWent) {
  Flat flat;
  flat.ground();
  const ObjectId box = flat.box(1, 1, 0, 0.5);
  flat.material(box, 0.5, 0);
  flat.set_velocity(box, {6, 0, 0});
  flat.world.step();
  const Energy first = flat.physics().energy();
  const double start = first.total();
  flat.run(3);
  Energy now = flat.physics().energy();
  now.friction_loss -= first.friction_loss;
  now.contact_loss -= first.contact_loss;
  EXPECT_NEAR(now.kinetic, 0, 1e-3);
  EXPECT_NEAR(now.friction_loss + now.contact_loss, start - now.total(), 0.05 * start);
  EXPECT_GT(now.friction_loss, 0.5 * (start - now.total()));
  EXPECT_NEAR(now.residual, 0, 0.05 * start);
}

}  // namespace
}  // namespace breve::testing
