// Elements: reading, replacing, members, inserting and removing.
#include <gtest/gtest.h>

#include "steve/machine/operators.hpp"
#include "tests/machine/fakes.hpp"

namespace breve::steve::testing {
namespace {

class Indexing : public ::testing::Test {
 protected:
  World w;
  Value list = w.list();
  Value hash = Value::of(Tag::Hash, w.heap.hash());
  Value vector = Value::of(Vector3(1, 2, 3));

  Indexing() {
    for (int i = 0; i < 3; ++i) w.heap.push(*list.list(), number(10 * i));
  }
  StringCell* name(std::string_view text) { return w.heap.string(text); }
  template <class F>
  RunErrorKind kind_of(F f) {
    try {
      f();
    } catch (const RunError& error) {
      message = error.what();
      return error.kind();
    }
    return RunErrorKind::Internal;
  }
  std::string message;
};

TEST_F(Indexing, ListIndexIsConvertedLikeAnInt) {
  EXPECT_EQ(index(w.heap, list, number(1)).i, 10);
  EXPECT_EQ(index(w.heap, list, number(1.9)).i, 10);
  EXPECT_EQ(index(w.heap, list, w.string("2")).i, 20);
}

TEST_F(Indexing, ListIndexOutsideIsABoundsErrorThatSaysWhatThereIs) {
  EXPECT_EQ(kind_of([&] { index(w.heap, list, number(3)); }), RunErrorKind::Bounds);
  EXPECT_EQ(message, "index 3 is outside a list of 3");
  EXPECT_EQ(kind_of([&] { index(w.heap, list, number(-1)); }), RunErrorKind::Bounds);
  EXPECT_EQ(kind_of([&] { index(w.heap, w.list(), number(0)); }), RunErrorKind::Bounds);
  EXPECT_EQ(message, "index 0 is outside an empty list");
  EXPECT_EQ(kind_of([&] { index(w.heap, Value::of(Tag::List, nullptr), number(0)); }), RunErrorKind::Bounds);
  EXPECT_EQ(kind_of([&] { index(w.heap, list, vector); }), RunErrorKind::Conversion);
}

TEST_F(Indexing, MissingHashKeyIsNull) {
  EXPECT_EQ(index(w.heap, hash, w.string("k")).tag, Tag::Null);
  set_index(w.heap, hash, w.string("k"), number(4));
  EXPECT_EQ(index(w.heap, hash, w.string("k")).i, 4);
  EXPECT_EQ(index(w.heap, Value::of(Tag::Hash, nullptr), number(1)).tag, Tag::Null);
}

TEST_F(Indexing, VectorsMatricesAndStringsGiveComponentsRowsAndBytes) {
  Matrix3 m;
  m << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  const Value matrix = Value::of(Tag::Matrix, w.heap.matrix(m));
  EXPECT_EQ(index(w.heap, vector, number(2)).d, 3.0);
  EXPECT_EQ(index(w.heap, matrix, number(1)).vector(), Vector3(4, 5, 6));
  EXPECT_EQ(text(index(w.heap, w.string("abc"), number(1))), "b");
  EXPECT_EQ(kind_of([&] { index(w.heap, vector, number(3)); }), RunErrorKind::Bounds);
  EXPECT_EQ(kind_of([&] { index(w.heap, matrix, number(-1)); }), RunErrorKind::Bounds);
  EXPECT_EQ(kind_of([&] { index(w.heap, w.string("abc"), number(3)); }), RunErrorKind::Bounds);
  EXPECT_EQ(kind_of([&] { index(w.heap, w.string("abc"), number(-1)); }), RunErrorKind::Bounds);
}

TEST_F(Indexing, OtherBasesAreTypeErrors) {
  EXPECT_EQ(kind_of([&] { index(w.heap, number(1), number(0)); }), RunErrorKind::Type);
  EXPECT_EQ(kind_of([&] { index(w.heap, Value(), number(0)); }), RunErrorKind::Type);
  EXPECT_EQ(kind_of([&] { set_index(w.heap, vector, number(0), number(0)); }), RunErrorKind::Type);
  EXPECT_EQ(kind_of([&] { with_index(w.heap, list, number(0), number(0)); }), RunErrorKind::Type);
}

TEST_F(Indexing, StoringAtTheLengthAppendsAndBeyondIsAnError) {
  set_index(w.heap, list, number(0), number(5));
  set_index(w.heap, list, number(3), number(30));
  EXPECT_EQ(text(list), "{ 5, 10, 20, 30 }");
  EXPECT_EQ(kind_of([&] { set_index(w.heap, list, number(5), number(0)); }), RunErrorKind::Bounds);
  EXPECT_EQ(kind_of([&] { set_index(w.heap, list, number(-1), number(0)); }), RunErrorKind::Bounds);
  set_index(w.heap, list, number(1), Value());
  EXPECT_EQ(text(list), "{ 5, (NULL expression), 20, 30 }") << "NULL is a legal element";
}

TEST_F(Indexing, VectorWithOneComponentReplaced) {
  EXPECT_EQ(with_index(w.heap, vector, number(1), number(9)).vector(), Vector3(1, 9, 3));
  EXPECT_EQ(with_index(w.heap, vector, number(1), w.string("4.5")).vector(), Vector3(1, 4.5, 3));
  EXPECT_EQ(kind_of([&] { with_index(w.heap, vector, number(1), vector); }), RunErrorKind::Conversion);
}

TEST_F(Indexing, MatrixWithOneRowReplaced) {
  const Value m = Value::of(Tag::Matrix, w.heap.matrix(Matrix3::Identity()));
  const Value n = with_index(w.heap, m, number(1), vector);
  EXPECT_EQ(to_matrix(n).row(1).transpose(), Vector3(1, 2, 3));
  EXPECT_EQ(to_matrix(m), Matrix3::Identity()) << "matrices in values do not change";
  EXPECT_EQ(kind_of([&] { with_index(w.heap, m, number(1), number(2)); }), RunErrorKind::Conversion);
}

TEST_F(Indexing, StringWithOneByteReplacedByText) {
  const Value s = w.string("abc");
  EXPECT_EQ(text(with_index(w.heap, s, number(1), w.string("XYZ"))), "aXYZc");
  EXPECT_EQ(text(with_index(w.heap, s, number(1), w.string(""))), "ac");
  EXPECT_EQ(text(with_index(w.heap, s, number(3), w.string("!"))), "abc!");
  EXPECT_EQ(kind_of([&] { with_index(w.heap, s, number(4), w.string("!")); }), RunErrorKind::Bounds);
  EXPECT_EQ(kind_of([&] { with_index(w.heap, s, number(-1), w.string("!")); }), RunErrorKind::Bounds);
  EXPECT_EQ(kind_of([&] { with_index(w.heap, s, number(0), number(1)); }), RunErrorKind::Type);
}

TEST_F(Indexing, MembersOfHashesAndVectors) {
  set_member(w.heap, hash, name("x"), number(8));
  EXPECT_EQ(member(w.heap, hash, name("x")).i, 8);
  EXPECT_EQ(index(w.heap, hash, w.string("x")).i, 8);
  EXPECT_EQ(member(w.heap, vector, name("y")).d, 2.0);
  EXPECT_EQ(member(w.heap, vector, name("Z")).d, 3.0);
  EXPECT_EQ(with_member(vector, name("x"), number(7)).vector(), Vector3(7, 2, 3));
}

TEST_F(Indexing, WrongMembersAreTypeErrorsAndSuggestSpaces) {
  EXPECT_EQ(kind_of([&] { member(w.heap, list, name("x")); }), RunErrorKind::Type);
  EXPECT_EQ(kind_of([&] { member(w.heap, vector, name("x-1")); }), RunErrorKind::Type);
  EXPECT_EQ(message, "a vector has no member 'x-1'; for a subtraction write spaces around the minus: x - 1");
  EXPECT_EQ(kind_of([&] { member(w.heap, Value(), name("x")); }), RunErrorKind::Type);
  EXPECT_EQ(kind_of([&] { set_member(w.heap, list, name("x"), number(1)); }), RunErrorKind::Type);
}

TEST_F(Indexing, InsertBeyondTheEndIsRefusedAndNegativeIsAnError) {
  EXPECT_TRUE(insert_at(w.heap, *list.list(), w.string("1"), number(5)));
  EXPECT_TRUE(insert_at(w.heap, *list.list(), number(4), number(6)));
  EXPECT_EQ(text(list), "{ 0, 5, 10, 20, 6 }");
  EXPECT_FALSE(insert_at(w.heap, *list.list(), number(9), number(7)));
  EXPECT_EQ(kind_of([&] { insert_at(w.heap, *list.list(), number(-1), number(7)); }), RunErrorKind::Bounds);
  EXPECT_EQ(list.list()->size, 5u);
}

TEST_F(Indexing, RemoveYieldsTheElementOrNull) {
  bool found = false;
  EXPECT_EQ(remove_at(w.heap, list, number(1.5), found).i, 10);
  EXPECT_TRUE(found);
  EXPECT_EQ(remove_at(w.heap, list, number(2), found).tag, Tag::Null);
  EXPECT_FALSE(found);
  EXPECT_EQ(kind_of([&] { remove_at(w.heap, list, number(-1), found); }), RunErrorKind::Bounds);
  set_index(w.heap, hash, number(1), number(2));
  EXPECT_EQ(remove_at(w.heap, hash, number(1), found).i, 2);
  EXPECT_TRUE(found);
  EXPECT_EQ(remove_at(w.heap, hash, number(1), found).tag, Tag::Null);
  EXPECT_EQ(kind_of([&] { remove_at(w.heap, number(1), number(1), found); }), RunErrorKind::Type);
}

}  // namespace
}  // namespace breve::steve::testing
