// Runs the `breve` command on every .tz program under a folder and holds its output against the expectations that
// stand in the program's own comments (README.md lists them). One process per program: a program that crashes or hangs
// fails alone, and what is tested is what a user runs.
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <mutex>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

extern char** environ;

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

#ifdef __OPTIMIZE__
constexpr auto kTimeLimit = std::chrono::seconds(60);
#else
constexpr auto kTimeLimit = std::chrono::seconds(600);
#endif
constexpr unsigned kWorkers = 2;
constexpr std::size_t kShownBytes = 1500;  // of a failing program's stderr

/// A line that stdout must have: literally, or as a regular expression.
struct ExpectedLine {
  std::string text;
  bool is_pattern = false;
};

/// Something that stderr must hold, at a line and column of the program if they are not 0.
struct ExpectedDiagnostic {
  enum class Kind { Error, Warning, Report } kind = Kind::Error;
  int line = 0, column = 0;
  std::string text;
};

struct Expectations {
  std::vector<ExpectedLine> output;
  std::vector<ExpectedDiagnostic> diagnostics;
  bool no_warnings = false, strict = false;
  std::string iterations = "3";
  std::vector<std::string> arguments;
  std::optional<int> stated_status;

  int status() const {
    if (stated_status) return *stated_status;
    const bool fails = std::any_of(diagnostics.begin(), diagnostics.end(), [](const ExpectedDiagnostic& d) {
      return d.kind == ExpectedDiagnostic::Kind::Error;
    });
    return fails ? 1 : 0;
  }
};

struct Program {
  fs::path file;
  std::string name;  // relative to the folder, without .tz; of a folder with a main.tz: the folder
};

struct Run {
  bool timed_out = false;
  int status = -1, signal = 0;
  std::string out, err;
};

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Lines by LF; a last line without LF counts, CR at the end of a line does not belong to it.
std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    lines.push_back(line);
  }
  return lines;
}

