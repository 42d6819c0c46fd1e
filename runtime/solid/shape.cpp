// A shape is an original solid, a scale and a density; everything else follows from these three.
#include "runtime/solid/shape.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/base/error.hpp"

namespace breve {

namespace {

constexpr double kSymmetryTolerance = 1e-9;  // relative; a matrix typed with ten digits passes

std::string show(const Vector3& v) { return fmt::format("({}, {}, {})", v.x(), v.y(), v.z()); }

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
  const Vector3 moments = solver.eigenvalues();  // rising
  if (!(moments[0] > 0)) refuse("must be positive definite");
  if (moments[2] > (moments[0] + moments[1]) * (1 + kSymmetryTolerance)) {
    refuse("no principal moment may exceed the sum of the other two");
  }
}

}  // namespace

struct Shape::Geometry : InMemory {
  explicit Geometry(Memory memory) : original_vertices(memory), solid(memory) {}
  Geometry(const Geometry& other) = delete;
  Geometry(Geometry&&) = delete;
  Geometry& operator=(const Geometry&) = default;  // the arrays stay in the memory that they have
  Memory memory() const { return original_vertices.get_allocator().resource(); }

  ShapeKind kind{};
  double original_radius = 0;                   // Sphere
  std::pmr::vector<Vector3> original_vertices;  // Box, Convex
  Moments original{};                           // at scale 1 and density 1; set_inertia changes `second`
  Vector3 scale = Vector3::Ones();
  Vector3 last_scale = Vector3::Ones();
  double density = 1;

  // What follows from the above.
  double radius = 0;
  Polyhedron solid;
  double bounding_radius = 0;
  double volume = 0;
  Matrix3 inertia = Matrix3::Zero();

  Vector3 factors() const { return kind == ShapeKind::Sphere ? Vector3::Constant(scale.x()) : scale; }
  void derive_size();
  void derive_mass();
};

/// Radius, vertices and planes from the original and the scale.
void Shape::Geometry::derive_size() {
  const Vector3 f = factors();
  radius = original_radius * f.x();
  bounding_radius = radius;
  for (std::size_t i = 0; i < original_vertices.size(); ++i) {
    solid.vertices[i] = original_vertices[i].cwiseProduct(f);
    bounding_radius = std::max(bounding_radius, solid.vertices[i].stableNorm());
  }
  update_planes(solid);
}

/// Volume and inertia. Error{Argument} if a mass or moment is too large or too small for a number.
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

Shape::Shape(std::unique_ptr<Geometry> geometry) : geometry_(std::move(geometry)) {
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

std::shared_ptr<Shape> Shape::of(ShapeKind kind, const Polyhedron& solid, double density, Memory memory) {
  auto g = make_in<Geometry>(memory, memory);
  g->kind = kind;
  g->original = moments(solid);
  g->original_vertices = solid.vertices;
  g->solid = solid;
  g->density = density;
  return shared(std::move(g));
}

std::shared_ptr<Shape> Shape::box(const Vector3& size, Memory memory) {
  return of(ShapeKind::Box, make_box(size), 1, memory);
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
Vector3 Shape::size() const {
  return geometry_->kind == ShapeKind::Box ? Vector3(geometry_->solid.vertices.back() * 2) : Vector3(Vector3::Zero());
}
const std::pmr::vector<Vector3>& Shape::vertices() const { return geometry_->solid.vertices; }
const std::pmr::vector<std::pmr::vector<int>>& Shape::faces() const { return geometry_->solid.faces; }
const Polyhedron& Shape::polyhedron() const { return geometry_->solid; }
double Shape::bounding_radius() const { return geometry_->bounding_radius; }

Eigen::AlignedBox3d Shape::bounds(const Matrix3& rotation) const {
  if (kind() == ShapeKind::Sphere) return {Vector3::Constant(-radius()), Vector3::Constant(radius())};
  Eigen::AlignedBox3d box;
  for (const Vector3& v : vertices()) box.extend(rotation * v);
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
  next->derive_size();
  next->derive_mass();
  geometry_ = std::move(next);
}

Vector3 Shape::point_on(const Vector3& direction) const {
  if (!direction.allFinite()) {
    throw Error(ErrorCode::Argument, fmt::format("a direction is {} (must be finite)", show(direction)));
  }
  const Vector3 unit = direction.stableNormalized();
  if (unit.squaredNorm() < 0.5) return Vector3::Zero();
  if (kind() == ShapeKind::Sphere) return radius() * unit;
  double distance = std::numeric_limits<double>::infinity();
  for (const Plane& plane : polyhedron().planes) {
    const double rise = plane.normal.dot(unit);
    if (rise > 0) distance = std::min(distance, plane.offset / rise);
  }
  return distance * unit;
}

namespace {

/// Where origin + t direction enters the ball: t >= 0, or infinity.
double enter_ball(double radius, const Vector3& origin, const Vector3& direction) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  const double a = direction.squaredNorm(), b = origin.dot(direction);
  const double c = (origin.norm() - radius) * (origin.norm() + radius);
  if (c <= 0) return 0;
  // |o x d|^2 = a |o|^2 - b^2 has no cancellation for rays that graze.
  const double discriminant = a * radius * radius - origin.cross(direction).squaredNorm();
  if (b >= 0 || discriminant < 0) return kMiss;
  return c / (-b + std::sqrt(discriminant));
}

/// The same for the intersection of half-spaces (Cyrus and Beck, 1978).
double enter_planes(const std::pmr::vector<Plane>& planes, const Vector3& origin, const Vector3& direction) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  double first = 0, last = kMiss;
  for (const Plane& plane : planes) {
    const double height = plane.normal.dot(origin) - plane.offset;
    const double rise = plane.normal.dot(direction);
    if (rise < 0) {
      first = std::max(first, height / -rise);
    } else if (rise > 0) {
      last = std::min(last, -height / rise);
    } else if (height > 0) {
      return kMiss;
    }
  }
  return first <= last ? first : kMiss;
}

}  // namespace

