// Every body of a world as arrays: pose, velocity, acceleration, shape, material. A script object holds an index.
// Kinematic motion is explicit Euler from the values at the start of a sub-step; free rigid motion is in free_motion.
#pragma once

#include <cstdint>
#include <memory>
#include <memory_resource>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"
#include "runtime/solid/shape.hpp"

namespace breve {

using BodyIndex = std::uint32_t;
inline constexpr BodyIndex kNoBody = 0xffffffffU;

enum class BodyKind : std::uint8_t { Mobile, Stationary, Link };

/// Coulomb friction and restitution as scripts set them. Defaults: an object that nobody configured.
struct Material {
  double restitution = 0.4;
  double friction = 0.15;
  double static_friction = -1;  // >= 0: set exactly by set-friction
  double dynamic_friction = -1;
  double normal_restitution = -1;  // >= 0: set exactly by set-restitution
  double tangential_restitution = 0;
  double restitution_threshold = 0;
};

/// Which bodies meet: category and mask as bits, and what a meeting does. Defaults: everything meets everything.
struct CollisionFilter {
  std::uint32_t category = 1;
  std::uint32_t mask = 0xffffffffU;   // of the categories of those that it meets
  bool sensor = false;                // handlers and events, and nobody is pushed
  bool asks = false;                  // its object is asked about each body that comes near
  Vector3 one_way = Vector3::Zero();  // own frame; not zero: what comes from other sides passes
  bool meets(const CollisionFilter& other) const {
    return (category & other.mask) != 0 && (other.category & mask) != 0;
  }
  friend bool operator==(const CollisionFilter&, const CollisionFilter&) = default;
};

/// How a body is drawn; kept and readable whether or not anything draws.
struct Appearance {
  Vector3 color{1, 1, 1};
  double alpha = 1;
  ObjectId texture, bitmap, lightmap;  // Image objects or null
  double texture_scale_x = 16, texture_scale_y = 16;
  double bitmap_heading = 0;  // rad
  std::string label;
  bool visible = true, shadows = true, as_point = false;
  bool bounding_box = false, axis = false, neighbor_lines = false;
};

/// All that decides how a body moves on.
struct BodyState {
  Vector3 location, velocity, acceleration, rotational_velocity, rotational_acceleration, force, torque;
  Quaternion orientation;
  const Shape* shape = nullptr;
  bool physics = false;
};

/// The mass of a physics-enabled body, copied from its shape when that was set or physics was switched on.
struct MassProperties {
  double mass = 1;                           // kg
  Matrix3 inertia = Matrix3::Identity();     // about the centre of mass, own frame, kg*m^2
  Vector3 center_of_mass = Vector3::Zero();  // own frame, m
  bool round = true;                         // equal moments of inertia: no gyroscopic term
  friend bool operator==(const MassProperties&, const MassProperties&) = default;
};

/// The observers of bodies that are moved by setters, each at a pace of its own.
enum class Follower : std::uint8_t { Collisions, Dynamics, Queries };
inline constexpr std::size_t kFollowers = 3;

class Bodies : public InMemory {
 public:
  explicit Bodies(std::pmr::memory_resource* memory);
  ~Bodies();
  Bodies(const Bodies&) = delete;
  Bodies& operator=(const Bodies&) = delete;

  BodyIndex add(BodyKind kind, ObjectId owner);
  void remove(BodyIndex body);
  std::size_t size() const;
  std::size_t index_end() const;  // every index is below this
  bool used(BodyIndex body) const;
  std::uint64_t revision() const;          // grows when a body is added, removed, or its physics switched
  std::uint64_t physics_revision() const;  // grows when others may push one another than did: physics was switched
  std::uint64_t shape_changes() const;     // grows when a shape that a body collides with gets a scale or a height
  std::size_t bytes() const;
  void swap(Bodies& other);
  /// From now on z = 0 and rotation about z only, exactly. Error{Argument} if a body is not so. A setter then throws
  /// Error{Argument} naming the property for a part out of the plane that is more than round-off.
  void flatten();
  bool flat() const { return flat_; }
  BodyKind kind(BodyIndex body) const;
  ObjectId owner(BodyIndex body) const;

  // Poses. A setter throws Error{Argument} naming the property if a value is not finite; nothing is changed then.
  const Vector3& location(BodyIndex body) const;
  Matrix3 rotation(BodyIndex body) const;
  Quaternion orientation(BodyIndex body) const;
  /// The poses of some bodies, seven numbers for each: location, orientation as (w, x, y, z). For thousands of them
  /// this takes half the time of asking for one after the other.
  /// @param to      the first row, at any address
  /// @param stride  bytes from one row to the next
  template <class Number>  // float or double
  void write_poses(std::span<const BodyIndex> some, char* to, std::size_t stride) const;
  void set_location(BodyIndex body, const Vector3& location);
  void set_rotation(BodyIndex body, const Matrix3& rotation);  // made orthonormal; Error{Argument} if it is singular
  void set_orientation(BodyIndex body, const Quaternion& orientation);

  // What the setters would store; the same errors, and nothing is changed.
  Vector3 allowed_location(const Vector3& location) const;
  Quaternion allowed_orientation(const Quaternion& orientation) const;
  Vector3 allowed_velocity(const Vector3& value) const;
  Vector3 allowed_spin(const Vector3& value) const;  // rotational velocity
  Vector3 allowed_force(const Vector3& newtons) const;
  Vector3 allowed_torque(const Vector3& newton_metres) const;

