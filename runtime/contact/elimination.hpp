// Gaussian elimination with partial pivoting that skips what is zero: stacked bodies couple with their neighbours only.
#pragma once

#include <cstddef>
#include <span>

namespace breve::contact {

/// A square matrix, row-major, of which numbers farther than `band` from the diagonal are zero. Where that is worth it
/// they are not stored; what exchanging rows makes of the band is.
class BandMatrix {
 public:
  BandMatrix() = default;
  BandMatrix(int size, int band);
  /// What memory it needs.
  std::size_t numbers() const { return numbers_; }
  void use(double* memory) { numbers_at_ = memory; }

  int size() const { return size_; }
  int band() const { return band_; }
  /// It is stored whole, and is so small that the nearest cache holds it.
  bool small() const { return band_ == size_ && size_ <= kSmall; }
  /// Number k of it is at [k], for those that are stored.
  double* row(int i) const { return numbers_at_ + shift_ + static_cast<std::ptrdiff_t>(i) * stride_; }
  void clear() const;

 private:
  static constexpr int kSmall = 48;
  int size_ = 0, band_ = 0;
  std::ptrdiff_t stride_ = 0, shift_ = 0;
  std::size_t numbers_ = 0;
  double* numbers_at_ = nullptr;
};

/// A becomes L and U in place, a few columns at a time.
/// @param pivots, ends  as many numbers each: the row each one was exchanged for, and where the rows of U end
/// @return              false if a pivot vanishes or is not finite; the matrix is then of no use
bool factorize(const BandMatrix& matrix, std::span<int> pivots, std::span<int> ends);

/// Solves A x = b with what factorize() left of A: b becomes x.
void substitute(const BandMatrix& factors, std::span<const int> pivots, std::span<const int> ends, std::span<double> b);

}  // namespace breve::contact
