// The inside of Planar: tables of joints and springs, the bodies that Box2D knows, its world. One idea a file works on
// it; README.md says which. Lengths inside b2World are in the world's length unit, everything else in metres.
#pragma once

#include <box2d/box2d.h>

#include <cmath>
#include <exception>
#include <map>
#include <memory>
#include <optional>

#include "runtime/contact/law.hpp"
#include "runtime/mechanics/core.hpp"
#include "runtime/planar/frozen.hpp"
#include "runtime/planar/held.hpp"
#include "runtime/planar/outline.hpp"
#include "runtime/planar/planar.hpp"

namespace breve {

inline constexpr std::uint32_t kNoSlot = 0xffffffffU;

struct FlatJoint : JointRecord {
  double position = 0;  // rad or m, as last known: full rotations are counted from here
  b2Joint* b2 = nullptr;
  double rate = 0;     // of its own axis at the start of the sub-step, in Box2D's units
  double work = 0;     // J, of its motor in the sub-step, where its assembly was solved as a whole
  double pull = 0;     // N or N*m that its spring, damper and set force give in this sub-step
  double bend = 0;     // how `rate` changed in the last sub-step, by time
  bool loose = false;  // its limit is off, since it is to bounce there
};

using FlatSpring = SpringRecord;

/// A body that Box2D knows: one that moves, or that others touch or hang on.
struct FlatBody {
  // What every sub-step looks at comes first: it is read body after body.
  BodyIndex body = kNoBody;
  bool fixed = false;        // does not move by itself
  bool driven = false;       // fixed, but is moved by a script in this step
  bool solid = true;         // others touch it
  bool jointed = false;      // some joint holds it
  int driver_strikes = 0;    // how often what a script moves has struck it, in this sub-step
  bool kicked = false;       // half of this sub-step's acceleration was taken off
  bool pulled = false;       // a spring or force method acts on it
  bool flies = false;        // springs pull at it, or at what joints connect it with, and nothing touches it
  bool has_force = false;    // set by scripts
  bool drowsy = false;       // may sleep, touches and is slow
  bool gathered = false;     // for a solution of what touches and is joined
  bool placed = false;       // stands elsewhere, or has other fixtures, than when Box2D last paired
  bool set_apart = false;    // takes no part in the steps of Box2D that are taken now
  bool steps_later = false;  // but it does, unless it is set apart
  bool missed = false;       // what steps came near it while it was set apart: it is to have a contact yet
  bool solved = false;       // its assembly was solved as a whole in this sub-step
  bool fresh = false;        // it has contacts that are in no order yet
  bool flown = false;        // it has taken this sub-step in flight
  bool looked_at = false;    // whether it rebounds in flight
  bool forced = false;       // springs or a force method may act on it
  int touching = 0;          // contacts that touch
  b2Body* b2 = nullptr;
  b2Vec2 at{0, 0}, before{0, 0};             // the centre of mass and its velocity at the start of the sub-step
  b2Vec2 kick{0, 0}, kicked_velocity{0, 0};  // what was taken off, and what was left
  float spin_kick = 0;
  float before_spin = 0, before_angle = 0;
  b2Vec2 given{0, 0};  // velocity that collisions within Box2D's step have changed it by
  float given_spin = 0;
  std::uint32_t group = kNoSlot;  // the slot that stands for all that it may meet in a sub-step
  int pieces = 1;                 // sub-steps that it needs for one of the others
  std::uint32_t part = kNoSlot;   // of what is solved
  std::uint32_t assembly = kNoSlot;
  bool looped = false;              // joints of its assembly close loops
  double thickness = 0;             // half its narrowest width, length units
  double reach = 0;                 // of its shape from its centre of mass, length units
  double twist = 0;                 // N*m, with `pull`
  Vector2 pull = Vector2::Zero();   // of springs and joints in this sub-step, N
  Vector2 force = Vector2::Zero();  // set by scripts, N
  Vector2 asked = Vector2::Zero();  // of its force method, in this sub-step
  double torque = 0;                // set by scripts, N*m
  MassProperties mass;
  // Values that are compared once a step.
  std::shared_ptr<Shape> shape;
  Material material;
  Vector3 scale = Vector3::Ones();
  // What the arrays held when they were last brought together with Box2D's.
  Vector3 location = Vector3::Zero(), velocity = Vector3::Zero(), spin = Vector3::Zero();
  Quaternion orientation{1, 0, 0, 0};

