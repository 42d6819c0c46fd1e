#include "creature.hpp"

#include <cmath>

#include "overlap.hpp"

namespace adversary {

namespace {

constexpr double kPi = 3.14159265358979323846;

Vector3 vector(const LinkGenes& genes, LinkGene first) {
  return Vector3(genes[first], genes[first + 1], genes[first + 2]);
}
Vector3 vector(const Case& is, WorldGene first) {
  return Vector3(is.world[first], is.world[first + 1], is.world[first + 2]);
}

Quaternion exponential(const Vector3& rotation) {
  const double angle = rotation.norm();
  return angle > 0 ? Quaternion(Eigen::AngleAxisd(angle, rotation / angle)) : Quaternion::Identity();
}

void put(double* out, const Vector3& v) { Vector3::Map(out) = v; }
void put(double* out, const Quaternion& q) { out[0] = q.w(), out[1] = q.x(), out[2] = q.y(), out[3] = q.z(); }

/// An octahedron with its corners on the axes.
struct Octahedron {
  double corners[18] = {};
  std::uint32_t sizes[8] = {3, 3, 3, 3, 3, 3, 3, 3};
  std::uint32_t indices[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  explicit Octahedron(const Vector3& half) {
    for (int k = 0; k < 3; ++k) corners[6 * k + k] = half[k], corners[6 * k + 3 + k] = -half[k];
  }
};

breve::Vector array(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

double Joint::beat(double time, int k) const {
  return frequency > 0 ? std::sin(2 * kPi * frequency * time + phase + k) : 1;
}

Creature::Creature(const Case& is, breve_rung rung, double step) {
  runtime_ = breve::Runtime::create().or_throw();
  program_ = runtime_.library_program().or_throw();
  breve_world_config config = breve_world_config_default();
  config.iteration_step = config.integration_step = step;
  world_ = runtime_.world(program_, config).or_throw();
  breve_accuracy accuracy = breve_accuracy_default();
  if (breve_rung_accuracy(rung, &accuracy) != BREVE_OK) throw breve::Failure(BREVE_ERROR_ARGUMENT, "no such rung");
  accuracy.contact_springs = accuracy.link_springs = false;  // what they store cannot be measured from outside
  world_.set_accuracy(accuracy).or_throw();
  if (has_gravity(is.family)) gravity_ = Vector3(0, -9.81, 0);
  world_.set_gravity(array(gravity_)).or_throw();
  for (const LinkGenes& genes : is.links) add_link(genes, is);
  for (int i = is.family == Family::Hang ? 0 : 1; i < is.count(); ++i)
    join(is.links[static_cast<std::size_t>(i)], is, i);
  place(is);
  close_loop(is);
  add_spring(is);
  // Overlap at the start is moved apart, which lifts bodies and strains springs: a family of its own.
  if (is.on(kSelfCollisions) && (is.family == Family::Overlap || !entangled()))
    if (const breve_status s = breve_object_set_self_collisions(world_.get(), bodies_[0].object, true); s != BREVE_OK)
      throw breve::Failure(s, breve_world_last_error(world_.get())->text);
  set_off(is);
}

void Creature::add_link(const LinkGenes& genes, const Case& is) {
  Body body;
  body.object = world_.create("Link").or_throw();
  body.mass = genes[kMass];
  Vector3 size = vector(genes, kSizeX);
  breve_geometry geometry = breve_geometry_default();
  const int shape = static_cast<int>(genes[kShape]);
  if (shape == 0) size = Vector3::Constant(size.x());
  body.half = 0.5 * size;
  const Vector3 squares = body.half.cwiseAbs2();
  const Vector3 sums(squares.y() + squares.z(), squares.z() + squares.x(), squares.x() + squares.y());
  const Octahedron octahedron(body.half);
  double volume = 0;
  if (shape == 0) {
    geometry.kind = BREVE_SHAPE_SPHERE;
    geometry.radius = body.half.x();
    volume = 4.0 / 3 * kPi * body.half.prod();
    body.inertia = body.mass * sums / 5;
  } else if (shape == 1) {
    geometry.kind = BREVE_SHAPE_BOX;
    put(geometry.size, size);
    volume = size.prod();
    body.inertia = body.mass * sums / 3;
  } else {
    geometry.kind = BREVE_SHAPE_CONVEX;
    geometry.vertices = octahedron.corners, geometry.vertex_count = 6;
    geometry.face_sizes = octahedron.sizes, geometry.face_count = 8;
    geometry.indices = octahedron.indices, geometry.index_count = 24;
    volume = 4.0 / 3 * body.half.prod();
    body.inertia = body.mass * sums / 10;
  }
  geometry.density = body.mass / volume;
  const breve_object made = world_.create_shape(geometry).or_throw();
  world_.set_shape(body.object, made).or_throw();
  world_.set_physics(body.object, true).or_throw();
  world_.set_material(body.object, {is[kFriction], is[kFriction], is[kRestitution], 0, is[kThreshold]}).or_throw();
  bodies_.push_back(body);
}

void Creature::join(const LinkGenes& genes, const Case& is, int link) {
  Joint joint;
  joint.kind = static_cast<breve_joint_kind>(static_cast<int>(genes[kJoint]));
  joint.child = link;
  joint.parent = link == 0 ? -1 : static_cast<int>(genes[kParent]) % link;
  const auto child = static_cast<std::size_t>(link);
  if (joint.parent >= 0)
    joint.on_parent = bodies_[static_cast<std::size_t>(joint.parent)].half.cwiseProduct(vector(genes, kAtX));
  joint.on_child = bodies_[child].half.cwiseProduct(vector(genes, kOnX));
  joint.axis = vector(genes, kAxisX);
  joint.axis = joint.axis.norm() > 1e-3 ? joint.axis.normalized() : Vector3(0, 0, 1);
  joint.other = joint.axis.unitOrthogonal();
  joint.zero = exponential(vector(genes, kRotationX));
  breve_joint_description d = breve_joint_description_default(joint.kind);
  if (joint.parent >= 0) d.parent = bodies_[static_cast<std::size_t>(joint.parent)].object;
  d.child = bodies_[child].object;
  put(d.parent_point, joint.on_parent);
  put(d.child_point, joint.on_child);
  put(d.normal, joint.axis);
  put(d.other_axis, joint.other);
  put(d.rotation, joint.zero);
  joint.object = world_.create_joint(d).or_throw();
  constexpr int axes[] = {1, 1, 0, 2, 3};
  joint.axes = axes[joint.kind];
  set_drive(genes, is, joint);
  joints_.push_back(joint);
}

void Creature::set_drive(const LinkGenes& genes, const Case& is, Joint& joint) {
  joint.drive = world_.drive(joint.object).or_throw();
  if (joint.axes == 0) return;
  breve_drive& drive = joint.drive;
  if (has_motors(is.family)) {
    drive.strength_limit = genes[kStrength] * genes[kMass];
    if (drive.strength_limit > 0) joint.speed = genes[kSpeed];
    // The axes of a ball joint rotate with it: the work of a force along them is not force times path.
    if (joint.kind != BREVE_JOINT_BALL) joint.torque = genes[kTorque] * genes[kMass];
  }
  joint.frequency = genes[kFrequency];
  joint.phase = genes[kPhase];
  drive.stiffness = genes[kStiffness];
  drive.damping = genes[kDamping];
  drive.limit_restitution = genes[kRebound];
  for (int k = 0; k < joint.axes; ++k) {
    if (joint.kind != BREVE_JOINT_BALL) drive.rest[k] = genes[kRest];
    // The middle angle of a ball joint has limits of its own.
    const double own = joint.kind == BREVE_JOINT_BALL && k == 1 ? drive.high[k] : INFINITY;
    if (genes[kReach] > 0) drive.high[k] = std::min(own, genes[kReach]), drive.low[k] = -drive.high[k];
  }
  world_.set_drive(joint.object, drive).or_throw();
  if (joint.speed != 0 || joint.torque != 0) driven_ = true;
}

void Creature::drive() {
  if (!driven_) return;
  for (Joint& joint : joints_) {
    if (joint.speed == 0 && joint.torque == 0) continue;
    for (int k = 0; k < joint.axes; ++k) {
      joint.drive.motor_speed[k] = joint.speed * joint.beat(world_.time(), k);
      joint.drive.force[k] = joint.torque * joint.beat(world_.time(), k);
    }
    world_.set_drive(joint.object, joint.drive).or_throw();
  }
}

Pose Creature::pose(int body) const {
  if (body < 0) return {};
  const breve_pose is = world_.pose(bodies_[static_cast<std::size_t>(body)].object).or_throw();
  return {Vector3(is.location), Quaternion(is.rotation[0], is.rotation[1], is.rotation[2], is.rotation[3])};
}

double Creature::lowest() const {
  double low = INFINITY;
  for (int i = 0; i < static_cast<int>(bodies_.size()); ++i) {
    const Pose at = pose(i);
    const Vector3 up = at.orientation.conjugate() * Vector3(0, 1, 0);
    low = std::min(low, at.at.y() - up.cwiseAbs().dot(bodies_[static_cast<std::size_t>(i)].half));
  }
  return low;
}

void Creature::place(const Case& is) {
  if (is.family == Family::Hang) return;
  breve_pose pose{};
  put(pose.rotation, exponential(vector(is, kTiltX)));
  const breve_object root = bodies_[0].object;
  const auto move = [&] {
    const breve_status s = breve_object_set_assembly_pose(world_.get(), root, &pose);
    if (s != BREVE_OK) throw breve::Failure(s, breve_world_last_error(world_.get())->text);
  };
  move();
  if (!has_floor(is.family)) return;
  pose.location[1] = is[kHeight] - lowest();
  move();
  const breve_object floor = world_.create("Stationary").or_throw();
  breve_geometry box = breve_geometry_default();
  box.kind = BREVE_SHAPE_BOX;
  box.size[0] = box.size[2] = 400, box.size[1] = 20;
  world_.set_shape(floor, world_.create_shape(box).or_throw()).or_throw();
  world_.set_pose(floor, {{0, -10, 0}, {1, 0, 0, 0}}).or_throw();
  world_.set_material(floor, {is[kFriction], is[kFriction], is[kRestitution], 0, is[kThreshold]}).or_throw();
}

void Creature::close_loop(const Case& is) {
  if (!is.on(kLoop) || is.count() < 3) return;
  const int a = static_cast<int>(is[kLoopA]) % is.count(), b = static_cast<int>(is[kLoopB]) % is.count();
  if (a == b) return;
  for (const Joint& joint : joints_)
    if ((joint.parent == a && joint.child == b) || (joint.parent == b && joint.child == a)) return;
  const Body &from = bodies_[static_cast<std::size_t>(a)], &to = bodies_[static_cast<std::size_t>(b)];
  const Pose at = pose(a), other = pose(b);
  const Vector3 point = from.half.cwiseProduct(vector(is, kLoopX));
  breve_joint_description d =
      breve_joint_description_default(is[kLoop] < 1.5 ? BREVE_JOINT_BALL : BREVE_JOINT_REVOLUTE);
  d.parent = from.object;
  d.child = to.object;
  put(d.parent_point, point);
  put(d.child_point, other.orientation.conjugate() * (at.at + at.orientation * point - other.at));
  put(d.rotation, (at.orientation.conjugate() * other.orientation).normalized());
  put(d.normal, Vector3::UnitZ());
  put(d.other_axis, Vector3::UnitX());
  (void)world_.create_joint(d).or_throw();
  loop_a_ = a, loop_b_ = b;
}

void Creature::add_spring(const Case& is) {
  if (!(is[kSpring] > 0)) return;
  const int a = static_cast<int>(is[kSpringA]) % is.count(), b = static_cast<int>(is[kSpringB]) % is.count();
  if (a == b) return;
  spring_ = {a, b, is[kSpring], is[kSpringLength]};
  breve_spring d = breve_spring_default();
  d.from = bodies_[static_cast<std::size_t>(a)].object;
  d.to = bodies_[static_cast<std::size_t>(b)].object;
  d.length = spring_.length;
  d.strength = spring_.strength;
  d.damping = 0;
  (void)world_.create_spring(d).or_throw();
}

bool Creature::entangled() const {
  const int count = static_cast<int>(bodies_.size());
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) {
      bool joined = loop_a_ >= 0 && std::minmax(loop_a_, loop_b_) == std::minmax(a, b);
      for (const Joint& joint : joints_) joined |= std::minmax(joint.parent, joint.child) == std::minmax(a, b);
      if (joined) continue;
      const Pose at = pose(a), other = pose(b);
      if (boxes_overlap({at.at, at.orientation.toRotationMatrix(), bodies_[static_cast<std::size_t>(a)].half},
                        {other.at, other.orientation.toRotationMatrix(), bodies_[static_cast<std::size_t>(b)].half}))
        return true;
    }
  return false;
}

void Creature::set_off(const Case& is) {
  for (const Joint& joint : joints_) {
    const LinkGenes& genes = is.links[static_cast<std::size_t>(joint.child)];
    double rate[3] = {genes[kRateX], genes[kRateY], genes[kRateZ]};
    for (int k = joint.axes; k < 3; ++k) rate[k] = 0;
    if (joint.axes == 0 || loop_a_ >= 0) continue;  // a closed loop is not free to move so
    const breve_status s = breve_joint_set_state(world_.get(), joint.object, nullptr, rate);
    if (s != BREVE_OK) throw breve::Failure(s, breve_world_last_error(world_.get())->text);
  }
  const breve_object first = bodies_[0].object;
  const Vector3 velocity = vector(is, kVelocityX), spin = vector(is, kSpinX);
  if (is.family == Family::Hang) return;
  if (!velocity.isZero()) world_.set_velocity(first, array(velocity)).or_throw();
  if (!spin.isZero()) world_.set_rotational_velocity(first, array(spin)).or_throw();
}

}  // namespace adversary
