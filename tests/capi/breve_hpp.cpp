// breve.hpp: what it adds to breve.h, by the standard that it promises, C++17.
#include "breve/breve.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

constexpr const char* kText =
    "@use Control.\n@use Mobile.\n@use Shape.\n@use Stationary.\n"
    "Controller Stage.\n"
    "Control : Stage {\n"
    "  + variables:\n"
    "    count (int).\n    title (string).\n    things (list).\n    mover (object).\n    item (object).\n"
    "  + to init:\n"
    "    title = \"a stage\".\n    things = { 1, \"two\" }.\n    mover = new Mobile.\n"
    "    item = (self add-menu named \"Go\" for-method \"go\").\n"
    "  + to go: count += 1.\n"
    "  + to catch-key-k-down: count += 100.\n"
    "  + to click on what (object): count += 1000.\n"
    "  + to add first x (int) second y = 1 (int): return x + y.\n"
    "  + to join text a (string) with b (string): return \"$a$b\".\n"
    "  + to fail: die \"as asked\".\n"
    "}\n"
    "Stationary : Block {\n"
    "  + to init: self register with-shape ((new Cube) init-with size (2, 2, 2)) at-location (0, 9, 0).\n"
    "}\n";

struct Stage {
  breve::Runtime runtime = breve::Runtime::create().or_throw();
  breve::Program program = runtime.compile("stage.tz", kText).or_throw();
  breve::World world = runtime.world(program).or_throw();
  breve::Object controller = world.controller();
};

TEST(BreveHpp, HandlesMoveAndCleanUp) {
  Stage stage;
  breve::World moved = std::move(stage.world);
  EXPECT_TRUE(moved.step());
  EXPECT_EQ(moved.iteration(), 1U);
  EXPECT_EQ(stage.world.step().code(), BREVE_ERROR_ARGUMENT);
  stage.runtime = {};
  stage.program = {};
  EXPECT_TRUE(moved.step());
}

TEST(BreveHpp, NothingThrowsUnlessAsked) {
  Stage stage;
  const auto bad = stage.runtime.compile("bad.tz", "Controller");
  EXPECT_FALSE(bad);
  EXPECT_EQ(bad.status().code(), BREVE_ERROR_COMPILE);
  EXPECT_FALSE(bad.text().empty());
  EXPECT_FALSE(stage.runtime.diagnostics().empty());
  EXPECT_THROW(stage.runtime.compile("bad.tz", "Controller").or_throw(), breve::Failure);
  auto failed = stage.world.call(stage.controller, "fail");
  EXPECT_EQ(failed.status().code(), BREVE_ERROR_SCRIPT);
  EXPECT_NE(failed.text().find("as asked"), std::string_view::npos);
  try {
    stage.world.call(stage.controller, "fly").or_throw();
    FAIL();
  } catch (const breve::Failure& e) {
    EXPECT_EQ(e.status(), BREVE_ERROR_NOT_FOUND);
    EXPECT_NE(std::string(e.what()).find("fly"), std::string::npos);
  }
}

TEST(BreveHpp, ValuesConvertBothWays) {
  Stage stage;
  auto& w = stage.world;
  EXPECT_EQ(w.call(stage.controller, "add", {{"first", 41}}).or_throw().integer(), 42);
  EXPECT_EQ(w.call(stage.controller, "join", {{"with", std::string("yz")}, {"text", "x"}}).or_throw().string(), "xyz");
  EXPECT_EQ(w.get(stage.controller, "title").or_throw().string(), "a stage");
  w.set(stage.controller, "title", "new").or_throw();
  EXPECT_EQ(w.get(stage.controller, "title").or_throw().string(), "new");
  const auto things = w.elements(w.get(stage.controller, "things").or_throw()).or_throw();
  ASSERT_EQ(things.size(), 2U);
  EXPECT_EQ(things[0].integer(), 1);
  EXPECT_EQ(things[1].string(), "two");
  EXPECT_EQ(things[1].number(7), 7);
  EXPECT_EQ(w.text(breve::Vector{1, 2, 3}).or_throw(), "(1.00000, 2.00000, 3.00000)");
  const auto add = w.prepare("add", {"second", "first"}).or_throw();
  EXPECT_EQ(w.call(stage.controller, add, {1, 2}).or_throw().integer(), 3);
}