  /// Velocity and spin before the sub-step's forces, in Box2D's units, with what collisions within it gave.
  Vector3 velocity_before() const {
    const b2Vec2 v = before + given;
    return {double{v.x}, double{v.y}, double{before_spin} + double{given_spin}};
  }
  /// Nothing but gravity and constant forces act on it.
  bool free_flight() const { return !jointed && !pulled && touching == 0; }
};

/// What the guard knows of the energy of the last steps, J.
struct EnergyWatch {
  int steps = 0;        // of this window
  double gain = 0;      // in it, unexplained
  double kinetic = 0;   // the most in it
  double turnover = 0;  // works and losses in it
  double slack = 0;     // the most in it
};

/// What a script set on a body that joints hold.
struct Strike {
  BodyIndex body = kNoBody;
  bool pushed = false, spun = false;  // its velocity, its spin
};

using BodyPair = std::pair<BodyIndex, BodyIndex>;

class SpringRows;

struct Planar::Core final : MechanicsCore, b2ContactListener, b2ContactFilter {
  Core(std::pmr::memory_resource* memory, Bodies& bodies);
  ~Core() override;

  std::pmr::vector<FlatJoint> joints;
  std::pmr::vector<FlatSpring> springs;
  std::pmr::map<BodyIndex, std::pmr::vector<JointIndex>> joints_at;  // by body, in the order of creation
  std::pmr::vector<BodyIndex> force_methods;                         // in order

  std::unique_ptr<b2World> b2;
  b2Body* ground = nullptr;          // what joints to the world hang on
  Held held;                         // memory for what Box2D takes
  std::size_t placed = 0;            // bodies that were since Box2D last paired
  std::pmr::vector<FlatBody> slots;  // those in use have a body
  std::pmr::vector<std::uint32_t> free_slots;
  std::pmr::vector<std::uint32_t> slot_of;  // by body
  std::optional<Frozen> frozen;             // what b2 is to be made of
  float last_step = 0;                      // s
  std::optional<Warm> kept;                 // while a sub-step is cut: impulses of the last one that was not
  bool muted = false;                       // Box2D's world is being dropped: its contacts are not reported
  bool thawing = false;                     // contacts that an image has are made again, whatever the rules are now

  std::uint64_t seen_revision = 0, seen_rules = 0, seen_scalings = 0;
  bool rules_seen = false, members_changed = true, materials_changed = true;
  MechanicsClient* client = nullptr;  // during advance()

  std::pmr::map<BodyPair, bool> met;  // pairs with a handler whose first touch was reported; true: in this step
  double now = 0;                     // s, at the start of the current sub-step
  int calm = 0;                       // steps since something was wrong
  EnergyWatch watched;
  double pushed = 0;                  // J, by which positions that were put right have lifted things in this step
  int refined = 0;                    // the guard's doublings of the sub-steps
  int awake = 0;                      // bodies that step, when their sub-step was planned or its rest began
  std::uint64_t looks = 0;            // at bodies, by steps of some alone in this sub-step
  double step_length = 0;             // s, of the sub-step that is being taken, uncut
  double lightest = 0, heaviest = 0;  // kg, of bodies that move by themselves, in this sub-step
  bool any_missed = false;            // some body has missed contacts
  bool landed_hard = false;           // some body has, in this sub-step
  bool joints_made = false;           // since they were last put in order
  std::size_t fresh_contacts = 0;     // at most so many are in no order yet
  std::exception_ptr failure;         // what went wrong in a callback of Box2D, which must come to its end all the same
  bool stepping = false;              // inside b2World::Step
  double friction = 0;                // J, lost in sliding contacts in this sub-step
  double driven_work = 0;             // J, of bodies moved by scripts on what they touch in this sub-step
  int located = 0;                    // impacts of pairs without handler in this sub-step of what steps
  std::uint64_t work_most = Meter::kNoBound;  // of the sub-step: what counters.work may become
  bool finishing = false;                     // it is that: the rest is taken coarsely
  bool spoiled = false;      // a number is not finite: the rest of the sub-step is left out, before it spreads
  double base = 0;           // J: total energy when the ledger began, plus what came and went with bodies
  double springs_known = 0;  // J: of springs, at the end of the last step; what differs since then scripts did
  std::pmr::vector<BodyIndex> scratch;

