// What the objects of a world play, for the host's ears.
#include "breve/sound.h"

#include <cmath>

#include "internal.hpp"
#include "steve/library/sounds.hpp"

using namespace breve::host;

breve_status breve_world_sound(const breve_world* world, double time, double rate, float* samples, size_t frame_count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    constexpr double kLeastRate = 1000, kMostRate = 1e6;
    if (!std::isfinite(time)) fail(BREVE_ERROR_ARGUMENT, "time is not finite");
    if (!(rate >= kLeastRate && rate <= kMostRate))
      fail(BREVE_ERROR_ARGUMENT, "rate is " + std::to_string(rate) + " (must be from 1000 to 1000000)");
    if (frame_count == 0) return;
    need(samples, "samples");
    if (frame_count > SIZE_MAX / sizeof(float) / 2) fail(BREVE_ERROR_ARGUMENT, "frame_count is too large");
    const std::span<float> frames(samples, 2 * frame_count);
    std::fill(frames.begin(), frames.end(), 0.0F);
    breve::steve::add_sounds(*world->world, frames, {time, rate});
  });
}
