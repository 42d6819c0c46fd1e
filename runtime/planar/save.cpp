// A flat world in a snapshot and in the hash. An image holds Box2D's world as data: bodies and their roomy boxes, what
// touches and where, impulses. That is all that Box2D goes on from, as what it solves has the order of bodies and
// joints (order.cpp): a restored world goes on as the saved one, bit for bit.
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "runtime/base/error.hpp"
#include "runtime/mechanics/members.hpp"
#include "runtime/planar/core.hpp"
#include "runtime/planar/doors.hpp"

namespace breve {

namespace {

using members::Adder;
using members::each;
using members::get_free;
using members::get_table;
using members::Is;
using members::put_free;
using members::put_table;
using members::Reader;
using members::Writer;

}  // namespace

template <class F, Is<FlatJoint> J>
void each(const F& f, J& j) {
  f(j.owner), f(j.serial), f(j.loop), f(j.position), f(j.bend), each(f, j.is), each(f, j.drive);
}
template <class F, Is<FrozenBody> B>
void each(const F& f, B& b) {
  f(b.body), f(b.x), f(b.y), f(b.angle), f(b.center_x), f(b.center_y), f(b.before_x), f(b.before_y), f(b.angle_before),
      f(b.vx), f(b.vy), f(b.spin), f(b.still);
  f(b.awake), f(b.kinematic), f(b.driven), f(b.pulled), f(b.placed);
  f(b.location), f(b.velocity), f(b.rotational_velocity), f(b.orientation);
  f(b.force_x), f(b.force_y), f(b.torque);
}
template <class F, Is<FrozenBox> B>
void each(const F& f, B& b) {
  f(b.body), f(b.fixture), f(b.child), f(b.low_x), f(b.low_y), f(b.high_x), f(b.high_y);
}
template <class F, Is<FrozenContact> C>
void each(const F& f, C& c) {
  f(c.key.a), f(c.key.b), f(c.key.fixture_a), f(c.key.fixture_b), f(c.key.child_a), f(c.key.child_b);
  auto& m = c.manifold;
  f(c.touching), f(c.friction), f(c.type), f(m.pointCount), f(m.localNormal.x), f(m.localNormal.y), f(m.localPoint.x),
      f(m.localPoint.y);
  for (auto& p : m.points) f(p.localPoint.x), f(p.localPoint.y), f(p.normalImpulse), f(p.tangentImpulse), f(p.id.key);
}
template <class F, Is<FrozenJoint> J>
void each(const F& f, J& j) {
  f(j.joint), f(j.reference), f(j.loose);
  f(j.warm.x), f(j.warm.y), f(j.warm.angular), f(j.warm.motor), f(j.warm.lower), f(j.warm.upper);
}

template <class F, Is<EnergyWatch> W>
void each(const F& f, W& w) {
  f(w.steps), f(w.gain), f(w.kinetic), f(w.turnover), f(w.slack);
}

namespace {

/// Self collisions have no softness in a flat world.
template <class F, Is<AssemblySettings> S>
void each_own(const F& f, S& s) {
  f(s.has_self), f(s.self_collisions), f(s.has_accuracy), each(f, s.accuracy);
}

template <class List>
void put_list(ByteWriter& out, const List& list) {
  out.put(static_cast<std::uint64_t>(list.size()));
  for (const auto& entry : list) each(Writer{out}, entry);
}
template <class Entry>
void get_list(ByteReader& in, std::pmr::vector<Entry>& list) {
  const std::size_t count = in.get_count();
  for (std::size_t i = 0; i < count; ++i) {
    Entry entry;
    each(Reader{in}, entry);
    list.push_back(entry);
  }
}

bool all_finite(std::initializer_list<float> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](float number) { return std::isfinite(number); });
}

