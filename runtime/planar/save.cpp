// A flat world in a snapshot and in the hash. An image holds Box2D's world as data: bodies, impulses of contacts by
// what touches, impulses of joints. Once an image was taken the live world is made anew from the same data when it next
// moves, so that going on after saving is the same as going on after loading, bit for bit.
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "runtime/base/error.hpp"
#include "runtime/mechanics/members.hpp"
#include "runtime/planar/core.hpp"

namespace breve {

// How long a body has been slow, which Box2D shows to nobody: where a template is instantiated by name, private members
// may be named.
float& sleep_time(b2Body& body);
template <auto Member>
struct SleepDoor {
  friend float& sleep_time(b2Body& body) { return body.*Member; }
};
template struct SleepDoor<&b2Body::m_sleepTime>;

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
  f(b.body), f(b.x), f(b.y), f(b.angle), f(b.vx), f(b.vy), f(b.spin), f(b.still), f(b.awake);
  f(b.location), f(b.velocity), f(b.rotational_velocity), f(b.orientation);
}
template <class F, Is<WarmContact> C>
void each(const F& f, C& c) {
  f(c.key.a), f(c.key.b), f(c.key.fixture_a), f(c.key.fixture_b), f(c.key.child_a), f(c.key.child_b), f(c.count);
  for (auto& p : c.points) f(p.id), f(p.normal), f(p.tangent);
}
template <class F, Is<FrozenJoint> J>
void each(const F& f, J& j) {
  f(j.joint), f(j.warm.x), f(j.warm.y), f(j.warm.angular), f(j.warm.motor), f(j.warm.lower), f(j.warm.upper);
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
    if (!all_finite({one.x, one.y, one.angle, one.vx, one.vy, one.spin, one.still})) ByteReader::fail();
    next = one.body + 1;
  }
  if (!std::isfinite(frozen.warm.step)) ByteReader::fail();
  for (const FrozenJoint& one : frozen.warm.joints) {
    const WarmJoint& w = one.warm;
    if (one.joint >= joints || !all_finite({w.x, w.y, w.angular, w.motor, w.lower, w.upper})) ByteReader::fail();
  }
  for (const WarmContact& one : frozen.warm.contacts) {
    if (one.count < 0 || one.count > b2_maxManifoldPoints) ByteReader::fail();
    for (const ContactImpulse& point : one.points)
      if (!all_finite({point.normal, point.tangent})) ByteReader::fail();
  }
}

/// Which shapes a contact is of, and whether its order is the other way.
ContactKey key_of(Planar::Core& core, b2Contact* contact, bool& swapped) {
  b2Fixture *a = contact->GetFixtureA(), *b = contact->GetFixtureB();
  ContactKey key{core.of(a->GetBody()).body,
                 core.of(b->GetBody()).body,
                 number_of(a),
                 number_of(b),
                 static_cast<std::uint32_t>(contact->GetChildIndexA()),
                 static_cast<std::uint32_t>(contact->GetChildIndexB())};
  swapped = key.b < key.a;
  if (swapped) {
    std::swap(key.a, key.b);
    std::swap(key.fixture_a, key.fixture_b);
    std::swap(key.child_a, key.child_b);
  }
  return key;
}

}  // namespace

/// What the last step left for the next.
Warm Planar::Core::warm() const {
  Warm made(memory);
  made.step = last_step;
  for (b2Contact* contact = b2->GetContactList(); contact; contact = contact->GetNext()) {
    const b2Manifold& manifold = *contact->GetManifold();
    if (!contact->IsTouching() || manifold.pointCount == 0) continue;
    WarmContact one;
    bool swapped = false;
    one.key = key_of(const_cast<Core&>(*this), contact, swapped);
    one.count = manifold.pointCount;
    for (int i = 0; i < one.count; ++i)
      one.points[i] = {manifold.points[i].id.key, manifold.points[i].normalImpulse, manifold.points[i].tangentImpulse};
    made.contacts.push_back(one);
  }
  std::sort(made.contacts.begin(), made.contacts.end(),
            [](const WarmContact& p, const WarmContact& q) { return p.key < q.key; });
  for (JointIndex i = 0; i < joints.size(); ++i)
    if (joints[i].used && joints[i].b2) made.joints.push_back({i, warm_of(joints[i])});
  return made;
}

