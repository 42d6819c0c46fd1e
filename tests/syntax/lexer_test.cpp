// The scanner: every kind of token, and its errors.
#include "steve/syntax/lexer.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace breve::steve {
namespace {

struct Scan {
  explicit Scan(std::string text) { tokens = lex(sources, sources.add("test.tz", std::move(text)), diagnostics); }
  // Tokens with a mark of their kind: i int, d double, s string, % documentation; names and signs as written.
  std::string text() const {
    std::string result;
    for (const Token& token : tokens) {
      if (token.kind == TokenKind::End) break;
      if (!result.empty()) result += ' ';
      switch (token.kind) {
        case TokenKind::Int: result += fmt::format("i{}", token.int_value); break;
        case TokenKind::Double: result += fmt::format("d{}", token.double_value); break;
        case TokenKind::String: result += fmt::format("s<{}>", token.text); break;
        default: result += token.text;
      }
    }
    return result;
  }
  std::string errors() const {
    std::string result;
    for (const Diagnostic& each : diagnostics.all()) {
      result += fmt::format("{}{}:{} {}", result.empty() ? "" : ", ", each.span.line, each.span.column, each.code);
    }
    return result;
  }
  Sources sources;
  Diagnostics diagnostics;
  std::vector<Token> tokens;
};

struct Row {
  const char* text;
  const char* tokens;
};

void expect_rows(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    const Scan scan(row.text);
    EXPECT_EQ(scan.text(), row.tokens) << row.text;
    EXPECT_EQ(scan.errors(), "") << row.text;
  }
}

void expect_errors(const std::vector<Row>& rows) {
  for (const Row& row : rows) EXPECT_EQ(Scan(row.text).errors(), row.tokens) << row.text;
}

TEST(Lexer, CommentsEndAtTheLineOrAtTheirClosingMark) {
  expect_rows({{"a # b\nc", "a c"},
               {"a#b", "a"},
               {"\"a # b\"", "s<a # b>"},
               {"a #! b \n c !# d", "a d"},
               {"#! no #! nesting !# here", "here"},
               {"% a doc line\nb", "% a doc line b"},
               {"  \t% indented\nb", "% indented b"},
               {"+ section Moving around\nb", "b"},
               {"+ section\nb", "b"},
               {"  +section x\rb", "b"},
               {"+ sections = 1", "+ sections = i1"}});
}

TEST(Lexer, FirstLineShebangIsALineComment) {
  expect_rows({{"#!/usr/bin/env breve\na", "a"},
               {"#!/usr/bin/breve\na #! b !# c", "a c"},
               {"\xEF\xBB\xBF#!/bin/x\na", "a"},
               {"#! a block\n on top !# b", "b"}});
  EXPECT_EQ(Scan("a\n#! open\nb").errors(), "2:1 unclosed-comment");
  EXPECT_EQ(Scan("a\n#! open\nb").text(), "a b");
}

TEST(Lexer, LeadingPercentContinuesAnUnfinishedExpression) {
  expect_rows({{"n = a\n  % b.", "n = a % b ."},
               {"n = (a + 1)\n % (b * 2).", "n = ( a + i1 ) % ( b * i2 ) ."},
               {"n = a.\n% b.", "n = a . % b."},
               {"k = { 1,\n % second\n 2 }.", "k = { i1 , % second i2 } ."},
               {"if x:\n % why\n", "if x : % why"},
               {"@include \"x\"\n% doc\n", "@ include s<x> % doc"}});
  const Scan prose("n = a\n  % adding b\n + b.");
  EXPECT_EQ(prose.text(), "n = a % adding b + b .");
  EXPECT_EQ(prose.errors(), "2:3 lint-leading-percent");
}

TEST(Lexer, NamesHoldDashesButDoNotEndWithThem) {
  expect_rows({{"a-b", "a-b"},
               {"a - b", "a - b"},
               {"a -b", "a - b"},
               {"a- b", "a - b"},
               {"a-1", "a-1"},
               {"a - 1", "a - i1"},
               {"a- 1", "a - i1"},
               {"a -1", "a - i1"},
               {"a--", "a --"},
               {"a--b", "a--b"},
               {"a-=1", "a -= i1"},
               {"_x_", "_x_"},
               {"a-b-_-", "a-b-_ -"},
               {"a1", "a1"},
               {"push-up", "push-up"},
               {"newest", "newest"}});
}

TEST(Lexer, NumbersAreUnsigned) {
  expect_rows({{"5", "i5"},
               {"007", "i7"},
               {"2147483647", "i2147483647"},
               {"-2147483648", "- i-2147483648"},
               {"5.", "i5 ."},
               {"5.x", "i5 . x"},
               {"1.5", "d1.5"},
               {".5", "d0.5"},
               {"b.5", "b d0.5"},
               {"1e5", "d100000"},
               {"1.0e-5", "d1e-05"},
               {"1E+2", "d100"},
               {"1.5e3.", "d1500 ."},
               {"1e", "i1 e"},
               {"1e-x", "i1 e-x"},
               {"1..5", "i1 . d0.5"},
               {"1e-999", "d0"},
               {"(n)-1", "( n ) - i1"},
               {"k{0}-1", "k { i0 } - i1"},
               {"5-3", "i5 - i3"},
               {"x-.5", "x - d0.5"},
               {"n*-1", "n * - i1"}});
  expect_errors({{"2147483648", "1:1 integer-too-large"},
                 {"a 99999999999999999999999", "1:3 integer-too-large"},
                 {"1e999", "1:1 number-too-large"}});
}

