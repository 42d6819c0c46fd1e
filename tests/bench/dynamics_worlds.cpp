// What worlds of bodies cost, through breve.h, as ratios within one run. Claims: a pile of 1,000 boxes on `fast` costs
// at most 1.1 times Bullet's rigid bodies driven directly; from 1,000 to 16,000 slow bodies at one density the cost
// grows with an exponent of at most 1.15. Prints tables; exits 1 if a claim does not hold. With an argument, only what
// it names: pile, crowds.
#include <breve/breve.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <random>
#include <vector>

namespace {

constexpr double kStep = 1.0 / 60;
constexpr double kMostAgainstBullet = 1.1, kMostExponent = 1.15;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void must(breve_status status) {
  if (status == BREVE_OK) return;
  std::printf("breve: %s\n", breve_status_name(status));
  std::exit(2);
}

struct Ours {
  breve_runtime* runtime = nullptr;
  breve_program* program = nullptr;
  breve_world* world = nullptr;
  breve_object shape{};

  explicit Ours(breve_rung rung) {
    must(breve_runtime_create(nullptr, &runtime));
    must(breve_program_create_library(runtime, nullptr, &program));
    breve_world_config config = breve_world_config_default();
    config.iteration_step = config.integration_step = kStep;
    must(breve_world_create(runtime, program, &config, &world));
    breve_accuracy accuracy = breve_accuracy_default();
    must(breve_rung_accuracy(rung, &accuracy));
    must(breve_world_set_accuracy(world, &accuracy));
  }
  ~Ours() {
    breve_world_destroy(world);
    breve_program_destroy(program);
    breve_runtime_destroy(runtime);
  }
  Ours(const Ours&) = delete;

