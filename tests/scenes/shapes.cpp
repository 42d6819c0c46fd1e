// The shapes of scenes, and their masses.
#include <cmath>
#include <numbers>
#include <utility>

#include "tests/scenes/scene.hpp"

namespace breve::scenes {
namespace {

constexpr double kCircle = 2 * std::numbers::pi;

Vector3 on_circle(double radius, double z, std::uint32_t i, std::uint32_t sides) {
  const double angle = kCircle * i / sides;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// A quad of a mesh as two triangles.
void add_quad(Shape& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.faces.push_back({a, b, c});
  mesh.faces.push_back({a, c, d});
}

/// Sums over the tetrahedra between the origin and triangles of the surface.
struct Integral {
  double volume = 0;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();  // of x x^T
  void add(const Vector3& a, const Vector3& b, const Vector3& c) {
    const double six = a.dot(b.cross(c));
    const Vector3 sum = a + b + c;
    volume += six / 6;
    squares += six / 120 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
};

}  // namespace

Shape ball(double radius, double density) {
  Shape out;
  out.radius = radius;
  out.density = density;
  return out;
}

Shape box(const Vector3& size, double density) {
  Shape out;
  out.form = Form::Box;
  out.size = size;
  out.density = density;
  return out;
}

Shape prism(std::uint32_t sides, double radius, double height, double density) {
  Shape out;
  out.form = Form::Convex;
  out.density = density;
  std::vector<std::uint32_t> top, bottom;
  for (std::uint32_t i = 0; i < sides; ++i) {
    out.corners.push_back(on_circle(radius, height / 2, i, sides));
    out.corners.push_back(on_circle(radius, -height / 2, i, sides));
    top.push_back(2 * i);
    bottom.push_back(2 * (sides - 1 - i) + 1);
    const std::uint32_t next = (i + 1) % sides;
    out.faces.push_back({2 * i, 2 * i + 1, 2 * next + 1, 2 * next});
  }
  out.faces.push_back(top);
  out.faces.push_back(bottom);
  return out;
}

Shape cone(std::uint32_t sides, double radius, double height, double density) {
  Shape out;
  out.form = Form::Convex;
  out.density = density;
  std::vector<std::uint32_t> base;
  for (std::uint32_t i = 0; i < sides; ++i) {
    out.corners.push_back(on_circle(radius, -height / 4, i, sides));
    base.push_back(sides - 1 - i);
    out.faces.push_back({i, (i + 1) % sides, sides});
  }
  out.corners.push_back({0, 0, 3 * height / 4});
  out.faces.push_back(base);
  return out;
}

Shape torus(double radius, double thickness, std::uint32_t around, std::uint32_t across, double density) {
  Shape out;
  out.form = Form::Mesh;
  out.density = density;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = kCircle * i / around, v = kCircle * j / across, r = radius + thickness * std::cos(v);
      out.corners.push_back({r * std::cos(u), thickness * std::sin(v), r * std::sin(u)});
      const std::uint32_t next_i = (i + 1) % around, next_j = (j + 1) % across;
      add_quad(out, i * across + j, i * across + next_j, next_i * across + next_j, next_i * across + j);
    }
  return out;
}

Shape bumpy(double radius, std::uint32_t around, std::uint32_t across, double density) {
  Shape out;
  out.form = Form::Mesh;
  out.density = density;
  for (std::uint32_t j = 1; j < across; ++j)
    for (std::uint32_t i = 0; i < around; ++i) {
      const double u = kCircle * i / around, v = std::numbers::pi * j / across;
      const double r = radius * (1 + 0.15 * std::cos(8 * u) * std::pow(std::sin(v), 3));
      out.corners.push_back({r * std::sin(v) * std::cos(u), r * std::cos(v), r * std::sin(v) * std::sin(u)});
    }
  const auto top = static_cast<std::uint32_t>(out.corners.size()), bottom = top + 1, last = (across - 2) * around;
  out.corners.push_back({0, radius, 0});
  out.corners.push_back({0, -radius, 0});
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t next = (i + 1) % around;
    out.faces.push_back({top, next, i});
    for (std::uint32_t j = 0; j < across - 2; ++j)
      add_quad(out, j * around + i, j * around + next, (j + 1) * around + next, (j + 1) * around + i);
    out.faces.push_back({bottom, last + i, last + next});
  }
  return out;
}

Shape bowl(double inner, double outer, std::uint32_t around, std::uint32_t across) {
  Shape out;
  out.form = Form::Mesh;
  // From the inner bottom up to the rim and down outside: circles, and a pole at either end.
  const std::uint32_t circles = 2 * across;
  for (std::uint32_t j = 0; j < circles; ++j) {
    const bool inside = j < across;
    const double r = inside ? inner : outer;
    const double v = std::numbers::pi / 2 * (inside ? j + 1 : circles - j) / across;  // from the pole
    for (std::uint32_t i = 0; i < around; ++i) {
      const double u = kCircle * i / around;
      out.corners.push_back({r * std::sin(v) * std::cos(u), -r * std::cos(v), r * std::sin(v) * std::sin(u)});
    }
  }
  const auto first = static_cast<std::uint32_t>(out.corners.size()), end = first + 1, last = (circles - 1) * around;
  out.corners.push_back({0, -inner, 0});
  out.corners.push_back({0, -outer, 0});
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t next = (i + 1) % around;
    out.faces.push_back({first, next, i});
    for (std::uint32_t j = 0; j + 1 < circles; ++j)
      add_quad(out, j * around + i, j * around + next, (j + 1) * around + next, (j + 1) * around + i);
    out.faces.push_back({end, last + i, last + next});
  }
  return out;
}

MassProperties mass_properties(const Shape& shape) {
  if (shape.form == Form::Ball) {
    const double mass = shape.density * 2.0 / 3 * kCircle * std::pow(shape.radius, 3);
    return {mass, Vector3::Constant(0.4 * mass * shape.radius * shape.radius)};
  }
  if (shape.form == Form::Box) {
    const double mass = shape.density * shape.size.prod();
    const Vector3 squares = shape.size.cwiseAbs2();
    return {mass, mass / 12 * (Vector3::Constant(squares.sum()) - squares)};
  }
  Integral sum;
  for (const auto& face : shape.faces)
    for (std::size_t i = 2; i < face.size(); ++i)
      sum.add(shape.corners[face[0]], shape.corners[face[i - 1]], shape.corners[face[i]]);
  const Vector3 squares = sum.squares.diagonal();
  return {shape.density * sum.volume, shape.density * (Vector3::Constant(squares.sum()) - squares)};
}

}  // namespace breve::scenes