TEST(Lexer, CharactersAreTheCodeOfTheirByte) {
  expect_rows({{"'a'", "i97"},
               {"' '", "i32"},
               {"'''", "i39"},
               {"'\\'", "i92"},
               {"'\"'", "i34"},
               {"'\\n'", "i10"},
               {"'\\t'", "i9"},
               {"'\\''", "i39"},
               {"'\\\\'", "i92"},
               {"'\\\"'", "i34"},
               {"'\xE9'", "i233"}});
  expect_errors({{"'ab'", "1:1 bad-character"},
                 {"'", "1:1 bad-character"},
                 {"'\\q'", "1:1 bad-character"},
                 {"x '\n'", "1:3 bad-character, 2:1 bad-character"}});
}

TEST(Lexer, StringsAreReadLeftToRight) {
  expect_rows({{R"("")", "s<>"},
               {R"("a\"b" c)", R"(s<a\"b> c)"},
               {R"("c:\\" "d")", R"(s<c:\\> s<d>)"},
               {"\"two\nlines\"", "s<two\nlines>"},
               {R"("\q$x")", R"(s<\q$x>)"}});
  const Scan scan("\"two\nlines\" a\nb");
  EXPECT_EQ(scan.tokens.at(1).span.line, 2U);
  EXPECT_EQ(scan.tokens.at(1).span.column, 8U);
  EXPECT_EQ(scan.tokens.at(2).span.line, 3U);
}

TEST(Lexer, AnUnclosedStringIsReportedWhereItOpens) {
  const Scan scan("a\nprint \"open.\nb c");
  EXPECT_EQ(scan.errors(), "2:7 unterminated-string");
  EXPECT_EQ(scan.text(), "a print s<open.> b c");
  EXPECT_EQ(Scan("\"a\\\"").errors(), "1:1 unterminated-string");
  EXPECT_EQ(Scan("\"").errors(), "1:1 unterminated-string");
  EXPECT_EQ(Scan("\"\\").errors(), "1:1 unterminated-string");
}

TEST(Lexer, PunctuationTakesTheLongestMatch) {
  expect_rows({{"+ ++ += - -- -= * *= / /= % %= ^ ^=", "+ ++ += - -- -= * *= / /= % %= ^ ^="},
               {"= == ! != < <= > >= && || |", "= == ! != < <= > >= && || |"},
               {"( ) [ ] { } , . : :: @ ?", "( ) [ ] { } , . : :: @ ?"},
               {"|||", "|| |"},
               {"===", "== ="},
               {"a::b", "a :: b"},
               {"{}", "{ }"},
               {"@@DEBUG@@(e)", "@@DEBUG@@ ( e )"}});
}

TEST(Lexer, OtherBytesAreErrorsAndScanningGoesOn) {
  const Scan scan("a $ b\n\xC3\xA9 c ~");
  EXPECT_EQ(scan.text(), "a b c");
  EXPECT_EQ(scan.errors(), "1:3 unexpected-byte, 2:1 unexpected-byte, 2:6 unexpected-byte");
  EXPECT_EQ(scan.diagnostics.all().at(0).message, "unexpected character '$'");
  EXPECT_EQ(scan.diagnostics.all().at(0).help, "variables are written without '$'; '$' belongs inside strings");
  EXPECT_NE(scan.diagnostics.all().at(1).message.find("0xC3"), std::string::npos);
  expect_errors({{std::string_view("a\x01").data(), "1:2 unexpected-byte"}, {"a & b", "1:3 unexpected-byte"}});
  expect_rows({{"# caf\xC3\xA9\na", "a"},
               {"\"caf\xC3\xA9\"", "s<caf\xC3\xA9>"},
               {"\xEF\xBB\xBF"
                "a",
                "a"}});
}

TEST(Lexer, LinesEndWithLfCrOrBoth) {
  const Scan scan("a\nb\rc\r\nd\n\re");
  std::string lines;
  for (const Token& token : scan.tokens) lines += fmt::format("{}:{} ", token.span.line, token.span.column);
  EXPECT_EQ(lines, "1:1 2:1 3:1 4:1 6:1 6:2 ");
}

TEST(Lexer, TokensKnowTheirSpacing) {
  const Scan scan("a -1 # x\n b");
  EXPECT_FALSE(scan.tokens.at(0).space_before);
  EXPECT_TRUE(scan.tokens.at(0).starts_line);
  EXPECT_TRUE(scan.tokens.at(1).space_before);
  EXPECT_FALSE(scan.tokens.at(1).space_after);
  EXPECT_FALSE(scan.tokens.at(1).starts_line);
  EXPECT_TRUE(scan.tokens.at(2).space_after);
  EXPECT_TRUE(scan.tokens.at(3).starts_line);
  EXPECT_EQ(scan.tokens.back().kind, TokenKind::End);
}

TEST(Lexer, EmptyTextsGiveTheEndAlone) {
  for (const char* text : {"", " ", "\n", "# only a comment", "\xEF\xBB\xBF"}) {
    EXPECT_EQ(Scan(text).tokens.size(), 1U) << text;
    EXPECT_EQ(Scan(text).errors(), "") << text;
  }
}

TEST(Lexer, ExpressionsInStringsHaveQuotedStrings) {
  Sources sources;
  Diagnostics diagnostics;
  const std::uint32_t file = sources.add("test.tz", R"(x "${h{\"key\"}} ")");
  const std::vector<Token> tokens = lex_inside_string(sources, file, 5, 15, diagnostics);
  ASSERT_EQ(tokens.size(), 5U);
  EXPECT_EQ(tokens[2].kind, TokenKind::String);
  EXPECT_EQ(tokens[2].text, "key");
  EXPECT_EQ(tokens[2].span.column, 8U);
  EXPECT_EQ(diagnostics.error_count(), 0U);
}

}  // namespace
}  // namespace breve::steve
