// The walkers of walkers.hpp.
#include "tests/bench/walkers.hpp"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace breve::bench {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return numbers[numbers.size() / 2];
}

// --- ours -----------------------------------------------------------------------------------------------------------

Walkers::Walkers(breve_rung rung, double step, int count, int first, int kinds) : World(step, rung) {
  constexpr double kApart = 6;  // m: limbs stretched out reach 2.3 m
  set_material(fixed(reference::box(Vector3(1000, 5, 1000), 1), Vector3(0, -2.5, 0)), kFriction, 0);
  for (const Section& section : sections()) {
    const breve_geometry geometry = reference::box(section.size, 1).geometry;  // of density 1
    must(breve_shape_create(get(), &geometry, &shapes_.emplace_back()));
  }
  for (int i = 0; i < count; ++i) add(Vector3(kApart * (i % 15), 1.7, kApart * (i / 15)), genes(first + i % kinds));
}

void Walkers::add(const Vector3& at, const Genes& genes) {
  One& one = walkers_.emplace_back();
  one.genes = genes;
  std::vector<breve_object> links;
  for (const Section& section : sections()) {
    links.push_back(make("Mobile"));
    must(breve_object_set_shape(get(), links.back(), shapes_[links.size() - 1]));
    must(breve_object_set_physics(get(), links.back(), true));
    place(links.back(), at, reference::Quaternion::Identity());
    set_material(links.back(), kFriction, 0);
    if (section.parent < 0) continue;
    reference::Hinge hinge;
    hinge.parent = links[static_cast<std::size_t>(section.parent)];
    hinge.child = links.back();
    hinge.parent_point = section.on_parent;
    hinge.child_point = section.on_child;
    one.joints.push_back(join(hinge));
    one.parents.push_back(hinge.parent);
    one.children.push_back(hinge.child);
    one.drives.push_back(drive(one.joints.back()));
    one.drives.back().strength_limit = kStrength;
    one.drives.back().damping = kDamping;
  }
}

/// For a hinge about z: the angle of the parent relative to the child. From poses: breve_joint_state would also work
/// out what the joint holds.
double Walkers::angle(breve_object parent, breve_object child) const {
  const reference::Quaternion between = orientation(child).conjugate() * orientation(parent);
  return 2 * std::atan(between.z() / between.w());
}

void Walkers::iterate() {
  const double now = time();
  for (One& one : walkers_)
    for (int i = 0; i < kHinges; ++i) {
      const auto k = static_cast<std::size_t>(i);
      one.drives[k].motor_speed[0] = one.genes.speed(i, now, angle(one.parents[k], one.children[k]));
      set_drive(one.joints[k], one.drives[k]);
    }
  step();
}

// --- Bullet's
// ---------------------------------------------------------------------------------------------------------

namespace {
btVector3 convert(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
}  // namespace

struct BulletWalker::Inside {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btBoxShape ground{btVector3(500, 2.5, 500)};
  btCollisionObject floor;
  std::vector<std::unique_ptr<btBoxShape>> shapes;
  std::unique_ptr<btMultiBody> body;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders;
  std::vector<std::unique_ptr<btMultiBodyJointMotor>> motors;
};

BulletWalker::BulletWalker(double step, const Genes& genes)
    : in_(std::make_unique<Inside>()), step_(step), genes_(genes) {
  in_->world.setGravity(btVector3(0, -9.81, 0));
  in_->floor.setCollisionShape(&in_->ground);
  in_->floor.setFriction(kFriction);
  btTransform under;
  under.setIdentity();
  under.setOrigin(btVector3(0, -2.5, 0));
  in_->floor.setWorldTransform(under);
  in_->world.addCollisionObject(&in_->floor, btBroadphaseProxy::StaticFilter,
                                btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
  const auto& all = sections();
  for (const Section& section : all) {
    in_->shapes.push_back(std::make_unique<btBoxShape>(0.5 * convert(section.size)));
    in_->shapes.back()->setMargin(0.001);
  }
  const auto inertia = [&](std::size_t i) {
    btVector3 moments;
    in_->shapes[i]->calculateLocalInertia(all[i].size.prod(), moments);
    return moments;
  };
  in_->body = std::make_unique<btMultiBody>(kHinges, all[0].size.prod(), inertia(0), false, false);
  for (std::size_t i = 1; i < all.size(); ++i)
    in_->body->setupRevolute(static_cast<int>(i) - 1, all[i].size.prod(), inertia(i), all[i].parent - 1,
                             btQuaternion(0, 0, 0, 1), btVector3(0, 0, 1), convert(all[i].on_parent),
                             convert(-all[i].on_child), true);
  in_->body->finalizeMultiDof();
  in_->body->setLinearDamping(0);
  in_->body->setAngularDamping(0);
  in_->body->setCanSleep(false);
  in_->body->setHasSelfCollision(false);
  in_->body->setBasePos(btVector3(0, 1.7, 0));
  for (std::size_t i = 0; i < all.size(); ++i) {
    auto collider = std::make_unique<btMultiBodyLinkCollider>(in_->body.get(), static_cast<int>(i) - 1);
    collider->setCollisionShape(in_->shapes[i].get());
    collider->setFriction(kFriction);
    if (i == 0)
      in_->body->setBaseCollider(collider.get());
    else
      in_->body->getLink(static_cast<int>(i) - 1).m_collider = collider.get();
    in_->world.addCollisionObject(collider.get(), btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::StaticFilter);
    in_->colliders.push_back(std::move(collider));
  }
  in_->world.addMultiBody(in_->body.get());
  for (int i = 0; i < kHinges; ++i) {
    in_->motors.push_back(std::make_unique<btMultiBodyJointMotor>(in_->body.get(), i, 0, kStrength * step));
    in_->world.addMultiBodyConstraint(in_->motors.back().get());
  }
  btAlignedObjectArray<btQuaternion> orientations;
  btAlignedObjectArray<btVector3> positions;
  in_->body->forwardKinematics(orientations, positions);
  in_->body->updateCollisionObjectWorldTransforms(orientations, positions);
}

BulletWalker::~BulletWalker() {
  for (const auto& motor : in_->motors) in_->world.removeMultiBodyConstraint(motor.get());
  for (const auto& collider : in_->colliders) in_->world.removeCollisionObject(collider.get());
  in_->world.removeCollisionObject(&in_->floor);
  in_->world.removeMultiBody(in_->body.get());
}

void BulletWalker::iterate() {
  for (int i = 0; i < kHinges; ++i) {
    in_->motors[static_cast<std::size_t>(i)]->setVelocityTarget(genes_.speed(i, time_, in_->body->getJointPos(i)));
    in_->body->addJointTorque(i, -kDamping * in_->body->getJointVel(i));
  }
  in_->world.stepSimulation(step_, 0);
  time_ += step_;
}

double BulletWalker::height() const { return in_->body->getBasePos().y(); }

}  // namespace breve::bench
