// The interface to the motion of bodies with forces: joints, contacts, accuracy, energy, guard. This is all that the
// world, native methods and the C API see of it; behind it stands runtime/dynamics in space, runtime/planar in a flat
// world.
//
// The arrays of runtime/kinematics stay what everybody reads: poses and velocities are written there. Between two calls
// of advance() a script may set anything there; what it set is found at the next advance() (or at once by
// `take_changes`): a link that was moved takes its whole assembly along, a link whose velocity was set is struck, so
// that the whole assembly answers.
#pragma once

#include <memory_resource>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/memory.hpp"
#include "runtime/base/meter.hpp"
#include "runtime/base/workers.hpp"
#include "runtime/kinematics/bodies.hpp"
#include "runtime/mechanics/accuracy.hpp"
#include "runtime/mechanics/joint.hpp"
#include "runtime/mechanics/ledger.hpp"
#include "runtime/mechanics/spring.hpp"
#include "runtime/solid/contact.hpp"

namespace breve {

/// What mechanics asks of the world around it.
class MechanicsClient {
 public:
  virtual ~MechanicsClient() = default;
  /// Position in the order of creation.
  virtual std::uint64_t serial(BodyIndex body) const = 0;
  /// A handler wants to know when these two touch.
  virtual bool handled(BodyIndex a, BodyIndex b) const = 0;
  /// These two are not to be pushed apart.
  virtual bool ignored(BodyIndex a, BodyIndex b) const = 0;
  /// Handlers are called at the moment of impact; otherwise at the end of the step.
  virtual bool locates() const = 0;
  /// Some pair has a handler.
  virtual bool any_handled() const = 0;
  /// Grows when an answer of the two first may have changed.
  virtual std::uint64_t rules() const = 0;
  /// The moment of impact of a pair with a handler, before its impulse. Bodies of the two islands stand at that moment.
  /// May change, free and create bodies; may throw.
  virtual void impact(BodyIndex a, BodyIndex b, const Contact& contact, double moment) = 0;
  /// The force of a body that has a force method, N, world axes, at the stage that stands in the arrays now.
  /// @param draw  the number of the sub-step, from which numbers drawn at random are to follow
  virtual Vector3 stage_force(BodyIndex body, double time, std::uint64_t draw) = 0;
  /// The threads that may share the work; null: the caller's own thread does it all.
  virtual Workers* workers() const { return nullptr; }
};

struct AssemblySettings;
struct JointRecord;
struct MechanicsCore;
struct SpringRecord;
struct WorldSettings;

/// The virtual functions differ between space and a flat world. The others, in mechanics.cpp, work on what both keep
/// (core.hpp).
class Mechanics : public InMemory {
 public:
  Mechanics() = default;
  Mechanics(const Mechanics&) = delete;
  Mechanics& operator=(const Mechanics&) = delete;
  virtual ~Mechanics() = default;
  virtual void rebind(Bodies& bodies) = 0;  // the same bodies, at another address

  // --- joints -----------------------------------------------------------------------------------------------------
  /// Joins two bodies, or a body to the world. Both become physics-enabled (a Stationary parent is like the world). The
  /// child, with everything attached to it, is rotated to its pose (unless keep_rotation) and moved so that the two
  /// points coincide; if it is connected with the parent already, the joint closes a loop: nothing is moved, and the
  /// joint becomes a constraint. A child that the world already holds also closes a loop.
  /// @param owner  the object behind it, for messages and for who_asked; may be null
  /// @throws Error{Argument} naming the property: a child that is not a body or is Stationary, a parent that is the
  ///         child, a point, rotation or normal that is not finite or has no direction. Nothing is changed then
  virtual JointIndex link(const JointDescription& description, ObjectId owner) = 0;
  virtual void unlink(JointIndex joint) = 0;
  bool linked(JointIndex joint) const;  // names a joint that there is
  virtual std::size_t joint_count() const = 0;
  const JointDescription& joint(JointIndex joint) const;
  ObjectId joint_owner(JointIndex joint) const;
  bool closes_loop(JointIndex joint) const;
  /// Point and normal may be changed while it is linked; the bodies are placed anew as by link(). Errors as there.
  virtual void relink(JointIndex joint, const JointDescription& description) = 0;

  const JointDrive& drive(JointIndex joint) const;
  /// Error{Argument} naming the number that is not finite, negative where it must not be, or a low limit above a high
  /// one; nothing is changed then. The strength limit is cut to 0 .. strength_hard_limit.
  virtual void set_drive(JointIndex joint, const JointDrive& drive) = 0;
  double strength_hard_limit(JointIndex joint) const;  // 500 x mass of the child, N*m or N