TEST(BreveHpp, ManyObjectsAreOneCall) {
  Stage stage;
  breve::World& w = stage.world;
  const breve::Object two[] = {stage.controller, stage.controller};
  const auto add = w.prepare("add", {"second", "first"}).or_throw();
  breve_value sums[2];
  w.call_all(two, 2, add, {1, 2}, sums).or_throw();
  EXPECT_EQ(sums[1].as.integer, 3);
  const auto balls = w.objects("Mobile").or_throw();
  ASSERT_FALSE(balls.empty());
  float place[3] = {1, 2, 3};
  double pose[7];
  w.set_all(balls.data(), 1, BREVE_PROPERTY_LOCATION, breve::Array(place, 3)).or_throw();
  w.get_all(balls.data(), 1, BREVE_PROPERTY_POSE, breve::Array(pose, 7)).or_throw();
  EXPECT_EQ(pose[2], 3);
  EXPECT_FALSE(w.get_all(two, 2, "title", breve::Array(pose, 1)));
}

TEST(BreveHpp, ManyObjectsAreGivenAsListsThatKnowTheirSizes) {
  Stage stage;
  breve::World& w = stage.world;
  for (int i = 0; i < 2; ++i) (void)w.create("Mobile").or_throw();
  const std::vector<breve::Object> balls = w.objects("Mobile").or_throw();
  ASSERT_EQ(balls.size(), 3U);
  const std::vector<breve::Vector> places = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  EXPECT_TRUE(w.set_all(balls, BREVE_PROPERTY_LOCATION, places));
  float poses[21];
  EXPECT_TRUE(w.get_all(balls, BREVE_PROPERTY_POSE, poses));
  EXPECT_EQ(poses[14], 7);
  std::vector<double> flat(9);
  EXPECT_TRUE(w.get_all(w.objects("Mobile").or_throw(), BREVE_PROPERTY_LOCATION, flat));
  EXPECT_EQ(flat[5], 6);
  std::vector<breve::Vector> between(3);
  w.set_interpolated(true).or_throw();
  EXPECT_TRUE(w.interpolate_all(balls, 1, BREVE_PROPERTY_LOCATION, between));
  EXPECT_EQ(between[2], places[2]);
  const breve::Object stages[] = {stage.controller};
  EXPECT_TRUE(w.set_all(stages, "count", std::array<double, 1>{7}));
  std::array<double, 1> count{};
  EXPECT_TRUE(w.get_all(stages, "count", count));
  EXPECT_EQ(count[0], 7);
  std::vector<double> none;
  EXPECT_TRUE(w.get_all(std::vector<breve::Object>(), BREVE_PROPERTY_LOCATION, none));
}

/// A list that is too short is refused, and nothing beyond it is written.
TEST(BreveHpp, ListsOfAnotherSizeAreRefused) {
  Stage stage;
  breve::World& w = stage.world;
  const breve::Object two[] = {w.create("Mobile").or_throw(), w.create("Mobile").or_throw()};
  std::vector<double> numbers(5);
  EXPECT_EQ(w.get_all(two, BREVE_PROPERTY_LOCATION, numbers).code(), BREVE_ERROR_ARGUMENT);
  numbers.resize(4);
  EXPECT_EQ(w.get_all(two, BREVE_PROPERTY_LOCATION, numbers).code(), BREVE_ERROR_ARGUMENT);
  EXPECT_EQ(w.set_all(two, BREVE_PROPERTY_POSE, numbers).code(), BREVE_ERROR_ARGUMENT);
  std::vector<breve::Vector> places(1);
  EXPECT_EQ(w.get_all(two, BREVE_PROPERTY_VELOCITY, places).code(), BREVE_ERROR_ARGUMENT);
  EXPECT_EQ(w.interpolate_all(two, 0, BREVE_PROPERTY_LOCATION, places).code(), BREVE_ERROR_ARGUMENT);
  numbers.clear();
  EXPECT_EQ(w.get_all(two, "count", numbers).code(), BREVE_ERROR_NOT_FOUND);
  EXPECT_EQ(breve::World().get_all(std::vector<breve::Object>(), BREVE_PROPERTY_LOCATION, numbers).code(),
            BREVE_ERROR_ARGUMENT);
}

