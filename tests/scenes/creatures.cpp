// Scenes of bodies with joints: vehicles, walkers, a ragdoll.
#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/scenes/builders.hpp"
#include "tests/scenes/nine_links.hpp"

namespace breve::scenes {

/// A car of 900 kg with a motor at each wheel drives over a low step.
Scene vehicle(Wheels wheels, bool flat) {
  constexpr double kRadius = 0.5, kSpeed = 6;  // m, m/s
  Scene scene;
  scene.flat = flat;
  scene.friction = 1;
  add_floor(scene);
  Body part;
  part.shape = scene.add(box({1, 0.24, 6}));
  part.at = {20, 0, 0};
  part.motion = Motion::Fixed;
  scene.add(part);
  part.motion = Motion::Free;
  part.assembly = 0;
  part.shape = scene.add(box({3, 0.4, 1.4}, 800 / 1.68));
  part.at = {0, 0.71, 0};
  const int chassis = scene.add(part);
  // 25 kg each.
  part.shape = scene.add(wheels == Wheels::Balls ? ball(kRadius, 25 / 0.5236) : prism(40, kRadius, 0.3, 25 / 0.2346));
  for (const double x : {-1.1, 1.1})
    for (const double z : {-1.2, 1.2}) {
      if (flat && z < 0) continue;
      part.at = {x, 0.51, flat ? 0 : z};
      Joint axle;
      axle.parent = chassis;
      axle.child = scene.add(part);
      axle.at = part.at;
      axle.strength = 600;
      scene.joints.push_back(axle);
    }
  scene.act = [count = static_cast<int>(scene.joints.size())](Side& side, double) {
    for (int i = 0; i < count; ++i) side.set_motor(i, -kSpeed / kRadius);
  };
  return scene;
}

namespace {

struct Gait {
  int first = 0;  // its first hinge
  Genes genes;
};

Gait add_walker(Scene& scene, const std::vector<std::size_t>& shapes, const Vector3& at, int number) {
  const auto& all = sections();
  const Gait gait{static_cast<int>(scene.joints.size()), genes(number % 10)};
  std::vector<int> links;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Body link;
    link.shape = shapes[i];
    link.at = at;
    link.assembly = number;
    Joint hinge;
    if (all[i].parent >= 0) {
      const auto parent = static_cast<std::size_t>(all[i].parent);
      hinge.parent = links[parent];
      hinge.at = scene.bodies[static_cast<std::size_t>(hinge.parent)].at + all[i].on_parent;
      if (scene.flat) hinge.at.z() = 0;
      link.at = hinge.at - all[i].on_child;
      hinge.strength = kHingeStrength;
    }
    links.push_back(scene.add(link));
    hinge.child = links.back();
    if (all[i].parent >= 0) scene.joints.push_back(hinge);
  }
  return gait;
}

}  // namespace

/// Walkers of ten kinds, too far from one another to meet.
Scene walkers(int count, bool flat) {
  constexpr double kApart = 6;  // m: limbs stretched out reach 2.3 m
  Scene scene;
  scene.flat = flat;
  scene.friction = 1;
  add_floor(scene, flat ? 4000 : 400);
  std::vector<std::size_t> shapes;
  for (const Section& section : sections()) shapes.push_back(scene.add(box(section.size)));
  std::vector<Gait> gaits;
  for (int i = 0; i < count; ++i) {
    const Vector3 at =
        flat ? Vector3(kApart * (i - count / 2), 1.7, 0) : Vector3(kApart * (i % 15 - 7), 1.7, kApart * (i / 15 - 7));
    gaits.push_back(add_walker(scene, shapes, at, i));
  }
  scene.act = [gaits](Side& side, double time) {
    for (const Gait& gait : gaits)
      for (int i = 0; i < kHinges; ++i)
        side.set_motor(gait.first + i, gait.genes.speed(i, time, side.angle(gait.first + i)));
  };
  return scene;
}

namespace {

/// Limbs of a ragdoll, from the chest on.
class Doll {
 public:
  Doll(Scene& scene, const Vector3& at) : scene_(scene) { chest_ = limb({0.2, 0.5, 0.4}, 25, at); }
  int chest() const { return chest_; }

  /// A limb of this size and mass; the joint is at these points of its parent and itself.
  int hang(int parent, Vector3 on_parent, const Vector3& on_child, const Vector3& size, double mass, Joint joint) {
    if (scene_.flat) {
      on_parent.z() = 0;
      joint.kind = Link::Hinge;
    }
    joint.parent = parent;
    joint.at = scene_.bodies[static_cast<std::size_t>(parent)].at + on_parent;
    joint.child = limb(size, mass, joint.at - on_child);
    scene_.joints.push_back(joint);
    return joint.child;
  }

 private:
  int limb(const Vector3& size, double mass, const Vector3& at) {
    Body body;
    body.shape = scene_.add(box(size, mass / size.prod()));
    body.at = at;
    body.assembly = 0;
    body.velocity = {-2.5, 1, scene_.flat ? 0 : 0.3};
    return scene_.add(body);
  }

  Scene& scene_;
  int chest_ = 0;
};

Joint ball_joint(const Vector3& low, const Vector3& high) {
  Joint out;
  out.kind = Link::Ball;
  out.low = low;
  out.high = high;
  return out;
}

Joint hinge(double low, double high) {
  Joint out;
  out.low[0] = low;
  out.high[0] = high;
  return out;
}

}  // namespace

/// A limp ragdoll of eleven limbs is thrown down ten steps.
Scene ragdoll(bool flat) {
  Scene scene;
  scene.flat = flat;
  scene.friction = 0.5;
  add_floor(scene);
  Body stair;
  stair.shape = scene.add(box({1, 0.5, 4}));
  stair.motion = Motion::Fixed;
  for (int i = 0; i < 10; ++i) {
    stair.at = {static_cast<double>(i), 0.25 + 0.5 * i, 0};
    scene.add(stair);
  }
  Doll doll(scene, {9, 6.4, 0});
  const auto both = [](const Vector3& most) { return ball_joint(-most, most); };
  doll.hang(doll.chest(), {0, 0.28, 0}, {0, -0.15, 0}, {0.22, 0.25, 0.2}, 5, both({0.5, 0.5, 0.8}));
  const int hips = doll.hang(doll.chest(), {0, -0.27, 0}, {0, 0.12, 0}, {0.2, 0.2, 0.35}, 12, both({0.4, 0.4, 0.6}));
  for (const double side : {-1, 1}) {
    const int arm =
        doll.hang(doll.chest(), {0, 0.2, 0.28 * side}, {0, 0.2, 0}, {0.1, 0.35, 0.1}, 2.5, both({1, 1, 1.5}));
    doll.hang(arm, {0, -0.2, 0}, {0, 0.2, 0}, {0.08, 0.35, 0.08}, 1.5, hinge(0, 2.2));
    const int thigh = doll.hang(hips, {0, -0.12, 0.12 * side}, {0, 0.22, 0}, {0.14, 0.4, 0.14}, 8,
                                ball_joint({-0.3, -0.3, -0.5}, {0.3, 0.3, 1}));
    doll.hang(thigh, {0, -0.22, 0}, {0, 0.22, 0}, {0.12, 0.4, 0.12}, 4, hinge(-2.2, 0));
  }
  return scene;
}

}  // namespace breve::scenes
