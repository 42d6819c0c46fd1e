// Convex hulls of a thousand random and nasty clouds against closed forms and against the points themselves.
// `./run bench hulls` measures Bullet's hull on the same clouds.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "runtime/base/error.hpp"
#include "runtime/base/hasher.hpp"
#include "tests/runtime/hull_sets.hpp"

namespace breve::hull_tests {
namespace {

using namespace hull_sets;

// Faces that are flat to 1e-8 of the extent are one face (make_hull), so that a point may be so far over it.
constexpr double kOneFace = 1.01e-8;
// A box keeps 16 digits less those that its offset takes. A point 1e-12 of the extent over a face is on it (make_hull):
// that is 1e-6 of the thickness of a sliver, and so on either side of a needle.
constexpr double kExact = 1e-12, kOfSliver = 2e-6, kOfFar = 1e-8;

double tolerance(const Set& set) {
  if (set.cloud == Cloud::Sliver || set.cloud == Cloud::Needle) return kOfSliver;
  if (set.cloud == Cloud::Far) return kOfFar;
  return kExact;
}

TEST(HullSets, HoldTheirPointsAndHaveTheVolumeAndInertiaOfTheClosedForm) {
  int closed_forms = 0;
  for (int i = 0; i < kSets; ++i) {
    const Set set = make_set(i);
    SCOPED_TRACE(std::string(kCloudNames[i % kClouds]) + ", set " + std::to_string(i));
    Polyhedron hull;
    ASSERT_NO_THROW(hull = make_hull(set.points));
    ASSERT_EQ(hull.vertices.size() + hull.faces.size(), hull.edges.size() + 2);
    const Quality q = quality(set, hull);
    ASSERT_LE(q.outside, kOneFace);
    if (!set.exact) continue;
    ++closed_forms;
    ASSERT_LE(q.volume, tolerance(set));
    ASSERT_LE(q.inertia, tolerance(set));
  }
  EXPECT_EQ(closed_forms, 700);
}

TEST(HullSets, BoxesAndPrismsHaveTheirOwnFacesAndNoMore) {
  for (int i = 0; i < kSets; ++i) {
    const Set set = make_set(i);
    if (set.cloud != Cloud::Box && set.cloud != Cloud::Doubled && set.cloud != Cloud::Prism) continue;
    const Polyhedron hull = make_hull(set.points);
    const std::size_t sides = set.cloud == Cloud::Prism ? set.points.size() / 2 : 4;
    ASSERT_EQ(hull.faces.size(), sides + 2) << "set " << i;
    // A point on an edge of a turned box may stand out of it by round-off.
    const bool rotated = i % 20 < 10 && set.cloud != Cloud::Prism;
    ASSERT_GE(hull.vertices.size(), 2 * sides) << "set " << i;
    if (!rotated) {
      ASSERT_EQ(hull.vertices.size(), 2 * sides) << "set " << i;
    }
  }
}

TEST(HullSets, TheSamePointsGiveTheSameFacesInTheSameOrder) {
  for (int i = 0; i < kSets; i += 7) {
    const Set set = make_set(i);
    const std::vector<Vector3> elsewhere(set.points);
    const Polyhedron first = make_hull(set.points), second = make_hull(elsewhere);
    ASSERT_EQ(first.faces, second.faces) << "set " << i;
    ASSERT_EQ(first.vertices, second.vertices) << "set " << i;
  }
}

// What one process does twice, another build may do differently: the faces of all sets, as a committed number. Corners
// are counted by their numbers, so that round-off in the clouds shows only if it changes which points are corners.
TEST(HullSets, AllBuildsGiveTheSameFacesInTheSameOrder) {
  constexpr std::uint64_t kFaces = 0x87d3ccb41e327d75;
  Hasher hasher;
  for (int i = 0; i < kSets; ++i) {
    const Polyhedron hull = make_hull(make_set(i).points);
    hasher.add(static_cast<std::uint64_t>(hull.vertices.size()));
    hasher.add(static_cast<std::uint64_t>(hull.faces.size()));
    for (const auto& face : hull.faces) {
      hasher.add(static_cast<std::uint64_t>(face.size()));
      for (const auto corner : face) hasher.add(static_cast<std::uint64_t>(corner));
    }
  }
  EXPECT_EQ(hasher.value(), kFaces) << std::hex << hasher.value();
}

}  // namespace
}  // namespace breve::hull_tests
