// Convex decomposition by cuts. A part of the solid is what a convex cell holds of it (cell_cut.hpp); its piece is the
// hull of that part. The space that the hull holds beyond the part is what each cut is to make small.
// HACD of Bullet's extras was measured first (`./run bench hulls`): it clusters triangles of the surface, so that its
// hulls fill a cup; its own hulls leave parts of a torus out; and an L of twenty triangles counts as convex.
#include "runtime/solid/pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "runtime/base/error.hpp"
#include "runtime/solid/cell_cut.hpp"

namespace breve {

namespace {

constexpr double kHair = 1e-10;           // of the extent: corners so near to a cut are on it
constexpr double kLeastPart = 1e-6;       // of the solid's volume: a cut that leaves less on a side is not made
constexpr double kBalance = 0.1;          // what the worse side counts beside the sum of both
constexpr std::size_t kMostFolds = 16;    // edges that fold inward whose planes are tried in one part
constexpr std::size_t kFewCorners = 160;  // the hull of more is judged by those that are farthest in some directions
constexpr int kDirections = 96;

constexpr double kHalf = 0.70710678118654752;
const std::array<Vector3, 9> kAcross{Vector3(1, 0, 0),          Vector3(0, 1, 0),          Vector3(0, 0, 1),
                                     Vector3(kHalf, kHalf, 0),  Vector3(kHalf, -kHalf, 0), Vector3(0, kHalf, kHalf),
                                     Vector3(0, kHalf, -kHalf), Vector3(kHalf, 0, kHalf),  Vector3(kHalf, 0, -kHalf)};

/// An edge that folds inward, with the planes that may cut there.
struct Fold {
  Vector3 middle;
  std::array<Plane, 3> planes;  // of its two faces, and between them
  double weight;                // length times sine of the fold
};

/// One part of the solid on its way.
struct Part {
  CellPart cut;
  std::vector<Plane> planes;  // of the cell: the part is behind each
  Polyhedron hull;
  double volume = 0, hull_volume = 0;
  bool final = false;  // no cut makes it better

  Part(CellPart c, std::vector<Plane> p) : cut(std::move(c)), planes(std::move(p)) {}
  double excess() const { return std::max(0.0, hull_volume - volume); }
};

/// Directions spread evenly over the sphere (a spiral of the golden angle).
std::vector<Vector3> spread_directions() {
  std::vector<Vector3> out;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z), angle = 2.399963229728653 * i;
    out.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return out;
}

class Splitter {
 public:
  Splitter(const TriangleMesh& mesh, const PieceSettings& settings, std::pmr::memory_resource* memory,
           const Charge& charge)
      : mesh_(mesh), settings_(settings), memory_(memory), directions_(spread_directions()) {
    constexpr std::uint64_t kUnits = 3;  // what one corner that is looked at takes
    charge_ = [&charge](std::uint64_t count) { charge(kUnits * count); };
    extent_ = mesh.bounds().sizes().maxCoeff();
  }
  std::shared_ptr<ConvexPieces> run();

 private:
  std::unique_ptr<Part> whole();
  void find_folds();
  std::vector<Vector3> corners_of(const CellPart& part) const;
  std::vector<Plane> planes_for(const Part& part) const;
  double judged_hull(const std::vector<Vector3>& corners) const;
  double score(const Part& part, const Plane& plane) const;
  bool finish(Part& part) const;
  bool split(std::size_t number);

  const TriangleMesh& mesh_;
  const PieceSettings& settings_;
  std::pmr::memory_resource* memory_;
  Charge charge_;
  std::vector<Vector3> directions_;
  std::vector<Fold> folds_;
  std::vector<std::unique_ptr<Part>> parts_;
  double extent_, volume_ = 0;
};

Plane through(const Vector3& point, const Vector3& normal) { return {normal, normal.dot(point)}; }

/// Edges that fold inward, those with the most weight first.
void Splitter::find_folds() {
  constexpr double kFlat = 1e-6;
  const auto& triangles = mesh_.triangles();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t e = 0; e < 3; ++e) {
      const std::int32_t n = mesh_.neighbours()[i][e];
      if (n < 0 || at(n) < i) continue;
      const auto corner = [&](std::size_t k) -> const Vector3& { return mesh_.corners()[at(triangles[i][k % 3])]; };
      const Vector3 &a = corner(e), &b = corner(e + 1);
      const Vector3 &here = mesh_.normals()[i], &there = mesh_.normals()[at(n)];
      const Vector3 along = (b - a).stableNormalized();
      const double sine = -here.cross(there).dot(along);  // > 0: the neighbour rises over this face
      const Vector3 between = (here - there).stableNormalized();
      if (!(sine > kFlat) || between.squaredNorm() < 0.5) continue;
      folds_.push_back(
          {(a + b) / 2, {through(a, here), through(a, there), through(a, between)}, sine * (b - a).norm()});
    }
  }
  std::stable_sort(folds_.begin(), folds_.end(), [](const Fold& p, const Fold& q) { return p.weight > q.weight; });
}

