// Shapes and masses, as Box2D has them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "runtime/base/error.hpp"
#include "runtime/planar/core.hpp"

namespace breve {

namespace {

void add_fixture(FlatBody& flat, const b2Shape& shape, std::uint32_t number) {
  b2FixtureDef def;
  def.shape = &shape;
  def.friction = 0;
  // KEEP IN STEP: touch.cpp. A contact's restitution is our note of what is known of it, -1 for nothing; Box2D's own
  // restitution is out of reach of any speed.
  def.restitution = -1;
  def.restitutionThreshold = std::numeric_limits<float>::max();
  def.userData.pointer = number;
  flat.b2->CreateFixture(&def);
}

b2Vec2 scaled(const Vector2& v, double unit) {
  return {static_cast<float>(v.x() / unit), static_cast<float>(v.y() / unit)};
}

/// Box2D's polygons have a skin, without which its search for the time of impact fails on what rests. It lies inside
/// the true outline: corners are rounded by it.
std::unique_ptr<b2Shape> polygon_of(const std::pmr::vector<Vector2>& points, double unit) {
  constexpr double kSkinPart = 0.25;  // of half the width, at most
  const double skin = std::min(double{b2_polygonRadius} * unit, kSkinPart * half_width(points));
  const std::pmr::vector<Vector2> core = shrunk(points, skin);
  auto shape = std::make_unique<b2PolygonShape>();
  shape->m_radius = static_cast<float>(skin / unit);
  shape->m_count = static_cast<int32>(core.size());
  Vector2 center = Vector2::Zero();
  for (std::size_t i = 0; i < core.size(); ++i) {
    shape->m_vertices[i] = scaled(core[i], unit);
    center += core[i] / static_cast<double>(core.size());
    const Vector2 out = -left_of(core[(i + 1) % core.size()] - core[i]).normalized();
    shape->m_normals[i] = b2Vec2(static_cast<float>(out.x()), static_cast<float>(out.y()));
  }
  shape->m_centroid = scaled(center, unit);
  return shape;
}

/// Corners nearer to each other than Box2D can tell, on which it aborts the process, are left out; the ends are not.
std::unique_ptr<b2Shape> profile_of(const std::pmr::vector<Vector2>& points, double unit) {
  constexpr float kNearest = 1.01F * b2_linearSlop;
  std::pmr::vector<b2Vec2> corners(points.get_allocator().resource());
  for (const Vector2& p : points) {
    const b2Vec2 corner = scaled(p, unit);
    if (!b2Vec2(2 * corner).IsValid())
      throw Error(ErrorCode::Argument,
                  fmt::format("a corner of a profile is at ({}, {}), which is out of the range of single precision",
                              p.x(), p.y()));
    const auto near_last = [&] { return !corners.empty() && b2Distance(corners.back(), corner) < kNearest; };
    if (near_last() && &p != &points.back()) continue;
    while (corners.size() > 1 && near_last()) corners.pop_back();
    corners.push_back(corner);
  }
  const std::size_t n = corners.size();
  if (n < 2 || b2Distance(corners[0], corners[1]) < kNearest)
    throw Error(
        ErrorCode::Argument,
        fmt::format("a profile is shorter than the resolution at a length unit of {}; set the world's length unit to "
                    "about the size of its bodies (set-length-unit, breve_world_config.length_unit)",
                    unit));
  auto chain = std::make_unique<b2ChainShape>();
  chain->CreateChain(corners.data(), static_cast<int32>(n), 2 * corners[0] - corners[1],
                     2 * corners[n - 1] - corners[n - 2]);
  chain->m_radius = 0;
  return chain;
}

std::unique_ptr<b2Shape> shape_of(const FlatPiece& piece, double unit) {
  if (piece.kind == FlatPiece::Kind::Polygon) return polygon_of(piece.points, unit);
  if (piece.kind != FlatPiece::Kind::Circle) return profile_of(piece.points, unit);
  auto circle = std::make_unique<b2CircleShape>();
  circle->m_p = scaled(piece.center, unit);
  circle->m_radius = static_cast<float>(piece.radius / unit);
  return circle;
}

/// The distance of the farthest point of a shape from a center.
double farthest_of(const Outline& outline, const Vector2& center) {
  double farthest = 0;
  for (const FlatPiece& piece : outline.pieces) {
    if (piece.kind == FlatPiece::Kind::Circle)
      farthest = std::max(farthest, (piece.center - center).norm() + piece.radius);
    for (const Vector2& point : piece.points) farthest = std::max(farthest, (point - center).norm());
  }
  return farthest;
}

/// @throws Error{Argument} where Box2D cannot have such a body
b2MassData mass_data(const MassProperties& mass, double unit) {
  const Vector3& c = mass.center_of_mass;
  b2MassData data;
  data.mass = static_cast<float>(mass.mass);
  data.center = b2Vec2(static_cast<float>(c.x() / unit), static_cast<float>(c.y() / unit));
  data.I = static_cast<float>((mass.inertia(2, 2) + mass.mass * c.head<2>().squaredNorm()) / (unit * unit));
  // Box2D takes the centre's part off again in single precision, and ends the process if nothing is left.
  const float own = data.I - data.mass * b2Dot(data.center, data.center);
  if (!(data.mass > 0) || !std::isfinite(data.mass) || !(own > 1e-6F * data.I) || !std::isfinite(data.I))
    throw Error(ErrorCode::Argument, fmt::format("a body's mass of {}, inertia of {} or centre of mass is out of the "
                                                 "range of single precision",
                                                 mass.mass, mass.inertia(2, 2)));
  return data;
}

}  // namespace

void Planar::Core::fit(FlatBody& flat) {
  const std::shared_ptr<Shape>& shape = bodies->collision_shape(flat.body);
  Outline outline = outline_of(*shape, memory);
  if (!outline.solid && !flat.fixed)
    throw Error(
        ErrorCode::Argument,
        "a surface that encloses nothing, or a height field, cannot be the shape of a body that moves in a flat "
        "world");
  constexpr double kThinnest = 0.002;  // length units; Box2D's bodies rest with an overlap of 0.005
  if (flat.solid && outline.thickness < kThinnest * settings.unit)
    throw Error(ErrorCode::Argument,
                fmt::format("a body is only {} wide, which is too thin at a length unit of {}; set the world's length "
                            "unit to about the size of its bodies (set-length-unit, breve_world_config.length_unit)",
                            2 * outline.thickness, settings.unit));
  // All is refused before anything is changed, so that the next step also refuses it.
  std::pmr::vector<std::unique_ptr<b2Shape>> pieces(memory);
  if (flat.solid)
    for (const FlatPiece& piece : outline.pieces) pieces.push_back(shape_of(piece, settings.unit));
  MassProperties mass;
  b2MassData data;
  if (!flat.fixed) {
    mass = bodies->mass_properties(flat.body);
    data = mass_data(mass, settings.unit);
  }
  while (b2Fixture* fixture = flat.b2->GetFixtureList()) flat.b2->DestroyFixture(fixture);
  flat.shape = shape;
  flat.scale = shape->scale();
  flat.thickness = outline.thickness / settings.unit;
  for (std::uint32_t number = 0; number < pieces.size(); ++number) add_fixture(flat, *pieces[number], number);
  if (flat.fixed) return;
  flat.mass = mass;
  flat.reach = farthest_of(outline, mass.center_of_mass.head<2>()) / settings.unit;
  flat.b2->SetMassData(&data);
}

}  // namespace breve
