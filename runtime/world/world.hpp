// One running simulation: objects, bodies, clock, schedule, observers, collision handlers, input, random numbers.
// It owns every part and orders the step; the parts do not know it.
#pragma once

#include <cstdint>
#include <memory>
#include <memory_resource>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"
#include "runtime/base/memory.hpp"
#include "runtime/base/random.hpp"
#include "runtime/kinematics/bodies.hpp"
#include "runtime/mechanics/mechanics.hpp"
#include "runtime/space/extent.hpp"
#include "runtime/world/behaviour.hpp"
#include "runtime/world/effects.hpp"
#include "runtime/world/events.hpp"
#include "runtime/world/object_handle.hpp"
#include "runtime/world/queries.hpp"
#include "runtime/world/resource.hpp"
#include "runtime/world/stage_observer.hpp"
#include "runtime/world/view.hpp"

namespace breve {

class PairJudge;

class World : public InMemory {
 public:
  /// @param memory  where every container of the world takes its bytes; outlives the world
  explicit World(std::pmr::memory_resource* memory, std::uint64_t seed = 1);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void set_behaviour(Behaviour* behaviour);  // not owned; outlives stepping
  /// Tell `observer` of the stages of the step from now on; null: nobody. Not owned. Not from inside a step.
  void set_stage_observer(StageObserver* observer) { observer_ = observer; }

  /// The threads that physics may use, up to as many as Mechanics::set_workers says. Not owned; outlives stepping.
  void share_workers(Workers* workers) { workers_ = workers; }

  // --- objects ---------------------------------------------------------------------------------------------------
  /// A new live instance. It joins the iteration lists at the start of the next step, in order of creation.
  /// @param user  what the script side wants back from `user(id)`
  ObjectId create(ClassId cls, std::uint64_t user, bool iterates, bool post_iterates);
  /// Forget everything about a live object: body, resource, schedule, observers. Its id is stale from now on.
  void release(ObjectId id);
  bool alive(ObjectId id) const;
  /// What hosts know an instance by, together with its index, also if it is gone. No restore gives it to another one.
  std::uint32_t ticket(ObjectId id) const;
  ObjectId holder(std::uint32_t index, std::uint32_t ticket) const;  // the live instance; null if there is none
  /// By index, for those who ask of many: an object is live if its ticket stands there. Good until one is created.
  std::span<const ObjectHandle> handles() const;
  std::uint64_t user(ObjectId id) const;  // Error{Stale} if not alive
  void set_user(ObjectId id, std::uint64_t user);
  ClassId class_of(ObjectId id) const;
  bool runs(ObjectId id, bool iterates, bool post_iterates) const;  // was it made so?
  /// Live objects in order of creation.
  std::pmr::vector<ObjectId> objects() const;
  std::size_t object_count() const;
  /// The script side has replaced its program: objects and collision handlers go over to other class numbers, and who
  /// iterates is decided anew. All or nothing. Error{Busy} inside a step, Error{Argument} if a live object's class is
  /// gone.
  /// @param classes  by old number
  void reclass(std::span<const ClassChange> classes);

  // --- native data of an object ----------------------------------------------------------------------------------
  void attach(ObjectId id, std::unique_ptr<Resource> resource);  // replaces an earlier one
  Resource* resource(ObjectId id) const;                         // null if none or not alive
  void add_resource_kind(std::string_view kind, ResourceLoader loader);

  // --- bodies ----------------------------------------------------------------------------------------------------
  /// Give a live object a body at the origin. One per object.
  void embody(ObjectId id, BodyKind kind);
  bool has_body(ObjectId id) const;
  BodyIndex body(ObjectId id) const;  // Error{Stale} if not alive, Error{Argument} if it has no body
  Bodies& bodies() { return *bodies_; }
  const Bodies& bodies() const { return *bodies_; }
  /// Joints, springs, accuracy, energy: whatever has to do with forces. Valid until the world is loaded or destroyed.
  Mechanics& mechanics();
  const Mechanics& mechanics() const;
  /// From now on the world is flat: every body has z = 0 and rotates only about z. What mechanics() gave before is
  /// gone; its settings are kept. Error{Argument} if there are bodies with physics, joints or springs, or a body that
  /// is not in the plane. Does nothing if it is already flat.
  void flatten();
  int dimension() const { return bodies_->flat() ? 2 : 3; }
  /// Objects whose shapes intersect this one's now and that are solvable (physics-enabled, Stationary), creation order.
  std::pmr::vector<ObjectId> touching(ObjectId id);

