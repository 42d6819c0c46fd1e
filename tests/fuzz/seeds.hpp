// Bytes to generate programs from, where there is no fuzzer: a plain series from a seed, the same on every machine.
#pragma once

#include <cstdint>
#include <vector>

namespace breve::fuzz {

/// Between 100 and 2,147 bytes, or up to 99 + `most`. SplitMix64, Steele, Lea and Flood 2014.
inline std::vector<std::uint8_t> bytes_of_seed(std::uint64_t seed, std::uint64_t most = 2048) {
  const auto next = [&seed] {
    std::uint64_t z = (seed += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  };
  std::vector<std::uint8_t> bytes(100 + next() % most);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(next());
  return bytes;
}

/// For fuzz_call: a program and its worlds take longer to make than many calls.
inline std::vector<std::uint8_t> calls_of_seed(std::uint64_t seed) { return bytes_of_seed(seed, 12'000); }
/// For fuzz_select and fuzz_restore: to compile the class library takes longer than to run many courses of a program.
inline std::vector<std::uint8_t> courses_of_seed(std::uint64_t seed) { return bytes_of_seed(seed, 8'000); }

}  // namespace breve::fuzz
