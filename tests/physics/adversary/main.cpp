// Looks for creatures that gain unexplained energy or momentum. `adversary --help` says how.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "search.hpp"

namespace {

using namespace adversary;

struct Options {
  std::string rung = "all", family = "all", replay, shrink, measure, output;
  std::uint64_t seed = 1;
  int evaluations = 140, print_case = -1;
  double seconds = 10, rate = 60, work = 3e7;
  bool verbose = false, random = false;
};

constexpr const char* kRungs[] = {"fast", "balanced", "precise", "reference", "conserving"};

std::vector<breve_rung> rungs_of(const Options& options) {
  std::vector<breve_rung> out;
  for (int i = 0; i < 5; ++i)
    if (options.rung == "all" || options.rung == kRungs[i]) out.push_back(static_cast<breve_rung>(i));
  if (out.empty()) throw std::runtime_error("there is no rung '" + options.rung + "'");
  return out;
}

std::vector<Family> families_of(const Options& options) {
  std::vector<Family> out;
  for (int i = 0; i < kFamilies; ++i)
    if (options.family == "all" || options.family == name_of(static_cast<Family>(i)))
      out.push_back(static_cast<Family>(i));
  if (out.empty()) throw std::runtime_error("there is no family '" + options.family + "'");
  return out;
}

Case load(const std::string& name) {
  std::ostringstream text;
  if (name == "-") {
    text << std::cin.rdbuf();
  } else {
    std::ifstream file(name);
    if (!file) throw std::runtime_error("cannot open " + name);
    text << file.rdbuf();
  }
  return read_case(text.str());
}

Setting setting_of(const Options& options, breve_rung rung) {
  return {rung, options.seconds, 1 / options.rate, options.verbose, options.work};
}

/// Prints the measures; those over their bounds are marked. Returns how many are.
int tell(const char* title, const Verdict& verdict, breve_rung rung) {
  int over = 0;
  std::printf("%-10s %s: scale %.4g J, gained %.4g J, guard acted %llu times, %.2f s of CPU, work %.3g%s\n",
              kRungs[rung], title, verdict.scale, verdict.gained,
              static_cast<unsigned long long>(verdict.interventions), verdict.cpu, verdict.work,
              verdict.cut > 0 ? ", cut short" : "");
  if (!verdict.refused.empty()) std::printf("    refused: %s\n", verdict.refused.c_str());
  for (int i = 0; i < kMeasures; ++i) {
    const auto measure = static_cast<Measure>(i);
    const double value = verdict.found[static_cast<std::size_t>(i)];
    const bool wrong = value > bound_of(measure, rung);
    over += wrong;
    if (value > 0) std::printf("    %-8s %9.3g%s\n", name_of(measure), value, wrong ? "  over its bound" : "");
  }
  return over;
}

int replay(const Options& options) {
  const Case one = load(options.replay);
  int over = 0;
  for (const breve_rung rung : rungs_of(options))
    over += tell("replayed", run_case(one, setting_of(options, rung)), rung);
  return over != 0;
}

int shrink_file(const Options& options) {
  const Case one = load(options.shrink);
  const breve_rung rung = rungs_of(options).front();
  Setting setting = setting_of(options, rung);
  setting.tell = false;
  Measure measure = run_case(one, setting).worst(rung);
  if (!options.measure.empty() && !measure_named(options.measure, measure))
    throw std::runtime_error("there is no measure '" + options.measure + "'");
  const Case small = shrink(one, setting, measure, setting.seconds);
  const Verdict verdict = run_case(small, setting);
  std::printf("# %s, %s %.3g in %g s\n%s", kRungs[rung], name_of(measure), verdict.found[measure], setting.seconds,
              write_case(small).c_str());
  return 0;
}

void keep(const Options& options, breve_rung rung, Family family, Measure measure, const Found& found) {
  if (options.output.empty()) return;
  std::filesystem::create_directories(options.output);
  std::ofstream file(options.output + "/" + kRungs[rung] + "-" + name_of(family) + "-" + name_of(measure) + ".case");
  file << "# evaluation " << found.number << " of seed " << options.seed << ": " << name_of(measure) << " "
       << found.verdict.found[measure] << "\n"
       << write_case(found.one);
}

/// One line for each measure that was exceeded; the worst of the others in one line.
int search_one(const Options& options, breve_rung rung, Family family, int evaluations) {
  Search is{setting_of(options, rung), family, options.seed, evaluations, options.random};
  is.setting.tell = false;
  // What overlaps shows at once what it does; later it is one of the other families.
  if (family == Family::Overlap) is.setting.seconds = std::min(is.setting.seconds, 0.5);
  double cpu = 0, slowest = 0;
  std::uint64_t interventions = 0;
  int refused = 0, guarded = 0, cut = 0;
  const auto begin = [&](const Found& found) {
    if (found.number == options.print_case) std::printf("%s", write_case(found.one).c_str()), std::fflush(stdout);
  };
  const auto look = [&](const Found& found) {
    cpu += found.verdict.cpu;
    interventions += found.verdict.interventions;
    guarded += found.verdict.interventions != 0;
    if (!found.verdict.refused.empty() && ++refused == 1) std::printf("  refused: %s\n", found.verdict.refused.c_str());
    cut += found.verdict.cut > 0;
    slowest = std::max(slowest, found.verdict.cpu);
    if (options.verbose) tell(std::to_string(found.number).c_str(), found.verdict, rung);
  };
  const Worst worst = search(is, begin, look);
  std::printf(
      "%-10s %-7s %d tried in %.1f s, the slowest %.1f s; guard acted %llu times in %d; %d cut short, %d refused\n",
      kRungs[rung], name_of(family), evaluations, cpu, slowest, static_cast<unsigned long long>(interventions), guarded,
      cut, refused);
  int over = 0;
  for (int i = 0; i < kMeasures; ++i) {
    const auto measure = static_cast<Measure>(i);
    const Found& found = worst[static_cast<std::size_t>(i)];
    if (found.number < 0) continue;
    const double value = found.verdict.found[static_cast<std::size_t>(i)], bound = bound_of(measure, rung);
    std::printf("    %-8s %9.3g %s %7.0e  (number %d, %d links, scale %.3g J, guard %llu)\n", name_of(measure), value,
                value > bound ? "EXCEEDS" : "within ", bound, found.number, found.one.count(), found.verdict.scale,
                static_cast<unsigned long long>(found.verdict.interventions));
    if (value > bound) keep(options, rung, family, measure, found), ++over;
  }
  std::fflush(stdout);
  return over;
}

int search_all(const Options& options) {
  int over = 0;
  const std::vector<Family> families = families_of(options);
  const int each = (options.evaluations + static_cast<int>(families.size()) - 1) / static_cast<int>(families.size());
  for (const breve_rung rung : rungs_of(options))
    for (const Family family : families) over += search_one(options, rung, family, each);
  std::printf("%d bounds exceeded\n", over);
  return over != 0;
}

}  // namespace

