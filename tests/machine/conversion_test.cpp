// The table of conversions, cell by cell, and truth.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "steve/machine/operators.hpp"
#include "tests/machine/fakes.hpp"

namespace breve::steve::testing {
namespace {

struct Samples {
  World w;
  ClassInfo cls = reference_class(1);
  std::array<Value, 11> values;
  Samples() {
    ListCell* list = w.heap.list();
    w.heap.push(*list, number(1));
    w.heap.push(*list, w.string("ab"));
    values = {Value(),
              number(7),
              number(2.5),
              Value::of(Vector3(1, 2, 3)),
              Value::of(Tag::Matrix, w.heap.matrix(Matrix3::Identity())),
              w.string("3.75x"),
              Value::of(Tag::Object, w.object(cls)),
              Value::of(Tag::List, list),
              Value::of(Tag::Hash, w.heap.hash()),
              Value::of(Tag::Pointer, w.heap.pointer(nullptr)),
              Value::of(Tag::Data, w.heap.data("\x01\xab"))};
  }
  const Value& operator[](Tag tag) const { return values[static_cast<std::size_t>(tag)]; }
};

template <class F>
std::string error_of(F f) {
  try {
    f();
  } catch (const RunError& error) {
    return error.kind() == RunErrorKind::Conversion ? error.what() : "another kind of error";
  }
  return "";
}

TEST(Conversion, IntTakesNumbersStringsAndLists) {
  const Samples s;
  EXPECT_EQ(to_int(s[Tag::Int]), 7);
  EXPECT_EQ(to_int(s[Tag::Double]), 2);
  EXPECT_EQ(to_int(number(-2.9)), -2);
  EXPECT_EQ(to_int(s[Tag::String]), 3);
  EXPECT_EQ(to_int(s[Tag::List]), 2);
  EXPECT_EQ(to_int(Value::of(Tag::List, nullptr)), 0);
  for (const Tag tag : {Tag::Null, Tag::Vector, Tag::Matrix, Tag::Object, Tag::Hash, Tag::Pointer, Tag::Data})
    EXPECT_THROW(to_int(s[tag]), RunError) << type_name(tag);
}

TEST(Conversion, DoubleTakesNumbersStringsAndLists) {
  const Samples s;
  EXPECT_EQ(to_double(s[Tag::Int]), 7.0);
  EXPECT_EQ(to_double(s[Tag::Double]), 2.5);
  EXPECT_EQ(to_double(s[Tag::String]), 3.75);
  EXPECT_EQ(to_double(s[Tag::List]), 2.0);
  for (const Tag tag : {Tag::Null, Tag::Vector, Tag::Matrix, Tag::Object, Tag::Hash, Tag::Pointer, Tag::Data})
    EXPECT_THROW(to_double(s[tag]), RunError) << type_name(tag);
}

TEST(Conversion, StringTakesEverything) {
  Samples s;
  const auto as_text = [&s](Tag tag) { return std::string(view(to_string(s.w.heap, s[tag]))); };
  EXPECT_EQ(as_text(Tag::Null), "(NULL expression)");
  EXPECT_EQ(as_text(Tag::Int), "7");
  EXPECT_EQ(as_text(Tag::Double), "2.500000");
  EXPECT_EQ(as_text(Tag::Vector), "(1.00000, 2.00000, 3.00000)");
  EXPECT_EQ(as_text(Tag::String), "3.75x");
  EXPECT_EQ(as_text(Tag::List), "{ 1, ab }");
  EXPECT_EQ(as_text(Tag::Hash), "{ }");
  EXPECT_EQ(as_text(Tag::Data), "01ab");
  EXPECT_EQ(as_text(Tag::Object).substr(0, 8), "Node (0x");
}

TEST(Conversion, ObjectTakesObjectsAndZero) {
  const Samples s;
  EXPECT_EQ(to_object(s[Tag::Object]), s[Tag::Object].object());
  EXPECT_EQ(to_object(number(0)), nullptr);
  EXPECT_EQ(to_object(number(0.0)), nullptr);
  for (const Tag tag : {Tag::Null, Tag::Int, Tag::Double, Tag::Vector, Tag::Matrix, Tag::String, Tag::List, Tag::Hash,
                        Tag::Pointer, Tag::Data})
    EXPECT_THROW(to_object(s[tag]), RunError) << type_name(tag);
}

TEST(Conversion, PointerTakesPointersAndIntZero) {
  const Samples s;
  EXPECT_EQ(to_pointer(s[Tag::Pointer]), s[Tag::Pointer].pointer());
  EXPECT_EQ(to_pointer(number(0)), nullptr);
  EXPECT_THROW(to_pointer(number(0.0)), RunError);
  for (const Tag tag : {Tag::Null, Tag::Int, Tag::Double, Tag::Vector, Tag::Matrix, Tag::String, Tag::Object, Tag::List,
                        Tag::Hash, Tag::Data})
    EXPECT_THROW(to_pointer(s[tag]), RunError) << type_name(tag);
}

TEST(Conversion, VectorMatrixListHashDataTakeTheirOwnTypeOnly) {
  const Samples s;
  EXPECT_EQ(to_vector(s[Tag::Vector]), Vector3(1, 2, 3));
  EXPECT_EQ(to_matrix(s[Tag::Matrix]), Matrix3::Identity());
  EXPECT_EQ(to_list(s[Tag::List]), s[Tag::List].list());
  EXPECT_EQ(to_hash(s[Tag::Hash]), s[Tag::Hash].hash());
  EXPECT_EQ(to_data(s[Tag::Data]), s[Tag::Data].data());
  for (const Value& v : s.values) {
    if (v.tag != Tag::Vector) {
      EXPECT_THROW(to_vector(v), RunError) << type_name(v.tag);
    }
    if (v.tag != Tag::Matrix) {
      EXPECT_THROW(to_matrix(v), RunError) << type_name(v.tag);
    }
    if (v.tag != Tag::List) {
      EXPECT_THROW(to_list(v), RunError) << type_name(v.tag);
    }
    if (v.tag != Tag::Hash) {
      EXPECT_THROW(to_hash(v), RunError) << type_name(v.tag);
    }
    if (v.tag != Tag::Data) {
      EXPECT_THROW(to_data(v), RunError) << type_name(v.tag);
    }
  }
}

TEST(Conversion, ErrorNamesTypesAndPlace) {
  EXPECT_EQ(error_of([] { to_int(Value::of(Vector3(0, 0, 0)), "variable 'n'"); }),
            "variable 'n' must be an int, not the vector (0, 0, 0)");
  EXPECT_EQ(error_of([] { to_list(number(3), "keyword 'to'"); }), "keyword 'to' must be a list, not the int 3");
  EXPECT_EQ(error_of([] { to_double(Value()); }), "a double is needed here, not no value (NULL)");
}

TEST(Conversion, StringsGiveTheirLeadingInteger) {
  EXPECT_EQ(leading_int("42"), 42);
  EXPECT_EQ(leading_int("  -17 km"), -17);
  EXPECT_EQ(leading_int("+5"), 5);
  EXPECT_EQ(leading_int("3.9"), 3);
  EXPECT_EQ(leading_int("abc"), 0);
  EXPECT_EQ(leading_int(""), 0);
  EXPECT_EQ(leading_int("+-5"), 0);
  EXPECT_EQ(leading_int("99999999999"), 2147483647);
  EXPECT_EQ(leading_int("-99999999999"), std::numeric_limits<std::int32_t>::min());
}

TEST(Conversion, StringsGiveTheirLeadingFloatAsTheCLibraryReadsIt) {
  for (const char* text :
       {"42",     "  -1.5e3x", "+.5",      "5.",  "1e",    "1e+",   "abc", "",          "-",     "+-5",
        "--5",    "0x10",      "0x1.8p3",  "0x",  "0xg",   "-0x.8", "inf", "-infinity", "nan",   "1e999",
        "-1e999", "1e-999",    "0x1p5000", ".e5", "1_000", "12,5",  "-0",  "-abc",      "\t\n 7"}) {
    const double expected = std::strtod(text, nullptr), found = leading_double(text);
    if (std::isnan(expected)) {
      EXPECT_TRUE(std::isnan(found)) << text;
    } else {
      EXPECT_EQ(found, expected) << text;
    }
    EXPECT_EQ(std::signbit(found), std::signbit(expected)) << text;
  }
}

TEST(Conversion, DoublesBeyondTheRangeOfIntGiveTheNearestInt) {
  EXPECT_EQ(truncate_to_int(1e10), 2147483647);
  EXPECT_EQ(truncate_to_int(-1e10), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(truncate_to_int(2147483647.9), 2147483647);
  EXPECT_EQ(truncate_to_int(-2147483648.9), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(truncate_to_int(std::numeric_limits<double>::infinity()), 2147483647);
  EXPECT_EQ(truncate_to_int(std::numeric_limits<double>::quiet_NaN()), 0);
}

TEST(Truth, FollowsTheTable) {
  Samples s;
  for (const Value& v : s.values) EXPECT_EQ(truth(v), v.tag != Tag::Null) << type_name(v.tag);
  EXPECT_FALSE(truth(number(0)));
  EXPECT_FALSE(truth(number(0.0)));
  EXPECT_TRUE(truth(number(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(truth(Value::of(Tag::String, nullptr)));
  EXPECT_TRUE(truth(s.w.string("0")));
  EXPECT_FALSE(truth(s.w.list()));
  EXPECT_FALSE(truth(Value::of(Tag::List, nullptr)));
  EXPECT_TRUE(truth(Value::of(Tag::Hash, s.w.heap.hash())));
  EXPECT_FALSE(truth(Value::of(Vector3(0, 0, 0))));
  EXPECT_TRUE(truth(Value::of(Vector3(0, 0, 1))));
  EXPECT_FALSE(truth(Value::of(Tag::Matrix, s.w.heap.matrix(Matrix3::Zero()))));
  EXPECT_FALSE(truth(Value::of(Tag::Object, nullptr)));
  s[Tag::Object].object()->state = Instance::State::Freed;
  EXPECT_FALSE(truth(s[Tag::Object]));
  EXPECT_FALSE(truth(Value::of(Tag::Pointer, nullptr)));
  EXPECT_FALSE(truth(Value::of(Tag::Data, nullptr)));
}

}  // namespace
}  // namespace breve::steve::testing
