// Scenes in Bullet. Its joints as constraints of rigid bodies cost less than its multibody world: 18 us a step of the
// nine-link walker instead of 24 to 33 (bench_dynamics_walkers).
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/bench/dynamics_scenes/peers.hpp"

namespace breve::bench {
namespace {

using namespace scenes;

btVector3 convert(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
Vector3 convert(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
btQuaternion convert(const Quaternion& q) { return {q.x(), q.y(), q.z(), q.w()}; }

/// Bodies of one assembly pass through each other.
struct Filter : btOverlapFilterCallback {
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    if ((a->m_collisionFilterGroup & b->m_collisionFilterMask) == 0 ||
        (b->m_collisionFilterGroup & a->m_collisionFilterMask) == 0)
      return false;
    const int first = assembly(a), second = assembly(b);
    return first < 0 || first != second;
  }
  static int assembly(const btBroadphaseProxy* proxy) {
    return static_cast<const btCollisionObject*>(proxy->m_clientObject)->getUserIndex();
  }
};

struct Made {
  std::unique_ptr<btTriangleMesh> triangles;
  std::unique_ptr<btCollisionShape> shape;
};

std::unique_ptr<btTriangleMesh> triangles_of(const Shape& shape) {
  auto out = std::make_unique<btTriangleMesh>();
  for (const auto& face : shape.faces)
    out->addTriangle(convert(shape.corners[face[0]]), convert(shape.corners[face[1]]), convert(shape.corners[face[2]]));
  return out;
}

Made make_shape(const Shape& shape, bool moves) {
  Made made;
  switch (shape.form) {
    case Form::Ball: made.shape = std::make_unique<btSphereShape>(shape.radius); return made;
    case Form::Box: made.shape = std::make_unique<btBoxShape>(convert(Vector3(shape.size / 2))); return made;
    case Form::Convex: {
      auto hull = std::make_unique<btConvexHullShape>();
      for (const Vector3& corner : shape.corners) hull->addPoint(convert(corner), false);
      hull->recalcLocalAabb();
      hull->setMargin(0.005);
      made.shape = std::move(hull);
      return made;
    }
    case Form::Mesh: {
      made.triangles = triangles_of(shape);
      if (moves) {
        auto mesh = std::make_unique<btGImpactMeshShape>(made.triangles.get());
        mesh->setMargin(0.005);
        mesh->updateBound();
        made.shape = std::move(mesh);
      } else {
        made.shape = std::make_unique<btBvhTriangleMeshShape>(made.triangles.get(), true);
        made.shape->setMargin(0.005);
      }
      return made;
    }
    case Form::Field: {
      const auto [low, high] = std::minmax_element(shape.heights.begin(), shape.heights.end());
      // Bullet puts the middle of this range at the body's centre.
      const double most = std::max(std::abs(*low), std::abs(*high));
      auto field = std::make_unique<btHeightfieldTerrainShape>(
          static_cast<int>(shape.columns), static_cast<int>(shape.rows), shape.heights.data(), -most, most, 1, false);
      field->setLocalScaling(btVector3(shape.tile, 1, shape.tile));
      made.shape = std::move(field);
      return made;
    }
  }
  return made;
}

class Bullet : public Side {
 public:
  Bullet(const Scene& scene, double step) : scene_(scene), step_(step), bodies_(scene.bodies.size()) {
    world_.setGravity(btVector3(0, -scene.gravity, 0));
    world_.getSolverInfo().m_restitutionVelocityThreshold = scene.threshold;
    world_.getPairCache()->setOverlapFilterCallback(&filter_);
    if (scene.has(Form::Mesh)) btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
      shapes_.push_back(make_shape(scene.shapes[i], std::any_of(scene.bodies.begin(), scene.bodies.end(), [i](auto& b) {
                                     return b.shape == i && b.motion == Motion::Free;
                                   })));
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      if (scene.bodies[i].born == 0) appear(static_cast<int>(i));
    for (const Joint& joint : scene.joints) add(joint);
  }
  ~Bullet() override {
    for (auto& constraint : constraints_) world_.removeConstraint(constraint.get());
    for (auto& body : bodies_)
      if (body) world_.removeRigidBody(body.get());
  }

  void appear(int number) override {
    const auto i = static_cast<std::size_t>(number);
    if (bodies_[i]) return;
    const Body& one = scene_.bodies[i];
    MassProperties mass;
    if (one.motion == Motion::Free) mass = mass_properties(scene_.shapes[one.shape]);
    btRigidBody::btRigidBodyConstructionInfo info(mass.mass, nullptr, shapes_[one.shape].shape.get(),
                                                  convert(mass.inertia));
    info.m_startWorldTransform = btTransform(convert(one.orientation), convert(one.at));
    // Bullet multiplies those of a pair.
    info.m_friction = std::sqrt(scene_.friction);
    info.m_restitution = std::sqrt(scene_.restitution);
    bodies_[i] = std::make_unique<btRigidBody>(info);
    btRigidBody& body = *bodies_[i];
    body.setActivationState(DISABLE_DEACTIVATION);
    body.setUserIndex(one.assembly);
    if (one.motion == Motion::Agent) {
      body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
      world_.addRigidBody(&body, btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::StaticFilter);
      agents_.push_back(i);
    } else {
      world_.addRigidBody(&body);
    }
    body.setLinearVelocity(convert(one.velocity));
    body.setAngularVelocity(convert(one.spin));
    if (scene_.flat) {
      body.setLinearFactor(btVector3(1, 1, 0));
      body.setAngularFactor(btVector3(0, 0, 1));
    }
  }

  Vector3 at(int body) const override { return convert(of(body).getWorldTransform().getOrigin()); }
  double angle(int joint) const override { return -hinges_[static_cast<std::size_t>(joint)]->getHingeAngle(); }
  void set_force(int body, const Vector3& force) override { of(body).applyCentralForce(convert(force)); }
  void set_velocity(int body, const Vector3& velocity) override { of(body).setLinearVelocity(convert(velocity)); }
  void set_motor(int joint, double speed) override {
    const auto i = static_cast<std::size_t>(joint);
    hinges_[i]->enableAngularMotor(true, -speed, scene_.joints[i].strength * step_);
  }

  void step() override {
    for (const Spring& spring : scene_.springs) pull(spring);
    for (const std::size_t i : agents_) {
      btTransform to = bodies_[i]->getWorldTransform();
      to.setOrigin(to.getOrigin() + step_ * bodies_[i]->getLinearVelocity());
      bodies_[i]->setWorldTransform(to);
    }
    world_.stepSimulation(step_, 0);
  }

 private:
  btRigidBody& of(int body) const { return *bodies_[static_cast<std::size_t>(body)]; }

  void pull(const Spring& spring) {
    btRigidBody &a = of(spring.a), &b = of(spring.b);
    const Vector3 apart = convert(b.getWorldTransform().getOrigin() - a.getWorldTransform().getOrigin());
    const btVector3 force =
        convert(spring_force(spring, apart, convert(b.getLinearVelocity() - a.getLinearVelocity())));
    a.applyCentralForce(force);
    b.applyCentralForce(-force);
  }

  /// Angles of Bullet are those of the parent against the child.
  void add(const Joint& joint) {
    btRigidBody &parent = of(joint.parent), &child = of(joint.child);
    const auto local = [&](const btRigidBody& body) {
      return convert(joint.at) - body.getWorldTransform().getOrigin();  // none is turned at the start
    };
    if (joint.kind == Link::Hinge) {
      const btVector3 axis = convert(joint.axis);
      auto made = std::make_unique<btHingeConstraint>(parent, child, local(parent), local(child), axis, axis);
      if (std::isfinite(joint.low[0])) made->setLimit(-joint.high[0], -joint.low[0]);
      hinges_.push_back(made.get());
      constraints_.push_back(std::move(made));
    } else {
      const btQuaternion none(0, 0, 0, 1);
      auto made = std::make_unique<btGeneric6DofSpring2Constraint>(parent, child, btTransform(none, local(parent)),
                                                                   btTransform(none, local(child)), RO_XYZ);
      made->setLinearLowerLimit(btVector3(0, 0, 0));
      made->setLinearUpperLimit(btVector3(0, 0, 0));
      made->setAngularLowerLimit(-convert(joint.high));
      made->setAngularUpperLimit(-convert(joint.low));
      hinges_.push_back(nullptr);
      constraints_.push_back(std::move(made));
    }
    world_.addConstraint(constraints_.back().get(), true);
  }

  const Scene& scene_;
  double step_;
  Filter filter_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<Made> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::size_t> agents_;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
  std::vector<btHingeConstraint*> hinges_;  // NULL where it is a ball joint
};

}  // namespace

std::unique_ptr<Side> make_bullet(const Scene& scene, double step) { return std::make_unique<Bullet>(scene, step); }

}  // namespace breve::bench