std::string replace_all(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// What follows `mark` in `line`; blanks at the end do not count, a final \s stands for one that does.
std::optional<std::string> after(const std::string& line, std::string_view mark) {
  const auto at = line.find(mark);
  if (at == std::string::npos) return std::nullopt;
  std::string rest = line.substr(at + mark.size());
  while (!rest.empty() && (rest.back() == ' ' || rest.back() == '\t')) rest.pop_back();
  if (rest.size() >= 2 && rest.ends_with("\\s")) rest.replace(rest.size() - 2, 2, " ");
  return rest;
}

/// "here: TEXT" and "LINE[:COLUMN]: TEXT" after "# expect error ".
std::optional<ExpectedDiagnostic> placed(ExpectedDiagnostic::Kind kind, const std::string& rest, int line) {
  static const std::regex pattern("(?:here|([0-9]+)(?::([0-9]+))?): ?(.*)");
  std::smatch match;
  if (!std::regex_match(rest, match, pattern)) return std::nullopt;
  ExpectedDiagnostic d;
  d.kind = kind;
  d.line = match[1].matched ? std::stoi(match[1]) : line;
  d.column = match[2].matched ? std::stoi(match[2]) : 0;
  d.text = match[3];
  return d;
}

void read_expectation(const std::string& line, int number, Expectations& to) {
  using Kind = ExpectedDiagnostic::Kind;
  if (const auto text = after(line, "# expect: ")) return to.output.push_back({*text, false});
  if (line.ends_with("# expect:")) return to.output.push_back({"", false});
  if (const auto text = after(line, "# expect match: ")) return to.output.push_back({*text, true});
  const std::pair<const char*, Kind> kinds[] = {
      {"# expect error", Kind::Error}, {"# expect warning", Kind::Warning}, {"# expect report", Kind::Report}};
  for (const auto& [mark, kind] : kinds) {
    if (const auto text = after(line, std::string(mark) + ": ")) return to.diagnostics.push_back({kind, 0, 0, *text});
    const auto rest = after(line, std::string(mark) + " ");
    if (!rest) continue;
    if (const auto diagnostic = placed(kind, *rest, number)) return to.diagnostics.push_back(*diagnostic);
  }
  if (line.starts_with("# no warnings")) to.no_warnings = true;
  if (line.find("\t# no warnings") != std::string::npos) to.no_warnings = true;
  if (line.starts_with("# strict")) to.strict = true;
  if (line.starts_with("# status: ")) to.stated_status = std::stoi(*after(line, "# status: "));
  if (line.starts_with("# iterations: ")) to.iterations = *after(line, "# iterations: ");
  if (line.starts_with("# arguments: ")) {
    std::istringstream words(*after(line, "# arguments: "));
    for (std::string word; words >> word;) to.arguments.push_back(word);
  }
}

Expectations read_expectations(const fs::path& file) {
  Expectations expectations;
  int number = 0;
  // A lone CR also ends a line of steve.
  for (const std::string& line : split_lines(replace_all(replace_all(read_file(file), "\r\n", "\n"), "\r", "\n")))
    read_expectation(line, ++number, expectations);
  return expectations;
}

/// Programs under `folder` whose name contains `filter`, by name. A folder with a main.tz is one program.
std::vector<Program> find_programs(const fs::path& folder, const std::string& filter) {
  std::vector<Program> found;
  for (auto it = fs::recursive_directory_iterator(folder); it != fs::recursive_directory_iterator(); ++it) {
    const fs::path& path = it->path();
    if (it->is_directory()) {
      if (!fs::exists(path / "main.tz")) continue;
      it.disable_recursion_pending();
      found.push_back({path / "main.tz", fs::relative(path, folder).string()});
    } else if (path.extension() == ".tz") {
      found.push_back({path, fs::relative(path, folder).replace_extension().string()});
    }
  }
  std::erase_if(found, [&](const Program& p) { return p.file.string().find(filter) == std::string::npos; });
  std::sort(found.begin(), found.end(), [](const Program& a, const Program& b) { return a.name < b.name; });
  return found;
}

/// A new directory that goes with all it holds.
class ScratchDirectory {
 public:
  ScratchDirectory() {
    std::string pattern = (fs::temp_directory_path() / "breve-suite-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("cannot create a scratch directory: " + pattern);
    path_ = pattern;
  }
  ~ScratchDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Wait for `child`, killing it when the time limit is over.
void wait_for(pid_t child, Run& run) {
  const auto deadline = Clock::now() + kTimeLimit;
  int status = 0;
  auto pause = std::chrono::microseconds(500);
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (Clock::now() > deadline) {
      run.timed_out = true;
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return;
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(pause * 2, std::chrono::microseconds(20000));
  }
  if (WIFEXITED(status)) run.status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) run.signal = WTERMSIG(status);
}

/// Start the command with its output in two files; it reads nothing.
Run spawn(const std::vector<std::string>& words, const fs::path& directory, const fs::path& logs) {
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const fs::path out = logs / "stdout", err = logs / "stderr";

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addchdir_np(&actions, directory.c_str());
  pid_t child = 0;
  const int failure = posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  Run run;
  if (failure != 0) {
    run.err = "cannot start " + words[0] + "\n";
    return run;
  }
  wait_for(child, run);
  run.out = read_file(out);
  run.err = read_file(err);
  return run;
}

/// Run a copy of the program in a directory of its own, so that what it writes goes nowhere else.
Run run_program(const fs::path& command, const Program& program, const Expectations& expectations) {
  const ScratchDirectory scratch, logs;
  if (program.file.filename() == "main.tz")
    fs::copy(program.file.parent_path(), scratch.path(), fs::copy_options::recursive);
  else
    fs::copy(program.file, scratch.path() / program.file.filename());
  std::vector<std::string> words{command.string(), "run", "--allow-system", program.file.filename().string()};
  words.insert(words.end(), expectations.arguments.begin(), expectations.arguments.end());
  words.insert(words.end(), {"--iterations", expectations.iterations, "--seed", "1"});
  if (expectations.strict) words.emplace_back("--strict");
  return spawn(words, scratch.path(), logs.path());
}

bool matches(const ExpectedLine& expected, const std::string& line) {
  return expected.is_pattern ? std::regex_match(line, std::regex(expected.text)) : expected.text == line;
}

/// Both sides of the first line that differs, or "".
std::string compare_output(const std::vector<ExpectedLine>& expected, const std::string& text) {
  const std::vector<std::string> lines = split_lines(text);
  for (std::size_t i = 0; i < std::max(expected.size(), lines.size()); ++i) {
    if (i < expected.size() && i < lines.size() && matches(expected[i], lines[i])) continue;
    std::ostringstream out;
    out << "  output line " << i + 1 << "\n    expected: "
        << (i >= expected.size() ? "(no more lines)"
                                 : (expected[i].is_pattern ? "match " : "") + expected[i].text + "|")
        << "\n    got:      " << (i >= lines.size() ? "(no more lines)" : lines[i] + "|") << "\n";
    return out.str();
  }
  return "";
}

bool is_found(const ExpectedDiagnostic& expected, const std::string& file, const std::string& text) {
  if (text.find(expected.text) == std::string::npos) return false;
  if (expected.kind == ExpectedDiagnostic::Kind::Warning && text.find("warning") == std::string::npos) return false;
  if (expected.line == 0) return true;
  std::string place = file + ":" + std::to_string(expected.line) + ":";
  if (expected.column != 0) place += std::to_string(expected.column) + ":";
  return text.find(place) != std::string::npos;
}

std::string compare_diagnostics(const Expectations& expectations, const std::string& file, const std::string& text) {
  std::ostringstream out;
  for (const ExpectedDiagnostic& expected : expectations.diagnostics) {
    if (is_found(expected, file, text)) continue;
    const char* const names[] = {"error", "warning", "report"};
    out << "  missing " << names[static_cast<int>(expected.kind)];
    if (expected.line != 0) out << " at " << expected.line << ":" << expected.column;
    out << ": " << expected.text << "\n";
  }
  if (expectations.no_warnings && text.find("warning:") != std::string::npos) out << "  there are warnings\n";
  return out.str();
}

/// The first failed expectation of a run, or "".
std::string judge(const Program& program, const Expectations& expectations, const Run& run) {
  std::ostringstream out;
  if (run.timed_out) out << "  ran longer than " << kTimeLimit.count() << " s\n";
  if (run.signal != 0) out << "  killed by signal " << run.signal << "\n";
  if (!run.timed_out && run.signal == 0 && run.status != expectations.status())
    out << "  exit status " << run.status << ", expected " << expectations.status() << "\n";
  out << compare_output(expectations.output, run.out);
  out << compare_diagnostics(expectations, program.file.filename().string(), run.err);
  if (!out.str().empty() && !run.err.empty())
    out << "  stderr:\n    " << replace_all(run.err.substr(0, kShownBytes), "\n", "\n    ") << "\n";
  return out.str();
}

int run_all(const fs::path& command, const std::vector<Program>& programs) {
  std::vector<std::string> verdicts(programs.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < programs.size(); i = next++) {
      try {
        const Expectations expectations = read_expectations(programs[i].file);
        verdicts[i] = judge(programs[i], expectations, run_program(command, programs[i], expectations));
      } catch (const std::exception& e) {
        verdicts[i] = std::string("  ") + e.what() + "\n";
      }
    }
  };
  {
    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < kWorkers; ++i) workers.emplace_back(work);
  }
  std::size_t failed = 0;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    if (verdicts[i].empty()) continue;
    ++failed;
    std::cout << "FAILED " << programs[i].name << "\n" << verdicts[i];
  }
  std::cout << programs.size() - failed << " passed, " << failed << " failed\n";
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::cerr << "usage: steve_suite BREVE FOLDER [PART-OF-PATH]\n";
    return 2;
  }
  const fs::path command = fs::absolute(argv[1]);
  const std::vector<Program> programs = find_programs(argv[2], argc == 4 ? argv[3] : "");
  if (programs.empty()) {
    std::cerr << "no programs found under " << argv[2] << "\n";
    return 2;
  }
  return run_all(command, programs);
}