  /// rad or m, sign as in JointDescription; a revolute joint counts whole revolutions. Universal and ball: angles about
  /// their axes.
  virtual JointVector position(JointIndex joint) const = 0;
  virtual JointVector velocity(JointIndex joint) const = 0;  // rad/s or m/s
  /// Put the joint there, moving so: what hangs on the child's side moves along. Error{Argument} if not finite, or
  /// if the joint closes a loop.
  virtual void set_position(JointIndex joint, const JointVector& position) = 0;
  virtual void set_velocity(JointIndex joint, const JointVector& velocity) = 0;
  /// The same for a ball joint, without angles: at zero turned by `rotation`, child relative to parent, in the parent's
  /// axes, and spinning so. Errors as above, and if it is not a ball joint.
  virtual void set_ball(JointIndex joint, const Quaternion& rotation, const Vector3& spin) = 0;
  /// At this moment, from the forces that act now (including those of joints that close loops) and those that contacts
  /// and limits had in the last sub-step.
  virtual JointReaction reaction(JointIndex joint) const = 0;

  // --- assemblies: bodies that joints connect ---------------------------------------------------------------------
  virtual bool jointed(BodyIndex a, BodyIndex b) const = 0;        // directly
  virtual bool same_assembly(BodyIndex a, BodyIndex b) const = 0;  // through joints
  /// All bodies that joints connect with this one, including itself, and the joints; in the order of creation of the
  /// bodies' indices and joints. A body without joints is alone.
  virtual std::pmr::vector<BodyIndex> links_of(BodyIndex body) const = 0;
  virtual std::pmr::vector<JointIndex> joints_of(BodyIndex body) const = 0;
  /// Moves the whole assembly rigidly so that this body stands there. Anchors of joints to the world move along.
  virtual void move_assembly(BodyIndex body, const Vector3& location, const Quaternion& orientation) = 0;
  /// The whole assembly moves as one solid, so that this body has this velocity and spin (world axes): no joint moves.
  /// Joints to the world allow what they allow. Error{Argument} if not finite.
  virtual void set_assembly_velocity(BodyIndex body, const Vector3& velocity, const Vector3& spin) = 0;
  /// Settings of the assembly that this body belongs to, kept with the body; the first body in the order of indices
  /// that has some decides for an assembly.
  void set_self_collisions(BodyIndex body, bool on);
  bool self_collisions(BodyIndex body) const;
  /// Contact softness within the assembly, for the iterative solver; used if cfm is not 0.
  virtual void set_self_collision_parameters(BodyIndex body, double erp, double cfm) = 0;
  void set_accuracy(BodyIndex body, const Accuracy& accuracy);
  void clear_accuracy(BodyIndex body);
  const Accuracy& accuracy(BodyIndex body) const;   // in force: the assembly's or the world's
  virtual Energy energy(BodyIndex body) const = 0;  // of its assembly; works and losses since it was made
  /// A script put the body somewhere else: if it has joints, its assembly follows now. Otherwise, and where this is not
  /// called, before anything is done with its assembly.
  virtual void moved(BodyIndex body) = 0;
  /// Pairs of links of the assembly that intersect now, of those that are tested at all: not those that a joint
  /// connects, and none without self collisions. Time grows as the square of the number of links.
  virtual std::size_t self_penetrations(BodyIndex body) const = 0;

  // --- springs between bodies ---------------------------------------------------------------------------------------
  /// Error{Argument} naming the property. The same body twice gives kNoSpring.
  virtual SpringIndex add_spring(const SpringDescription& description, ObjectId owner) = 0;
  virtual void remove_spring(SpringIndex spring) = 0;
  bool has_spring(SpringIndex spring) const;
  const SpringDescription& spring(SpringIndex spring) const;
  virtual void set_spring(SpringIndex spring, const SpringDescription& description) = 0;  // not its bodies
  double spring_length(SpringIndex spring) const;                                         // m, now
  double spring_force(SpringIndex spring) const;  // N, in the last sub-step; pulling is positive