/// Box2D aborts the process where a number is not finite.
void check_frozen(const Frozen& frozen, const Bodies& bodies, std::size_t joints) {
  BodyIndex next = 0;
  for (const FrozenBody& one : frozen.bodies) {
    if (one.body < next || !bodies.used(one.body)) ByteReader::fail();
    if (!all_finite({one.x, one.y, one.angle, one.center_x, one.center_y, one.before_x, one.before_y, one.angle_before,
                     one.vx, one.vy, one.spin, one.still}))
      ByteReader::fail();
    next = one.body + 1;
  }
  if (!std::isfinite(frozen.step)) ByteReader::fail();
  for (const FrozenBox& one : frozen.boxes)
    if (!all_finite({one.low_x, one.low_y, one.high_x, one.high_y}) || one.low_x > one.high_x || one.low_y > one.high_y)
      ByteReader::fail();
  for (const FrozenJoint& one : frozen.joints) {
    const WarmJoint& w = one.warm;
    if (one.joint >= joints || !all_finite({one.reference, w.x, w.y, w.angular, w.motor, w.lower, w.upper}))
      ByteReader::fail();
  }
  for (const FrozenContact& one : frozen.contacts) {
    const b2Manifold& m = one.manifold;
    if (m.pointCount < (one.touching ? 1 : 0) || m.pointCount > b2_maxManifoldPoints ||
        one.type > b2Manifold::e_faceB ||
        !all_finite({one.friction, m.localNormal.x, m.localNormal.y, m.localPoint.x, m.localPoint.y}))
      ByteReader::fail();
    for (const b2ManifoldPoint& p : m.points)
      if (!all_finite({p.localPoint.x, p.localPoint.y, p.normalImpulse, p.tangentImpulse})) ByteReader::fail();
  }
}

}  // namespace

namespace {

/// Without what Box2D has never written: points that are not used, and all of it where nothing touches.
void freeze_manifold(const b2Contact& contact, FrozenContact& to) {
  const b2Vec2 zero(0, 0);
  const b2Manifold& manifold = *contact.GetManifold();
  const bool touches = contact.IsTouching();
  to.type = static_cast<std::uint8_t>(touches ? manifold.type : b2Manifold::e_circles);
  b2Manifold& known = to.manifold;
  known.type = b2Manifold::e_circles;
  known.localNormal = touches && manifold.type != b2Manifold::e_circles ? manifold.localNormal : zero;
  known.localPoint = touches ? manifold.localPoint : zero;
  known.pointCount = touches ? manifold.pointCount : 0;
  for (int i = 0; i < b2_maxManifoldPoints; ++i) {
    b2ManifoldPoint& point = known.points[i];
    point.localPoint = zero;
    point.normalImpulse = point.tangentImpulse = 0;
    point.id.key = 0;
    if (i < known.pointCount) point = manifold.points[i];
  }
}

}  // namespace

/// What the last step left for the next, in what steps now.
Warm Planar::Core::warm() const {
  Warm made(memory);
  made.step = last_step;
  for (b2Contact* contact = b2->GetContactList(); contact; contact = contact->GetNext()) {
    const b2Manifold& manifold = *contact->GetManifold();
    if (!contact->IsTouching() || manifold.pointCount == 0 || !steps(*contact)) continue;
    WarmContact one;
    one.key = key_of(*contact);
    one.count = manifold.pointCount;
    for (int i = 0; i < one.count; ++i)
      one.points[i] = {manifold.points[i].id.key, manifold.points[i].normalImpulse, manifold.points[i].tangentImpulse};
    made.contacts.push_back(one);
  }
  std::sort(made.contacts.begin(), made.contacts.end(),
            [](const WarmContact& p, const WarmContact& q) { return p.key < q.key; });
  for (JointIndex i = 0; i < joints.size(); ++i)
    if (joints[i].used && joints[i].b2 && steps(joints[i])) made.joints.push_back({i, warm_of(joints[i])});
  return made;
}

/// Impulses times a factor, to contacts of the same shapes and features; none to others.
void Planar::Core::set_contacts(const Warm& from, double factor) {
  const auto scaled = [factor](float impulse) { return static_cast<float>(factor * impulse); };
  for (b2Contact* contact = b2->GetContactList(); contact; contact = contact->GetNext()) {
    b2Manifold& manifold = *contact->GetManifold();
    if (manifold.pointCount == 0 || !steps(*contact)) continue;
    const ContactKey key = key_of(*contact);
    const auto found = std::lower_bound(from.contacts.begin(), from.contacts.end(), key,
                                        [](const WarmContact& p, const ContactKey& k) { return p.key < k; });
    const int known = found != from.contacts.end() && found->key == key ? found->count : 0;
    for (int i = 0; i < manifold.pointCount; ++i) {
      manifold.points[i].normalImpulse = manifold.points[i].tangentImpulse = 0;
      for (int k = 0; k < known; ++k)
        if (found->points[k].id == manifold.points[i].id.key) {
          manifold.points[i].normalImpulse = scaled(found->points[k].normal);
          manifold.points[i].tangentImpulse = scaled(found->points[k].tangent);
        }
    }
  }
}

