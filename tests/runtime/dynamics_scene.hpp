// Worlds with joints for the tests of dynamics: by hand, or from the systems of the reference files.
#pragma once

#include "articulated_reference.hpp"
#include "fake_behaviour.hpp"
#include "runtime/mechanics/mechanics.hpp"

namespace breve::testing {

namespace ref = breve::articulated::reference;

/// A box whose mass properties are replaced by what is asked for.
inline std::shared_ptr<Shape> solid(double mass, const Matrix3& inertia, const Vector3& size = Vector3(1, 1, 1)) {
  std::shared_ptr<Shape> shape = Shape::box(size);
  shape->set_mass(mass);
  shape->set_inertia(inertia);
  return shape;
}

struct Physics : Scene {
  explicit Physics(double step = 1.0 / 60) {
    world.set_integration_step(step);
    world.set_iteration_step(step);
    script.recording = false;
  }
  Mechanics& mechanics() { return world.mechanics(); }
  /// A physics-enabled body.
  ObjectId rigid(std::shared_ptr<Shape> shape, const Vector3& at, const Quaternion& rotation = Quaternion::Identity()) {
    const ObjectId id = body(1, at, BodyKind::Mobile, std::move(shape));
    world.bodies().set_orientation(world.body(id), rotation);
    world.bodies().set_physics(world.body(id), true);
    return id;
  }
  BodyIndex index(ObjectId id) { return world.body(id); }
  void run(double seconds) {
    const auto steps = static_cast<long>(std::llround(seconds / world.iteration_step()));
    for (long i = 0; i < steps; ++i) world.step();
  }
};

/// A system of the mb_ files as bodies and joints of a world. Bodies stand at their centres of mass.
struct Machine : Physics {
  std::vector<ObjectId> links;
  std::vector<JointIndex> joints;  // of each; kNoJoint: free
  ref::Case given;

  Machine(const std::string& name, double step, bool with_tau) : Physics(step), given(ref::load(name)) {
    mechanics().set_gravity(given.loads.gravity);
    const articulated::Model model(given.links);
    for (std::size_t i = 0; i < given.links.size(); ++i) add(model, i, with_tau);
    // Joints are closed as by an impact without rebound: so all are made before anything moves.
    for (std::size_t i = 0; i < given.links.size(); ++i) start(model, i);
  }

  void add(const articulated::Model& model, std::size_t i, bool with_tau) {
    const articulated::Link& link = given.links[i];
    const articulated::Body& numbers = model.body(static_cast<int>(i));
    const ObjectId id = rigid(solid(link.mass, link.inertia), Vector3::Zero());
    links.push_back(id);
    joints.push_back(kNoJoint);
    if (link.type == articulated::JointType::Free) return;
    JointDescription is;
    using articulated::JointType;
    const std::map<JointType, JointKind> kinds = {{JointType::Revolute, JointKind::Revolute},
                                                  {JointType::Prismatic, JointKind::Prismatic},
                                                  {JointType::Universal, JointKind::Universal},
                                                  {JointType::Ball, JointKind::Ball},
                                                  {JointType::Fixed, JointKind::Fixed}};
    is.kind = kinds.at(link.type);
    is.child = index(id);
    is.child_point = -link.com;
    is.relative_rotation = link.rotation;
    if (link.parent >= 0) {
      is.parent = index(links[static_cast<std::size_t>(link.parent)]);
      is.parent_point = link.position - given.links[static_cast<std::size_t>(link.parent)].com;
    } else {
      is.parent_point = link.position;
    }
    // The file's angles turn the child along +axis, ours the parent.
    is.normal = link.rotation * -link.axis;
    if (link.type == JointType::Universal) is.other_axis = link.rotation * -link.axis2;
    const JointIndex joint = joints.back() = mechanics().link(is, id);
    JointDrive drive = mechanics().drive(joint);
    if (with_tau && given.loads.tau.size() && axis_count(is.kind) > 0 && link.type != JointType::Ball)
      for (int k = 0; k < axis_count(is.kind); ++k) drive.force[k] = given.loads.tau[numbers.v + k];
    if (!given.loads.drives.empty()) {
      drive.stiffness = given.loads.drives[i].stiffness;
      drive.damping = given.loads.drives[i].damping;
    }
    mechanics().set_drive(joint, drive);
  }