TEST(BreveHpp, ValuesTellWhetherTheyBorrow) {
  Stage stage;
  auto& w = stage.world;
  EXPECT_TRUE(w.get(stage.controller, "title").or_throw().borrows());
  EXPECT_TRUE(w.get(stage.controller, "things").or_throw().borrows());
  EXPECT_TRUE(w.create_hash().or_throw().borrows());
  EXPECT_TRUE(breve::Value("text").borrows());
  EXPECT_FALSE(w.get(stage.controller, "count").or_throw().borrows());
  EXPECT_FALSE(w.get(stage.controller, "mover").or_throw().borrows());
  EXPECT_FALSE(breve::Value().borrows() || breve::Value(0.5).borrows());
  EXPECT_FALSE(breve::Value(breve::Vector{1, 2, 3}).borrows());
  EXPECT_FALSE(breve::Value::matrix({1, 0, 0, 0, 1, 0, 0, 0, 1}).borrows());
}

TEST(BreveHpp, ValuesAreMadeOfAnyNumberAndText) {
  const auto same = [](const breve::Value& value, int number) {
    return value.type == std::uint32_t{BREVE_TYPE_INT} && value.integer() == number;
  };
  EXPECT_TRUE(same(0, 0) && same(7L, 7) && same(7LL, 7) && same(7U, 7) && same(std::size_t{7}, 7));
  EXPECT_TRUE(same(std::uint8_t{255}, 255) && same(std::int8_t{-128}, -128) && same(short{-3}, -3) && same(true, 1));
  EXPECT_TRUE(same(INT32_MAX, INT32_MAX) && same(std::int64_t{INT32_MIN}, INT32_MIN));
  EXPECT_EQ(breve::Value(std::int64_t{INT32_MAX} + 1).type, std::uint32_t{BREVE_TYPE_DOUBLE});
  EXPECT_EQ(breve::Value(std::int64_t{INT32_MIN} - 1).number(), -2147483649.0);
  EXPECT_EQ(breve::Value(UINT64_MAX).number(), 18446744073709551615.0);
  EXPECT_EQ(breve::Value(0.5F).number(), 0.5);
  const std::string text = "text";
  EXPECT_EQ(breve::Value(text).string().data(), text.data());
  EXPECT_EQ(breve::Value(std::string_view(text).substr(1)).string(), "ext");
  EXPECT_EQ(breve::Value(breve::Object{}).type, std::uint32_t{BREVE_TYPE_OBJECT});
  EXPECT_EQ(breve::Value::matrix({1, 0, 0, 0, 1, 0, 0, 0, 1}).type, std::uint32_t{BREVE_TYPE_MATRIX});
}

TEST(BreveHpp, ListsAndHashesAreMadeAndRead) {
  Stage stage;
  auto& w = stage.world;
  const auto list = w.create_list().or_throw();
  w.push(list, "a").or_throw();
  w.push(list, 2).or_throw();
  EXPECT_EQ(w.list_size(list).or_throw(), 2U);
  EXPECT_EQ(w.element(list, 1).or_throw().integer(), 2);
  EXPECT_EQ(w.element(list, 2).status().code(), BREVE_ERROR_NOT_FOUND);
  const auto hash = w.create_hash().or_throw();
  w.hash_set(hash, "key", 0.5).or_throw();
  EXPECT_EQ(w.hash_size(hash).or_throw(), 1U);
  EXPECT_EQ(w.hash_get(hash, "key").or_throw().number(), 0.5);
  EXPECT_EQ(w.elements(w.hash_keys(hash).or_throw()).or_throw().at(0).string(), "key");
}

