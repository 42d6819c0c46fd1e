// The `breve` command: what the words on the command line mean.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <csignal>
#include <functional>
#include <iostream>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "check.hpp"
#include "doc.hpp"
#include "lsp.hpp"
#include "repl.hpp"
#include "replay.hpp"
#include "run.hpp"
#include "session.hpp"
#include "viewer.hpp"

namespace {

using breve::command::AccessOptions;
using breve::command::CheckOptions;
using breve::command::DocOptions;
using breve::command::LspOptions;
using breve::command::Output;
using breve::command::ReplayOptions;
using breve::command::ReplOptions;
using breve::command::RunOptions;
using breve::command::ViewOptions;

constexpr const char* kExitStatuses =
    "Exit status: 0 success, 1 compile or run-time error, 2 wrong usage, 3 a limit was exceeded.";

/// A number, all of it; anything else is an error that says so.
template <class Number>
std::function<std::string(const std::string&)> parser(std::optional<Number>& out, const char* what) {
  return [&out, what](const std::string& text) -> std::string {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !(number >= 0) ||
        number > std::numeric_limits<Number>::max())
      return fmt::format("'{}' is not a {}", text, what);
    out = number;
    return {};
  };
}

/// An option with a number. CLI11's own conversions accept signs and say little.
template <class Number>
CLI::Option* number(CLI::App& app, const char* name, const char* type, std::optional<Number>& out, const char* what,
                    const char* help) {
  return app
      .add_option_function<std::string>(
          name, [](const std::string&) {}, help)
      ->type_name(type)
      ->check(CLI::Validator(parser(out, what), ""));
}

/// An option that may be given several times, each time with one value.
CLI::Option* several(CLI::App& app, const char* name, const char* type, std::vector<std::string>& out,
                     const std::string& help) {
  return app.add_option(name, out, help + "; may be repeated")->type_name(type)->expected(1)->take_all();
}

void describe_plugins(CLI::App& app, std::vector<std::string>& directories) {
  several(app, "--allow-plugins", "DIR", directories,
          "Let @plugin load shared libraries below DIR; they run with all your rights")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
}

void describe_access(CLI::App& app, AccessOptions& o) {
  several(app, "--allow-read", "DIR", o.read,
          "Let the program read files below DIR, as it may below the current directory, its own and those of --path")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  several(app, "--allow-write", "DIR", o.write,
          "Let the program write and read files below DIR, as it may below the current directory")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  app.add_flag("--no-files", o.no_files, "Do not let the program read or write files")
      ->excludes("--allow-read")
      ->excludes("--allow-write");
  app.add_flag("--allow-system", o.system, "Let the program run commands of the operating system");
  app.add_flag("--allow-network", o.network, "Let the program open servers and send requests, on this machine only");
  app.add_option("--network-address", o.network_address,
                 "With --allow-network: let servers listen on ADDRESS, and requests go to any machine")
      ->type_name("ADDRESS");
  describe_plugins(app, o.plugins);
}

void describe_pictures(CLI::App& app, RunOptions& o) {
  app.add_option("--snapshot", o.record.snapshot, "At the end, draw the world into a picture")->type_name("OUT.png");
  app.add_option("--contact-sheet", o.record.contact_sheet, "At the end, twelve moments of the run in one picture")
      ->type_name("OUT.png");
  app.add_option("--movie", o.record.movie,
                 "A movie of the run, at the pace of simulated time: OUT.mp4, OUT.gif, or numbered pictures in OUT/")
      ->type_name("OUT.mp4|OUT.gif|OUT/");
  app.add_option("--sound", o.sound, "Write what the program plays, from its beginning on")->type_name("OUT.wav");
  app.add_option("--size", o.record.size,
                 "Size of a picture, in pixels (960x600). Those of a contact sheet are a third of it")
      ->type_name("WxH");
  app.add_option("--fps", o.record.fps, "Frames of the movie in a simulated second (25)")
      ->type_name("N")
      ->check(CLI::Range(0.001, 1000.0));
  app.add_flag("--plain", o.record.plain, "Draw nothing but the colours and lights that the program sets");
  app.add_option("--arrows", o.record.arrows,
                 "Draw arrows for contacts, forces, velocities or joints, several with commas between")
      ->type_name("KIND")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_flag("--live", o.live, "Show the world from above on the terminal, and the plotted values");
  auto* plot = several(app, "--plot", "METHOD", o.plot.names,
                       "What a method or variable of the controller says after each iteration: a number or a vector");
  app.add_option("--plot-to", o.plot.plot, "Draw that over time; the numbers go beside it, into OUT.csv")
      ->type_name("OUT.svg|OUT.png")
      ->needs(plot);
  app.add_option("--log", o.plot.log, "Write these numbers as a table")->type_name("OUT.csv")->needs(plot);
}