/// Everything, in a cell a little larger than its bounds, so that no corner of it is in the solid.
std::unique_ptr<Part> Splitter::whole() {
  CellPart all(memory_);
  for (const Triangle& t : mesh_.triangles()) {
    all.surface.add_triangle(mesh_.corners()[at(t[0])], mesh_.corners()[at(t[1])], mesh_.corners()[at(t[2])]);
  }
  const Polyhedron box = make_box(1.01 * mesh_.bounds().sizes().cwiseMax(1e-3 * extent_));
  for (const auto& face : box.faces) {
    for (const int v : face) all.cell.corners.push_back(box.vertices[at(v)] + mesh_.bounds().center());
    all.cell.close();
  }
  return std::make_unique<Part>(std::move(all), std::vector<Plane>{});
}

/// What the hull of a part is made of: its surface, and the corners of the cell that are in the solid.
std::vector<Vector3> Splitter::corners_of(const CellPart& part) const {
  std::vector<Vector3> corners(part.surface.corners.begin(), part.surface.corners.end());
  const auto less = [](const Vector3& p, const Vector3& q) {
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  std::vector<Vector3> cell(part.cell.corners.begin(), part.cell.corners.end());
  std::sort(cell.begin(), cell.end(), less);
  cell.erase(std::unique(cell.begin(), cell.end()), cell.end());
  charge_(16 * cell.size());
  for (const Vector3& p : cell) {
    if (mesh_.inside(p)) corners.push_back(p);
  }
  std::sort(corners.begin(), corners.end(), less);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// The volume of a hull, or of one a little smaller if there are many corners; negative if they are flat.
double Splitter::judged_hull(const std::vector<Vector3>& corners) const {
  charge_(4 * std::min(corners.size(), kFewCorners));
  const auto volume_of = [](const std::vector<Vector3>& points) {
    try {
      return moments(make_hull(points)).volume;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::Argument) throw;
      return -1.0;
    }
  };
  if (corners.size() <= kFewCorners) return volume_of(corners);
  charge_(corners.size() * kDirections / 16);
  std::vector<std::size_t> chosen;
  for (const Vector3& d : directions_) {
    std::size_t best = 0;
    double most = d.dot(corners[0]);
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const double here = d.dot(corners[i]);
      if (here > most) most = here, best = i;
    }
    chosen.push_back(best);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  std::vector<Vector3> points;
  for (const std::size_t i : chosen) points.push_back(corners[i]);
  return volume_of(points);
}

/// Planes worth a try: at the heaviest folds in the part, and across its axes.
std::vector<Plane> Splitter::planes_for(const Part& part) const {
  std::vector<Plane> planes;
  std::vector<const Fold*> folds;
  charge_(1 + folds_.size() / 4);
  for (const Fold& fold : folds_) {
    const bool here = std::all_of(part.planes.begin(), part.planes.end(), [&](const Plane& p) {
      return p.normal.dot(fold.middle) < p.offset - kHair * extent_;
    });
    if (here) folds.push_back(&fold);
  }
  // The heaviest, and others all the way to the lightest.
  const std::size_t count = std::min(folds.size(), kMostFolds);
  for (std::size_t i = 0; i < count; ++i) {
    const Fold& fold = *folds[i * i * (folds.size() - 1) / std::max<std::size_t>(1, (count - 1) * (count - 1))];
    planes.insert(planes.end(), fold.planes.begin(), fold.planes.end());
  }
  for (const Vector3& normal : kAcross) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vector3& p : part.hull.vertices) {
      low = std::min(low, normal.dot(p));
      high = std::max(high, normal.dot(p));
    }
    for (const double share : {0.5, 0.25, 0.75}) planes.push_back({normal, low + share * (high - low)});
  }
  return planes;
}

double diagonal(const auto& corners) {
  Eigen::AlignedBox3d box;
  for (const Vector3& p : corners) box.extend(p);
  return box.diagonal().norm();
}

