// Expressions: literals, precedence, postfixes, list operations, assignment, and where method calls may stand.
#include <gtest/gtest.h>

#include "reading.hpp"

namespace breve::steve::test::expressions_test {
namespace {

struct Row {
  const char* text;
  const char* tree;
};

void expect_expressions(const std::vector<Row>& rows) {
  for (const Row& row : rows) EXPECT_EQ(expression(row.text), row.tree) << row.text;
}

void expect_statements(const std::vector<Row>& rows) {
  for (const Row& row : rows) EXPECT_EQ(statements(row.text), row.tree) << row.text;
}

TEST(Expressions, LiteralsAndNames) {
  expect_expressions({{"5", "5"},
                      {"5.0", "5.0"},
                      {"'a'", "97"},
                      {"\"text\"", "\"text\""},
                      {"n", "n"},
                      {"in", "in"},
                      {"variables", "variables"},
                      {"self", "self"},
                      {"super", "super"},
                      {"(1, n, -2.5)", "(vec 1 n -2.5)"},
                      {"{}", "(list)"},
                      {"{ # nothing\n }", "(list)"},
                      {"{1, {2}, \"x\"}", "(list 1 (list 2) \"x\")"},
                      {"[ (1, 0, 0), (0, n, 0), (0, 0, 1) ]", "(mat 1 0 0 0 n 0 0 0 1)"},
                      {"@@DEBUG@@(n + 1)", "(n + 1)"}});
}

TEST(Expressions, Primaries) {
  expect_expressions({{"(n)", "n"},
                      {"(self get-level)", "(call self get-level)"},
                      {"f()", "(fn f)"},
                      {"f (n, m + 1)", "(fn f n (m + 1))"},
                      {"|n|", "(mag n)"},
                      {"| |n| - 2 |", "(mag ((mag n) - 2))"},
                      {"|n| + |m|", "((mag n) + (mag m))"},
                      {"random[5]", "(random 5)"},
                      {"random [(1, 2, 3)]", "(random (vec 1 2 3))"},
                      {"new Kiln", "(new Kiln)"},
                      {"new \"Kiln\"", "(new Kiln)"},
                      {"all Kilns", "(all Kilns)"},
                      {"a[i + 1]", "(item a (i + 1))"}});
}

TEST(Expressions, PostfixesBindToTheLeft) {
  expect_expressions({{"k{1}", "(at k 1)"},
                      {"k{1}{2}", "(at (at k 1) 2)"},
                      {"a[1]{2}", "(at (item a 1) 2)"},
                      {"v::x", "(:: v x)"},
                      {"v::Y", "(:: v y)"},
                      {"v ::z", "(:: v z)"},
                      {"h::list", "(:: h list)"},
                      {"v::x-1", "(:: v x-1)"},
                      {"o::part::x", "(:: (:: o part) x)"},
                      {"(self get)::x", "(:: (call self get) x)"},
                      {"(1, 2, 3)::x", "(:: (vec 1 2 3) x)"},
                      {"{1, 2}{0}", "(at (list 1 2) 0)"},
                      {"3 new Kiln", "(new Kiln 3)"},
                      {"1 + 1 new Kiln", "(1 + (new Kiln 1))"},
                      {"(n) new Kilns", "(new Kilns n)"},
                      {"-1 new Kiln", "(neg (new Kiln 1))"}});
}

TEST(Expressions, TheLetterOfAComponentIsKept) {
  const Reading reading("NULL : T { + to f: return v::X + v::x + v::width. }");
  const auto& chain = std::get<ast::Chain>(std::get<ast::Return>(reading.method().body.at(0)->node).value->node);
  EXPECT_EQ(std::get<ast::Member>(chain.first->node).letter, 'X');
  EXPECT_EQ(std::get<ast::Member>(chain.rest.at(0).second->node).letter, 'x');
  EXPECT_EQ(std::get<ast::Member>(chain.rest.at(1).second->node).letter, 0);
}

TEST(Expressions, PrecedenceIsTheLanguagesOwn) {
  expect_expressions({{"2 * 3 ^ 2", "(2 * 3 ^ 2)"},
                      {"2 ^ 3 ^ 2", "(2 ^ 3 ^ 2)"},
                      {"-2 ^ 2", "(-2 ^ 2)"},
                      {"- 2 ^ 2", "(-2 ^ 2)"},
                      {"-n ^ 2", "((neg n) ^ 2)"},
                      {"1 + 2 * 3 - 4", "(1 + (2 * 3) - 4)"},
                      {"a / b % c", "(a / b % c)"},
                      {"!a == 1", "((! a) == 1)"},
                      {"!!a", "(! (! a))"},
                      {"! -a", "(! (neg a))"},
                      {"1 < 2 == 1", "(1 < 2 == 1)"},
                      {"a != b >= c <= d > e", "(a != b >= c <= d > e)"},
                      {"a + 1 < b * 2", "((a + 1) < (b * 2))"},
                      {"a || b && c || d", "(a || (b && c) || d)"},
                      {"a == 1 && b == 2", "((a == 1) && (b == 2))"},
                      {"(a || b) && c", "((a || b) && c)"},
                      {"1 + (n = 2)", "(1 + (= n 2))"}});
}

TEST(Expressions, MinusIsUnaryOrBinaryByPosition) {
  expect_expressions({{"n - 1", "(n - 1)"},
                      {"n- 1", "(n - 1)"},
                      {"n -1", "(n - 1)"},
                      {"n-1", "n-1"},
                      {"(n)-1", "(n - 1)"},
                      {"k{0}-1", "((at k 0) - 1)"},
                      {"|k|-1", "((mag k) - 1)"},
                      {"f()-1", "((fn f) - 1)"},
                      {"5-3", "(5 - 3)"},
                      {"x-.5", "(x - 0.5)"},
                      {"n*-1", "(n * -1)"},
                      {"n - -1", "(n - -1)"},
                      {"{-1, -2}", "(list -1 -2)"},
                      {"- -5", "5"},
                      {"-2147483648", "-2147483648"},
                      {"-x", "(neg x)"},
                      {"-(5)", "-5"},
                      {"-2.5", "-2.5"}});
  EXPECT_EQ(expression("n - 2147483648"), "error 1:12 integer-too-large");
  EXPECT_EQ(statements("self set-level to -1."), "(call self set-level to:-1).");
}

TEST(Expressions, ListOperations) {
  expect_statements({{"push 1 + 2 onto k.", "(push (1 + 2) k)."},
                     {"push (self measure) onto k{2}.", "(push (call self measure) (at k 2))."},
                     {"prepend x onto o::list.", "(prepend x (:: o list))."},
                     {"n = pop k.", "(= n (pop k))."},
                     {"n = pop k{2} + 1.", "(= n ((pop (at k 2)) + 1))."},
                     {"unprepend k.", "(unprepend k)."},
                     {"insert x at k{0}.", "(insert x k 0)."},
                     {"insert at at k{1}{2}.", "(insert at (at k 1) 2)."},
                     {"remove h{\"key\"}.", "(remove h \"key\")."},
                     {"m = copylist k.", "(= m (copylist k))."},
                     {"sort k with compare.", "(sort k compare)."},
                     {"push push 1 onto a onto b.", "(push (push 1 a) b)."}});
}

TEST(Expressions, AssignmentsAreCompleteExpressions) {
  expect_statements({{"n = m = 3.", "(= n (= m 3))."},
                     {"f(n = 2).", "(fn f (= n 2))."},
                     {"k = {n = 1, 2}.", "(= k (list (= n 1) 2))."},
                     {"n += 1.", "(+= n 1)."},
                     {"n -= 1. n *= 2. n /= 3. n %= 4. n ^= 5.", "(-= n 1). (*= n 2). (/= n 3). (%= n 4). (^= n 5)."},
                     {"n++. n--.", "(++ n). (-- n)."},
                     {"m = n++.", "(= m (++ n))."}});
}

TEST(Expressions, EveryTargetTakesEveryAssignment) {
  for (const std::string target : {"n", "a[i]", "k{i}", "v::x", "o::part", "m{1}{2}", "a[0]{1}", "(self get){0}"}) {
    const std::string tree = expression(target);
    EXPECT_EQ(statements(target + " = 5."), "(= " + tree + " 5).");
    EXPECT_EQ(statements(target + " += 5."), "(+= " + tree + " 5).");
    EXPECT_EQ(statements(target + "++."), "(++ " + tree + ").");
    EXPECT_EQ(statements(target + "--."), "(-- " + tree + ").");
  }
}

TEST(Expressions, OtherThingsAreNoTargets) {
  for (const char* text : {"5 = 3.", "1 + n = 2.", "(n) = 3.", "f() = 2.", "-n = 2.", "5++.", "(n)++.", "self = 3.",
                           "{n} = {3}.", "(a, b, c) = v.", "n++ = 3."}) {
    EXPECT_NE(statements(text).find("error"), std::string::npos) << text;
  }
  EXPECT_EQ(body_errors("1 + n = 2."), "1:7 bad-target");
}

TEST(Expressions, CallsStandAsStatementsAndAtTheRightOfAVariable) {
  expect_statements(
      {{"self move.", "(call self move)."},
       {"self place at p + (0, 1, 0) times n * 2.", "(call self place at:(p + (vec 0 1 0)) times:(n * 2))."},
       {"n = self measure.", "(=call n (call self measure))."},
       {"n = (self measure).", "(= n (call self measure))."},
       {"print (self measure) + 1.", "(print ((call self measure) + 1))"},
       {"(new Kiln prepare volume 3.0) run.", "(call (call (new Kiln) prepare volume:3.0) run)."},
       {"k{0} run.", "(call (at k 0) run)."},
       {"all Kilns run.", "(call (all Kilns) run)."},
       {"3 new Kiln run.", "(call (new Kiln 3) run)."},
       {"o::part run at at.", "(call (:: o part) run at:at)."},
       {"super iterate.", "(call super iterate)."},
       {"o set to (1, 2, 3) with {1} in [ (1,0,0), (0,1,0), (0,0,1) ].",
        "(call o set to:(vec 1 2 3) with:(list 1) in:(mat 1 0 0 0 1 0 0 0 1))."},
       {"n = to measure.", "(=call n (call to measure))."},
       {"o set x y with interfaces.", "(call o set x:y with:interfaces)."},
       {"o put value n = 5.", "(call o put value:(= n 5))."}});
}

TEST(Expressions, CallsElsewhereNeedParentheses) {
  for (const char* text : {"return self measure.", "print self measure.", "n += self measure.", "k{0} = self measure.",
                           "k = {self measure}.", "if self measure: n = 1.", "while self measure: n = 1.",
                           "print 1 + self measure.", "n = m = self measure.", "f(self measure).", "free self measure.",
                           "push self measure onto k.", "x = k{self measure}.", "(n = self measure)."}) {
    EXPECT_NE(body_errors(text).find("call-needs-parentheses"), std::string::npos) << text;
    EXPECT_EQ(body_errors(text).find(','), std::string::npos) << text;
  }
  EXPECT_EQ(body_errors("print self measure at 5, 3."), "1:7 call-needs-parentheses");
}

TEST(Expressions, ConstantsAreReplacedWhereOperandsStand) {
  const Reading reading(
      "@define LIMIT 5.\n@define HERE (1, -2, 3).\nNULL : T { + to f: n = LIMIT + HERE. m = LIMIT-1. h::LIMIT = 2. }");
  EXPECT_EQ(reading.errors(), "");
  EXPECT_EQ(show(*reading.method().body.at(0)), "(= n ((const LIMIT 5) + (const HERE (1 -2 3)))).");
  EXPECT_EQ(show(*reading.method().body.at(1)), "(= m LIMIT-1).");
  EXPECT_EQ(show(*reading.method().body.at(2)), "(= (:: h LIMIT) 2).");
}

TEST(Expressions, SpansCoverTheirText) {
  const Reading reading("NULL : T { + to f:\n  n = (a + b) * self.\n}");
  const ast::Stmt& statement = *reading.method().body.at(0);
  EXPECT_EQ(statement.span.line, 2U);
  EXPECT_EQ(statement.span.column, 3U);
  EXPECT_EQ(statement.span.length, 19U);
  const auto& assign = std::get<ast::Assign>(std::get<ast::ExprStmt>(statement.node).expr->node);
  EXPECT_EQ(assign.value->span.column, 7U);
  EXPECT_EQ(assign.value->span.length, 14U);
  const auto& chain = std::get<ast::Chain>(assign.value->node);
  EXPECT_TRUE(chain.first->parenthesised);
  EXPECT_EQ(chain.first->span.length, 7U);
  EXPECT_EQ(chain.operators.at(0).column, 15U);
}

TEST(Expressions, ALongSumIsOneNode) {
  std::string text = "n = 1";
  for (int i = 0; i < 5000; ++i) text += " + 1";
  EXPECT_EQ(body_errors(text + "."), "");
}

TEST(ExpressionLints, WarnAndKeepTheMeaning) {
  const std::vector<Row> rows{{"n = m -1.", "1:7 lint-minus-spacing"},
                              {"n = m - 1.", ""},
                              {"n = m -k.", ""},
                              {"k = {1 -1}.", "1:8 lint-minus-spacing"},
                              {"n = 2*x^2.", "1:8 lint-precedence"},
                              {"n = x^y^z.", "1:8 lint-precedence"},
                              {"n = -2^2.", "1:7 lint-precedence"},
                              {"n = 2*(x^2).", ""},
                              {"n = x^2*3.", ""},
                              {"n = (-2)^2.", ""},
                              {"k = n new Kiln.", "1:5 lint-new-count"},
                              {"k = 5 new Kiln.", ""},
                              {"if n = 5: n = 1.", "1:4 lint-assignment-condition"},
                              {"if (n = 5): n = 1.", ""},
                              {"while n = 5: n = 1.", "1:7 lint-assignment-condition"},
                              {"for n = 0, n = 5, n++: f().", "1:12 lint-assignment-condition"},
                              {"n == 5. n = 1.", "1:3 lint-unused-comparison"},
                              {"n = 1. n == 5.", ""}};
  for (const Row& row : rows) {
    EXPECT_EQ(body_warnings(row.text), row.tree) << row.text;
    EXPECT_EQ(body_errors(row.text), "") << row.text;
  }
}

}  // namespace
}  // namespace breve::steve::test::expressions_test
