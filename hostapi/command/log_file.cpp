// What a replay needs to know of a run: the program, its arguments, and each option that its world depends on.
#include "log_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace breve::command {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kVersion = 1;

Json json_of(const RunOptions& o, std::uint64_t seed) {
  return {{"breve-log", kVersion},
          {"file", o.file},
          {"folder", std::filesystem::current_path().string()},
          {"arguments", o.arguments},
          {"paths", o.paths},
          {"settings", o.settings},
          {"seed", seed},
          {"strict", o.strict},
          {"coarse-random", o.coarse_random},
          {"accuracy", o.accuracy},
          {"budget", o.budget.value_or(0)},
          {"physics-budget", o.physics_budget.value_or(0)},
          {"memory", o.memory.value_or(0)},
          {"depth", o.depth.value_or(0)},
          {"read", o.access.read},
          {"write", o.access.write},
          {"no-files", o.access.no_files},
          {"system", o.access.system},
          {"plugins", o.access.plugins}};
}

RunOptions options_of(const Json& json) {
  RunOptions o;
  json.at("file").get_to(o.file);
  json.at("arguments").get_to(o.arguments);
  json.at("paths").get_to(o.paths);
  json.at("settings").get_to(o.settings);
  json.at("strict").get_to(o.strict);
  json.at("coarse-random").get_to(o.coarse_random);
  json.at("accuracy").get_to(o.accuracy);
  o.budget = json.at("budget").get<std::uint64_t>();
  o.physics_budget = json.at("physics-budget").get<std::uint64_t>();
  o.memory = json.at("memory").get<std::uint64_t>();
  o.depth = json.at("depth").get<std::uint32_t>();
  json.at("read").get_to(o.access.read);
  json.at("write").get_to(o.access.write);
  json.at("no-files").get_to(o.access.no_files);
  json.at("system").get_to(o.access.system);
  return o;
}

}  // namespace

LogFile::LogFile(const RunOptions& options, std::uint64_t seed, breve_world* world)
    : name_(options.log), file_(std::fopen(options.log.c_str(), "wb")) {
  if (!file_) throw std::runtime_error(fmt::format("cannot write '{}'", name_));
  const std::string head = json_of(options, seed).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  write(this, head.data(), head.size());
  if (breve_world_record_start(world, &LogFile::write, this) != BREVE_OK)
    throw std::runtime_error(fmt::format("cannot record: {}", breve_world_last_error(world)->message));
}

/// Each piece is flushed, so that the log of a process that ends early reaches up to its last iteration.
void LogFile::write(void* sink, const char* bytes, std::size_t size) {
  auto& log = *static_cast<LogFile*>(sink);
  if (std::fwrite(bytes, 1, size, log.file_.get()) != size || std::fflush(log.file_.get()) != 0) log.failed_ = true;
}

void LogFile::finish(breve_world* world) {
  const bool whole = breve_world_recording(world) && breve_world_record_stop(world) == BREVE_OK;
  if (failed_) throw std::runtime_error(fmt::format("cannot write '{}': is the disk full?", name_));
  if (!whole) throw std::runtime_error(fmt::format("the log '{}' ends before the run does", name_));
}

ReadLog read_log(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("cannot read '{}'", file));
  ReadLog read;
  std::string head;
  std::getline(in, head);
  try {
    const Json json = Json::parse(head);
    if (json.at("breve-log").get<int>() != kVersion)
      throw std::runtime_error(fmt::format("'{}' was recorded by another version of breve", file));
    read.options = options_of(json);
    read.options.log = file;
    json.at("seed").get_to(read.seed);
    json.at("folder").get_to(read.folder);
  } catch (const Json::exception&) {
    throw std::runtime_error(fmt::format("'{}' is not a log of `breve run --record`", file));
  }
  read.log.assign(std::istreambuf_iterator<char>(in), {});
  return read;
}

}  // namespace breve::command