/// What hulls of both sides would hold beyond their parts, times how long the sides are; infinity if the cut is not to
/// be made. No single cut makes the hull of a ring or a cup smaller: the length then leads to parts that can be cut
/// well.
double Splitter::score(const Part& part, const Plane& plane) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  charge_(1 + part.cut.corner_count() / 2);
  CellPart behind(memory_), front(memory_);
  cut(part.cut, plane, kHair * extent_, behind, front);
  const double low = behind.volume(), high = front.volume();
  if (!(low > kLeastPart * volume_ && high > kLeastPart * volume_)) return kNever;
  const std::vector<Vector3> corners_low = corners_of(behind), corners_high = corners_of(front);
  const double hull_low = judged_hull(corners_low), hull_high = judged_hull(corners_high);
  if (hull_low < 0 || hull_high < 0) return kNever;
  const double a = std::max(0.0, hull_low - low) * diagonal(corners_low);
  const double b = std::max(0.0, hull_high - high) * diagonal(corners_high);
  return a + b + kBalance * std::max(a, b);
}

/// Hull and volumes of a part; false if it is too flat for a hull.
bool Splitter::finish(Part& part) const {
  const std::vector<Vector3> corners = corners_of(part.cut);
  charge_(4 * corners.size());
  try {
    part.hull = make_hull(corners);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Argument) throw;
    return false;
  }
  part.volume = part.cut.volume();
  part.hull_volume = moments(part.hull).volume;
  return true;
}

/// Cut one part in two by the best plane; false if none makes it better.
bool Splitter::split(std::size_t number) {
  const Part& part = *parts_[number];
  const Plane* best = nullptr;
  double least = (1 + kBalance) * part.excess() * diagonal(part.hull.vertices) * (1 - 1e-9);
  const std::vector<Plane> planes = planes_for(part);
  for (const Plane& plane : planes) {
    const double here = score(part, plane);
    if (here >= least) continue;
    least = here;
    best = &plane;
  }
  if (best == nullptr) return false;
  CellPart behind(memory_), front(memory_);
  cut(part.cut, *best, kHair * extent_, behind, front);
  std::vector<Plane> low = part.planes, high = part.planes;
  low.push_back(*best);
  high.push_back({-best->normal, -best->offset});
  auto a = std::make_unique<Part>(std::move(behind), std::move(low));
  auto b = std::make_unique<Part>(std::move(front), std::move(high));
  if (!finish(*a) || !finish(*b)) return false;
  parts_[number] = std::move(a);
  parts_.push_back(std::move(b));
  return true;
}

std::shared_ptr<ConvexPieces> Splitter::run() {
  volume_ = mesh_.moments().volume;
  find_folds();
  parts_.push_back(whole());
  if (!finish(*parts_[0])) {
    throw Error(ErrorCode::Argument, "a mesh is too flat for a solid: it must be thicker than 1e-6 of its extent");
  }
  double excess = 0;
  while (true) {
    excess = 0;
    std::size_t worst = parts_.size();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      excess += parts_[i]->excess();
      if (parts_[i]->final) continue;
      if (worst == parts_.size() || parts_[i]->excess() > parts_[worst]->excess()) worst = i;
    }
    const bool enough = excess <= settings_.excess * volume_ || excess <= 1e-9 * volume_;
    if (enough || worst == parts_.size() || static_cast<int>(parts_.size()) >= settings_.most) break;
    if (!split(worst)) parts_[worst]->final = true;
  }
  std::shared_ptr<ConvexPieces> out(new (memory_) ConvexPieces(excess / volume_, parts_.size(), memory_),
                                    std::default_delete<ConvexPieces>(), std::pmr::polymorphic_allocator<>(memory_));
  for (const auto& part : parts_) out->add(part->hull);
  return out;
}

}  // namespace

std::shared_ptr<ConvexPieces> split_into_convex(const TriangleMesh& mesh, const PieceSettings& settings,
                                                std::pmr::memory_resource* memory, const Charge& charge) {
  const auto refuse = [](const std::string& why) { throw Error(ErrorCode::Argument, why); };
  if (settings.most < 1 || settings.most > PieceSettings::kMost) {
    refuse(
        fmt::format("the number of convex pieces is {} (must be from 1 to {})", settings.most, PieceSettings::kMost));
  }
  if (!std::isfinite(settings.excess) || settings.excess < 0) {
    refuse(fmt::format("the excess of convex pieces is {} (must be finite and >= 0)", settings.excess));
  }
  if (mesh.triangles().size() > kMostPieceTriangles) {
    refuse(fmt::format("a mesh has {} triangles (at most {} can be split into convex pieces: take a coarser mesh)",
                       mesh.triangles().size(), kMostPieceTriangles));
  }
  check_solid(mesh, charge);
  return Splitter(mesh, settings, memory, charge).run();
}

}  // namespace breve
