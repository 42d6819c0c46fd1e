// Which bodies Box2D knows; what scripts changed goes in before a step, poses and velocities come out after it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "runtime/base/error.hpp"
#include "runtime/planar/assembly.hpp"
#include "runtime/planar/spring_rows.hpp"

namespace breve {

namespace {

/// Box2D fills a table for the whole process when the first contact is made, unguarded: two worlds on two threads would
/// both do so. It is made to do it once, here, where the language guards.
bool contacts_are_ready() {
  static const bool ready = [] {
    b2World world(b2Vec2(0, 0));
    b2CircleShape circle;
    circle.m_radius = 1;
    b2BodyDef def;
    def.type = b2_dynamicBody;
    for (int i = 0; i < 2; ++i) world.CreateBody(&def)->CreateFixture(&circle, 1);
    world.Step(0, 1, 1);
    return world.GetContactCount() == 1;
  }();
  return ready;
}

}  // namespace

Planar::Core::Core(std::pmr::memory_resource* resource, Bodies& all)
    : MechanicsCore(resource, all),
      joints(resource),
      springs(resource),
      joints_at(resource),
      force_methods(resource),
      held(resource),
      slots(resource),
      free_slots(resource),
      slot_of(resource),
      met(resource),
      scratch(resource),
      articulations(resource) {}

Planar::Core::~Core() {
  muted = true;  // contacts end with the world
}

FlatBody* Planar::Core::find(BodyIndex body) {
  return body < slot_of.size() && slot_of[body] != kNoSlot ? &slots[slot_of[body]] : nullptr;
}

void Planar::Core::make_world() {
  held.hold(kPerWorld);
  if (!contacts_are_ready()) throw Error(ErrorCode::Unsupported, "the installed Box2D library creates no contacts");
  b2 = std::make_unique<b2World>(b2Vec2(0, 0));
  b2->SetContactListener(this);
  b2->SetContactFilter(this);
  b2->SetContinuousPhysics(false);  // step_box2d() solves impacts itself
  b2->SetSubStepping(true);
  b2BodyDef def;
  ground = b2->CreateBody(&def);
  members_changed = true;
  rules_seen = false;
}

void Planar::Core::drop_world() {
  kept.reset();
  muted = true;
  b2.reset();
  muted = false;
  ground = nullptr;
  thawing = false;
  slots.clear();
  placed = 0;
  free_slots.clear();
  std::fill(slot_of.begin(), slot_of.end(), kNoSlot);
  for (FlatJoint& joint : joints) joint.b2 = nullptr;
}

/// With the bodies and joints that there are now; contacts may still have to be made.
void Planar::Core::ensure_world() {
  if (!b2) {
    if (bodies->rigid() == 0) return;
    if (frozen)
      thaw_world();
    else
      make_world();
  }
  if (seen_revision != bodies->revision()) members_changed = true;
  if (members_changed) update_members();
}

void Planar::Core::sync() {
  ensure_world();
  if (!b2) return;
  push_changes();
  refresh_rules();
  held.hold(expected_bytes());
  order_joints();
}

void Planar::Core::update_members() {
  if (slot_of.size() < bodies->index_end()) slot_of.resize(bodies->index_end(), kNoSlot);
  for (BodyIndex body = 0; body < slot_of.size(); ++body) {
    const bool used = bodies->used(body);
    const bool moves = used && bodies->dynamic(body);
    const bool fixed = used && !moves && bodies->driver(body);
    const bool anchor = used && !moves && joints_at.count(body) != 0;
    FlatBody* flat = find(body);
    const bool right = flat && (moves || fixed || anchor) && flat->fixed == !moves && flat->solid == (moves || fixed);
    if (flat && !right) remove_member(slot_of[body]);
    if (!right && (moves || fixed || anchor)) add_member(body);
  }
  order_bodies();
  for (FlatJoint& joint : joints)
    if (joint.used && !joint.b2) make_b2(joint);
  number_assemblies();
  seen_revision = bodies->revision();
  members_changed = false;
  rules_seen = false;
}

namespace {

/// As far away as Box2D can tell: nobody meets there what moves without physics.
constexpr float kFar = 1e15F;
b2Vec2 nearest_valid(const b2Vec2& position) {
  const auto clamp = [](float x) { return std::isnan(x) ? kFar : std::clamp(x, -kFar, kFar); };
  return {clamp(position.x), clamp(position.y)};
}

}  // namespace

/// Box2D aborts the process on a body whose position or angle is not finite in single precision.
b2Vec2 Planar::Core::position_of(BodyIndex body) const {
  if (!bodies->orientation(body).coeffs().allFinite())
    throw Error(ErrorCode::Argument, "the orientation of a body is no longer finite");
  const Vector3& location = bodies->location(body);
  const b2Vec2 position = to_b2(location);
  if (!position.IsValid() && !bodies->dynamic(body)) return nearest_valid(position);
  if (!position.IsValid())
    throw Error(ErrorCode::Argument,
                fmt::format("a body is at ({}, {}, 0), which is out of the range of single precision; keep scenes of "
                            "flat worlds within some 1,000 length units of the origin",
                            location.x(), location.y()));
  return position;
}

void Planar::Core::add_member(BodyIndex body) {
  const b2Vec2 position = position_of(body);
  held.hold(kPerWorld + static_cast<std::size_t>(b2->GetBodyCount() + 1) * kPerBody);
  if (free_slots.capacity() <= slots.size()) free_slots.reserve(2 * slots.size() + 16);
  std::uint32_t slot;
  if (free_slots.empty()) {
    slot = static_cast<std::uint32_t>(slots.size());
    slots.emplace_back();
  } else {
    slot = free_slots.back();
    free_slots.pop_back();
    slots[slot] = FlatBody();
  }
  FlatBody& flat = slots[slot];
  flat.body = body;
  slot_of[body] = slot;
  flat.fixed = !bodies->dynamic(body);
  flat.solid = !flat.fixed || bodies->driver(body);
  flat.material = std::as_const(*bodies).material(body);
  b2BodyDef def;
  def.type = flat.fixed ? b2_staticBody : b2_dynamicBody;
  def.position = position;
  def.angle = static_cast<float>(angle_of(bodies->orientation(body)));
  def.userData.pointer = slot + 1;
  flat.b2 = b2->CreateBody(&def);
  const double kept_base = base;
  try {
    fit(flat);
  } catch (...) {
    remove_member(slot);
    base = kept_base;  // it has no mass yet
    throw;
  }
  note_placed(flat);
  push_velocity(flat);
  note_known(flat);
  flat.force = bodies->force(body).head<2>();
  flat.torque = bodies->torque(body).z();
  flat.has_force = flat.force != Vector2::Zero() || flat.torque != 0;
  if (!flat.fixed) base += energy_of(body);
}

void Planar::Core::remove_member(std::uint32_t slot) {
  FlatBody& flat = slots[slot];
  placed -= flat.placed ? 1 : 0;
  for (FlatJoint& joint : joints)
    if (joint.used && joint.b2 && (joint.b2->GetBodyA() == flat.b2 || joint.b2->GetBodyB() == flat.b2)) drop_b2(joint);
  if (!flat.fixed) base -= kinetic_of(flat);
  b2->DestroyBody(flat.b2);
  slot_of[flat.body] = kNoSlot;
  flat = FlatBody();
  free_slots.push_back(slot);
}

// --- in and out -----------------------------------------------------------------------------------------------------

void Planar::Core::note_known(FlatBody& flat) {
  flat.location = bodies->location(flat.body);
  flat.orientation = bodies->orientation(flat.body);
  flat.velocity = bodies->velocity(flat.body);
  flat.spin = bodies->rotational_velocity(flat.body);
}

void Planar::Core::push_pose(FlatBody& flat) {
  // Whole turns stay: joints count them.
  const double before = flat.b2->GetAngle();
  const double angle = before + std::remainder(angle_of(bodies->orientation(flat.body)) - before, 2 * M_PI);
  flat.b2->SetTransform(position_of(flat.body), static_cast<float>(angle));
  flat.b2->SetAwake(true);
  note_placed(flat);
}

void Planar::Core::push_velocity(FlatBody& flat) {
  push_velocity(flat, bodies->velocity(flat.body), bodies->rotational_velocity(flat.body).z());
}

/// The velocity of its origin, m/s and rad/s; as fast as single precision can tell, which the guard then stops.
void Planar::Core::push_velocity(FlatBody& flat, const Vector3& velocity, double spin) {
  if (flat.fixed) return;
  const auto nearest = [](double x) {
    constexpr double kFastest = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(x, -kFastest, kFastest));
  };
  const Vector3 arm = bodies->orientation(flat.body) * flat.mass.center_of_mass;
  const Vector3 center = (velocity + spin * Vector3(-arm.y(), arm.x(), 0)) / settings.unit;
  flat.b2->SetLinearVelocity(b2Vec2(nearest(center.x()), nearest(center.y())));
  flat.b2->SetAngularVelocity(nearest(spin));
}

