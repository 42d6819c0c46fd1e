// What steve costs beside Lua 5.4: each program of the folder language/ in both, by breve's command and by lua5.4.
// Checks that both print the same, prints a table of CPU times and their ratios, and the geometric means. It measures
// and judges nothing: "required" is what the machine is meant to reach. Exits 1 if a program fails or the two differ.
// Usage: bench_language [PROGRAM…]   (all by default)
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace {

struct Row {
  const char* file;
  const char* what;
  double required;  // steve's time over Lua's, at most
  bool plain;       // counts in the mean of what Lua also has built in: no vectors, no world
};

constexpr Row kRows[] = {
    {"float_loop", "float loop, 1e7 turns", 0.8, true},
    {"fibonacci", "Fibonacci(30) by method calls", 1.0, true},
    {"calls", "1e7 method calls, two keywords", 0.7, true},
    {"vectors", "vector arithmetic, 1e6 turns", 0.10, false},
    {"lists", "list push and index, 1e6", 1.0, true},
    {"foreach", "foreach over a list of 1e6", 0.5, true},
    {"hashes", "hash, 1e6 string and 1e6 int keys", 0.6, true},
    {"strings", "string building, 2e5", 1.2, true},
    {"objects", "create, call, drop 2e6 objects", 1.5, true},
    {"sort", "sort 1e5, comparison method", 1.0, true},
    {"boids", "1,000 boids, 50 iterations", 0.25, false},
};
constexpr double kRequiredMean = 0.5;
constexpr double kRequiredPlainMean = 0.75;

constexpr int kRuns = 5;               // odd: the middle one counts
constexpr double kPatience = 20;       // seconds of CPU time: a program that has used so much is not run again
constexpr double kLeast = 1e-4;        // seconds: below this a difference of two CPU times says nothing
constexpr double kTolerance = 1.5e-6;  // numbers are printed with six decimals: the last one may differ by one

struct Outcome {
  double seconds = 0;  // user and system time of the process
  std::string said;
};

[[noreturn]] void become(const std::vector<std::string>& command, int output) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  if (dup2(output, STDOUT_FILENO) >= 0) execvp(words[0], words.data());
  std::perror(words[0]);
  std::_Exit(127);
}

Outcome run(const std::vector<std::string>& command) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    close(ends[0]);
    become(command, ends[1]);
  }
  close(ends[1]);
  Outcome outcome;
  std::array<char, 65536> buffer{};
  for (ssize_t got = 0; (got = read(ends[0], buffer.data(), buffer.size())) > 0;) {
    outcome.said.append(buffer.data(), static_cast<std::size_t>(got));
  }
  close(ends[0]);
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error(command.back() + ": failed");
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  outcome.seconds = seconds(used.ru_utime) + seconds(used.ru_stime);
  return outcome;
}

std::vector<std::string> steve_command(const std::string& file) {
  return {BREVE_COMMAND, "run", "--quiet", file + ".tz"};
}
std::vector<std::string> lua_command(const std::string& file) { return {"lua5.4", file + ".lua"}; }

bool same_word(const std::string& a, const std::string& b) {
  if (a == b) return true;
  char* end_a = nullptr;
  char* end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a);
  const double y = std::strtod(b.c_str(), &end_b);
  return end_a != a.c_str() && std::string_view(end_a) == end_b && std::abs(x - y) <= kTolerance;
}

bool same_text(const std::string& a, const std::string& b) {
  std::istringstream words_a(a);
  std::istringstream words_b(b);
  std::string word_a;
  std::string word_b;
  while (words_a >> word_a) {
    if (!(words_b >> word_b) || !same_word(word_a, word_b)) return false;
  }
  return !(words_b >> word_b);
}

double middle(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

struct Times {
  double steve = 0;
  double lua = 0;
};

// The two take turns, so that a busy moment of the machine meets both.
Times measure(const std::string& file) {
  std::vector<double> steve;
  std::vector<double> lua;
  double spent = 0;
  for (int i = 0; i < kRuns && spent < kPatience; ++i) {
    const Outcome ours = run(steve_command(file));
    const Outcome theirs = run(lua_command(file));
    if (!same_text(ours.said, theirs.said)) {
      throw std::runtime_error(file + ": steve and Lua print different things:\n" + ours.said.substr(0, 200) + "\n" +
                               theirs.said.substr(0, 200));
    }
    steve.push_back(ours.seconds);
    lua.push_back(theirs.seconds);
    spent += ours.seconds + theirs.seconds;
  }
  return {middle(steve), middle(lua)};
}

// The geometric mean of what was added.
class Mean {
 public:
  void add(double ratio) {
    logarithms_ += std::log(ratio);
    ++count_;
  }
  void print(const char* what, double required) const {
    if (count_ > 0) std::printf("%-36s %27.3f %9.2f\n", what, std::exp(logarithms_ / count_), required);
  }

 private:
  double logarithms_ = 0;
  int count_ = 0;
};

bool wanted(const Row& row, const std::vector<std::string>& names) {
  return names.empty() || std::find(names.begin(), names.end(), row.file) != names.end();
}

void print_table(const std::vector<std::string>& names) {
  const Times start = measure("empty");
  std::printf(
      "CPU seconds, middle of %d runs; the start-up of an empty program (steve %.4f, Lua %.4f) is taken off\n\n", kRuns,
      start.steve, start.lua);
  std::printf("%-36s %9s %9s %7s %9s\n", "program", "steve s", "Lua s", "ratio", "required");
  Mean all;
  Mean plain;
  for (const Row& row : kRows) {
    if (!wanted(row, names)) continue;
    const Times times = measure(row.file);
    const double steve = std::max(times.steve - start.steve, kLeast);
    const double lua = std::max(times.lua - start.lua, kLeast);
    const double ratio = steve / lua;
    all.add(ratio);
    if (row.plain) plain.add(ratio);
    std::printf("%-36s %9.4f %9.4f %7.3f %9.2f%s\n", row.what, steve, lua, ratio, row.required,
                ratio > row.required ? "  above" : "");
    std::fflush(stdout);
  }
  std::printf("\n");
  if (!names.empty()) return;
  all.print("geometric mean", kRequiredMean);
  plain.print("without the vectors and the boids", kRequiredPlainMean);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> names(argv + 1, argv + argc);
  for (const std::string& name : names) {
    if (std::none_of(std::begin(kRows), std::end(kRows), [&](const Row& row) { return name == row.file; })) {
      std::fprintf(stderr, "bench_language: no program \"%s\"\n", name.c_str());
      return 2;
    }
  }
  try {
    std::filesystem::current_path(BREVE_LANGUAGE_FOLDER);
    print_table(names);
  } catch (const std::exception& problem) {
    std::fflush(stdout);
    std::fprintf(stderr, "bench_language: %s\n", problem.what());
    return 1;
  }
  return 0;
}
