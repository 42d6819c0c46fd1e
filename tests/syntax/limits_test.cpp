// Hostile texts: deep nesting, long lines, random bytes. Each ends in clear errors, in linear time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "reading.hpp"

namespace breve::steve::test {
namespace {

std::string repeat(std::string_view text, std::size_t times) {
  std::string result;
  result.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i) result += text;
  return result;
}

constexpr std::size_t kMany = 100'000;

TEST(Limits, DeepNestingIsOneError) {
  const std::vector<std::string> bodies{
      "n = " + repeat("(", kMany) + "1" + repeat(")", kMany) + ".",
      "n = " + repeat("(", kMany),
      "n = " + repeat("{", kMany) + repeat("}", kMany) + ".",
      "n = " + repeat("| ", kMany) + ".",
      repeat("{ ", kMany) + "n. " + repeat("}", kMany),
      "n = " + repeat("!", kMany) + "n.",
      "n = n" + repeat(" - ", kMany) + "n.",
      "n = " + repeat("n = ", kMany) + "n.",
      "n = k" + repeat("{0}", kMany) + ".",
      "n = o" + repeat("::part", kMany) + ".",
      "n = 1" + repeat(" new Kiln", kMany) + ".",
      repeat("if n: ", kMany) + "m.",
      repeat("while n: ", kMany) + "m.",
      repeat("foreach n in k: ", kMany) + "m.",
      "n = " + repeat("pop k{", kMany) + "1.",
      "n = " + repeat("f(", kMany) + "1.",
      "n = " + repeat("push ", kMany) + "1.",
      "n = " + repeat("@@DEBUG@@(", kMany) + "1.",
  };
  for (const std::string& body : bodies) {
    const Reading reading("NULL : T {\n+ to f:\n" + body + "\n+ to g: m = .\n}\n");
    const std::string errors = reading.errors();
    EXPECT_NE(errors.find("nesting"), std::string::npos) << body.substr(0, 30);
    EXPECT_LT(errors.size(), 200U) << body.substr(0, 30) << " " << errors;
  }
}

TEST(Limits, AfterATooDeepMethodTheNextIsRead) {
  const Reading reading("NULL : T {\n+ to f:\nn = " + repeat("(", kMany) + "1" + repeat(")", kMany) +
                        ".\n+ to g: m = .\n}\n");
  EXPECT_EQ(reading.errors(), "3:203 nesting, 4:13 syntax");
}

TEST(Limits, NestingUpToTheLimitIsRead) {
  EXPECT_EQ(body_errors("n = " + repeat("(", 150) + "1" + repeat(")", 150) + "."), "");
  EXPECT_EQ(body_errors("n = k" + repeat("{0}", 150) + "."), "");
  EXPECT_EQ(body_errors(repeat("if n: ", 150) + "m."), "");
  EXPECT_EQ(body_errors("n = (k" + repeat("{0}", 150) + ")" + repeat("{1}", 150) + "."), "1:596 nesting");
}

TEST(Limits, LongFlatTextsAreFine) {
  EXPECT_EQ(body_errors("n = 1" + repeat(" + 1 * 2", kMany) + "."), "");
  EXPECT_EQ(body_errors(repeat("if n: m. else ", kMany) + "m."), "");
  EXPECT_EQ(body_errors("k = {1" + repeat(", 1", kMany) + "}."), "");
  EXPECT_EQ(body_errors(repeat("n = 1.\n", kMany)), "");
  EXPECT_EQ(body_errors("print \"" + repeat("$n ", kMany) + "\"."), "");
  EXPECT_EQ(body_errors("self run" + repeat(" at 5", kMany) + "."), "");
}

TEST(Limits, TooManyTokensAreAnError) {
  EXPECT_EQ(Reading(repeat("(", kMaxTokens + 5)).errors(), fmt::format("1:{} file-too-large", kMaxTokens + 1));
}

TEST(Limits, ErrorsAreCapped) {
  EXPECT_LE(Reading(repeat("; ", 5000)).diagnostics.all().size(), 1001U);
  EXPECT_LE(Reading("NULL : T { + to f:\n" + repeat("n = .\n", 5000) + "}").diagnostics.all().size(), 1001U);
  EXPECT_LE(Reading("NULL : T { + to f:\n" + repeat("n = m -1.\n", 5000) + "}").diagnostics.all().size(), 1001U);
}

// Ten megabytes on one line: of a name, a string, a comment, blanks, digits, stray bytes, quotes.
TEST(Limits, ALineOfTenMegabytes) {
  constexpr std::size_t kBytes = 10'000'000;
  const std::vector<std::pair<std::string, bool>> texts{
      {repeat("x", kBytes), false},
      {"# " + repeat("x", kBytes), true},
      {repeat(" ", kBytes), true},
      {repeat("1", kBytes), false},
      {repeat(";", kBytes), false},
      {repeat("'", kBytes), false},
      {"\"" + repeat("x", kBytes), false},
      {repeat("\" ", kBytes / 2), false},
      {repeat("-", kBytes), false},
      {repeat("\\\"", kBytes / 2), false},
      {repeat("#! ", kBytes / 3), true},
      {"% " + repeat("%", kBytes), true},
      {"n = \"" + repeat("${n ", kBytes / 4) + "\"", false},
      {"n = \"" + repeat("${n{", kBytes / 4) + "\"", false},
  };
  for (const auto& [text, fine] : texts) {
    const Reading reading(text);
    EXPECT_EQ(reading.diagnostics.error_count() == 0, fine) << text.substr(0, 20);
    for (const Diagnostic& each : reading.diagnostics.all()) ASSERT_LT(format(each, reading.sources).size(), 800U);
  }
}

// A hundred thousand units each: a reader that is worse than linear in any of these shapes does not come back in the
// time that a test has.
TEST(Limits, LongTextsOfManyShapesAreRead) {
  const std::vector<std::pair<std::string, std::string>> shapes{
      {"NULL : T { + to f:\n", "self run at (n + 1) with \"$n of ${m}\".\n"},
      {"NULL : T { + to f:\n", "n = (4.\n"},
      {"NULL : T {\n", "+ to f at x (int):\n % doc\n return x.\n"},
      {"", "\"x "},
      {"NULL : T { + to f: print \"", "${a {"},
      {"NULL : T { + to f: print \"", "${a + }"},
      {"", "#! x\n"},
      {"NULL : T { + to f:\n", "{ n = \n"},
      {"", "} + to x: "},
      {"", "A : B { "},
      {"NULL : T { + to f: n = m", "\n k m"},
      {"NULL : T { + to f: ", "a, "},
  };
  for (const auto& [before, unit] : shapes) {
    constexpr std::size_t kUnits = 100'000;
    const Reading reading(before + repeat(unit, kUnits));
    EXPECT_GT(reading.diagnostics.all().size(), 0U) << unit;
    for (const Diagnostic& each : reading.diagnostics.all()) ASSERT_LT(format(each, reading.sources).size(), 800U);
  }
}

TEST(Limits, RandomBytesNeverCrash) {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    std::mt19937 random(seed);
    std::string text(random() % 300, ' ');
    for (char& c : text) c = static_cast<char>(random() % 256);
    const Reading reading(text);
    for (const Diagnostic& each : reading.diagnostics.all()) format(each, reading.sources);
  }
}

