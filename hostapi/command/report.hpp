// What `breve run` tells about a world when the run is over.
#pragma once

#include <cstdint>
#include <string>

#include "breve/breve.h"
#include "interventions.hpp"

namespace breve::command {

/// The effects of a world as a table for people.
std::string effects_table(const breve_world* world);

/// "hash 0x0123456789abcdef\n"; "" if there is no hash.
std::string hash_line(const breve_world* world);

struct RunTimes {
  double wall = 0, cpu = 0;  // s, from the creation of the world to the end of the run
};

/// One line of JSON: iterations, sim_seconds, wall_seconds, cpu_seconds, objects, seed, hash, guard.
/// @param seed  with which the world was made
std::string stats_line(const breve_world* world, const RunTimes& times, std::uint64_t seed,
                       const Interventions& interventions);

/// One row for each object with a place in space: class, location, rotation as a quaternion; full precision.
/// @throws std::runtime_error if the file cannot be written
void write_positions(const breve_world* world, const std::string& path);

}  // namespace breve::command
