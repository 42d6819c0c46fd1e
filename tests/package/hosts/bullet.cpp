// A host with Bullet in single precision, the common build, in one process with breve: a ball falls in its world while
// breve steps a 3D program. Prints breve's hash. Without an argument Bullet does nothing.
#include <btBulletDynamicsCommon.h>

#include <breve/breve.hpp>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>

namespace {

static_assert(sizeof(btScalar) == sizeof(float), "the host is to use Bullet with floats");

/// Many boxes fall on a floor, so that pairs of Bullet also meet.
class Pile {
 public:
  Pile() : dispatcher_(&configuration_), world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
    add(btVector3(0, -1, 0), 0, floor_);
    for (int i = 0; i < 20; ++i)
      add(btVector3(0.1F * static_cast<float>(i % 3), 1.1F * static_cast<float>(i), 0), 1, box_);
  }
  ~Pile() {
    for (auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  void step() { world_.stepSimulation(1.0F / 60); }
  float height() const { return bodies_.back()->getWorldTransform().getOrigin().y(); }

 private:
  void add(const btVector3& at, btScalar mass, btCollisionShape& shape) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia));
    bodies_.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    world_.addRigidBody(bodies_.back().get());
  }
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  btBoxShape floor_{btVector3(50, 1, 50)}, box_{btVector3(0.5F, 0.5F, 0.5F)};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) return 2;
  std::ifstream file(arguments[1]);
  std::stringstream text;
  text << file.rdbuf();
  auto runtime = breve::Runtime::create().or_throw();
  auto program = runtime.compile(arguments[1], text.str()).or_throw();
  breve_world_config config = breve_world_config_default();
  config.seed = 7;
  auto world = runtime.world(program, config).or_throw();
  std::unique_ptr<Pile> pile;
  if (count > 2) pile = std::make_unique<Pile>();
  for (int i = 0; i < 300; ++i) {
    if (pile) pile->step();
    if (!world.step()) return 1;
  }
  if (pile && !(pile->height() < 25 && pile->height() > 0)) return 1;
  std::printf("%016llx\n", static_cast<unsigned long long>(world.hash().or_throw()));
}