  // known_bodies.cpp: which bodies Box2D knows
  FlatBody* find(BodyIndex body);
  const FlatBody* find(BodyIndex body) const { return const_cast<Core*>(this)->find(body); }
  const FlatBody& of(const b2Body* b) const { return const_cast<Core*>(this)->of(b); }
  FlatBody& of(const b2Body* b) {
    return slots[static_cast<std::size_t>(const_cast<b2Body*>(b)->GetUserData().pointer - 1)];
  }
  bool is_body(const b2Body* b) const { return const_cast<b2Body*>(b)->GetUserData().pointer != 0; }
  /// Box2D's world holds what the arrays hold. Error{Argument} for a shape that cannot be.
  void sync();
  void ensure_world();
  void make_world();
  void drop_world();
  void update_members();
  b2Vec2 position_of(BodyIndex body) const;
  void add_member(BodyIndex body);
  void remove_member(std::uint32_t slot);
  void push_shapes();
  void push_changes();

  // fit.cpp
  void fit(FlatBody& flat);

  // waking.cpp
  void wake(BodyIndex body);
  void wake_all();
  FrozenBody* find_frozen(BodyIndex body);
  void wake_ends(const FlatSpring& spring);
  static void wake_touching(FlatBody& flat);
  void wake_met(const FlatBody& flat);

  // known_bodies.cpp
  void note_known(FlatBody& flat);
  void push_pose(FlatBody& flat);
  void push_velocity(FlatBody& flat);
  void push_velocity(FlatBody& flat, const Vector3& velocity, double spin);
  void write_back(FlatBody& flat);
  void write_back_all();
  static bool is_finite(const b2Body& body);
  void refresh_rules();

  // joints.cpp
  FlatJoint& at(JointIndex joint);
  void check_flat(const JointDescription& is) const;
  void place_child(FlatJoint& joint);
  void detach(JointIndex joint);

  // box_joints.cpp
  void make_b2(FlatJoint& joint);
  void make_b2(FlatJoint& joint, float reference);
  static float reference_of(const FlatJoint& joint);
  void drop_b2(FlatJoint& joint);
  void put_drive(FlatJoint& joint);

  // joints.cpp
  double read_position(const FlatJoint& joint) const;
  double read_velocity(const FlatJoint& joint) const;

  // box_joints.cpp
  WarmJoint warm_of(const FlatJoint& joint) const;
  void set_warm(FlatJoint& joint, const WarmJoint& warm);

  // joints.cpp
  double gap(const FlatJoint& joint) const;  // m, between the two points of a joint

  // box_joints.cpp
  Vector2 axis_of(const FlatJoint& joint) const;  // of a prismatic one, unit, as Box2D's bodies stand

  // assemblies.cpp
  void collect(BodyIndex body, std::pmr::vector<BodyIndex>& out) const;
  void collect_beyond(JointIndex joint, std::pmr::vector<BodyIndex>& out);
  bool jointed(BodyIndex a, BodyIndex b) const;
  bool held_by_world(BodyIndex body) const;
  void move_rigidly(std::span<const BodyIndex> some, const Pose& from, const Pose& to);
  void place_beyond(std::span<const BodyIndex> some, BodyIndex parent, const Pose& from, const Pose& to);
  void follow(BodyIndex leader, const Pose& from);
  void number_assemblies();
  bool has_loops(std::span<const BodyIndex> all) const;
  const AssemblySettings* settings_of(BodyIndex body, bool (*wanted)(const AssemblySettings&)) const;

  // waking.cpp
  void place_drivers(double h);

  // crowds.cpp
  std::size_t expected_bytes() const;
  void note_placed(FlatBody& flat);
  void expect_pairs(const WorkBound& most);
  void all_paired();

  // assemblies.cpp
  bool pushes(BodyIndex a, BodyIndex b, const MechanicsClient& asked) const;
  Pose pose(BodyIndex body) const { return {bodies->location(body), bodies->orientation(body)}; }

  // strikes.cpp: velocities that scripts set on what joints connect
  void strike_all(std::pmr::vector<Strike>& all);
  void strike(std::span<const Strike> some);
  void give_velocities(std::span<const BodyIndex> some);
  void allow_velocities(BodyIndex body);
  void take_velocity(FlatBody& flat);

  // loads.cpp: forces of a sub-step
  std::unique_ptr<SpringRows> spring_rows;  // made when there are some; keeps its memory
  void apply_forces(double dt);
  void apply_springs(double dt);
  void ask_forces();

