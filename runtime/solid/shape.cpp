// A shape is an original solid, a scale and a density; everything else follows from these three.
#include "runtime/solid/shape.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "runtime/base/error.hpp"
#include "runtime/solid/shape_geometry.hpp"

namespace breve {

std::string show(const Vector3& v) { return fmt::format("({}, {}, {})", v.x(), v.y(), v.z()); }

namespace {

constexpr double kSymmetryTolerance = 1e-9;  // relative; a matrix typed with ten digits passes

void check_positive(const char* what, double value) {
  if (!std::isfinite(value) || value <= 0) {
    throw Error(ErrorCode::Argument, fmt::format("{} is {} (must be finite and > 0)", what, value));
  }
}

/// Inertia and second moments turn into one another: I = tr(S) 1 - S and S = tr(I)/2 1 - I. The diagonal is summed
/// without S(i, i), so that the small moment of a thin rod is not lost in the difference.
Matrix3 inertia_of(const Matrix3& second) {
  Matrix3 inertia = -second;
  for (int i = 0; i < 3; ++i) inertia(i, i) = second((i + 1) % 3, (i + 1) % 3) + second((i + 2) % 3, (i + 2) % 3);
  return inertia;
}
Matrix3 second_of(const Matrix3& inertia) { return inertia.trace() / 2 * Matrix3::Identity() - inertia; }

/// Under the map x -> F x at constant density S becomes det(F) F S F.
Matrix3 stretched(const Matrix3& second, const Vector3& factors) {
  return factors.prod() * (factors.asDiagonal() * second * factors.asDiagonal());
}

void check_inertia(const Matrix3& inertia) {
  const auto refuse = [&](const char* must) {
    throw Error(ErrorCode::Argument, fmt::format("an inertia matrix is [{}, {}, {}] ({})", show(inertia.row(0)),
                                                 show(inertia.row(1)), show(inertia.row(2)), must));
  };
  if (!inertia.allFinite()) refuse("must be finite");
  const double size = inertia.cwiseAbs().maxCoeff();
  if ((inertia - inertia.transpose()).cwiseAbs().maxCoeff() > kSymmetryTolerance * size) refuse("must be symmetric");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia, Eigen::EigenvaluesOnly);
  const Vector3& moments = solver.eigenvalues();  // rising
  if (!(moments[0] > 0)) refuse("must be positive definite");
  if (moments[2] > (moments[0] + moments[1]) * (1 + kSymmetryTolerance)) {
    refuse("no principal moment may exceed the sum of the other two");
  }
}

}  // namespace

void Shape::Geometry::derive_size() {
  const Vector3 f = factors();
  radius = original_radius * f.x();
  bounding_radius = radius;
  for (std::size_t i = 0; i < original_vertices.size(); ++i) {
    solid.vertices[i] = original_vertices[i].cwiseProduct(f);
    bounding_radius = std::max(bounding_radius, solid.vertices[i].stableNorm());
  }
  if (original_round.is_round()) {
    round = original_round;
    round.radius = radius = original_round.radius * f.x();
    round.half = original_round.half * f[round.axis];
    bounding_radius = round.is_capsule() ? round.radius + round.half : std::hypot(round.radius, round.half);
    place_corners(round, solid.vertices);
  }
  update_planes(solid);
  if (!surface) return;
  pieces = original_pieces ? original_pieces->scaled(scale) : nullptr;
  const Eigen::AlignedBox3d& box = surface->bounds();
  bounding_radius = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).stableNorm();
}

void Shape::Geometry::derive_mass() {
  volume = original.volume * factors().prod();
  inertia = density * inertia_of(stretched(original.second, factors()));
  const double mass = density * volume;
  const auto fits = [](double x) { return std::isnormal(x) && x > 0; };
  if (!fits(volume) || !fits(mass) || !inertia.allFinite() || !fits(inertia.diagonal().minCoeff())) {
    throw Error(ErrorCode::Argument,
                fmt::format("a shape of volume {} and density {} has mass {} and moments of inertia {}: out of range",
                            volume, density, mass, show(inertia.diagonal())));
  }
}

Shape::Shape(std::unique_ptr<Geometry> geometry) : geometry_(std::move(geometry)), counts_(geometry_->memory()) {
  geometry_->derive_size();
  geometry_->derive_mass();
}

Shape::~Shape() = default;

std::shared_ptr<Shape> Shape::shared(std::unique_ptr<Geometry> geometry) {
  const Memory memory = geometry->memory();
  // The count of owners stands in the same memory.
  return std::shared_ptr<Shape>(new (memory) Shape(std::move(geometry)), std::default_delete<Shape>(),
                                std::pmr::polymorphic_allocator<>(memory));
}

std::shared_ptr<Shape> Shape::sphere(double radius, Memory memory) {
  check_positive("the radius of a sphere", radius);
  auto g = make_in<Geometry>(memory, memory);
  g->kind = ShapeKind::Sphere;
  g->original_radius = radius;
  g->original.volume = 4 * std::numbers::pi / 3 * radius * radius * radius;
  g->original.first.setZero();
  g->original.second = g->original.volume * radius * radius / 5 * Matrix3::Identity();
  return shared(std::move(g));
}

std::shared_ptr<Shape> Shape::of(ShapeKind kind, Polyhedron solid, double density, Memory memory) {
  auto g = make_in<Geometry>(memory, memory);
  g->kind = kind;
  g->original = moments(solid);
  g->original_vertices = solid.vertices;
  g->solid = std::move(solid);
  g->density = density;
  return shared(std::move(g));
}