bool Shape::raycast(const Vector3& origin, const Vector3& direction, double& fraction) const {
  if (!origin.allFinite() || !direction.allFinite()) {
    throw Error(ErrorCode::Argument,
                fmt::format("a ray from {} along {} (must be finite)", show(origin), show(direction)));
  }
  const double t = kind() == ShapeKind::Sphere ? enter_ball(radius(), origin, direction)
                                               : enter_planes(polyhedron().planes, origin, direction);
  if (!std::isfinite(t)) return false;
  fraction = t;
  return true;
}

void Shape::save(ByteWriter& out) const {
  const Geometry& g = *geometry_;
  out.put(g.kind);
  out.put(g.original_radius);
  out.put(static_cast<std::uint64_t>(g.original_vertices.size()));
  for (const Vector3& v : g.original_vertices) out.put(v);
  out.put(static_cast<std::uint64_t>(g.solid.faces.size()));
  for (const auto& face : g.solid.faces) {
    out.put(static_cast<std::uint64_t>(face.size()));
    for (const int v : face) out.put(static_cast<std::int32_t>(v));
  }
  out.put(g.original.second);
  out.put(g.inertia);  // a given one does not come back from `second` to the last bit
  out.put(g.scale);
  out.put(g.last_scale);
  out.put(g.density);
}

namespace {

/// A polyhedron whose indices are in range and whose vertices are finite.
Polyhedron load_polyhedron(ByteReader& in) {
  Polyhedron solid;
  solid.vertices.resize(in.get_count(3 * sizeof(double)));
  for (Vector3& v : solid.vertices) {
    v = in.get_vector();
    if (!v.allFinite()) ByteReader::fail();
  }
  solid.faces.resize(in.get_count(sizeof(std::uint64_t)));
  for (auto& face : solid.faces) {
    face.resize(in.get_count(sizeof(std::int32_t)));
    if (face.size() < 3) ByteReader::fail();
    for (int& v : face) {
      v = in.get<std::int32_t>();
      if (v < 0 || static_cast<std::size_t>(v) >= solid.vertices.size()) ByteReader::fail();
    }
  }
  connect(solid);
  return solid;
}

bool positive(double value) { return std::isfinite(value) && value > 0; }

}  // namespace

std::shared_ptr<Shape> Shape::load(ByteReader& in) {
  const auto kind = in.get<ShapeKind>();
  const double radius = in.get<double>();
  if (kind > ShapeKind::Convex) ByteReader::fail();
  try {
    Polyhedron solid = load_polyhedron(in);
    const bool round = kind == ShapeKind::Sphere;
    const bool whole = solid.faces.size() >= 4 && (kind != ShapeKind::Box || solid.vertices.size() == 8);
    if (round ? !solid.faces.empty() || !solid.vertices.empty() : !whole) ByteReader::fail();
    const std::shared_ptr<Shape> shape = round ? sphere(radius, in.memory()) : of(kind, solid, 1, in.memory());
    Geometry& g = *shape->geometry_;
    g.original.second = in.get_matrix();
    const Matrix3 inertia = in.get_matrix();
    g.scale = in.get_vector();
    g.last_scale = in.get_vector();
    g.density = in.get<double>();
    if (!positive(g.scale.minCoeff()) || !positive(g.scale.maxCoeff()) || !positive(g.density)) ByteReader::fail();
    g.derive_size();
    g.derive_mass();
    if (!inertia.isApprox(g.inertia, 1e-9)) ByteReader::fail();
    g.inertia = inertia;
    return shape;
  } catch (const Error&) {
    ByteReader::fail();
  }
}

void Shape::hash(Hasher& hasher) const {
  const Geometry& g = *geometry_;
  hasher.add(static_cast<std::uint64_t>(g.kind));
  hasher.add(g.radius);
  for (const Vector3& v : g.solid.vertices) hasher.add(v);
  for (const auto& face : g.solid.faces) {
    for (const int v : face) hasher.add(static_cast<std::uint64_t>(v));
  }
  hasher.add(g.inertia);
  hasher.add(g.scale);
  hasher.add(g.last_scale);
  hasher.add(g.density);
}

}  // namespace breve
