// How diagnostics look, and places in sources.
#include <gtest/gtest.h>

#include "steve/syntax/diagnostic.hpp"

namespace breve::steve {
namespace {

std::string shown(const std::string& text, std::uint32_t offset, std::uint32_t length, std::string help = {}) {
  Sources sources;
  const std::uint32_t file = sources.add("a.tz", text);
  return format({Severity::Error, "code", "bad thing", std::move(help), sources.span_at(file, offset, length)},
                sources);
}

TEST(Diagnostic, ShowsPlaceLineCaretAndHelp) {
  EXPECT_EQ(shown("one\ntwo three\n", 8, 5, "do this"),
            "a.tz:2:5: error: bad thing\n    2 | two three\n      |     ^^^^^\nhelp: do this\n");
  EXPECT_EQ(shown("ab", 2, 0), "a.tz:1:3: error: bad thing\n    1 | ab\n      |   ^\n");
  EXPECT_EQ(shown("ab\ncd", 0, 5), "a.tz:1:1: error: bad thing\n    1 | ab\n      | ^^\n");
  EXPECT_EQ(shown("", 0, 0), "a.tz:1:1: error: bad thing\n    1 | \n      | ^\n");
}

TEST(Diagnostic, KeepsTabsSoThatTheCaretLinesUp) {
  EXPECT_EQ(shown("\ta\tb", 3, 1), "a.tz:1:4: error: bad thing\n    1 | \ta\tb\n      | \t \t^\n");
}

TEST(Diagnostic, ShowsUnprintableBytesAsEscapes) {
  EXPECT_EQ(shown("a\x01\xE9z", 3, 1), "a.tz:1:4: error: bad thing\n    1 | a\\x01\\xE9z\n      |          ^\n");
  EXPECT_EQ(shown("a\x01z", 1, 1), "a.tz:1:2: error: bad thing\n    1 | a\\x01z\n      |  ^^^^\n");
  EXPECT_EQ(shown("\xC3\xA9 z", 3, 1), "a.tz:1:4: error: bad thing\n    1 | \xC3\xA9 z\n      |   ^\n");
  EXPECT_EQ(shown(std::string("a\0z", 3), 2, 1), "a.tz:1:3: error: bad thing\n    1 | a\\x00z\n      |      ^\n");
}

TEST(Diagnostic, CutsLongLinesAroundTheCaret) {
  std::string line(10000, 'x');
  line[5000] = 'Y';
  const std::string text = shown(line, 5000, 1);
  const std::size_t source = text.find('\n') + 1;
  const std::string shown_line = text.substr(source, text.find('\n', source) - source);
  const std::string caret_line = text.substr(source + shown_line.size() + 1);
  EXPECT_LE(shown_line.size(), 134U);
  // The sign of the cut takes three bytes and one column.
  EXPECT_EQ(shown_line.find('Y') - 2, caret_line.find('^'));
  EXPECT_TRUE(shown_line.starts_with("    1 | …") && shown_line.ends_with("…"));
  EXPECT_EQ(shown(line, 9999, 1).substr(0, 30), "a.tz:1:10000: error: bad thing");
  EXPECT_NE(shown(line, 10000, 0).find("^\n"), std::string::npos);
}

TEST(Diagnostic, WithoutAPlaceIsOneLine) {
  EXPECT_EQ(format({Severity::Warning, "code", "odd", "", {}}, Sources{}), "warning: odd\n");
  EXPECT_EQ(format({Severity::Note, "code", "so", "", Span{7, 0, 0, 1, 1}}, Sources{}), "note: so\n");
}

TEST(Diagnostics, CountErrorsOnly) {
  Diagnostics diagnostics;
  diagnostics.error({}, "a", "b");
  diagnostics.warning({}, "c", "d", "e");
  EXPECT_EQ(diagnostics.error_count(), 1U);
  EXPECT_EQ(diagnostics.all().size(), 2U);
  EXPECT_EQ(diagnostics.all().at(1).help, "e");
}

TEST(Sources, LinesEndWithLfCrOrBoth) {
  Sources sources;
  const std::uint32_t file = sources.add("a", "one\ntwo\rthree\r\nfour");
  EXPECT_EQ(sources.line_text(sources.span_at(file, 5, 1)), "two");
  EXPECT_EQ(sources.line_text(sources.span_at(file, 10, 1)), "three");
  EXPECT_EQ(sources.span_at(file, 17, 1).line, 4U);
  EXPECT_EQ(sources.span_at(file, 17, 1).column, 3U);
  EXPECT_EQ(sources.line_text(Span{9, 0, 0, 1, 1}), "");
  EXPECT_EQ(sources.line_text(Span{file, 0, 0, 99, 1}), "");
}

TEST(Sources, TextsStayWhereTheyAre) {
  Sources sources;
  const std::string_view text = sources.file(sources.add("a", "abc")).text;
  for (int i = 0; i < 1000; ++i) sources.add("b", "d");
  EXPECT_EQ(text, "abc");
  EXPECT_EQ(text.data(), sources.file(0).text.data());
}

TEST(Nearest, TakesTheFewestEditsUpToAThird) {
  EXPECT_EQ(nearest("velocty", {"location", "velocity", "volume"}), "velocity");
  EXPECT_EQ(nearest("get-lcoation", {"set-location", "get-location"}), "get-location");
  EXPECT_EQ(nearest("flaot", {"int", "float"}), "float");
  EXPECT_EQ(nearest("abc", {"xyz"}), "");
  EXPECT_EQ(nearest("ab", {"ac"}), "");
  EXPECT_EQ(nearest("abc", {"abd", "abe"}), "abd");
  EXPECT_EQ(nearest("", {"a"}), "");
  EXPECT_EQ(nearest("abc", {}), "");
  EXPECT_EQ(nearest(std::string(100000, 'a'), {std::string_view("a")}), "");
}

}  // namespace
}  // namespace breve::steve
