// Operators, row by row of the tables 5.4 to 5.7, and |e|.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "steve/machine/operators.hpp"
#include "tests/machine/fakes.hpp"

namespace breve::steve::testing {
namespace {

using ast::BinaryOp;
constexpr BinaryOp kAll[] = {BinaryOp::Add, BinaryOp::Sub, BinaryOp::Mul, BinaryOp::Div, BinaryOp::Mod, BinaryOp::Pow,
                             BinaryOp::Lt,  BinaryOp::Le,  BinaryOp::Gt,  BinaryOp::Ge,  BinaryOp::Eq,  BinaryOp::Ne};
constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();

class Operators : public ::testing::Test {
 protected:
  World w;
  ClassInfo cls = reference_class(1);

  Value of(BinaryOp op, const Value& a, const Value& b) { return binary(w.heap, op, a, b); }
  Value list(std::initializer_list<Value> values) {
    Value v = w.list();
    for (const Value& element : values) w.heap.push(*v.list(), element);
    return v;
  }
  Value vector(double x, double y, double z) { return Value::of(Vector3(x, y, z)); }
  Value matrix(const Matrix3& m) { return Value::of(Tag::Matrix, w.heap.matrix(m)); }
  std::string shown(BinaryOp op, const Value& a, const Value& b) { return text(of(op, a, b)); }
  std::string error(BinaryOp op, const Value& a, const Value& b) {
    try {
      of(op, a, b);
    } catch (const RunError& e) {
      kind = e.kind();
      return e.what();
    }
    return "";
  }
  RunErrorKind kind = RunErrorKind::Internal;
};

TEST_F(Operators, IntegersWrapAndTruncate) {
  EXPECT_EQ(shown(BinaryOp::Div, number(7), number(2)), "3");
  EXPECT_EQ(shown(BinaryOp::Div, number(-7), number(2)), "-3");
  EXPECT_EQ(shown(BinaryOp::Mod, number(-7), number(3)), "-1");
  EXPECT_EQ(shown(BinaryOp::Pow, number(2), number(-1)), "0");
  EXPECT_EQ(shown(BinaryOp::Pow, number(2), number(10)), "1024");
  EXPECT_EQ(shown(BinaryOp::Add, number(kMost), number(1)), "-2147483648");
  EXPECT_EQ(shown(BinaryOp::Sub, number(kLeast), number(1)), "2147483647");
  EXPECT_EQ(shown(BinaryOp::Mul, number(65536), number(65536)), "0");
  EXPECT_EQ(shown(BinaryOp::Le, number(2), number(2)), "1");
  EXPECT_EQ(shown(BinaryOp::Ne, number(2), number(2)), "0");
  EXPECT_EQ(of(BinaryOp::Gt, number(2), number(1)).tag, Tag::Int);
}

TEST_F(Operators, DivisionByZeroIsAMathErrorForEveryType) {
  const Value zero = number(0), zero_double = number(0.0), v = vector(1, 2, 3), m = matrix(Matrix3::Identity());
  for (const Value& z : {zero, zero_double})
    for (const Value& x : {number(1), number(1.0), w.string("1")})
      for (const BinaryOp op : {BinaryOp::Div, BinaryOp::Mod}) {
        EXPECT_EQ(error(op, x, z), "division by zero");
        EXPECT_EQ(kind, RunErrorKind::Math);
      }
  EXPECT_EQ(error(BinaryOp::Div, v, zero), "division by zero");
  EXPECT_EQ(error(BinaryOp::Div, zero_double, v), "division by zero");
  EXPECT_EQ(error(BinaryOp::Div, m, zero), "division by zero");
}

TEST_F(Operators, SmallestIntegerDividedByMinusOneIsAMathError) {
  EXPECT_NE(error(BinaryOp::Div, number(kLeast), number(-1)), "");
  EXPECT_EQ(kind, RunErrorKind::Math);
  EXPECT_EQ(shown(BinaryOp::Mod, number(kLeast), number(-1)), "0");
}

TEST_F(Operators, OneDoubleMakesItDoubleArithmetic) {
  EXPECT_EQ(shown(BinaryOp::Div, number(7), number(2.0)), "3.500000");
  EXPECT_EQ(shown(BinaryOp::Mod, number(5.5), number(2)), "1.500000");
  EXPECT_EQ(shown(BinaryOp::Mod, number(-5.5), number(2)), "-1.500000");
  EXPECT_EQ(shown(BinaryOp::Pow, number(2.0), number(-1)), "0.500000");
  EXPECT_EQ(shown(BinaryOp::Eq, number(1), number(1.0)), "1");
  const Value nan = number(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(shown(BinaryOp::Eq, nan, nan), "0");
  EXPECT_EQ(shown(BinaryOp::Ne, nan, nan), "1");
  EXPECT_EQ(shown(BinaryOp::Lt, nan, number(1)), "0");
}

TEST_F(Operators, StringsConcatenateCompareByBytesAndElseCountAsDoubles) {
  const auto s = [this](std::string_view t) { return w.string(t); };
  EXPECT_EQ(shown(BinaryOp::Add, s("2"), s("3")), "23");
  EXPECT_EQ(shown(BinaryOp::Add, s("2"), number(3)), "5.000000");
  EXPECT_EQ(shown(BinaryOp::Mul, s("2"), s("3")), "6.000000");
  EXPECT_EQ(shown(BinaryOp::Lt, s("abc"), s("abd")), "0");
  EXPECT_EQ(shown(BinaryOp::Lt, s("10"), s("9")), "0");
  EXPECT_EQ(shown(BinaryOp::Eq, s("1.0"), s("1")), "0");
  EXPECT_EQ(shown(BinaryOp::Eq, s("1.0"), number(1)), "1");
  EXPECT_EQ(shown(BinaryOp::Ne, s("a"), s("b")), "1");
  EXPECT_EQ(shown(BinaryOp::Eq, s(""), s("")), "1");
  EXPECT_EQ(shown(BinaryOp::Add, s("ab"), number(5)), "5.000000");
  EXPECT_EQ(shown(BinaryOp::Add, s("2"), list({number(1)})), "3.000000");
}

TEST_F(Operators, ListsCountAsTheirLength) {
  const Value k = list({number(5), number(6), number(7)});
  EXPECT_EQ(shown(BinaryOp::Add, k, number(1)), "4");
  EXPECT_EQ(shown(BinaryOp::Gt, k, number(2)), "1");
  EXPECT_EQ(shown(BinaryOp::Eq, k, number(3)), "1");
  EXPECT_EQ(shown(BinaryOp::Mul, k, number(0.5)), "1.500000");
  EXPECT_EQ(shown(BinaryOp::Sub, k, list({number(1)})), "2");
}

TEST_F(Operators, ListsAreEqualIfTheirElementsAre) {
  const Value left = list({w.string("5"), list({number(1)})});
  EXPECT_EQ(shown(BinaryOp::Eq, left, list({number(5.0), list({number(1.0)})})), "1");
  EXPECT_EQ((*left.list())[0].tag, Tag::String) << "comparing changes nothing";
  EXPECT_EQ(shown(BinaryOp::Ne, left, list({number(5.0), list({number(2)})})), "1");
  EXPECT_EQ(shown(BinaryOp::Eq, left, list({w.string("5")})), "0");
  EXPECT_EQ(shown(BinaryOp::Eq, w.list(), w.list()), "1");
  EXPECT_EQ(shown(BinaryOp::Eq, list({vector(1, 2, 3)}), list({vector(1, 2, 3)})), "1");
  EXPECT_EQ(shown(BinaryOp::Eq, list({vector(1, 2, 3)}), list({number(1)})), "0") << "what cannot be compared differs";
  EXPECT_EQ(shown(BinaryOp::Eq, list({Value()}), list({Value()})), "1");
}

TEST_F(Operators, EqualityOfCyclicAndDeepListsEnds) {
  const Value a = list({number(1)}), b = list({number(1)});
  w.heap.push(*a.list(), a);
  w.heap.push(*b.list(), b);
  EXPECT_TRUE(equal(a, b));
  w.heap.push(*b.list(), number(2));
  EXPECT_FALSE(equal(a, b));
  Value x = w.list(), y = w.list();
  for (int i = 0; i < 100'000; ++i) x = list({x}), y = list({y});
  EXPECT_TRUE(equal(x, y));
  for (int i = 0; i < 60; ++i) x = list({x, x}), y = list({y, y});  // 2^60 paths
  EXPECT_TRUE(equal(x, y));
}

TEST_F(Operators, Vectors) {
  const Value v = vector(1, 2, 3), u = vector(4, 5, 6);
  EXPECT_EQ(shown(BinaryOp::Add, v, u), "(5.00000, 7.00000, 9.00000)");
  EXPECT_EQ(shown(BinaryOp::Sub, v, u), "(-3.00000, -3.00000, -3.00000)");
  EXPECT_EQ(shown(BinaryOp::Eq, v, v), "1");
  EXPECT_EQ(shown(BinaryOp::Ne, v, u), "1");
  EXPECT_EQ(shown(BinaryOp::Mul, v, number(2)), "(2.00000, 4.00000, 6.00000)");
  EXPECT_EQ(shown(BinaryOp::Mul, w.string("2"), v), "(2.00000, 4.00000, 6.00000)");
  EXPECT_EQ(shown(BinaryOp::Mul, v, list({number(9), number(9)})), "(2.00000, 4.00000, 6.00000)");
  EXPECT_EQ(shown(BinaryOp::Div, v, number(2)), "(0.50000, 1.00000, 1.50000)");
  EXPECT_EQ(shown(BinaryOp::Div, number(2), v), "(0.50000, 1.00000, 1.50000)") << "s / v is v / s";
}

TEST_F(Operators, WrongVectorOperandsAreTypeErrorsThatSayWhat) {
  const Value v = vector(1, 2, 3);
  EXPECT_EQ(error(BinaryOp::Mul, v, v), "cannot multiply the vector (1, 2, 3) by the vector (1, 2, 3)");
  EXPECT_EQ(kind, RunErrorKind::Type);
  EXPECT_EQ(error(BinaryOp::Add, v, number(1)), "cannot add the vector (1, 2, 3) and the int 1");
  EXPECT_EQ(error(BinaryOp::Sub, number(1), v), "cannot subtract the vector (1, 2, 3) from the int 1");
  EXPECT_EQ(error(BinaryOp::Mod, v, number(2)), "cannot take the remainder of the vector (1, 2, 3) by the int 2");
  EXPECT_EQ(error(BinaryOp::Pow, v, number(2)), "cannot raise the vector (1, 2, 3) to the power of the int 2");
  EXPECT_EQ(error(BinaryOp::Lt, v, v), "cannot compare the vector (1, 2, 3) with the vector (1, 2, 3)");
  EXPECT_EQ(error(BinaryOp::Eq, v, number(0)), "cannot compare the vector (1, 2, 3) with the int 0");
  EXPECT_NE(error(BinaryOp::Mul, v, Value::of(Tag::Object, nullptr)), "");
}

TEST_F(Operators, Matrices) {
  Matrix3 a, b;
  a << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  b << 2, 0, 1, 0, 3, 0, 1, 0, 2;
  const Value m = matrix(a), n = matrix(b), v = vector(1, -1, 2);
  const auto result = [](const Value& value) { return to_matrix(value); };
  EXPECT_EQ(result(of(BinaryOp::Add, m, n)), a + b);
  EXPECT_EQ(result(of(BinaryOp::Sub, m, n)), a - b);
  EXPECT_TRUE(result(of(BinaryOp::Mul, m, n)).isApprox(a * b, 1e-15));
  EXPECT_TRUE(result(of(BinaryOp::Div, m, n)).isApprox(a * b.inverse(), 1e-14));
  EXPECT_EQ(text(of(BinaryOp::Mul, m, v)), "(5.00000, 11.00000, 19.00000)");
  EXPECT_EQ(text(of(BinaryOp::Mul, v, m)), "(11.00000, 13.00000, 17.00000)") << "transpose(M) * v";
  EXPECT_EQ(result(of(BinaryOp::Mul, m, number(2))), a * 2);
  EXPECT_EQ(result(of(BinaryOp::Mul, w.string("2"), m)), a * 2);
  EXPECT_EQ(result(of(BinaryOp::Div, m, number(2))), a / 2);
  EXPECT_TRUE(result(of(BinaryOp::Div, number(2), n)).isApprox(2 * b.inverse(), 1e-14));
  EXPECT_EQ(shown(BinaryOp::Eq, m, matrix(a)), "1");
  EXPECT_EQ(shown(BinaryOp::Ne, m, n), "1");
}

TEST_F(Operators, WrongMatrixOperandsAreErrors) {
  const Value m = matrix(Matrix3::Identity()), singular = matrix(Matrix3::Ones()), v = vector(1, 2, 3);
  for (const BinaryOp op : kAll) {
    if (op != BinaryOp::Mul) {
      EXPECT_NE(error(op, m, v), "");
    }
    if (op != BinaryOp::Mul) {
      EXPECT_NE(error(op, v, m), "");
    }
    if (op != BinaryOp::Mul && op != BinaryOp::Div) {
      EXPECT_NE(error(op, m, number(1)), "");
    }
    EXPECT_NE(error(op, m, Value::of(Tag::Hash, nullptr)), "");
  }
  EXPECT_TRUE(error(BinaryOp::Add, m, v).starts_with("cannot add a matrix and the vector ("));
  EXPECT_NE(error(BinaryOp::Div, m, singular), "");
  EXPECT_EQ(kind, RunErrorKind::Math);
  EXPECT_NE(error(BinaryOp::Div, number(1), singular), "");
  EXPECT_EQ(kind, RunErrorKind::Math);
}

TEST_F(Operators, ObjectsCompareByIdentityAndWithZero) {
  Instance* instance = w.object(cls);
  const Value a = Value::of(Tag::Object, instance), b = Value::of(Tag::Object, w.object(cls));
  const Value none = Value::of(Tag::Object, nullptr);
  EXPECT_EQ(shown(BinaryOp::Eq, a, a), "1");
  EXPECT_EQ(shown(BinaryOp::Eq, a, b), "0");
  EXPECT_EQ(shown(BinaryOp::Ne, a, b), "1");
  EXPECT_EQ(shown(BinaryOp::Eq, a, number(0)), "0");
  EXPECT_EQ(shown(BinaryOp::Eq, none, number(0)), "1");
  EXPECT_EQ(shown(BinaryOp::Eq, number(0), none), "1");
  EXPECT_EQ(shown(BinaryOp::Eq, none, number(0.0)), "1");
  EXPECT_EQ(shown(BinaryOp::Eq, none, Value()), "1");
  EXPECT_EQ(shown(BinaryOp::Eq, a, w.string("x")), "0");
  EXPECT_EQ(shown(BinaryOp::Ne, a, w.string("x")), "1");
  instance->state = Instance::State::Freed;
  EXPECT_EQ(shown(BinaryOp::Ne, a, number(0)), "1") << "a freed object is not equal to 0";
}

TEST_F(Operators, ArithmeticOnReferencesIsATypeError) {
  const Value object = Value::of(Tag::Object, w.object(cls)), hash = Value::of(Tag::Hash, w.heap.hash());
  for (const BinaryOp op : kAll) {
    if (op == BinaryOp::Eq || op == BinaryOp::Ne) continue;
    for (const Value& reference : {object, hash, Value::of(Tag::Pointer, nullptr)}) {
      EXPECT_NE(error(op, reference, number(1)), "");
      EXPECT_EQ(kind, RunErrorKind::Type);
      EXPECT_NE(error(op, number(1.5), reference), "");
      EXPECT_NE(error(op, reference, reference), "");
      EXPECT_NE(error(op, reference, w.string("1")), "");
    }
  }
  EXPECT_TRUE(error(BinaryOp::Add, object, number(1)).starts_with("cannot add the object "));
  EXPECT_NE(error(BinaryOp::Eq, object, number(5)), "");
}

TEST_F(Operators, NullIsZeroAmongIntsAndNothingAmongDoubles) {
  EXPECT_EQ(shown(BinaryOp::Eq, Value(), number(0)), "1");
  EXPECT_EQ(shown(BinaryOp::Add, Value(), number(5)), "5");
  EXPECT_EQ(shown(BinaryOp::Add, number(5), Value()), "5");
  EXPECT_EQ(shown(BinaryOp::Eq, Value(), Value()), "1");
  EXPECT_NE(error(BinaryOp::Add, Value(), number(1.0)), "");
  EXPECT_EQ(kind, RunErrorKind::Conversion);
  EXPECT_NE(error(BinaryOp::Add, w.string("1"), Value()), "");
  EXPECT_EQ(kind, RunErrorKind::Conversion);
}

TEST_F(Operators, EveryPairOfTypesGivesAValueOrARunError) {
  ListCell* items = w.heap.list();
  for (const Value& v :
       {Value(), number(3), number(-0.5), vector(1, 2, 3), matrix(Matrix3::Identity()), w.string("4"),
        Value::of(Tag::String, nullptr), Value::of(Tag::Object, nullptr), Value::of(Tag::Object, w.object(cls)),
        list({number(1)}), Value::of(Tag::List, nullptr), Value::of(Tag::Hash, w.heap.hash()),
        Value::of(Tag::Pointer, nullptr), Value::of(Tag::Data, w.heap.data("x"))})
    w.heap.push(*items, v);
  for (const Value& a : *items)
    for (const Value& b : *items)
      for (const BinaryOp op : kAll) {
        try {
          of(op, a, b);
        } catch (const RunError& e) {
          EXPECT_GT(std::string_view(e.what()).size(), 10u);
        }
      }
}

TEST_F(Operators, Negation) {
  EXPECT_EQ(text(negate(number(5))), "-5");
  EXPECT_EQ(text(negate(number(kLeast))), "-2147483648");
  EXPECT_EQ(text(negate(number(2.5))), "-2.500000");
  EXPECT_EQ(text(negate(vector(1, 0, -1))), "(-1.00000, -0.00000, 1.00000)");
  EXPECT_EQ(text(negate(w.string("3"))), "-3.000000");
  EXPECT_THROW(negate(matrix(Matrix3::Identity())), RunError);
  EXPECT_THROW(negate(w.list()), RunError);
  EXPECT_THROW(negate(Value()), RunError);
}

TEST_F(Operators, Magnitude) {
  EXPECT_EQ(text(magnitude(number(-5))), "5");
  EXPECT_EQ(text(magnitude(number(-2.5))), "2.500000");
  EXPECT_EQ(text(magnitude(vector(3, 4, 12))), "13.000000");
  EXPECT_EQ(text(magnitude(list({number(1), number(2)}))), "2");
  EXPECT_EQ(text(magnitude(w.string("abc"))), "3");
  EXPECT_THROW(magnitude(Value::of(Tag::Hash, w.heap.hash())), RunError);
  EXPECT_THROW(magnitude(Value()), RunError);
  EXPECT_THROW(magnitude(Value::of(Tag::Object, nullptr)), RunError);
}

}  // namespace
}  // namespace breve::steve::testing
