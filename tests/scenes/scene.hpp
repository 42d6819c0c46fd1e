// Scenes of bodies as plain data, which breve.h, another engine or a test builds: each scene lives once. A scene that
// acts on its bodies (attraction, a gait) does so through Side, so that all engines are driven alike.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace breve::scenes {

using Vector3 = Eigen::Vector3d;
using Quaternion = Eigen::Quaterniond;

inline constexpr double kGravity = 9.81;  // m/s^2, along -y
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum class Form { Ball, Box, Convex, Mesh, Field };

/// The centre of mass is the origin, and the principal axes are x, y, z.
struct Shape {
  Form form = Form::Ball;
  double radius = 1;                              // m, of a ball
  Vector3 size = Vector3::Ones();                 // m, edges of a box
  std::vector<Vector3> corners;                   // m, of a convex solid and a mesh
  std::vector<std::vector<std::uint32_t>> faces;  // corners counter-clockwise from outside; triangles of a mesh
  std::vector<double> heights;                    // m, of a field: `columns` values along x for each of `rows` along z
  std::uint32_t columns = 0, rows = 0;
  double tile = 1;     // m, edge of a cell of a field
  double density = 1;  // kg/m^3
};
Shape ball(double radius, double density = 1);
Shape box(const Vector3& size, double density = 1);
/// A prism about z.
Shape prism(std::uint32_t sides, double radius, double height, double density = 1);
/// A pyramid about z over a regular base.
Shape cone(std::uint32_t sides, double radius, double height, double density = 1);
/// A ring about y; 2 * around * across triangles.
Shape torus(double radius, double thickness, std::uint32_t around, std::uint32_t across, double density = 1);
/// A ball with eight bumps and eight hollows around y; 2 * around * (across - 1) triangles.
Shape bumpy(double radius, std::uint32_t around, std::uint32_t across, double density = 1);
/// A half of a hollow ball, open above, as a closed mesh.
Shape bowl(double inner, double outer, std::uint32_t around, std::uint32_t across);

struct MassProperties {
  double mass = 0;                    // kg
  Vector3 inertia = Vector3::Zero();  // kg*m^2, about x, y, z
};
MassProperties mass_properties(const Shape& shape);  // not of a field

enum class Motion {
  Fixed,
  Free,
  Agent
};  // an agent moves at its velocity and feels nothing, but has a collision handler

struct Body {
  std::size_t shape = 0;
  Vector3 at = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
  Motion motion = Motion::Free;
  int assembly = -1;  // bodies of one assembly pass through each other; -1: none
  Vector3 velocity = Vector3::Zero(), spin = Vector3::Zero();
  int born = 0;  // the step before which it appears
};

enum class Link { Hinge, Ball };

/// It connects two bodies as they are at the start, where its position is zero. Positive: the child rotates about the
/// axis.
struct Joint {
  Link kind = Link::Hinge;
  int parent = 0, child = 0;
  Vector3 at = Vector3::Zero();     // world frame
  Vector3 axis = Vector3::UnitZ();  // of a hinge. A ball's Euler angles are about x (parent's), y and z (child's)
  Vector3 low = Vector3::Constant(-kInfinity), high = Vector3::Constant(kInfinity);  // rad; [0] of a hinge
  double strength = 0;  // N*m, of the motor of a hinge; 0: none
};

/// Between the centres of two bodies.
struct Spring {
  int a = 0, b = 0;
  double length = 1, stiffness = 100, damping = 0.1;  // m, N/m, N*s/m
};

/// A world of some engine that is made of a scene.
class Side {
 public:
  Side() = default;
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;
  virtual ~Side() = default;
  virtual void appear(int body) = 0;
  virtual Vector3 at(int body) const = 0;
  virtual double angle(int joint) const = 0;                   // rad, of a hinge, between -pi and pi
  virtual void set_force(int body, const Vector3& force) = 0;  // N, for the next step
  virtual void set_velocity(int body, const Vector3& velocity) = 0;
  virtual void set_motor(int joint, double speed) = 0;  // rad/s
  virtual void step() = 0;
};

struct Scene {
  std::string name;
  bool flat = false;  // in the plane z = 0
  double gravity = kGravity;
  double friction = 0.5, restitution = 0, threshold = 0.1;  // of each pair; m/s below which nothing bounces
  std::vector<Shape> shapes;
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Spring> springs;
  std::function<void(Side&, double time)> act;  // before each step; NULL: nothing

  int add(const Body& body);  // its number
  std::size_t add(Shape shape);
  bool has(Form form) const;
};

/// Lets bodies appear whose time has come, and acts. Every side of a scene is called so before its n-th step.
void prepare(const Scene& scene, Side& side, int step, double time);

/// The names of all scenes, in the order of the tables.
const std::vector<std::string>& names();
/// @throws std::out_of_range if there is no such scene
Scene make(std::string_view name);

}  // namespace breve::scenes
