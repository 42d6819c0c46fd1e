// Scenes that several tests share: see scenes.hpp.
#include "scenes.hpp"

#include <cmath>

namespace breve::reference {

double Chain::total(const World& world, std::size_t link) const {
  double sum = 0;
  for (std::size_t i = 0; i <= link; ++i) sum += world.read(joints[i]).position[0];
  return sum;
}

double Chain::rate(const World& world, std::size_t link) const {
  double sum = 0;
  for (std::size_t i = 0; i <= link; ++i) sum += world.read(joints[i]).velocity[0];
  return sum;
}

double Chain::widest(const World& world) const {
  double worst = 0;
  for (const Hinge& hinge : hinges) worst = std::max(worst, world.open(hinge));
  return worst;
}

Chain hang(World& world, const std::vector<double>& lengths, const std::vector<double>& masses, const Vector3& from) {
  Chain out;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    out.links.push_back(world.body(rod(lengths[i], masses[i]), Vector3::Zero()));
    Hinge hinge;
    hinge.child = out.links.back();
    hinge.child_point = Vector3(0, 0.5 * lengths[i], 0);
    hinge.normal = -Vector3::UnitZ();  // so that a positive angle turns the child about +z
    if (i > 0) {
      hinge.parent = out.links[i - 1];
      hinge.parent_point = Vector3(0, -0.5 * lengths[i - 1], 0);
    } else {
      hinge.parent_point = from;
    }
    out.hinges.push_back(hinge);
    out.joints.push_back(world.join(hinge));
  }
  return out;
}

void start(World& world, const Chain& chain, const std::vector<double>& angles, const std::vector<double>& rates) {
  for (std::size_t i = 0; i < chain.joints.size(); ++i)
    world.set_joint(chain.joints[i], angles[i] - (i > 0 ? angles[i - 1] : 0), rates[i] - (i > 0 ? rates[i - 1] : 0));
}

Bar::Bar(World& world, const Vector3& from, const Vector3& to, double mass) : length((to - from).norm()) {
  const double angle = std::atan2(to.y() - from.y(), to.x() - from.x()) - kPi / 2;
  orientation = Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
  body = world.body(rod(length, mass), 0.5 * (from + to), orientation);
}

Hinge pin(const Bar* parent, const Vector3& on_parent, const Bar& child, const Vector3& on_child) {
  Hinge hinge;
  if (parent) hinge.parent = parent->body;
  hinge.child = child.body;
  hinge.parent_point = on_parent;
  hinge.child_point = on_child;
  hinge.normal = -Vector3::UnitZ();
  hinge.rotation = parent ? parent->orientation.conjugate() * child.orientation : child.orientation;
  return hinge;
}

Solid needle(const Vector3& tip, double mass, const Matrix3& inertia) {
  Solid out;
  const Vector3 u = 0.02 * tip.norm() * tip.unitOrthogonal(), v = tip.normalized().cross(u);
  for (const Vector3& corner : {tip, Vector3(-tip), u, v, Vector3(-u), Vector3(-v)})
    out.corners.insert(out.corners.end(), corner.data(), corner.data() + 3);
  for (std::uint32_t side = 0; side < 4; ++side)
    for (std::uint32_t end = 0; end < 2; ++end)
      for (const std::uint32_t corner : {end, 2 + side, 2 + (side + 1) % 4}) out.indices.push_back(corner);
  out.sizes.assign(8, 3);
  out.geometry.kind = BREVE_SHAPE_CONVEX;
  out.mass = mass;
  out.inertia = inertia;
  return out;
}

Vector3 along(double tilt) { return Vector3(std::cos(tilt), std::sin(tilt), 0); }
Vector3 across(double tilt) { return Vector3(-std::sin(tilt), std::cos(tilt), 0); }

breve_object incline(World& world, double tilt) {
  const Quaternion orientation(Eigen::AngleAxisd(tilt, Vector3::UnitZ()));
  return world.fixed(box(Vector3(200, 10, 200), 1), -5 * across(tilt), orientation);
}

}  // namespace breve::reference
