// Convex hulls: breve's own beside Bullet's btConvexHullComputer (float64) on the thousand clouds of
// tests/runtime/hull_sets.hpp. Claims: breve's hulls leave no point outside by more than 1e-8 of the extent and are at
// least as exact as Bullet's on every kind of cloud. Prints a table; exits 1 if a claim does not hold.
#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "runtime/base/error.hpp"
#include "tests/runtime/hull_sets.hpp"

namespace {

using namespace breve;
using namespace breve::hull_sets;

constexpr double kMostOutside = 1.01e-8;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Polyhedron bullet_hull(const std::vector<Vector3>& points) {
  btConvexHullComputer computer;
  computer.compute(points[0].data(), static_cast<int>(sizeof(Vector3)), static_cast<int>(points.size()), 0, 0);
  Polyhedron solid;
  for (int i = 0; i < computer.vertices.size(); ++i) {
    const btVector3& v = computer.vertices[i];
    solid.vertices.emplace_back(v.x(), v.y(), v.z());
  }
  for (int f = 0; f < computer.faces.size(); ++f) {
    auto& face = solid.faces.emplace_back();
    const btConvexHullComputer::Edge* const first = &computer.edges[computer.faces[f]];
    const btConvexHullComputer::Edge* edge = first;
    do {
      face.push_back(edge->getSourceVertex());
      edge = edge->getNextEdgeOfFace();
    } while (edge != first);
  }
  return solid;
}

struct Column {
  Quality worst;
  double seconds = 0;
  int none = 0;  // clouds of which it made no solid

  template <class Make>
  void add(const Set& set, Make&& make) {
    const double before = cpu_seconds();
    Polyhedron solid;
    try {
      solid = make(set.points);
    } catch (const Error&) {
    }
    seconds += cpu_seconds() - before;
    if (solid.faces.size() < 4) {
      ++none;
      return;
    }
    const Quality q = quality(set, solid);
    worst.outside = std::max(worst.outside, q.outside);
    worst.volume = std::max(worst.volume, q.volume);
    worst.inertia = std::max(worst.inertia, q.inertia);
  }
  void print() const {
    std::printf("  %8.1e %8.1e %8.1e %5d %7.1f", worst.outside, worst.volume, worst.inertia, none, 1e3 * seconds);
  }
};

}  // namespace

int main() {
  Column own[kClouds], bullet[kClouds];
  for (int i = 0; i < kSets; ++i) {
    const Set set = make_set(i);
    own[i % kClouds].add(set, [](const auto& points) { return make_hull(points); });
    bullet[i % kClouds].add(set, bullet_hull);
  }
  std::printf(
      "worst of %d clouds of a kind: a point outside, of the extent; relative error of volume and of inertia;\n"
      "clouds without a solid; milliseconds of all\n\n",
      kSets / kClouds);
  std::printf("%-15s  %-40s  %s\n", "", "breve", "btConvexHullComputer");
  bool holds = true;
  for (int k = 0; k < kClouds; ++k) {
    std::printf("%-15s", kCloudNames[k]);
    own[k].print();
    bullet[k].print();
    const bool good = own[k].none == 0 && own[k].worst.outside <= kMostOutside &&
                      (own[k].worst.volume <= bullet[k].worst.volume || bullet[k].none > 0);
    std::printf("%s\n", good ? "" : "  WORSE");
    holds = holds && good;
  }
  return holds ? 0 : 1;
}
