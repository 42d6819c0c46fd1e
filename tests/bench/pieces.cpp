// Convex decomposition: breve's cuts beside HACD of Bullet's extras (float64) on the concave meshes of
// tests/runtime/mesh_solids.hpp. Claims: breve's pieces hold every corner of the mesh and every point inside that is
// tried, and no more than a tenth of volume beyond it (a fifth of a thin bowl). Prints a table; exits 1 if a claim does
// not hold.
#include <hacdHACD.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <limits>
#include <random>
#include <vector>

#include "runtime/solid/triangle_mesh.hpp"
#include "tests/runtime/mesh_solids.hpp"

namespace {

using namespace breve;
using namespace breve::mesh_solids;

constexpr double kExcess = 0.1, kOfBowl = 0.2, kOutside = 1e-8;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Result {
  std::vector<std::vector<Plane>> pieces;
  double volume = 0, seconds = 0;

  double outside(const Vector3& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& planes : pieces) {
      double here = -std::numeric_limits<double>::infinity();
      for (const Plane& plane : planes) here = std::max(here, plane.normal.dot(p) - plane.offset);
      least = std::min(least, here);
    }
    return least;
  }
};

Result by_cuts(const Mesh& mesh, double excess) {
  const auto shape = mesh.shape();
  Result result;
  const double before = cpu_seconds();
  shape->split({96, excess}, [](std::uint64_t) {});
  result.seconds = cpu_seconds() - before;
  for (const auto& piece : shape->pieces()->all()) {
    result.pieces.emplace_back(piece.solid.planes.begin(), piece.solid.planes.end());
    result.volume += moments(piece.solid).volume;
  }
  return result;
}

Result by_clusters(const Mesh& mesh) {
  std::vector<HACD::Vec3<HACD::Real>> points;
  std::vector<HACD::Vec3<long>> triangles;
  for (const Vector3& p : mesh.corners) points.emplace_back(p.x(), p.y(), p.z());
  for (const Triangle& t : mesh.triangles) triangles.emplace_back(long{t[0]}, long{t[1]}, long{t[2]});
  HACD::HACD hacd;
  hacd.SetPoints(points.data());
  hacd.SetNPoints(points.size());
  hacd.SetTriangles(triangles.data());
  hacd.SetNTriangles(triangles.size());
  hacd.SetCompacityWeight(0.1);
  hacd.SetVolumeWeight(0);
  hacd.SetNClusters(1);
  hacd.SetNVerticesPerCH(100);
  hacd.SetConcavity(10);  // of 1000 that the mesh is scaled to
  hacd.SetAddFacesPoints(true);
  hacd.SetAddExtraDistPoints(true);
  hacd.NormalizeData();
  Result result;
  const double before = cpu_seconds();
  hacd.Compute(true);
  result.seconds = cpu_seconds() - before;
  hacd.DenormalizeData();
  for (std::size_t i = 0; i < hacd.GetNClusters(); ++i) {
    std::vector<HACD::Vec3<HACD::Real>> corners(hacd.GetNPointsCH(i));
    std::vector<HACD::Vec3<long>> faces(hacd.GetNTrianglesCH(i));
    hacd.GetCH(i, corners.data(), faces.data());
    auto& planes = result.pieces.emplace_back();
    const auto corner = [&](long k) {
      const auto& p = corners[static_cast<std::size_t>(k)];
      return Vector3(p.X(), p.Y(), p.Z());
    };
    for (const auto& face : faces) {
      const Vector3 a = corner(face.X()), b = corner(face.Y()), c = corner(face.Z());
      const Vector3 normal = (b - a).cross(c - a).stableNormalized();
      result.volume += a.dot(b.cross(c)) / 6;
      if (normal.squaredNorm() > 0.5) planes.push_back({normal, normal.dot(a)});
    }
  }
  return result;
}

struct Quality {
  double corners = 0, inside = 0;  // the farthest that one is outside all pieces
};

Quality quality(const Mesh& mesh, const Result& result) {
  const auto shape = mesh.shape();
  const Eigen::AlignedBox3d box = shape->surface()->bounds();
  Quality q;
  for (const Vector3& p : mesh.corners) q.corners = std::max(q.corners, result.outside(p));
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 4000; ++i) {
    const Vector3 share(unit(engine), unit(engine), unit(engine));
    const Vector3 p = box.min() + share.cwiseProduct(box.sizes());
    if (shape->surface()->inside(p)) q.inside = std::max(q.inside, result.outside(p));
  }
  return q;
}

void print(const Mesh& mesh, const Result& result, double volume) {
  const Quality q = quality(mesh, result);
  std::printf("  %6zu %8.3f %9.1e %9.1e %8.1f", result.pieces.size(), result.volume / volume - 1, q.corners, q.inside,
              1e3 * result.seconds);
}

}  // namespace

int main() {
  const struct {
    const char* name;
    Mesh mesh;
    double excess;
  } solids[] = {{"ell", ell(), kExcess},
                {"cup 16", cup(1, 2, 0.2, 16), kExcess},
                {"cup 32", cup(1, 2, 0.2, 32), kExcess},
                {"bowl 24 x 6", bowl(1, 0.2, 24, 6), kOfBowl},
                {"torus 16 x 8", torus(1, 0.3, 16, 8), kExcess},
                {"torus 32 x 16", torus(1, 0.3, 32, 16), kExcess},
                {"torus 64 x 32", torus(1, 0.3, 64, 32), kExcess}};
  std::printf("pieces; volume beyond the mesh; a corner and a point inside, how far outside; milliseconds\n\n");
  std::printf("%-14s %9s  %-46s  %s\n", "", "triangles", "breve", "HACD");
  bool holds = true;
  for (const auto& [name, mesh, excess] : solids) {
    const double volume = mesh.shape()->volume();
    const Result own = by_cuts(mesh, excess), hacd = by_clusters(mesh);
    std::printf("%-14s %9zu", name, mesh.triangles.size());
    print(mesh, own, volume);
    print(mesh, hacd, volume);
    const Quality q = quality(mesh, own);
    const bool good = own.volume <= (1 + excess) * volume * (1 + 1e-9) && q.corners <= kOutside && q.inside <= kOutside;
    std::printf("%s\n", good ? "" : "  CLAIM BROKEN");
    holds = holds && good;
  }
  return holds ? 0 : 1;
}
