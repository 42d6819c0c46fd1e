// Numbers that no body can have, from the host and from a script: an error that names what is wrong, and a world that
// is the same bit for bit; and what is finite but far beyond sense leaves the world finite.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scenes.hpp"

namespace breve::reference {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Target {
  World world{1.0 / 60};
  Chain chain;
  breve_object ball;
  Target() {
    chain = hang(world, {1, 1}, {1, 1});
    ball = world.body(sphere(0.5, 1), Vector3(3, 2, 0));
    world.run(0.1);
  }
  /// The call must be refused with a text, and nothing may change.
  void refuse(const char* what, const std::function<breve_status()>& call) {
    const std::uint64_t before = world.hash();
    const breve_status status = call();
    EXPECT_EQ(status, BREVE_ERROR_ARGUMENT) << what << ": " << breve_status_name(status);
    if (status != BREVE_OK) {
      const breve_error* error = breve_world_last_error(world.get());
      EXPECT_TRUE(error && error->message[0] != '\0') << what;
    }
    EXPECT_EQ(world.hash(), before) << what;
  }
};

TEST(Refusals, VectorsThatAreNotFinite) {
  Target t;
  breve_world* world = t.world.get();
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      double v[3] = {1, 2, 3};
      v[axis] = bad;
      breve_pose pose{{v[0], v[1], v[2]}, {1, 0, 0, 0}};
      t.refuse("velocity", [&] { return breve_object_set_velocity(world, t.ball, v); });
      t.refuse("velocity of a link", [&] { return breve_object_set_velocity(world, t.chain.links[0], v); });
      t.refuse("spin", [&] { return breve_object_set_rotational_velocity(world, t.ball, v); });
      t.refuse("place", [&] { return breve_object_set_pose(world, t.ball, &pose); });
      t.refuse("place of an assembly", [&] { return breve_object_set_assembly_pose(world, t.chain.links[1], &pose); });
      t.refuse("force", [&] { return breve_object_set_force(world, t.ball, v, nullptr); });
      t.refuse("torque", [&] { return breve_object_set_force(world, t.ball, nullptr, v); });
      t.refuse("gravity", [&] { return breve_world_set_gravity(world, v); });
      t.refuse("joint", [&] { return breve_joint_set_state(world, t.chain.joints[0], axis == 0 ? v : nullptr, v); });
    }
    breve_pose pose{{0, 0, 0}, {1, bad, 0, 0}};
    t.refuse("rotation", [&] { return breve_object_set_pose(world, t.ball, &pose); });
  }
}

TEST(Refusals, SizesMassesAndAxes) {
  Target t;
  breve_world* world = t.world.get();
  breve_object made;
  for (const double bad : {kNan, kInfinity, 0.0, -1.0}) {
    breve_geometry ball = breve_geometry_default(), block = ball;
    ball.radius = bad;
    t.refuse("radius", [&] { return breve_shape_create(world, &ball, &made); });
    ball.radius = 1;
    ball.density = bad;
    t.refuse("density", [&] { return breve_shape_create(world, &ball, &made); });
    block.kind = BREVE_SHAPE_BOX;
    block.size[1] = bad;
    t.refuse("size", [&] { return breve_shape_create(world, &block, &made); });
    breve_joint_description hinge = breve_joint_description_default(BREVE_JOINT_REVOLUTE);
    hinge.child = t.ball;
    hinge.normal[0] = std::isfinite(bad) ? 0 : bad;
    t.refuse("normal", [&] { return breve_joint_create(world, &hinge, &made); });
    hinge.normal[0] = 1;
    hinge.rotation[0] = std::isfinite(bad) ? 0 : bad;
    t.refuse("rotation of a joint", [&] { return breve_joint_create(world, &hinge, &made); });
    hinge.rotation[0] = 1;
    hinge.parent = t.ball;
    t.refuse("a body joined to itself", [&] { return breve_joint_create(world, &hinge, &made); });
    breve_accuracy accuracy = t.world.accuracy();
    accuracy.tolerance = bad;
    t.refuse("tolerance", [&] { return breve_world_set_accuracy(world, &accuracy); });
    accuracy = t.world.accuracy();
    accuracy.step = bad == 0 ? -1e-3 : bad;
    t.refuse("step", [&] { return breve_world_set_accuracy(world, &accuracy); });
    accuracy = t.world.accuracy();
    accuracy.contact_stiffness = bad;
    t.refuse("stiffness of contacts", [&] { return breve_world_set_accuracy(world, &accuracy); });
    if (bad != 0) {
      const breve_material material{bad, 0.5, 0.5, 0, 0};
      t.refuse("friction", [&] { return breve_object_set_material(world, t.ball, &material); });
      breve_drive drive = t.world.drive(t.chain.joints[0]);
      drive.damping = bad;
      t.refuse("damping", [&] { return breve_joint_set_drive(world, t.chain.joints[0], &drive); });
    }
  }
}

