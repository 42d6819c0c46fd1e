// Convex decomposition: a closed solid of triangles as convex pieces that hold it together.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <memory_resource>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/memory.hpp"
#include "runtime/solid/polyhedron.hpp"
#include "runtime/solid/triangle_mesh.hpp"

namespace breve {

struct PieceSettings {
  static constexpr int kMost = 256;
  int most = 32;         // pieces; from 1 to kMost
  double excess = 0.05;  // how much more volume all pieces together may hold than the solid, as a part of the solid's;
                         // finite and >= 0. It is reached if `most` allows it.
};

/// Counts work before it is done, in units of Meter. It may throw to end the work.
using Charge = std::function<void(std::uint64_t units)>;

/// The pieces of a solid, in an order that depends on the mesh alone. They never change.
class ConvexPieces : public InMemory {
 public:
  struct Piece {
    Polyhedron solid;  // in the frame of the whole
    Polyhedron about;  // the same about its own centre
    Vector3 center;
    double reach = 0, radius = 0;  // of the spheres about the origin and about the centre that hold it

    explicit Piece(std::pmr::memory_resource* memory) : solid(memory), about(memory), center(Vector3::Zero()) {}
  };

  ConvexPieces(double excess, std::size_t count, std::pmr::memory_resource* memory);
  void add(const Polyhedron& solid);
  const std::pmr::vector<Piece>& all() const { return pieces_; }
  double excess() const { return excess_; }  // as in PieceSettings
  std::shared_ptr<const ConvexPieces> scaled(const Vector3& factors) const;
  void save(ByteWriter& out) const;
  /// Error{Image} unless they are convex solids within `bounds`, or hardly outside.
  static std::shared_ptr<const ConvexPieces> load(ByteReader& in, const Eigen::AlignedBox3d& bounds);
  void hash(Hasher& hasher) const;

 private:
  double excess_;
  std::pmr::vector<Piece> pieces_;
};

/// Every point of the solid is in some piece. Pieces overlap and stand out of the solid where they are not yet convex.
/// By cuts along planes, each time of the piece that exceeds its part most: through edges that fold inward, along their
/// faces or between them, and across the axes; of these the plane after which hulls exceed their parts least.
/// @throws Error{Argument}  a mesh that is not closed, has more than kMostPieceTriangles triangles, whose surface
///                          crosses itself or of which one closed part is inside another, or bad settings
constexpr std::size_t kMostPieceTriangles = 20'000;
std::shared_ptr<ConvexPieces> split_into_convex(const TriangleMesh& mesh, const PieceSettings& settings,
                                                std::pmr::memory_resource* memory, const Charge& charge);

/// The same check by itself. Cost O(triangles) where they do not crowd.
void check_solid(const TriangleMesh& mesh, const Charge& charge);

}  // namespace breve
