// Grids of numbers: arithmetic is Eigen's, row by row where neighbours are needed.
#include "runtime/patches/field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/base/in_pieces.hpp"

namespace breve {

namespace {

void check_size(const char* name, int size) {
  if (size < 1)
    throw Error(ErrorCode::Argument, fmt::format("the {} size of a matrix is {} (must be > 0)", name, size));
}

}  // namespace

Field::Field(int dimensions, int nx, int ny, int nz, std::pmr::memory_resource* memory)
    : dimensions_(dimensions), nx_(nx), ny_(ny), nz_(nz), values_(memory) {
  check_size("x", nx);
  check_size("y", ny);
  check_size("z", nz);
  const std::size_t across = static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz);
  if (across > kMaxElements / static_cast<std::size_t>(nx)) {
    throw Error(ErrorCode::Argument,
                fmt::format("a matrix of {} has too many elements (at most {})", size_text(), kMaxElements));
  }
  values_.resize(across * static_cast<std::size_t>(nx));
}

Field::Field(const Field& other, std::pmr::memory_resource* memory)
    : dimensions_(other.dimensions_), nx_(other.nx_), ny_(other.ny_), nz_(other.nz_), values_(other.values_, memory) {}

Field Field::line(int size, std::pmr::memory_resource* memory) { return {1, size, 1, 1, memory}; }
Field Field::plane(int nx, int ny, std::pmr::memory_resource* memory) { return {2, nx, ny, 1, memory}; }
Field Field::space(int nx, int ny, int nz, std::pmr::memory_resource* memory) { return {3, nx, ny, nz, memory}; }

std::string Field::size_text() const {
  switch (dimensions_) {
    case 1: return fmt::format("{}", nx_);
    case 2: return fmt::format("{} x {}", nx_, ny_);
    default: return fmt::format("{} x {} x {}", nx_, ny_, nz_);
  }
}

std::size_t Field::at(int x, int y, int z) const {
  if (x < 0 || x >= nx_ || y < 0 || y >= ny_ || z < 0 || z >= nz_) {
    const std::string index = dimensions_ == 1   ? fmt::format("{}", x)
                              : dimensions_ == 2 ? fmt::format("({}, {})", x, y)
                                                 : fmt::format("({}, {}, {})", x, y, z);
    throw Error(ErrorCode::Argument,
                fmt::format("index {} is outside a matrix of {} (indices start at 0)", index, size_text()));
  }
  return static_cast<std::size_t>((static_cast<Eigen::Index>(x) * ny_ + y) * nz_ + z);
}

void Field::check_same_size(const Field& other, const char* what) const {
  if (same_size(other)) return;
  throw Error(ErrorCode::Argument, fmt::format("cannot {} a matrix of {} and one of {}: the sizes must agree", what,
                                               size_text(), other.size_text()));
}

/// `work(begin, count)` for all elements, piece by piece.
template <class Work>
void Field::in_pieces(const Poll& poll, Work&& work) const {
  breve::in_pieces(values_.size(), sizeof(double), poll, [&](std::size_t begin, std::size_t end) {
    work(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin));
  });
}

void Field::fill(double value, const Poll& poll) {
  in_pieces(poll, [&](auto begin, auto count) { array().segment(begin, count).setConstant(value); });
}

void Field::scale(double factor, const Poll& poll) {
  in_pieces(poll, [&](auto begin, auto count) { array().segment(begin, count) *= factor; });
}

void Field::add_scalar(double value, const Poll& poll) {
  in_pieces(poll, [&](auto begin, auto count) { array().segment(begin, count) += value; });
}

void Field::add(const Field& other, double factor, const Poll& poll) {
  check_same_size(other, "add");
  in_pieces(poll, [&](auto begin, auto count) {
    array().segment(begin, count) += factor * other.values().segment(begin, count);
  });
}

void Field::subtract(const Field& other, double factor, const Poll& poll) {
  check_same_size(other, "subtract");
  in_pieces(poll, [&](auto begin, auto count) {
    array().segment(begin, count) -= factor * other.values().segment(begin, count);
  });
}