TEST(Refusals, StepsOfAWorld) {
  breve_runtime* runtime = nullptr;
  breve_program* program = nullptr;
  breve_world* world = nullptr;
  ASSERT_EQ(breve_runtime_create(nullptr, &runtime), BREVE_OK);
  ASSERT_EQ(breve_program_create_library(runtime, nullptr, &program), BREVE_OK);
  for (const double bad : {kNan, kInfinity, -1.0}) {
    breve_world_config config = breve_world_config_default();
    config.iteration_step = bad;
    EXPECT_EQ(breve_world_create(runtime, program, &config, &world), BREVE_ERROR_ARGUMENT);
    config.iteration_step = 0;
    config.integration_step = bad;
    EXPECT_EQ(breve_world_create(runtime, program, &config, &world), BREVE_ERROR_ARGUMENT);
  }
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
}

TEST(Refusals, ScriptsAreToldWhatIsWrong) {
  Target t;
  breve_object shape;
  const breve_geometry geometry = breve_geometry_default();
  t.world.must(breve_shape_create(t.world.get(), &geometry, &shape));
  const auto refuse = [&](breve_object self, const std::string& text, const std::string& word) {
    const std::uint64_t before = t.world.hash();
    EXPECT_EQ(breve_world_evaluate(t.world.get(), self, text.c_str(), text.size(), nullptr), BREVE_ERROR_SCRIPT)
        << text;
    const std::string message = breve_world_last_error(t.world.get())->message;
    EXPECT_NE(message.find(word), std::string::npos) << text << ": " << message;
    EXPECT_EQ(t.world.hash(), before) << text;
  };
  for (const char* number : {"0.0", "-1.0"}) {
    refuse(shape, std::string("self set-mass to ") + number, "mass");
    refuse(shape, std::string("self set-density to ") + number, "density");
    refuse(shape, std::string("self init-with-sphere radius ") + number, "radius");
  }
  refuse(t.chain.joints[0], "self set-joint-damping to -1.0", "damping");
  refuse(t.ball, "self set-friction static -1.0 dynamic 0.5", "friction");
  refuse(t.ball, "self set-restitution normal 2.0", "restitution");
}

/// 1e308 is finite: it may be set, and must not spoil the world.
TEST(Refusals, TheLargestNumbersLeaveTheWorldFinite) {
  for (int kind = 0; kind < 4; ++kind) {
    Target t;
    const double huge[3] = {1e308, -1e308, 1e308};
    const breve_pose away{{1e308, 0, 0}, {1, 0, 0, 0}};
    breve_world* world = t.world.get();
    const breve_status status = kind == 0   ? breve_object_set_velocity(world, t.ball, huge)
                                : kind == 1 ? breve_object_set_rotational_velocity(world, t.chain.links[0], huge)
                                : kind == 2 ? breve_object_set_force(world, t.ball, huge, huge)
                                            : breve_object_set_pose(world, t.ball, &away);
    EXPECT_NE(status, BREVE_ERROR_INTERNAL) << kind;
    for (int i = 0; i < 10; ++i) EXPECT_NO_THROW(t.world.step()) << kind;
    for (const breve_object one : {t.ball, t.chain.links[0], t.chain.links[1]}) {
      EXPECT_TRUE(t.world.at(one).allFinite()) << kind;
      EXPECT_TRUE(t.world.velocity(one).allFinite()) << kind;
      EXPECT_TRUE(t.world.spin(one).allFinite()) << kind;
    }
  }
}

}  // namespace
}  // namespace breve::reference
