// An array of numbers at an aligned address. Eigen computes elements before the first aligned address one by one and
// the rest in pairs, and both may differ in the last bit: from a fixed alignment the same elements are always paired.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <memory_resource>
#include <utility>

namespace breve::learn {

using MatrixMap = Eigen::Map<Eigen::MatrixXd>;
using ConstMatrixMap = Eigen::Map<const Eigen::MatrixXd>;
using VectorMap = Eigen::Map<Eigen::VectorXd>;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;

class Numbers {
 public:
  explicit Numbers(std::pmr::memory_resource* memory) : memory_(memory) {}
  Numbers(std::pmr::memory_resource* memory, std::size_t size) : memory_(memory) { resize(size); }
  Numbers(const Numbers& other) : memory_(other.memory_) { *this = other; }
  Numbers(Numbers&& other) noexcept
      : memory_(other.memory_), data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  ~Numbers() { release(); }

  Numbers& operator=(const Numbers& other) {
    if (this == &other) return *this;
    if (size_ != other.size_) Numbers(memory_, other.size_).swap(*this);
    if (size_ > 0 && data_) std::copy_n(other.data_, size_, data_);
    return *this;
  }
  Numbers& operator=(Numbers&& other) noexcept {
    Numbers(std::move(other)).swap(*this);
    return *this;
  }

  /// Zeros are appended, or the last numbers removed.
  void resize(std::size_t size) {
    if (size == size_) return;
    if (size == 0) {
      release();
      data_ = nullptr;
      size_ = 0;
      return;
    }
    double* const data = static_cast<double*>(memory_->allocate(size * sizeof(double), kAlignment));
    const std::size_t kept = std::min(size, size_);
    if (kept > 0) std::copy_n(data_, kept, data);
    std::fill_n(data + kept, size - kept, 0.0);
    release();
    data_ = data;
    size_ = size;
  }
  /// So many zeros in place of what there is. `poll` is called in between and may throw: then some are left undefined.
  template <class Poll>
  void assign_zeros(std::size_t size, const Poll& poll) {
    constexpr std::size_t kPiece = 1 << 17;  // numbers: pages of memory that are touched first take time
    release();
    data_ = nullptr;
    size_ = 0;
    if (size == 0) return;
    data_ = static_cast<double*>(memory_->allocate(size * sizeof(double), kAlignment));
    size_ = size;
    for (std::size_t at = 0; at < size; at += kPiece) {
      std::fill_n(data_ + at, std::min(kPiece, size - at), 0.0);
      poll();
    }
  }
  void fill(double value) { std::fill_n(data_, size_, value); }

  std::pmr::memory_resource* memory() const { return memory_; }
  std::size_t size() const { return size_; }
  double* data() { return data_; }
  const double* data() const { return data_; }
  double* begin() { return data_; }
  double* end() { return data_ + size_; }
  const double* begin() const { return data_; }
  const double* end() const { return data_ + size_; }
  double& operator[](std::size_t i) { return data_[i]; }
  double operator[](std::size_t i) const { return data_[i]; }

  VectorMap vector() { return {data_, static_cast<Eigen::Index>(size_)}; }
  ConstVectorMap vector() const { return {data_, static_cast<Eigen::Index>(size_)}; }
  /// Consecutive numbers from `at` as a matrix, column by column.
  MatrixMap matrix(std::size_t at, Eigen::Index rows, Eigen::Index columns) { return {data_ + at, rows, columns}; }
  ConstMatrixMap matrix(std::size_t at, Eigen::Index rows, Eigen::Index columns) const {
    return {data_ + at, rows, columns};
  }

  void swap(Numbers& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }

 private:
  static constexpr std::size_t kAlignment = 64;  // bytes, a line of the cache

  void release() {
    if (data_) memory_->deallocate(data_, size_ * sizeof(double), kAlignment);
  }

  std::pmr::memory_resource* memory_;
  double* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace breve::learn