  void start(const articulated::Model& model, std::size_t i) {
    const articulated::Link& link = given.links[i];
    const articulated::Body& numbers = model.body(static_cast<int>(i));
    const double *q = given.state.q.data() + numbers.q, *v = given.state.v.data() + numbers.v;
    const ObjectId id = links[i];
    const JointIndex joint = joints[i];
    if (link.type == articulated::JointType::Free) {
      const Quaternion rotation = link.rotation * Quaternion(q[3], q[4], q[5], q[6]);
      const Vector3 spin = rotation * Vector3(v[3], v[4], v[5]);
      const Vector3 arm = rotation * link.com;
      world.bodies().set_orientation(index(id), rotation);
      world.bodies().set_location(index(id), link.position + link.rotation * Vector3(q[0], q[1], q[2]) + arm);
      world.bodies().set_velocity(index(id), link.rotation * Vector3(v[0], v[1], v[2]) + spin.cross(arm));
      world.bodies().set_rotational_velocity(index(id), spin);
      return;
    }
    const int axes = axis_count(mechanics().joint(joint).kind);
    if (link.type == articulated::JointType::Ball) {
      start_ball(link, joint, q, v);
    } else if (axes > 0) {
      mechanics().set_position(joint, {q[0], axes == 2 ? q[1] : 0, 0});
      mechanics().set_velocity(joint, {v[0], axes == 2 ? v[1] : 0, 0});
    }
  }

  /// The quaternion and spin of the file, by turning the last link about its joint and striking it.
  void start_ball(const articulated::Link& link, JointIndex joint, const double* q, const double* v) {
    const Quaternion model(q[0], q[1], q[2], q[3]);
    mechanics().set_ball(joint, link.rotation * model * link.rotation.conjugate(),
                         link.rotation * (model * Vector3(v[0], v[1], v[2])));
  }

  /// q and v of the file's conventions, read from the poses and velocities of the bodies.
  articulated::State read() {
    articulated::State state = given.state;
    const articulated::Model model(given.links);
    const Bodies& bodies = world.bodies();
    for (std::size_t i = 0; i < links.size(); ++i) {
      const articulated::Link& link = given.links[i];
      const articulated::Body& numbers = model.body(static_cast<int>(i));
      double *q = state.q.data() + numbers.q, *v = state.v.data() + numbers.v;
      const BodyIndex body = index(links[i]);
      const bool held = link.parent >= 0;
      const BodyIndex parent = held ? index(links[static_cast<std::size_t>(link.parent)]) : 0;
      const Quaternion from = held ? bodies.orientation(parent) : Quaternion::Identity();
      const Vector3 spin =
          bodies.rotational_velocity(body) - (held ? bodies.rotational_velocity(parent) : Vector3(Vector3::Zero()));
      const Quaternion rotation = link.rotation.conjugate() * from.conjugate() * bodies.orientation(body);
      const Vector3 own = bodies.orientation(body).conjugate() * spin;
      if (link.type == articulated::JointType::Free) {
        const Vector3 arm = bodies.orientation(body) * -link.com;
        const Vector3 at = bodies.location(body) + arm - link.position;
        const Vector3 speed = bodies.velocity(body) + bodies.rotational_velocity(body).cross(arm);
        Eigen::Map<Vector3>{q} = link.rotation.conjugate() * at;
        q[3] = rotation.w(), q[4] = rotation.x(), q[5] = rotation.y(), q[6] = rotation.z();
        Eigen::Map<Vector3>{v} = link.rotation.conjugate() * speed;
        Eigen::Map<Vector3>{v + 3} = own;
      } else if (link.type == articulated::JointType::Ball) {
        q[0] = rotation.w(), q[1] = rotation.x(), q[2] = rotation.y(), q[3] = rotation.z();
        Eigen::Map<Vector3>{v} = own;
      } else if (joints[i] != kNoJoint) {
        const JointVector position = mechanics().position(joints[i]), rate = mechanics().velocity(joints[i]);
        for (int k = 0; k < articulated::velocity_count(link.type); ++k) q[k] = position[k], v[k] = rate[k];
      }
    }
    for (const articulated::Body& one : model.bodies()) {
      const bool ball = one.type == articulated::JointType::Ball;
      if (!ball && one.type != articulated::JointType::Free) continue;
      const int at = ball ? one.q : one.q + 3;
      if (state.q.segment<4>(at).dot(given.state.q.segment<4>(at)) < 0) state.q.segment<4>(at) *= -1;
    }
    return state;
  }
};

}  // namespace breve::testing
