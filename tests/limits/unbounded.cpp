// Runs programs whose natives, or whose physics, could work for minutes, each with what it needs made by `ready` first.
//
//   limits_unbounded budget FOLDER     `ready`, `go` and two steps are over within 0.2 s of processor time each under a
//                                      budget of 1,000,000 and 256 MB, with the statuses that the program names
//   limits_unbounded interrupt FOLDER  without a budget, all but `ready` end within 50 ms after breve_world_interrupt
//   limits_unbounded statuses FOLDER   as `budget`, but only the statuses count: for machines that are busy
// A third argument runs the program of that name alone.
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "../fuzz/support.hpp"
#include "watch.hpp"

namespace breve::limits {
namespace {

/// From a program's first lines: "# expect: BREVE_ERROR_BUDGET BREVE_OK BREVE_OK", the statuses of those calls.
std::string expected_of(const std::string& text) {
  constexpr std::string_view kMark = "# expect: ";
  const std::size_t at = text.find(kMark);
  if (at == std::string::npos) return "";
  const std::size_t from = at + kMark.size();
  return text.substr(from, text.find('\n', from) - from);
}

/// What the programs read: a long file that is a single line, and a pipe into which nobody writes.
std::string folder_with_files() {
  char name[] = "/tmp/breve-unbounded-XXXXXX";
  fuzz::require(mkdtemp(name) != nullptr, "no folder to write to");
  const std::string folder = name;
  std::ofstream(folder + "/zeros").close();
  std::filesystem::resize_file(folder + "/zeros", std::uintmax_t{64} << 20);
  fuzz::require(mkfifo((folder + "/pipe").c_str(), 0600) == 0, "no pipe");
  return folder;
}

class Unbounded {
 public:
  explicit Unbounded(std::string_view mode)
      : interrupts_(mode == "interrupt"),
        timed_(mode != "statuses"),
        watch_(interrupts_),
        folder_(folder_with_files()),
        runtime_(make_runtime()) {}
  ~Unbounded() { std::filesystem::remove_all(folder_); }

  void run(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    const std::string name = path.stem().string();
    std::string statuses;
    const double least = least_of_tries(bound(), [&] {
      statuses.clear();
      return longest(text, name, statuses);
    });
    const bool right = interrupts_ || statuses == expected_of(text);
    if (!right) std::printf("%s: %s and not %s\n", name.c_str(), statuses.c_str(), expected_of(text).c_str());
    if (least > bound()) std::printf("%s takes %.0f ms: %s\n", name.c_str(), 1e3 * least, statuses.c_str());
    if (!right || least > bound()) ++failed_;
    if (least > worst_) worst_ = least, slowest_ = name;
    ++programs_;
  }

  int end() const {
    std::printf("%d programs, %d failures, the slowest: %s with %.0f ms\n", programs_, failed_, slowest_.c_str(),
                1e3 * worst_);
    return programs_ == 0 || failed_ != 0;
  }

 private:
  double bound() const {
    if (!timed_) return kHangs;
    return interrupts_ ? kLongestAfter : kLongest;
  }

  fuzz::Runtime make_runtime() const {
    breve_runtime_config config = breve_runtime_config_default();
    constexpr std::uint64_t kMostBytes = 64 << 20;
    fuzz::require(breve_files_add_directory(folder_.c_str(), true, kMostBytes, &config.files) == BREVE_OK, "no files");
    config.rights = BREVE_RIGHT_SLEEP;
    fuzz::Runtime made = fuzz::make_runtime(config);
    breve_files_release(&config.files);
    return made;
  }

  fuzz::World make_world(const breve_program* program, const std::string& name) {
    breve_world_config config = breve_world_config_default();
    config.memory_limit = kMemory;
    config.budget = interrupts_ ? 0 : kBudget;
    config.seed = 1;
    breve_world* world = nullptr;
    if (breve_world_create(runtime_.get(), program, &config, &world) != BREVE_OK)
      fuzz::finding(breve_runtime_last_error(runtime_.get())->text, name);
    return fuzz::World(world);
  }

  bool has(std::string_view method) const {
    return text_.find("+ to " + std::string(method) + ":") != std::string::npos;
  }

  static breve_status call(breve_world* world, std::string_view method) {
    return breve_object_call(world, breve_world_controller(world), method.data(), nullptr, 0, nullptr);
  }

  /// @return s of the call that took longest, or after an interrupt; less than 0: not known
  double longest(const std::string& text, const std::string& name, std::string& statuses) {
    text_ = text;
    breve_program* compiled = nullptr;
    if (breve_program_compile(runtime_.get(), "program.tz", text.data(), text.size(), &compiled) != BREVE_OK)
      fuzz::finding(breve_runtime_last_error(runtime_.get())->text, name);
    const fuzz::Program program(compiled);
    const fuzz::World world = make_world(compiled, name);
    if (interrupts_ && has("ready") && call(world.get(), "ready") != BREVE_OK)
      fuzz::finding(breve_world_last_error(world.get())->text, name);
    double longest = 0;
    for (const std::string_view what : {"ready", "go", "step", "step"}) {
      const bool steps = what == "step";
      if (!steps && (!has(what) || (interrupts_ && what == "ready"))) continue;
      watch_.begin(world.get(), name, name == "sleep");
      const Used began = Used::now();
      const breve_status status = steps ? breve_world_step(world.get()) : call(world.get(), what);
      const Used used = Used::now() - began;
      const double after = watch_.end(used);
      if (interrupts_ && after < 0) return after;
      const double taken = used.time <= kLongest ? used.time : Peer::idle(used, used.time);
      longest = std::max(longest, interrupts_ ? after : taken);
      statuses += (statuses.empty() ? "" : " ") + std::string(breve_status_name(status));
    }
    return longest;
  }

  const bool interrupts_, timed_;
  Watch watch_;
  std::string folder_;
  fuzz::Runtime runtime_;
  std::string text_;  // of the program that runs
  int programs_ = 0, failed_ = 0;
  double worst_ = 0;
  std::string slowest_;
};

}  // namespace
}  // namespace breve::limits

int main(int count, char** arguments) {
  const std::string_view mode = count > 2 ? arguments[1] : "";
  if (mode != "budget" && mode != "interrupt" && mode != "statuses") {
    std::fprintf(stderr, "limits_unbounded budget|interrupt|statuses FOLDER [NAME]\n");
    return 2;
  }
  std::vector<std::filesystem::path> programs;
  for (const auto& entry : std::filesystem::directory_iterator(arguments[2]))
    if (count < 4 || entry.path().stem() == arguments[3]) programs.push_back(entry.path());
  std::sort(programs.begin(), programs.end());
  breve::limits::Unbounded unbounded(mode);
  for (const std::filesystem::path& program : programs) unbounded.run(program);
  return unbounded.end();
}