void describe_run(CLI::App& app, RunOptions& o) {
  constexpr const char* kWhole = "whole number (0 or more)";
  app.add_option("FILE", o.file, "The program (.tz)")->required();
  app.add_option("ARGS", o.arguments,
                 "Arguments of the program, after its own name. After -- they may look like options");
  auto* iterations = number(app, "--iterations", "N", o.iterations, kWhole, "Stop after N iterations");
  number(app, "--seconds", "S", o.seconds, "number of seconds (0 or more)", "Stop after S simulated seconds")
      ->excludes(iterations);
  number(app, "--seed", "K", o.seed, kWhole, "Seed of the random numbers. Without it, breve draws one and shows it");
  several(app, "--set", "NAME=VALUE", o.settings, "Set a variable of the controller before its init");
  number(app, "--budget", "N", o.budget, kWhole,
         "Stop with an error if an iteration takes more than N loop iterations and calls");
  number(app, "--physics-budget", "N", o.physics_budget, kWhole,
         "Move bodies coarsely if an iteration's physics exceeds N units of work");
  number(app, "--memory", "MB", o.memory, kWhole, "Stop with an error if the world takes more memory");
  number(app, "--depth", "N", o.depth, kWhole, "Stop with an error if calls nest deeper than N (5000)");
  several(app, "--path", "DIR", o.paths, "Also search DIR for modules and data files");
  describe_access(app, o.access);
  app.add_option("--accuracy", o.accuracy,
                 "Accuracy of bodies with physics: fast, balanced, precise, reference or conserving")
      ->type_name("RUNG")
      ->check(CLI::IsMember({"fast", "balanced", "precise", "reference", "conserving"}));
  auto* watch =
      app.add_flag("--watch", o.watch, "When a file of the program changes, continue with the changed program");
  app.add_option("--record", o.log, "Record all input of the run, so that `breve replay FILE` repeats it exactly")
      ->type_name("FILE")
      ->excludes(watch);
  app.add_flag("--coarse-random", o.coarse_random, "Draw random floats from 32,768 values, as in the original breve");
  app.add_flag("--strict", o.strict, "Treat warnings as errors, both at compile time and during the run");
  app.add_flag("--quiet", o.quiet, "Show no warnings and no progress");
  app.add_flag("--verbose", o.verbose, "Report each use of an obsolete method and each action of the guard");
  app.add_flag(
      "--stats", o.stats,
      "At the end, print one line of JSON to standard error: iterations, sim_seconds, wall_seconds, cpu_seconds, "
      "objects, seed, hash");
  app.add_flag("--effects", o.effects,
               "At the end, list the effects of the simulation: which were active, why, and their cost");
  app.add_flag("--hash", o.hash, "Print the hash of the world's state as the last line of the output");
  app.add_option("--positions", o.positions, "At the end, write the pose of every object: class,x,y,z,qw,qx,qy,qz")
      ->type_name("OUT.csv");
  app.add_flag("--profile{-}", o.profile,
               "At the end, print a time profile to standard error; with --profile=OUT.txt, write it to that file");
  auto* trace = app.add_option("--trace", o.trace, "Write every call to a file for ui.perfetto.dev or chrome://tracing")
                    ->type_name("OUT.json");
  number(app, "--trace-limit", "MB", o.trace_limit, kWhole, "Stop recording when the trace reaches this size (200)")
      ->needs(trace);
  describe_pictures(app, o);
  app.footer("Without --iterations and --seconds the program runs until it ends the simulation or is interrupted.\n" +
             std::string(kExitStatuses));
}

void describe_view(CLI::App& app, ViewOptions& o) {
  constexpr const char* kWhole = "whole number (0 or more)";
  app.add_option("FILE", o.run.file, "The program (.tz)")->required();
  app.add_option("ARGS", o.run.arguments,
                 "Arguments of the program, after its own name. After -- they may look like options");
  number(app, "--seed", "K", o.run.seed, kWhole, "Seed of the random numbers (1)");
  several(app, "--set", "NAME=VALUE", o.run.settings, "Set a variable of the controller before its init");
  several(app, "--path", "DIR", o.run.paths, "Also search DIR for modules and data files");
  describe_access(app, o.run.access);
  app.add_option("--accuracy", o.run.accuracy,
                 "Accuracy of bodies with physics: fast, balanced, precise, reference or conserving")
      ->type_name("RUNG")
      ->check(CLI::IsMember({"fast", "balanced", "precise", "reference", "conserving"}));
  app.add_flag("--watch", o.run.watch, "When a file of the program changes, continue with the changed program");
  app.add_option("--size", o.run.record.size, "Size of the window, in pixels (960x600)")->type_name("WxH");
  app.add_option("--speed", o.speed, "Simulated seconds in a second (1)")
      ->type_name("X")
      ->check(CLI::Range(0.001, 1000.0));
  app.add_flag("--paused", o.paused, "Begin paused");
  app.add_flag("--plain", o.run.record.plain, "Draw nothing but the colours and lights that the program sets");
  app.add_option("--arrows", o.run.record.arrows,
                 "Draw arrows for contacts, forces, velocities or joints, several with commas between")
      ->type_name("KIND")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_flag("--software", o.software,
               "Draw in main memory, as `breve run` does, and not with this machine's OpenGL");
  app.add_flag("--strict", o.run.strict, "Treat warnings as errors");
  app.add_flag("--quiet", o.run.quiet, "Show no warnings");
  app.add_flag("--verbose", o.run.verbose, "Report each use of an obsolete method and each action of the guard");
  app.add_option("--play", o.play, "Take input from a file, for tests; see docs/viewer.md")->type_name("FILE");
  app.footer("F1 in the window lists its keys.\n" + std::string(kExitStatuses));
}

