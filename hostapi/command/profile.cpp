// The options around a run: a profile started with the world, a trace file, and what is written at the end.
#include "profile.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace breve::command {

namespace {
constexpr std::uint64_t kMegabyte = 1'000'000;
constexpr std::uint64_t kTraceLimit = 200;  // MB: what chrome://tracing still opens
}  // namespace

Profiling::Profiling(const RunOptions& options) : options_(options) {
  if (!options.trace.empty())
    trace_ = std::make_unique<TraceWriter>(options.trace, options.file,
                                           options.trace_limit.value_or(kTraceLimit) * kMegabyte);
}

void Profiling::configure(breve_world_config& config) {
  config.profile = trace_ || !options_.profile.empty();
  if (!trace_) return;
  config.trace = &TraceWriter::receive;
  config.trace_user = trace_.get();
}

bool Profiling::finish(breve_world* world, Output& output) {
  const bool stopped = !world || breve_world_profile_stop(world) != BREVE_ERROR_MEMORY;
  if (!stopped) output.complain("breve: the profile is incomplete: memory ran out\n");
  const bool traced = finish_trace(output);
  return (!world || options_.profile.empty() || finish_profile(world, output)) && traced;
}

bool Profiling::finish_trace(Output& output) {
  if (!trace_) return true;
  if (trace_->left_out() != 0)
    output.complain(
        fmt::format("breve: the trace is full: {} calls from iteration {} on are not in {} (see --trace-limit)\n",
                    trace_->left_out(), trace_->cut_at_iteration(), options_.trace));
  try {
    trace_->close();
    return true;
  } catch (const std::exception& e) {
    output.complain(fmt::format("breve: {}\n", e.what()));
    return false;
  }
}

bool Profiling::finish_profile(breve_world* world, Output& output) const {
  try {
    const std::string text = profile_text(world, options_.file);
    if (options_.profile == "-") {
      output.complain(text);
      return true;
    }
    std::FILE* file = std::fopen(options_.profile.c_str(), "w");
    if (!file) throw std::runtime_error("cannot write " + options_.profile + ": " + std::strerror(errno));
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    if (std::fclose(file) != 0 || !written) throw std::runtime_error("cannot write all of " + options_.profile);
    return true;
  } catch (const std::exception& e) {
    output.complain(fmt::format("breve: {}\n", e.what()));
    return false;
  }
}

}  // namespace breve::command
