// Flat worlds for tests: bodies made by hand, the controller advances them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "../fake_behaviour.hpp"
#include "runtime/mechanics/mechanics.hpp"

namespace breve::testing {

struct Flat : Scene {
  explicit Flat(Rung rung = Rung::Balanced, double step = 1.0 / 60) {
    world.flatten();
    world.set_integration_step(step);
    world.set_iteration_step(step);
    script.recording = false;
    physics().set_accuracy(rung);
    physics().set_guard(GuardMode::Report);
  }
  Mechanics& physics() { return world.mechanics(); }
  BodyIndex index(ObjectId id) { return world.body(id); }
  Bodies& bodies() { return world.bodies(); }

  ObjectId rigid(std::shared_ptr<Shape> shape, double x, double y, double angle = 0, ClassId cls = 1) {
    const ObjectId id = body(cls, {x, y, 0}, BodyKind::Mobile, std::move(shape));
    rotate(id, angle);
    bodies().set_physics(index(id), true);
    return id;
  }
  ObjectId fixed(std::shared_ptr<Shape> shape, double x, double y, double angle = 0, ClassId cls = 2) {
    const ObjectId id = body(cls, {x, y, 0}, BodyKind::Stationary, std::move(shape));
    rotate(id, angle);
    return id;
  }
  ObjectId ground(double width = 1000) { return fixed(Shape::box({width, 10, 1}), 0, -5); }
  ObjectId ball(double radius, double x, double y) { return rigid(Shape::sphere(radius), x, y); }
  ObjectId box(double width, double height, double x, double y) { return rigid(Shape::box({width, height, 1}), x, y); }
  void rotate(ObjectId id, double angle) {
    bodies().set_orientation(index(id), Quaternion(std::cos(angle / 2), 0, 0, std::sin(angle / 2)));
  }
  double angle(ObjectId id) {
    const Quaternion q = bodies().orientation(index(id));
    return 2 * std::atan2(q.z(), q.w());
  }
  void material(ObjectId id, double mu, double e) {
    Material& m = bodies().material(index(id));
    m.static_friction = m.dynamic_friction = mu;
    m.normal_restitution = e;
    m.tangential_restitution = 0;
  }
  void run(double seconds) {
    const auto steps = static_cast<long>(std::llround(seconds / world.iteration_step()));
    for (long i = 0; i < steps; ++i) world.step();
  }
  JointIndex hinge(ObjectId parent, ObjectId child, const Vector3& on_parent, const Vector3& on_child) {
    JointDescription is;
    is.kind = JointKind::Revolute;
    is.parent = parent ? index(parent) : kNoBody;
    is.child = index(child);
    is.parent_point = on_parent;
    is.child_point = on_child;
    is.normal = {0, 0, 1};
    is.keep_rotation = true;
    return physics().link(is, child);
  }
};

}  // namespace breve::testing
