// Each instruction of Push by what it leaves on the stacks; published programs; hostile texts and configurations.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "runtime/base/error.hpp"
#include "runtime/learn/push/edit.hpp"
#include "runtime/learn/push/instructions.hpp"
#include "runtime/learn/push/interpreter.hpp"
#include "runtime/learn/push/text.hpp"

namespace breve::push {
namespace {

std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }

std::string text(const Code& code) {
  std::pmr::string out;
  print(code, out);
  return std::string(out);
}

template <class T, class Make>
void show(std::string& all, const char* title, const Stack<T>& stack, Make&& make) {
  if (stack.empty()) return;
  all += all.empty() ? title : std::string(" ") + title;
  for (const T& item : stack) all += " " + text(make(item));
}

/// The stacks that are not empty, each from its bottom to its top.
std::string stacks(const Interpreter& m) {
  std::string all;
  show(all, "I", m.integers, [](std::int32_t x) { return atom(Node::of_integer(x), memory()); });
  show(all, "F", m.floats, [](double x) { return atom(Node::of_float(x), memory()); });
  show(all, "B", m.booleans, [](std::uint8_t x) { return atom(Node::of_boolean(x != 0), memory()); });
  show(all, "V", m.vectors, [](const Vector3& x) { return atom(Node::of_vector(x), memory()); });
  show(all, "N", m.names, [](const Code& x) { return x; });
  show(all, "C", m.codes, [](const Code& x) { return x; });
  return all;
}

Outcome run(Interpreter& m, std::string_view program, std::uint64_t steps = 10'000) {
  Random random(1);
  m.settings.push_code = false;
  m.begin(parse(program, memory()));
  Outcome outcome = Outcome::Paused;
  while (outcome == Outcome::Paused) outcome = m.advance(steps, random);
  return outcome;
}

std::string after(std::string_view program) {
  Interpreter m(memory());
  EXPECT_EQ(run(m, program), Outcome::Finished) << program;
  return stacks(m);
}

struct Row {
  const char *program, *stacks;
};

// Stacks are empty before each program. NOOP: too little on the stacks, so that all stays as it is.
constexpr Row kRows[] = {
    {"", ""},
    {"7", "I 7"},
    {"(1 (2.5 TRUE) [1 2 3] name)", "I 1 F 2.5 B TRUE V [1 2 3] N name"},

    {"1 1 INTEGER.=", "B TRUE"},
    {"7 2 INTEGER.%", "I 1"},
    {"-7 2 INTEGER.%", "I 1"},
    {"7 -2 INTEGER.%", "I -1"},
    {"7 0 INTEGER.%", "I 7 0"},
    {"7 2 INTEGER.*", "I 14"},
    {"2147483647 2 INTEGER.*", "I -2"},
    {"7 2 INTEGER.+", "I 9"},
    {"2147483647 1 INTEGER.+", "I -2147483648"},
    {"7 INTEGER.+", "I 7"},
    {"7 2 INTEGER.-", "I 5"},
    {"-7 2 INTEGER./", "I -3"},
    {"-2147483648 -1 INTEGER./", "I -2147483648"},
    {"7 0 INTEGER./", "I 7 0"},
    {"1 2 INTEGER.<", "B TRUE"},
    {"1 2 INTEGER.>", "B FALSE"},
    {"1 2 INTEGER.MAX", "I 2"},
    {"1 2 INTEGER.MIN", "I 1"},
    {"TRUE FALSE INTEGER.FROMBOOLEAN INTEGER.FROMBOOLEAN", "I 0 1"},
    {"-2.9 1e300 INTEGER.FROMFLOAT INTEGER.FROMFLOAT", "I 2147483647 -2"},
    {"x 5 INTEGER.DEFINE x x", "I 5 5"},
    {"1 INTEGER.DUP", "I 1 1"},
    {"1 2 INTEGER.FLUSH", ""},
    {"1 2 INTEGER.POP", "I 1"},
    {"1 2 3 INTEGER.ROT", "I 2 3 1"},
    {"1 2 3 4 2 INTEGER.SHOVE", "I 1 4 2 3"},
    {"1 2 INTEGER.STACKDEPTH", "I 1 2 2"},
    {"1 2 INTEGER.SWAP", "I 2 1"},
    {"1 2 3 4 2 INTEGER.YANK", "I 1 3 4 2"},
    {"1 2 3 99 INTEGER.YANK", "I 2 3 1"},
    {"1 2 3 -5 INTEGER.YANKDUP", "I 1 2 3 3"},
    {"1 2 3 1 INTEGER.YANKDUP", "I 1 2 3 2"},
    {"0 INTEGER.YANK", "I 0"},

    {"1.5 1.5 FLOAT.=", "B TRUE"},
    {"7.5 2.0 FLOAT.%", "F 1.5"},
    {"-7.5 2.0 FLOAT.%", "F 0.5"},
    {"1.5 2.0 FLOAT.*", "F 3.0"},
    {"1e300 1e300 FLOAT.*", "F 1e+300 1e+300"},
    {"1.5 2.0 FLOAT.+", "F 3.5"},
    {"1.5 2.0 FLOAT.-", "F -0.5"},
    {"1.0 2.0 FLOAT./", "F 0.5"},
    {"1.0 0.0 FLOAT./", "F 1.0 0.0"},
    {"1.0 0.0 FLOAT.%", "F 1.0 0.0"},
    {"1.0 2.0 FLOAT.<", "B TRUE"},
    {"1.0 2.0 FLOAT.>", "B FALSE"},
    {"1.0 2.0 FLOAT.MAX", "F 2.0"},
    {"1.0 2.0 FLOAT.MIN", "F 1.0"},
    {"0.0 FLOAT.SIN", "F 0.0"},
    {"0.0 FLOAT.COS", "F 1.0"},
    {"0.0 FLOAT.TAN", "F 0.0"},
    {"TRUE FLOAT.FROMBOOLEAN", "F 1.0"},
    {"3 FLOAT.FROMINTEGER", "F 3.0"},
    {"x 5.5 FLOAT.DEFINE x", "F 5.5"},
    {"1.0 FLOAT.DUP", "F 1.0 1.0"},
    {"1.0 FLOAT.FLUSH", ""},
    {"1.0 FLOAT.POP", ""},
    {"1.0 2.0 3.0 FLOAT.ROT", "F 2.0 3.0 1.0"},
    {"1.0 2.0 3.0 2 FLOAT.SHOVE", "F 3.0 1.0 2.0"},
    {"1.0 FLOAT.STACKDEPTH", "I 1 F 1.0"},
    {"1.0 2.0 FLOAT.SWAP", "F 2.0 1.0"},
    {"1.0 2.0 1 FLOAT.YANK", "F 2.0 1.0"},
    {"1.0 2.0 1 FLOAT.YANKDUP", "F 1.0 2.0 1.0"},

    {"TRUE FALSE BOOLEAN.=", "B FALSE"},
    {"TRUE FALSE BOOLEAN.AND", "B FALSE"},
    {"TRUE FALSE BOOLEAN.OR", "B TRUE"},
    {"TRUE BOOLEAN.NOT", "B FALSE"},
    {"0.0 BOOLEAN.FROMFLOAT 2 BOOLEAN.FROMINTEGER", "B FALSE TRUE"},
    {"x TRUE BOOLEAN.DEFINE x", "B TRUE"},
    {"TRUE BOOLEAN.DUP", "B TRUE TRUE"},
    {"TRUE BOOLEAN.FLUSH", ""},
    {"TRUE BOOLEAN.POP", ""},
    {"TRUE FALSE FALSE BOOLEAN.ROT", "B FALSE FALSE TRUE"},
    {"TRUE FALSE 1 BOOLEAN.SHOVE", "B FALSE TRUE"},
    {"TRUE BOOLEAN.STACKDEPTH", "I 1 B TRUE"},
    {"TRUE FALSE BOOLEAN.SWAP", "B FALSE TRUE"},
    {"TRUE FALSE 1 BOOLEAN.YANK", "B FALSE TRUE"},
    {"TRUE FALSE 1 BOOLEAN.YANKDUP", "B TRUE FALSE TRUE"},

    {"[1 2 3] [1 2 3] VECTOR.=", "B TRUE"},
    {"[1 2 3] 2.0 VECTOR.*", "V [2 4 6]"},
    {"[1 2 3] 2.0 VECTOR./", "V [0.5 1 1.5]"},
    {"[1 2 3] 0.0 VECTOR./", "F 0.0 V [1 2 3]"},
    {"[1 2 3] [1 0 1] VECTOR.+", "V [2 2 4]"},
    {"[1 2 3] [1 0 1] VECTOR.-", "V [0 2 2]"},
    {"[1 0 0] [0 1 0] VECTOR.CROSS", "V [0 0 1]"},
    {"[1 2 3] [4 5 6] VECTOR.DOT", "F 32.0"},
    {"[3 4 0] VECTOR.LENGTH", "F 5.0"},
    {"[0 4 0] VECTOR.NORMALIZE", "V [0 1 0]"},
    {"[0 0 0] VECTOR.NORMALIZE", "V [0 0 0]"},
    {"[1 2 3] VECTOR.X [1 2 3] VECTOR.Y [1 2 3] VECTOR.Z", "F 1.0 2.0 3.0"},
    {"1.0 2.0 3.0 VECTOR.FROMFLOATS", "V [1 2 3]"},
    {"x [1 2 3] VECTOR.DEFINE x", "V [1 2 3]"},
    {"[1 2 3] VECTOR.DUP", "V [1 2 3] [1 2 3]"},
    {"[1 2 3] VECTOR.FLUSH", ""},
    {"[1 2 3] VECTOR.POP", ""},
    {"[1 0 0] [2 0 0] [3 0 0] VECTOR.ROT", "V [2 0 0] [3 0 0] [1 0 0]"},
    {"[1 0 0] [2 0 0] 1 VECTOR.SHOVE", "V [2 0 0] [1 0 0]"},
    {"[1 0 0] VECTOR.STACKDEPTH", "I 1 V [1 0 0]"},
    {"[1 0 0] [2 0 0] VECTOR.SWAP", "V [2 0 0] [1 0 0]"},
    {"[1 0 0] [2 0 0] 1 VECTOR.YANK", "V [2 0 0] [1 0 0]"},
    {"[1 0 0] [2 0 0] 1 VECTOR.YANKDUP", "V [1 0 0] [2 0 0] [1 0 0]"},

    {"a a NAME.=", "B TRUE"},
    {"a NAME.DUP", "N a a"},
    {"a NAME.FLUSH", ""},
    {"a NAME.POP", ""},
    {"x 1 INTEGER.DEFINE NAME.QUOTE x x", "I 1 N x"},
    {"x 1 INTEGER.DEFINE NAME.RANDBOUNDNAME", "N x"},
    {"NAME.RANDBOUNDNAME", ""},
    {"a b c NAME.ROT", "N b c a"},
    {"a b 1 NAME.SHOVE", "N b a"},
    {"a NAME.STACKDEPTH", "I 1 N a"},
    {"a b NAME.SWAP", "N b a"},
    {"a b 1 NAME.YANK", "N b a"},
    {"a b 1 NAME.YANKDUP", "N a b a"},

    {"CODE.QUOTE (1 2) CODE.QUOTE (1 2) CODE.=", "B TRUE"},
    {"CODE.QUOTE a CODE.QUOTE (b c) CODE.APPEND", "C (a b c)"},
    {"CODE.QUOTE a CODE.ATOM CODE.QUOTE () CODE.ATOM", "B TRUE FALSE"},
    {"CODE.QUOTE (a b) CODE.CAR CODE.QUOTE () CODE.CAR CODE.QUOTE c CODE.CAR", "C a () c"},
    {"CODE.QUOTE (a b c) CODE.CDR CODE.QUOTE c CODE.CDR", "C (b c) ()"},
    {"CODE.QUOTE x CODE.QUOTE (a b) CODE.CONS", "C (x a b)"},
    {"CODE.QUOTE (a) CODE.QUOTE (b (c (a)) (d (a))) CODE.CONTAINER", "C (c (a))"},
    {"CODE.QUOTE z CODE.QUOTE (b) CODE.CONTAINER", "C ()"},
    {"CODE.QUOTE (b (a)) CODE.QUOTE a CODE.CONTAINS", "B TRUE"},
    {"CODE.QUOTE a CODE.QUOTE (b (a)) CODE.CONTAINS", "B FALSE"},
    {"x CODE.QUOTE (1 2) CODE.DEFINE x", "I 1 2"},
    {"x CODE.QUOTE (1 2) CODE.DEFINE NAME.QUOTE x CODE.DEFINITION", "C (1 2)"},
    {"CODE.QUOTE (a b) CODE.QUOTE (a c) CODE.DISCREPANCY", "I 2"},
    {"CODE.QUOTE (a (b)) CODE.QUOTE (a (b)) CODE.DISCREPANCY", "I 0"},
    {"CODE.QUOTE (a (b b)) CODE.QUOTE (a) CODE.DISCREPANCY", "I 3"},
    {"CODE.QUOTE (1 CODE.STACKDEPTH) CODE.DO", "I 1 1"},
    {"CODE.QUOTE (1 CODE.STACKDEPTH) CODE.DO*", "I 1 0"},
    {"CODE.QUOTE 7 3 CODE.DO*COUNT", "I 0 7 1 7 2 7"},
    {"CODE.QUOTE 7 0 CODE.DO*COUNT", "I 0 C 7"},
    {"CODE.QUOTE 7 3 5 CODE.DO*RANGE", "I 3 7 4 7 5 7"},
    {"CODE.QUOTE 7 1 -1 CODE.DO*RANGE", "I 1 7 0 7 -1 7"},
    {"CODE.QUOTE 7 3 CODE.DO*TIMES", "I 7 7 7"},
    {"CODE.QUOTE a CODE.DUP", "C a a"},
    {"CODE.QUOTE (a (b c)) 3 CODE.EXTRACT", "C b"},
    {"CODE.QUOTE (a (b c)) -6 CODE.EXTRACT", "C a"},
    {"CODE.QUOTE a CODE.FLUSH", ""},
    {"TRUE CODE.FROMBOOLEAN 1.5 CODE.FROMFLOAT 2 CODE.FROMINTEGER a CODE.FROMNAME", "C TRUE 1.5 2 a"},
    {"[1 2 3] CODE.FROMVECTOR", "C [1 2 3]"},
    {"TRUE CODE.QUOTE 1 CODE.QUOTE 2 CODE.IF", "I 1"},
    {"FALSE CODE.QUOTE 1 CODE.QUOTE 2 CODE.IF", "I 2"},
    {"CODE.QUOTE x CODE.QUOTE (a (b c)) 2 CODE.INSERT", "C (a x)"},
    {"CODE.QUOTE x CODE.QUOTE (a (b c)) 3 CODE.INSERT", "C (a (x c))"},
    {"CODE.QUOTE (a (b c)) CODE.LENGTH CODE.QUOTE a CODE.LENGTH", "I 2 1"},
    {"CODE.QUOTE a CODE.QUOTE (b) CODE.LIST", "C (a (b))"},
    {"CODE.QUOTE a CODE.QUOTE (b a) CODE.MEMBER", "B TRUE"},
    {"CODE.NOOP", ""},
    {"CODE.QUOTE (a b c) 4 CODE.NTH", "C b"},
    {"CODE.QUOTE (a b c) -2 CODE.NTHCDR", "C (c)"},
    {"CODE.QUOTE () 1 CODE.NTH", "C ()"},
    {"CODE.QUOTE () CODE.NULL", "B TRUE"},
    {"CODE.QUOTE a CODE.POP", ""},
    {"CODE.QUOTE b CODE.QUOTE (a b) CODE.POSITION", "I 1"},
    {"CODE.QUOTE c CODE.QUOTE (a b) CODE.POSITION", "I -1"},
    {"CODE.QUOTE a CODE.QUOTE b CODE.QUOTE c CODE.ROT", "C b c a"},
    {"CODE.QUOTE a CODE.QUOTE b 1 CODE.SHOVE", "C b a"},
    {"CODE.QUOTE (a (b c)) CODE.SIZE", "I 5"},
    {"CODE.QUOTE a CODE.STACKDEPTH", "I 1 C a"},
    {"CODE.QUOTE (x) CODE.QUOTE a CODE.QUOTE (a (b a)) CODE.SUBST", "C ((x) (b (x)))"},
    {"CODE.QUOTE a CODE.QUOTE b CODE.SWAP", "C b a"},
    {"CODE.QUOTE a CODE.QUOTE b 1 CODE.YANK", "C b a"},
    {"CODE.QUOTE a CODE.QUOTE b 1 CODE.YANKDUP", "C a b a"},

    {"EXEC.= a a 1", "I 1 B TRUE"},
    {"x EXEC.DEFINE (1 2) x", "I 1 2"},
    {"2 EXEC.DO*COUNT 7", "I 0 7 1 7"},
    {"3 5 EXEC.DO*RANGE 7", "I 3 7 4 7 5 7"},
    {"3 EXEC.DO*TIMES 7", "I 7 7 7"},
    {"EXEC.DUP 7", "I 7 7"},
    {"EXEC.FLUSH 7 8", ""},
    {"TRUE EXEC.IF 1 2", "I 1"},
    {"FALSE EXEC.IF 1 2", "I 2"},
    {"EXEC.K 1 2 3", "I 1 3"},
    {"EXEC.POP 1 2", "I 2"},
    {"EXEC.ROT 1 2 3", "I 3 1 2"},
    {"EXEC.S 1 2 3", "I 1 3 2 3"},
    {"1 EXEC.SHOVE 5 6 7", "I 6 5 7"},
    {"EXEC.STACKDEPTH 5 6", "I 2 5 6"},
    {"EXEC.SWAP 1 2", "I 2 1"},
    {"EXEC.Y (EXEC.FLUSH) 1", ""},
    {"3 EXEC.Y (1 INTEGER.- INTEGER.DUP 0 INTEGER.= BOOLEAN.NOT EXEC.IF () EXEC.POP)", "I 0"},
    {"1 EXEC.YANK 5 6 7", "I 6 5 7"},
    {"1 EXEC.YANKDUP 5 6 7", "I 6 5 6 7"},
};

TEST(PushInstructions, LeaveOnTheStacksWhatThePublishedDescriptionSays) {
  for (const Row& row : kRows) EXPECT_EQ(after(row.program), row.stacks) << row.program;
}

TEST(PushInstructions, AreAllInTheTableAbove) {
  // What these give is a matter of chance, or of the whole table; they have tests below.
  std::set<std::string, std::less<>> missing = {"CODE.INSTRUCTIONS"};
  for (const Instruction& instruction : instructions())
    if (!instruction.name.ends_with(".RAND")) missing.emplace(instruction.name);
  for (const Row& row : kRows) {
    const Code code = parse(row.program, memory());
    for (std::uint32_t i = 0; i < code.points(); ++i)
      if (code.nodes()[i].kind == Kind::Instruction)
        missing.erase(std::string(instructions()[code.nodes()[i].instruction].name));
  }
  EXPECT_EQ(missing, (std::set<std::string, std::less<>>{"CODE.INSTRUCTIONS"}));
}

TEST(PushInstructions, AloneOnEmptyStacksDoNothingButWhatNeedsNothing) {
  for (const Instruction& instruction : instructions()) {
    const std::string name(instruction.name);
    if (name.ends_with("STACKDEPTH") || name.ends_with(".RAND") || name == "CODE.INSTRUCTIONS") continue;
    EXPECT_EQ(after(name), "") << name;
  }
}

TEST(PushInstructions, RandomConstantsLieInTheirRanges) {
  Interpreter m(memory());
  m.settings.min_integer = 3, m.settings.max_integer = 5;
  m.settings.min_float = 2, m.settings.max_float = 2.5;
  run(m, "100 EXEC.DO*TIMES (INTEGER.RAND FLOAT.RAND VECTOR.RAND BOOLEAN.RAND NAME.RAND 20 CODE.RAND)");
  ASSERT_EQ(m.integers.size(), 100U);
  std::set<std::int32_t> seen(m.integers.begin(), m.integers.end());
  EXPECT_EQ(seen, (std::set<std::int32_t>{3, 4, 5}));
  for (const double x : m.floats) EXPECT_TRUE(x >= 2 && x <= 2.5);
  for (const Vector3& v : m.vectors) EXPECT_TRUE(v.minCoeff() >= 2 && v.maxCoeff() <= 2.5);
  std::set<std::uint32_t> sizes;
  for (const Code& code : m.codes) sizes.insert(code.points());
  EXPECT_GE(*sizes.begin(), 1U);
  EXPECT_LE(*sizes.rbegin(), 20U);
  EXPECT_GT(sizes.size(), 10U);
  EXPECT_EQ(m.names.size(), 100U);
}

TEST(PushInstructions, InstructionsListsTheActiveOnes) {
  Interpreter m(memory());
  std::pmr::string unknown;
  m.settings.read("instruction INTEGER.+\ninstruction integer.dup\ninstruction FLOAT.ERC\n", unknown);
  m.add_macro("twice", parse("INTEGER.DUP INTEGER.+", memory()));
  run(m, "CODE.INSTRUCTIONS 4 twice");
  EXPECT_EQ(stacks(m), "I 8 C (INTEGER.+ INTEGER.DUP twice)");
}

// --- published programs ----------------------------------------------------------------------------------------------

TEST(PushPrograms, FactorialByCodeThatDoesItself) {
  EXPECT_EQ(after("5 CODE.QUOTE (CODE.QUOTE (INTEGER.POP 1) CODE.QUOTE (CODE.DUP INTEGER.DUP 1 INTEGER.- CODE.DO "
                  "INTEGER.*) INTEGER.DUP 2 INTEGER.< CODE.IF) CODE.DO"),
            "I 120");
}

TEST(PushPrograms, FactorialByALoop) { EXPECT_EQ(after("1 1 5 EXEC.DO*RANGE INTEGER.*"), "I 120"); }

TEST(PushPrograms, FactorialByTheYCombinator) {
  EXPECT_EQ(after("1 5 EXEC.Y (INTEGER.DUP 0 INTEGER.= EXEC.IF (INTEGER.POP EXEC.POP) "
                  "(INTEGER.DUP 2 INTEGER.YANK INTEGER.* INTEGER.SWAP 1 INTEGER.-))"),
            "I 120");
}

TEST(PushPrograms, FibonacciByALoop) {
  EXPECT_EQ(after("0 1 10 EXEC.DO*TIMES (INTEGER.DUP 2 INTEGER.YANK INTEGER.+) INTEGER.POP"), "I 55");
}

TEST(PushPrograms, AListIsReversedByCodeManipulation) {
  EXPECT_EQ(after("CODE.QUOTE () CODE.QUOTE (a b c d) 4 EXEC.DO*TIMES "
                  "(CODE.DUP CODE.CAR 2 CODE.YANK CODE.CONS CODE.SWAP CODE.CDR) CODE.POP"),
            "C (d c b a)");
}

// --- limits ----------------------------------------------------------------------------------------------------------

TEST(PushLimits, ARunEndsAtItsStepsAndGoesOnFromThere) {
  Interpreter m(memory());
  EXPECT_EQ(run(m, "EXEC.Y (1 INTEGER.+)", 1000), Outcome::CutOff);
  EXPECT_EQ(m.effort, 1000U);
  EXPECT_FALSE(m.execs.empty());
}

TEST(PushLimits, CodeBeyondTheListLimitIsNotMade) {
  Interpreter m(memory());
  m.settings.list_limit = 20;
  run(m, "CODE.QUOTE (a) 100 EXEC.DO*TIMES (CODE.DUP CODE.APPEND)");
  for (const Code& code : m.codes) EXPECT_LE(code.points(), 20U);
  EXPECT_GT(m.codes.front().points(), 10U);
}

TEST(PushLimits, AFullStackCutsTheRunOff) {
  Interpreter m(memory());
  EXPECT_EQ(run(m, "EXEC.Y 1", 100'000'000), Outcome::CutOff);
  EXPECT_EQ(m.integers.size(), Interpreter::kMaxDepth);
}

TEST(PushLimits, DeepNestingCostsNoStack) {
  constexpr std::size_t kDeep = 400'000;
  const std::string deep = std::string(kDeep, '(') + "7" + std::string(kDeep, ')');
  const Code code = parse(deep, memory());
  EXPECT_EQ(code.points(), kDeep + 1);
  EXPECT_EQ(text(code), deep);
  EXPECT_EQ(discrepancy(code, code, memory()), 0U);
  Interpreter m(memory());
  EXPECT_EQ(run(m, deep, 10'000'000), Outcome::Finished);
  EXPECT_EQ(stacks(m), "I 7");
}

// --- texts and configurations ----------------------------------------------------------------------------------------

std::string complaint(std::string_view program) {
  try {
    parse(program, memory());
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(PushText, BadTextsAreErrorsThatNameTheCharacter) {
  EXPECT_EQ(complaint("(1 2"), "Push code, character 1: this '(' is not closed");
  EXPECT_EQ(complaint("1 2)"), "Push code, character 4: unmatched ')'");
  EXPECT_EQ(complaint("99999999999"), "Push code, character 1: the number '99999999999' is out of range");
  EXPECT_EQ(complaint("1 1e999"), "Push code, character 3: the number '1e999' is out of range");
  EXPECT_EQ(complaint("1x"), "Push code, character 1: '1x' is not a number, and a name does not begin like one");
  EXPECT_EQ(complaint("[1 2]"), "Push code, character 1: a vector is written [x y z], with three numbers");
  EXPECT_NE(complaint(std::string(300, 'n')), "");
  std::string large;
  for (std::uint32_t i = 0; i <= kMaxPoints; ++i) large += "1 ";
  EXPECT_EQ(complaint(large), "Push code of more than 1000000 points");
}

TEST(PushText, WhatIsPrintedIsReadBack) {
  for (const char* program : {"()", "7", "(1.0 -2.5e-300 [0.1 -2 1e+20] TRUE FALSE x-y (INTEGER.+ (())))"}) {
    const Code code = parse(program, memory());
    EXPECT_EQ(text(code), program);
    EXPECT_EQ(parse(text(code), memory()), code);
  }
}

std::string configured(std::string_view config) {
  Interpreter m(memory());
  std::pmr::string unknown;
  try {
    m.settings.read(config, unknown);
  } catch (const Error& error) {
    EXPECT_EQ(m.settings.active.size(), instructions().size()) << "nothing is changed";
    return error.what();
  }
  return std::string(unknown);
}

TEST(PushConfiguration, BadLinesAreErrorsThatNameTheLine) {
  EXPECT_EQ(configured("instruction INTEGER.+\nMAX-RANDOM-INTEGER"),
            "Push configuration, line 2: 'MAX-RANDOM-INTEGER' needs a value");
  EXPECT_EQ(configured("\nMAX-RANDOM-INTEGER 1e99"),
            "Push configuration, line 2: MAX-RANDOM-INTEGER must be an integer from -2147483647 to 2147483647");
  EXPECT_EQ(configured("MIN-RANDOM-INTEGER 99"),
            "Push configuration, line 1: MIN-RANDOM-INTEGER is greater than MAX-RANDOM-INTEGER");
  EXPECT_EQ(configured("TOP-LEVEL-PUSH-CODE maybe"),
            "Push configuration, line 1: TOP-LEVEL-PUSH-CODE must be TRUE or FALSE");
  EXPECT_EQ(configured("MAX-RANDOM-FLOAT nan"),
            "Push configuration, line 1: MAX-RANDOM-FLOAT must be a number from -1e+300 to 1e+300");
  EXPECT_EQ(configured("type FLOAT 3"), "Push configuration, line 1: more than two words; a comment begins with #");
}

TEST(PushConfiguration, UnknownNamesAreLeftOut) {
  EXPECT_EQ(configured("type NOTYPE # none\ninstruction NO.SUCH\nNO-SETTING 1"),
            "line 1: 'NOTYPE' is not known\nline 2: 'NO.SUCH' is not known\nline 3: 'NO-SETTING' is not known\n");
}

TEST(PushConfiguration, WhatIsPrintedIsReadBack) {
  Interpreter m(memory()), n(memory());
  std::pmr::string unknown, first, second;
  m.settings.read("type FLOAT\nMAX-RANDOM-FLOAT 7.5\nEVALPUSH-LIMIT 99\nTOP-LEVEL-POP-CODE true", unknown);
  m.settings.print(first);
  n.settings.read(first, unknown);
  n.settings.print(second);
  EXPECT_EQ(first, second);
  EXPECT_NE(first.find("EVALPUSH-LIMIT 99\n"), std::string::npos);
  EXPECT_EQ(first.find("instruction INTEGER"), std::string::npos);
}

// --- images ----------------------------------------------------------------------------------------------------------

TEST(PushImage, ARunGoesOnInARestoredInterpreterAsItWouldHave) {
  Interpreter m(memory());
  EXPECT_EQ(run(m,
                "x CODE.QUOTE (a b) CODE.DEFINE 1.5 [1 2 3] 0 1 30 EXEC.DO*TIMES (INTEGER.DUP 2 INTEGER.YANK "
                "INTEGER.+ 5 CODE.RAND NAME.QUOTE)",
                150),
            Outcome::CutOff);
  ByteWriter out;
  m.save(out);
  Interpreter restored(memory());
  ByteReader in(out.bytes().data(), out.bytes().size());
  restored.load(in);
  EXPECT_EQ(in.left(), 0U);
  Hasher before, after_load;
  m.hash(before);
  restored.hash(after_load);
  EXPECT_EQ(before.value(), after_load.value());
  run(m, "x", 1000);
  run(restored, "x", 1000);
  EXPECT_EQ(stacks(m), stacks(restored));
}

/// Every byte of an image put to several others: loads, or ends in Error{Image}.
TEST(PushImage, DamagedImagesAreRefusedOrAreInterpretersThatRun) {
  Interpreter m(memory());
  m.settings.active.resize(3);
  run(m, "x CODE.QUOTE (a (b) 1.5 [1 2 3]) CODE.DEFINE 5 EXEC.Y (TRUE 1 INTEGER.+ CODE.QUOTE (2 (3)) CODE.QUOTE y)",
      60);
  ByteWriter out;
  m.save(out);
  int refused = 0, loaded = 0;
  for (std::size_t at = 0; at < out.bytes().size(); ++at)
    for (const int value : {0x00, 0x01, 0x7f, 0xff}) {
      std::vector<std::uint8_t> bytes(out.bytes().begin(), out.bytes().end());
      bytes[at] = static_cast<std::uint8_t>(value);
      Interpreter damaged(memory());
      ByteReader in(bytes.data(), bytes.size());
      try {
        damaged.load(in);
        run(damaged, "CODE.SIZE x CODE.SUBST CODE.CONTAINER", 200);
        ++loaded;
      } catch (const Error& error) {
        ASSERT_EQ(error.code(), ErrorCode::Image) << error.what();
        ++refused;
      }
    }
  EXPECT_GT(refused, 100);
  EXPECT_GT(loaded, 100);
}

}  // namespace
}  // namespace breve::push
