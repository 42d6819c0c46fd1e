// What every search of runtime/learn/evolution owes to images of it.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory_resource>

#include "runtime/base/bytes.hpp"
#include "runtime/base/error.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/random.hpp"

namespace breve::learn {

/// A copy out of an image goes on as the search does; an image that is cut off is refused; one with a forged byte is
/// refused, or gives a search that runs.
/// @param advance  (search, random): one generation
/// @param fits     (search): whether `advance` is right for what a forged image gave
template <class Search, class Advance, class Fits>
void expect_goes_on_from_image(Search& search, Random& random, const Advance& advance, const Fits& fits) {
  ByteWriter out;
  search.save(out);
  const auto bytes = out.take();
  Search copy(std::pmr::get_default_resource());
  ByteReader in(bytes.data(), bytes.size());
  copy.load(in);
  Random other = random;
  for (int i = 0; i < 10; ++i) {
    advance(search, random);
    advance(copy, other);
  }
  Hasher a, b;
  search.hash(a);
  copy.hash(b);
  EXPECT_EQ(a.value(), b.value());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ByteReader cut(bytes.data(), size);
    EXPECT_THROW(Search(std::pmr::get_default_resource()).load(cut), Error);
  }
  for (int round = 0; round < 5000; ++round) {
    auto forged = bytes;
    forged[random.below(forged.size())] = static_cast<std::uint8_t>(random.below(256));
    Search forger(std::pmr::get_default_resource());
    ByteReader from(forged.data(), forged.size());
    try {
      forger.load(from);
    } catch (const Error&) {
      continue;
    }
    if (fits(forger)) advance(forger, random);
  }
}

}  // namespace breve::learn