/// The properties of any body that may change: its shape, its material, and where it is if it is fixed.
void Planar::Core::push_shapes() {
  // Box2D's step has driven what is compared here out of the caches.
  constexpr std::size_t kAhead = 10;
  const std::uint64_t scalings = bodies->shape_changes();
  const bool scaled = std::exchange(seen_scalings, scalings) != scalings;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (i + kAhead < slots.size()) {
      __builtin_prefetch(&slots[i + kAhead].body);
      __builtin_prefetch(&slots[i + kAhead].shape);
    }
    FlatBody& flat = slots[i];
    if (flat.body == kNoBody) continue;
    const Shape* shape = bodies->collision_shape(flat.body).get();
    const bool weighs_other = !flat.fixed && !(bodies->mass_properties(flat.body) == flat.mass);
    if (flat.shape.get() != shape || weighs_other || (scaled && flat.scale != shape->scale())) {
      const double before = flat.fixed ? 0 : kinetic_of(flat);
      wake_touching(flat);
      fit(flat);
      note_placed(flat);
      flat.b2->SetAwake(true);
      wake_met(flat);
      if (!flat.fixed) ledger.script_work += kinetic_of(flat) - before;
    }
    if (flat.fixed && (flat.location != bodies->location(flat.body) ||
                       flat.orientation.coeffs() != bodies->orientation(flat.body).coeffs())) {
      push_pose(flat);
      note_known(flat);
      // What stood on it is to notice.
      wake_touching(flat);
      wake_met(flat);
    }
    const Material& material = std::as_const(*bodies).material(flat.body);
    if (std::memcmp(&material, &flat.material, sizeof material) != 0) {
      flat.material = material;
      materials_changed = true;
      flat.b2->SetAwake(true);
      wake_touching(flat);
    }
  }
}