int main(int count, char** arguments) {
  Options options;
  CLI::App app("Looks for creatures that gain unexplained energy or momentum.");
  app.add_option("--rung", options.rung, "fast, balanced, precise, reference, conserving or all");
  app.add_option("--family", options.family, "drift, swim, fall, hang, drop, walk, overlap or all");
  app.add_option("--seed", options.seed, "of the search");
  app.add_option("--evaluations", options.evaluations, "creatures for each rung, shared evenly by the families");
  app.add_flag("--random", options.random, "draw every creature at random");
  app.add_option("--print-case", options.print_case, "print the creature of that number");
  app.add_option("--replay", options.replay, "run the creature in a file ('-': standard input) and judge it");
  app.add_option("--shrink", options.shrink, "make the creature in a file as small as it may be, and print it");
  app.add_option("--measure", options.measure, "what --shrink keeps: energy, momentum, …; the worst unless given");
  app.add_option("--seconds", options.seconds, "of each run");
  app.add_option("--rate", options.rate, "iterations per second");
  app.add_option("--work", options.work, "counted work of a run that is not cut short");
  app.add_option("--output", options.output, "folder for the worst creatures that exceed a bound");
  app.add_flag("--verbose", options.verbose, "tell each creature; with --replay the balance after each iteration");
  CLI11_PARSE(app, count, arguments);
  try {
    if (!options.replay.empty()) return replay(options);
    if (!options.shrink.empty()) return shrink_file(options);
    return search_all(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "adversary: %s\n", error.what());
    return 2;
  }
}
