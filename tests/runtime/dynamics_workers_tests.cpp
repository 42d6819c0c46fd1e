// Islands on several threads: the same hash, the same events in the same order, the same errors as on one. Under
// ThreadSanitizer the same runs show that islands share nothing that they must not.
#include <gtest/gtest.h>

#include <new>

#include "dynamics_scene.hpp"
#include "runtime/base/error.hpp"

namespace breve::testing {
namespace {

/// Stacks, chains with motors, springs, spinning boxes, balls that rebound, and two handlers, in islands of their own.
struct Crowd : Physics {
  std::vector<JointIndex> joints;
  std::vector<ObjectId> balls;

  explicit Crowd(int workers, GuardMode guard = GuardMode::Rest, int count = 6) {
    mechanics().set_workers(workers);
    mechanics().set_guard(guard);
    mechanics().set_sleeping(true);
    body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(1000, 5, 1000)));
    for (int i = 0; i < count; ++i) {
      const double x = 10 * i;
      for (int k = 0; k < 3; ++k) rigid(Shape::box(Vector3(1, 1, 1)), Vector3(x, 0.5 + 1.1 * k, 0.02 * i * k));
      chain(Vector3(x, 3, 10));
      const ObjectId spinner = rigid(Shape::box(Vector3(1, 2, 3)), Vector3(x, 5, 20));
      world.bodies().set_rotational_velocity(index(spinner), Vector3(1, 500 + 20 * i, 2));  // the guard acts
      balls.push_back(rigid(Shape::sphere(0.5), Vector3(x, 1 + 0.1 * i, 30)));
      world.bodies().material(index(balls.back())).normal_restitution = 0.8;
    }
    world.handle_collisions(1, 2, "hit", balls[1]);
    script.on_collided = [this](ObjectId ball, ObjectId, const Vector3&, const Vector3&) {
      if (ball == balls[1] && world.time() > 0.3) set_velocity(ball, Vector3(0, 4, 0));
      return false;
    };
  }
  void chain(const Vector3& at) {
    ObjectId last = rigid(Shape::box(Vector3(0.2, 1, 0.2)), at);
    const ObjectId first = last;
    for (int k = 0; k < 2; ++k) {
      const ObjectId next = rigid(Shape::box(Vector3(0.2, 1, 0.2)), at);
      JointDescription is;
      is.parent = index(last);
      is.child = index(next);
      is.parent_point = Vector3(0, -0.5, 0);
      is.child_point = Vector3(0, 0.5, 0);
      is.normal = Vector3::UnitZ();
      joints.push_back(mechanics().link(is, next));
      JointDrive drive = mechanics().drive(joints.back());
      drive.motor_speed[0] = 3;
      drive.strength_limit = 0.5;
      drive.low[0] = -1;
      drive.high[0] = 1;
      mechanics().set_drive(joints.back(), drive);
      last = next;
    }
    SpringDescription spring;
    spring.a = index(first);
    spring.b = index(last);
    spring.length = 0.5;
    mechanics().add_spring(spring, first);
  }
  /// What a host can see of a step.
  std::string events() {
    std::string text;
    for (const Impact& one : mechanics().impacts())
      text += std::to_string(one.a.index) + '-' + std::to_string(one.b.index) + '@' + std::to_string(one.time) + ' ';
    for (const Intervention& one : mechanics().interventions())
      text += std::to_string(one.body.index) + '!' + std::to_string(static_cast<int>(one.reason)) + ' ';
    const DynamicsCounters& c = mechanics().counters();
    return text + std::to_string(c.sub_steps) + ' ' + std::to_string(c.contacts) + ' ' + std::to_string(c.sleeping);
  }
};

TEST(DynamicsWorkers, TheHashAndTheEventsDoNotDependOnThem) {
  for (const Rung rung : {Rung::Balanced, Rung::Fast}) {
    Crowd one(1);
    std::vector<std::unique_ptr<Crowd>> others;
    for (const int workers : {2, 3, 8}) others.push_back(std::make_unique<Crowd>(workers));
    one.mechanics().set_accuracy(rung);
    for (const auto& other : others) other->mechanics().set_accuracy(rung);
    std::size_t impacts = 0, interventions = 0;
    for (int i = 0; i < 60; ++i) {
      one.world.step();
      impacts += one.mechanics().impacts().size();
      interventions += one.mechanics().interventions().size();
      for (const auto& other : others) {
        other->world.step();
        ASSERT_EQ(other->world.hash(), one.world.hash()) << name_of(rung) << " step " << i;
        ASSERT_EQ(other->events(), one.events()) << name_of(rung) << " step " << i;
        ASSERT_EQ(other->mechanics().energy().residual, one.mechanics().energy().residual);
      }
    }
    EXPECT_TRUE(impacts > 10 || rung == Rung::Fast);
    EXPECT_GT(interventions, 10U);
  }
}

TEST(DynamicsWorkers, TheNumberMayChangeBetweenSteps) {
  Crowd one(1), two(1);
  for (int i = 0; i < 30; ++i) {
    two.mechanics().set_workers(1 + i % 4);
    one.world.step();
    two.world.step();
    ASSERT_EQ(one.world.hash(), two.world.hash());
  }
}

TEST(DynamicsWorkers, TheErrorIsThatOfTheFirstIsland) {
  std::string said;
  for (const int workers : {1, 2, 4}) {
    Crowd s(workers, GuardMode::Off);
    Accuracy accuracy = accuracy_of(Rung::Conserving);
    s.mechanics().set_accuracy(accuracy);
    for (std::size_t i = 0; i < s.joints.size(); i += 4) s.mechanics().set_velocity(s.joints[i], Vector3(1e9, 0, 0));
    try {
      s.run(0.5);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      if (said.empty()) said = error.what();
      EXPECT_EQ(error.what(), said);
    }
  }
}

/// Whatever allocation of whichever thread fails, the step ends with an error and gives all back.
TEST(DynamicsWorkers, MemoryThatEndsIsAnErrorOnAnyThread) {
  int failures = 0;
  for (std::size_t more = 0; more < 400'000 && failures < 1000; more += 4096) {
    Crowd s(3, GuardMode::Rest, 3);
    s.memory.set_limit(s.memory.used() + more);
    try {
      s.run(0.05);
      break;
    } catch (const std::bad_alloc&) {
      ++failures;
      EXPECT_LE(s.memory.used(), s.memory.limit());
    }
    s.memory.set_limit(0);
    s.run(0.05);
  }
  EXPECT_GT(failures, 5);
}

}  // namespace
}  // namespace breve::testing