  // --- neighbours (centres only; see docs/language.md) -------------------------------------------------------------
  /// Record where everything is: neighbours are asked of this moment until the next call.
  void update_neighbors();
  /// Live objects strictly within `id`'s neighbourhood size of its centre at the last update, order of creation.
  /// The span is valid until the next call on this world.
  const std::pmr::vector<ObjectId>& neighbors(ObjectId id);
  /// What user() gives for each of these neighbours, in the same order and as long valid: cheaper than asking for each.
  std::span<const std::uint64_t> neighbor_users(ObjectId id);

  // --- questions about space ---------------------------------------------------------------------------------------
  /// To be asked about scene(). Count what they cost with work(EffectId::Queries, …).
  Queries& queries();
  Queries::Scene scene();
  /// The same for a script: the work of the answer counts as its own, and the host may end it.
  Queries::Scene scene_of_script();

  // --- how far space goes ------------------------------------------------------------------------------------------
  /// Along this axis space is open, wraps, or has walls. At the end of each sub-step kinematic bodies that move, and
  /// bodies with physics that have no joints, are brought inside; walls reflect their centres. Neighbours and offsets
  /// are across edges that wrap; collisions are not. @throws Error{Argument} as Extent::set
  void set_space(int axis, Ending edge, double low, double high, ObjectId asked_by = {});
  const Extent& space() const;

  // --- clock and step ----------------------------------------------------------------------------------------------
  double time() const { return clock_.time; }
  double iteration_step() const { return clock_.iteration_step; }
  double integration_step() const { return clock_.integration_step; }
  void set_iteration_step(double seconds);    // how long an iteration lasts, exactly; finite and > 0
  void set_integration_step(double seconds);  // the longest sub-step; finite and > 0
  /// Equal sub-steps of an iteration: as few as are no longer than the integration step. Error{Argument} if they are
  /// more than 1e9.
  std::uint64_t substeps() const;
  /// The budget of the physics of each iteration, see Mechanics::advance.
  void bound_physics(const WorkBound& bound) { physics_bound_ = bound; }
  /// The host calls a script: what bodies are advanced in this call have the bound of an iteration.
  void begin_call();
  std::uint64_t iteration() const { return clock_.iteration; }
  /// One iteration: input, iterate, post-iterate, scheduled calls, the script side's own end. Errors of scripts pass
  /// through; the rest of the iteration is then not run and not counted, and the world may be stepped, saved or
  /// destroyed. Error{Busy} from inside a step.
  void step();
  /// Advance every body by one iteration step, in sub-steps, with collision handlers. Called by the controller's
  /// iterate. The clock moves once, at the end; while a handler runs it reads the moment of the contact.
  /// Error{Busy} from inside itself; Error{Argument} if an iteration step has too many sub-steps.
  void advance_bodies();
  /// The body, which has no physics, goes straight and evenly and is there at the end of the next iteration; then it
  /// stands. It pushes and carries what it touches. Omitted values stay as they were set for that iteration, or are.
  /// Error{Argument}: it has physics, or the target is not finite.
  void set_target(BodyIndex body, const Vector3* location, const Quaternion* orientation);
  /// Where the body is to be at the end of the next iteration; none if nobody has set that.
  std::optional<Pose> target(BodyIndex body) const;
  /// A force and a torque, world axes, that act beside those that are set, in the next iteration only. At `point`,
  /// world frame; null: at the centre of mass. Error{Argument}: not finite, out of the plane of a flat world, or no
  /// body with physics.
  void add_force(BodyIndex body, const Vector3& force, const Vector3& torque, const Vector3* point);
  /// An impulse, N*s: at once; on a body that joints hold as a force of the next iteration. Likewise.
  void add_impulse(BodyIndex body, const Vector3& impulse, const Vector3* point);
  /// If it sleeps.
  void wake(BodyIndex body);
  /// A script or host is about to put the body elsewhere. One that bodies with physics meet goes there in the next
  /// iteration, as to a target, if that is no farther than its bounding radius and half a radian; else it jumps.
  void leave(BodyIndex body);
  /// Acts on physics-enabled bodies, (0, -9.81, 0) until set. Error{Argument} if not finite.
  void set_gravity(const Vector3& gravity);
  const Vector3& gravity() const;
  bool stepping() const { return stepping_; }
  void request_end() { clock_.end_requested = true; }
  bool end_requested() const { return clock_.end_requested; }
  void set_paused(bool paused) { clock_.paused = paused; }
  bool paused() const { return clock_.paused; }

