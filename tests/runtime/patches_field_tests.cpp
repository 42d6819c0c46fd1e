// Field against plain loops over its elements.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "runtime/base/error.hpp"
#include "runtime/patches/field.hpp"

namespace breve {
namespace {

// A handful of additions of numbers up to 10.
constexpr double kExact = 1e-13;

Field noise(Field field, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> value(-2, 2);
  for (int x = 0; x < field.nx(); ++x)
    for (int y = 0; y < field.ny(); ++y)
      for (int z = 0; z < field.nz(); ++z) field.set(x, y, z, value(engine));
  return field;
}

std::vector<Field> fields() {
  std::vector<Field> all{Field::line(1),        Field::line(2),       Field::line(7),     Field::plane(1, 1),
                         Field::plane(1, 5),    Field::plane(4, 3),   Field::plane(2, 2), Field::space(1, 1, 1),
                         Field::space(3, 4, 5), Field::space(2, 1, 6)};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = noise(all[i], i);
  return all;
}

template <class F>
void for_each(const Field& f, F act) {
  for (int x = 0; x < f.nx(); ++x)
    for (int y = 0; y < f.ny(); ++y)
      for (int z = 0; z < f.nz(); ++z) act(x, y, z);
}

/// The Laplacian element by element; `outside` gives the value at any indices.
template <class F>
double laplacian(const Field& f, int x, int y, int z, F value) {
  double sum = value(x - 1, y, z) + value(x + 1, y, z);
  if (f.dimensions() > 1) sum += value(x, y - 1, z) + value(x, y + 1, z);
  if (f.dimensions() > 2) sum += value(x, y, z - 1) + value(x, y, z + 1);
  return sum - 2 * f.dimensions() * f.get(x, y, z);
}

std::string message(auto act) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Argument);
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

TEST(Field, StartsAsZerosAndKeepsWhatIsSet) {
  Field f = Field::space(2, 3, 4);
  EXPECT_EQ(f.absolute_sum(), 0);
  EXPECT_EQ(f.size(), 24U);
  f.set(1, 2, 3, 5);
  f.set(0, 0, 1, -7);
  EXPECT_EQ(f.get(1, 2, 3), 5);
  EXPECT_EQ(f.get(0, 0, 1), -7);
  EXPECT_EQ(f.absolute_sum(), 12);
  EXPECT_EQ(f.max(), 5);
}

TEST(Field, ArithmeticMatchesLoops) {
  for (const Field& a : fields()) {
    const Field b = noise(a, 99);
    Field sum = a, difference = a, product = a, scaled = a, shifted = a, copied = a, filled = a;
    sum.add(b, 0.5);
    difference.subtract(b, 2);
    product.multiply(b);
    scaled.scale(3);
    shifted.add_scalar(-1);
    copied.copy(b);
    filled.fill(4);
    double absolute = 0, largest = a.get(0);
    for_each(a, [&](int x, int y, int z) {
      const double u = a.get(x, y, z), v = b.get(x, y, z);
      EXPECT_EQ(sum.get(x, y, z), u + 0.5 * v);
      EXPECT_EQ(difference.get(x, y, z), u - 2 * v);
      EXPECT_EQ(product.get(x, y, z), u * v);
      EXPECT_EQ(scaled.get(x, y, z), 3 * u);
      EXPECT_EQ(shifted.get(x, y, z), u - 1);
      EXPECT_EQ(copied.get(x, y, z), v);
      EXPECT_EQ(filled.get(x, y, z), 4);
      absolute += std::abs(u);
      largest = std::max(largest, u);
    });
    EXPECT_EQ(a.absolute_sum(), absolute);
    EXPECT_EQ(a.max(), largest);
  }
}

TEST(Field, DiffusionTakesTheOutsideAsZero) {
  for (const Field& a : fields()) {
    Field d = a;
    d.diffuse(a, 0.25);
    for_each(a, [&](int x, int y, int z) {
      const auto value = [&](int i, int j, int k) {
        return i < 0 || j < 0 || k < 0 || i >= a.nx() || j >= a.ny() || k >= a.nz() ? 0 : a.get(i, j, k);
      };
      EXPECT_NEAR(d.get(x, y, z), 0.25 * laplacian(a, x, y, z, value), kExact);
    });
  }
}

TEST(Field, OneLayerInSpaceSpreadsAsAPlaneAndLeaksAtItsEdgesOnly) {
  Field layer = Field::space(9, 7, 1), plane = Field::plane(9, 7);
  layer.set(4, 3, 0, 100);
  plane.set(4, 3, 0, 100);
  for (int step = 0; step < 3; ++step) {  // in which nothing reaches an edge
    layer.spread(0.05);
    plane.spread(0.05);
  }
  EXPECT_NEAR(layer.absolute_sum(), 100, 1e-12);
  for (int step = 0; step < 50; ++step) {
    layer.spread(0.05);
    plane.spread(0.05);
  }
  EXPECT_LT(layer.absolute_sum(), 99);
  EXPECT_TRUE((layer.values() == plane.values()).all());
  // Several layers have six neighbours.
  Field space = Field::space(5, 5, 3);
  space.set(2, 2, 1, 1);
  space.spread(0.1);
  EXPECT_NEAR(space.get(2, 2, 1), 0.4, 1e-15);
}

TEST(Field, PeriodicDiffusionWrapsForEverySize) {
  for (const Field& a : fields()) {
    Field d = a;
    d.diffuse_periodic(d, 0.25);  // in place
    for_each(a, [&](int x, int y, int z) {
      const auto value = [&](int i, int j, int k) {
        return a.get((i + a.nx()) % a.nx(), (j + a.ny()) % a.ny(), (k + a.nz()) % a.nz());
      };
      EXPECT_NEAR(d.get(x, y, z), 0.25 * laplacian(a, x, y, z, value), kExact);
    });
  }
}

TEST(Field, ACosineDecaysByItsEigenvalue) {
  // One explicit step multiplies the mode cos(k x) by 1 + 2 r (cos k - 1).
  const int n = 12;
  Field f = Field::line(n);
  const double k = 2 * std::numbers::pi / n, r = 0.25;
  for (int x = 0; x < n; ++x) f.set(x, 0, 0, std::cos(k * x));
  for (int step = 0; step < 50; ++step) {
    Field change = f;
    change.diffuse_periodic(f, r);
    f.add(change);
  }
  EXPECT_NEAR(f.get(0), std::pow(1 + 2 * r * (std::cos(k) - 1), 50), kExact);
}

TEST(Field, TransformIsTheMatrixProduct) {
  const Field m = noise(Field::plane(3, 4), 1), right = noise(Field::plane(4, 2), 2), vector = noise(Field::line(4), 3);
  Field product = Field::plane(3, 2), image = Field::line(3);
  right.transform(m, product);
  vector.transform(m, image);
  for (int i = 0; i < 3; ++i) {
    double along = 0;
    for (int k = 0; k < 4; ++k) along += m.get(i, k) * vector.get(k);
    EXPECT_NEAR(image.get(i), along, kExact);
    for (int j = 0; j < 2; ++j) {
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += m.get(i, k) * right.get(k, j);
      EXPECT_NEAR(product.get(i, j), sum, kExact);
    }
  }
  // The result may be an operand.
  Field square = noise(Field::plane(3, 3), 4), expected = square;
  square.transform(square, expected);
  square.transform(square, square);
  EXPECT_TRUE((square.values() == expected.values()).all());
}

TEST(Field, WrongIndicesAndSizesAreNamed) {
  Field f = Field::plane(3, 4);
  EXPECT_EQ(message([&] { f.get(3, 0); }), "index (3, 0) is outside a matrix of 3 x 4 (indices start at 0)");
  EXPECT_EQ(message([&] { f.set(0, -1, 0, 1); }), "index (0, -1) is outside a matrix of 3 x 4 (indices start at 0)");
  EXPECT_EQ(message([&] { Field::line(3).get(3); }), "index 3 is outside a matrix of 3 (indices start at 0)");
  EXPECT_EQ(message([&] { f.add(Field::plane(4, 3)); }),
            "cannot add a matrix of 3 x 4 and one of 4 x 3: the sizes must agree");
  EXPECT_NE(message([&] { f.diffuse(Field::space(3, 4, 1)); }).find("must agree"), std::string::npos);
  EXPECT_EQ(message([] { Field::plane(0, 3); }), "the x size of a matrix is 0 (must be > 0)");
  EXPECT_NE(message([] { Field::space(2000000000, 2000000000, 2000000000); }).find("too many elements"),
            std::string::npos);
  Field out = Field::plane(2, 2);
  EXPECT_NE(message([&] { f.transform(f, out); }).find("the columns of the first"), std::string::npos);
  EXPECT_NE(message([&] { f.transform(Field::plane(3, 3), out); }).find("does not fit"), std::string::npos);
}

TEST(Field, ChannelBytesAreCut) {
  EXPECT_EQ(Field::channel_byte(0.5, 1), 127);
  EXPECT_EQ(Field::channel_byte(0.5, 4), 255);
  EXPECT_EQ(Field::channel_byte(-1, 1), 0);
  EXPECT_EQ(Field::channel_byte(std::numeric_limits<double>::quiet_NaN(), 1), 0);
}

TEST(Field, PrintsRowsLikeMatlab) {
  Field f = Field::plane(2, 2);
  f.set(0, 1, 0, 0.5);
  f.set(1, 0, 0, 3);
  EXPECT_EQ(f.matlab(), "[ 0 0.5; 3 0 ]");
  Field v = Field::line(2);
  v.set(1, 0, 0, 2);
  EXPECT_EQ(v.matlab(), "[ 0 2 ]");
}

TEST(Field, AnImageGivesTheSameFieldBack) {
  for (const Field& a : fields()) {
    ByteWriter out;
    a.save(out);
    const auto bytes = out.take();
    ByteReader in(bytes.data(), bytes.size());
    const Field b = Field::load(in);
    Hasher before, after;
    a.hash(before);
    b.hash(after);
    EXPECT_EQ(before.value(), after.value());
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      ByteReader cut(bytes.data(), size);
      EXPECT_THROW(Field::load(cut), Error);
    }
  }
  ByteWriter huge;
  for (const int n : {3, 0x7fffffff, 0x7fffffff, 0x7fffffff}) huge.put(static_cast<std::int32_t>(n));
  ByteReader in(huge.bytes().data(), huge.bytes().size());
  EXPECT_THROW(Field::load(in), Error);
}

}  // namespace
}  // namespace breve
