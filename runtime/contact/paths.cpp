// Straight pieces of paths. They are read off from where the stages of motion took each body, whatever rule moved it.
#include <cmath>

#include "runtime/contact/collision_stage.hpp"

namespace breve {

/// Only what moves, or did, is gone through: a world may have many more bodies that stand.
void CollisionStage::start_paths() {
  paths_.clear();
  settling_.swap(moved_);
  moved_.clear();
  for (const ProxyIndex index : settling_) {
    proxies_[index].path = kNoPath;
    proxies_[index].impacts = 0;
  }
  if (bodies_->size() == 0) return;
  for (const BodyIndex body : bodies_->translating_bodies()) start_path(body);
  for (const BodyIndex body : bodies_->rotating_bodies()) start_path(body);
  for (const BodyIndex body : bodies_->rigid_bodies()) start_path(body);
}

void CollisionStage::start_path(BodyIndex body) {
  const ProxyIndex index = body < proxy_of_.size() ? proxy_of_[body] : kNoProxy;
  if (index == kNoProxy || proxies_[index].path != kNoPath) return;
  // Its path is known by its place once there is one: memory may end here.
  moved_.push_back(index);
  paths_.emplace_back();
  paths_.back().from = bodies_->state(body);
  proxies_[index].path = static_cast<std::uint32_t>(paths_.size() - 1);
}

void CollisionStage::finish_path(Path& path) {
  const double length = path.end - path.begin;
  path.velocity = path.rotational_velocity = Vector3::Zero();
  if (!(length > 0)) return;
  // A kinematic body moves with the velocity it had at the start; reading it off would only add rounding.
  path.velocity = path.from.physics ? Vector3((path.to.location - path.from.location) / length) : path.from.velocity;
  if (path.to.orientation.coeffs() == path.from.orientation.coeffs()) return;
  Quaternion rotation = path.to.orientation * path.from.orientation.conjugate();
  if (rotation.w() < 0) rotation.coeffs() = -rotation.coeffs();
  const double sine = rotation.vec().norm();
  if (sine > 0) path.rotational_velocity = rotation.vec() * (2 * std::atan2(sine, rotation.w()) / (sine * length));
}

BodyState CollisionStage::state_at(const Path& path, double time) {
  if (time <= path.begin) return path.from;
  if (time >= path.end) return path.to;
  const double elapsed = time - path.begin;
  const double fraction = elapsed / (path.end - path.begin);
  BodyState state = path.from;
  const Pose pose =
      pose_at({{path.from.location, path.from.orientation}, path.velocity, path.rotational_velocity}, elapsed);
  state.location = pose.location;
  state.orientation = pose.orientation;
  state.velocity += fraction * (path.to.velocity - path.from.velocity);
  state.rotational_velocity += fraction * (path.to.rotational_velocity - path.from.rotational_velocity);
  return state;
}

Motion CollisionStage::motion_from(const Proxy& proxy, double time) const {
  if (proxy.path == kNoPath) return {pose_now(proxy), Vector3::Zero(), Vector3::Zero()};
  const Path& path = paths_[proxy.path];
  const BodyState state = state_at(path, time);
  return {{state.location, state.orientation}, path.velocity, path.rotational_velocity};
}

Pose CollisionStage::pose_now(const Proxy& proxy) const {
  return {bodies_->location(proxy.body), bodies_->orientation(proxy.body)};
}

void CollisionStage::place(BodyIndex body, const BodyState& state) {
  bodies_->place(body, state.location, state.orientation, state.velocity, state.rotational_velocity);
}

/// The offset to be added to b's position so that it is near a, across edges of space that wrap.
Vector3 CollisionStage::image_of_b(const Pair& pair) const {
  if (!space_.wraps()) return Vector3::Zero();
  return space_.image(proxies_[pair.a].box.center(), proxies_[pair.b].box.center());
}

bool CollisionStage::touching(const Substep& substep, const Pair& pair, const Pose& pose_a, const Pose& wanted_b,
                              Contact& contact) {
  const Shape& a = *bodies_->collision_shape(proxies_[pair.a].body);
  const Shape& b = *bodies_->collision_shape(proxies_[pair.b].body);
  const Pose pose_b{wanted_b.location + image_of_b(pair), wanted_b.orientation};
  const double tolerance = touch_tolerance(a, pose_a, b, pose_b);
  // Spheres around both that are apart settle it; also refuses what is not finite.
  const double reach = a.bounding_radius() + b.bounding_radius() + tolerance;
  if (!((pose_a.location - pose_b.location).squaredNorm() <= reach * reach)) return false;
  NarrowCounters narrow;
  const bool touch = closest_within(a, pose_a, b, pose_b, tolerance, contact, &narrow);
  counters_.facets += narrow.facets;
  if (narrow.facets != 0) substep.client.work(narrow.facets);
  return touch;
}

}  // namespace breve