void describe_check(CLI::App& app, CheckOptions& o) {
  app.add_option("FILE", o.files, "Programs (.tz)")->required();
  several(app, "--path", "DIR", o.paths, "Also search DIR for modules");
  several(app, "--allow", "CODE", o.allowed, "Do not report this lint");
  describe_plugins(app, o.plugins);
  app.add_flag("--strict", o.strict, "Treat warnings as errors");
  app.add_flag("--json", o.json, "Print JSON: an array of file, line, column, length, severity, code, message, help");
  app.footer(kExitStatuses);
}

void describe_replay(CLI::App& app, ReplayOptions& o) {
  app.add_option("FILE", o.file, "A log that `breve run --record` has written")->required();
  describe_plugins(app, o.plugins);
  app.add_flag("--hash", o.hash, "Print the hash of the world's state as the last line of the output");
  app.add_flag("--quiet", o.quiet, "Say nothing unless the runs differ");
  app.footer(
      "Run it in the directory where the log was recorded, with the program unchanged. Nothing outside is touched: "
      "the\n"
      "program reads what the log holds. It fails at the first iteration that differs from the recorded run.\n" +
      std::string(kExitStatuses));
}

void describe_repl(CLI::App& app, ReplOptions& o) {
  app.add_option("FILE", o.file, "The program (.tz). Without it: a world with an empty controller");
  number(app, "--seed", "K", o.seed, "whole number (0 or more)", "Seed of the random numbers (1)");
  several(app, "--path", "DIR", o.paths, "Also search DIR for modules and data files");
  describe_access(app, o.access);
  app.add_flag("--strict", o.strict, "Treat warnings as errors");
  app.add_flag("--quiet", o.quiet, "No warnings");
  app.footer("`:help` in the session lists its commands.\n" + std::string(kExitStatuses));
}

void describe_doc(CLI::App& app, DocOptions& o) {
  app.add_option("FILE", o.files, "Programs (.tz), or parts of programs");
  app.add_flag("--library", o.library, "Also document the class library");
  app.add_option("--out", o.out, "Write the pages to DIR (reference)")->type_name("DIR");
  app.add_option("--format", o.format, "markdown, html or both (both)")
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"markdown", "html", "both"}));
  several(app, "--path", "DIR", o.paths, "Also search DIR for modules");
  app.footer("Lines that begin with % document the class or method that contains them.\n" + std::string(kExitStatuses));
}

void describe_lsp(CLI::App& app, LspOptions& o) {
  several(app, "--path", "DIR", o.paths, "Also search DIR for modules");
  app.footer("For editors: the language server protocol over standard input and output. See docs/editors.");
}

bool is_command(const CLI::App& app, const std::string& word) {
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (command->get_name() == word) return true;
  return false;
}

/// Letters to put in, leave out or exchange, to get from one word to the other.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t corner = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = corner + (a[i - 1] == b[j - 1] ? 0 : 1);
      corner = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
    }
  }
  return row[b.size()];
}

/// The option of the command that was given which is near to one that it does not know; "" if there is none.
std::string near_option(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands())
    for (const std::string& given : command->remaining()) {
      if (!given.starts_with("--")) continue;
      std::string best;
      std::size_t fewest = given.size() / 3;
      for (const CLI::Option* option : command->get_options())
        for (const std::string& name : option->get_lnames())
          if (const std::size_t n = edits(given.substr(0, given.find('=')), "--" + name); n <= fewest) {
            best = "--" + name;
            fewest = n - (n > 0 ? 1 : 0);
          }
      if (!best.empty()) return best;
    }
  return {};
}

