// The rows of a breve_array.
#pragma once

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

#include "guard.hpp"

namespace breve::host {

inline constexpr std::size_t kMostNumbers = 7;  // of one object

/// The rows of an array of the host, one for each object. They may lie at any address.
class Rows {
 public:
  Rows(const breve_array* array, std::size_t count, std::size_t width) : width_(width) {
    need(array, "array");
    if (array->number != BREVE_NUMBER_FLOAT && array->number != BREVE_NUMBER_DOUBLE)
      fail(BREVE_ERROR_ARGUMENT, "array.number is " + std::to_string(array->number) + ", which is not a breve_number");
    single_ = array->number == BREVE_NUMBER_FLOAT;
    if (array->width != width)
      fail(BREVE_ERROR_ARGUMENT, "array.width is " + std::to_string(array->width) + ", but an object has " +
                                     std::to_string(width) + " of these numbers");
    const std::size_t row = width * (single_ ? sizeof(float) : sizeof(double));
    stride_ = array->stride != 0 ? array->stride : row;
    if (stride_ < row)
      fail(BREVE_ERROR_ARGUMENT, "array.stride is " + std::to_string(array->stride) + " bytes, but an object's " +
                                     std::to_string(width) + " numbers take " + std::to_string(row));
    if (count != 0) need(array->numbers, "array.numbers");
    if (count > std::numeric_limits<std::size_t>::max() / stride_)
      fail(BREVE_ERROR_ARGUMENT, "count is too large for any memory");
    bytes_ = static_cast<char*>(array->numbers);
  }

  char* bytes() const { return bytes_; }
  std::size_t stride() const { return stride_; }  // of bytes
  bool single() const { return single_; }         // floats

  /// W numbers, which is its width: a copy of a known size is some moves.
  template <std::size_t W>
  void put(std::size_t row, const double* numbers) const {
    char* const to = bytes_ + row * stride_;
    if (!single_) {
      std::memcpy(to, numbers, W * sizeof(double));
      return;
    }
    float narrow[W];
    for (std::size_t i = 0; i < W; ++i) narrow[i] = static_cast<float>(numbers[i]);
    std::memcpy(to, narrow, W * sizeof(float));
  }
  void get(std::size_t row, double* numbers) const {
    const char* const from = bytes_ + row * stride_;
    if (!single_) {
      std::memcpy(numbers, from, width_ * sizeof(double));
      return;
    }
    float narrow[kMostNumbers];
    std::memcpy(narrow, from, width_ * sizeof(float));
    std::copy_n(narrow, width_, numbers);
  }

 private:
  char* bytes_;
  std::size_t stride_, width_;
  bool single_;
};

}  // namespace breve::host