  // --- schedule ----------------------------------------------------------------------------------------------------
  /// Call `method` of `target` at absolute time `when`; again every `interval` seconds if it is > 0.
  /// Returns false, and queues nothing, if `when` is not in the future; a repeating one starts an interval from now
  /// then. Error{Argument} for a time or an interval that is not finite, Error{Stale} for a target that is not alive.
  bool schedule(ObjectId target, std::string_view method, double when, double interval = 0);
  /// Remove queued calls: those of `method` ("" = any) at time `when` (0 = any). Returns how many.
  std::size_t unschedule(ObjectId target, std::string_view method, double when);
  /// Among calls due at the same time the last scheduled goes first (default), or the first.
  void set_stable_schedule(bool stable);
  /// Calls run up to one iteration step early (default, as programs observed), or only once their time has come.
  void set_exact_schedule(bool exact);
  std::size_t scheduled_count() const;

  // --- notifications -----------------------------------------------------------------------------------------------
  void observe(ObjectId observer, ObjectId announcer, std::string_view message, std::string_view method);
  std::size_t unobserve(ObjectId observer, ObjectId announcer, std::string_view message);  // all matching; how many
  void announce(ObjectId announcer, std::string_view message);  // calls at once, order of registration

  // --- collision handlers, by exact class on both sides --------------------------------------------------------------
  void handle_collisions(ClassId owner, ClassId other, std::string_view method, ObjectId asked_by);
  void ignore_collisions(ClassId owner, ClassId other);
  struct CollisionRule {
    ClassId other;
    std::string_view method;  // empty: no handler
    bool ignored;
  };
  std::vector<CollisionRule> collision_rules(ClassId owner) const;  // by the number of the other class
  /// "impact" (first touch at its time of impact, the default) or "step" (calls at the end of the sub-step).
  void set_impact_timing(bool at_impact);

  // --- who collides with whom ----------------------------------------------------------------------------------------
  void set_filter(BodyIndex body, const CollisionFilter& filter);  // as Bodies::set_filter; who lies on it wakes
  /// Two objects whose collisions are off neither push one another nor call handlers. Returns whether this changes
  /// anything. Error{Stale}, Error{Argument} if both are the same object.
  bool set_collides(ObjectId a, ObjectId b, bool on);
  bool collides(ObjectId a, ObjectId b) const;
  /// Asked about what comes near to bodies that ask, before their objects are. Not owned; null: nobody.
  void set_pair_judge(PairJudge* judge);

  // --- events --------------------------------------------------------------------------------------------------------
  Events& events();                                         // made on first use
  const Events* gathered() const { return events_.get(); }  // null: nobody asked for any

  // --- input, random numbers, view -----------------------------------------------------------------------------------
  void queue_input(InputEvent event);
  Random& random() { return random_; }
  ViewState& view() { return view_; }
  const ViewState& view() const { return view_; }

  // --- what it cost, what it is --------------------------------------------------------------------------------------
  const Effects& effects() const;
  /// What scripts call for by themselves, patches and diffusion: `items` are added, and the time until the end of the
  /// scope that keeps the result.
  StageScope work(EffectId id, ObjectId asked_by, std::uint64_t items);
  /// The same of what a host asks for, maybe between iterations: observers do not hear of it.
  StageScope asked_by_host(EffectId id);
  std::uint64_t hash() const;
  /// The whole world with its script side, as a checked, versioned image. Error{Busy} inside a step.
  std::pmr::vector<std::uint8_t> save(std::uint64_t program_fingerprint) const;
  /// Replace this world's state by an image's. Error{Image} for a damaged or foreign image; the world is then
  /// unchanged.
  void load(const std::uint8_t* data, std::size_t size, std::uint64_t program_fingerprint);

 private:
  struct Parts;
  struct Clock {
    double time = 0;     // s
    double residue = 0;  // what rounding kept out of `time` (Kahan): a thousand steps of 0.06 make 60
    double iteration_step = 0.06;
    double integration_step = 0.02;
    std::uint64_t iteration = 0;
    bool end_requested = false;
    bool paused = false;
    void advance(double seconds);
  };

  // step.cpp
  void deliver_input();
  void run_scheduled();
  void run_substeps(double h, std::uint64_t count);
  void count_bytes();
  // judge.cpp, events.cpp
  void wake_around(BodyIndex body);
  void gather_events();
  void tell_events();
  void look_again();
  // world_image.cpp
  void write_image(ByteWriter& out) const;
  void read_image(ByteReader& in, World& fresh) const;
  void swap_state(World& other);

  std::pmr::memory_resource* memory_;
  Behaviour* behaviour_ = nullptr;
  StageObserver* observer_ = nullptr;
  std::unique_ptr<Bodies> bodies_;
  std::unique_ptr<Parts> parts_;
  std::unique_ptr<Events> events_;  // not state
  Random random_;
  ViewState view_;
  Clock clock_;
  WorkBound physics_bound_;
  Workers* workers_ = nullptr;
  bool stepping_ = false;
  bool advancing_ = false;
};

}  // namespace breve