void Planar::Core::push_changes() {
  push_shapes();
  scratch.clear();
  bodies->take_touched(scratch);
  std::pmr::vector<Strike> struck(memory);
  // Changes are found before anything is moved: a moved body takes others along.
  for (const BodyIndex body : scratch) {
    const FlatBody* flat = find(body);
    if (!flat || flat->fixed || !flat->jointed) continue;
    const bool spun = flat->spin != bodies->rotational_velocity(body),
               pushed = flat->velocity != bodies->velocity(body);
    if (pushed || spun) struck.push_back({body, pushed, spun});
  }
  for (const BodyIndex body : scratch) {
    FlatBody* flat = find(body);
    if (!flat || flat->fixed) continue;
    const bool moved =
        flat->location != bodies->location(body) || flat->orientation.coeffs() != bodies->orientation(body).coeffs();
    const bool pushed =
        !flat->jointed && (flat->velocity != bodies->velocity(body) || flat->spin != bodies->rotational_velocity(body));
    const Vector3 &force = bodies->force(body), &torque = bodies->torque(body);
    const bool forced = flat->force != force.head<2>() || flat->torque != torque.z();
    flat->force = force.head<2>();
    flat->torque = torque.z();
    flat->has_force = flat->force != Vector2::Zero() || flat->torque != 0;
    if (moved || pushed) {
      const double before = kinetic_of(*flat);
      const Pose from{flat->location, flat->orientation};
      if (moved) push_pose(*flat);
      if (moved && flat->jointed) follow(body, from);
      if (flat->jointed)
        push_velocity(*flat, flat->velocity, flat->spin.z());
      else
        push_velocity(*flat);
      ledger.script_work += kinetic_of(*flat) - before;
    }
    if (moved || pushed || forced) flat->b2->SetAwake(true);
    flat->location = bodies->location(body);
    flat->orientation = bodies->orientation(body);
    if (!flat->jointed) note_known(*flat);
  }
  if (!struck.empty()) strike_all(struck);
}