// Random sequences of real tokens get much further into the parser than random bytes.
TEST(Limits, RandomTokensNeverCrash) {
  constexpr std::string_view kPieces[] = {"n",
                                          "m",
                                          "self",
                                          "super",
                                          "5",
                                          "2.5",
                                          "\"x $n ${n + 1} ${(\"",
                                          "'c'",
                                          "(",
                                          ")",
                                          "[",
                                          "]",
                                          "{",
                                          "}",
                                          ".",
                                          ",",
                                          ":",
                                          "::",
                                          "+",
                                          "-",
                                          "*",
                                          "^",
                                          "=",
                                          "==",
                                          "++",
                                          "--",
                                          "+=",
                                          "||",
                                          "&&",
                                          "|",
                                          "!",
                                          "<",
                                          "@",
                                          "@use",
                                          "@define",
                                          "@include",
                                          "if",
                                          "else",
                                          "while",
                                          "for",
                                          "foreach",
                                          "each",
                                          "in",
                                          "print",
                                          "return",
                                          "free",
                                          "die",
                                          "new",
                                          "all",
                                          "random",
                                          "push",
                                          "onto",
                                          "pop",
                                          "insert",
                                          "at",
                                          "remove",
                                          "sort",
                                          "with",
                                          "copylist",
                                          "+ to",
                                          "- to f:",
                                          "+ variables:",
                                          "\nNULL : T {",
                                          "(int)",
                                          "(5 ints)",
                                          "int",
                                          "objects",
                                          "Controller",
                                          "\n",
                                          "\n% doc\n",
                                          "@@DEBUG@@",
                                          "?",
                                          "@native",
                                          "2147483648",
                                          "-"};
  for (unsigned seed = 0; seed < 4000; ++seed) {
    std::mt19937 random(seed);
    std::string text = seed % 2 == 0 ? "NULL : T { + to f: " : "";
    for (std::size_t i = random() % 120; i > 0; --i) {
      text += kPieces[random() % std::size(kPieces)];
      text += random() % 4 == 0 ? "" : " ";
    }
    const Reading reading(text, seed % 3 == 0);
    for (const Diagnostic& each : reading.diagnostics.all()) {
      EXPECT_FALSE(each.message.empty());
      EXPECT_GT(each.span.line, 0U) << text;
      format(each, reading.sources);
    }
  }
}

// Every prefix of a correct program is cut off somewhere new.
TEST(Limits, CutOffProgramsNeverCrash) {
  const std::string program = R"(@use Control.
@define LIMIT -5.
Controller Test.
Control : Test (aka Tests) [version 1.5] {
  + variables: a, b (int). c (3 Kiln objects).
  + to init with x = (1, -2, 3) (vector):
    n (list).
    % doc
    for a = 0, a < 5, a++: { push a onto n. if a == 2: print "$a ${a + 1}". else if b: {} else: b = |a| - 2. }
    foreach b in n: self run at (n{0} + random[5]) to [ (1,0,0), (0,1,0), (0,0,1) ].
    insert 3 at n{1}. sort n with compare. free (3 new Kiln). return x::x.
})";
  EXPECT_EQ(Reading(program).errors(), "");
  for (std::size_t length = 0; length < program.size(); ++length) {
    const Reading reading(program.substr(0, length));
    for (const Diagnostic& each : reading.diagnostics.all()) format(each, reading.sources);
  }
}

}  // namespace
}  // namespace breve::steve::test
