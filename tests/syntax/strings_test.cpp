// Escapes and interpolation of string expressions.
#include <gtest/gtest.h>

#include "reading.hpp"

namespace breve::steve::test::strings_test {
namespace {

struct Row {
  const char* text;
  const char* tree;
  const char* lint;
};

void expect_strings(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    EXPECT_EQ(expression(row.text), row.tree) << row.text;
    EXPECT_EQ(body_warnings(std::string("f(") + row.text + ")."), row.lint) << row.text;
  }
}

TEST(Strings, KnownEscapesAreProcessedAndOthersKept) {
  expect_strings({{R"("a\nb\tc\"d\\e")", "\"a\nb\tc\"d\\e\"", ""},
                  {R"("\q\x")", R"("\q\x")", ""},
                  {R"("c:\\")", R"("c:\")", ""},
                  {"\"two\nlines\"", "\"two\nlines\"", ""}});
}

TEST(Strings, ReferencesAreSplitOff) {
  expect_strings({{R"("$n.")", R"(("" $n "."))", ""},
                  {R"("$n$m")", R"(("" $n "" $m ""))", ""},
                  {R"("$k{1}!")", R"(("" $k{1} "!"))", ""},
                  {R"("$k{ 1 }!")", R"(("" $k{1} "!"))", ""},
                  {R"("$a[2]")", R"(("" $a[2] ""))", ""},
                  {R"("${n}th")", R"(("" $n "th"))", ""},
                  {R"("${k{1}}x")", R"(("" $k{1} "x"))", ""},
                  {R"("${a[1]}x")", R"(("" $a[1] "x"))", ""},
                  {R"("${k}{1}")", R"(("" $k "{1}"))", ""},
                  {R"("$n-")", R"(("" $n- ""))", ""},
                  {R"("$1st")", R"(("" $1st ""))", ""},
                  {R"("${n}-")", R"(("" $n "-"))", ""},
                  {R"("$n::x")", R"(("" $n "::x"))", ""},
                  {R"("$self, $super")", R"(("" $self ", " $self ""))", ""},
                  {R"("${n} } $m}")", R"(("" $n " } " $m "}"))", ""},
                  {R"("\\$n")", R"(("\" $n ""))", ""}});
}

TEST(Strings, DoubtfulDollarsAreLinted) {
  expect_strings({{R"("price \$n")", R"("price \$n")", "1:10 lint-escaped-dollar"},
                  {R"("five $")", R"("five ")", "1:9 lint-lone-dollar"},
                  {R"("a $ b")", R"("a $ b")", "1:6 lint-lone-dollar"},
                  {R"("${}")", R"("${}")", "1:4 lint-lone-dollar"},
                  {R"("${")", R"("${")", "1:4 lint-lone-dollar"},
                  {R"("$k{i}")", R"(("" $k "{i}"))", "1:6 lint-interpolation"},
                  {R"("$k{ and")", R"(("" $k "{ and"))", "1:6 lint-interpolation"},
                  {R"("$k{}")", R"(("" $k "{}"))", "1:6 lint-interpolation"},
                  {R"("$k[1}")", R"(("" $k "[1}"))", "1:6 lint-interpolation"},
                  {R"("$k{-1}")", R"(("" $k "{-1}"))", "1:6 lint-interpolation"},
                  {R"("$k{99999999999}")", R"(("" $k "{99999999999}"))", "1:6 lint-interpolation"},
                  {R"("${n")", R"(("" $n ""))", "1:4 lint-interpolation"},
                  {R"("${n items}")", R"(("" $n " items}"))", "1:4 lint-interpolation"}});
}

TEST(Strings, BracesMayHoldAnExpression) {
  expect_strings({{R"("${n + 1}!")", R"(("" $=(n + 1) "!"))", ""},
                  {R"("${k{i}}")", R"(("" $=(at k i) ""))", ""},
                  {R"("${(self level)}")", R"(("" $=(call self level) ""))", ""},
                  {R"("${h{\"key\"}} x")", R"(("" $=(at h "key") " x"))", ""},
                  {R"("${v::x}, ${|k|}")", R"(("" $=(:: v x) ", " $=(mag k) ""))", ""}});
  const Reading reading("NULL : T { + to f:\n  print \"x ${a + b}\".\n}");
  const auto& print = std::get<ast::Print>(reading.method().body.at(0)->node);
  const auto& literal = std::get<ast::StringLit>(print.items.at(0)->node);
  EXPECT_EQ(literal.parts.at(0).span.column, 12U);
  EXPECT_EQ(literal.parts.at(0).span.length, 8U);
  EXPECT_EQ(literal.parts.at(0).expr->span.line, 2U);
  EXPECT_EQ(literal.parts.at(0).expr->span.column, 14U);
}

TEST(Strings, AnExpressionInBracesThatIsWrongIsAnError) {
  EXPECT_EQ(body_errors(R"(print "${(a + }".)"), "1:15 syntax");
  EXPECT_EQ(body_errors(R"(print "${~}".)"), "1:10 unexpected-byte");
}

TEST(Strings, ConstantsDefaultsAndFileNamesKeepTheirEscapes) {
  const Reading reading(
      "@define TEXT \"a\\n$n\".\n@include \"a\\b\"\nNULL : T { + to f with w = \"\\t$x\" (string): print TEXT, new "
      "\"a$b\". }");
  EXPECT_EQ(reading.errors(), "");
  EXPECT_EQ(reading.warnings(), "");
  EXPECT_EQ(reading.file.directives.at(0).text, "a\\b");
  EXPECT_EQ(show(*reading.method().parameters.at(0).default_value), "\"\\t$x\"");
  EXPECT_EQ(show(*reading.method().body.at(0)), "(print (const TEXT \"a\\n$n\") (new a$b))");
}

}  // namespace
}  // namespace breve::steve::test::strings_test
