// Bodies that are on their way to a target: at an even speed until the end of an iteration, then they stand there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/world/parts.hpp"

namespace breve {

void World::set_target(BodyIndex body, const Vector3* new_location, const Quaternion* new_orientation) {
  if (bodies_->dynamic(body))
    throw Error(ErrorCode::Argument,
                "a body with physics is moved by forces: only a body without physics can have a target");
  parts_->make_room_for_target(body);  // before anything is changed
  Parts::Target* const known = parts_->target_of(body);
  Vector3 location = known ? known->location : bodies_->location(body);
  Quaternion orientation = known ? known->orientation : bodies_->orientation(body);
  if (new_location) location = *new_location;
  if (new_orientation) orientation = *new_orientation;
  if (!location.allFinite() || !orientation.coeffs().allFinite() || !(orientation.norm() > 0))
    throw Error(ErrorCode::Argument, "a target's location and rotation must be finite");
  bodies_->allowed_location(location);  // what the body cannot have at the end is refused now
  bodies_->allowed_orientation(orientation);
  const Quaternion now = bodies_->orientation(body);
  const Eigen::AngleAxisd rotation(now.conjugate() * orientation.normalized());
  const double seconds = clock_.iteration_step;
  const Vector3 velocity = bodies_->allowed_velocity((location - bodies_->location(body)) / seconds);
  const Vector3 spin = bodies_->allowed_spin(rotation.angle() / seconds * rotation.axis());
  bodies_->set_velocity(body, velocity);
  bodies_->set_rotational_velocity(body, spin);
  const Parts::Target target{bodies_->owner(body), location, orientation.normalized()};
  if (known)
    *known = target;
  else
    parts_->add_target(body, target);
}

std::optional<Pose> World::target(BodyIndex body) const {
  const Parts::Target* const known = parts_->target_of(body);
  if (!known || bodies_->dynamic(body)) return std::nullopt;
  return Pose{known->location, known->orientation};
}

World::Parts::Target* World::Parts::target_of(BodyIndex body) {
  if (body >= target_places.size()) return nullptr;
  const std::size_t place = target_places[body];
  return place < targets.size() && targets[place].object == world->bodies_->owner(body) ? &targets[place] : nullptr;
}

void World::Parts::make_room_for_target(BodyIndex body) {
  if (body >= target_places.size()) target_places.resize(body + 1);
  if (targets.size() == targets.capacity()) targets.reserve(2 * targets.size() + 16);
}

void World::Parts::add_target(BodyIndex body, const Target& target) {
  target_places[body] = static_cast<std::uint32_t>(targets.size());
  targets.push_back(target);
}

void World::leave(BodyIndex body) {
  if (bodies_->rigid() == 0 || !bodies_->driver(body) || bodies_->moving(body)) return;
  const Parts::Target from{bodies_->owner(body), bodies_->location(body), bodies_->orientation(body)};
  const auto [at, first] = parts_->left.try_emplace(body, from);
  if (!first && !(at->second.object == from.object)) at->second = from;  // what left there is gone, and its place taken
}

/// A body that was put nearby is on its way there; what is new, or was put far away, is there already.
void World::Parts::aim_at_targets() {
  constexpr double kMostRotation = 0.5;  // rad
  Bodies& bodies = *world->bodies_;
  for (const auto& [body, from] : left) {
    if (!objects.alive(from.object) || objects.at(from.object).serial > advanced) continue;
    if (!bodies.driver(body) || bodies.moving(body)) continue;
    const Vector3 location = bodies.location(body);
    const Quaternion orientation = bodies.orientation(body);
    const bool near = (location - from.location).norm() <= bodies.collision_shape(body)->bounding_radius() &&
                      orientation.angularDistance(from.orientation) <= kMostRotation;
    if (!near) continue;
    bodies.set_location(body, from.location);
    bodies.set_orientation(body, from.orientation);
    world->set_target(body, &location, &orientation);
  }
  left.clear();
  advanced = objects.last_serial();
}

void World::Parts::reach_targets() {
  Bodies& bodies = *world->bodies_;
  for (const Target& target : targets) {
    if (!objects.alive(target.object)) continue;
    const BodyIndex body = objects.at(target.object).body;
    if (bodies.dynamic(body)) continue;  // physics was enabled on the way
    bodies.set_velocity(body, Vector3::Zero());
    bodies.set_rotational_velocity(body, Vector3::Zero());
    bodies.set_location(body, target.location);
    bodies.set_orientation(body, target.orientation);
  }
  targets.clear();
}

// Objects that were freed meanwhile are left out: nothing refers to them.

void World::Parts::save_targets(ByteWriter& out) const {
  const auto save = [this, &out](const auto& some, const auto& of) {
    const auto lives = [&](const auto& one) { return objects.alive(of(one).object); };
    out.put(static_cast<std::uint64_t>(std::count_if(some.begin(), some.end(), lives)));
    for (const auto& one : some) {
      if (!lives(one)) continue;
      out.put(of(one).object);
      out.put(of(one).location);
      out.put(of(one).orientation);
    }
  };
  save(targets, [](const Target& one) -> const Target& { return one; });
  save(left, [](const auto& one) -> const Target& { return one.second; });
  out.put(advanced);
}

void World::Parts::load_targets(ByteReader& in) {
  const auto load = [this, &in](const auto& keep) {
    const std::size_t count = in.get_count(sizeof(Vector3));
    for (std::size_t i = 0; i < count; ++i) {
      Target target;
      target.object = in.get_object();
      target.location = in.get_vector();
      target.orientation = in.get_quaternion();
      const bool embodied = objects.alive(target.object) && objects.at(target.object).body != kNoBody;
      if (!embodied || !target.location.allFinite() || !target.orientation.coeffs().allFinite()) ByteReader::fail();
      keep(target);
    }
  };
  load([this](const Target& target) {
    const BodyIndex body = objects.at(target.object).body;
    make_room_for_target(body);
    add_target(body, target);
  });
  load([this](const Target& target) { left.try_emplace(objects.at(target.object).body, target); });
  advanced = in.get<std::uint64_t>();
}

void World::Parts::hash_targets(Hasher& hasher) const {
  const auto add = [this, &hasher](const Target& target) {
    if (!objects.alive(target.object)) return;
    hasher.add(objects.at(target.object).serial);
    hasher.add(target.location);
    hasher.add(target.orientation);
  };
  for (const Target& target : targets) add(target);
  for (const auto& [body, target] : left) add(target);
}

}  // namespace breve
