// Scenes in the Open Dynamics Engine: the quick step, contacts of at most four points a pair (sixteen with meshes).
#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "tests/bench/dynamics_scenes/peers.hpp"

namespace breve::bench {
namespace {

using namespace scenes;

constexpr int kMostPoints = 4, kMostOfMesh = 16;

/// What ODE cannot do ends the process unless a handler leaves in another way.
[[noreturn]] void refuse(int, const char* format, va_list arguments) {
  std::array<char, 300> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  throw std::runtime_error(text.data());
}

/// ODE has one state a process, which is set up once.
void set_up_ode() {
  static const bool done = dInitODE2(0) != 0;
  if (!done) throw std::runtime_error("dInitODE2 failed");
  dSetErrorHandler(refuse);
  dSetDebugHandler(refuse);
}

Vector3 vector(const dReal* v) { return {v[0], v[1], v[2]}; }

/// What ODE reads from a shape as long as its geometries live.
struct Data {
  std::vector<dReal> planes, points;
  std::vector<unsigned> polygons;
  std::vector<dTriIndex> indices;
  dTriMeshDataID mesh = nullptr;
  dHeightfieldDataID field = nullptr;
};

void fill_convex(const Shape& shape, Data& data) {
  for (const Vector3& corner : shape.corners) data.points.insert(data.points.end(), corner.begin(), corner.end());
  for (const auto& face : shape.faces) {
    const Vector3 &a = shape.corners[face[0]], &b = shape.corners[face[1]], &c = shape.corners[face[2]];
    const Vector3 normal = (b - a).cross(c - a).normalized();
    data.planes.insert(data.planes.end(), {normal.x(), normal.y(), normal.z(), normal.dot(a)});
    data.polygons.push_back(static_cast<unsigned>(face.size()));
    data.polygons.insert(data.polygons.end(), face.begin(), face.end());
  }
}

Data make_data(const Shape& shape) {
  Data data;
  if (shape.form == Form::Convex) fill_convex(shape, data);
  if (shape.form == Form::Mesh) {
    for (const Vector3& corner : shape.corners) data.points.insert(data.points.end(), corner.begin(), corner.end());
    for (const auto& face : shape.faces) data.indices.insert(data.indices.end(), face.begin(), face.end());
    data.mesh = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(data.mesh, data.points.data(), 3 * sizeof(dReal),
                                static_cast<int>(shape.corners.size()), data.indices.data(),
                                static_cast<int>(data.indices.size()), 3 * sizeof(dTriIndex));
    // Convex solids on it need this.
    dGeomTriMeshDataPreprocess2(data.mesh, 1U << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES, nullptr);
  }
  if (shape.form == Form::Field) {
    data.field = dGeomHeightfieldDataCreate();
    dGeomHeightfieldDataBuildDouble(data.field, shape.heights.data(), 0, shape.tile * (shape.columns - 1),
                                    shape.tile * (shape.rows - 1), static_cast<int>(shape.columns),
                                    static_cast<int>(shape.rows), 1, 0, 1, 0);
  }
  return data;
}

class Ode : public Side {
 public:
  Ode(const Scene& scene, double step) : scene_(scene), step_(step), items_(scene.bodies.size()) {
    set_up_ode();
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, 0, -scene.gravity, 0);
    for (const Shape& shape : scene.shapes) shapes_.push_back(make_data(shape));
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      if (scene.bodies[i].born == 0) appear(static_cast<int>(i));
    for (const Joint& joint : scene.joints) add(joint);
  }
  ~Ode() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    for (Data& data : shapes_) {
      if (data.mesh) dGeomTriMeshDataDestroy(data.mesh);
      if (data.field) dGeomHeightfieldDataDestroy(data.field);
    }
  }

  void appear(int number) override {
    const auto i = static_cast<std::size_t>(number);
    if (items_[i].geometry) return;
    const Body& one = scene_.bodies[i];
    Item& item = items_[i];
    item.geometry = make_geometry(one.shape);
    item.what = &one;
    dGeomSetData(item.geometry, &item);
    if (one.motion == Motion::Free) {
      item.body = dBodyCreate(world_);
      const MassProperties of = mass_properties(scene_.shapes[one.shape]);
      dMass mass;
      dMassSetParameters(&mass, of.mass, 0, 0, 0, of.inertia.x(), of.inertia.y(), of.inertia.z(), 0, 0, 0);
      dBodySetMass(item.body, &mass);
      dGeomSetBody(item.geometry, item.body);
      dBodySetLinearVel(item.body, one.velocity.x(), one.velocity.y(), one.velocity.z());
      dBodySetAngularVel(item.body, one.spin.x(), one.spin.y(), one.spin.z());
      if (scene_.flat) dJointAttach(dJointCreatePlane2D(world_, nullptr), item.body, nullptr);
    }
    const dQuaternion orientation = {one.orientation.w(), one.orientation.x(), one.orientation.y(),
                                     one.orientation.z()};
    dGeomSetPosition(item.geometry, one.at.x(), one.at.y(), one.at.z());
    // A field that is placeable lies with y up, as ours.
    dGeomSetQuaternion(item.geometry, orientation);
  }

  Vector3 at(int body) const override { return vector(dGeomGetPosition(of(body).geometry)); }
  double angle(int joint) const override { return dJointGetHingeAngle(joints_[static_cast<std::size_t>(joint)]); }
  void set_force(int body, const Vector3& force) override {
    dBodySetForce(of(body).body, force.x(), force.y(), force.z());
  }
  void set_velocity(int body, const Vector3& velocity) override {
    dBodySetLinearVel(of(body).body, velocity.x(), velocity.y(), velocity.z());
  }
  void set_motor(int joint, double speed) override {
    dJointSetHingeParam(joints_[static_cast<std::size_t>(joint)], dParamVel, speed);
  }