void Planar::Core::write_back(FlatBody& flat) {
  const b2Transform& at = flat.b2->GetTransform();
  const double angle = flat.b2->GetAngle(), spin = flat.b2->GetAngularVelocity();
  const Vector3 location = from_b2(at.p);
  const Quaternion orientation = rotation_about_z(angle);
  const Vector3 arm = orientation * flat.mass.center_of_mass;
  const Vector3 velocity = from_b2(flat.b2->GetLinearVelocity()) - spin * Vector3(-arm.y(), arm.x(), 0);
  bodies->set_motion(flat.body, location, orientation, velocity, {0, 0, spin});
  flat.location = location;
  flat.orientation = orientation;
  flat.velocity = velocity;
  flat.spin = {0, 0, spin};
}

bool Planar::Core::is_finite(const b2Body& body) {
  const b2Vec2 at = body.GetPosition(), v = body.GetLinearVelocity();
  return std::isfinite(at.x + at.y + v.x + v.y + body.GetAngle() + body.GetAngularVelocity());
}

void Planar::Core::write_back_all() {
  constexpr float kMostAngle = 50;  // rad; beyond it single precision is worth less than 4e-6 rad
  for (FlatBody& flat : slots) {
    if (flat.body == kNoBody || flat.fixed) continue;
    // What fell asleep in this step is written once more.
    if (!flat.b2->IsAwake() && flat.velocity == Vector3::Zero() && flat.spin == Vector3::Zero()) continue;
    if (!is_finite(*flat.b2)) continue;  // the guard puts it where it was
    if (!flat.jointed && std::abs(flat.b2->GetAngle()) > kMostAngle)
      flat.b2->SetTransform(flat.b2->GetPosition(), std::remainder(flat.b2->GetAngle(), 2 * b2_pi));
    write_back(flat);
  }
  for (FlatJoint& joint : joints)
    if (joint.used && joint.is.kind == JointKind::Revolute) joint.position = read_position(joint);
}

void Planar::Core::refresh_rules() {
  const bool changed = !rules_seen || (client && seen_rules != client->rules() + rules);
  if (changed && client) {
    seen_rules = client->rules() + rules;
    rules_seen = true;
    for (FlatBody& flat : slots) {
      if (flat.body == kNoBody) continue;
      for (b2Fixture* fixture = flat.b2->GetFixtureList(); fixture; fixture = fixture->GetNext()) fixture->Refilter();
    }
  }
  if (changed || materials_changed)
    for (b2Contact* contact = b2->GetContactList(); contact; contact = contact->GetNext()) contact->SetRestitution(-1);
  materials_changed = false;
}

}  // namespace breve