  // --- settings of the world ----------------------------------------------------------------------------------------
  virtual int dimension() const = 0;  // 3, or 2 in a flat world
  /// m: about the size of the bodies, 1 unless set. Thresholds of lengths and speeds (rest, rebound, errors of motion)
  /// are multiples of it; a flat world computes with it as 1, so that sizes from 0.1 to 10 of it are best.
  double length_unit() const;
  /// Error{Argument} if it is not from 1e-9 to 1e9.
  void set_length_unit(double metres);
  virtual void set_gravity(const Vector3& gravity) = 0;  // m/s^2; Error{Argument} if not finite
  const Vector3& gravity() const;
  void set_accuracy(Rung rung);
  void set_accuracy(const Accuracy& accuracy);  // Error{Argument} naming the setting
  const Accuracy& accuracy() const;
  virtual std::string describe_accuracy() const = 0;  // what the settings mean here, in words, for people
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
  virtual void set_force_method(BodyIndex body, bool on) = 0;
  virtual bool force_method(BodyIndex body) const = 0;

  // --- what there is to know ----------------------------------------------------------------------------------------
  virtual bool asleep(BodyIndex body) const = 0;
  /// What the contact of two bodies carried in the last sub-step, N on `body`, and with kNoBody all its contacts.
  virtual Vector3 contact_force(BodyIndex body, BodyIndex other) const = 0;
  virtual Energy energy() const = 0;  // of all physics-enabled bodies
  const DynamicsCounters& counters() const;
  std::span<const Intervention> interventions() const;  // of the last iteration
  std::span<const Impact> impacts() const;              // of the last iteration
  virtual std::size_t bytes() const = 0;
  // What the effects ask: how many there are, and who asked first.
  struct Census {
    std::size_t bodies = 0;                                       // physics-enabled
    std::size_t joints = 0, limits = 0, motors = 0, springs = 0;  // joints with them
    std::size_t pairs = 0, rough = 0, bouncing = 0;  // pairs near enough to push; of them with friction, restitution
    std::size_t force_methods = 0, asleep = 0;
    ObjectId first_joint, first_limit, first_motor, first_spring, first_pair, first_rough, first_bouncing;
    ObjectId first_force_method;
  };
  virtual Census census() const = 0;

  // --- the world's side ---------------------------------------------------------------------------------------------
  /// Counters, interventions and impacts start again.
  /// @param bound  of the work of all advance() until the next iteration
  void begin_iteration(std::uint64_t iteration, const WorkBound& bound);
  /// A call of the host begins in which scripts may advance bodies outside an iteration: its work has the same bound.
  /// What the last iteration counted stays.
  void begin_call(const WorkBound& bound);
  /// Moves all physics-enabled bodies from time `start` to `start + h`. Error{Numeric} only with the guard off.
  /// @param share  of the work that is left of the bound, that this may take: what needs more is finished coarsely, and
  ///               the guard tells. In (0, 1]
  virtual void advance(MechanicsClient& client, double start, double h, double share) = 0;
  bool over() const;  // the work of the iteration is used up, or ended
  /// Something left advance() by an exception.
  virtual void abandon() = 0;
  /// Finds what was changed in the arrays since, and brings assemblies in step with it.
  virtual void take_changes() = 0;
  /// Contacts of these two are solved here, and their handlers called from here.
  virtual bool pushes(BodyIndex a, BodyIndex b, const MechanicsClient& client) const = 0;
  std::uint64_t rules() const;              // grows when that may have changed
  virtual void forget(BodyIndex body) = 0;  // it is going: its joints and springs go with it
  virtual void save(ByteWriter& out) const = 0;
  virtual void load(ByteReader& in) = 0;  // into a fresh one whose bodies are loaded; Error{Image}
  virtual void hash(Hasher& hasher) const = 0;

 protected:
  void share(MechanicsCore& core);
  const WorldSettings& settings() const;
  const WorkBound& bound() const { return bound_; }
  /// The inside, which is made if there is none yet.
  virtual MechanicsCore& inside() = 0;
  virtual const JointRecord* joint_record(JointIndex joint) const = 0;      // null: it is not linked
  virtual const SpringRecord* spring_record(SpringIndex spring) const = 0;  // null: it is not connected
  /// The settings of the first body of the assembly, by index, that has `wanted` ones; null if there is none.
  virtual const AssemblySettings* settings_of(BodyIndex body, bool (*wanted)(const AssemblySettings&)) const = 0;
  virtual void settings_begin(BodyIndex) {}  // the body gets settings of its own
  virtual void accuracy_changed() {}         // of the world, or of some assembly
  virtual void sleeping_ended() {}
  virtual void length_unit_changed() {}

 private:
  MechanicsCore* shared_ = nullptr;  // null: there is no inside yet
  WorkBound bound_;                  // of the iteration
  int workers_ = 1;                  // a world that has no inside yet has none for their sake: hashes do not know them
};

}  // namespace breve