/// Reports a word that is not a command, and the command or the file that may be meant.
int refuse_command(const CLI::App& app, const std::string& word) {
  std::cerr << "breve: there is no command '" << word << "': it must be run, replay, repl, check, doc, lsp or help\n";
  std::string best;
  std::size_t fewest =
      word.size() < 3 ? 1 : std::max<std::size_t>(2, word.size() / 3);  // two: letters that changed places
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (const std::size_t n = edits(word, command->get_name()); n <= fewest) {
      best = command->get_name();
      fewest = n - (n > 0 ? 1 : 0);
    }
  if (word.ends_with(".tz") || word.ends_with(".lua"))
    std::cerr << "To run a program: breve run " << word << "\n";
  else if (!best.empty())
    std::cerr << "Did you mean " << best << "?\n";
  else
    std::cerr << "Try `breve help`.\n";
  return breve::command::kWrongUsage;
}

/// @param topic  a command; "": all of them
int show_help(CLI::App& app, const std::string& topic) {
  if (!topic.empty() && !is_command(app, topic)) return refuse_command(app, topic);
  const CLI::App& shown = topic.empty() ? app : *app.get_subcommand(topic);
  std::cout << shown.get_formatter()->make_help(&shown, topic.empty() ? app.get_name() : app.get_name() + " " + topic,
                                                CLI::AppFormatMode::Normal);
  return breve::command::kEndedWell;
}

/// Help that was asked for, or what is wrong on the command line. @return  the exit status
int refuse_options(const CLI::App& app, const CLI::ParseError& e, int argc, char** argv) {
  const bool asked = e.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
  if (asked) {
    app.exit(e, std::cout, std::cerr);
    return breve::command::kEndedWell;
  }
  if (app.get_subcommands().empty() && argc > 1 && *argv[1] == '-') {
    std::cerr << "breve: options come after a command, as in: breve run " << argv[1] << " ... FILE\n";
    return breve::command::kWrongUsage;
  }
  const std::string near = near_option(app);
  std::cerr << "breve: " << e.what() << "\n"
            << (near.empty() ? "Try `breve help` or `breve help run`.\n" : "Did you mean " + near + "?\n");
  return breve::command::kWrongUsage;
}

int main_guarded(int argc, char** argv) {
  // A reader of the output who goes away is seen as an error of write().
  std::signal(SIGPIPE, SIG_IGN);
  CLI::App app("breve: worlds of agents", "breve");
  app.set_version_flag("--version", std::string("breve ") + breve_version());
  app.require_subcommand(1);
  app.footer("`breve help` shows this text, `breve help run` the options of a command.");
  RunOptions run_options;
  ReplOptions repl_options;
  ViewOptions view_options;
  CheckOptions check_options;
  DocOptions doc_options;
  LspOptions lsp_options;
  ReplayOptions replay_options;
  auto* run = app.add_subcommand("run", "Run a program");
  auto* replay = app.add_subcommand("replay", "Repeat a run that was recorded, and compare it");
  auto* repl = app.add_subcommand("repl", "Type statements that run in a world");
  auto* view = app.add_subcommand("view", "Run a program in a window");
  auto* check = app.add_subcommand("check", "Compile programs and show errors, warnings and notes");
  auto* doc = app.add_subcommand("doc", "Generate reference pages from the comments of programs");
  auto* lsp = app.add_subcommand("lsp", "Language server for editors: errors as you type, completion, definitions");
  std::string topic;
  auto* help = app.add_subcommand("help", "Show this text, or the options of a command");
  help->add_option("COMMAND", topic, "run, view, replay, repl, check, doc or lsp");
  describe_run(*run, run_options);
  describe_replay(*replay, replay_options);
  describe_repl(*repl, repl_options);
  describe_view(*view, view_options);
  describe_check(*check, check_options);
  describe_doc(*doc, doc_options);
  describe_lsp(*lsp, lsp_options);
  if (argc > 1 && *argv[1] != '-' && !is_command(app, argv[1])) return refuse_command(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return refuse_options(app, e, argc, argv);
  }
  if (help->parsed()) return show_help(app, topic);
  if (lsp->parsed()) return breve::command::lsp(lsp_options);
  if (doc->parsed() && doc_options.files.empty() && !doc_options.library) {
    std::cerr << "breve: doc needs a FILE or --library\nTry `breve doc --help`.\n";
    return breve::command::kWrongUsage;
  }
  Output output;
  if (doc->parsed()) return breve::command::doc(doc_options, output);
  if (view->parsed()) return breve::command::view(view_options, output);
  if (repl->parsed()) return breve::command::repl(repl_options, output);
  if (replay->parsed()) return breve::command::replay(replay_options, output);
  return run->parsed() ? breve::command::run(run_options, output) : breve::command::check(check_options, output);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return main_guarded(argc, argv);
  } catch (const std::exception& e) {
    std::cerr << "breve: " << e.what() << "\n";
    return breve::command::kFailed;
  }
}
