// The nine-link walker of the sample, in C++: a box body and four limbs of two sections, hinges driven by sines.
#pragma once

#include <numbers>

#include "dynamics_scene.hpp"

namespace breve::testing {

struct Walker : Physics {
  explicit Walker(Rung rung, double step = 1.0 / 60) : Physics(step) {
    dynamics().set_accuracy(rung);
    floor = body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(1000, 5, 1000)));
    trunk = rigid(Shape::box(Vector3(2, 0.5, 1)), Vector3(0, 1.7, 0));
    links.push_back(trunk);
    for (const double x : {-0.8, 0.8})
      for (const double z : {-0.65, 0.65}) {
        const ObjectId thigh = hang(trunk, Vector3(x, -0.2, z), Vector3(0, 0.3, 0), Vector3(0.25, 0.7, 0.25));
        hang(thigh, Vector3(0, -0.35, 0), Vector3(0, 0.35, 0), Vector3(0.2, 0.7, 0.2));
      }
    for (const ObjectId link : links) {
      Material& material = world.bodies().material(index(link));
      material.static_friction = 1;
      material.dynamic_friction = 0.8;
      material.normal_restitution = 0;
    }
  }
  ObjectId hang(ObjectId parent, const Vector3& on_parent, const Vector3& on_child, const Vector3& size) {
    const ObjectId id = rigid(Shape::box(size), Vector3::Zero());
    JointDescription is;
    is.parent = index(parent);
    is.child = index(id);
    is.parent_point = on_parent;
    is.child_point = on_child;
    is.normal = Vector3::UnitZ();
    hinges.push_back(dynamics().link(is, id));
    JointDrive drive = dynamics().drive(hinges.back());
    drive.strength_limit = 6;
    drive.damping = 0.05;
    dynamics().set_drive(hinges.back(), drive);
    links.push_back(id);
    return id;
  }
  void step() {
    for (std::size_t i = 0; i < hinges.size(); ++i) {
      const double phase = 0.13 * static_cast<double>(i * i % 7), amplitude = 0.3 + 0.1 * static_cast<double>(i % 4);
      const double goal = amplitude * std::sin(2 * std::numbers::pi * (world.time() / 0.9 + phase));
      JointDrive drive = dynamics().drive(hinges[i]);
      drive.motor_speed[0] = 8 * (goal - dynamics().position(hinges[i])[0]);
      dynamics().set_drive(hinges[i], drive);
    }
    world.step();
  }

  ObjectId floor, trunk;
  std::vector<ObjectId> links;
  std::vector<JointIndex> hinges;
};

}  // namespace breve::testing