std::shared_ptr<Shape> Shape::of(const Round& round, Memory memory) {
  auto g = make_in<Geometry>(memory, memory);
  g->kind = round.is_cylinder() ? ShapeKind::Cylinder : ShapeKind::Capsule;
  g->original_round = round;
  g->original = moments(round);
  g->solid = make_polygons(round);
  return shared(std::move(g));
}

std::shared_ptr<Shape> Shape::cylinder(double height, double radius, int axis, Memory memory) {
  check_positive("the height of a cylinder", height);
  check_positive("the radius of a cylinder", radius);
  return of({RoundKind::Cylinder, axis, radius, height / 2}, memory);
}

std::shared_ptr<Shape> Shape::capsule(double length, double radius, int axis, Memory memory) {
  check_positive("the length of a capsule", length);
  check_positive("the radius of a capsule", radius);
  return of({RoundKind::Capsule, axis, radius, length / 2}, memory);
}

std::shared_ptr<Shape> Shape::box(const Vector3& size, Memory memory) {
  return of(ShapeKind::Box, make_box(size, memory), 1, memory);
}

std::shared_ptr<Shape> Shape::prism(int sides, double height, double radius, Memory memory) {
  return of(ShapeKind::Convex, make_prism(sides, height, radius), 1, memory);
}

std::shared_ptr<Shape> Shape::cone(int sides, double height, double radius, Memory memory) {
  return of(ShapeKind::Convex, make_cone(sides, height, radius), 1, memory);
}

std::shared_ptr<Shape> Shape::convex(const std::vector<std::vector<Vector3>>& faces, double density, Memory memory) {
  check_positive("the density of a shape", density);
  return of(ShapeKind::Convex, make_convex(faces), density, memory);
}

ShapeKind Shape::kind() const { return geometry_->kind; }
double Shape::radius() const { return geometry_->radius; }
const Round& Shape::round() const { return geometry_->round; }
Vector3 Shape::size() const {
  return geometry_->kind == ShapeKind::Box ? Vector3(geometry_->solid.vertices.back() * 2) : Vector3(Vector3::Zero());
}
const std::pmr::vector<Vector3>& Shape::vertices() const { return geometry_->solid.vertices; }
const Surface* Shape::surface() const { return geometry_->surface.get(); }
const std::pmr::vector<std::pmr::vector<int>>& Shape::faces() const { return geometry_->solid.faces; }
const Polyhedron& Shape::polyhedron() const { return geometry_->solid; }
double Shape::bounding_radius() const { return geometry_->bounding_radius; }

Eigen::AlignedBox3d Shape::bounds(const Matrix3& rotation) const {
  if (kind() == ShapeKind::Sphere) return {Vector3::Constant(-radius()), Vector3::Constant(radius())};
  if (round().is_round()) {
    const Vector3 half = half_extent(round(), rotation);
    return {-half, half};
  }
  Eigen::AlignedBox3d box;
  if (kind() == ShapeKind::HeightField) {
    for (int i = 0; i < 8; ++i) {
      box.extend(rotation * geometry_->surface->bounds().corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
    }
    return box;
  }
  for (const Vector3& v : polyhedron().vertices) box.extend(rotation * v);  // a mesh reaches as far as its hull
  return box;
}

double Shape::volume() const { return geometry_->volume; }
double Shape::mass() const { return geometry_->volume * geometry_->density; }
double Shape::density() const { return geometry_->density; }
const Matrix3& Shape::inertia() const { return geometry_->inertia; }
const Vector3& Shape::scale() const { return geometry_->scale; }
const Vector3& Shape::last_scale() const { return geometry_->last_scale; }

Vector3 Shape::center_of_mass() const {
  const Geometry& g = *geometry_;
  return (g.original.first / g.original.volume).cwiseProduct(g.factors());
}

void Shape::set_mass(double mass) {
  check_positive("the mass of a shape", mass);
  set_density(mass / geometry_->volume);
}

void Shape::set_density(double density) {
  check_positive("the density of a shape", density);
  const double before = geometry_->density;
  geometry_->density = density;
  try {
    geometry_->derive_mass();
  } catch (const Error&) {
    geometry_->density = before;
    geometry_->derive_mass();
    throw;
  }
}

void Shape::set_inertia(const Matrix3& inertia) {
  check_inertia(inertia);
  Geometry& g = *geometry_;
  const Matrix3 symmetric = (inertia + inertia.transpose()) / 2;
  g.original.second = stretched(second_of(symmetric / g.density), g.factors().cwiseInverse());
  g.inertia = symmetric;
}

void Shape::set_scale(const Vector3& factors) {
  static constexpr const char* kWhat[] = {"the scale of a shape along x", "the scale of a shape along y",
                                          "the scale of a shape along z"};
  for (int i = 0; i < 3; ++i) check_positive(kWhat[i], factors[i]);
  auto next = make_in<Geometry>(geometry_->memory(), geometry_->memory());
  *next = *geometry_;
  next->last_scale = next->scale;
  next->scale = factors;
  next->scale_surface();
  next->derive_size();
  next->derive_mass();
  geometry_ = std::move(next);
  note_change();
}

void Shape::note_change() {
  ++changes_;
  for (const ChangeCount& count : counts_) ++*count;
}

void Shape::report_changes_to(const ChangeCount& count) {
  if (std::find(counts_.begin(), counts_.end(), count) != counts_.end()) return;
  std::erase_if(counts_,
                [](const ChangeCount& other) { return other.use_count() == 1; });  // that nobody reads any more
  counts_.push_back(count);
}

}  // namespace breve