void Field::multiply(const Field& other, const Poll& poll) {
  check_same_size(other, "multiply");
  in_pieces(poll,
            [&](auto begin, auto count) { array().segment(begin, count) *= other.values().segment(begin, count); });
}

void Field::add_product(const Field& a, const Field& b, double factor, const Poll& poll) {
  check_same_size(a, "add the product of");
  check_same_size(b, "add the product of");
  in_pieces(poll, [&](auto begin, auto count) {
    array().segment(begin, count) += factor * a.values().segment(begin, count) * b.values().segment(begin, count);
  });
}

void Field::copy(const Field& other, const Poll& poll) {
  check_same_size(other, "copy");
  in_pieces(poll,
            [&](auto begin, auto count) { array().segment(begin, count) = other.values().segment(begin, count); });
}

double Field::absolute_sum(const Poll& poll) const {
  double sum = 0;
  in_pieces(poll, [&](auto begin, auto count) {
    for (const double value : values().segment(begin, count)) sum += std::abs(value);
  });
  return sum;
}

double Field::max(const Poll& poll) const {
  double largest = values_[0];
  in_pieces(poll, [&](auto begin, auto count) {
    for (const double value : values().segment(begin, count)) largest = std::max(largest, value);
  });
  return largest;
}

template <bool kPeriodic>
void Field::laplacian(const Field& other, double factor, int dimensions, bool added, const Poll& poll) {
  check_same_size(other, "diffuse");
  const auto from = other.values();
  std::pmr::vector<double> scratch(values_.get_allocator());
  scratch.reserve(values_.size());
  Eigen::Map<Eigen::ArrayXd> sum(scratch.data(), length());
  in_pieces(poll, [&](auto begin, auto count) {
    scratch.resize(static_cast<std::size_t>(begin + count));  // new memory, also a piece at a time
    sum.segment(begin, count) = (-2.0 * dimensions) * from.segment(begin, count);
  });
  // Along each axis the grid is a stack of slabs of `slab` elements that touch the next along the axis.
  const auto add_shifted = [&](Eigen::Index to, Eigen::Index source, Eigen::Index count) {
    constexpr Eigen::Index kPiece = Eigen::Index{1} << 19;
    for (Eigen::Index done = 0; done < count; done += kPiece) {
      const Eigen::Index piece = std::min(kPiece, count - done);
      sum.segment(to + done, piece) += from.segment(source + done, piece);
      if (poll && count > kPiece) poll();
    }
  };
  const auto along = [&](Eigen::Index count, Eigen::Index slab) {
    const Eigen::Index block = count * slab;
    for (Eigen::Index start = 0; start < from.size(); start += block) {
      const Eigen::Index inner = block - slab;
      add_shifted(start, start + slab, inner);
      add_shifted(start + slab, start, inner);
      if constexpr (kPeriodic) {
        add_shifted(start + inner, start, slab);
        add_shifted(start, start + inner, slab);
      }
      if (poll && start % (Eigen::Index{1} << 16) < block) poll();
    }
  };
  along(nx_, static_cast<Eigen::Index>(ny_) * nz_);
  if (dimensions > 1) along(ny_, nz_);
  if (dimensions > 2) along(nz_, 1);
  in_pieces(poll, [&](auto begin, auto count) {
    if (added)
      array().segment(begin, count) += factor * sum.segment(begin, count);
    else
      array().segment(begin, count) = factor * sum.segment(begin, count);
  });
}

void Field::diffuse(const Field& other, double factor, const Poll& poll) {
  laplacian<false>(other, factor, dimensions_, false, poll);
}
void Field::diffuse_periodic(const Field& other, double factor, const Poll& poll) {
  laplacian<true>(other, factor, dimensions_, false, poll);
}
void Field::spread(double factor, const Poll& poll) { laplacian<false>(*this, factor, spans(), true, poll); }
void Field::spread_periodic(double factor, const Poll& poll) { laplacian<true>(*this, factor, spans(), true, poll); }

