// Arrays of numbers in images and hashes.
#pragma once

#include <algorithm>
#include <cmath>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/learn/network/numbers.hpp"

namespace breve::learn {

inline void put_numbers(ByteWriter& out, const Numbers& numbers) {
  out.put(static_cast<std::uint64_t>(numbers.size()));
  out.raw(numbers.data(), numbers.size() * sizeof(double));
}

inline void get_numbers(ByteReader& in, Numbers& numbers) {
  numbers.resize(in.get_count(sizeof(double)));
  in.raw(numbers.data(), numbers.size() * sizeof(double));
}

inline void hash_numbers(Hasher& hasher, const Numbers& numbers) {
  hasher.add(static_cast<std::uint64_t>(numbers.size()));
  for (const double number : numbers) hasher.add(number);
}

inline bool all_finite(const Numbers& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
}

}  // namespace breve::learn
