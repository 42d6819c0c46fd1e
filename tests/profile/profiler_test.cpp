// The tree of calls, driven by hand: entries and exits as the machine tells them.
#include "steve/machine/profiler.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <string>

#include "runtime/base/memory.hpp"
#include "steve/compile/compile.hpp"
#include "steve/library/library.hpp"

namespace breve::steve {
namespace {

const Callee kA = Callee::act("a"), kB = Callee::act("b"), kC = Callee::act("c");

struct NoModules final : ModuleResolver {
  std::optional<ModuleSource> resolve(std::string_view, std::string_view) override { return std::nullopt; }
};

std::shared_ptr<const Program> compiled(const std::string& text) {
  NoModules none;
  auto result = compile({"p.tz", text}, none, library_source());
  EXPECT_TRUE(result.program);
  return result.program;
}

std::shared_ptr<const Program> small_program() {
  return compiled(
      "@use Control.\nController Main.\nControl : Main {\n  + to one: return 1.\n  + to two: return 2.\n}\n");
}

const MethodInfo& method(const Program& program, const char* name) {
  const auto* found = program.find_class("Main")->find_method(program.symbols().find(name), 0);
  EXPECT_TRUE(found);
  return *found;
}

class ProfilerTest : public ::testing::Test {
 protected:
  Profiler make(Profiler::Trace trace = {}) { return Profiler(small_program(), &memory_, std::move(trace)); }

  static std::string path(Profiler& p, std::size_t node) {
    const auto n = p.node(node);
    return node == 0 ? n.name : path(p, n.parent) + "/" + n.name;
  }
  static std::string tree(Profiler& p) {
    std::string text;
    for (std::size_t i = 0; i < p.node_count(); ++i) text += path(p, i) + " " + std::to_string(p.node(i).calls) + "\n";
    return text;
  }

