// Elimination within a band, against dense matrices.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <vector>

#include "runtime/contact/elimination.hpp"

namespace breve::contact {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A band matrix with what it needs.
struct Banded {
  BandMatrix matrix;
  std::vector<double> numbers;
  std::vector<int> pivots, ends;

  Banded(const Matrix& dense, int band) : matrix(static_cast<int>(dense.rows()), band), numbers(matrix.numbers()) {
    const auto n = static_cast<std::size_t>(dense.rows());
    pivots.resize(n);
    ends.resize(n);
    matrix.use(numbers.data());
    matrix.clear();
    for (int i = 0; i < matrix.size(); ++i)
      for (int k = 0; k < matrix.size(); ++k)
        if (std::abs(i - k) <= band) matrix.row(i)[k] = dense(i, k);
  }
};

/// Small numbers on the diagonal make it exchange rows; some numbers are zero.
Matrix random_matrix(int n, int band, double diagonal, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1, 1);
  Matrix out = Matrix::Zero(n, n);
  for (int i = 0; i < n; ++i)
    for (int k = std::max(0, i - band); k <= std::min(n - 1, i + band); ++k) {
      const double value = number(random);
      if (i == k || std::abs(value) > 0.2) out(i, k) = i == k ? diagonal * value : value;
    }
  return out;
}

TEST(Elimination, BandsOfAnyWidthAreSolvedForAnyNumberOfRightHandSides) {
  std::mt19937 random(7);
  for (const int n : {1, 2, 3, 4, 5, 7, 8, 9, 31, 64, 97})
    for (const int band : {0, 1, 2, 5, 12, 40, 96})
      for (const double diagonal : {1e-3, 1.0, 100.0}) {
        const Matrix dense = random_matrix(n, band, diagonal, random);
        Banded banded(dense, band);
        const Eigen::FullPivLU<Matrix> exact(dense);
        if (!(exact.rcond() > 1e-9)) continue;
        ASSERT_TRUE(factorize(banded.matrix, banded.pivots, banded.ends)) << n << " " << band;
        for (int side = 0; side < 2; ++side) {
          const Eigen::VectorXd wanted = Eigen::VectorXd::Random(n), b = dense * wanted;
          std::vector<double> found(b.data(), b.data() + n);
          substitute(banded.matrix, banded.pivots, banded.ends, found);
          for (int i = 0; i < n; ++i)
            EXPECT_NEAR(found[static_cast<std::size_t>(i)], wanted[i], 1e-13 / exact.rcond()) << n << " " << band;
        }
      }
}

TEST(Elimination, SingularMatricesAreToldApart) {
  std::mt19937 random(7);
  for (const int n : {1, 4, 9}) {
    Matrix dense = random_matrix(n, n, 1, random);
    dense.row(n / 2).setZero();
    Banded banded(dense, n);
    EXPECT_FALSE(factorize(banded.matrix, banded.pivots, banded.ends));
    dense.row(n / 2).setConstant(std::nan(""));
    Banded invalid(dense, n);
    EXPECT_FALSE(factorize(invalid.matrix, invalid.pivots, invalid.ends));
  }
}

}  // namespace
}  // namespace breve::contact
