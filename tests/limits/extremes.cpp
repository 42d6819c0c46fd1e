// Calls natives with extreme arguments, and measures how long each takes: under a budget, and where a host interrupts
// it.
//
//   limits_extremes budget     each is over within 0.2 s of processor time under a budget of 1,000,000
//   limits_extremes interrupt  each that has no budget ends within 50 ms after breve_world_interrupt
//   limits_extremes table      the table of docs/limits.md
//   limits_extremes refused    what refuses each call that is made of it: its work is not measured
//   limits_extremes all        `budget`, the table and what is refused, of one pass
// A second argument runs the programs about that class alone ("Image", "functions", "language").
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "../fuzz/support.hpp"
#include "extreme_cases.hpp"
#include "files_to_load.hpp"
#include "watch.hpp"

namespace breve::limits {
namespace {

constexpr double kShown = 0.1;  // s, in the table

/// The worst that was seen of each name.
struct Worst {
  double time = 0;
  std::string statement;
  bool works = false;   // one of its calls ended without an error, or by the budget
  std::string refusal;  // what the last of the others said
};

std::string first_line(const char* text) {
  constexpr std::size_t kMost = 160;
  const std::string_view whole = text;
  return std::string(whole.substr(0, std::min(whole.find('\n'), kMost)));
}

class Extremes {
 public:
  Extremes(bool interrupts, std::string only) : interrupts_(interrupts), only_(std::move(only)), watch_(interrupts) {
    char name[] = "/tmp/breve-extremes-XXXXXX";
    fuzz::require(mkdtemp(name) != nullptr, "no folder to write to");
    folder_ = name;
    breve_runtime_config config = breve_runtime_config_default();
    constexpr std::uint64_t kMostBytes = 64 << 20;
    fuzz::require(breve_files_add_directory(name, true, kMostBytes, &config.files) == BREVE_OK, "no files");
    config.rights = BREVE_RIGHT_SLEEP | BREVE_RIGHT_REAL_TIME | BREVE_RIGHT_ENTROPY;
    runtime_ = fuzz::make_runtime(config);
    breve_files_release(&config.files);
  }
  ~Extremes() { std::filesystem::remove_all(folder_); }

  void run() {
    for (const ExtremeProgram& program : extreme_programs())
      if (only_.empty() || program.about == only_) run(program);
  }
  const std::map<std::string, Worst>& worst() const { return worst_; }
  std::size_t calls() const { return calls_; }

 private:
  fuzz::World make_world(const ExtremeProgram& text, const breve_program* program) {
    breve_world_config config = breve_world_config_default();
    config.memory_limit = kMemory;
    config.budget = interrupts_ ? 0 : kBudget;
    breve_world* world = nullptr;
    if (breve_world_create(runtime_.get(), program, &config, &world) != BREVE_OK)
      fuzz::finding(breve_runtime_last_error(runtime_.get())->text, text.about);
    return fuzz::World(world);
  }

  void run(const ExtremeProgram& text) {
    breve_program* compiled = nullptr;
    if (breve_program_compile(runtime_.get(), "extremes.tz", text.text.data(), text.text.size(), &compiled) != BREVE_OK)
      fuzz::finding(breve_runtime_last_error(runtime_.get())->text, text.about);
    const fuzz::Program program(compiled);
    write_files_to_load(folder_);  // anew: a case may have written to them
    fuzz::World world;
    for (std::size_t i = 0; i < text.cases.size(); ++i) {
      const std::string method = "case-" + std::to_string(i);
      const auto time_case = [&] {
        return least_of_tries(interrupts_ ? kLongestAfter : kLongest, [&] {
          world = make_ready(text, program.get(), std::move(world));
          return time(world.get(), text.cases[i].name, method);
        });
      };
      double least = time_case();
      // What earlier cases have done to the world may be why one is refused.
      if (text.cases[i].fits && !works()) {
        world.reset();
        least = std::max(least, time_case());
      }
      Worst& worst = worst_[text.cases[i].name];
      if (least > worst.time) {
        worst.time = least;
        worst.statement = text.cases[i].statement;
      }
      worst.works = worst.works || works();
      if (status_ != BREVE_OK && world) worst.refusal = first_line(breve_world_last_error(world.get())->text);
    }
  }

  /// A world whose values are made: this one, if it is as it should be.
  fuzz::World make_ready(const ExtremeProgram& text, const breve_program* program, fuzz::World world) {
    if (world && is_ready(world.get())) return world;
    world = make_world(text, program);
    if (!is_ready(world.get()) && unmade_.insert(text.text).second)
      std::printf("%s is not made: %s\n", text.about.c_str(),
                  first_line(breve_world_last_error(world.get())->text).c_str());
    return world;
  }