TEST(BreveHpp, ListsGoIntoTheRoomOfTheHost) {
  Stage stage;
  auto& w = stage.world;
  breve::Object one[1];
  EXPECT_GT(w.objects(nullptr, one).or_throw(), 1U);
  EXPECT_EQ(one[0], w.objects().or_throw().front());
  const auto block = w.create("Block").or_throw();
  std::array<breve::Vector, 8> corners{};
  std::array<std::uint32_t, 6> sizes{};
  std::array<std::uint32_t, 24> indices{};
  w.shape_vertices(block, corners).or_throw();
  w.shape_faces(block, sizes, indices).or_throw();
  EXPECT_EQ(w.shape_vertices(block).or_throw().back(), corners.back());
  EXPECT_EQ(w.shape_faces(block).or_throw()[5][3], indices[23]);
  std::vector<unsigned char> image(w.snapshot(breve::Room<unsigned char>(nullptr, 0)).or_throw());
  EXPECT_EQ(w.snapshot(image).or_throw(), image.size());
  w.restore(image.data(), image.size()).or_throw();
  EXPECT_TRUE(w.alive(block));
}

TEST(BreveHpp, TheRestOfTheInterfaceIsWrapped) {
  EXPECT_EQ(breve::abi(), std::uint32_t{BREVE_ABI});
  EXPECT_STREQ(breve::version(), breve_version());
  EXPECT_EQ(breve::find_rung("precise").or_throw(), BREVE_RUNG_PRECISE);
  EXPECT_EQ(breve::accuracy_of(BREVE_RUNG_FAST).or_throw().rung, std::uint32_t{BREVE_RUNG_FAST});
  EXPECT_FALSE(breve::lint(breve::lint_count()));
  EXPECT_GT(breve::library_module(0).or_throw().size, 0U);
  Stage stage;
  auto& w = stage.world;
  EXPECT_STREQ(stage.program.class_at(stage.program.class_count() - 1).or_throw().name, "Block");
  EXPECT_NEAR(w.gravity().or_throw()[1], -9.81, 1e-12);
  w.set_space(1, BREVE_EDGE_WALL, -2, 3).or_throw();
  EXPECT_EQ(w.space(1).or_throw().edge, BREVE_EDGE_WALL);
  EXPECT_EQ(w.space(1).or_throw().high, 3);
  w.set_guard(BREVE_GUARD_REPORT).or_throw();
  EXPECT_EQ(w.guard(), BREVE_GUARD_REPORT);
  EXPECT_FALSE(w.accuracy_text().or_throw().empty());
  EXPECT_EQ(w.grid_size(stage.controller).status().code(), BREVE_ERROR_NOT_FOUND);
  EXPECT_EQ(w.spring(stage.controller).status().code(), BREVE_ERROR_TYPE);
  EXPECT_EQ(w.physics_counters().or_throw().contacts, 0U);
}

