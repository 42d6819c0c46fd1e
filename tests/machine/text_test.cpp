// The print format, against printf where the C library defines it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>

#include "steve/machine/operators.hpp"
#include "tests/machine/fakes.hpp"

namespace breve::steve::testing {
namespace {

std::string printed(const char* format, double d) {
  char buffer[400];
  return {buffer, static_cast<std::size_t>(std::snprintf(buffer, sizeof buffer, format, d))};
}

class Text : public ::testing::Test {
 protected:
  World w;
  Value list(std::initializer_list<Value> values) {
    Value v = w.list();
    for (const Value& element : values) w.heap.push(*v.list(), element);
    return v;
  }
};

TEST_F(Text, DoublesAreWrittenAsPrintfDoesUnlessThatChangesASmallOne) {
  std::mt19937_64 random(1);
  std::vector<double> samples = {0.0,
                                 -0.0,
                                 2.5,
                                 1e300,
                                 -1e300,
                                 1e-300,
                                 0.0000005,
                                 0.0000015,
                                 123456789.123456789,
                                 std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN(),
                                 -std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::max(),
                                 std::numeric_limits<double>::denorm_min()};
  for (int i = 0; i < 20'000; ++i) samples.push_back(std::bit_cast<double>(random()));
  for (int i = 0; i < 20'000; ++i) samples.push_back(static_cast<double>(random() % 1000000) / 64.0);
  for (const double d : samples) {
    const std::string shown = text(number(d));
    if (shown != printed("%f", d)) {
      ASSERT_LT(std::abs(d), 1e-3) << shown;
      ASSERT_EQ(std::strtod(shown.c_str(), nullptr), d) << "what six decimals would change reads back";
    }
  }
}

TEST_F(Text, NumberToStringIsTheSameText) {
  EXPECT_EQ(view(number_to_string(w.heap, -2.5)), "-2.500000");
  EXPECT_EQ(view(number_to_string(w.heap, std::numeric_limits<std::int32_t>::min())), "-2147483648");
}

TEST_F(Text, VectorsHaveFiveDecimalsAndExponentsWhenAnyComponentIsLarge) {
  EXPECT_EQ(text(Value::of(Vector3(1, 2, 3))), "(1.00000, 2.00000, 3.00000)");
  EXPECT_EQ(text(Value::of(Vector3(1e10, 0, 0))), "(10000000000.00000, 0.00000, 0.00000)");
  EXPECT_EQ(text(Value::of(Vector3(2e10, 1, -3))), "(2.00000e+10, 1.00000e+00, -3.00000e+00)");
  EXPECT_EQ(text(Value::of(Vector3(0, 2e10, 0))), "(0.00000e+00, 2.00000e+10, 0.00000e+00)");
  EXPECT_EQ(text(Value::of(Vector3(0, 0, -2e110))), "(0.00000e+00, 0.00000e+00, -2.00000e+110)");
}

TEST_F(Text, Matrix) {
  Matrix3 m;
  m << 1, 2, 3, 4, 5, 6, 7, 8, 9e20;
  EXPECT_EQ(
      text(Value::of(Tag::Matrix, w.heap.matrix(m))),
      "[ (1.00000, 2.00000, 3.00000), (4.00000, 5.00000, 6.00000), (7.00000, 8.00000, 900000000000000000000.00000)"
      " ]");
}

TEST_F(Text, Lists) {
  EXPECT_EQ(text(w.list()), "{ }");
  EXPECT_EQ(text(Value::of(Tag::List, nullptr)), "{ }");
  EXPECT_EQ(text(list({number(1), w.string("ab"), list({number(2)})})), "{ 1, ab, { 2 } }");
  EXPECT_EQ(text(list({w.list(), w.list()})), "{ { }, { } }");
}

TEST_F(Text, OnlyAListInsideItselfIsCircular) {
  const Value shared = list({number(1)});
  EXPECT_EQ(text(list({shared, shared})), "{ { 1 }, { 1 } }");
  const Value a = list({number(1)});
  w.heap.push(*a.list(), a);
  a.list()->serial = 0x1a2b;
  EXPECT_EQ(text(a), "{ 1, [circular list reference 0x1a2b] }");
}

TEST_F(Text, HashesShowWhatIsInThemInTheOrderOfTheKeys) {
  HashCell* hash = w.heap.hash();
  w.roots.frames.push_back(hash);
  w.heap.set(*hash, w.string("b"), number(1));
  w.heap.set(*hash, number(2), list({number(3)}));
  w.heap.set(*hash, list({number(3)}), w.string("a"));
  w.heap.set(*hash, w.string("self"), Value::of(Tag::Hash, hash));
  hash->serial = 0x1a2b;
  hash->entries[2].key.list()->serial = 0x1a2c;
  EXPECT_EQ(text(Value::of(Tag::Hash, hash)),
            "{ b: 1, 2: { 3 }, [list 0x1a2c]: a, self: [circular hash reference 0x1a2b] }");
}

TEST_F(Text, NumbersThatSixDecimalsWouldChangeReadBack) {
  const auto shown = [](double d) { return text(number(d)); };
  EXPECT_EQ(shown(1e-9), "1e-09");
  EXPECT_EQ(shown(-1.5e-6), "-1.5e-06");
  EXPECT_EQ(shown(0.00012345), "0.00012345");
  EXPECT_EQ(shown(0.0005), "0.000500");
  EXPECT_EQ(shown(0.000001), "0.000001");
  EXPECT_EQ(shown(1.0 / 3), "0.333333");
  EXPECT_EQ(shown(-0.0), "-0.000000");
  EXPECT_EQ(shown(5e-324), "5e-324");
}

TEST_F(Text, NestingBeyondAThousandIsCut) {
  Value deep = list({number(1)});
  for (int i = 1; i < 1000; ++i) deep = list({deep});
  EXPECT_NE(text(deep).find("{ 1 }"), std::string::npos);
  deep = list({deep});
  EXPECT_EQ(text(deep).find('1'), std::string::npos);
  EXPECT_NE(text(deep).find("{ { ... } }"), std::string::npos);
  for (int i = 0; i < 100'000; ++i) deep = list({deep});
  EXPECT_LT(text(deep).size(), 5000u);
}

TEST_F(Text, ObjectsShowClassAddressAndDescription) {
  const ClassInfo cls = reference_class(0);
  Instance* instance = w.object(cls);
  instance->serial = 0x1a2b;
  const Value v = Value::of(Tag::Object, instance);
  EXPECT_EQ(text(v), "Node (0x1a2b) ");
  const Describe describe = [](Instance&) { return std::string("tall"); };
  EXPECT_EQ(text(v, describe), "Node (0x1a2b) tall");
  instance->state = Instance::State::Freed;
  EXPECT_EQ(text(v, describe), "Node (0x1a2b) ");
  EXPECT_EQ(text(Value::of(Tag::Object, nullptr)), "0x0 (NULL)");
}

TEST_F(Text, DescriptionThatDropsTheListsBeingPrintedIsSafe) {
  const ClassInfo cls = reference_class(0);
  const Value inner = list({number(1), Value::of(Tag::Object, w.object(cls)), number(2)});
  const Value outer = list({inner, number(3)});
  const Describe describe = [&](Instance&) {
    w.heap.resize(*outer.list(), 0);
    w.heap.reclaim();
    return std::string("gone");
  };
  w.roots.frames.push_back(outer.ref);
  EXPECT_EQ(text(outer, describe, &w.heap).substr(0, 9), "{ { 1, No");
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 2u) << "the outer list and the object";
}

TEST_F(Text, TheRest) {
  EXPECT_EQ(text(number(-7)), "-7");
  EXPECT_EQ(text(Value()), "(NULL expression)");
  EXPECT_EQ(text(Value::of(Tag::Hash, w.heap.hash())), "{ }");
  EXPECT_EQ(text(Value::of(Tag::Hash, nullptr)), "{ }");
  EXPECT_EQ(text(Value::of(Tag::Pointer, nullptr)), "(NULL pointer)");
  PointerCell* pointer = w.heap.pointer(nullptr);
  pointer->serial = 255;
  EXPECT_EQ(text(Value::of(Tag::Pointer, pointer)), "0xff");
  EXPECT_EQ(text(Value::of(Tag::Data, w.heap.data(std::string_view("\x00\xff\x10", 3)))), "00ff10");
  EXPECT_EQ(text(Value::of(Tag::Data, nullptr)), "");
  EXPECT_EQ(text(Value::of(Tag::String, nullptr)), "");
}

}  // namespace
}  // namespace breve::steve::testing
