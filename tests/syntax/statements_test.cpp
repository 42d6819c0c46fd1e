// Statements, blocks, and what `{` and `else` belong to.
#include <gtest/gtest.h>

#include "reading.hpp"

namespace breve::steve::test::statements_test {
namespace {

struct Row {
  const char* text;
  const char* tree;
};

void expect_statements(const std::vector<Row>& rows) {
  for (const Row& row : rows) EXPECT_EQ(statements(row.text), row.tree) << row.text;
}

TEST(Statements, Simple) {
  expect_statements({{"print 1, n, \"x\".", "(print 1 n \"x\")"},
                     {"printf n.", "(printf n)"},
                     {"return.", "(return)"},
                     {"return n + 1.", "(return (n + 1))"},
                     {"free self.", "(free self)"},
                     {"die \"no\".", "(die \"no\")"},
                     {"n.", "n."},
                     {"n = 5.m = 6.", "(= n 5). (= m 6)."},
                     {"", ""},
                     {"new Kiln.", "(new Kiln)."}});
}

TEST(Statements, IfTakesTheNearestElse) {
  expect_statements({{"if a: b.", "(if a b.)"},
                     {"if a: b. else c.", "(if a b. else c.)"},
                     {"if a: b. else: c.", "(if a b. else c.)"},
                     {"if a: b. else if c: d. else e.", "(if a b. c d. else e.)"},
                     {"if a: b. else: if c: d.", "(if a b. c d.)"},
                     {"if a: if b: c. else d.", "(if a (if b c. else d.))"},
                     {"if a: { if b: c. } else d.", "(if a {(if b c.)} else d.)"},
                     {"if a: {} else b.", "(if a {} else b.)"},
                     {"if a: {}. else b.", "(if a {} else b.)"},
                     {"if a::x: b.", "(if (:: a x) b.)"},
                     {"if a:b.", "(if a b.)"}});
}

TEST(Statements, Loops) {
  expect_statements(
      {{"while n < 5: n++.", "(while (n < 5) (++ n).)"},
       {"while n: {}.", "(while n {})"},
       {"while n: {} m = 1.", "(while n {}) (= m 1)."},
       {"for n = 0, n < 5, n += 1: print n.", "(for (= n 0) (n < 5) (+= n 1) (print n))"},
       {"for n=0,n<5,n++:{ f(). g(). }", "(for (= n 0) (n < 5) (++ n) {(fn f). (fn g).})"},
       {"foreach item in k: print item.", "(foreach item k (print item))"},
       {"for each item in (self list-all): { print item. }", "(foreach item (call self list-all) {(print item)})"},
       {"for each = 0, each < 5, each++: f().", "(for (= each 0) (each < 5) (++ each) (fn f).)"},
       {"for each, n, m: f().", "(for each n m (fn f).)"},
       {"foreach each in in: f().", "(foreach each in (fn f).)"},
       {"foreach item in all Kilns: f().", "(foreach item (all Kilns) (fn f).)"}});
}

TEST(Statements, BracesAreBlocksOrListsByTheirContent) {
  expect_statements({{"{ n = 1. }", "{(= n 1).}"},
                     {"{ n = 1. m = 2. }", "{(= n 1). (= m 2).}"},
                     {"{}", "{}"},
                     {"{ # nothing\n}", "{}"},
                     {"{} {}. {}", "{} {} {}"},
                     {"{ { n. } }", "{{n.}}"},
                     {"{ if a: { b. } }", "{(if a {b.})}"},
                     {"{ while a: {} }", "{(while a {})}"},
                     {"{1, 2}.", "(list 1 2)."},
                     {"{n} run.", "(call (list n) run)."},
                     {"{n, m} run.", "(call (list n m) run)."},
                     {"{n}{0} = 5.", "(= (at (list n) 0) 5)."},
                     {"k = {}.", "(= k (list))."},
                     {"k = { # nothing\r }.", "(= k (list))."}});
}

TEST(Statements, MultipleLinesAndDocumentationInside) {
  expect_statements({{"self add\n  named \"x\"\n  for-method \"y\".", "(call self add named:\"x\" for-method:\"y\")."},
                     {"k = { 1,\n % second\n 2 }.", "(= k (list 1 2))."},
                     {"n = a\n - b.", "(= n (a - b))."},
                     {"n = a\n % b.", "(= n (a % b))."},
                     {"n = a\n + to.", "(= n (a + to))."},
                     {"self move from a\n + to by 5.", "(call self move from:(a + to) by:5)."}});
}

TEST(Statements, InteractiveStatementsNeedNoPeriod) {
  for (const auto& [text, tree] :
       std::vector<std::pair<std::string, std::string>>{{"n = 5", "(= n 5)."},
                                                        {"print self measure-it", "error"},
                                                        {"self move to 5", "(call self move to:5)."},
                                                        {"if a: b", "(if a b.)"},
                                                        {"print LIMIT.", "(print (const LIMIT 7))"}}) {
    Sources sources;
    Diagnostics diagnostics;
    Defines defines;
    defines.add("LIMIT", ast::Constant{7, {}}, false);
    const std::vector<Token> tokens = lex(sources, sources.add("typed", text), diagnostics);
    const ast::Method method = parse_statement(tokens, defines, diagnostics, sources);
    if (tree == "error") {
      EXPECT_EQ(diagnostics.error_count(), 1U) << text;
      continue;
    }
    EXPECT_EQ(diagnostics.error_count(), 0U) << text;
    ASSERT_EQ(method.body.size(), 1U) << text;
    EXPECT_EQ(show(*method.body.at(0)), tree);
  }
}

}  // namespace
}  // namespace breve::steve::test::statements_test