TEST(BreveHpp, ObjectsAreReadAndWritten) {
  Stage stage;
  auto& w = stage.world;
  const auto mover = w.get(stage.controller, "mover").or_throw().object();
  EXPECT_TRUE(w.alive(mover));
  EXPECT_EQ(w.class_of(mover), "Mobile");
  EXPECT_TRUE(w.is_a(mover, "Real"));
  w.set_velocity(mover, {0, 3, 0}).or_throw();
  EXPECT_EQ(w.velocity(mover).or_throw()[1], 3);
  w.set_rotational_velocity(mover, {0, 0, 1}).or_throw();
  EXPECT_EQ(w.rotational_velocity(mover).or_throw()[2], 1);
  w.set_color(mover, {0, 0.5, 1, 1}).or_throw();
  EXPECT_EQ(w.color(mover).or_throw()[1], 0.5);
  w.set_pose(mover, {{1, 2, 3}, {1, 0, 0, 0}}).or_throw();
  EXPECT_EQ(w.pose(mover).or_throw().location[2], 3);
  EXPECT_EQ(w.shape(mover).or_throw().kind, BREVE_SHAPE_SPHERE);
  EXPECT_TRUE(w.shape_vertices(mover).or_throw().empty());
  const auto block = w.create("Block").or_throw();
  EXPECT_EQ(w.objects("Block").or_throw().size(), 1U);
  EXPECT_EQ(w.shape_vertices(block).or_throw().size(), 8U);
  const auto faces = w.shape_faces(block).or_throw();
  ASSERT_EQ(faces.size(), 6U);
  EXPECT_EQ(faces[5].size(), 4U);
  w.free(block).or_throw();
  EXPECT_EQ(w.pose(block).status().code(), BREVE_ERROR_STALE);
  EXPECT_NE(block, mover);
}

TEST(BreveHpp, InputStepsAndSnapshots) {
  Stage stage;
  auto& w = stage.world;
  const auto count = [&] { return w.get(stage.controller, "count").or_throw().integer(); };
  w.key("k").or_throw();
  w.click().or_throw();
  w.choose(w.get(stage.controller, "item").or_throw().object()).or_throw();
  EXPECT_GE(w.menu_items().or_throw().size(), 1U);
  const auto snapshot = w.snapshot().or_throw();
  const auto hash = w.hash().or_throw();
  w.step().or_throw();
  EXPECT_EQ(count(), 1101);
  EXPECT_NE(w.hash().or_throw(), hash);
  w.restore(snapshot).or_throw();
  EXPECT_EQ(w.hash().or_throw(), hash);
  EXPECT_EQ(count(), 0);
  EXPECT_NEAR(w.advance(1.5 * w.iteration_step()).or_throw(), 0.5, 1e-9);
  EXPECT_EQ(w.iteration(), 1U);
  EXPECT_NEAR(w.time(), w.iteration_step(), 1e-12);
  EXPECT_EQ(w.seed(), 1U);
  EXPECT_LE(w.random().or_throw(), 1.0);
  w.set_paused(true).or_throw();
  EXPECT_TRUE(w.paused());
  EXPECT_FALSE(w.ended());
  EXPECT_FALSE(w.effects().or_throw().empty());
  EXPECT_EQ(w.stats().or_throw().iterations, 1U);
  EXPECT_EQ(w.last_error(), nullptr);
}

TEST(BreveHpp, ProfilesAreReadWhole) {
  Stage stage;
  auto& w = stage.world;
  EXPECT_EQ(w.profile().status().code(), BREVE_ERROR_NOT_FOUND);
  w.start_profile().or_throw();
  w.step().or_throw();
  w.stop_profile().or_throw();
  const auto nodes = w.profile().or_throw();
  ASSERT_GE(nodes.size(), 2U);
  EXPECT_EQ(nodes[0].kind, BREVE_PROFILE_WORLD);
  EXPECT_STREQ(nodes[1].name, "iteration");
}

TEST(World, EvaluatesStatementsAndGoesOnWithAChangedProgram) {
  auto runtime = breve::Runtime::create().or_throw();
  const char* const text = "@use Control.\nController Main.\nControl : Main { + to get: return 1. }\n";
  const char* const changed = "@use Control.\nController Main.\nControl : Main { + to get: return 2. }\n";
  auto world = runtime.world(runtime.compile("main.tz", text).or_throw()).or_throw();
  EXPECT_EQ(world.evaluate("x = (self get) + 1").or_throw().integer(), 2);
  ASSERT_TRUE(world.reload(runtime.compile("main.tz", changed).or_throw()));
  EXPECT_EQ(world.evaluate("x * 10 + (self get)", world.controller()).or_throw().integer(), 22);
  EXPECT_EQ(world.session().or_throw().type, static_cast<std::uint32_t>(BREVE_TYPE_HASH));
  EXPECT_EQ(world.evaluate("nowhere").status().code(), BREVE_ERROR_COMPILE);
  EXPECT_EQ(world.reload(breve::Program()).code(), BREVE_ERROR_ARGUMENT);
  EXPECT_TRUE(breve::statements_complete("x = 1") && !breve::statements_complete("x = {"));
  world.interrupt();
}

