// What the fuzzers share: handles of breve.h that let go of themselves, and the word with which a finding ends.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "breve/breve.h"

namespace breve::fuzz {

struct Destroy {
  void operator()(breve_runtime* runtime) const { breve_runtime_destroy(runtime); }
  void operator()(breve_program* program) const { breve_program_destroy(program); }
  void operator()(breve_world* world) const { breve_world_destroy(world); }
};
using Runtime = std::unique_ptr<breve_runtime, Destroy>;
using Program = std::unique_ptr<breve_program, Destroy>;
using World = std::unique_ptr<breve_world, Destroy>;

/// A finding: print what is wrong and what it happened to, and abort.
[[noreturn]] inline void finding(std::string_view what, std::string_view about = {}) {
  std::fprintf(stderr, "FINDING: %.*s\n%.*s\n", static_cast<int>(what.size()), what.data(),
               static_cast<int>(about.size()), about.data());
  std::abort();
}

inline void require(bool condition, std::string_view what, std::string_view about = {}) {
  if (!condition) finding(what, about);
}

inline Runtime make_runtime(const breve_runtime_config& config) {
  breve_runtime* made = nullptr;
  require(breve_runtime_create(&config, &made) == BREVE_OK, "no runtime");
  return Runtime(made);
}

}  // namespace breve::fuzz