  // step.cpp
  void advance(MechanicsClient& asked, double start, double h, double share);
  bool worn() const;
  void count_work(int iterations);
  void finish(double left);
  int sub_steps() const;
  double longest_step() const;
  int velocity_iterations() const;
  int count_awake() const;
  int iterations_now() const;
  int position_iterations() const;
  void run(double dt, bool handled);
  void take_sub_step(double dt, int count, double left);
  double plan_pieces(double dt, int count);
  void rush(double left);
  void step_box2d(float dt, int iterations);
  void step(double dt, bool bounce = true);
  void end_cuts(double dt);
  void end_cut_short();
  void start_warm(double dt);
  void kick(double dt);
  void return_spins();
  void resist_rolling(double dt);
  void report_lasting(double moment);

  // groups.cpp: bodies that step apart from all others
  class Apart;
  bool steps(const b2Contact& contact) const;
  bool steps(BodyIndex a, BodyIndex b) const;
  bool steps(const FlatJoint& joint) const { return steps(joint.is.parent, joint.is.child); }
  bool steps(const FlatSpring& spring) const { return steps(spring.is.a, spring.is.b); }
  void number_groups(double dt);
  void step_pieces(double dt);
  void step_meeting(double dt);
  void step_groups(double dt);
  void make_missed_contacts();

  // flights.cpp: bodies that rebound in flight
  class Flight;
  struct Unfinished {
    double left = 0;  // s, of the sub-step
    std::pmr::vector<BodyIndex> bodies;
  };
  std::pmr::vector<Unfinished> take_flights(double dt);

  // order.cpp: of what Box2D solves
  ContactKey key_of(const b2Contact& contact) const;
  ContactKey key_of(const b2Contact& contact, bool& swapped) const;
  ContactKey key_of(const b2Fixture& a, int child_a, const b2Fixture& b, int child_b, bool& swapped) const;
  struct Place {
    BodyIndex first = kNoBody;
    ContactKey key;
    friend auto operator<=>(const Place&, const Place&) = default;
  };
  Place place_of(const b2Contact& contact) const;
  Place place_of(const ContactKey& key) const;
  b2Contact* contact_before(const Place& place) const;
  b2Contact* last_before(b2Contact* from, const Place& place) const;
  void order_bodies();
  void order_slots();
  void order_joints();
  void make_contacts();
  void list_places(BodyIndex body, std::pmr::vector<Place>& places) const;
  void order_contacts();
  void order_edges();

  // assembly.cpp: assemblies that nothing pushes
  class Assembly;
  std::pmr::vector<std::unique_ptr<Assembly>> articulations;  // by their first bodies
  bool articulations_known = false;                           // no body or joint came or went since
  void number_joints();
  void move_assemblies(double dt);
  void take_back_gains(double dt);

  // assembly_gaps.cpp: those that something pushes
  void close_joints(double dt);

  // landings.cpp: what Box2D's sweeps solve badly
  class Island;
  void settle_landings(double dt);

  // impacts.cpp: where the next first touch is
  struct Hit {
    b2Fixture *a = nullptr, *b = nullptr;
    int child_a = 0, child_b = 0;
    double t = 0;
    bool handled = false;
    JointIndex stop = kNoJoint;       // that a joint reaches, instead of two shapes
    BodyPair pair{kNoBody, kNoBody};  // the lower index first: of what meets at one moment, the lowest comes first
    double closing = 0;               // length units/s, at which the shapes approach then
  };
  /// Which first touches are looked for.
  struct Sought {
    bool handled = false, bounces = false;
  };
  bool handlers() const;
  bool few() const;
  static bool swings_back(const FlatBody& a, const FlatBody& b, double restitution);
  bool find_hit(double dt, const Sought& sought, Hit& best);
  std::pmr::vector<BodyIndex> meeting(double dt);
  template <class F>
  void each_approach(double dt, const Sought& sought, const F& f);
  double most_approach(const FlatBody& a, const FlatBody& b, double dt) const;
  void consider(b2Fixture* a, int child_a, b2Fixture* b, int child_b, bool handled, double dt, Hit& best, bool& found);
  void look_around(FlatBody& flat, double dt, Hit& best, bool& found);
  void deliver(const Hit& hit, double moment);
  b2Transform transform_after(const FlatBody& flat, double t) const;
  bool approach_fast(const FlatBody& a, const FlatBody& b, double dt) const;
  bool near_enough(const BodyPair& pair) const;
  Contact contact_between(b2Fixture* a, int child_a, b2Fixture* b, int child_b, bool flipped) const;

  // touch.cpp: Box2D's callbacks, and what is known of a contact
  void BeginContact(b2Contact* contact) override;
  void EndContact(b2Contact* contact) override;
  void PreSolve(b2Contact* contact, const b2Manifold* old) override;
  void PostSolve(b2Contact* contact, const b2ContactImpulse* impulse) override;
  void note_driven_work(b2Contact* contact, const b2ContactImpulse& impulse);
  bool lands_hard(b2Contact& contact) const;
  bool ShouldCollide(b2Fixture* a, b2Fixture* b) override;
  contact::Law law_of(const FlatBody& a, const FlatBody& b) const;
  void refresh(b2Contact* contact);

