// Bodies that have forces: joints, trees, contacts, the step of every rung, energy and guard. What the world, native
// methods and the C API see of it; start here, go on with README.md.
//
// The arrays of runtime/kinematics stay what everybody reads: poses and velocities are written there. Between two calls
// of advance() a script may set anything there; what it set is found at the next advance() (or at once by
// `take_changes`): a link that was moved takes its whole assembly along, a link whose velocity was set is struck, so
// that the whole assembly answers. Positions and velocities of joints are the truth and never drift.
#pragma once

#include <memory>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/memory.hpp"
#include "runtime/dynamics/account.hpp"
#include "runtime/dynamics/accuracy.hpp"
#include "runtime/dynamics/joint.hpp"
#include "runtime/dynamics/spring.hpp"
#include "runtime/kinematics/bodies.hpp"
#include "runtime/solid/contact.hpp"

namespace breve {

/// What dynamics asks of the world around it.
class DynamicsClient {
 public:
  virtual ~DynamicsClient() = default;
  /// Position in the order of creation.
  virtual std::uint64_t serial(BodyIndex body) const = 0;
  /// A handler wants to know when these two touch.
  virtual bool handled(BodyIndex a, BodyIndex b) const = 0;
  /// These two are not to be pushed apart.
  virtual bool ignored(BodyIndex a, BodyIndex b) const = 0;
  /// Handlers are called at the moment of impact; otherwise at the end of the step.
  virtual bool locates() const = 0;
  /// Grows when an answer of the two first may have changed.
  virtual std::uint64_t rules() const = 0;
  /// The moment of impact of a pair with a handler, before its impulse. Bodies of the two islands stand at that moment.
  /// May change, free and create bodies; may throw.
  virtual void impact(BodyIndex a, BodyIndex b, const Contact& contact, double moment) = 0;
  /// The force of a body that has a force method, N, world axes, at the stage that stands in the arrays now.
  /// @param draw  the number of the sub-step, from which numbers drawn at random are to follow
  virtual Vector3 stage_force(BodyIndex body, double time, std::uint64_t draw) = 0;
};

class Dynamics : public InMemory {
 public:
  Dynamics(std::pmr::memory_resource* memory, Bodies& bodies);
  ~Dynamics();
  Dynamics(const Dynamics&) = delete;
  Dynamics& operator=(const Dynamics&) = delete;
  void rebind(Bodies& bodies);  // the same bodies, at another address

  // --- joints -----------------------------------------------------------------------------------------------------
  /// Joins two bodies, or a body to the world. Both become physics-enabled (a Stationary parent is like the world). The
  /// child, with all that hangs on it, is turned to its place (unless keep_rotation) and moved so that the two points
  /// coincide; if it is connected with the parent already, the joint closes a ring: nothing is moved, and the joint
  /// becomes a constraint. A child that is held by the world already closes a ring too.
  /// @param owner  the object behind it, for messages and for who_asked; may be null
  /// @throws Error{Argument} naming the property: a child that is no body or is Stationary, parent and child the same,
  ///         a point, rotation or normal that is not finite or has no direction. Nothing is changed then
  JointIndex link(const JointDescription& description, ObjectId owner);
  void unlink(JointIndex joint);
  bool linked(JointIndex joint) const;  // names a joint that there is
  std::size_t joint_count() const;
  const JointDescription& joint(JointIndex joint) const;
  ObjectId joint_owner(JointIndex joint) const;
  bool closes_ring(JointIndex joint) const;
  /// Point and normal may be changed while it is linked; the bodies are placed anew as by link(). Errors as there.
  void relink(JointIndex joint, const JointDescription& description);

  const JointDrive& drive(JointIndex joint) const;
  /// Error{Argument} naming the number that is not finite, negative where it must not be, or a low limit above a high
  /// one; nothing is changed then. The strength limit is cut to 0 .. strength_hard_limit.
  void set_drive(JointIndex joint, const JointDrive& drive);
  double strength_hard_limit(JointIndex joint) const;  // 500 x mass of the child, N*m or N

  /// rad or m, sign as in JointDescription; a revolute joint counts its whole turns. Universal and ball: angles about
  /// their axes.
  JointVector position(JointIndex joint) const;
  JointVector velocity(JointIndex joint) const;  // rad/s or m/s
  /// Put the joint there, moving so: what hangs on the child's side moves along. Error{Argument} if not finite, or if
  /// the joint closes a ring.
  void set_position(JointIndex joint, const JointVector& position);
  void set_velocity(JointIndex joint, const JointVector& velocity);
  /// The same for a ball joint, without angles: at zero turned by `turn`, child relative to parent, in the parent's
  /// axes, and spinning so. Errors as above, and if it is no ball joint.
  void set_ball(JointIndex joint, const Quaternion& turn, const Vector3& spin);
  /// At this moment, from the forces that act now (those of joints that close rings too) and those that contacts and
  /// limits had in the last sub-step.
  JointReaction reaction(JointIndex joint) const;

