// Landings on light bodies. Box2D starts each step from the impulses of the last one, and its sweeps hardly converge
// where something heavy presses on something light. The impulse that stopped a heavy body would therefore push it up
// again in the next step, and so create energy; stacks that land and long chains of joints that spin gain energy for
// the same reason. If one of some bodies that touch has struck hard, and either they are of very different masses or
// they are stacked and not too many, or if contacts and joints have given energy, the solver of runtime/contact
// replaces Box2D's velocities of all that is connected with them: it solves the impact first, without rebound (bodies
// that rebound have collided before), then the forces of the sub-step. Only the impulses of the second solution start
// the next step.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/planar/island.hpp"

namespace breve {

namespace {

constexpr double kUneven = 4;  // ratio of two masses, from which Box2D's sweeps are slow
// What strikes so deep in a sub-step, or as after a fall from so high, is solved at once; both are parts of the smaller
// body's radius of gyration.
constexpr double kDeep = 0.1, kHigh = 0.25;
constexpr double kGain = 0.002;   // of the energy of motion: what contacts may err by
constexpr double kTorn = 1;       // falls of a sub-step: the speed that sweeps leave at joints of loops
constexpr int kMostPoints = 100;  // of a stack of similar masses: Box2D goes on with more of them

bool moves(const FlatBody* flat) { return flat && !flat->fixed; }

bool uneven(const FlatBody* a, const FlatBody* b) {
  if (!moves(a) || !moves(b)) return false;
  const auto [light, heavy] = std::minmax(a->mass.mass, b->mass.mass);
  return heavy > kUneven * light;
}

/// What a sub-step did to bodies that touch or are joined, all of them together.
struct Together {
  std::uint32_t next;  // one of them that stands for more of them; itself at last
  double gain = 0;     // J, that contacts and joints gave beyond the work of motors
  double allowed = 0;  // J, of that
  double parting = 0;  // Box2D's length units/s, of the ends of joints that close loops, in sum
  int points = 0;      // of contacts
  bool uneven = false, joined = false, struck = false, stacked = false;
  bool suspect(double fall) const {
    const bool solves = uneven || (stacked && points <= kMostPoints);
    return (struck && solves) || ((uneven || joined) && gain > allowed) || parting > kTorn * fall;
  }
};

/// Which bodies touch or are joined, by their slots, and what a sub-step did to them.
class Landings {
 public:
  Landings(const Planar::Core& core, double dt) : core_(core), dt_(dt), all_(core.memory) {
    all_.reserve(core.slots.size());
    for (std::uint32_t i = 0; i < core.slots.size(); ++i) all_.push_back({i});
    for_contacts([this](const FlatBody& a, const FlatBody& b, b2Contact*) { unite(&a, &b); });
    for_joints([this](const FlatJoint&, const FlatBody& child, const FlatBody* parent) { unite(&child, parent); });
    weigh();
  }
  Together& of(const FlatBody& flat) { return all_[root(slot_of(flat))]; }

 private:
  template <class F>
  void for_contacts(const F& f) {
    for (b2Contact* contact = core_.b2->GetContactList(); contact; contact = contact->GetNext())
      if (contact->IsTouching() && contact->IsEnabled() && contact->GetManifold()->pointCount > 0)
        f(core_.of(contact->GetFixtureA()->GetBody()), core_.of(contact->GetFixtureB()->GetBody()), contact);
  }
  template <class F>
  void for_joints(const F& f) {
    for (const FlatJoint& joint : core_.joints)
      if (const FlatBody* child = joint.used && joint.b2 ? core_.find(joint.is.child) : nullptr; moves(child))
        f(joint, *child, joint.is.parent == kNoBody ? nullptr : core_.find(joint.is.parent));
  }
  std::uint32_t slot_of(const FlatBody& flat) const { return static_cast<std::uint32_t>(&flat - core_.slots.data()); }
  std::uint32_t root(std::uint32_t slot) {
    while (all_[slot].next != slot) slot = all_[slot].next = all_[all_[slot].next].next;
    return slot;
  }
  void unite(const FlatBody* a, const FlatBody* b) {
    if (!moves(a) || !moves(b)) return;
    const std::uint32_t first = root(slot_of(*a)), second = root(slot_of(*b));
    all_[std::max(first, second)].next = std::min(first, second);
  }
  void weigh();
  void weigh_contact(const FlatBody& a, const FlatBody& b, b2Contact* contact);
  double given_to(const FlatBody& flat) const;
  double parting_of(const FlatJoint& joint) const;
  double size_of(const FlatBody& flat) const;
  static double strike_of(const FlatBody& a, const FlatBody& b, b2Contact* contact);

