// What a host does beside stepping changes no run: the hash after each iteration of a plain run is that of runs with
// more workers, with a profile, with images taken, restored from an image of its own each time, and of two worlds that
// take turns by images. Bodies of a flat world go on from the image that is taken of them (breve.h), so there only the
// runs with images are compared with one another.
//
//   stress_undisturbed FOLDER ITERATIONS   each program of a folder
#include <breve/breve.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

namespace {

using breve::World;

/// A world after an iteration.
struct Moment {
  breve_status status;
  std::uint64_t hash;
  bool operator==(const Moment&) const = default;
};

class Runs {
 public:
  Runs(const std::filesystem::path& path, int iterations)
      : name_(path.filename().string()), iterations_(iterations), runtime_(make_runtime()) {
    std::ifstream file(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    program_ = runtime_.compile(name_.c_str(), text).or_throw();
    World world = make();
    const auto planar = world.objects("PlanarControl");
    flat_ = planar.status() && !planar.value().empty();
    for (int i = 0; i < iterations; ++i) plain_.push_back(step(world));
  }

  bool flat() const { return flat_; }
  /// From now on runs are to be like one that begins with an image and takes one after each iteration.
  void begin_with_images() {
    World world = make();
    for (Moment& moment : plain_) {
      (void)world.snapshot().or_throw();
      moment = step(world);
    }
  }

  /// Steps a world, and does something to it before and after each iteration.
  void compare(const char* what, const std::function<void(World&)>& prepare, const std::function<void(World&)>& after) {
    World world = make();
    prepare(world);
    for (int i = 0; i < iterations_; ++i) {
      if (differs(what, i, step(world))) return;
      after(world);
    }
  }

  /// Each iteration is made by the one of two worlds that did not make the last.
  void take_turns() {
    World worlds[2] = {make(), make()};
    for (int i = 0; i < iterations_; ++i) {
      World &one = worlds[i % 2], &other = worlds[1 - i % 2];
      if (differs("two worlds in turn", i, step(one))) return;
      other.restore(one.snapshot().or_throw()).or_throw();
    }
  }

  bool wrong() const { return wrong_; }

 private:
  static breve::Runtime make_runtime() {
    breve_runtime_config config = breve_runtime_config_default();
    config.print = [](void*, breve_world*, breve_channel, const char*, std::size_t) {};
    return breve::Runtime::create(config).or_throw();
  }

  World make() {
    breve_world_config config = breve_world_config_default();
    const char* const name = name_.c_str();
    config.arguments = &name;
    config.argument_count = 1;
    return runtime_.world(program_, config).or_throw();
  }

  static Moment step(World& world) {
    const breve_status status = breve_world_step(world.get());
    return {status, world.hash().or_throw()};
  }

  bool differs(const char* what, int iteration, const Moment& moment) {
    const Moment& wanted = plain_[static_cast<std::size_t>(iteration)];
    if (moment == wanted) return false;
    std::printf("%s: %s: iteration %d is another: %s, %s in a plain run\n", name_.c_str(), what, iteration + 1,
                breve_status_name(moment.status), breve_status_name(wanted.status));
    wrong_ = true;
    return true;
  }

  const std::string name_;
  const int iterations_;
  breve::Runtime runtime_;
  breve::Program program_;
  std::vector<Moment> plain_;
  bool flat_ = false, wrong_ = false;
};

/// Whether all runs of a program were its plain run.
bool holds(const std::filesystem::path& path, int iterations) {
  const auto nothing = [](World&) {};
  const auto take_image = [](World& world) { (void)world.snapshot().or_throw(); };
  Runs runs(path, iterations);
  runs.compare("again", nothing, nothing);
  runs.compare(
      "two workers", [](World& world) { world.set_workers(2).or_throw(); }, nothing);
  runs.compare(
      "profile, trace, effects",
      [](World& world) { world.start_profile([](void*, const breve_trace_event*) {}).or_throw(); },
      [](World& world) { (void)world.effects().or_throw(); });
  if (runs.flat()) runs.begin_with_images();
  runs.compare("images taken", take_image, take_image);
  runs.compare("restored", nothing, [](World& world) { world.restore(world.snapshot().or_throw()).or_throw(); });
  runs.take_turns();
  return !runs.wrong();
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "stress_undisturbed FOLDER ITERATIONS\n");
    return 2;
  }
  std::vector<std::filesystem::path> programs;
  for (const auto& entry : std::filesystem::directory_iterator(arguments[1]))
    if (entry.path().extension() == ".tz") programs.push_back(entry.path());
  std::sort(programs.begin(), programs.end());
  bool all = !programs.empty();
  for (const std::filesystem::path& program : programs) {
    try {
      all = holds(program, std::atoi(arguments[2])) && all;
    } catch (const std::exception& error) {
      std::printf("%s: %s\n", program.filename().c_str(), error.what());
      all = false;
    }
  }
  std::printf("%zu programs\n", programs.size());
  return !all;
}
