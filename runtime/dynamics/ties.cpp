// The table of springs between bodies, and the force of one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/core.hpp"

namespace breve {

namespace {

[[noreturn]] void no_spring() { throw Error(ErrorCode::Argument, "the spring is not connected"); }

}  // namespace

SpringEntry& Dynamics::Core::tie_at(SpringIndex spring) {
  if (spring >= springs.size() || !springs[spring].used) no_spring();
  return springs[spring];
}

SpringIndex Dynamics::tie(const SpringDescription& description, ObjectId owner) {
  check(description);
  for (const BodyIndex end : {description.a, description.b})
    if (!bodies_->used(end)) throw Error(ErrorCode::Argument, "spring: an end is not a body in the world");
  if (description.a == description.b) return kNoSpring;
  Core& c = core();
  c.sync_changes();
  if (c.free_springs.capacity() <= c.springs.size()) c.free_springs.reserve(2 * c.springs.size() + 16);
  c.entry(description.a);
  c.entry(description.b);
  SpringIndex index;
  if (c.free_springs.empty()) {
    index = static_cast<SpringIndex>(c.springs.size());
    c.springs.emplace_back();
  } else {
    index = c.free_springs.back();
    c.free_springs.pop_back();
  }
  c.springs[index].used = true;
  c.springs[index].owner = owner;
  c.springs[index].is = description;
  // Whoever ties moving bodies stretches the spring.
  c.springs[index].booked = c.known_to_books(description.a) || c.known_to_books(description.b) ? 0 : kNoBook;
  for (const BodyIndex end : {description.a, description.b}) {
    ++c.entry(end).ties;
    c.near.wake(end);
    if (c.entry(end).tree == kNone) c.graph_changed = true;
  }
  c.clusters_changed = true;
  return index;
}

void Dynamics::untie(SpringIndex spring) {
  Core& c = core();
  const SpringDescription& is = c.tie_at(spring).is;
  for (const BodyIndex end : {is.a, is.b}) {
    --c.entry(end).ties;
    c.near.wake(end);
    // A free body needs no tree any more.
    if (!c.needs_tree(end) && c.entry(end).tree != kNone) c.drop_tree(c.entry(end).tree);
  }
  if (in_books(c.springs[spring].booked)) c.account.script_work -= c.springs[spring].booked;
  c.springs[spring] = SpringEntry();
  c.free_springs.push_back(spring);
  c.clusters_changed = true;
}

bool Dynamics::tied(SpringIndex spring) const {
  return core_ && spring < core_->springs.size() && core_->springs[spring].used;
}

const SpringDescription& Dynamics::spring(SpringIndex spring) const {
  if (!core_) no_spring();
  return core_->tie_at(spring).is;
}

void Dynamics::set_spring(SpringIndex spring, const SpringDescription& description) {
  check(description);
  SpringEntry& entry = core().tie_at(spring);
  const BodyIndex a = entry.is.a, b = entry.is.b;
  entry.is = description;
  entry.is.a = a;
  entry.is.b = b;
  entry.set = true;
  for (const BodyIndex end : {a, b}) core_->near.wake(end);
}

double Dynamics::spring_length(SpringIndex spring) const {
  const SpringDescription& is = this->spring(spring);
  const Vector3 a = bodies_->location(is.a) + bodies_->orientation(is.a) * is.point_a;
  const Vector3 b = bodies_->location(is.b) + bodies_->orientation(is.b) * is.point_b;
  return (b - a).norm();
}

double Dynamics::spring_force(SpringIndex spring) const {
  if (!core_) no_spring();
  return core_->tie_at(spring).force;
}

}  // namespace breve
