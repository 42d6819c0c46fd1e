// The stages that move bodies: kinematic translation and rotation by explicit Euler, and free rigid motion.
#include <cmath>
#include <cstring>

#include "runtime/base/rotation_vector.hpp"
#include "runtime/kinematics/arrays.hpp"
#include "runtime/kinematics/free_motion.hpp"

namespace breve {

void Bodies::Arrays::rotate_one(BodyIndex body, double h) {
  RotationRow& row = rotation_rows[rotation_row[body]];
  // q' = q (0, w) / 2 with w in the body's own frame; all from the values at the start.
  const Vector3& w = row.velocity;
  const Quaternion rate = row.orientation * Quaternion(0, w.x(), w.y(), w.z());
  row.orientation.coeffs() += 0.5 * h * rate.coeffs();
  row.orientation.normalize();
  row.velocity += h * row.acceleration;
}

void Bodies::Arrays::move_rigid_one(BodyIndex body, double h, const Vector3& gravity) {
  const RigidRow& rigid = rigid_rows[rigid_row[body]];
  const Vector3 pull = gravity + rigid.force / rigid.solid.mass;
  if (rotation_row[body] == kNoRow) {
    velocity[body] += h * pull;
    location[body] += h * velocity[body];
    return;
  }
  RotationRow& rotation = rotation_rows[rotation_row[body]];
  // The centre of mass moves like a point; the body rotates about it.
  const Vector3 arm = rotation.orientation * rigid.solid.center_of_mass;
  const Vector3 center_velocity = velocity[body] + rotation.velocity.cross(arm) + h * pull;
  const Vector3 center = location[body] + arm + h * center_velocity;
  const Quaternion to_own = rotation.orientation.conjugate();
  const Vector3 own_spin = to_own * rotation.velocity;
  const Vector3 own_torque = to_own * rigid.torque;
  Vector3 middle;
  Vector3 spin;
  if (rigid.solid.round) {
    spin = own_spin + (h / rigid.solid.inertia(0, 0)) * own_torque;
    middle = 0.5 * (own_spin + spin);
  } else {
    spin = advance_spin(rigid.solid.inertia, own_spin, own_torque, h, middle);
  }
  rotation.orientation = (rotation.orientation * rotation_by(h * middle)).normalized();
  rotation.velocity = rotation.orientation * spin;
  const Vector3 new_arm = rotation.orientation * rigid.solid.center_of_mass;
  location[body] = center - new_arm;
  velocity[body] = center_velocity - rotation.velocity.cross(new_arm);
}

namespace {

ObjectId first_of(const ActiveSet& set, const std::pmr::vector<ObjectId>& owner) {
  return set.members().empty() ? ObjectId{} : owner[set.members().front()];
}

/// What a world without bodies has of each kind.
const std::pmr::vector<BodyIndex> kNoBodies;

}  // namespace

std::size_t Bodies::translating() const { return arrays_ ? arrays_->translating.members().size() : 0; }
std::size_t Bodies::rotating() const { return arrays_ ? arrays_->rotating.members().size() : 0; }
std::size_t Bodies::rigid() const { return arrays_ ? arrays_->rigid.members().size() : 0; }
const std::pmr::vector<BodyIndex>& Bodies::translating_bodies() const {
  return arrays_ ? arrays_->translating.members() : kNoBodies;
}
const std::pmr::vector<BodyIndex>& Bodies::rotating_bodies() const {
  return arrays_ ? arrays_->rotating.members() : kNoBodies;
}
const std::pmr::vector<BodyIndex>& Bodies::rigid_bodies() const {
  return arrays_ ? arrays_->rigid.members() : kNoBodies;
}
ObjectId Bodies::first_translating() const {
  return arrays_ ? first_of(arrays_->translating, arrays_->owner) : ObjectId{};
}
ObjectId Bodies::first_rotating() const { return arrays_ ? first_of(arrays_->rotating, arrays_->owner) : ObjectId{}; }
ObjectId Bodies::first_rigid() const { return arrays_ ? first_of(arrays_->rigid, arrays_->owner) : ObjectId{}; }

void Bodies::translate(double h) {
  if (!arrays_) return;
  for (const BodyIndex body : arrays_->translating.members()) arrays_->translate_one(body, h);
}

void Bodies::rotate(double h) {
  if (!arrays_) return;
  for (const BodyIndex body : arrays_->rotating.members()) arrays_->rotate_one(body, h);
}

BodyState Bodies::state(BodyIndex body) const {
  BodyState s;
  s.location = location(body);
  s.orientation = orientation(body);
  s.velocity = velocity(body);
  s.acceleration = acceleration(body);
  s.rotational_velocity = rotational_velocity(body);
  s.rotational_acceleration = rotational_acceleration(body);
  s.force = force(body);
  s.torque = torque(body);
  s.shape = collision_shape(body).get();
  s.physics = physics(body);
  return s;
}

void Bodies::place(BodyIndex body, const Vector3& location, const Quaternion& orientation, const Vector3& velocity,
                   const Vector3& rotational_velocity) {
  Arrays& a = *arrays_;
  a.location[body] = location;
  a.velocity[body] = velocity;
  if (a.rotation_row[body] != kNoRow) {
    RotationRow& row = a.rotation_rows[a.rotation_row[body]];
    row.orientation = orientation;
    row.velocity = rotational_velocity;
  }
  a.classify(body);
}

void Bodies::set_motion(BodyIndex body, const Vector3& location, const Quaternion& orientation, const Vector3& velocity,
                        const Vector3& rotational_velocity) {
  Arrays& a = *arrays_;
  if (!a.rigid.has(body)) a.note_put(body);
  a.location[body] = location;
  a.velocity[body] = velocity;
  if (a.rotation_row[body] == kNoRow && orientation.vec() == Vector3::Zero() && rotational_velocity == Vector3::Zero())
    return;
  RotationRow& row = a.rotation(body);
  row.orientation = orientation;
  row.velocity = rotational_velocity;
}

void Bodies::take_touched(std::pmr::vector<BodyIndex>& out) {
  if (!arrays_) return;
  Arrays& a = *arrays_;
  out.reserve(out.size() + a.touched.size());  // all or none
  for (const BodyIndex body : a.touched) {
    if (!a.touched_now(body)) continue;
    out.push_back(body);
    a.rigid_rows[a.rigid_row[body]].touched = false;
  }
  a.touched.clear();
}

void Bodies::take_put(Follower follower, std::pmr::vector<BodyIndex>& out) {
  if (!arrays_) return;
  Arrays& a = *arrays_;
  const auto which = static_cast<std::size_t>(follower);
  if (follower == Follower::Queries && !a.queried) {
    a.put[which].reserve(2 * a.owner.size());
    a.queried = true;
  }
  out.insert(out.end(), a.put[which].begin(), a.put[which].end());
  for (const BodyIndex body : a.put[which]) a.in_put[body] = static_cast<std::uint8_t>(a.in_put[body] & ~(1U << which));
  a.put[which].clear();
}

void Bodies::touch(std::span<const BodyIndex> some) {
  for (const BodyIndex body : some)
    if (used(body)) arrays_->note(body);
}

void Bodies::touch_rigid() {
  if (!arrays_) return;
  for (BodyIndex body = 0; body < arrays_->owner.size(); ++body)
    if (used(body) && physics(body)) arrays_->note(body);
}

void Bodies::advance(BodyIndex body, double h, const Vector3& gravity) {
  Arrays& a = *arrays_;
  if (a.rigid.has(body)) a.move_rigid_one(body, h, gravity);
  if (a.translating.has(body)) a.translate_one(body, h);
  if (a.rotating.has(body)) a.rotate_one(body, h);
}

void Bodies::set_log(std::pmr::vector<BodyIndex>* log) {
  if (arrays_) arrays_->log = log;
}

template <class Number>
void Bodies::write_poses(std::span<const BodyIndex> some, char* to, std::size_t stride) const {
  const Arrays* const a = arrays_.get();
  const Quaternion unrotated = Quaternion::Identity();
  for (const BodyIndex body : some) {
    const RowIndex row = a->rotation_row[body];
    const Quaternion& q = row == kNoRow ? unrotated : a->rotation_rows[row].orientation;
    const Vector3& at = a->location[body];
    // One by one, at any address: a copy of all seven would wait for them to be stored first.
    const auto put = [to](std::size_t index, double value) {
      const auto number = static_cast<Number>(value);
      std::memcpy(to + index * sizeof number, &number, sizeof number);
    };
    put(0, at.x()), put(1, at.y()), put(2, at.z());
    put(3, q.w()), put(4, q.x()), put(5, q.y()), put(6, q.z());
    to += stride;
  }
}

template void Bodies::write_poses<float>(std::span<const BodyIndex> some, char* to, std::size_t stride) const;
template void Bodies::write_poses<double>(std::span<const BodyIndex> some, char* to, std::size_t stride) const;

}  // namespace breve
