// The entrance of libFuzzer to one of the targets; the build names it in BREVE_FUZZ_TARGET.
#include <cstddef>

#include "targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  breve::fuzz::BREVE_FUZZ_TARGET({data, size});
  return 0;
}