TEST(Functions, OfTheHostAnswerScriptsAndAreCounted) {
  auto runtime = breve::Runtime::create().or_throw();
  breve_function f = breve_function_default();
  f.name = "seven";
  f.result = BREVE_TYPE_INT;
  f.call = [](void*, const breve_call*, breve_value* result) {
    *result = breve::Value(7);
    return BREVE_OK;
  };
  ASSERT_TRUE(runtime.add_function(f));
  EXPECT_EQ(runtime.add_function(f).code(), BREVE_ERROR_ARGUMENT);
  const char* const text = "@use Control.\nController A.\nControl : A { + to get: return seven(). }\n";
  auto world = runtime.world(runtime.compile("a.tz", text).or_throw()).or_throw();
  EXPECT_EQ(world.call(world.controller(), "get").or_throw().integer(), 7);
  EXPECT_TRUE(world.charge(1));
}

TEST(Lints, AreAllowedByTheirCode) {
  auto runtime = breve::Runtime::create().or_throw();
  const char* text = "@use Control.\nController A.\nControl : A {\n  + to init: print 2 * 3 ^ 2.\n}\n";
  ASSERT_TRUE(runtime.compile("a.tz", text));
  EXPECT_EQ(runtime.diagnostics().size(), 1U);
  EXPECT_EQ(runtime.allow("lint-precedense").code(), BREVE_ERROR_NOT_FOUND);
  ASSERT_TRUE(runtime.allow("lint-precedence"));
  ASSERT_TRUE(runtime.compile("a.tz", text));
  EXPECT_TRUE(runtime.diagnostics().empty());
}

TEST(Analysis, TellsOfAProgramThatDoesNotCompile) {
  auto runtime = breve::Runtime::create().or_throw();
  auto analysis =
      runtime.analyse("a.tz", "Object : A {\n  + to hop: x = 1.\n  + to run: self ho.\n}\nController A.\n").or_throw();
  ASSERT_FALSE(analysis.diagnostics().empty());
  EXPECT_STREQ(analysis.diagnostics()[0].code, "unknown-variable");
  const auto symbols = analysis.symbols();
  EXPECT_STREQ(symbols.at(0).name, "a.tz");
  EXPECT_STREQ(symbols.at(1).signature, "Object : A");
  EXPECT_STREQ(analysis.at("a.tz", 2, 9).or_throw().name, "hop");
  EXPECT_EQ(analysis.at("a.tz", 9, 9).status().code(), BREVE_ERROR_NOT_FOUND);
  const auto items = analysis.completions("a.tz", 3, 20).or_throw();
  ASSERT_EQ(items.size(), 1U);
  EXPECT_STREQ(items[0].name, "hop");
  EXPECT_TRUE(runtime.analyse("empty.tz", {}));
  EXPECT_EQ(breve::Analysis().at("a.tz", 1, 1).status().code(), BREVE_ERROR_ARGUMENT);
}

