// Long memory is made piece by piece: the first write to a page may take the system some microseconds, so that some
// tens of megabytes at once would keep whoever wants to end the work waiting.
#pragma once

#include <algorithm>
#include <cstddef>

#include "runtime/base/poll.hpp"

namespace breve {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

/// `work(begin, end)` for all of `count` elements of so many bytes, in order.
template <class Work>
void in_pieces(std::size_t count, std::size_t element_bytes, const Poll& poll, Work&& work) {
  const std::size_t piece = std::max<std::size_t>(1, kPieceBytes / element_bytes);
  for (std::size_t begin = 0; begin < count; begin += piece) {
    work(begin, std::min(count, begin + piece));
    if (poll) poll();
  }
}

/// `values` is empty, and gets so many default values.
template <class Vector>
void resize_in_pieces(Vector& values, std::size_t count, const Poll& poll) {
  values.reserve(count);
  in_pieces(count, sizeof(typename Vector::value_type), poll,
            [&](std::size_t, std::size_t end) { values.resize(end); });
}

}  // namespace breve