  const Planar::Core& core_;
  double dt_;
  std::pmr::vector<Together> all_;
};

void Landings::weigh() {
  const double fall = core_.settings.gravity.norm() * dt_;
  for (const FlatBody& flat : core_.slots) {
    if (flat.body == kNoBody || flat.fixed || !flat.b2->IsAwake()) continue;
    Together& all = of(flat);
    all.gain += given_to(flat);
    // What rests takes up the speed of a sub-step's fall again and again.
    all.allowed += kGain * core_.motion_of(flat) + 0.5 * flat.mass.mass * fall * fall;
  }
  for_joints([this](const FlatJoint& joint, const FlatBody& child, const FlatBody* parent) {
    Together& all = of(child);
    all.gain -= core_.motor_work(joint, dt_);
    all.joined = true;
    all.uneven = all.uneven || uneven(&child, parent);
    if (child.looped) all.parting += parting_of(joint);
  });
  for_contacts([this](const FlatBody& a, const FlatBody& b, b2Contact* contact) { weigh_contact(a, b, contact); });
}

void Landings::weigh_contact(const FlatBody& a, const FlatBody& b, b2Contact* contact) {
  Together& all = of(a.fixed ? b : a);
  all.uneven = all.uneven || uneven(&a, &b);
  // What scripts move may give energy.
  if (a.driven || b.driven) all.allowed = std::numeric_limits<double>::infinity();
  all.points += contact->GetManifold()->pointCount;
  all.stacked = all.stacked || (moves(&a) && moves(&b));
  if (all.struck) return;
  const double size = std::min(size_of(a), size_of(b)), speed = strike_of(a, b, contact), u = core_.settings.unit;
  all.struck = speed * dt_ > kDeep * size || (speed * u > core_.slowest_bounce(core_.law_of(a, b)) &&
                                              speed * speed * u / 2 > core_.settings.gravity.norm() * kHigh * size);
}

/// The speed at which the ends of a joint part, which the sweeps have left, Box2D's length units/s.
double Landings::parting_of(const FlatJoint& joint) const {
  b2Joint& b = *joint.b2;
  Vector2 speed = vector_of(b.GetBodyB()->GetLinearVelocityFromWorldPoint(b.GetAnchorB())) -
                  vector_of(b.GetBodyA()->GetLinearVelocityFromWorldPoint(b.GetAnchorA()));
  if (joint.is.kind == JointKind::Prismatic) {
    const Vector2 axis = core_.axis_of(joint);
    speed -= speed.dot(axis) * axis;
  }
  return speed.norm();
}

/// The energy that contacts and joints have given to a body, J.
double Landings::given_to(const FlatBody& flat) const {
  const double u = core_.settings.unit, m = flat.mass.mass, inertia = flat.mass.inertia(2, 2);
  const Vector3 before = flat.velocity_before();
  const b2Vec2 v = flat.b2->GetLinearVelocity() + (flat.kicked ? flat.kick : b2Vec2(0, 0));
  const Vector3 after(double{v.x}, double{v.y}, double{flat.b2->GetAngularVelocity()});
  const Vector2 force = m * core_.settings.gravity.head<2>() + flat.force + flat.asked + flat.pull;
  const Vector2 impulse = m * u * (after - before).head<2>() - dt_ * force;
  const double angular = inertia * (after[2] - before[2]) - dt_ * (flat.torque + flat.twist);
  return impulse.dot((before + after).head<2>()) * u / 2 + angular * (before[2] + after[2]) / 2;
}

/// The radius of gyration, length units.
double Landings::size_of(const FlatBody& flat) const {
  if (flat.fixed) return std::numeric_limits<double>::infinity();
  return std::sqrt(flat.mass.inertia(2, 2) / flat.mass.mass) / core_.settings.unit;
}

/// The speed, length units/s, at which two have come together at some point of their contact.
double Landings::strike_of(const FlatBody& a, const FlatBody& b, b2Contact* contact) {
  const auto velocity = [](const FlatBody& flat, const b2Vec2& point) {
    const Vector3 v = flat.velocity_before();
    const Vector2 arm = vector_of(point) - vector_of(flat.b2->GetWorldCenter());
    return Vector2(v.head<2>() + v[2] * left_of(arm));
  };
  b2WorldManifold where;
  contact->GetWorldManifold(&where);
  double fastest = 0;
  for (int k = 0; k < contact->GetManifold()->pointCount; ++k) {
    const Vector2 approach = velocity(a, where.points[k]) - velocity(b, where.points[k]);
    fastest = std::max(fastest, approach.dot(vector_of(where.normal)));
  }
  return fastest;
}

}  // namespace

void Planar::Core::settle_landings(double dt) {
  if (joints.empty() && !(heaviest > kUneven * lightest) && !landed_hard) return;
  Landings landings(*this, dt);
  const double fall = settings.gravity.norm() / settings.unit * dt;
  for (FlatBody& flat : slots) flat.gathered = false;
  for (FlatBody& flat : slots) {
    if (flat.body == kNoBody || flat.fixed || flat.gathered || flat.solved || !flat.b2->IsAwake()) continue;
    if (!landings.of(flat).suspect(fall)) continue;
    Island island(*this, dt);
    island.gather(flat);
    island.solve();
  }
}

}  // namespace breve