/// Impulses as of a step of this length, s.
void Planar::Core::set_impulses(const Warm& from, double length) {
  set_contacts(from, length / from.step);
  set_joints(from, length / from.step);
}

void Planar::Core::set_joints(const Warm& from, double factor) {
  const auto f = static_cast<float>(factor);
  for (const auto& [index, w] : from.joints) {
    if (!joints[index].used || !joints[index].b2) continue;
    set_warm(joints[index], {f * w.x, f * w.y, f * w.angular, f * w.motor, f * w.lower, f * w.upper});
  }
}

/// An image holds shapes as the bodies have them now: so Box2D's world takes bodies and shapes that came or changed
/// since the last step before it is saved, as it would in the next one.
/// @return  false if there is a shape that cannot be, which the next step reports
bool Planar::Core::take_shapes() {
  if (!b2) return true;
  try {
    ensure_world();
    push_shapes();
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// Before an image is taken. Box2D's world cannot be made anew where a shape cannot be: then this world also goes on
/// from the image's data.
void Planar::Core::prepare_image() {
  if (take_shapes()) return;
  frozen.emplace(freeze());
  drop_world();
}

Frozen Planar::Core::freeze() const {
  Frozen made(memory);
  made.step = last_step;
  for (BodyIndex body = 0; body < slot_of.size(); ++body)
    if (const FlatBody* flat = find(body)) freeze(*flat, made);
  for (const b2Contact* contact = b2->GetContactList(); contact; contact = contact->GetNext()) {
    FrozenContact& one = made.contacts.emplace_back();
    one.key = key_of(*contact);
    one.touching = contact->IsTouching();
    one.friction = contact->GetFriction();
    freeze_manifold(*contact, one);
  }
  std::sort(made.contacts.begin(), made.contacts.end(),
            [](const FrozenContact& p, const FrozenContact& q) { return p.key < q.key; });
  for (JointIndex i = 0; i < joints.size(); ++i)
    if (joints[i].used && joints[i].b2)
      made.joints.push_back({i, reference_of(joints[i]), joints[i].loose, warm_of(joints[i])});
  return made;
}

void Planar::Core::freeze(const FlatBody& flat, Frozen& made) const {
  b2Body& b = *flat.b2;
  FrozenBody one;
  one.body = flat.body;
  one.x = b.GetPosition().x;
  one.y = b.GetPosition().y;
  one.angle = b.GetAngle();
  one.center_x = b.GetWorldCenter().x;
  one.center_y = b.GetWorldCenter().y;
  one.before_x = sweep_of(b).c0.x;
  one.before_y = sweep_of(b).c0.y;
  one.angle_before = sweep_of(b).a0;
  one.vx = b.GetLinearVelocity().x;
  one.vy = b.GetLinearVelocity().y;
  one.spin = b.GetAngularVelocity();
  one.awake = b.IsAwake();
  one.still = sleep_time(b);
  one.kinematic = b.GetType() == b2_kinematicBody;
  one.driven = flat.driven;
  one.pulled = flat.pulled;
  one.placed = flat.placed;
  one.location = flat.location;
  one.velocity = flat.velocity;
  one.rotational_velocity = flat.spin;
  one.orientation = flat.orientation;
  one.force_x = flat.force.x();
  one.force_y = flat.force.y();
  one.torque = flat.torque;
  made.bodies.push_back(one);
  for (const b2Fixture* fixture = b.GetFixtureList(); fixture; fixture = fixture->GetNext())
    for (int child = 0; child < fixture->GetShape()->GetChildCount(); ++child) {
      const b2AABB& box = roomy_box(*b2, *fixture, child);
      made.boxes.push_back({flat.body, number_of(fixture), static_cast<std::uint32_t>(child), box.lowerBound.x,
                            box.lowerBound.y, box.upperBound.x, box.upperBound.y});
    }
}

void Planar::Core::save(ByteWriter& out) const {
  each(Writer{out}, settings);
  out.put(settings.unit);
  each(Writer{out}, ledger);
  out.put(base);
  out.put(springs_known);
  out.put(next_serial);
  out.put(sub_step);
  out.put(refined);
  out.put(calm);
  each(Writer{out}, watched);
  put_table(out, joints);
  put_free(out, free_joints);
  put_table(out, springs);
  put_free(out, free_springs);
  out.put(static_cast<std::uint64_t>(own.size()));
  for (const auto& [body, one] : own) {
    out.put(body);
    each_own(Writer{out}, one);
  }
  put_free(out, force_methods);
  out.put(static_cast<std::uint64_t>(met.size()));
  for (const auto& [pair, told] : met) out.put(pair.first), out.put(pair.second);
  out.put(b2 || frozen);
  if (!b2 && !frozen) return;
  std::optional<Frozen> live;
  const Frozen& as_data = frozen ? *frozen : live.emplace(freeze());
  out.put(as_data.step);
  put_list(out, as_data.bodies);
  put_list(out, as_data.boxes);
  put_list(out, as_data.contacts);
  put_list(out, as_data.joints);
}

void Planar::Core::load(ByteReader& in) {
  each(Reader{in}, settings);
  settings.unit = in.get<double>();
  check_loaded(settings);
  if (settings.gravity.z() != 0) ByteReader::fail();
  each(Reader{in}, ledger);
  base = in.get<double>();
  springs_known = in.get<double>();
  next_serial = in.get<std::uint64_t>();
  sub_step = in.get<std::uint64_t>();
  refined = in.get<int>();
  calm = in.get<int>();
  each(Reader{in}, watched);
  if (refined < 0 || refined > 8) ByteReader::fail();
  get_table(in, joints);
  get_free(in, joints, free_joints);
  get_table(in, springs);
  get_free(in, springs, free_springs);
  join_loaded();
  const std::size_t settings_count = in.get_count(sizeof(BodyIndex));
  for (std::size_t i = 0; i < settings_count; ++i) {
    const auto body = in.get<BodyIndex>();
    if (!bodies->used(body)) ByteReader::fail();
    each_own(Reader{in}, own[body]);
    breve::check(own[body].accuracy);
  }
  const std::size_t methods = in.get_count(sizeof(BodyIndex));
  for (std::size_t i = 0; i < methods; ++i) {
    force_methods.push_back(in.get<BodyIndex>());
    if (!bodies->used(force_methods.back())) ByteReader::fail();
  }
  const std::size_t pairs = in.get_count(2 * sizeof(BodyIndex));
  for (std::size_t i = 0; i < pairs; ++i) {
    const auto first = in.get<BodyIndex>(), second = in.get<BodyIndex>();
    if (!bodies->used(first) || !bodies->used(second)) ByteReader::fail();
    met[{first, second}] = false;
  }
  if (!in.get_bool()) return;
  frozen.emplace(memory);
  frozen->step = last_step = in.get<float>();
  get_list(in, frozen->bodies);
  get_list(in, frozen->boxes);
  get_list(in, frozen->contacts);
  get_list(in, frozen->joints);
  check_frozen(*frozen, *bodies, joints.size());
}

void Planar::Core::join_loaded() {
  for (const JointIndex index : used_joints(joints, memory)) {
    const JointDescription& is = joints[index].is;
    check_flat(is);
    check(joints[index].drive, is.kind);
    if (!std::isfinite(joints[index].position) || !std::isfinite(joints[index].bend)) ByteReader::fail();
    joints_at[is.child].push_back(index);
    if (is.parent != kNoBody) joints_at[is.parent].push_back(index);
  }
  for (const FlatSpring& spring : springs) {
    if (!spring.used) continue;
    check(spring.is);
    if (!bodies->used(spring.is.a) || !bodies->used(spring.is.b) || spring.is.a == spring.is.b ||
        static_cast<int>(spring.is.mode) > static_cast<int>(SpringMode::ContractOnly))
      ByteReader::fail();
  }
}

void Planar::Core::hash(Hasher& hasher) const {
  const Adder add{hasher};
  each(add, settings);
  add(settings.unit);
  each(add, ledger);
  add(base);
  add(springs_known);
  add(refined);
  add(calm);
  each(add, watched);
  for (const FlatJoint& joint : joints)
    if (joint.used) each(add, joint);
  for (const FlatSpring& spring : springs)
    if (spring.used) each(add, spring);
  for (const auto& [body, one] : own) {
    add(body);
    each_own(add, one);
  }
}

}  // namespace breve
