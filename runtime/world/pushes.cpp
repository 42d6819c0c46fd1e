// Impulses, and forces that act in one iteration only.
#include <Eigen/LU>
#include <algorithm>

#include "runtime/base/error.hpp"
#include "runtime/world/push_scope.hpp"

namespace breve {

namespace {

void need_finite_push(const Vector3& value, const char* what) {
  if (!value.allFinite()) throw Error(ErrorCode::Argument, std::string(what) + " must be finite");
}

void need_flat_push(const Vector3& force, const Vector3& torque) {
  if (force.z() != 0 || torque.x() != 0 || torque.y() != 0)
    throw Error(ErrorCode::Argument,
                "this world is flat: what pushes a body must lie in the plane, and turn it about z");
}

Vector3 push_center(const Bodies& bodies, BodyIndex body) {
  return bodies.orientation(body) * bodies.mass_properties(body).center_of_mass;
}

}  // namespace

void World::add_force(BodyIndex body, const Vector3& force, const Vector3& torque, const Vector3* point) {
  if (!bodies_->dynamic(body))
    throw Error(ErrorCode::Argument, "only a body with physics that is not a Stationary can be pushed");
  need_finite_push(force, "a force");
  need_finite_push(torque, "a torque");
  Vector3 about = torque;
  if (point) {
    need_finite_push(*point, "the point of a force");
    about += (*point - bodies_->location(body) - push_center(*bodies_, body)).cross(force);
    need_finite_push(about, "the torque of a force");
  }
  if (bodies_->flat()) need_flat_push(force, about);
  const ObjectId object = bodies_->owner(body);
  auto& pushes = parts_->pushes;
  auto known = std::find_if(pushes.begin(), pushes.end(), [&](const auto& one) { return one.object == object; });
  const bool first = known == pushes.end();
  const Vector3 all_force = first ? force : Vector3(known->force + force);
  const Vector3 all_torque = first ? about : Vector3(known->torque + about);
  need_finite_push(all_force, "the sum of forces");
  need_finite_push(all_torque, "the sum of torques");
  if (first) known = pushes.insert(pushes.end(), {object, Vector3::Zero(), Vector3::Zero()});
  known->force = all_force;
  known->torque = all_torque;
  wake(body);
}

void World::add_impulse(BodyIndex body, const Vector3& impulse, const Vector3* point) {
  if (!bodies_->dynamic(body))
    throw Error(ErrorCode::Argument, "only a body with physics that is not a Stationary can be pushed");
  need_finite_push(impulse, "an impulse");
  if (!parts_->dynamics->joints_of(body).empty()) {
    add_force(body, impulse / clock_.iteration_step, Vector3::Zero(), point);
    return;
  }
  const MassProperties& solid = bodies_->mass_properties(body);
  const Vector3 center = push_center(*bodies_, body);
  Vector3 spin = Vector3::Zero();
  if (point) {
    need_finite_push(*point, "the point of an impulse");
    const Vector3 moment = (*point - bodies_->location(body) - center).cross(impulse);
    if (bodies_->flat()) {
      need_flat_push(impulse, moment);
      spin.z() = moment.z() / solid.inertia(2, 2);
    } else {
      const Matrix3 rotation = bodies_->rotation(body);
      spin = rotation * Eigen::Matrix3d(solid.inertia).inverse() * rotation.transpose() * moment;
    }
  } else if (bodies_->flat()) {
    need_flat_push(impulse, Vector3::Zero());
  }
  // The velocity is that of the origin, which goes around the centre of mass.
  const Vector3 velocity = bodies_->velocity(body) + impulse / solid.mass - spin.cross(center);
  const Vector3 spinning = bodies_->rotational_velocity(body) + spin;
  bodies_->allowed_velocity(velocity);
  bodies_->allowed_spin(spinning);
  bodies_->set_velocity(body, velocity);
  if (spin != Vector3::Zero()) bodies_->set_rotational_velocity(body, spinning);
}

void World::wake(BodyIndex body) {
  if (bodies_->dynamic(body)) bodies_->touch({&body, 1});
}

// --- while an iteration moves bodies --------------------------------------------------------------------------------

World::Parts::PushScope::PushScope(Parts& parts) : parts_(parts), before_(parts.pushes.get_allocator()) {
  if (parts.pushes.empty()) return;
  Bodies& bodies = *parts.world->bodies_;
  before_.reserve(parts.pushes.size());
  try {
    for (const Push& push : parts.pushes) {
      if (!parts.objects.alive(push.object)) continue;
      const BodyIndex body = parts.objects.at(push.object).body;
      if (!bodies.dynamic(body)) continue;  // physics was disabled meanwhile
      const Vector3 force = bodies.force(body), torque = bodies.torque(body);
      const Vector3 all_force = force + push.force, all_torque = torque + push.torque;
      if (!all_force.allFinite() || !all_torque.allFinite()) continue;
      before_.push_back({push.object, force, torque, all_force, all_torque});
      bodies.set_force(body, all_force);
      bodies.set_torque(body, all_torque);
    }
  } catch (...) {
    give_back();
    throw;
  }
  parts.pushes.clear();
}

World::Parts::PushScope::~PushScope() { give_back(); }

/// A force that a handler has set meanwhile stays.
void World::Parts::PushScope::give_back() noexcept {
  Bodies& bodies = *parts_.world->bodies_;
  for (const Before& before : before_) {
    if (!parts_.objects.alive(before.object) || parts_.objects.at(before.object).body == kNoBody) continue;
    const BodyIndex body = parts_.objects.at(before.object).body;
    try {
      if (bodies.force(body) == before.all_force) bodies.set_force(body, before.force);
      if (bodies.torque(body) == before.all_torque) bodies.set_torque(body, before.torque);
    } catch (...) {
      continue;  // there is no memory for a note of it: it acts once more
    }
  }
  before_.clear();
}

// --- snapshot -------------------------------------------------------------------------------------------------------

void World::Parts::save_pushes(ByteWriter& out) const {
  std::uint64_t live = 0;
  for (const Push& push : pushes) live += objects.alive(push.object) ? 1 : 0;
  out.put(live);
  for (const Push& push : pushes) {
    if (!objects.alive(push.object)) continue;
    out.put(push.object);
    out.put(push.force);
    out.put(push.torque);
  }
}

void World::Parts::load_pushes(ByteReader& in) {
  for (std::size_t left = in.get_count(sizeof(ObjectId) + 6 * sizeof(double)); left > 0; --left) {
    Push push;
    push.object = in.get_object();
    push.force = in.get_vector();
    push.torque = in.get_vector();
    const bool fits = objects.alive(push.object) && objects.at(push.object).body != kNoBody;
    if (!fits || !push.force.allFinite() || !push.torque.allFinite()) ByteReader::fail();
    pushes.push_back(push);
  }
}

void World::Parts::hash_pushes(Hasher& hasher) const {
  for (const Push& push : pushes) {
    if (!objects.alive(push.object)) continue;
    hasher.add(std::uint64_t{push.object.index});
    hasher.add(push.force);
    hasher.add(push.torque);
  }
}

}  // namespace breve