  static bool is_ready(breve_world* world) {
    const breve_object controller = breve_world_controller(world);
    bool ready = true;
    for (const char* part : {"ready", "make-arguments", "make-one", "make-peer"}) {
      // Twice: what does not fit one budget fits two.
      const auto made = [&] { return breve_object_call(world, controller, part, nullptr, 0, nullptr) == BREVE_OK; };
      ready = (made() || made()) && ready;
    }
    return ready;
  }

  bool works() const { return status_ == BREVE_OK || status_ == BREVE_ERROR_BUDGET; }

  double time(breve_world* world, const std::string& name, const std::string& method) {
    ++calls_;
    watch_.begin(world, name, name == "sleep()");
    const Used began = Used::now();
    status_ = breve_object_call(world, breve_world_controller(world), method.c_str(), nullptr, 0, nullptr);
    const Used used = Used::now() - began;
    const double after = watch_.end(used);
    if (interrupts_) return after;
    return used.time <= kShown ? used.time : Peer::idle(used, used.time);
  }

  const bool interrupts_;
  const std::string only_;
  std::string folder_;
  fuzz::Runtime runtime_;
  Watch watch_;
  std::map<std::string, Worst> worst_;
  std::set<std::string> unmade_;  // programs whose objects could not be made
  std::size_t calls_ = 0;
  breve_status status_ = BREVE_OK;  // of the call that was made last
};

std::vector<std::pair<std::string, Worst>> slowest_first(const std::map<std::string, Worst>& worst) {
  std::vector<std::pair<std::string, Worst>> sorted(worst.begin(), worst.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second.time > b.second.time; });
  return sorted;
}

void print_table(const Extremes& extremes) {
  std::printf("| what | worst time, ms | statement |\n| --- | ---: | --- |\n");
  std::size_t others = 0;
  for (const auto& [name, worst] : slowest_first(extremes.worst())) {
    if (worst.time < kShown)
      ++others;
    else
      std::printf("| `%s` | %.0f | `%s` |\n", name.c_str(), 1e3 * worst.time, worst.statement.c_str());
  }
  std::printf("| %zu others | < %.0f | |\n", others, 1e3 * kShown);
}

std::size_t refused(const Extremes& extremes, bool print) {
  std::size_t count = 0;
  for (const auto& [name, worst] : extremes.worst()) {
    if (worst.works) continue;
    ++count;
    if (print) std::printf("%s: %s\n", name.c_str(), worst.refusal.c_str());
  }
  return count;
}

int run(std::string_view mode, const std::string& only) {
  const bool interrupts = mode == "interrupt";
  Extremes extremes(interrupts, only);
  extremes.run();
  if (mode == "table" || mode == "all") print_table(extremes);
  const std::size_t unseen = refused(extremes, mode == "refused" || mode == "all");
  if (mode == "table" || mode == "refused") return 0;
  const double bound = interrupts ? kLongestAfter : kLongest;
  int failed = 0;
  for (const auto& [name, worst] : slowest_first(extremes.worst())) {
    if (worst.time <= bound) break;
    std::printf("%s takes %.0f ms: %s\n", name.c_str(), 1e3 * worst.time, worst.statement.c_str());
    ++failed;
  }
  std::printf("%zu calls of %zu natives, %d of them take longer than %.0f ms\n", extremes.calls(),
              extremes.worst().size(), failed, 1e3 * bound);
  // Abstract classes, pointers, what the host does not allow: more would mean that arguments do not fit any more.
  constexpr std::size_t kMostUnseen = 210;
  const bool many = !interrupts && only.empty() && unseen > kMostUnseen;
  if (many) std::printf("%zu natives refuse each call (at most %zu): see `refused`\n", unseen, kMostUnseen);
  return failed == 0 && !many ? 0 : 1;
}

}  // namespace
}  // namespace breve::limits

int main(int count, char** arguments) {
  const std::string_view mode = count > 1 ? arguments[1] : "";
  if (mode != "budget" && mode != "interrupt" && mode != "table" && mode != "refused" && mode != "all") {
    std::fprintf(stderr, "limits_extremes budget|interrupt|table|refused|all [CLASS]\n");
    return 2;
  }
  return breve::limits::run(mode, count > 2 ? arguments[2] : "");
}
