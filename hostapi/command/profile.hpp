// `breve run --profile` and `--trace`: where the time of a run goes.
#pragma once

#include <memory>
#include <string>

#include "breve/breve.h"
#include "output.hpp"
#include "run.hpp"
#include "trace.hpp"

namespace breve::command {

/// A profile for people: a tree of calls, the methods and the lines that took most time.
/// @throws std::runtime_error if the profile cannot be read
std::string profile_text(breve_world* world, const std::string& program);

/// What these options do before, during and after a run.
class Profiling {
 public:
  /// @throws std::runtime_error if the trace file cannot be written
  explicit Profiling(const RunOptions& options);
  /// Let the world that is about to be made start with a profile, if one is wanted.
  void configure(breve_world_config& config);
  /// The run is over: write what was asked for. False if a file could not be written, which has been told.
  bool finish(breve_world* world, Output& output);

 private:
  bool finish_trace(Output& output);
  bool finish_profile(breve_world* world, Output& output) const;

  const RunOptions& options_;
  std::unique_ptr<TraceWriter> trace_;
};

}  // namespace breve::command
