// A world built and stepped through breve.h alone, for the reference files and the hard scenes: what a host sees.
#pragma once

#include <breve/breve.h>

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace breve::reference {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Quaternion = Eigen::Quaterniond;

inline constexpr double kPi = 3.14159265358979323846;

/// What a body is made of. Mass and inertia replace what the geometry would give.
struct Solid {
  breve_geometry geometry = breve_geometry_default();
  std::vector<double> corners;  // of a convex solid, and its faces: where there are some, geometry gets them
  std::vector<std::uint32_t> sizes, indices;
  std::optional<double> mass;
  std::optional<Matrix3> inertia;  // about the centre, own axes
};
Solid sphere(double radius, double mass);
Solid box(const Vector3& size, double mass);
/// A box of the mass with this inertia: what it looks like does not matter.
Solid lump(double mass, const Matrix3& inertia, const Vector3& size = Vector3(0.1, 0.1, 0.1));
/// A uniform slender rod along y.
Solid rod(double length, double mass);
/// A hollow ball, thin as paper.
Solid shell(double radius, double mass);

/// A joint between two bodies: points in their own frames, the axis in the parent's.
struct Hinge {
  breve_object parent{}, child{};
  Vector3 parent_point = Vector3::Zero(), child_point = Vector3::Zero(), normal = Vector3::UnitZ();
  breve_joint_kind kind = BREVE_JOINT_REVOLUTE;
  Quaternion rotation = Quaternion::Identity();
};

/// What happened in some iterations, summed.
struct Toll {
  std::uint64_t iterations = 0, sub_steps = 0, most = 0, evaluations = 0, impacts = 0, interventions = 0, direct = 0;
  double per_iteration() const { return static_cast<double>(sub_steps) / static_cast<double>(iterations); }
};

/// Every call throws std::runtime_error with the library's own text where the library refuses.
class World {
 public:
  explicit World(double step, breve_rung rung = BREVE_RUNG_BALANCED, std::uint32_t dimension = 3);
  /// A program of steve, in the place of the class library alone.
  World(double step, breve_rung rung, const std::string& program);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  breve_world* get() const { return world_; }
  void must(breve_status status) const;

  // --- settings
  void set_gravity(const Vector3& gravity);
  void set_rung(breve_rung rung);
  breve_accuracy accuracy() const;
  void set_accuracy(const breve_accuracy& accuracy);
  /// A scheme of smooth motion at the integration step, and nothing else of any rung.
  void set_integrator(breve_integrator integrator);
  void set_guard(breve_guard guard);

  // --- bodies
  std::string body_class = "Mobile";  // of what body() makes
  breve_object make(const char* class_name);
  breve_object body(const Solid& solid, const Vector3& at, const Quaternion& orientation = Quaternion::Identity());
  breve_object fixed(const Solid& solid, const Vector3& at, const Quaternion& orientation = Quaternion::Identity());
  void set_material(breve_object body, double friction, double restitution, double tangential = 0);
  void set_material(breve_object body, const breve_material& material);
  void place(breve_object body, const Vector3& at, const Quaternion& orientation);
  void set_velocity(breve_object body, const Vector3& velocity);
  void set_spin(breve_object body, const Vector3& spin);  // rad/s, world axes
  void set_force(breve_object body, const Vector3& force, const Vector3& torque = Vector3::Zero());
  Vector3 at(breve_object body) const;
  Quaternion orientation(breve_object body) const;
  Vector3 velocity(breve_object body) const;
  Vector3 spin(breve_object body) const;
  bool asleep(breve_object body) const;

  // --- joints
  breve_object join(const Hinge& hinge);
  breve_joint_info read(breve_object joint) const;
  breve_drive drive(breve_object joint) const;
  void set_drive(breve_object joint, const breve_drive& drive);
  void set_joint(breve_object joint, double position, double velocity);
  /// The distance of the two points that a joint holds together.
  double open(const Hinge& hinge) const;

  // --- time
  void step();
  /// Runs whole iterations; `look` after each of them.
  void run(double seconds, const std::function<void()>& look = {});
  double time() const { return breve_world_time(world_); }
  const Toll& toll() const { return toll_; }

  std::vector<breve_impact> impacts() const;
  std::vector<breve_intervention> interventions() const;
  breve_energy energy() const;
  /// Kinetic, potential and elastic energy.
  double mechanical() const;
  breve_physics_counters counters() const;
  std::uint64_t hash() const;

 private:
  void open_world(double step, breve_rung rung, std::uint32_t dimension);
  breve_object shape(const Solid& solid);

  breve_runtime* runtime_ = nullptr;
  breve_program* program_ = nullptr;
  breve_world* world_ = nullptr;
  Toll toll_;
};

inline bool same(breve_object a, breve_object b) { return a.index == b.index && a.generation == b.generation; }
inline Vector3 vector(const double v[3]) { return Vector3(v[0], v[1], v[2]); }

}  // namespace breve::reference