  MemoryMeter memory_;
};

TEST_F(ProfilerTest, NodesAreMadePerCallerAndLine) {
  auto p = make();
  for (int i = 0; i < 3; ++i) {
    p.enter(kA, 0);
    for (const std::uint32_t line : {7U, 8U, 7U}) {
      p.enter(kB, line);
      p.leave();
    }
    p.enter(kC, 7);
    p.enter(kB, 1);
    p.leave();
    p.leave();
    p.leave();
  }
  EXPECT_EQ(tree(p), "world 0\nworld/a 3\nworld/a/b 6\nworld/a/b 3\nworld/a/c 3\nworld/a/c/b 3\n");
  EXPECT_EQ(p.node(2).call_line, 7U);
  EXPECT_EQ(p.node(3).call_line, 8U);
  EXPECT_EQ(p.depth(), 0U);
}

TEST_F(ProfilerTest, WhatIsActiveAlreadyCountsInItsFirstNode) {
  auto p = make();
  p.enter(kA, 0);
  for (std::uint32_t i = 0; i < 500; ++i) p.enter(i % 2 == 0 ? kB : kA, i % 2);
  p.enter(kC, 9);
  p.leave();
  p.unwind(0);
  EXPECT_EQ(tree(p), "world 0\nworld/a 251\nworld/a/b 250\nworld/a/c 1\n");
}

TEST_F(ProfilerTest, AnExceptionLeavesWhatItPassed) {
  auto p = make();
  p.enter(kA, 0);
  try {
    const ProfileScope scope(&p, kB, 1);
    p.enter(kC, 2);
    p.enter(kA, 3);
    throw std::runtime_error("out");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(p.depth(), 1U);
  p.enter(kC, 4);
  p.leave();
  p.leave();
  EXPECT_EQ(tree(p), "world 0\nworld/a 2\nworld/a/b 1\nworld/a/b/c 1\nworld/a/c 1\n");
}

TEST_F(ProfilerTest, EverySecondIsInOneNodeAndTheRootHasThemAll) {
  auto p = make();
  using Clock = Profiler::Clock;
  const auto start = Clock::now();
  const auto at = [&](int seconds) { return start + std::chrono::seconds(seconds); };
  p.stage_begins("outer", at(0));
  p.stage_begins("inner", at(1));
  p.stage_ends(at(4));
  p.stage_ends(at(6));
  p.stage_begins("outer", at(100));  // what passed since then was the host's
  p.stage_ends(at(101));
  constexpr double kCost = 1e-3;  // of three calls: far more than any clock takes
  EXPECT_NEAR(p.node(0).total_seconds, 7, kCost);
  EXPECT_EQ(p.node(0).self_seconds, 0);
  EXPECT_NEAR(p.node(1).total_seconds, 7, kCost);
  EXPECT_NEAR(p.node(1).self_seconds, 4, kCost);
  EXPECT_NEAR(p.node(2).self_seconds, 3, kCost);
  EXPECT_EQ(p.node(1).calls, 2U);
}

TEST_F(ProfilerTest, WhatTheProfilerCostsIsTakenOutAndNothingGoesBelowZero) {
  auto p = make();
  p.enter(kA, 0);
  for (int i = 0; i < 20'000; ++i) {
    p.enter(kB, 1);
    p.leave();
  }
  p.leave();
  EXPECT_GT(p.overhead_seconds(), 0);
  for (std::size_t i = 0; i < p.node_count(); ++i) EXPECT_GE(p.node(i).self_seconds, 0);
}

TEST_F(ProfilerTest, WithoutMemoryItEndsAndKeepsWhatItHas) {
  auto p = make();
  p.enter(kA, 0);
  memory_.set_limit(memory_.used());
  for (std::uint32_t line = 0; line < 1000; ++line) {
    p.enter(kB, line);
    p.leave();
  }
  p.enter(kC, 1);
  p.unwind(0);
  EXPECT_TRUE(p.out_of_memory());
  EXPECT_EQ(p.depth(), 0U);
  memory_.set_limit(0);
  EXPECT_GE(p.node_count(), 2U);
  EXPECT_LT(p.node_count(), 1000U);
}

TEST_F(ProfilerTest, WithoutMemoryToBeginWithThereIsNone) {
  make();
  for (std::size_t limit = 1; limit <= memory_.peak(); limit += 8) {
    memory_.set_limit(limit);
    if (limit < memory_.peak()) {
      EXPECT_THROW(make(), std::bad_alloc) << limit;
    } else {
      EXPECT_NO_THROW(make());
    }
  }
  EXPECT_EQ(memory_.used(), 0U);
}

TEST_F(ProfilerTest, ATreeThatIsFullCountsNewCallsInTheirCaller) {
  auto p = make();
  constexpr std::uint32_t kWide = 400;
  static_assert(kWide * kWide > Profiler::kMostNodes);
  for (std::uint32_t caller = 0; caller < kWide; ++caller) {
    p.enter(kA, caller);
    for (std::uint32_t line = 0; line < kWide; ++line) {
      p.enter(kB, line);
      p.leave();
    }
    p.leave();
  }
  EXPECT_TRUE(p.full());
  EXPECT_EQ(p.node_count(), Profiler::kMostNodes);
  EXPECT_EQ(p.node(1).calls, 1U);
}

TEST_F(ProfilerTest, EventsTellEveryEntryAndExitInOrder) {
  std::string told;
  double last = 0;
  auto p = make([&](const TraceEvent& e) {
    told += (e.begins ? "<" : ">") + std::string(e.callee.name);
    EXPECT_GE(e.seconds, last);
    last = e.seconds;
  });
  p.enter(kA, 0);
  p.enter(kB, 1);
  p.enter(kA, 2);
  p.unwind(0);
  EXPECT_EQ(told, "<a<b<a>a>b>a");
}

TEST_F(ProfilerTest, AReceiverThatThrowsEndsTheTraceOnly) {
  int told = 0;
  auto p = make([&](const TraceEvent&) {
    ++told;
    throw std::runtime_error("no more");
  });
  p.enter(kA, 0);
  p.enter(kB, 0);
  p.unwind(0);
  EXPECT_EQ(told, 1);
  EXPECT_EQ(p.node_count(), 3U);
}

TEST_F(ProfilerTest, AMethodOfAReplacedProgramGoesOnInItsNode) {
  auto old = small_program();
  Profiler p(old, &memory_, {});
  for (const char* name : {"one", "two"}) {
    p.enter(Callee::of(method(*old, name)), 3);
    p.leave();
  }
  const auto changed =
      compiled("@use Control.\nController Main.\nControl : Main {\n  + to zero: return 0.\n  + to two: return 2.\n}\n");
  p.use(changed);
  old.reset();  // the profiler keeps what its nodes refer to
  for (const char* name : {"two", "zero"}) {
    p.enter(Callee::of(method(*changed, name)), 3);
    p.leave();
  }
  EXPECT_EQ(tree(p), "world 0\nworld/one 1\nworld/two 2\nworld/zero 1\n");
  EXPECT_STREQ(p.node(1).class_name, "Main");
  EXPECT_EQ(p.node(1).line, 4U);
  EXPECT_EQ(p.node(2).line, 5U);
}

}  // namespace
}  // namespace breve::steve
