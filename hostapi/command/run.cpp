// The loop of `breve run`, and what it tells before, during and after.
#include "run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <ctime>
#include <optional>
#include <random>
#include <stdexcept>
#include <thread>

#include "interventions.hpp"
#include "live.hpp"
#include "log_file.hpp"
#include "profile.hpp"
#include "report.hpp"
#include "session.hpp"
#include "sound.hpp"
#include "watch.hpp"

namespace breve::command {

namespace {

using Clock = std::chrono::steady_clock;

// A signal handler can reach nothing but a global of this type.
volatile std::sig_atomic_t interrupted = 0;

/// The first SIGINT asks for an end after the iteration; a second one ends the process.
void watch_for_interrupt() {
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// "45 s", "2 min 5 s", "3 h 20 min"
std::string time_words(double seconds) {
  if (!(seconds < 1e9)) return "a very long time";
  const auto whole = std::llround(std::max(0.0, seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

/// A line on the terminal about a run that takes long.
class Progress {
 public:
  Progress(const RunOptions& options, Output& output) : options_(options), output_(output) {}

  void show(const breve_world* world) {
    if (options_.quiet || options_.live || !output_.shows_progress()) return;
    const auto now = Clock::now();
    if (now < next_) return;
    next_ = now + kEvery;
    const auto iteration = breve_world_iteration(world);
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double time = breve_world_time(world);
    std::string of;
    double done = 0;  // part of the whole
    if (options_.iterations) {
      of = fmt::format(" of {}", *options_.iterations);
      done = static_cast<double>(iteration) / static_cast<double>(*options_.iterations);
    }
    if (options_.seconds) {
      done = time / *options_.seconds;
      of = fmt::format(", {:.0f} % of {} s", 100 * done, *options_.seconds);
    }
    const std::string left = done > 0 ? ", " + time_words(elapsed * (1 - done) / done) + " to go" : "";
    // What matters most first: a narrow terminal shows the beginning.
    output_.progress(fmt::format("iteration {}{}{}, {:.3g} x real time, {:.2f} s simulated, {:.0f} iterations/s",
                                 iteration, of, left, time / elapsed, time, static_cast<double>(iteration) / elapsed));
  }

 private:
  static constexpr auto kPatience = std::chrono::seconds(2);  // a shorter run shows nothing
  static constexpr auto kEvery = std::chrono::milliseconds(250);
  const RunOptions& options_;
  Output& output_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_ + kPatience;
};

bool is_over(const breve_world* world, const RunOptions& options, const Output& output) {
  if (breve_world_ended(world) || interrupted != 0 || !output.open()) return true;
  if (options.iterations && breve_world_iteration(world) >= *options.iterations) return true;
  // Sums of a decimal step fall short by rounding: that must not cause an additional iteration.
  constexpr double kRounding = 1e-6;  // of a step
  return options.seconds && breve_world_time(world) >= *options.seconds - kRounding * breve_world_iteration_step(world);
}

/// With --watch a program that failed waits for its files to be mended. False: interrupted.
bool mended(breve_world* world, Reloader& reloader, Output& output) {
  if (const breve_error* error = breve_world_last_error(world)) output.complain(error->text);
  output.complain("breve: waiting for the program to change\n");
  while (interrupted == 0 && output.open()) {
    if (reloader.look(world)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

/// The observers that read the world at its beginning and after each iteration.
struct Lookers {
  std::optional<Recorder> recorder;
  std::optional<Plotter> plotter;
  std::optional<SoundWriter> sound;
  std::optional<LiveView> live;

  Lookers(breve_runtime* runtime, const RunOptions& options, Output& output) {
    if (options.record.any()) recorder.emplace(runtime, options.record, output);
    if (!options.sound.empty()) sound.emplace(options.sound);
    if (!options.plot.names.empty() && options.plot.plot.empty() && options.plot.log.empty() && !options.live)
      throw std::runtime_error("--plot: nothing shows these values; add --plot-to OUT.svg, --log OUT.csv or --live");
    if (!options.plot.names.empty()) plotter.emplace(options.plot);
    if (!options.live) return;
    if (!output.shows_progress())
      output.complain("breve: --live needs a terminal: nothing is shown\n");
    else
      live.emplace(runtime, options.record.plain, output);
  }
  const Series* series() const { return plotter ? &plotter->series() : nullptr; }
  void look(breve_world* world) {
    if (plotter) plotter->look(world);
    if (recorder) recorder->look(world);
    if (sound) sound->listen(world);
    if (live) live->look(world, series());
  }
  void finish(breve_world* world) {
    if (plotter) plotter->finish();
    if (recorder) recorder->finish(world);
    if (sound) sound->finish();
    if (live) live->finish(world, series());
  }
};

/// @param reloader  may be null: nothing is watched
breve_status iterate(breve_world* world, const RunOptions& options, Reloader* reloader, Interventions& interventions,
                     Lookers& lookers, Output& output) {
  Progress progress(options, output);
  lookers.look(world);
  while (!is_over(world, options, output)) {
    if (reloader) reloader->look(world);
    const breve_status status = breve_world_step(world);
    interventions.take(world, options.verbose && !options.quiet ? &output : nullptr);
    if (status != BREVE_OK) {
      if (!reloader || status == BREVE_ERROR_MEMORY) return status;
      if (!mended(world, *reloader, output)) return BREVE_OK;
    }
    lookers.look(world);
    output.flush_sometimes();
    progress.show(world);
  }
  return BREVE_OK;
}

// A seed that a script can read as an int.
std::uint64_t draw_seed() { return std::random_device()() & 0x7fffffffU; }

constexpr double kLongIteration = 10;  // s that an iteration may take before its position is reported

/// Each of --set has a name and a '='. Otherwise that is reported.
bool are_settings(const std::vector<std::string>& given, Output& output) {
  for (const auto& setting : given)
    if (const std::size_t equal = setting.find('='); equal == 0 || equal == std::string::npos) {
      output.complain(fmt::format("breve: --set: '{}' is not of the form NAME=VALUE\n", setting));
      return false;
    }
  return true;
}

/// What --set gives, taken apart at the first '='.
class Settings {
 public:
  explicit Settings(const std::vector<std::string>& given) {
    for (const auto& text : given) {
      const std::size_t equal = text.find('=');
      names_.push_back(text.substr(0, equal));
      values_.push_back(text.substr(equal + 1));
    }
    for (std::size_t i = 0; i < names_.size(); ++i) list_.push_back({names_[i].c_str(), values_[i].c_str()});
  }
  void configure(breve_world_config& config) const {
    config.settings = list_.data();
    config.setting_count = list_.size();
  }

 private:
  std::vector<std::string> names_, values_;
  std::vector<breve_setting> list_;
};

void say_where_it_stopped(const breve_world* world, const RunOptions& options, std::uint64_t seed, Output& output) {
  const breve_error* error = breve_world_last_error(world);
  if (!error) return;
  output.complain(error->text);
  if (options.quiet) return;
  const std::uint64_t iterations = breve_world_iteration(world);
  output.complain(fmt::format("breve: stopped after {} iteration{}, {:.6g} s simulated; --seed {} reproduces it\n",
                              iterations, iterations == 1 ? "" : "s", breve_world_time(world), seed));
}

void say_what_went_on(const breve_world* world, const RunOptions& options, const Interventions& interventions,
                      Output& output) {
  if (!options.quiet) output.complain(interventions.summary());
  breve_stats stats = breve_stats_default();
  if (options.quiet || breve_world_stats(world, &stats) != BREVE_OK || stats.errors == 0) return;
  output.complain(
      fmt::format("breve: {} run-time error{} did not stop the run\n", stats.errors, stats.errors == 1 ? "" : "s"));
}

}  // namespace

ExitStatus exit_status(breve_status status) {
  switch (status) {
    case BREVE_OK: return kEndedWell;
    case BREVE_ERROR_MEMORY:
    case BREVE_ERROR_BUDGET:
    case BREVE_ERROR_DEPTH: return kLimitHit;
    default: return kFailed;
  }
}

WorldHandle make_world(const Session& session, const breve_program* program, const RunOptions& options,
                       std::uint64_t seed, Profiling* profiling, breve_status& status) {
  std::vector<const char*> arguments{options.file.c_str()};
  for (const auto& argument : options.arguments) arguments.push_back(argument.c_str());
  breve_world_config config = breve_world_config_default();
  config.seed = seed;
  config.arguments = arguments.data();
  config.argument_count = arguments.size();
  config.strict = options.strict;
  config.coarse_random = options.coarse_random;
  config.verbose = options.verbose;
  config.accuracy = options.accuracy.empty() ? nullptr : options.accuracy.c_str();
  config.budget = options.budget.value_or(0);
  config.physics_budget = options.physics_budget.value_or(0);
  config.memory_limit = static_cast<std::size_t>(options.memory.value_or(0)) * 1024 * 1024;
  config.depth_limit = options.depth.value_or(0);
  config.patience = kLongIteration;
  const Settings settings(options.settings);
  settings.configure(config);
  if (profiling) profiling->configure(config);
  breve_world* world = nullptr;
  status = breve_world_create(session.runtime(), program, &config, &world);
  return WorldHandle(world);
}

int run(const RunOptions& options, Output& output) {
  Session session(output, options.paths, options.quiet, options.strict, &options.access);
  ProgramHandle program;
  if (!are_settings(options.settings, output)) return kWrongUsage;
  if (const ExitStatus loaded = session.load(options.file, program); loaded != kEndedWell) return loaded;

  const std::uint64_t seed = options.seed ? *options.seed : draw_seed();
  if (!options.seed && !options.quiet) output.complain(fmt::format("breve: seed {}\n", seed));
  watch_for_interrupt();
  const auto wall_start = Clock::now();
  const double cpu_start = cpu_seconds();

  breve_status status = BREVE_OK;
  Profiling profiling(options);
  const WorldHandle world = make_world(session, program.get(), options, seed, &profiling, status);
  if (!world) {
    const breve_error* error = breve_runtime_last_error(session.runtime());
    // A wrong option has no position in a file, which other errors begin with.
    if (error && status == BREVE_ERROR_ARGUMENT) output.complain("breve: ");
    output.complain(error ? error->text : "breve: cannot make the world\n");
    profiling.finish(nullptr, output);
    return exit_status(status);
  }
  std::optional<Reloader> reloader;
  if (options.watch) reloader.emplace(session, output, options.file);
  Interventions interventions;
  int result = kEndedWell;
  const auto complain = [&](const std::exception& e) {
    output.complain(fmt::format("breve: {}\n", e.what()));
    result = kFailed;
  };
  try {
    std::optional<LogFile> log;
    if (!options.log.empty()) log.emplace(options, seed, world.get());
    Lookers lookers(session.runtime(), options, output);
    status = iterate(world.get(), options, reloader ? &*reloader : nullptr, interventions, lookers, output);
    lookers.finish(world.get());
    if (log) log->finish(world.get());
  } catch (const std::exception& e) {
    complain(e);
  }
  const RunTimes times{std::chrono::duration<double>(Clock::now() - wall_start).count(), cpu_seconds() - cpu_start};
  if (status != BREVE_OK) say_where_it_stopped(world.get(), options, seed, output);
  if (status != BREVE_OK) result = exit_status(status);
  say_what_went_on(world.get(), options, interventions, output);
  if (!options.positions.empty()) {
    try {
      write_positions(world.get(), options.positions);
    } catch (const std::exception& e) {
      complain(e);
    }
  }
  if (options.effects) output.print(effects_table(world.get()));
  if (options.hash) output.print(hash_line(world.get()));
  output.flush();
  if (!profiling.finish(world.get(), output) && result == kEndedWell) result = kFailed;
  if (options.stats) output.complain(stats_line(world.get(), times, seed, interventions));
  return result;
}

}  // namespace breve::command
