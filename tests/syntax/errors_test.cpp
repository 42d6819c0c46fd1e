// Mistakes in statements: each is reported once, where it is, and reading goes on behind it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reading.hpp"

namespace breve::steve::test::errors_test {
namespace {

struct Row {
  const char* text;
  const char* errors;
};

void expect_errors(const std::vector<Row>& rows) {
  for (const Row& row : rows) EXPECT_EQ(body_errors(row.text), row.errors) << row.text;
}

TEST(Errors, AMissingPeriodIsShownAtTheEndOfItsStatement) {
  expect_errors({{"n = 5\nm = 6.", "1:6 missing-period"},
                 {"n = m\nm = 6.", "1:6 missing-period"},
                 {"n = m\nk run at 5.", "1:6 missing-period"},
                 {"self run at 5\nself stop.", "1:14 missing-period"},
                 {"k run\nm stop at 5 6.", "1:6 missing-period, 2:13 call-arguments"},
                 {"n = 5\nk run.", "1:6 missing-period"},
                 {"n = m\nk{0} = 5.", "1:6 missing-period"},
                 {"n++\nm--", "1:4 missing-period, 2:4 missing-period"},
                 {"print \"x\"\nprint \"y\".", "1:10 missing-period"},
                 {"return\nn = 5.", ""},
                 {"{ n = 5 }", "1:8 missing-period"},
                 {"if n: { m = 5 }\nn = 6.", "1:14 missing-period"},
                 {"if n: { self run }\nn = 6.", "1:17 missing-period"},
                 {"if n: m = 5\nn = 6.", "1:12 missing-period"},
                 {"n = 5 # remark\nm = 6.", "1:6 missing-period"},
                 {"a = b.5", "1:6 syntax"}});
}

TEST(Errors, AMissingPeriodBeforeAMethodHeader) {
  EXPECT_EQ(Reading("NULL : T {\n+ to f: n = 5\n+ to g: m = 6.\n}").errors(), "2:14 missing-period");
  EXPECT_EQ(Reading("NULL : T {\n+ to f: n = m\n- to g at x (int): m = 6.\n}").errors(), "2:14 missing-period");
  EXPECT_EQ(Reading("NULL : T {\n+ to f: n = m\n= to g: m = 6.\n}").errors(), "2:14 missing-period");
}

TEST(Errors, MissingColons) {
  expect_errors({{"if n { m = 1. }", "1:5 missing-colon"},
                 {"if (n) m = 1.", "1:7 missing-colon"},
                 {"if n\n  m = 1.", "1:5 missing-colon"},
                 {"while n < 5 { n++. }", "1:12 missing-colon"},
                 {"foreach n in k print n.", "1:15 missing-colon"},
                 {"for n = 0, n < 5, n++ { f(). }", "1:22 missing-colon"},
                 {"if n, m = 1.", "1:5 syntax"}});
}

TEST(Errors, BracketsAndOperands) {
  expect_errors({{"n = (4.", "1:7 missing-parenthesis"},
                 {"n = 4).", "1:6 syntax"},
                 {"n = ().", "1:6 syntax"},
                 {"n = (1, 2).", "1:10 syntax"},
                 {"n = (1, 2, 3, 4).", "1:13 syntax"},
                 {"k = {1, 2.", "1:10 syntax"},
                 {"k = {1, 2,}.", "1:11 syntax"},
                 {"n = |m.", "1:7 syntax"},
                 {"n = | |a| - |b||.", "1:15 syntax"},
                 {"n = ||a| - 2|.", "1:5 syntax"},
                 {"n = 3 + .", "1:9 syntax"},
                 {"n = + 3.", "1:5 syntax"},
                 {"n = --m.", "1:5 syntax"},
                 {"n = * 3.", "1:5 syntax"},
                 {"n = k{}.", "1:6 syntax"},
                 {"n = f(1.", "1:8 syntax"},
                 {"n = random(5).", "1:11 syntax"},
                 {"n = (m)[0].", "1:8 syntax"},
                 {"n = v:: x.", "1:6 syntax"},
                 {"n = v::5.", "1:8 syntax"},
                 {"m = [ (1, 2, 3), n, (1, 2, 3) ].", "1:18 syntax"},
                 {"m = [ (1, 2, 3), (n), (1, 2, 3) ].", "1:18 syntax"},
                 {"n = new 5.", "1:9 syntax"},
                 {"n = @define.", "1:5 syntax"},
                 {"n = list.", "1:5 syntax"},
                 {"print \"a\" b.", "1:11 syntax"},
                 {"print.", "1:6 syntax"},
                 {"die.", "1:4 syntax"},
                 {".", "1:1 syntax"}});
}

TEST(Errors, ListOperationsAndLoops) {
  expect_errors({{"sort k by compare.", "1:8 sort-with"},
                 {"sort k compare.", "1:8 sort-with"},
                 {"push 1 into k.", "1:8 syntax"},
                 {"push 1.", "1:7 syntax"},
                 {"insert 1 at k.", "1:13 syntax"},
                 {"insert 1 onto k{0}.", "1:10 syntax"},
                 {"remove k.", "1:8 syntax"},
                 {"foreach n of k: f().", "1:11 syntax"},
                 {"for n = 0, n < 5: f().", "1:17 syntax"},
                 {"else n = 5.", "1:1 stray-else"},
                 {"if n: m = 1. m = 2. else m = 3.", "1:21 stray-else"},
                 {"if n: { m = 1. }.", "1:17 stray-period"},
                 {"self run at.", "1:10 call-arguments"},
                 {"self run at self measure.", "1:13 call-needs-parentheses"}});
}

TEST(Errors, AllOfAFileAreReported) {
  const Reading reading(R"(@use Control
@include "a.tz"
NULL : First {
  + variables:
    a (flaot).
    b (int).
  + to init:
    n = (4.
    if n > { m = 1. }
    n = 5
    m = ; 6.
  + to list: print "x" y.
  - to good at x (int):
    return x.
}
NULL : Second {
  + to f:
    { n = 1.
  + to g:
    n = 2 3.
}
Controller First
)");
  EXPECT_EQ(reading.errors(),
            "1:13 missing-period, 5:8 unknown-type, 8:11 missing-parenthesis, 9:12 syntax, 10:10 missing-period, 11:9 "
            "syntax, "
            "12:8 reserved-word, 12:24 syntax, 18:5 missing-brace, 20:11 syntax, 22:17 missing-period");
  EXPECT_EQ(reading.file.classes.size(), 2U);
  EXPECT_EQ(reading.only_class().methods.size(), 3U);
  EXPECT_EQ(reading.method(2).parameters.size(), 1U);
}

TEST(Errors, StrayBracesDoNotEndTheClass) {
  const Reading reading("NULL : T {\n+ to f:\n  n = 1. }\n  m = 2.\n+ to g: return.\n}\n");
  EXPECT_EQ(reading.errors(), "3:10 stray-brace");
  EXPECT_EQ(reading.method(0).body.size(), 2U);
  EXPECT_EQ(reading.only_class().methods.size(), 2U);
}

TEST(Errors, ABrokenConditionDoesNotHideItsBody) {
  expect_errors(
      {{"if n + : m = .", "1:8 syntax, 1:14 syntax"}, {"while (n: { m = . }", "1:9 missing-parenthesis, 1:17 syntax"}});
}

TEST(Errors, SayWhatToDo) {
  const std::vector<std::pair<std::string, std::string>> rows{
      {"sort k by compare.", "write: sort list with method-name"},
      {"return self measure.", "write it as (self measure)"},
      {"return self measure at 5.", "write it as (self measure at 5)"},
      {"if n: { m = 1. }.", "remove it"},
      {"n = ||a| - 2|.", "write a space between nested bars: | |a| - b |"},
      {"a = b.5", "write a space after the '.' that ends a statement"},
      {"if 1 + n = 2: f().",
       "to compare, write '=='; to assign inside an expression, put the assignment in parentheses"},
      {"n = @define.", ""},
      {"if a and b: f().", "logical and is written '&&'"},
      {"if a == 5 or b: f().", "logical or is written '||'"},
      {"list (int).", "choose another name"}};
  for (const auto& [text, help] : rows) {
    const Reading reading("NULL : T { + to f:\n" + text + "\n}");
    ASSERT_FALSE(reading.diagnostics.all().empty()) << text;
    EXPECT_EQ(reading.diagnostics.all().front().help, help) << text;
  }
}

TEST(Errors, OfTheScannerSilenceTheirLine) {
  EXPECT_EQ(body_errors("n = 5 ~ m\nn = ."), "1:7 unexpected-byte, 2:5 syntax");
  EXPECT_EQ(body_errors("print \"open.\nn = ."), "1:7 unterminated-string, 2:5 syntax");
}

}  // namespace
}  // namespace breve::steve::test::errors_test
