// A world built and stepped through breve.h alone: see world.hpp.
#include "world.hpp"

#include <cmath>
#include <stdexcept>

namespace breve::reference {

Solid sphere(double radius, double mass) {
  Solid out;
  out.geometry.radius = radius;
  out.mass = mass;
  return out;
}

Solid box(const Vector3& size, double mass) {
  Solid out;
  out.geometry.kind = BREVE_SHAPE_BOX;
  Vector3::Map(out.geometry.size) = size;
  out.mass = mass;
  return out;
}

Solid lump(double mass, const Matrix3& inertia, const Vector3& size) {
  Solid out = box(size, mass);
  out.inertia = inertia;
  return out;
}

Solid rod(double length, double mass) {
  const double across = mass * length * length / 12;
  return lump(mass, Vector3(across, 1e-4 * across, across).asDiagonal(), length * Vector3(0.02, 1, 0.02));
}

Solid shell(double radius, double mass) {
  Solid out = sphere(radius, mass);
  out.inertia = Matrix3::Identity() * (2.0 / 3 * mass * radius * radius);
  return out;
}

World::World(double step, breve_rung rung, std::uint32_t dimension) {
  must(breve_runtime_create(nullptr, &runtime_));
  must(breve_program_create_library(runtime_, nullptr, &program_));
  open_world(step, rung, dimension);
}

World::World(double step, breve_rung rung, const std::string& program) {
  must(breve_runtime_create(nullptr, &runtime_));
  must(breve_program_compile(runtime_, "test.tz", program.c_str(), program.size(), &program_));
  open_world(step, rung, 0);
}

void World::open_world(double step, breve_rung rung, std::uint32_t dimension) {
  breve_world_config config = breve_world_config_default();
  config.iteration_step = config.integration_step = step;
  config.dimension = dimension;
  must(breve_world_create(runtime_, program_, &config, &world_));
  set_gravity(Vector3(0, -9.81, 0));  // the class library starts with 9.8
  set_rung(rung);
}

World::~World() {
  breve_world_destroy(world_);
  breve_program_destroy(program_);
  breve_runtime_destroy(runtime_);
}

void World::must(breve_status status) const {
  if (status == BREVE_OK) return;
  const breve_error* error = world_ ? breve_world_last_error(world_) : breve_runtime_last_error(runtime_);
  throw std::runtime_error(std::string(breve_status_name(status)) + ": " + (error ? error->text : ""));
}

void World::set_gravity(const Vector3& gravity) { must(breve_world_set_gravity(world_, gravity.data())); }

void World::set_rung(breve_rung rung) {
  breve_accuracy accuracy = breve_accuracy_default();
  must(breve_rung_accuracy(rung, &accuracy));
  set_accuracy(accuracy);
}

breve_accuracy World::accuracy() const {
  breve_accuracy accuracy = breve_accuracy_default();
  must(breve_world_accuracy(world_, &accuracy));
  return accuracy;
}

void World::set_accuracy(const breve_accuracy& accuracy) { must(breve_world_set_accuracy(world_, &accuracy)); }

void World::set_integrator(breve_integrator integrator) {
  breve_accuracy a = accuracy();
  a.integrator = integrator;
  a.implicit_joints = a.implicit_spin = false;
  a.step = a.contact_step = 0;
  set_accuracy(a);
}

void World::set_guard(breve_guard guard) { must(breve_world_set_guard(world_, guard)); }

breve_object World::make(const char* class_name) {
  breve_object made{};
  must(breve_object_create(world_, class_name, &made));
  return made;
}

breve_object World::shape(const Solid& solid) {
  breve_object shape{};
  breve_geometry geometry = solid.geometry;
  if (!solid.corners.empty()) {
    geometry.vertices = solid.corners.data(), geometry.vertex_count = solid.corners.size() / 3;
    geometry.face_sizes = solid.sizes.data(), geometry.face_count = solid.sizes.size();
    geometry.indices = solid.indices.data(), geometry.index_count = solid.indices.size();
  }
  must(breve_shape_create(world_, &geometry, &shape));
  if (solid.mass) {
    const breve_keyword to{"to", breve_value_double(*solid.mass)};
    must(breve_object_call(world_, shape, "set-mass", &to, 1, nullptr));
  }
  if (solid.inertia) {
    const breve_keyword to{"to", breve_value_matrix(Matrix3(solid.inertia->transpose()).data())};
    must(breve_object_call(world_, shape, "set-inertia-matrix", &to, 1, nullptr));
  }
  return shape;
}

breve_object World::body(const Solid& solid, const Vector3& at, const Quaternion& orientation) {
  const breve_object made = make(body_class.c_str());
  must(breve_object_set_shape(world_, made, shape(solid)));
  must(breve_object_set_physics(world_, made, true));
  place(made, at, orientation);
  return made;
}

breve_object World::fixed(const Solid& solid, const Vector3& at, const Quaternion& orientation) {
  const breve_object made = make("Stationary");
  must(breve_object_set_shape(world_, made, shape(solid)));
  place(made, at, orientation);
  return made;
}

void World::set_material(breve_object body, double friction, double restitution, double tangential) {
  set_material(body, breve_material{friction, friction, restitution, tangential, 0});
}

void World::set_material(breve_object body, const breve_material& material) {
  must(breve_object_set_material(world_, body, &material));
}

void World::place(breve_object body, const Vector3& at, const Quaternion& orientation) {
  const breve_pose pose{{at.x(), at.y(), at.z()}, {orientation.w(), orientation.x(), orientation.y(), orientation.z()}};
  must(breve_object_set_pose(world_, body, &pose));
}

void World::set_velocity(breve_object body, const Vector3& velocity) {
  must(breve_object_set_velocity(world_, body, velocity.data()));
}

void World::set_spin(breve_object body, const Vector3& spin) {
  must(breve_object_set_rotational_velocity(world_, body, spin.data()));
}

void World::set_force(breve_object body, const Vector3& force, const Vector3& torque) {
  must(breve_object_set_force(world_, body, force.data(), torque.data()));
}

Vector3 World::at(breve_object body) const {
  breve_pose pose;
  must(breve_object_pose(world_, body, &pose));
  return vector(pose.location);
}

Quaternion World::orientation(breve_object body) const {
  breve_pose pose;
  must(breve_object_pose(world_, body, &pose));
  return Quaternion(pose.rotation[0], pose.rotation[1], pose.rotation[2], pose.rotation[3]);
}

Vector3 World::velocity(breve_object body) const {
  Vector3 out;
  must(breve_object_velocity(world_, body, out.data()));
  return out;
}

Vector3 World::spin(breve_object body) const {
  Vector3 out;
  must(breve_object_rotational_velocity(world_, body, out.data()));
  return out;
}

bool World::asleep(breve_object body) const {
  bool out = false;
  must(breve_object_asleep(world_, body, &out));
  return out;
}

breve_object World::join(const Hinge& hinge) {
  breve_joint_description d = breve_joint_description_default(hinge.kind);
  d.parent = hinge.parent;
  d.child = hinge.child;
  Vector3::Map(d.parent_point) = hinge.parent_point;
  Vector3::Map(d.child_point) = hinge.child_point;
  Vector3::Map(d.normal) = hinge.normal;
  const Quaternion& r = hinge.rotation;
  d.rotation[0] = r.w(), d.rotation[1] = r.x(), d.rotation[2] = r.y(), d.rotation[3] = r.z();
  breve_object joint{};
  must(breve_joint_create(world_, &d, &joint));
  return joint;
}

breve_joint_info World::read(breve_object joint) const {
  breve_joint_info info;
  must(breve_joint_state(world_, joint, &info));
  return info;
}

breve_drive World::drive(breve_object joint) const {
  breve_drive drive = breve_drive_default();
  must(breve_joint_drive(world_, joint, &drive));
  return drive;
}

void World::set_drive(breve_object joint, const breve_drive& drive) {
  must(breve_joint_set_drive(world_, joint, &drive));
}

void World::set_joint(breve_object joint, double position, double velocity) {
  const double there[3] = {position, 0, 0}, so[3] = {velocity, 0, 0};
  must(breve_joint_set_state(world_, joint, there, so));
}

double World::open(const Hinge& hinge) const {
  const bool held = hinge.parent.generation != 0;
  const Vector3 from =
      held ? Vector3(at(hinge.parent) + orientation(hinge.parent) * hinge.parent_point) : hinge.parent_point;
  return (at(hinge.child) + orientation(hinge.child) * hinge.child_point - from).norm();
}

void World::step() {
  must(breve_world_step(world_));
  const breve_physics_counters counted = counters();
  ++toll_.iterations;
  toll_.sub_steps += counted.sub_steps;
  toll_.most = std::max(toll_.most, counted.sub_steps);
  toll_.evaluations += counted.evaluations;
  toll_.impacts += counted.impacts;
  toll_.interventions += counted.interventions;
  toll_.direct += counted.direct;
}

void World::run(double seconds, const std::function<void()>& look) {
  const auto steps = std::llround(seconds / breve_world_iteration_step(world_));
  for (long long i = 0; i < steps; ++i) {
    step();
    if (look) look();
  }
}

std::vector<breve_impact> World::impacts() const {
  std::size_t count = 0;
  must(breve_world_impacts(world_, nullptr, 0, &count));
  std::vector<breve_impact> out(count);
  must(breve_world_impacts(world_, out.data(), count, &count));
  return out;
}

std::vector<breve_intervention> World::interventions() const {
  std::size_t count = 0;
  must(breve_world_interventions(world_, nullptr, 0, &count));
  std::vector<breve_intervention> out(count);
  must(breve_world_interventions(world_, out.data(), count, &count));
  return out;
}

breve_energy World::energy() const {
  breve_energy energy = breve_energy_default();
  must(breve_world_energy(world_, &energy));
  return energy;
}

double World::mechanical() const {
  const breve_energy now = energy();
  return now.kinetic + now.potential + now.springs;
}

breve_physics_counters World::counters() const {
  breve_physics_counters counters = breve_physics_counters_default();
  must(breve_world_physics_counters(world_, &counters));
  return counters;
}

std::uint64_t World::hash() const {
  std::uint64_t hash = 0;
  must(breve_world_hash(world_, &hash));
  return hash;
}

}  // namespace breve::reference
