// flock.cpp: the host of flock.c, in C++: handles that clean up after themselves, results that carry their status.
//
// What it teaches: breve.hpp. A failure is a value as long as one looks at it; or_throw() turns it into an exception
// where there is nothing better to do, as here. Both hosts print the same numbers, and end with the same hash.
//
//     flock_cpp [FILE.tz [FRAMES]]        default: samples/worlds/flock.tz, 600 frames
#include <algorithm>
#include <breve/breve.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace {

double length(const breve::Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// What the host wants to know about the flock.
struct Look {
  double spread = 0;  // mean distance of the birds from their centre, length units
  double order = 0;   // |mean heading| of those that fly: 1 if all fly the same way
  int landed = 0;
};

Look look_at_flock(breve::World& world) {
  const auto birds = world.objects("Bird").or_throw();
  const double count = static_cast<double>(birds.size());
  std::vector<breve::Vector> places;
  breve::Vector center{}, heading{};
  int flying = 0;
  for (const breve::Object bird : birds) {
    const breve_pose pose = world.pose(bird).or_throw();
    const breve::Vector velocity = world.velocity(bird).or_throw();
    const double speed = length(velocity);
    places.push_back({pose.location[0], pose.location[1], pose.location[2]});
    for (std::size_t k = 0; k < 3; ++k) {
      center[k] += pose.location[k] / count;
      if (speed > 0) heading[k] += velocity[k] / speed;
    }
    if (speed > 0) ++flying;
  }
  Look look;
  for (const breve::Vector& p : places) look.spread += length({p[0] - center[0], p[1] - center[1], p[2] - center[2]});
  if (!birds.empty()) look.spread /= count;
  if (flying) look.order = length(heading) / flying;
  // What the host cannot see from outside, it asks the controller for.
  look.landed = world.call(world.controller(), "get-landed-count").or_throw().integer();
  return look;
}

void run(breve::World& world, int frames) {
  using Clock = std::chrono::steady_clock;
  double total = 0, worst = 0;
  std::printf("%7s %9s %9s %7s %7s %12s\n", "frame", "time", "spread", "order", "landed", "frame time");
  for (int frame = 1; frame <= frames; ++frame) {
    const auto start = Clock::now();
    world.step().or_throw();
    const double spent = std::chrono::duration<double>(Clock::now() - start).count();
    total += spent;
    worst = std::max(worst, spent);
    if (frame % 60 != 0 && frame != frames) continue;
    const Look look = look_at_flock(world);
    std::printf("%7d %7.1f s %9.2f %7.2f %7d %9.3f ms\n", frame, world.time(), look.spread, look.order, look.landed,
                1e3 * spent);
  }
  std::printf("\n%d frames, %.1f simulated seconds, in %.2f s: %.3f ms a frame, %.3f ms the longest\n", frames,
              world.time(), total, 1e3 * total / frames, 1e3 * worst);
  std::printf("hash %016llx\n", static_cast<unsigned long long>(world.hash().or_throw()));
}

/// Warnings and errors go to stderr. What the script prints is left out: this host prints its own table.
void speak(void*, breve_world*, breve_channel channel, const char* text, std::size_t size) {
  if (channel != BREVE_CHANNEL_PRINT) std::fwrite(text, 1, size, stderr);
}

}  // namespace

int main(int argc, char** argv) {
  const char* file = argc > 1 ? argv[1] : "samples/worlds/flock.tz";
  const int frames = argc > 2 ? std::atoi(argv[2]) : 600;
  if (frames < 1) {
    std::fprintf(stderr, "usage: %s [FILE.tz [FRAMES]]\n", argv[0]);
    return 2;
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    std::fprintf(stderr, "flock: cannot read %s\n", file);
    return EXIT_FAILURE;
  }
  const std::string text{std::istreambuf_iterator<char>(in), {}};

  try {
    breve_runtime_config config = breve_runtime_config_default();
    config.print = speak;
    auto runtime = breve::Runtime::create(config).or_throw();
    const auto program = runtime.compile(file, text).or_throw();
    auto world = runtime.world(program).or_throw();
    run(world, frames);
    return EXIT_SUCCESS;
  } catch (const breve::Failure& failure) {
    std::fprintf(stderr, "flock: %s", failure.what());
    return EXIT_FAILURE;
  }
}
