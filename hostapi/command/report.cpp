// Tables and lines, from what breve.h tells.
#include "report.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

namespace breve::command {

namespace {

std::string hash_text(const breve_world* world) {
  std::uint64_t hash = 0;
  return breve_world_hash(world, &hash) == BREVE_OK ? fmt::format("0x{:016x}", hash) : std::string();
}

std::vector<breve_object> objects_of(const breve_world* world) {
  std::size_t count = 0;
  if (breve_world_objects(world, nullptr, nullptr, 0, &count) != BREVE_OK) return {};
  std::vector<breve_object> objects(count);
  if (breve_world_objects(world, nullptr, objects.data(), count, &count) != BREVE_OK) return {};
  return objects;
}

std::string why(const breve_world* world, const breve_effect& effect) {
  if (!effect.active) return {};
  const char* asker = breve_object_class(world, effect.asked_by);
  return asker ? fmt::format("{} (first requested by a {})", effect.reason, asker) : std::string(effect.reason);
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

std::string effects_table(const breve_world* world) {
  std::size_t count = 0;
  if (breve_world_effects(world, nullptr, 0, &count) != BREVE_OK) return {};
  std::vector<breve_effect> effects(count);
  if (breve_world_effects(world, effects.data(), count, &count) != BREVE_OK) return {};
  // Items, calls and time are those of the last iteration.
  std::string table = fmt::format("{:<16} {:<6} {:>7} {:>9} {:>9} {:>12} {:>11}  {}\n", "effect", "active", "since",
                                  "items", "calls", "microseconds", "bytes", "why");
  for (const auto& e : effects) {
    std::string line = fmt::format("{:<16} {:<6} {:>7} {:>9} {:>9} {:>12.1f} {:>11}  {}", e.name,
                                   e.active ? "yes" : "no", e.active ? std::to_string(e.since) : "-", e.items, e.calls,
                                   e.seconds * 1e6, e.bytes, why(world, e));
    line.erase(line.find_last_not_of(' ') + 1);
    table += line + "\n";
  }
  return table;
}

std::string hash_line(const breve_world* world) {
  const std::string hash = hash_text(world);
  return hash.empty() ? hash : "hash " + hash + "\n";
}

std::string stats_line(const breve_world* world, const RunTimes& times, std::uint64_t seed,
                       const Interventions& interventions) {
  breve_stats stats = breve_stats_default();
  breve_world_stats(world, &stats);
  nlohmann::ordered_json line;
  line["iterations"] = stats.iterations;
  line["sim_seconds"] = stats.time;
  line["wall_seconds"] = times.wall;
  line["cpu_seconds"] = times.cpu;
  line["objects"] = stats.objects;
  line["seed"] = seed;
  line["hash"] = hash_text(world);
  for (const char* action : {"reported", "refined", "put to rest"}) line["guard"][action] = interventions.count(action);
  return line.dump() + "\n";
}

void write_positions(const breve_world* world, const std::string& path) {
  const auto fail = [&] { throw std::runtime_error("cannot write " + path + ": " + std::strerror(errno)); };
  std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "w"));
  if (!file) fail();
  std::fputs("class,x,y,z,qw,qx,qy,qz\n", file.get());
  for (const breve_object object : objects_of(world)) {
    breve_pose p;
    if (breve_object_pose(world, object, &p) != BREVE_OK) continue;  // it has no place in space
    std::fprintf(file.get(), "%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", breve_object_class(world, object),
                 p.location[0], p.location[1], p.location[2], p.rotation[0], p.rotation[1], p.rotation[2],
                 p.rotation[3]);
  }
  if (std::fflush(file.get()) != 0 || std::ferror(file.get())) fail();
}

}  // namespace breve::command
