// The pieces of a solid as they are kept: scaled, in images and in hashes.
#include <algorithm>

#include "runtime/solid/pieces.hpp"
#include "runtime/solid/polyhedron_image.hpp"

namespace breve {

namespace {

std::shared_ptr<ConvexPieces> make_pieces(double excess, std::size_t count, std::pmr::memory_resource* memory) {
  return {new (memory) ConvexPieces(excess, count, memory), std::default_delete<ConvexPieces>(),
          std::pmr::polymorphic_allocator<>(memory)};
}

/// Does no vertex of a neighbouring face stand out of a face?
bool folds_outward_everywhere(const Polyhedron& solid, double hair) {
  return std::all_of(solid.edges.begin(), solid.edges.end(), [&](const Edge& edge) {
    const Plane& plane = solid.planes[at(edge.left)];
    const auto& beyond = solid.faces[at(edge.right)];
    return std::all_of(beyond.begin(), beyond.end(),
                       [&](int v) { return plane.normal.dot(solid.vertices[at(v)]) <= plane.offset + hair; });
  });
}

}  // namespace

ConvexPieces::ConvexPieces(double excess, std::size_t count, std::pmr::memory_resource* memory)
    : excess_(excess), pieces_(memory) {
  pieces_.reserve(count);
}

void ConvexPieces::add(const Polyhedron& solid) {
  Piece& piece = pieces_.emplace_back(pieces_.get_allocator().resource());
  piece.solid = solid;
  update_planes(piece.solid);
  for (const Vector3& p : solid.vertices) piece.center += p / static_cast<double>(solid.vertices.size());
  piece.about = piece.solid;
  for (Vector3& p : piece.about.vertices) {
    piece.reach = std::max(piece.reach, p.stableNorm());
    p -= piece.center;
    piece.radius = std::max(piece.radius, p.stableNorm());
  }
  update_planes(piece.about);
}

std::shared_ptr<const ConvexPieces> ConvexPieces::scaled(const Vector3& factors) const {
  auto out = make_pieces(excess_, pieces_.size(), pieces_.get_allocator().resource());
  for (const Piece& piece : pieces_) {
    Polyhedron solid(piece.solid, pieces_.get_allocator().resource());
    for (Vector3& p : solid.vertices) p = p.cwiseProduct(factors);
    out->add(solid);
  }
  return out;
}

void ConvexPieces::save(ByteWriter& out) const {
  out.put(excess_);
  out.put(static_cast<std::uint64_t>(pieces_.size()));
  for (const Piece& piece : pieces_) save_polyhedron(piece.solid, out);
}

std::shared_ptr<const ConvexPieces> ConvexPieces::load(ByteReader& in, const Eigen::AlignedBox3d& bounds) {
  constexpr double kHair = 1e-6;  // of the extent
  const double hair = kHair * bounds.sizes().maxCoeff();
  const double excess = in.get<double>();
  if (!std::isfinite(excess) || excess < 0) ByteReader::fail();
  const std::size_t count = in.get_count(2 * sizeof(std::uint64_t));
  if (count < 1 || count > PieceSettings::kMost) ByteReader::fail();
  auto out = make_pieces(excess, count, in.memory());
  for (std::size_t i = 0; i < count; ++i) {
    const Polyhedron solid = load_polyhedron(in);
    const bool within = std::all_of(solid.vertices.begin(), solid.vertices.end(),
                                    [&](const Vector3& p) { return bounds.exteriorDistance(p) <= hair; });
    if (solid.faces.size() < 4 || !within) ByteReader::fail();
    out->add(solid);
    if (!folds_outward_everywhere(out->all().back().solid, hair)) ByteReader::fail();
  }
  return out;
}

void ConvexPieces::hash(Hasher& hasher) const {
  hasher.add(excess_);
  for (const Piece& piece : pieces_) {
    for (const Vector3& p : piece.solid.vertices) hasher.add(p);
    for (const auto& face : piece.solid.faces) {
      for (const int v : face) hasher.add(static_cast<std::uint64_t>(v));
    }
  }
}

}  // namespace breve
