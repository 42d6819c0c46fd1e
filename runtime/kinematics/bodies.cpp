// Bodies: making, removing and setting. Every setter refuses what is not finite before anything changes.
#include "runtime/kinematics/bodies.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "runtime/base/error.hpp"
#include "runtime/kinematics/arrays.hpp"

namespace breve {

namespace {

const Vector3 kZero = Vector3::Zero();

void require_finite(std::string_view property, const Vector3& value) {
  if (value.allFinite()) return;
  throw Error(ErrorCode::Argument,
              fmt::format("{} must be finite, but is ({}, {}, {})", property, value.x(), value.y(), value.z()));
}

/// Parts out of the plane up to here, relative to the whole, are what scripts' arithmetic leaves.
constexpr double kInPlane = 1e-9;

/// In a flat world: a vector with z = 0.
Vector3 in_plane(std::string_view property, const Vector3& value, bool flat) {
  if (!flat || value.z() == 0) return value;
  if (std::abs(value.z()) > kInPlane * std::max(1.0, value.norm()))
    throw Error(ErrorCode::Argument, fmt::format("{} is ({}, {}, {}), but this world is flat: z must be 0", property,
                                                 value.x(), value.y(), value.z()));
  return {value.x(), value.y(), 0};
}

/// In a flat world: a place that single precision can hold, whatever the length unit.
const Vector3& in_reach(const Vector3& location, bool flat) {
  constexpr double kFarthest = 1e28;  // 3e38 at the smallest unit of 1e-9, with room for sums
  if (flat && !(location.cwiseAbs().maxCoeff() <= kFarthest))
    throw Error(ErrorCode::Argument, fmt::format("location is ({}, {}, 0), but a flat world ends at {:g}", location.x(),
                                                 location.y(), kFarthest));
  return location;
}

/// In a flat world: a vector along z.
Vector3 about_z(std::string_view property, const Vector3& value, bool flat) {
  if (!flat || (value.x() == 0 && value.y() == 0)) return value;
  if (value.head<2>().norm() > kInPlane * std::max(1.0, value.norm()))
    throw Error(ErrorCode::Argument,
                fmt::format("{} is ({}, {}, {}), but this world is flat: bodies rotate about z only, x and y must be 0",
                            property, value.x(), value.y(), value.z()));
  return {0, 0, value.z()};
}

/// In a flat world: a rotation about z.
Quaternion rotation_about_z(const Quaternion& unit, bool flat) {
  if (!flat || (unit.x() == 0 && unit.y() == 0)) return unit;
  if (std::hypot(unit.x(), unit.y()) > kInPlane)
    throw Error(ErrorCode::Argument,
                fmt::format("orientation is rotated out of the plane (quaternion {}, {}, {}, {}), but this world is "
                            "flat: bodies rotate about z only",
                            unit.w(), unit.x(), unit.y(), unit.z()));
  return Quaternion(unit.w(), 0, 0, unit.z()).normalized();
}

/// The rotation nearest to a matrix that is one up to round-off or drift.
Quaternion rotation_of(const Matrix3& matrix) {
  if (!matrix.allFinite()) throw Error(ErrorCode::Argument, "rotation must be finite");
  constexpr double kOrthonormal = 1e-12;  // what chains of products by scripts leave
  if ((matrix * matrix.transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff() < kOrthonormal &&
      matrix.determinant() > 0) {
    return Quaternion(Eigen::Matrix3d(matrix)).normalized();
  }
  Eigen::Matrix3d nearest = matrix / std::max(matrix.cwiseAbs().maxCoeff(), 1e-300);
  constexpr double kSingular = 1e-9;  // determinant of a matrix of size 1 whose rows still are three directions
  const double determinant = nearest.determinant();
  if (std::abs(determinant) < kSingular) {
    throw Error(ErrorCode::Argument, "rotation is a singular matrix: its rows must be three independent directions");
  }
  if (determinant < 0) {
    throw Error(ErrorCode::Argument, "rotation is a mirror image: its determinant must be positive");
  }
  // Newton's iteration for the polar decomposition (Higham, 1986): quadratic; the bound is far beyond any use of it.
  for (int i = 0; i < 60; ++i) {
    const Eigen::Matrix3d next = 0.5 * (nearest + nearest.inverse().transpose());
    const double change = (next - nearest).cwiseAbs().maxCoeff();
    nearest = next;
    if (change < 1e-15) break;
  }
  return Quaternion(nearest).normalized();
}

}  // namespace

Bodies::Arrays::Arrays(std::pmr::memory_resource* memory)
    : owner(memory),
      kind(memory),
      location(memory),
      velocity(memory),
      acceleration(memory),
      rotation_row(memory),
      rigid_row(memory),
      material_row(memory),
      appearance_row(memory),
      filter_row(memory),
      collision_shape(memory),
      display_shape(memory),
      neighborhood(memory),
      driven(memory),
      rotation_rows(memory),
      rigid_rows(memory),
      materials(memory),
      appearances(memory),
      filters(memory),
      picky(memory),
      translating(memory),
      rotating(memory),
      rigid(memory),
      free(memory),
      put{std::pmr::vector<BodyIndex>(memory), std::pmr::vector<BodyIndex>(memory),
          std::pmr::vector<BodyIndex>(memory)},
      in_put(memory),
      touched(memory),
      shape_changes(std::allocate_shared<std::uint64_t>(std::pmr::polymorphic_allocator<std::uint64_t>(memory), 0)) {}

BodyIndex Bodies::Arrays::grow() {
  const std::size_t size = owner.size() + 1;
  // The owner's column comes last: if memory runs out before, the index does not exist.
  kind.resize(size);
  location.resize(size);
  velocity.resize(size);
  acceleration.resize(size);
  rotation_row.resize(size, kNoRow);
  rigid_row.resize(size, kNoRow);
  material_row.resize(size, kNoRow);
  appearance_row.resize(size, kNoRow);
  filter_row.resize(size, kNoRow);
  collision_shape.resize(size);
  display_shape.resize(size);
  neighborhood.resize(size);
  driven.resize(size);
  in_put.resize(size);
  for (std::size_t i = 0; i < kFollowers; ++i) {
    if (i == static_cast<std::size_t>(Follower::Queries) && !queried) continue;
    if (put[i].capacity() < size) put[i].reserve(2 * size);
  }
  if (free.capacity() < size) free.reserve(2 * size);        // so that remove() never allocates
  if (touched.capacity() < size) touched.reserve(2 * size);  // nor note(), but where bodies come and go within a step
  owner.resize(size);
  return static_cast<BodyIndex>(size - 1);
}

void Bodies::Arrays::classify(BodyIndex body) {
  const bool physical = physics(body);
  const bool pushed = velocity[body] != kZero || acceleration[body] != kZero;
  const RowIndex row = rotation_row[body];
  const bool spun = row != kNoRow && (rotation_rows[row].velocity != kZero || rotation_rows[row].acceleration != kZero);
  translating.set(body, !physical && pushed);
  rotating.set(body, !physical && spun);
  rigid.set(body, physical && kind[body] != BodyKind::Stationary);
}

void Bodies::Arrays::copy_mass(BodyIndex body) {
  RigidRow& row = rigid_rows[rigid_row[body]];
  const Shape& shape = *collision_shape[body];
  MassProperties& solid = row.solid;
  solid.mass = shape.mass();
  solid.center_of_mass = shape.center_of_mass();
  const Vector3& c = solid.center_of_mass;
  // Steiner: from the origin of the shape to its centre of mass.
  solid.inertia = shape.inertia() - solid.mass * (c.squaredNorm() * Matrix3::Identity() - Matrix3(c * c.transpose()));
  const double moment = solid.inertia(0, 0);
  constexpr double kRound = 1e-14;  // a sphere's inertia is round up to the last digits
  solid.round = (solid.inertia - moment * Matrix3::Identity()).cwiseAbs().maxCoeff() <= kRound * moment;
}

Bodies::Bodies(std::pmr::memory_resource* memory) : memory_(memory) {}
Bodies::~Bodies() = default;

Bodies::Arrays& Bodies::arrays() {
  if (!arrays_) arrays_ = make_in<Arrays>(memory_, memory_);
  return *arrays_;
}

void Bodies::swap(Bodies& other) {
  std::swap(arrays_, other.arrays_);
  std::swap(memory_, other.memory_);
  std::swap(flat_, other.flat_);
}

void Bodies::flatten() {
  for (BodyIndex body = 0; body < index_end(); ++body) {
    if (!used(body)) continue;
    const bool vectors = location(body).z() == 0 && velocity(body).z() == 0 && acceleration(body).z() == 0;
    const Quaternion rotation = orientation(body);
    const Vector3 &spin = rotational_velocity(body), &more = rotational_acceleration(body);
    const bool rotates =
        rotation.x() == 0 && rotation.y() == 0 && spin.x() == 0 && spin.y() == 0 && more.x() == 0 && more.y() == 0;
    if (!vectors || !rotates)
      throw Error(ErrorCode::Argument, "the world cannot become flat: a body is not in the plane z = 0");
  }
  flat_ = true;
}

BodyIndex Bodies::add(BodyKind kind, ObjectId owner) {
  Arrays& a = arrays();
  if (!a.default_shape) {
    a.default_shape = Shape::sphere(1, memory_);
    a.default_shape->report_changes_to(a.shape_changes);
  }
  BodyIndex body;
  if (a.free.empty()) {
    body = a.grow();
  } else {
    body = a.free.back();
    a.free.pop_back();
  }
  a.owner[body] = owner;
  a.kind[body] = kind;
  a.location[body] = a.velocity[body] = a.acceleration[body] = kZero;
  a.collision_shape[body] = a.display_shape[body] = a.default_shape;
  a.neighborhood[body] = 0;
  a.driven[body] = 0;
  a.note_put(body);
  ++a.used;
  ++a.revision;
  return body;
}

void Bodies::remove(BodyIndex body) {
  Arrays& a = *arrays_;
  if (!used(body)) throw std::logic_error("a body to be removed does not exist");
  a.translating.set(body, false);
  a.rotating.set(body, false);
  a.rigid.set(body, false);
  a.rotation_rows.drop(a.rotation_row[body]);
  a.rigid_rows.drop(a.rigid_row[body]);
  a.materials.drop(a.material_row[body]);
  a.appearances.drop(a.appearance_row[body]);
  a.filters.drop(a.filter_row[body]);
  std::erase(a.picky, body);
  a.collision_shape[body].reset();
  a.display_shape[body].reset();
  a.owner[body] = {};
  a.free.push_back(body);
  --a.used;
  ++a.revision;
}

std::size_t Bodies::size() const { return arrays_ ? arrays_->used : 0; }
std::size_t Bodies::index_end() const { return arrays_ ? arrays_->owner.size() : 0; }
bool Bodies::used(BodyIndex body) const { return body < index_end() && arrays_->owner[body]; }
std::uint64_t Bodies::revision() const { return arrays_ ? arrays_->revision : 0; }
std::uint64_t Bodies::physics_revision() const { return arrays_ ? arrays_->physics_revision : 0; }
std::uint64_t Bodies::shape_changes() const { return arrays_ ? *arrays_->shape_changes : 0; }

std::size_t Bodies::bytes() const {
  if (!arrays_) return 0;
  constexpr std::size_t kColumns = sizeof(ObjectId) + sizeof(BodyKind) + 3 * sizeof(Vector3) + 5 * sizeof(RowIndex) +
                                   2 * sizeof(std::shared_ptr<Shape>) + sizeof(double) + 2 * sizeof(std::uint8_t) +
                                   kFollowers * sizeof(BodyIndex);
  const Arrays& a = *arrays_;
  return sizeof(Arrays) + a.owner.capacity() * kColumns + a.rotation_rows.bytes() + a.rigid_rows.bytes() +
         a.materials.bytes() + a.filters.bytes() + a.appearances.bytes() + a.translating.bytes() + a.rotating.bytes() +
         a.rigid.bytes();
}

BodyKind Bodies::kind(BodyIndex body) const { return arrays_->kind[body]; }
ObjectId Bodies::owner(BodyIndex body) const { return arrays_->owner[body]; }

const Vector3& Bodies::location(BodyIndex body) const { return arrays_->location[body]; }

Matrix3 Bodies::rotation(BodyIndex body) const { return orientation(body).toRotationMatrix(); }

Quaternion Bodies::orientation(BodyIndex body) const {
  const RowIndex row = arrays_->rotation_row[body];
  return row == kNoRow ? Quaternion::Identity() : arrays_->rotation_rows[row].orientation;
}

Vector3 Bodies::allowed_location(const Vector3& location) const {
  require_finite("location", location);
  return in_reach(in_plane("location", location, flat_), flat_);
}

Quaternion Bodies::allowed_orientation(const Quaternion& orientation) const {
  const double norm = orientation.norm();
  if (!std::isfinite(norm) || norm == 0) {
    throw Error(ErrorCode::Argument, "orientation must be a finite quaternion of non-zero length");
  }
  return rotation_about_z(orientation.normalized(), flat_);
}

Vector3 Bodies::allowed_velocity(const Vector3& value) const {
  require_finite("velocity", value);
  return in_plane("velocity", value, flat_);
}

Vector3 Bodies::allowed_spin(const Vector3& value) const {
  require_finite("rotational velocity", value);
  return about_z("rotational velocity", value, flat_);
}

void Bodies::set_location(BodyIndex body, const Vector3& location) {
  arrays_->location[body] = allowed_location(location);
  arrays_->note_put(body);
  arrays_->note(body);
}

void Bodies::set_rotation(BodyIndex body, const Matrix3& rotation) { set_orientation(body, rotation_of(rotation)); }

void Bodies::set_orientation(BodyIndex body, const Quaternion& orientation) {
  const Quaternion rotated = allowed_orientation(orientation);
  if (arrays_->rotation_row[body] == kNoRow && orientation.vec() == kZero) return;
  arrays_->rotation(body).orientation = rotated;
  arrays_->note_put(body);
  arrays_->note(body);
}

const Vector3& Bodies::velocity(BodyIndex body) const { return arrays_->velocity[body]; }
const Vector3& Bodies::acceleration(BodyIndex body) const { return arrays_->acceleration[body]; }

const Vector3& Bodies::rotational_velocity(BodyIndex body) const {
  const RowIndex row = arrays_->rotation_row[body];
  return row == kNoRow ? kZero : arrays_->rotation_rows[row].velocity;
}

const Vector3& Bodies::rotational_acceleration(BodyIndex body) const {
  const RowIndex row = arrays_->rotation_row[body];
  return row == kNoRow ? kZero : arrays_->rotation_rows[row].acceleration;
}

void Bodies::set_velocity(BodyIndex body, const Vector3& value) {
  arrays_->velocity[body] = allowed_velocity(value);
  arrays_->note_driven(body, value);
  arrays_->classify(body);
  arrays_->note(body);
}

void Bodies::set_acceleration(BodyIndex body, const Vector3& value) {
  require_finite("acceleration", value);
  arrays_->acceleration[body] = in_plane("acceleration", value, flat_);
  arrays_->note_driven(body, value);
  arrays_->classify(body);
  arrays_->note(body);
}

void Bodies::set_rotational_velocity(BodyIndex body, const Vector3& value) {
  const Vector3 spin = allowed_spin(value);
  if (arrays_->rotation_row[body] == kNoRow && value == kZero) return;
  arrays_->rotation(body).velocity = spin;
  arrays_->note_driven(body, spin);
  arrays_->classify(body);
  arrays_->note(body);
}

void Bodies::set_rotational_acceleration(BodyIndex body, const Vector3& value) {
  require_finite("rotational acceleration", value);
  if (arrays_->rotation_row[body] == kNoRow && value == kZero) return;
  const Vector3 spin = about_z("rotational acceleration", value, flat_);
  arrays_->rotation(body).acceleration = spin;
  arrays_->note_driven(body, spin);
  arrays_->classify(body);
  arrays_->note(body);
}

bool Bodies::physics(BodyIndex body) const { return arrays_->physics(body); }

bool Bodies::dynamic(BodyIndex body) const { return used(body) && physics(body) && kind(body) != BodyKind::Stationary; }

bool Bodies::driver(BodyIndex body) const {
  return used(body) && (kind(body) == BodyKind::Stationary || (arrays_->driven[body] != 0 && !physics(body)));
}

bool Bodies::moving(BodyIndex body) const { return arrays_->translating.has(body) || arrays_->rotating.has(body); }

Vector3 Bodies::spin(BodyIndex body) const {
  const Vector3& velocity = rotational_velocity(body);
  return physics(body) ? velocity : Vector3(orientation(body) * velocity);
}

std::uint32_t Bodies::physics_switches(BodyIndex body) const {
  const RowIndex row = arrays_->rigid_row[body];
  return row == kNoRow ? 0 : arrays_->rigid_rows[row].switches;
}

void Bodies::set_physics(BodyIndex body, bool enabled) {
  Arrays& a = *arrays_;
  if (a.physics(body) == enabled) return;
  RigidRow& row = a.make_rigid(body);
  a.note(body);  // before anything changes: it may take memory
  row.physics = enabled;
  ++row.switches;
  if (enabled) {
    a.copy_mass(body);
    row.kinematic_velocity = a.velocity[body];
    row.kinematic_rotational_velocity = rotational_velocity(body);
    // The rotational velocity of a rigid body is in the world frame.
    if (a.rotation_row[body] != kNoRow) {
      RotationRow& rotation = a.rotation_rows[a.rotation_row[body]];
      rotation.velocity = rotation.orientation * rotation.velocity;
    }
  } else {
    a.velocity[body] = row.kinematic_velocity;
    if (a.rotation_row[body] != kNoRow)
      a.rotation_rows[a.rotation_row[body]].velocity = row.kinematic_rotational_velocity;
  }
  ++a.revision;
  ++a.physics_revision;
  a.classify(body);
}

const Vector3& Bodies::force(BodyIndex body) const {
  const RowIndex row = arrays_->rigid_row[body];
  return row == kNoRow ? kZero : arrays_->rigid_rows[row].force;
}

const Vector3& Bodies::torque(BodyIndex body) const {
  const RowIndex row = arrays_->rigid_row[body];
  return row == kNoRow ? kZero : arrays_->rigid_rows[row].torque;
}

Vector3 Bodies::allowed_force(const Vector3& newtons) const {
  require_finite("force", newtons);
  return in_plane("force", newtons, flat_);
}

Vector3 Bodies::allowed_torque(const Vector3& newton_metres) const {
  require_finite("torque", newton_metres);
  return about_z("torque", newton_metres, flat_);
}

void Bodies::set_force(BodyIndex body, const Vector3& newtons) {
  const Vector3 force = allowed_force(newtons);
  arrays_->make_rigid(body).force = force;
  arrays_->note(body);
}

void Bodies::set_torque(BodyIndex body, const Vector3& newton_metres) {
  const Vector3 torque = allowed_torque(newton_metres);
  arrays_->make_rigid(body).torque = torque;
  if (newton_metres != kZero) arrays_->rotation(body);
  arrays_->note(body);
}

double Bodies::neighborhood_size(BodyIndex body) const { return arrays_->neighborhood[body]; }

void Bodies::set_neighborhood_size(BodyIndex body, double radius) {
  if (!std::isfinite(radius)) {
    throw Error(ErrorCode::Argument, fmt::format("neighborhood size must be finite, but is {}", radius));
  }
  arrays_->neighborhood[body] = radius;
}

void Bodies::set_filter(BodyIndex body, const CollisionFilter& filter) {
  Arrays& a = *arrays_;
  require_finite("the open side", filter.one_way);
  CollisionFilter allowed = filter;
  allowed.one_way = in_plane("the open side", filter.one_way, flat_);
  if (allowed == this->filter(body)) return;
  a.note(body);  // before anything changes: it may take memory
  const bool picks = allowed.asks || allowed.one_way != kZero;
  const auto at = std::lower_bound(a.picky.begin(), a.picky.end(), body);
  const bool picked = at != a.picky.end() && *at == body;
  RowIndex& row = a.filter_row[body];
  if (row == kNoRow) row = a.filters.make();
  if (picks && !picked) a.picky.insert(at, body);
  if (!picks && picked) a.picky.erase(at);
  a.filters[row] = allowed;
  ++a.revision;
  ++a.physics_revision;
}

}  // namespace breve
