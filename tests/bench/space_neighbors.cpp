// How the cost of neighbour search alone grows, without any script: one update and one query of every agent, for 12,500
// to 100,000 agents at constant density, about 20 neighbours each. Claim: twice the agents cost at most 2.3 times as
// much, spread evenly, crowded into clumps, and strewn over a wide world. Prints a table; exits 1 if the claim does not
// hold.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <vector>

#include "runtime/world/world.hpp"

namespace {

using namespace breve;

constexpr double kBound = 2.3;
constexpr int kRounds = 7;  // the fastest counts: the others were disturbed
constexpr double kNeighbors = 20;

enum class Crowd { Uniform, Flat, Clumps, Wide };

Vector3 in_cube(Random& r, double side) {
  const double x = r.uniform(), y = r.uniform(), z = r.uniform();
  return Vector3(x, y, z) * side;
}

/// Agents at a density of 1 per unit volume (or area), so that the radius for 20 neighbours is the same at every size.
Vector3 place(Crowd crowd, Random& r, int agents) {
  switch (crowd) {
    case Crowd::Uniform: return in_cube(r, std::cbrt(agents));
    case Crowd::Flat: {
      const double side = std::sqrt(agents);
      const double x = r.uniform() * side, y = r.uniform() * side;
      return Vector3(x, y, 0);
    }
    case Crowd::Clumps: {
      // Clumps of a thousand, a million units apart.
      const auto clump = static_cast<double>(r.below(static_cast<std::uint64_t>(agents / 1000)));
      return Vector3(1e6 * clump, 0, 0) + in_cube(r, 10);
    }
    case Crowd::Wide: return in_cube(r, 1e6);
  }
  return Vector3::Zero();
}

double radius_for(Crowd crowd, int agents) {
  constexpr double kPi = 3.14159265358979323846;
  if (crowd == Crowd::Flat) return std::sqrt(kNeighbors / kPi);
  const double radius = std::cbrt(kNeighbors * 3 / (4 * kPi));
  return crowd == Crowd::Wide ? radius * 1e6 / std::cbrt(agents) : radius;
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double measure(Crowd crowd, int agents, double& neighbors) {
  World world(std::pmr::new_delete_resource());
  std::vector<ObjectId> ids;
  for (int i = 0; i < agents; ++i) {
    ids.push_back(world.create(1, 0, false, false));
    world.embody(ids.back(), BodyKind::Mobile);
    world.bodies().set_location(world.body(ids.back()), place(crowd, world.random(), agents));
    world.bodies().set_neighborhood_size(world.body(ids.back()), radius_for(crowd, agents));
  }
  double best = 1e300;
  for (int round = 0; round < kRounds; ++round) {
    const double start = cpu_seconds();
    std::size_t found = 0;
    world.update_neighbors();
    for (const ObjectId id : ids) found += world.neighbors(id).size();
    best = std::min(best, cpu_seconds() - start);
    neighbors = static_cast<double>(found) / agents;
  }
  return best;
}

}  // namespace

int main() {
  const struct {
    Crowd crowd;
    const char* name;
  } crowds[] = {{Crowd::Uniform, "uniform"}, {Crowd::Flat, "flat"}, {Crowd::Clumps, "clumps"}, {Crowd::Wide, "wide"}};
  bool holds = true;
  std::printf("%-8s %8s %10s %12s %10s %8s\n", "crowd", "agents", "neighbors", "ms", "ns/agent", "ratio");
  for (const auto& [crowd, name] : crowds) {
    double before = 0;
    for (const int agents : {12500, 25000, 50000, 100000}) {
      double neighbors = 0;
      const double seconds = measure(crowd, agents, neighbors);
      const double ratio = before > 0 ? seconds / before : 0;
      std::printf("%-8s %8d %10.1f %12.2f %10.0f %8.2f\n", name, agents, neighbors, seconds * 1e3,
                  seconds * 1e9 / agents, ratio);
      holds = holds && ratio <= kBound;
      before = seconds;
    }
  }
  std::printf(holds ? "holds: at most %.1f times for twice the agents\n" : "FAILS: more than %.1f times\n", kBound);
  return holds ? 0 : 1;
}
