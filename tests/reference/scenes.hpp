// Scenes that several tests share: pendulums of rods, bars and pins, a floor, an incline.
#pragma once

#include "world.hpp"

namespace breve::reference {

/// Bodies on hinges about z, hanging from a point of the world one below the other, straight down at zero. The joints'
/// positions are angles of a rod to the one above it, positive toward +x.
struct Chain {
  std::vector<breve_object> links, joints;
  std::vector<Hinge> hinges;
  double total(const World& world, std::size_t link) const;  // rad, absolute
  double rate(const World& world, std::size_t link) const;   // rad/s, absolute
  double widest(const World& world) const;                   // the worst gap of a joint, m
};

/// Uniform rods. Their angles to one another are 0.
Chain hang(World& world, const std::vector<double>& lengths, const std::vector<double>& masses,
           const Vector3& from = Vector3::Zero());
/// Sets the absolute angles and rates.
void start(World& world, const Chain& chain, const std::vector<double>& angles, const std::vector<double>& rates);

/// A bar between two points of the plane z = 0; its y axis goes from the first to the second.
struct Bar {
  breve_object body{};
  Quaternion orientation = Quaternion::Identity();
  double length = 0;
  Bar() = default;
  Bar(World& world, const Vector3& from, const Vector3& to, double mass);
  Vector3 begin() const { return Vector3(0, -length / 2, 0); }
  Vector3 end() const { return Vector3(0, length / 2, 0); }
};

/// A hinge about z between two bars as they stand; without a parent, to a point of the world. Positive: the child turns
/// counterclockwise.
Hinge pin(const Bar* parent, const Vector3& on_parent, const Bar& child, const Vector3& on_child);

/// A double pyramid, thin as a needle, with one tip at `tip` from its centre: what it touches, it touches with a point.
Solid needle(const Vector3& tip, double mass, const Matrix3& inertia);

/// A wide floor with its upper face at y = 0, rotated about z by `tilt`: a plane that rises toward +x.
breve_object incline(World& world, double tilt);
/// Unit vector up the slope, and the slope's normal.
Vector3 along(double tilt);
Vector3 across(double tilt);

}  // namespace breve::reference