  // Motion, world frame; the rotational velocity of a kinematic body is in its own frame.
  const Vector3& velocity(BodyIndex body) const;
  const Vector3& acceleration(BodyIndex body) const;
  const Vector3& rotational_velocity(BodyIndex body) const;
  const Vector3& rotational_acceleration(BodyIndex body) const;
  void set_velocity(BodyIndex body, const Vector3& value);
  void set_acceleration(BodyIndex body, const Vector3& value);
  void set_rotational_velocity(BodyIndex body, const Vector3& value);
  void set_rotational_acceleration(BodyIndex body, const Vector3& value);

  // Rigid motion: on after enable_physics. Force and torque act at the centre of mass, world frame, until replaced.
  bool physics(BodyIndex body) const;
  bool dynamic(BodyIndex body) const;  // in use, physics-enabled and not Stationary
  /// Not dynamic, but bodies that are meet it: a Stationary, or one without physics that was once given a velocity, a
  /// rotational velocity or an acceleration. Contacts do not move it.
  bool driver(BodyIndex body) const;
  bool moving(BodyIndex body) const;   // by velocity or rotational velocity alone
  Vector3 spin(BodyIndex body) const;  // rotational velocity in world axes, with physics or without, rad/s
  void set_physics(BodyIndex body, bool enabled);
  /// How often physics was enabled or disabled: what was made of the body before is to be made anew.
  std::uint32_t physics_switches(BodyIndex body) const;
  const Vector3& force(BodyIndex body) const;
  const Vector3& torque(BodyIndex body) const;
  void set_force(BodyIndex body, const Vector3& newtons);
  void set_torque(BodyIndex body, const Vector3& newton_metres);

  const std::shared_ptr<Shape>& collision_shape(BodyIndex body) const;
  const std::shared_ptr<Shape>& display_shape(BodyIndex body) const;
  void set_collision_shape(BodyIndex body, std::shared_ptr<Shape> shape);  // never null
  void set_display_shape(BodyIndex body, std::shared_ptr<Shape> shape);
  /// World-aligned bounds of the collision shape at the body's pose.
  Eigen::AlignedBox3d bounds(BodyIndex body) const;
  double mass(BodyIndex body) const;                            // of its collision shape now
  const MassProperties& mass_properties(BodyIndex body) const;  // of a body that was ever physics-enabled

  double neighborhood_size(BodyIndex body) const;  // 0 until set
  void set_neighborhood_size(BodyIndex body, double radius);
  Material& material(BodyIndex body);  // made on first use
  const Material& material(BodyIndex body) const;
  const CollisionFilter& filter(BodyIndex body) const;
  /// Error{Argument} if `one_way` is not finite, or out of the plane of a flat world.
  void set_filter(BodyIndex body, const CollisionFilter& filter);
  bool filtered() const;                             // some body has, or had, a filter of its own
  const std::pmr::vector<BodyIndex>& picky() const;  // bodies that ask or let pass from some sides, sorted
  Appearance& appearance(BodyIndex body);            // made on first use
  const Appearance& appearance(BodyIndex body) const;

  // --- the stages of a sub-step of h seconds, each over its own active bodies only ----------------
  std::size_t translating() const;  // kinematic bodies with a velocity or an acceleration
  std::size_t rotating() const;     // kinematic bodies with a rotational velocity or acceleration
  std::size_t rigid() const;        // physics-enabled bodies that are not Stationary
  const std::pmr::vector<BodyIndex>& translating_bodies() const;  // the first of these, in no order that matters
  const std::pmr::vector<BodyIndex>& rotating_bodies() const;
  const std::pmr::vector<BodyIndex>& rigid_bodies() const;  // these, in no order that matters
  ObjectId first_translating() const;                       // null if there is none; so the other two
  ObjectId first_rotating() const;
  ObjectId first_rigid() const;
  void translate(double h);
  void rotate(double h);

  // --- for the stage that stops bodies at their time of impact -------------------------------------------------------
  BodyState state(BodyIndex body) const;
  /// Put it there, moving so, without a note in the log.
  void place(BodyIndex body, const Vector3& location, const Quaternion& orientation, const Vector3& velocity,
             const Vector3& rotational_velocity);
  void advance(BodyIndex body, double h, const Vector3& gravity);  // one body through the stages above
  /// Put it there as the result of a step: neither a note in the log nor among the touched.
  void set_motion(BodyIndex body, const Vector3& location, const Quaternion& orientation, const Vector3& velocity,
                  const Vector3& rotational_velocity);
  /// Appends the physics-enabled bodies that setters changed since the last call (or that were switched), in the order
  /// of the first change; from now on they count as not touched.
  void take_touched(std::pmr::vector<BodyIndex>& out);
  void touch(std::span<const BodyIndex> some);  // so that the next one gives them again
  void touch_rigid();                           // all physics-enabled bodies count as touched
  /// Appends the bodies that were added since this follower asked last, or put elsewhere or given another collision
  /// shape by a setter; each once, and maybe some that are gone. What the stages of a sub-step move is not among them.
  /// To Queries nothing is kept for before it asks for the first time: it then gets nobody.
  void take_put(Follower follower, std::pmr::vector<BodyIndex>& out);
  /// While a log is set, each setter that changes how a body moves notes the body there. Null: no log.
  void set_log(std::pmr::vector<BodyIndex>* log);

  // --- snapshot -----------------------------------------------------------------------------------------------------
  void save(ByteWriter& out) const;
  void load(ByteReader& in);  // into fresh bodies; Error{Image}
  void hash(Hasher& hasher, BodyIndex body) const;

 private:
  struct Arrays;
  Arrays& arrays();  // made with the first body: a world without bodies has none
  std::pmr::memory_resource* memory_;
  std::unique_ptr<Arrays> arrays_;
  bool flat_ = false;
};

}  // namespace breve