  breve_object body(const char* class_name, double x, double y, double z) {
    breve_object made;
    must(breve_object_create(world, class_name, &made));
    must(breve_object_set_shape(world, made, shape));
    const breve_pose pose{{x, y, z}, {1, 0, 0, 0}};
    must(breve_object_set_pose(world, made, &pose));
    const breve_material material{0.5, 0.5, 0, 0, 0};
    must(breve_object_set_material(world, made, &material));
    return made;
  }
  void set_shape(const breve_geometry& geometry) { must(breve_shape_create(world, &geometry, &shape)); }
  breve_object moving(double x, double y, double z) {
    const breve_object made = body("Mobile", x, y, z);
    must(breve_object_set_physics(world, made, true));
    return made;
  }
  void step() { must(breve_world_step(world)); }
  breve_physics_counters counters() const {
    breve_physics_counters out = breve_physics_counters_default();
    must(breve_world_physics_counters(world, &out));
    return out;
  }
};

/// Where the boxes of the pile start: ten layers of ten by ten, each a little aside of the one below.
struct Start {
  double x, y, z;
};

std::vector<Start> pile() {
  std::mt19937 random(3);
  const auto jitter = [&] { return 0.1 * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
  std::vector<Start> out;
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x)
      for (int z = 0; z < 10; ++z) {
        const double aside = jitter(), along = jitter();
        out.push_back({1.2 * x - 5.4 + aside, 0.6 + 1.1 * y, 1.2 * z - 5.4 + along});
      }
  return out;
}

struct OurPile : Ours {
  OurPile() : Ours(BREVE_RUNG_FAST) {
    breve_geometry geometry = breve_geometry_default();
    geometry.kind = BREVE_SHAPE_BOX;
    geometry.size[0] = geometry.size[2] = 200;
    geometry.size[1] = 10;
    set_shape(geometry);
    body("Stationary", 0, -5, 0);
    geometry.size[0] = geometry.size[1] = geometry.size[2] = 1;
    set_shape(geometry);
    for (const Start& at : pile()) boxes.push_back(moving(at.x, at.y, at.z));
  }
  std::vector<breve_object> boxes;
  double height() const {
    double most = 0;
    for (const breve_object one : boxes) {
      breve_pose pose;
      must(breve_object_pose(world, one, &pose));
      most = std::max(most, pose.location[1]);
    }
    return most;
  }
};

/// The same in Bullet's world of rigid bodies, in double precision, sleeping off.
class BulletPile {
 public:
  BulletPile()
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
        ground_(btVector3(100, 5, 100)),
        cube_(btVector3(0.5, 0.5, 0.5)) {
    world_.setGravity(btVector3(0, -9.81, 0));
    add(ground_, 0, {0, -5, 0});
    for (const Start& at : pile()) add(cube_, 1, at);
  }
  ~BulletPile() {
    for (auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  BulletPile(const BulletPile&) = delete;
  void step() { world_.stepSimulation(kStep, 0); }
  double height() const {
    double most = 0;
    for (const auto& body : bodies_)
      most = std::max(most, static_cast<double>(body->getWorldTransform().getOrigin().y()));
    return most;
  }

 private:
  void add(btCollisionShape& shape, double mass, const Start& at) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(btVector3(at.x, at.y, at.z));
    info.m_friction = 0.5;
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_.back().get());
  }
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  btBoxShape ground_, cube_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

bool measure_pile() {
  OurPile ours;
  BulletPile bullet;
  std::printf("pile of 1,000 boxes, ms of CPU time a step at 1/60 s, `fast`\n%12s %10s %10s %8s\n", "seconds", "breve",
              "Bullet", "ratio");
  double all_ours = 0, all_bullet = 0;
  for (int second = 0; second < 6; ++second) {
    double our_time = 0, their_time = 0;
    for (int i = 0; i < 60; ++i) {
      const double start = cpu_seconds();
      ours.step();
      const double middle = cpu_seconds();
      bullet.step();
      our_time += middle - start;
      their_time += cpu_seconds() - middle;
    }
    std::printf("%9d-%d %10.2f %10.2f %8.2f\n", second, second + 1, our_time / 60 * 1e3, their_time / 60 * 1e3,
                our_time / their_time);
    all_ours += our_time;
    all_bullet += their_time;
  }
  const breve_physics_counters counted = ours.counters();
  std::printf("%12s %10.2f %10.2f %8.2f (<= %.1f)\n", "all", all_ours / 360 * 1e3, all_bullet / 360 * 1e3,
              all_ours / all_bullet, kMostAgainstBullet);
  std::printf("highest box at %.2f m (Bullet %.2f); %lu contacts, %lu of them warm\n", ours.height(), bullet.height(),
              counted.contacts, counted.warm);
  return all_ours / all_bullet <= kMostAgainstBullet;
}

/// Slow balls at one density, without gravity.
double crowd(int count, breve_physics_counters* counted) {
  Ours world(BREVE_RUNG_FAST);
  const double none[3] = {0, 0, 0};
  must(breve_world_set_gravity(world.world, none));
  breve_geometry geometry = breve_geometry_default();
  geometry.radius = 0.5;
  world.set_shape(geometry);
  std::mt19937 random(5);
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  // A grid with jitter, so that none overlap at the start: about a quarter of space is filled.
  const int side = static_cast<int>(std::ceil(std::cbrt(count)));
  for (int i = 0; i < count; ++i) {
    const double x = 1.3 * (i % side) + 0.3 * unit(), y = 1.3 * (i / side % side) + 0.3 * unit();
    const double z = 1.3 * (i / side / side) + 0.3 * unit();
    const breve_object made = world.moving(x, y, z);
    const double a = unit(), b = unit(), c = unit();
    const double velocity[3] = {a - 0.5, b - 0.5, c - 0.5};
    must(breve_object_set_velocity(world.world, made, velocity));
  }
  for (int i = 0; i < 10; ++i) world.step();
  double fastest = 1e9;
  for (int round = 0; round < 5; ++round) {
    const double start = cpu_seconds();
    for (int i = 0; i < 6; ++i) world.step();
    fastest = std::min(fastest, (cpu_seconds() - start) / 6);
  }
  *counted = world.counters();
  return fastest;
}

bool measure_crowds() {
  std::printf("slow bodies at one density, a step of 1/60 s on `fast`\n%8s %10s %10s %10s %10s %10s\n", "bodies", "ms",
              "us/body", "pairs", "contacts", "warm");
  double first = 0, last = 0, first_pairs = 0, last_pairs = 0;
  for (const int count : {1000, 2000, 4000, 8000, 16000}) {
    breve_physics_counters counted;
    const double cost = crowd(count, &counted);
    std::printf("%8d %10.2f %10.2f %10lu %10lu %10lu\n", count, cost * 1e3, cost * 1e6 / count, counted.pairs,
                counted.contacts, counted.warm);
    if (count == 1000) first = cost, first_pairs = static_cast<double>(counted.pairs);
    last = cost, last_pairs = static_cast<double>(counted.pairs);
  }
  const double exponent = std::log(last / first) / std::log(16),
               pairs = std::log(last_pairs / first_pairs) / std::log(16);
  std::printf("exponent of the time %.3f, of the pairs looked at %.3f (<= %.2f)\n", exponent, pairs, kMostExponent);
  return exponent <= kMostExponent && pairs <= kMostExponent;
}

}  // namespace

int main(int argc, char** argv) {
  const auto wanted = [&](const char* name) { return argc < 2 || std::strcmp(argv[1], name) == 0; };
  bool holds = true;
  if (wanted("pile")) holds = measure_pile() && holds;
  if (wanted("crowds")) holds = measure_crowds() && holds;
  std::printf("%s\n", holds ? "holds" : "DOES NOT HOLD");
  return holds ? 0 : 1;
}
