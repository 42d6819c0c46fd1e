// `breve run`: a program from its first iteration to its last.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "access.hpp"
#include "output.hpp"
#include "plot.hpp"
#include "record.hpp"
#include "session.hpp"

namespace breve::command {

struct RunOptions {
  std::string file;
  std::vector<std::string> arguments, paths;
  std::optional<std::uint64_t> iterations;      // until the program ends if neither is given
  std::optional<double> seconds;                // simulated
  std::optional<std::uint64_t> seed;            // drawn if not given
  std::optional<std::uint64_t> budget;          // loop iterations and calls in one step
  std::optional<std::uint64_t> physics_budget;  // units of work of an iteration's physics
  std::optional<std::uint64_t> memory;          // MB
  std::optional<std::uint32_t> depth;           // nested calls
  std::vector<std::string> settings;            // name=value: variables of the controller
  bool watch = false;                           // reload the program when its files change
  bool live = false;                            // draw the world on the terminal
  bool coarse_random = false;
  AccessOptions access;
  bool strict = false, quiet = false, verbose = false, stats = false, effects = false, hash = false;
  std::string accuracy;  // rung, "" for the program's own
  RecordOptions record;
  PlotOptions plot;
  std::string sound;                         // WAV file, "" for none
  std::string log;                           // of all input, for `breve replay`; "" for none
  std::string positions;                     // CSV file, "" for none
  std::string profile;                       // file, "-" for standard error, "" for none
  std::string trace;                         // JSON file, "" for none
  std::optional<std::uint64_t> trace_limit;  // MB
};

class Profiling;

/// @param profiling  may be null
WorldHandle make_world(const Session& session, const breve_program* program, const RunOptions& options,
                       std::uint64_t seed, Profiling* profiling, breve_status& status);

/// What the command ends with after such a failure.
ExitStatus exit_status(breve_status status);

/// @return  the exit status
int run(const RunOptions& options, Output& output);

}  // namespace breve::command