  void step() override {
    for (const Spring& spring : scene_.springs) pull(spring);
    for (const Item& item : items_)
      if (item.geometry && item.what->motion == Motion::Agent) {
        const Vector3 to = vector(dGeomGetPosition(item.geometry)) + step_ * item.what->velocity;
        dGeomSetPosition(item.geometry, to.x(), to.y(), to.z());
      }
    dSpaceCollide(space_, this, [](void* side, dGeomID a, dGeomID b) { static_cast<Ode*>(side)->near(a, b); });
    dWorldQuickStep(world_, step_);
    dJointGroupEmpty(contacts_);
  }

 private:
  struct Item {
    dGeomID geometry = nullptr;
    dBodyID body = nullptr;  // NULL: it does not feel anything
    const Body* what = nullptr;
  };
  const Item& of(int body) const { return items_[static_cast<std::size_t>(body)]; }

  dGeomID make_geometry(std::size_t number) {
    const Shape& shape = scene_.shapes[number];
    Data& data = shapes_[number];
    switch (shape.form) {
      case Form::Ball: return dCreateSphere(space_, shape.radius);
      case Form::Box: return dCreateBox(space_, shape.size.x(), shape.size.y(), shape.size.z());
      case Form::Mesh: return dCreateTriMesh(space_, data.mesh, nullptr, nullptr, nullptr);
      case Form::Field: return dCreateHeightfield(space_, data.field, 1);
      case Form::Convex: break;
    }
    return dCreateConvex(space_, data.planes.data(), static_cast<unsigned>(shape.faces.size()), data.points.data(),
                         static_cast<unsigned>(shape.corners.size()), data.polygons.data());
  }

  void near(dGeomID first, dGeomID second) {
    const Item &a = *static_cast<const Item*>(dGeomGetData(first)),
               &b = *static_cast<const Item*>(dGeomGetData(second));
    const bool told = (a.what->motion == Motion::Agent) != (b.what->motion == Motion::Agent);
    if (!a.body && !b.body && !told) return;
    if (a.what->assembly >= 0 && a.what->assembly == b.what->assembly) return;
    const bool mesh = dGeomGetClass(first) == dTriMeshClass || dGeomGetClass(second) == dTriMeshClass;
    std::array<dContact, kMostOfMesh> contacts{};
    const int count = dCollide(first, second, mesh ? kMostOfMesh : kMostPoints, &contacts[0].geom, sizeof(dContact));
    if (!a.body && !b.body) return;
    for (int i = 0; i < count; ++i) {
      dContact& contact = contacts[static_cast<std::size_t>(i)];
      contact.surface.mode = dContactApprox1 | (scene_.restitution > 0 ? dContactBounce : 0);
      contact.surface.mu = scene_.friction;
      contact.surface.bounce = scene_.restitution;
      contact.surface.bounce_vel = scene_.threshold;
      dJointAttach(dJointCreateContact(world_, contacts_, &contact), a.body, b.body);
    }
  }

  void pull(const Spring& spring) {
    const dBodyID a = of(spring.a).body, b = of(spring.b).body;
    const Vector3 apart = vector(dBodyGetPosition(b)) - vector(dBodyGetPosition(a));
    const Vector3 force = spring_force(spring, apart, vector(dBodyGetLinearVel(b)) - vector(dBodyGetLinearVel(a)));
    dBodyAddForce(a, force.x(), force.y(), force.z());
    dBodyAddForce(b, -force.x(), -force.y(), -force.z());
  }

  void add(const Joint& joint) {
    const dBodyID parent = of(joint.parent).body, child = of(joint.child).body;
    if (joint.kind == Link::Hinge) {
      const dJointID made = dJointCreateHinge(world_, nullptr);
      dJointAttach(made, child, parent);
      dJointSetHingeAnchor(made, joint.at.x(), joint.at.y(), joint.at.z());
      dJointSetHingeAxis(made, joint.axis.x(), joint.axis.y(), joint.axis.z());
      if (std::isfinite(joint.low[0])) {
        dJointSetHingeParam(made, dParamLoStop, joint.low[0]);
        dJointSetHingeParam(made, dParamHiStop, joint.high[0]);
      }
      if (joint.strength > 0) dJointSetHingeParam(made, dParamFMax, joint.strength);
      joints_.push_back(made);
      return;
    }
    const dJointID made = dJointCreateBall(world_, nullptr);
    dJointAttach(made, parent, child);
    dJointSetBallAnchor(made, joint.at.x(), joint.at.y(), joint.at.z());
    const dJointID stops = dJointCreateAMotor(world_, nullptr);
    dJointAttach(stops, parent, child);
    dJointSetAMotorMode(stops, dAMotorEuler);
    dJointSetAMotorAxis(stops, 0, 1, 1, 0, 0);
    dJointSetAMotorAxis(stops, 2, 2, 0, 0, 1);
    // Angles of this motor are those of the parent against the child.
    for (int i = 0; i < 3; ++i) {
      dJointSetAMotorParam(stops, dParamLoStop1 + i * dParamGroup, -joint.high[i]);
      dJointSetAMotorParam(stops, dParamHiStop1 + i * dParamGroup, -joint.low[i]);
    }
    joints_.push_back(made);
  }

  const Scene& scene_;
  double step_;
  dWorldID world_ = nullptr;
  dSpaceID space_ = nullptr;
  dJointGroupID contacts_ = nullptr;
  std::vector<Data> shapes_;
  std::vector<Item> items_;
  std::vector<dJointID> joints_;
};

}  // namespace

std::unique_ptr<Side> make_ode(const Scene& scene, double step) { return std::make_unique<Ode>(scene, step); }

}  // namespace breve::bench