/// Impulses times a factor, to contacts of the same shapes and features; none to others.
void Planar::Core::set_contacts(const Warm& from, double factor) {
  const auto scaled = [factor](float impulse) { return static_cast<float>(factor * impulse); };
  for (b2Contact* contact = b2->GetContactList(); contact; contact = contact->GetNext()) {
    b2Manifold& manifold = *contact->GetManifold();
    if (manifold.pointCount == 0) continue;
    bool swapped = false;
    const ContactKey key = key_of(*this, contact, swapped);
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

void Planar::Core::set_joints(const Warm& from, double factor) {
  const auto f = static_cast<float>(factor);
  for (const FrozenJoint& one : from.joints) {
    if (one.joint >= joints.size() || !joints[one.joint].used || !joints[one.joint].b2) continue;
    const WarmJoint& w = one.warm;
    set_warm(joints[one.joint], {f * w.x, f * w.y, f * w.angular, f * w.motor, f * w.lower, f * w.upper});
  }
}

Frozen Planar::Core::freeze() {
  Frozen made(memory);
  for (BodyIndex body = 0; body < slot_of.size(); ++body) {
    const FlatBody* flat = find(body);
    if (!flat) continue;
    FrozenBody one;
    one.body = body;
    one.x = flat->b2->GetPosition().x;
    one.y = flat->b2->GetPosition().y;
    one.angle = flat->b2->GetAngle();
    one.vx = flat->b2->GetLinearVelocity().x;
    one.vy = flat->b2->GetLinearVelocity().y;
    one.spin = flat->b2->GetAngularVelocity();
    one.awake = flat->b2->IsAwake();
    one.still = sleep_time(*flat->b2);
    one.location = flat->location;
    one.velocity = flat->velocity;
    one.rotational_velocity = flat->spin;
    one.orientation = flat->orientation;
    made.bodies.push_back(one);
  }
  made.warm = kept ? *kept : warm();
  return made;
}

void Planar::Core::thaw() {
  const double kept = base;
  update_members();
  base = kept;
  for (const FlatBody& flat : slots) {
    const auto position = std::lower_bound(frozen->bodies.begin(), frozen->bodies.end(), flat.body,
                                           [](const FrozenBody& one, BodyIndex body) { return one.body < body; });
    const bool counted = position != frozen->bodies.end() && position->body == flat.body;
    if (flat.body != kNoBody && !flat.fixed && !counted) base += energy_of(flat.body);
  }
  for (const FrozenBody& one : frozen->bodies) {
    FlatBody* flat = find(one.body);
    if (!flat) continue;
    flat->b2->SetTransform(b2Vec2(one.x, one.y), one.angle);
    flat->b2->SetLinearVelocity(b2Vec2(one.vx, one.vy));
    flat->b2->SetAngularVelocity(one.spin);
    flat->location = one.location;
    flat->velocity = one.velocity;
    flat->spin = one.rotational_velocity;
    flat->orientation = one.orientation;
  }
  // Their reference angles follow from the bodies' angles, full rotations included.
  for (FlatJoint& joint : joints) {
    if (!joint.used) continue;
    drop_b2(joint);
    make_b2(joint);
  }
  set_joints(frozen->warm, 1);
  bodies->touch_rigid();  // what was set in the arrays and not taken yet is found by comparing
}

void Planar::Core::thaw_contacts() {
  muted = true;
  b2->SetContinuousPhysics(true);
  b2->Step(0, 1, 1);  // contacts are found and their points computed; nothing moves
  muted = false;
  rethrow();
  set_contacts(frozen->warm, 1);
  for (const FrozenBody& one : frozen->bodies) {
    FlatBody* flat = find(one.body);
    if (!flat || flat->fixed || flat->location != bodies->location(one.body)) continue;
    if (one.awake)
      sleep_time(*flat->b2) = one.still;
    else
      flat->b2->SetAwake(false);
  }
  frozen.reset();
}

void Planar::Core::save(ByteWriter& out) {
  if (b2 && !frozen) {
    frozen.emplace(freeze());
    last_step = frozen->warm.step;
  }
  if (b2) drop_world();
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
  out.put(frozen.has_value());
  if (!frozen) return;
  out.put(frozen->warm.step);
  put_list(out, frozen->bodies);
  put_list(out, frozen->warm.contacts);
  put_list(out, frozen->warm.joints);
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
  frozen->warm.step = last_step = in.get<float>();
  get_list(in, frozen->bodies);
  get_list(in, frozen->warm.contacts);
  get_list(in, frozen->warm.joints);
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
