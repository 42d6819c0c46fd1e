// What the fuzzers share: handles of breve.h that release themselves, images of worlds, and the word with which a
// finding ends.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
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
[[noreturn]] inline void finding(std::string_view what, std::string_view about = "") {
  std::fprintf(stderr, "FINDING: %.*s\n%.*s\n", static_cast<int>(what.size()), what.data(),
               static_cast<int>(about.size()), about.data());
  std::abort();
}

inline void require(bool condition, std::string_view what, std::string_view about = "") {
  if (!condition) finding(what, about);
}

/// The image of a world; nothing if the memory limit leaves no room for it.
/// @param guess  bytes that it probably has; an image that is larger is taken twice
inline std::string image_of(const breve_world* world, std::string_view program, std::size_t guess = 0) {
  std::size_t size = 0;
  std::string image(guess, '\0');
  breve_status status = breve_world_snapshot(world, guess == 0 ? nullptr : image.data(), guess, &size);
  if (status == BREVE_OK && size > guess) {
    image.resize(size);
    status = breve_world_snapshot(world, image.data(), size, &size);
  }
  image.resize(size);
  if (status == BREVE_ERROR_MEMORY) return "";
  if (status != BREVE_OK) finding(breve_world_last_error(world)->text, program);
  return image;
}

inline Runtime make_runtime(const breve_runtime_config& config) {
  breve_runtime* made = nullptr;
  require(breve_runtime_create(&config, &made) == BREVE_OK, "no runtime");
  return Runtime(made);
}

}  // namespace breve::fuzz
