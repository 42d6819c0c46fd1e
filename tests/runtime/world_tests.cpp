// The step, the clock, the schedule, observers, ids and the ledger of effects.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/runtime/fake_behaviour.hpp"

namespace breve {
namespace {

using testing::FakeBehaviour;
using testing::Scene;
using Calls = std::vector<std::string>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

ErrorCode code_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::Unsupported;
}

TEST(Step, RunsInputIteratePostIterateScheduleAndEndInThisOrder) {
  Scene s;
  const ObjectId agent = s.world.create(1, 0, true, true);
  s.world.schedule(agent, "beat", 0.01);
  s.world.queue_input({InputEvent::Kind::KeyDown, "x", {}});
  s.world.step();
  EXPECT_EQ(s.script.calls, (Calls{"input 0 x", "iterate 0", "iterate 1", "post 1", "scheduled 1 beat", "end"}));
}

TEST(Step, AgentsIterateInOrderOfCreationEvenWhenSlotsAreReused) {
  Scene s;
  const ObjectId a = s.world.create(1, 0, true, false);
  const ObjectId b = s.world.create(1, 0, true, false);
  s.world.step();
  s.world.release(a);
  const ObjectId c = s.world.create(1, 0, true, false);
  EXPECT_EQ(c.index, a.index);
  s.script.calls.clear();
  s.world.step();
  EXPECT_EQ(s.script.calls, (Calls{"iterate 0", testing::line("iterate", b), testing::line("iterate", c), "end"}));
}

TEST(Step, InstancesCreatedDuringAStepAreFirstIteratedInTheNext) {
  Scene s;
  bool created = false;
  s.script.on_iterate = [&](ObjectId) {
    if (!created) s.world.create(1, 0, true, true);
    created = true;
  };
  s.world.step();
  EXPECT_EQ(s.script.calls, (Calls{"iterate 0", "end"}));
  s.script.calls.clear();
  s.world.step();
  EXPECT_EQ(s.script.calls, (Calls{"iterate 0", "iterate 1", "post 1", "end"}));
}

TEST(Step, InstancesFreedDuringAStepAreSkippedAtOnce) {
  Scene s;
  const ObjectId victim = s.world.create(1, 0, true, true);
  s.script.on_iterate = [&](ObjectId id) {
    if (id == s.controller) s.world.release(victim);
  };
  s.world.step();
  EXPECT_EQ(s.script.calls, (Calls{"iterate 0", "end"}));
}

TEST(Step, CannotBeTakenFromInsideAStep) {
  Scene s;
  s.script.on_iterate = [&](ObjectId) { EXPECT_EQ(code_of([&] { s.world.step(); }), ErrorCode::Busy); };
  s.world.step();
  EXPECT_FALSE(s.world.stepping());
  EXPECT_EQ(s.world.iteration(), 1U);
}

TEST(Step, AnErrorAbandonsTheIterationAndLeavesTheWorldUsable) {
  Scene s;
  s.world.schedule(s.controller, "fail", 0.05);
  s.script.on_scheduled = [](ObjectId, std::string_view) { throw Error(ErrorCode::Script, "oh"); };
  EXPECT_EQ(code_of([&] { s.world.step(); }), ErrorCode::Script);
  EXPECT_FALSE(s.world.stepping());
  EXPECT_EQ(s.world.time(), 0.06) << "the clock reads the world's time again";
  EXPECT_EQ(s.world.iteration(), 0U);
  s.world.step();
  EXPECT_EQ(s.world.iteration(), 1U);
}

TEST(Step, InputForAFreedMenuItemIsDroppedAndAClickOnAFreedObjectIsAClickOnNothing) {
  Scene s;
  const ObjectId item = s.world.create(1, 0, false, false);
  s.world.queue_input({InputEvent::Kind::Menu, "", item});
  s.world.queue_input({InputEvent::Kind::Click, "", item});
  s.world.release(item);
  bool null = false;
  s.script.on_input = [&](const InputEvent& e) { null = !e.object; };
  s.world.step();
  EXPECT_TRUE(null);
  EXPECT_EQ(s.script.calls[0], "input 0");
  EXPECT_EQ(s.script.calls[1], "iterate 0");
}

// --- clock ----------------------------------------------------------------------------------------------------------

TEST(Clock, AnIterationLastsExactlyTheIterationStepInWhateverOrderTheStepsWereSet) {
  const struct {
    double integration, iteration;
    std::uint64_t substeps;
  } cases[] = {{0.025, 0.06, 3}, {0.0125, 1.0 / 60, 2}, {0.1, 0.25, 3},
               {0.02, 0.001, 1}, {0.02, 0.03, 2},       {0.3, 0.3, 1}};
  for (const auto& c : cases) {
    for (const bool iteration_first : {false, true}) {
      Scene s;
      if (iteration_first) s.world.set_iteration_step(c.iteration);
      s.world.set_integration_step(c.integration);
      if (!iteration_first) s.world.set_iteration_step(c.iteration);
      EXPECT_EQ(s.world.iteration_step(), c.iteration);
      EXPECT_EQ(s.world.integration_step(), c.integration);
      EXPECT_EQ(s.world.substeps(), c.substeps);
      s.world.step();
      EXPECT_EQ(s.world.time(), c.iteration);
      for (int i = 1; i < 60; ++i) s.world.step();
      EXPECT_DOUBLE_EQ(s.world.time(), 60 * c.iteration);
    }
  }
}

TEST(Clock, WhatMovesMovesForTheIterationStepToo) {
  Scene s;
  s.world.set_integration_step(0.0125);
  s.world.set_iteration_step(1.0 / 60);
  const BodyIndex body = s.world.body(s.body(1, Vector3::Zero()));
  s.world.bodies().set_velocity(body, {3, 0, 0});
  for (int i = 0; i < 60; ++i) s.world.step();
  EXPECT_NEAR(s.world.bodies().location(body)[0], 3.0, 1e-12);
}

TEST(Clock, RoundingMakesNoExtraSubstep) {
  const struct { double integration, iteration; } cases[] = {{0.02, 0.06}, {0.0125, 0.05}, {0.1, 0.3}, {0.001, 0.06}};
  for (const auto& c : cases) {
    Scene s;
    s.world.set_integration_step(c.integration);
    s.world.set_iteration_step(c.iteration);
    s.world.step();
    EXPECT_NEAR(s.world.time(), c.iteration, 1e-15);
  }
}

TEST(Clock, AThousandStepsOfSixHundredthsAreSixty) {
  Scene s;
  for (int i = 0; i < 1000; ++i) s.world.step();
  EXPECT_DOUBLE_EQ(s.world.time(), 60.0);
}

TEST(Clock, StepsThatAreNotFiniteAndPositiveAreRefused) {
  Scene s;
  for (const double bad : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(code_of([&] { s.world.set_iteration_step(bad); }), ErrorCode::Argument);
    EXPECT_EQ(code_of([&] { s.world.set_integration_step(bad); }), ErrorCode::Argument);
  }
}

TEST(Clock, AnIterationStepOfTooManySubstepsIsAnErrorNotAHang) {
  Scene s;
  s.world.set_integration_step(1e-300);
  EXPECT_EQ(code_of([&] { s.world.step(); }), ErrorCode::Argument);
}

// --- schedule -------------------------------------------------------------------------------------------------------

TEST(Schedule, FiresUpToOneIterationStepEarlyAndTheClockReadsTheEventsTime) {
  Scene s;
  std::vector<double> times;
  s.script.on_scheduled = [&](ObjectId, std::string_view) { times.push_back(s.world.time()); };
  s.world.schedule(s.controller, "beat", 0.11);
  s.world.step();
  EXPECT_EQ(times, std::vector<double>{0.11});
  EXPECT_EQ(s.world.time(), 0.06);
}

TEST(Schedule, InExactModeFiresOnlyOnceItsTimeHasCome) {
  Scene s;
  s.world.set_exact_schedule(true);
  s.world.schedule(s.controller, "beat", 0.11);
  s.world.step();
  EXPECT_EQ(s.world.scheduled_count(), 1U);
  s.world.step();
  EXPECT_EQ(s.world.scheduled_count(), 0U);
}

TEST(Schedule, ATimeNotInTheFutureQueuesNothing) {
  Scene s;
  EXPECT_FALSE(s.world.schedule(s.controller, "beat", 0));
  EXPECT_FALSE(s.world.schedule(s.controller, "beat", -1));
  EXPECT_EQ(s.world.scheduled_count(), 0U);
  EXPECT_EQ(code_of([&] { s.world.schedule(s.controller, "beat", kNan); }), ErrorCode::Argument);
  EXPECT_EQ(code_of([&] { s.world.schedule({7, 7}, "beat", 1); }), ErrorCode::Stale);
}

Calls tie_order(bool stable) {
  Scene s;
  s.world.set_stable_schedule(stable);
  for (const char* name : {"a", "b", "c", "d"}) s.world.schedule(s.controller, name, 0.05);
  s.world.schedule(s.controller, "first", 0.01);
  s.script.on_iterate = nullptr;
  s.world.step();
  return Calls(s.script.calls.begin() + 1, s.script.calls.end() - 1);
}

TEST(Schedule, AmongEqualTimesTheLastScheduledGoesFirstUnlessStableOrderIsAskedFor) {
  EXPECT_EQ(tie_order(false),
            (Calls{"scheduled 0 first", "scheduled 0 d", "scheduled 0 c", "scheduled 0 b", "scheduled 0 a"}));
  EXPECT_EQ(tie_order(true),
            (Calls{"scheduled 0 first", "scheduled 0 a", "scheduled 0 b", "scheduled 0 c", "scheduled 0 d"}));
}

TEST(Schedule, RepeatsFirstAtTheAbsoluteTimeOfItsInterval) {
  Scene s;
  std::vector<double> times;
  s.script.on_scheduled = [&](ObjectId, std::string_view) { times.push_back(s.world.time()); };
  EXPECT_TRUE(s.world.schedule(s.controller, "beat", 0.1, 0.1));
  for (int i = 0; i < 5; ++i) s.world.step();  // until 0.3, and one step ahead
  ASSERT_EQ(times.size(), 3U);
  EXPECT_DOUBLE_EQ(times[2], 0.3);
}

TEST(Schedule, ARepeatWhoseFirstTimeIsPastStartsAnIntervalFromNow) {
  Scene s;
  for (int i = 0; i < 10; ++i) s.world.step();  // 0.6
  std::vector<double> times;
  s.script.on_scheduled = [&](ObjectId, std::string_view) { times.push_back(s.world.time()); };
  EXPECT_TRUE(s.world.schedule(s.controller, "beat", 0.1, 0.1));
  s.world.step();
  ASSERT_EQ(times.size(), 1U);
  EXPECT_DOUBLE_EQ(times[0], 0.7);
}

TEST(Schedule, WhatAHandlerAddsFiresInTheSamePassIfDue) {
  Scene s;
  s.script.on_scheduled = [&](ObjectId id, std::string_view method) {
    if (method == "one") {
      EXPECT_TRUE(s.world.schedule(id, "two", 0.06));
      EXPECT_TRUE(s.world.schedule(id, "later", 5));
      EXPECT_FALSE(s.world.schedule(id, "past", 0.05)) << "the clock reads 0.05 now";
    }
  };
  s.world.schedule(s.controller, "one", 0.05);
  s.world.step();
  EXPECT_EQ(s.script.calls, (Calls{"iterate 0", "scheduled 0 one", "scheduled 0 two", "end"}));
}

TEST(Schedule, UnscheduleRemovesByMethodAndTime) {
  Scene s;
  for (const double when : {1.0, 2.0, 3.0}) s.world.schedule(s.controller, "a", when);
  s.world.schedule(s.controller, "b", 2.0);
  EXPECT_EQ(s.world.unschedule(s.controller, "a", 2.0), 1U);
  EXPECT_EQ(s.world.unschedule(s.controller, "unknown", 0), 0U);
  EXPECT_EQ(s.world.unschedule(s.controller, "a", 0), 2U);
  EXPECT_EQ(s.world.unschedule(s.controller, "", 0), 1U);
}

TEST(Schedule, ARepeatCanUnscheduleItselfFromItsOwnCall) {
  Scene s;
  s.script.on_scheduled = [&](ObjectId id, std::string_view) { s.world.unschedule(id, "beat", 0); };
  s.world.schedule(s.controller, "beat", 0.01, 0.01);
  s.world.step();
  EXPECT_EQ(s.script.calls, (Calls{"iterate 0", "scheduled 0 beat", "end"}));
}

TEST(Schedule, CallsOfFreedObjectsAreDropped) {
  Scene s;
  std::vector<ObjectId> agents;
  for (int i = 0; i < 100; ++i) {
    agents.push_back(s.world.create(1, 0, false, false));
    s.world.schedule(agents.back(), "beat", 0.01 * (100 - i));
  }
  for (const ObjectId id : agents) {
    if (id.index % 3 != 0) s.world.release(id);
  }
  EXPECT_EQ(s.world.scheduled_count(), 33U);
  const ObjectId heir = s.world.create(1, 0, false, false);  // a reused slot inherits no calls
  for (int i = 0; i < 20; ++i) s.world.step();
  EXPECT_EQ(s.world.scheduled_count(), 0U);
  EXPECT_EQ(std::count(s.script.calls.begin(), s.script.calls.end(), testing::line("scheduled", heir, "beat")), 0);
}

TEST(Schedule, AnIntervalBelowTheResolutionOfTheClockDoesNotHang) {
  Scene s;
  for (int i = 0; i < 100; ++i) s.world.step();
  s.world.schedule(s.controller, "beat", 6.01, 1e-300);
  s.script.recording = false;
  s.world.step();
}

TEST(Schedule, AMillionCallsComeInOrderOfTime) {
  Scene s;
  s.script.recording = false;
  constexpr int kCalls = 1000000;
  for (int i = 0; i < kCalls; ++i) s.world.schedule(s.controller, "beat", 1e-6 + s.world.random().uniform() * 0.05);
  double last = 0;
  int count = 0;
  s.script.on_scheduled = [&](ObjectId, std::string_view) {
    EXPECT_LE(last, s.world.time());
    last = s.world.time();
    ++count;
  };
  s.world.step();
  EXPECT_EQ(count, kCalls);
}

// --- notifications --------------------------------------------------------------------------------------------------

TEST(Notifications, AreDeliveredAtOnceInOrderOfRegistrationDuplicatesIncluded) {
  Scene s;
  const ObjectId a = s.world.create(1, 0, false, false);
  const ObjectId b = s.world.create(1, 0, false, false);
  s.world.observe(b, s.controller, "ping", "m");
  s.world.observe(a, s.controller, "ping", "n");
  s.world.observe(b, s.controller, "ping", "m");
  s.world.observe(a, s.controller, "Ping", "wrong");
  s.world.announce(s.controller, "ping");
  s.world.announce(a, "ping");
  EXPECT_EQ(s.script.calls, (Calls{"notified 2 m ping", "notified 1 n ping", "notified 2 m ping"}));
}

TEST(Notifications, UnobserveRemovesEveryMatchingRegistration) {
  Scene s;
  const ObjectId a = s.world.create(1, 0, false, false);
  for (int i = 0; i < 4; ++i) s.world.observe(a, s.controller, "ping", "m");
  s.world.observe(a, s.controller, "pong", "m");
  EXPECT_EQ(s.world.unobserve(a, s.controller, "ping"), 4U);
  EXPECT_EQ(s.world.unobserve(a, s.controller, "ping"), 0U);
  s.world.announce(s.controller, "ping");
  s.world.announce(s.controller, "pong");
  EXPECT_EQ(s.script.calls, (Calls{"notified 1 m pong"}));
}

// The oracle is a plain list, gone through from end to end.
TEST(Notifications, KeepTheirOrderThroughManyRegistrationsAndRemovals) {
  Scene s;
  std::vector<ObjectId> observers;
  for (int i = 0; i < 60; ++i) observers.push_back(s.world.create(1, 0, false, false));
  std::vector<std::pair<std::size_t, std::string>> expected;
  std::uint32_t random = 1;
  const auto draw = [&](std::uint32_t below) {
    random = random * 1664525 + 1013904223;
    return (random >> 8) % below;
  };
  for (int iteration = 0; iteration < 3000; ++iteration) {
    const std::size_t who = draw(60);
    const std::string message = draw(2) ? "ping" : "pong";
    if (iteration % 1000 == 999) {  // freed, and another one in its slot
      s.world.release(observers[who]);
      std::erase_if(expected, [&](const auto& e) { return e.first == who; });
      observers[who] = s.world.create(1, 0, false, false);
    } else if (draw(5) < (iteration / 500 % 2 ? 2U : 3U)) {
      s.world.observe(observers[who], s.controller, message, "m");
      expected.emplace_back(who, message);
    } else {
      const auto gone = std::erase_if(expected, [&](const auto& e) { return e.first == who && e.second == message; });
      ASSERT_EQ(s.world.unobserve(observers[who], s.controller, message), gone);
    }
    if (iteration % 100 != 0) continue;
    Calls calls;
    for (const auto& [observer, text] : expected)
      if (text == "ping") calls.push_back("notified " + std::to_string(observers[observer].index) + " m ping");
    s.script.calls.clear();
    s.world.announce(s.controller, "ping");
    ASSERT_EQ(s.script.calls, calls) << iteration;
  }
}

TEST(Notifications, SurviveObserversBeingFreedAndAddedDuringDelivery) {
  Scene s;
  std::vector<ObjectId> observers;
  for (int i = 0; i < 5; ++i) {
    observers.push_back(s.world.create(1, 0, false, false));
    s.world.observe(observers.back(), s.controller, "ping", "m");
  }
  bool first = true;
  s.script.on_notified = [&](ObjectId, std::string_view) {
    if (!first) return;
    first = false;
    s.world.release(observers[1]);
    for (int i = 0; i < 100; ++i) s.world.observe(s.world.create(1, 0, false, false), s.controller, "ping", "m");
    s.world.unobserve(observers[2], s.controller, "ping");
  };
  s.world.announce(s.controller, "ping");
  EXPECT_EQ(s.script.calls,
            (Calls{"notified 1 m ping", "notified 3 m ping", "notified 4 m ping", "notified 5 m ping"}));
}

TEST(Notifications, AFreedAnnouncersRegistrationsDoNotPassToItsHeir) {
  Scene s;
  const ObjectId a = s.world.create(1, 0, false, false);
  const ObjectId b = s.world.create(1, 0, false, false);
  s.world.observe(b, a, "ping", "m");
  s.world.release(a);
  const ObjectId heir = s.world.create(1, 0, false, false);
  ASSERT_EQ(heir.index, a.index);
  s.world.announce(heir, "ping");
  EXPECT_TRUE(s.script.calls.empty());
  EXPECT_EQ(code_of([&] { s.world.announce(a, "ping"); }), ErrorCode::Stale);
}

// --- ids, effects, memory -------------------------------------------------------------------------------------------

TEST(Objects, AStaleIdIsAnErrorAndNeverAnotherObject) {
  Scene s;
  const ObjectId old = s.body(1, Vector3(1, 2, 3));
  s.world.release(old);
  const ObjectId heir = s.body(1, Vector3(4, 5, 6));
  ASSERT_EQ(old.index, heir.index);
  EXPECT_FALSE(s.world.alive(old));
  EXPECT_EQ(code_of([&] { s.world.user(old); }), ErrorCode::Stale);
  EXPECT_EQ(code_of([&] { s.world.body(old); }), ErrorCode::Stale);
  EXPECT_EQ(code_of([&] { s.world.release(old); }), ErrorCode::Stale);
  EXPECT_EQ(code_of([&] { s.world.release({}); }), ErrorCode::Stale);
  EXPECT_EQ(s.world.resource(old), nullptr);
  EXPECT_EQ(code_of([&] { s.world.body(s.controller); }), ErrorCode::Argument);
  EXPECT_EQ(code_of([&] { s.world.embody(heir, BodyKind::Mobile); }), ErrorCode::Argument);
}

TEST(Effects, AWorldOfAbstractAgentsBuildsNoBodiesAndNoCollisionStructure) {
  Scene s;
  for (int i = 0; i < 100; ++i) s.world.create(1, 0, true, false);
  s.world.handle_collisions(1, 1, "hit", s.controller);
  for (int i = 0; i < 5; ++i) s.world.step();
  for (const EffectId id : {EffectId::Motion, EffectId::Rotation, EffectId::Gravity, EffectId::Rigid,
                            EffectId::Collision, EffectId::TimeOfImpact, EffectId::Neighbors, EffectId::Schedule}) {
    const Effect& effect = s.world.effects()[id];
    EXPECT_FALSE(effect.active) << effect.name;
    EXPECT_EQ(effect.calls, 0U) << effect.name;
    EXPECT_EQ(effect.bytes, 0U) << effect.name;
  }
  EXPECT_TRUE(s.world.effects()[EffectId::Script].active);
  EXPECT_EQ(s.world.effects()[EffectId::Script].calls, 101U);
}

TEST(Effects, NameWhoAskedAndSinceWhen) {
  Scene s;
  s.world.step();
  const ObjectId still = s.body(1, Vector3(0, 0, 0));
  s.world.step();
  EXPECT_FALSE(s.world.effects()[EffectId::Motion].active);
  const ObjectId mover = s.body(1, Vector3(9, 0, 0));
  s.set_velocity(mover, Vector3(1, 0, 0));
  s.world.step();
  const Effect& motion = s.world.effects()[EffectId::Motion];
  EXPECT_TRUE(motion.active);
  EXPECT_EQ(motion.since, 2U);
  EXPECT_EQ(motion.asked_by, mover);
  EXPECT_EQ(motion.items, 3U) << "one body, three sub-steps";
  EXPECT_FALSE(motion.reason.empty());
  EXPECT_FALSE(s.world.effects()[EffectId::Collision].active);
  s.world.handle_collisions(1, 1, "hit", still);
  s.world.step();
  EXPECT_TRUE(s.world.effects()[EffectId::Collision].active);
  EXPECT_EQ(s.world.effects()[EffectId::Collision].asked_by, still);
}

TEST(Memory, GoesBackToNothingWhenTheWorldIsGone) {
  MemoryMeter memory;
  {
    World world(&memory);
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const ObjectId id = world.create(i % 3, i, true, true);
      world.embody(id, i % 2 == 0 ? BodyKind::Mobile : BodyKind::Stationary);
      world.bodies().set_location(world.body(id), Vector3(i, 0, 0));
      world.bodies().set_rotational_velocity(world.body(id), Vector3(1, 0, 0));
      world.bodies().set_neighborhood_size(world.body(id), 2.5);
      world.schedule(id, "a method with a long name", 1 + i);
      world.observe(id, id, "a message with a long name", "m");
    }
    world.handle_collisions(0, 1, "hit", {});
    world.update_neighbors();
    for (const ObjectId id : world.objects()) world.neighbors(id);
    for (int i = 0; i < 3; ++i) world.advance_bodies();
    EXPECT_GT(memory.used(), 0U);
  }
  EXPECT_EQ(memory.used(), 0U);
}

TEST(Memory, RunningOutIsAnExceptionAndTheWorldGoesOn) {
  Scene s;
  for (std::size_t more = 64; more < 200000; more += 4096) {
    s.memory.set_limit(s.memory.used() + more);
    try {
      for (int i = 0; i < 200; ++i) s.body(1, Vector3(i, 0, 0));
      s.world.handle_collisions(1, 1, "hit", s.controller);
      s.world.step();
    } catch (const std::bad_alloc&) {
    }
    s.memory.set_limit(0);
    s.script.recording = false;
    s.world.step();
  }
  std::size_t bodies = 0;
  for (const ObjectId id : s.world.objects()) bodies += s.world.has_body(id) ? 1 : 0;
  EXPECT_EQ(bodies, s.world.bodies().size());
}

}  // namespace
}  // namespace breve
