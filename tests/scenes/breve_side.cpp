// A scene as a world of breve.
#include "tests/scenes/breve_side.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace breve::scenes {
namespace {

/// The library alone has no flat controller, and no class of agents with collision handlers.
std::string program(bool flat) {
  const std::string controller = flat ? "PlanarControl" : "PhysicalControl";
  return "@use " + controller + ".\n@use MultiBody.\n@use Stationary.\n@use Shape.\n@use Spring.\n" +
         "Controller Scene.\n" + controller + " : Scene {}\n" +
         "Mobile : Agent {\n"
         "  + variables:\n"
         "    touches (int).\n"
         "  + to init:\n"
         "    self handle-collisions with-type \"Stationary\" with-method \"touch\".\n"
         "  + to touch on other (object):\n"
         "    touches++.\n"
         "}\n";
}

const char* class_of(Motion motion) {
  switch (motion) {
    case Motion::Fixed: return "Stationary";
    case Motion::Agent: return "Agent";
    case Motion::Free: break;
  }
  return "Mobile";
}

}  // namespace

BreveSide::BreveSide(const Scene& scene, breve_rung rung, double step)
    : scene_(scene), world_(step, rung, program(scene.flat)), bodies_(scene.bodies.size()) {
  world_.set_gravity(Vector3(0, -scene.gravity, 0));
  for (const Shape& shape : scene.shapes) add_shape(shape);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].born == 0) appear(static_cast<int>(i));
  for (const Joint& joint : scene.joints) add_joint(joint);
  for (const Spring& spring : scene.springs) add_spring(spring);
}

void BreveSide::add_shape(const Shape& shape) {
  breve_geometry geometry = breve_geometry_default();
  std::vector<std::uint32_t> sizes, indices;
  for (const auto& face : shape.faces) {
    sizes.push_back(static_cast<std::uint32_t>(face.size()));
    indices.insert(indices.end(), face.begin(), face.end());
  }
  switch (shape.form) {
    case Form::Ball: geometry.kind = BREVE_SHAPE_SPHERE; break;
    case Form::Box: geometry.kind = BREVE_SHAPE_BOX; break;
    case Form::Convex: geometry.kind = BREVE_SHAPE_CONVEX; break;
    case Form::Mesh: geometry.kind = BREVE_SHAPE_MESH; break;
    case Form::Field: geometry.kind = BREVE_SHAPE_HEIGHT_FIELD; break;
  }
  geometry.radius = shape.radius;
  Vector3::Map(geometry.size) = shape.size;
  if (!shape.corners.empty()) geometry.vertices = shape.corners.front().data();
  geometry.vertex_count = shape.corners.size();
  geometry.face_sizes = sizes.data(), geometry.face_count = sizes.size();
  geometry.indices = indices.data(), geometry.index_count = indices.size();
  geometry.heights = shape.heights.data();
  geometry.columns = shape.columns, geometry.rows = shape.rows, geometry.tile = shape.tile;
  geometry.density = shape.density;
  world_.must(breve_shape_create(world_.get(), &geometry, &shapes_.emplace_back()));
}

void BreveSide::appear(int body) {
  const Body& one = scene_.bodies[static_cast<std::size_t>(body)];
  breve_object& made = bodies_[static_cast<std::size_t>(body)];
  if (made.generation != 0) return;  // it has been there from the start
  made = world_.make(class_of(one.motion));
  world_.must(breve_object_set_shape(world_.get(), made, shapes_[one.shape]));
  world_.place(made, one.at, one.orientation);
  world_.set_material(made, {scene_.friction, scene_.friction, scene_.restitution, 0, scene_.threshold});
  if (one.motion == Motion::Free) world_.must(breve_object_set_physics(world_.get(), made, true));
  if (one.velocity != Vector3::Zero()) world_.set_velocity(made, one.velocity);
  if (one.spin != Vector3::Zero()) world_.set_spin(made, one.spin);
}

void BreveSide::add_joint(const Joint& joint) {
  const auto parent = static_cast<std::size_t>(joint.parent), child = static_cast<std::size_t>(joint.child);
  const bool hinge = joint.kind == Link::Hinge;
  breve_joint_description description =
      breve_joint_description_default(hinge ? BREVE_JOINT_REVOLUTE : BREVE_JOINT_BALL);
  description.parent = bodies_[parent];
  description.child = bodies_[child];
  Vector3::Map(description.parent_point) = joint.at - scene_.bodies[parent].at;
  Vector3::Map(description.child_point) = joint.at - scene_.bodies[child].at;
  Vector3::Map(description.normal) = hinge ? joint.axis : Vector3(Vector3::UnitX());
  Vector3::Map(description.other_axis) = Vector3::UnitZ();
  world_.must(breve_joint_create(world_.get(), &description, &joints_.emplace_back()));
  // breve counts what the parent turns against the child.
  breve_drive drive = world_.drive(joints_.back());
  for (int i = 0; i < 3; ++i) drive.low[i] = -joint.high[i], drive.high[i] = -joint.low[i];
  drive.strength_limit = joint.strength;
  world_.set_drive(joints_.back(), drive);
}

void BreveSide::add_spring(const Spring& spring) {
  breve_spring description = breve_spring_default();
  description.from = bodies_[static_cast<std::size_t>(spring.a)];
  description.to = bodies_[static_cast<std::size_t>(spring.b)];
  description.length = spring.length;
  description.strength = spring.stiffness;
  description.damping = spring.damping;
  breve_object made{};
  world_.must(breve_spring_create(world_.get(), &description, &made));
}

/// From poses: breve_joint_state would also work out what the joint holds.
double BreveSide::angle(int joint) const {
  const Joint& one = scene_.joints[static_cast<std::size_t>(joint)];
  const Quaternion between = world_.orientation(body(one.parent)).conjugate() * world_.orientation(body(one.child));
  return 2 * std::atan(between.vec().dot(one.axis) / between.w());
}

void BreveSide::set_force(int body, const Vector3& force) {
  world_.set_force(bodies_[static_cast<std::size_t>(body)], force);
}

void BreveSide::set_velocity(int body, const Vector3& velocity) {
  world_.set_velocity(bodies_[static_cast<std::size_t>(body)], velocity);
}

void BreveSide::set_motor(int joint, double speed) {
  const breve_object made = joints_[static_cast<std::size_t>(joint)];
  breve_drive drive = world_.drive(made);
  drive.motor_speed[0] = -speed;
  world_.set_drive(made, drive);
}

}  // namespace breve::scenes
