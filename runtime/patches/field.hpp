// A dense grid of numbers in one, two or three dimensions: what scripts call Vector, Matrix2D and Matrix3D.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <string>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/poll.hpp"

namespace breve {

/// Element (x, y, z) is at index (x * ny + y) * nz + z. Every failing call throws Error{Argument} and changes nothing.
class Field {
 public:
  static constexpr std::size_t kMaxElements = std::size_t{1} << 28;  // 2 GiB of doubles

  /// Zeros, in `memory`. Sizes from 1; at most kMaxElements in all.
  static Field line(int size, std::pmr::memory_resource* memory = std::pmr::get_default_resource());
  static Field plane(int nx, int ny, std::pmr::memory_resource* memory = std::pmr::get_default_resource());
  static Field space(int nx, int ny, int nz, std::pmr::memory_resource* memory = std::pmr::get_default_resource());
  /// A copy in `memory`.
  Field(const Field& other, std::pmr::memory_resource* memory);
  Field(const Field&) = default;  // in the default memory
  Field(Field&&) = default;
  Field& operator=(const Field&) = default;  // the elements stay in the memory that this field has
  Field& operator=(Field&&) = default;

  int dimensions() const { return dimensions_; }
  int nx() const { return nx_; }
  int ny() const { return ny_; }  // 1 for a line
  int nz() const { return nz_; }  // 1 for a line or a plane
  std::size_t size() const { return values_.size(); }
  Eigen::Map<const Eigen::ArrayXd> values() const { return {values_.data(), length()}; }
  double* data() { return values_.data(); }  // size() of them, in their order
  bool same_size(const Field& other) const {
    return other.dimensions_ == dimensions_ && other.nx_ == nx_ && other.ny_ == ny_ && other.nz_ == nz_;
  }
  /// Take `values`, as many as are here; if they lie in the same memory, in exchange for those.
  void swap_values(std::pmr::vector<double>& values) {
    values.get_allocator() == values_.get_allocator() ? values_.swap(values) : void(values_ = values);
  }

  // Elements; an index out of range is named in the error.
  double get(int x, int y = 0, int z = 0) const { return values_[at(x, y, z)]; }
  void set(int x, int y, int z, double value) { values_[at(x, y, z)] = value; }

  // Whole fields; the other field must have the same sizes. Where `poll` throws, a part of the elements is changed.
  void fill(double value, const Poll& poll = {});
  void scale(double factor, const Poll& poll = {});
  void add_scalar(double value, const Poll& poll = {});
  void add(const Field& other, double factor = 1, const Poll& poll = {});
  void subtract(const Field& other, double factor = 1, const Poll& poll = {});
  void multiply(const Field& other, const Poll& poll = {});  // element by element
  void add_product(const Field& a, const Field& b, double factor = 1, const Poll& poll = {});
  void copy(const Field& other, const Poll& poll = {});

  double absolute_sum(const Poll& poll = {}) const;  // in the order of the elements: the same on every machine
  double max(const Poll& poll = {}) const;

  /// this = factor * (sum of the 2 d neighbours - 2 d * other), d dimensions. `other` may be this field.
  void diffuse(const Field& other, double factor = 1, const Poll& poll = {});           // outside is 0
  void diffuse_periodic(const Field& other, double factor = 1, const Poll& poll = {});  // edges wrap, for every size

  /// this += factor * its own Laplacian, as above, over the dimensions that the elements span: a field in space of one
  /// layer (nz 1) spreads as a plane, so that nothing leaks through the dimension that it lacks.
  void spread(double factor, const Poll& poll = {});
  void spread_periodic(double factor, const Poll& poll = {});
  int spans() const { return dimensions_ == 3 && nz_ == 1 ? 2 : dimensions_; }

  /// result = matrix * this. For a plane this is the product of matrices with x as row and y as column; for a line the
  /// product with a column. `result` must have the sizes of the product and may be either operand.
  void transform(const Field& matrix, Field& result, const Poll& poll = {}) const;

  /// Channel bytes as an image takes them: floor(255 * factor * value), not below 0 nor above 255; NaN gives 0.
  static std::uint8_t channel_byte(double value, double factor);

  /// Rows as a matrix is typed into MATLAB: "[ 1 2; 3 4 ]"; a line or a plane.
  std::string matlab(const Poll& poll = {}) const;

  void save(ByteWriter& out) const;
  static Field load(ByteReader& in);  // Error{Image}
  void hash(Hasher& hasher) const;

 private:
  Field(int dimensions, int nx, int ny, int nz, std::pmr::memory_resource* memory);
  Eigen::Index length() const { return static_cast<Eigen::Index>(values_.size()); }
  Eigen::Map<Eigen::ArrayXd> array() { return {values_.data(), length()}; }
  std::size_t at(int x, int y, int z) const;
  void check_same_size(const Field& other, const char* what) const;
  std::string size_text() const;
  template <bool kPeriodic>
  void laplacian(const Field& other, double factor, int dimensions, bool added, const Poll& poll);
  template <class Work>
  void in_pieces(const Poll& poll, Work&& work) const;

  int dimensions_, nx_, ny_, nz_;
  std::pmr::vector<double> values_;
};

}  // namespace breve
