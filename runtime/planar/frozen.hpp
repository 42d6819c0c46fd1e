// Box2D's world as data: impulses of contacts and joints, and all that an image of a flat world holds.
#pragma once

#include <box2d/box2d.h>

#include <compare>
#include <cstdint>
#include <memory_resource>
#include <utility>
#include <vector>

#include "runtime/mechanics/core.hpp"

namespace breve {

/// Impulses that Box2D starts the next step from.
struct WarmJoint {
  float x = 0, y = 0, angular = 0, motor = 0, lower = 0, upper = 0;
};

/// Which two shapes meet: indices of bodies, of their fixtures, and of a profile's edge. The first one has the
/// lower numbers.
struct ContactKey {
  BodyIndex a = kNoBody, b = kNoBody;
  std::uint32_t fixture_a = 0, fixture_b = 0, child_a = 0, child_b = 0;
  friend auto operator<=>(const ContactKey&, const ContactKey&) = default;
};
struct ContactImpulse {
  std::uint32_t id = 0;
  float normal = 0, tangent = 0;
};
struct WarmContact {
  ContactKey key;
  int count = 0;
  ContactImpulse points[2];
};
struct FrozenBody {
  BodyIndex body = kNoBody;
  float x = 0, y = 0, angle = 0, center_x = 0, center_y = 0, vx = 0, vy = 0, spin = 0;
  float before_x = 0, before_y = 0, angle_before = 0;  // of its centre, before its last step
  float still = 0;                                     // s, since when it has been slow enough to sleep
  bool awake = true;
  bool kinematic = false, driven = false;  // moved by a script once, or in the last step
  bool pulled = false;                     // by a spring or a force method in the last step
  bool placed = false;                     // since Box2D last paired
  Vector3 location = Vector3::Zero(), velocity = Vector3::Zero(), rotational_velocity = Vector3::Zero();
  Quaternion orientation{1, 0, 0, 0};
  double force_x = 0, force_y = 0, torque = 0;  // set by scripts, N and N*m, as the last step knew them
};
/// The roomy box of a fixture, or of an edge of one that is a profile.
struct FrozenBox {
  BodyIndex body = kNoBody;
  std::uint32_t fixture = 0, child = 0;
  float low_x = 0, low_y = 0, high_x = 0, high_y = 0;
};
/// Two shapes that are near each other.
struct FrozenContact {
  ContactKey key;
  bool touching = false;
  float friction = 0;     // its coefficient in the last step
  std::uint8_t type = 0;  // the manifold's
  b2Manifold manifold;
};
struct FrozenJoint {
  JointIndex joint = kNoJoint;
  float reference = 0;  // rad, between its bodies, where its position is zero
  bool loose = false;   // its limit is off
  WarmJoint warm;
};
/// Impulses of a step of some length.
struct Warm {
  float step = 0;                                             // s
  std::pmr::vector<WarmContact> contacts;                     // by key
  std::pmr::vector<std::pair<JointIndex, WarmJoint>> joints;  // by index
  explicit Warm(std::pmr::memory_resource* memory) : contacts(memory), joints(memory) {}
};
/// Box2D's world as data: what an image holds, and what a world is made of when it is loaded.
struct Frozen {
  float step = 0;                            // s, the length of the last one
  std::pmr::vector<FrozenBody> bodies;       // by body
  std::pmr::vector<FrozenBox> boxes;         // by body, fixture and child
  std::pmr::vector<FrozenContact> contacts;  // by key
  std::pmr::vector<FrozenJoint> joints;      // by index
  explicit Frozen(std::pmr::memory_resource* memory)
      : bodies(memory), boxes(memory), contacts(memory), joints(memory) {}
};

}  // namespace breve