  // impulse.cpp
  static bool squeezed(const FlatBody& a, const FlatBody& b);
  bool collide(FlatBody& a, FlatBody& b, const b2WorldManifold& where, int points);
  void spread(FlatBody& a, FlatBody& b);
  double slowest_bounce(const contact::Law& law) const;

  // stops.cpp: limits that bounce
  bool keeps_within_limits(const FlatJoint& joint, double dt) const;
  void set_stops(bool bounce);
  bool find_stop(double dt, bool found, Hit& best) const;
  bool stops_within(const FlatJoint& joint, double dt, double& t) const;
  void rebound(JointIndex joint);
  double slowest_rebound(const FlatJoint& joint) const;

  // ledger.cpp
  Energy stored() const;
  double kinetic_of(const FlatBody& flat) const;
  double motion_of(const FlatBody& flat) const;
  double energy_of(BodyIndex body) const;
  void end_ledger(double dt);
  double take_back(FlatBody& flat, double given);
  double held_work(const FlatBody& flat, const b2Vec2& moved_by, double dt) const;
  double lifted(const FlatBody& flat, const b2Vec2& moved_by, double dt) const;
  Energy energy() const;
  double springs_energy() const;
  double joint_rate(const FlatJoint& joint) const;
  double motor_work(const FlatJoint& joint, double dt) const;
  bool is_solved(const FlatJoint& joint) const;
  // step_guard.cpp
  bool rest_spoiled(double moment);
  void watch(double moment, bool wrong);
  struct Balance {
    double kinetic = 0, stored = 0, works = 0, losses = 0;  // J
    double slack = 0;  // J, that lifts what is awake by the overlap in which bodies rest
  };
  Balance balance(double in_springs) const;
  double rounding_of_springs() const;
  bool watch_energy(const Balance& before, double moment);
  GuardAction remedy() const;
  FlatBody* liveliest();
  void intervene(BodyIndex body, GuardReason reason, double value, double moment, GuardAction action);
  void rest(FlatBody& flat);
  bool tell_overlaps(double moment, GuardAction action);
  void hold_still(FlatBody& flat);
  void forget_impulses(const FlatBody& flat);

  // save.cpp
  bool take_shapes();
  void prepare_image();
  Frozen freeze() const;
  void freeze(const FlatBody& flat, Frozen& made) const;

  // thaw.cpp
  void thaw_world();
  void thaw();
  void thaw_bodies();
  void thaw_joints();
  void thaw_contacts();
  b2Fixture* fixture_of(BodyIndex body, std::uint32_t number, std::uint32_t child) const;

  // touch.cpp
  void rethrow();
  void before_solving(b2Contact* contact);

  // save.cpp
  Warm warm() const;
  void set_impulses(const Warm& from, double length);
  void set_contacts(const Warm& from, double factor);
  void set_joints(const Warm& from, double factor);
  void save(ByteWriter& out) const;
  void load(ByteReader& in);
  void join_loaded();
  void hash(Hasher& hasher) const;

  // forget.cpp
  void forget(BodyIndex body);

  b2Vec2 to_b2(const Vector3& v) const {
    return {static_cast<float>(v.x() / settings.unit), static_cast<float>(v.y() / settings.unit)};
  }
  Vector3 from_b2(const b2Vec2& v) const { return {v.x * settings.unit, v.y * settings.unit, 0}; }
};

/// The angle of a rotation about z.
inline double angle_of(const Quaternion& q) { return 2 * std::atan2(q.z(), q.w()); }
inline Quaternion rotation_about_z(double angle) { return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)}; }
/// v turned left by a right angle.
inline Vector2 left_of(const Vector2& v) { return {-v.y(), v.x()}; }
inline Vector2 vector_of(const b2Vec2& v) { return {v.x, v.y}; }
/// Which way a revolute joint counts: +1 if its normal is +z.
inline double sense(const JointDescription& is) { return is.normal.z() < 0 ? -1 : 1; }
/// Index of a fixture among those of its body; its shape decides the order.
inline std::uint32_t number_of(const b2Fixture* fixture) {
  return static_cast<std::uint32_t>(const_cast<b2Fixture*>(fixture)->GetUserData().pointer);
}

}  // namespace breve
