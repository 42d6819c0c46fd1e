// The fuzzers' targets without libFuzzer: on files, or on bytes made from seeds. Usage:
//   replay TARGET FILE-OR-FOLDER…        each file (a finding: the word about it, and an abort)
//   replay TARGET --seeds FIRST COUNT    what the functions of seeds.hpp make
//   replay --program FILE                print the program that fuzz_run generates of a file
//   replay --program-of-seed SEED        the same of a seed
//   replay --selectors-of-seed SEED      print the program that fuzz_select generates of a seed
//   replay --keep SEED                   the program that fuzz_run generates of a seed, as `replay text` reads it
//   replay --functions FIRST COUNT       the functions of breve.h that fuzz_call calls, and how often it does with
//   seeds replay --checksum FIRST COUNT        FNV-1a of the programs of seeds: each compiler must give the same
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "call_functions.hpp"
#include "generator.hpp"
#include "seeds.hpp"
#include "targets.hpp"

namespace {

using breve::fuzz::Bytes;

std::vector<std::uint8_t> read(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void (*target_named(std::string_view name))(Bytes) {
  if (name == "call") return breve::fuzz::fuzz_call;
  if (name == "compile") return breve::fuzz::fuzz_compile;
  if (name == "run") return breve::fuzz::fuzz_run;
  if (name == "select") return breve::fuzz::fuzz_select;
  if (name == "restore") return breve::fuzz::fuzz_restore;
  if (name == "feed") return breve::fuzz::fuzz_feed;
  if (name == "text") return breve::fuzz::fuzz_text;
  if (name == "image") return breve::fuzz::fuzz_image;
  return nullptr;
}

std::vector<std::uint8_t> bytes_for(void (*target)(Bytes), std::uint64_t seed) {
  if (target == breve::fuzz::fuzz_call) return breve::fuzz::calls_of_seed(seed);
  const bool has_courses = target == breve::fuzz::fuzz_select || target == breve::fuzz::fuzz_restore;
  return has_courses ? breve::fuzz::courses_of_seed(seed) : breve::fuzz::bytes_of_seed(seed);
}

std::string program_of(Bytes bytes) {
  breve::fuzz::Choices choices(bytes);
  breve::fuzz::skip_plan(choices);
  return breve::fuzz::generate_program(choices);
}

int show(Bytes bytes) {
  std::fputs(program_of(bytes).c_str(), stdout);
  return 0;
}

std::uint64_t number(const std::string& text) { return std::strtoull(text.c_str(), nullptr, 10); }

int show_checksum(std::uint64_t first, std::uint64_t count) {
  std::uint64_t sum = 0xcbf29ce484222325U;
  for (std::uint64_t seed = first; seed < first + count; ++seed)
    for (const char c : program_of(breve::fuzz::bytes_of_seed(seed)))
      sum = (sum ^ static_cast<std::uint8_t>(c)) * 0x100000001b3U;
  std::printf("%016llx\n", static_cast<unsigned long long>(sum));
  return 0;
}

/// An error if one of them never succeeds: its call is worth nothing then.
int show_functions(std::uint64_t first, std::uint64_t count) {
  for (std::uint64_t seed = first; seed < first + count; ++seed)
    breve::fuzz::fuzz_call(breve::fuzz::calls_of_seed(seed));
  int result = 0;
  std::puts("function                                     calls succeeded from callbacks");
  for (std::size_t i = 0; i < breve::fuzz::all_functions().size(); ++i) {
    const breve::fuzz::Tally& tally = breve::fuzz::tallies()[i];
    const bool works = tally.succeeded != 0 || count == 0;
    std::printf("%-40s %9zu %9zu %9zu%s\n", breve::fuzz::all_functions()[i].name, tally.calls, tally.succeeded,
                tally.called_back, works ? "" : " never succeeds");
    if (!works) result = 1;
  }
  return result;
}

/// Files in the order of their names.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() == 2 && arguments[0] == "--program") return show(read(arguments[1]));
  if (arguments.size() == 2 && arguments[0] == "--program-of-seed")
    return show(breve::fuzz::bytes_of_seed(number(arguments[1])));
  if (arguments.size() == 2 && arguments[0] == "--selectors-of-seed") {
    std::fputs(breve::fuzz::select_program_of(breve::fuzz::courses_of_seed(number(arguments[1]))).c_str(), stdout);
    return 0;
  }
  if (arguments.size() == 2 && arguments[0] == "--keep") {
    std::fputs(breve::fuzz::kept_program_of(breve::fuzz::bytes_of_seed(number(arguments[1]))).c_str(), stdout);
    return 0;
  }
  if (arguments.size() == 3 && arguments[0] == "--checksum")
    return show_checksum(number(arguments[1]), number(arguments[2]));
  if (arguments.size() == 3 && arguments[0] == "--functions")
    return show_functions(number(arguments[1]), number(arguments[2]));
  auto* const target = arguments.size() >= 2 ? target_named(arguments[0]) : nullptr;
  if (!target) {
    std::fputs("usage: replay TARGET FILE-OR-FOLDER... | TARGET --seeds FIRST COUNT | --program FILE\n", stderr);
    return 2;
  }
  std::size_t done = 0;
  if (arguments.size() == 4 && arguments[1] == "--seeds") {
    const auto first = number(arguments[2]);
    const auto count = number(arguments[3]);
    for (; done < count; ++done) {
      std::fprintf(stderr, "seed %llu\n", static_cast<unsigned long long>(first + done));
      target(bytes_for(target, first + done));
    }
  } else {
    for (std::size_t i = 1; i < arguments.size(); ++i)
      for (const auto& file : files_of(arguments[i])) {
        std::fprintf(stderr, "%s\n", file.c_str());
        target(read(file));
        ++done;
      }
  }
  std::size_t calls = 0;
  for (const breve::fuzz::Tally& tally : breve::fuzz::tallies()) calls += tally.calls;
  if (calls != 0) std::printf("%zu calls\n", calls);
  const std::size_t programs = breve::fuzz::selected_programs();
  if (programs != 0) std::printf("%zu programs\n", programs);
  std::printf("%zu inputs, no finding\n", done);
  return done != 0 ? 0 : 1;
}
