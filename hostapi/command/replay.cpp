// A replay compiles the recorded program again and hands the log to its world. The log cannot grant anything: files are
// not opened, commands are not run, and plugins are only loaded if the user allows it again.
#include "replay.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "log_file.hpp"
#include "report.hpp"

namespace breve::command {

namespace {

std::string iterations(std::uint64_t count) { return fmt::format("{} iteration{}", count, count == 1 ? "" : "s"); }

/// @return  the exit status
int report(const breve_replay& replay, const ReplayOptions& options, Output& output) {
  if (replay.differs) {
    output.complain(
        fmt::format("breve: iteration {} differs from the recorded run: its hash is {:016x}, and was {:016x} ({} "
                    "before it agree)\n",
                    replay.iteration, replay.hash, replay.recorded_hash, replay.iterations - 1));
    return kFailed;
  }
  if (options.quiet) return kEndedWell;
  output.complain(fmt::format("breve: {} replayed, each as it was recorded\n", iterations(replay.iterations)));
  if (!replay.complete) output.complain("breve: the log has no end: the recorded process ended before its run did\n");
  return kEndedWell;
}

}  // namespace

int replay(const ReplayOptions& options, Output& output) {
  ReadLog recorded = read_log(options.file);
  std::error_code ignored;
  if (!std::filesystem::exists(recorded.options.file, ignored)) {
    output.complain(fmt::format("breve: there is no file '{}' here; the log was recorded in {}\n",
                                recorded.options.file, recorded.folder));
    return kWrongUsage;
  }
  recorded.options.quiet = options.quiet;
  recorded.options.access.plugins = options.plugins;
  recorded.options.access.read.clear();  // they may be gone, and nothing is read
  recorded.options.access.write.clear();
  Session session(output, recorded.options.paths, options.quiet, recorded.options.strict, &recorded.options.access);
  ProgramHandle program;
  if (const ExitStatus loaded = session.load(recorded.options.file, program); loaded != kEndedWell) return loaded;
  breve_status status = BREVE_OK;
  const WorldHandle world = make_world(session, program.get(), recorded.options, recorded.seed, nullptr, status);
  if (!world) {
    output.complain(breve_runtime_last_error(session.runtime())->text);
    return exit_status(status);
  }
  breve_replay result{};
  status = breve_world_replay(world.get(), recorded.log.data(), recorded.log.size(), nullptr, nullptr, &result);
  if (status == BREVE_ERROR_IMAGE) {
    output.complain(fmt::format("breve: cannot replay '{}': {}; has {} changed since?\n", options.file,
                                breve_world_last_error(world.get())->message, recorded.options.file));
    return kFailed;
  }
  if (status != BREVE_OK) {
    output.complain(breve_world_last_error(world.get())->text);
    return exit_status(status);
  }
  if (options.hash) output.print(hash_line(world.get()));
  output.flush();
  return report(result, options, output);
}

}  // namespace breve::command