  // --- assemblies: bodies that joints connect ---------------------------------------------------------------------
  bool jointed(BodyIndex a, BodyIndex b) const;        // directly
  bool same_assembly(BodyIndex a, BodyIndex b) const;  // through joints
  /// All bodies that joints connect with this one, itself too, and the joints; in the order of creation of the bodies'
  /// indices and joints. A body without joints is alone.
  std::pmr::vector<BodyIndex> links_of(BodyIndex body) const;
  std::pmr::vector<JointIndex> joints_of(BodyIndex body) const;
  /// Moves the whole assembly rigidly so that this body stands there. Anchors of joints to the world move along.
  void move_assembly(BodyIndex body, const Vector3& location, const Quaternion& orientation);
  /// The whole assembly moves as one solid, so that this body has this velocity and spin (world axes): no joint turns.
  /// Joints to the world allow what they allow. Error{Argument} if not finite.
  void set_assembly_velocity(BodyIndex body, const Vector3& velocity, const Vector3& spin);
  /// Settings of the assembly that this body belongs to, kept with the body; the first body in the order of indices
  /// that has some decides for an assembly.
  void set_self_collisions(BodyIndex body, bool on);
  bool self_collisions(BodyIndex body) const;
  /// Contact softness within the assembly, for the iterative solver; used if cfm is not 0.
  void set_self_collision_parameters(BodyIndex body, double erp, double cfm);
  void set_accuracy(BodyIndex body, const Accuracy& accuracy);
  void clear_accuracy(BodyIndex body);
  const Accuracy& accuracy(BodyIndex body) const;  // in force: the assembly's or the world's
  Energy energy(BodyIndex body) const;             // of its assembly; works and losses since it was made
  /// A script put the body somewhere else: if it has joints, its assembly follows now. Otherwise, and where this is not
  /// called, before anything is done with its assembly.
  void moved(BodyIndex body);
  /// Pairs of links of the assembly that intersect now, of those that are tested at all: not those that a joint
  /// connects, and none without self collisions. Time grows as the square of the number of links.
  std::size_t self_penetrations(BodyIndex body) const;

  // --- springs between bodies ---------------------------------------------------------------------------------------
  /// Error{Argument} naming the property. The same body twice gives kNoSpring.
  SpringIndex tie(const SpringDescription& description, ObjectId owner);
  void untie(SpringIndex spring);
  bool tied(SpringIndex spring) const;
  const SpringDescription& spring(SpringIndex spring) const;
  void set_spring(SpringIndex spring, const SpringDescription& description);  // not its bodies
  double spring_length(SpringIndex spring) const;                             // m, now
  double spring_force(SpringIndex spring) const;  // N, in the last sub-step; pulling is positive

  // --- settings of the world ----------------------------------------------------------------------------------------
  void set_gravity(const Vector3& gravity);  // m/s^2; Error{Argument} if not finite
  const Vector3& gravity() const;
  void set_accuracy(Rung rung);
  void set_accuracy(const Accuracy& accuracy);  // Error{Argument} naming the setting
  const Accuracy& accuracy() const;
  void set_guard(GuardMode mode);
  GuardMode guard() const;
  /// Bodies at rest may sleep until something touches or changes them (enable-auto-disable). Off at first.
  void set_sleeping(bool on);
  bool sleeping() const;
  /// Contacts by the iterative solver and nothing else (enable-fast-physics), with at most so many iterations; 0: as
  /// the rung says.
  void set_fast_contacts(int iterations);
  /// For the softness of the iterative solver; ignored where contacts are solved exactly.
  void set_softness(double erp, double cfm);
  double erp() const;
  double cfm() const;
  /// Threads that work on islands, the caller's one of them; results do not depend on it. 1 at first.
  void set_workers(int workers);
  int workers() const;
  /// The client's stage_force is asked for this body's force at every stage of the integrator.
  void set_force_method(BodyIndex body, bool on);
  bool force_method(BodyIndex body) const;

  // --- what there is to know ----------------------------------------------------------------------------------------
  bool asleep(BodyIndex body) const;
  Energy energy() const;  // of all physics-enabled bodies
  const DynamicsCounters& counters() const;
  std::span<const Intervention> interventions() const;  // of the last iteration
  std::span<const Impact> impacts() const;              // of the last iteration
  std::size_t bytes() const;
  // What the effects ask: how many there are, and who asked first.
  struct Census {
    std::size_t bodies = 0;                                       // physics-enabled
    std::size_t joints = 0, limits = 0, motors = 0, springs = 0;  // joints with them
    std::size_t pairs = 0, rough = 0, bouncing = 0;  // pairs near enough to push; of them with friction, restitution
    std::size_t force_methods = 0, asleep = 0;
    ObjectId first_joint, first_limit, first_motor, first_spring, first_pair, first_rough, first_bouncing;
    ObjectId first_force_method;
  };
  Census census() const;

  // --- the world's side ---------------------------------------------------------------------------------------------
  void begin_iteration(std::uint64_t iteration);  // counters, interventions and impacts start again
  /// Moves all physics-enabled bodies from time `start` to `start + h`. Error{Numeric} only with the guard off.
  void advance(DynamicsClient& client, double start, double h);
  /// Something left advance() by an exception.
  void abandon();
  /// Finds what was changed in the arrays since, and brings assemblies in step with it.
  void take_changes();
  /// Contacts of these two are solved here, and their handlers called from here.
  bool pushes(BodyIndex a, BodyIndex b, const DynamicsClient& client) const;
  std::uint64_t rules() const;  // grows when that may have changed
  void forget(BodyIndex body);  // it is going: its joints and springs go with it
  void save(ByteWriter& out) const;
  void load(ByteReader& in);  // into a fresh one whose bodies are loaded; Error{Image}
  void hash(Hasher& hasher) const;

  struct Core;  // the inside

 private:
  // Made with the first joint, tie or physics-enabled body.
  Core& core();
  std::pmr::memory_resource* memory_;
  Bodies* bodies_;
  std::unique_ptr<Core> core_;
};

}  // namespace breve