void Field::transform(const Field& matrix, Field& result, const Poll& poll) const {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  if (matrix.dimensions_ != 2 || dimensions_ > 2 || matrix.ny_ != nx_) {
    throw Error(ErrorCode::Argument,
                fmt::format("cannot multiply a matrix of {} by one of {}: the columns of the first "
                            "must be as many as the rows of the second",
                            matrix.size_text(), size_text()));
  }
  if (result.dimensions_ != dimensions_ || result.nx_ != matrix.nx_ || result.ny_ != ny_) {
    throw Error(ErrorCode::Argument, fmt::format("the product of matrices of {} and {} does not fit into one of {}",
                                                 matrix.size_text(), size_text(), result.size_text()));
  }
  const Eigen::Map<const RowMajor> left(matrix.values_.data(), matrix.nx_, matrix.ny_);
  const Eigen::Map<const RowMajor> right(values_.data(), nx_, ny_);
  std::pmr::vector<double> scratch(result.values_.get_allocator());
  resize_in_pieces(scratch, result.size(), poll);
  Eigen::Map<RowMajor> product(scratch.data(), result.nx_, result.ny_);
  // So many rows at a time that a piece takes some milliseconds.
  constexpr Eigen::Index kPiece = Eigen::Index{1} << 24;  // multiplications
  const Eigen::Index rows = std::max<Eigen::Index>(1, kPiece / std::max<Eigen::Index>(1, length()));
  for (Eigen::Index row = 0; row < left.rows(); row += rows) {
    const Eigen::Index count = std::min(rows, left.rows() - row);
    product.middleRows(row, count).noalias() = left.middleRows(row, count) * right;
    if (poll) poll();
  }
  result.values_.swap(scratch);
}

std::uint8_t Field::channel_byte(double value, double factor) {
  const double level = 255 * factor * value;
  if (!(level > 0)) return 0;
  return static_cast<std::uint8_t>(std::min(level, 255.0));
}

std::string Field::matlab(const Poll& poll) const {
  if (dimensions_ > 2) throw Error(ErrorCode::Argument, "a 3D matrix has no rows to print");
  std::string text = "[";
  for (int x = 0; x < nx_; ++x) {
    if (x > 0 && dimensions_ == 2) text += ";";
    for (int y = 0; y < ny_; ++y) {
      text += fmt::format(" {}", get(x, y));
      if (poll && (static_cast<unsigned>(y) & 0xfffU) == 0) poll();
    }
  }
  return text + " ]";
}

void Field::save(ByteWriter& out) const {
  for (const int n : {dimensions_, nx_, ny_, nz_}) out.put(static_cast<std::int32_t>(n));
  out.raw(values_.data(), size() * sizeof(double));
}

Field Field::load(ByteReader& in) {
  std::int32_t n[4];
  for (std::int32_t& value : n) value = in.get<std::int32_t>();
  const bool flat = (n[0] > 1 || n[2] == 1) && (n[0] > 2 || n[3] == 1);
  if (n[0] < 1 || n[0] > 3 || n[1] < 1 || n[2] < 1 || n[3] < 1 || !flat) ByteReader::fail();
  // Divided, not multiplied: a damaged size cannot overflow nor ask for more than the image holds.
  const auto held = in.left() / sizeof(double);
  const auto sizes = [&](int i) { return static_cast<std::size_t>(n[i]); };
  if (sizes(1) > held || sizes(2) > held / sizes(1) || sizes(3) > held / sizes(1) / sizes(2)) ByteReader::fail();
  Field field(n[0], n[1], n[2], n[3], in.memory());
  in.raw(field.values_.data(), field.size() * sizeof(double));
  return field;
}

void Field::hash(Hasher& hasher) const {
  for (const int n : {dimensions_, nx_, ny_, nz_}) hasher.add(static_cast<std::uint64_t>(n));
  for (const double value : values_) hasher.add(value);
}

}  // namespace breve