TEST(Bodies, TellTheirListenerWhatCarriesThem) {
  auto runtime = breve::Runtime::create().or_throw();
  const auto program = runtime.library_program().or_throw();
  auto world = runtime.world(program).or_throw();
  int contacts = 0;
  breve_listener listener = world.listener().or_throw();
  EXPECT_EQ(listener.contact, nullptr);
  listener.user = &contacts;
  listener.contact = [](void* user, breve_world*, const breve_contact*) { ++*static_cast<int*>(user); };
  ASSERT_TRUE(world.set_listener(&listener));
  const breve::Object ball = world.create("Mobile").or_throw(), floor = world.create("Floor").or_throw();
  ASSERT_TRUE(world.watch_contacts(ball));
  EXPECT_TRUE(world.contacts_watched(ball).or_throw());
  EXPECT_FALSE(world.contacts_watched(floor).or_throw());
  breve_geometry box = breve_geometry_default();
  box.kind = BREVE_SHAPE_BOX;
  ASSERT_TRUE(world.set_shape(ball, world.create_shape(box).or_throw()));
  ASSERT_TRUE(world.set_pose(ball, {{0, 0.5, 0}, {1, 0, 0, 0}}));
  ASSERT_TRUE(world.set_physics(ball, true));
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(world.step());
  EXPECT_GT(contacts, 20);
  EXPECT_NEAR(world.contact_force(ball).or_throw()[1], 9.81, 0.01);
  EXPECT_NEAR(world.contact_force(floor, ball).or_throw()[1], -9.81, 0.01);
  ASSERT_TRUE(world.set_listener(nullptr));
  EXPECT_EQ(world.listener().or_throw().user, nullptr);
  EXPECT_FALSE(world.target(floor).or_throw().moves);
  ASSERT_TRUE(world.set_target(floor, world.pose(floor).or_throw()));
  EXPECT_TRUE(world.target(floor).or_throw().moves);
  ASSERT_TRUE(world.set_integration_step(0.005));
  EXPECT_EQ(world.integration_step(), 0.005);
}

TEST(Bodies, AreBuiltJoinedAndDrivenWithoutAScript) {
  auto runtime = breve::Runtime::create().or_throw();
  const auto program = runtime.library_program().or_throw();
  auto world = runtime.world(program).or_throw();
  const breve::Object arm = world.create("Link").or_throw(), ball = world.create("Mobile").or_throw();
  breve_geometry box = breve_geometry_default();
  box.kind = BREVE_SHAPE_BOX;
  ASSERT_TRUE(world.set_shape(ball, world.create_shape(box).or_throw()));
  EXPECT_NEAR(world.mass(ball).or_throw(), 1, 1e-12);
  ASSERT_TRUE(world.set_physics(ball, true));
  ASSERT_TRUE(world.set_gravity({0, 0, 0}));
  ASSERT_TRUE(world.set_force(ball, {1, 0, 0}));
  ASSERT_TRUE(world.set_material(ball, {0.5, 0.5, 0, 0, 0}));
  breve_joint_description hinge = breve_joint_description_default(BREVE_JOINT_REVOLUTE);
  hinge.child = arm;
  hinge.parent_point[1] = 5;
  const breve::Object joint = world.create_joint(hinge).or_throw();
  breve_drive drive = world.drive(joint).or_throw();
  drive.strength_limit = 5;
  drive.motor_speed[0] = 1;
  ASSERT_TRUE(world.set_drive(joint, drive));
  EXPECT_EQ(world.links(arm).or_throw().size(), 1U);
  EXPECT_EQ(world.joints(arm).or_throw().size(), 1U);
  breve_spring spring = breve_spring_default();
  spring.from = arm;
  spring.to = ball;
  spring.strength = 0;
  ASSERT_TRUE(world.create_spring(spring));
  breve_accuracy accuracy = world.accuracy().or_throw();
  accuracy.step = 1e-3;
  ASSERT_TRUE(world.set_accuracy(accuracy));
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(world.step());
  EXPECT_NEAR(world.joint(joint).or_throw().position[0], 1, 0.05);
  EXPECT_NEAR(world.velocity(ball).or_throw()[0], 1, 1e-2);
  EXPECT_GT(world.energy().or_throw().kinetic, 0.4);
  EXPECT_TRUE(world.impacts().or_throw().empty());
  EXPECT_TRUE(world.interventions().or_throw().empty());
  ASSERT_TRUE(world.break_joint(joint));
  EXPECT_FALSE(world.joint(joint).or_throw().linked);
}

}  // namespace
