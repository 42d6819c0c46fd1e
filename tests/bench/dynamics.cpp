// What the dynamics of articulated bodies costs, as ratios within one run. Claims: forward dynamics of a chain of
// revolute links costs at most 0.5 times one step of Bullet's multibody world (float64, no contact) per link, for 9,
// 20, 50 and 100 links; it is linear from 20 to 640 links (32 times, within 20 %); a Runge-Kutta 4 step costs at most 5
// times one forward dynamics. Prints a table; exits 1 if a claim does not hold.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/integrator.hpp"
#include "runtime/articulated/tree_system.hpp"

namespace {

using namespace breve;
using namespace breve::articulated;

constexpr double kMostAgainstBullet = 0.5;
constexpr double kGrowth = 32, kGrowthTolerance = 0.2;
constexpr double kMostRungeKutta = 5;
constexpr int kRounds = 9;  // the fastest counts: the others were disturbed
constexpr double kStep = 1e-3;

constexpr double kMass = 0.5, kLength = 0.3;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Links hanging on each other, their axes along y and z by turns, so that the chain moves in space.
std::vector<Link> chain_links(int n) {
  std::vector<Link> links(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    Link& link = links[static_cast<std::size_t>(i)];
    link.parent = i - 1;
    link.position = Vector3(i == 0 ? 0 : kLength, 0, 0);
    link.axis = i % 2 == 0 ? Vector3::UnitY() : Vector3::UnitZ();
    link.mass = kMass;
    link.com = Vector3(0.5 * kLength, 0, 0);
    link.inertia = Vector3(0.001, 0.004, 0.005).asDiagonal();
  }
  return links;
}

State chain_state(int n) {
  State state{Vector(n), Vector(n)};
  for (int i = 0; i < n; ++i) {
    state.q[i] = 0.1 * std::sin(i + 1.0);
    state.v[i] = 0.2 * std::cos(2.0 * i);
  }
  return state;
}

/// The same chain in a multibody world of Bullet, nothing else in it.
class BulletChain {
 public:
  explicit BulletChain(int n)
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
        body_(std::make_unique<btMultiBody>(n, 0.0, btVector3(1, 1, 1), true, false)) {
    world_.setGravity(btVector3(0, 0, -9.81));
    const State state = chain_state(n);
    for (int i = 0; i < n; ++i) {
      const btVector3 axis = i % 2 == 0 ? btVector3(0, 1, 0) : btVector3(0, 0, 1);
      body_->setupRevolute(i, kMass, btVector3(0.001, 0.004, 0.005), i - 1, btQuaternion(0, 0, 0, 1), axis,
                           btVector3(i == 0 ? 0 : 0.5 * kLength, 0, 0), btVector3(0.5 * kLength, 0, 0), true);
    }
    body_->finalizeMultiDof();
    body_->setLinearDamping(0);
    body_->setAngularDamping(0);
    body_->setCanSleep(false);
    body_->setHasSelfCollision(false);
    for (int i = 0; i < n; ++i) {
      body_->setJointPos(i, state.q[i]);
      body_->setJointVel(i, state.v[i]);
    }
    world_.addMultiBody(body_.get());
  }
  ~BulletChain() { world_.removeMultiBody(body_.get()); }
  BulletChain(const BulletChain&) = delete;

  void step() { world_.stepSimulation(kStep, 0); }
  double joint_velocity(int i) const { return body_->getJointVel(i); }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_;
  std::unique_ptr<btMultiBody> body_;
};

class OurChain {
 public:
  explicit OurChain(int n)
      : model_(chain_links(n)), system_(model_), integrator_(system_, Scheme::RungeKutta4), data_(model_) {
    system_.loads.gravity = Vector3(0, 0, -9.81);
    const State start = chain_state(n);
    state_ = {0, start.q, start.v, 0};
    tree_ = start;
  }
  void accelerate() {
    // As in a simulation, the state differs from call to call.
    tree_.q[0] += 1e-9 * forward_dynamics(model_, data_, tree_, system_.loads)[0];
  }
  void runge_kutta() { integrator_.step(state_, kStep); }
  double acceleration(int i) { return forward_dynamics(model_, data_, tree_, system_.loads)[i]; }

 private:
  Model model_;
  TreeSystem system_;
  Integrator integrator_;
  Data data_;
  Instant state_;
  State tree_;
};

template <class F>
double seconds(int repeats, F f) {
  const double start = cpu_seconds();
  for (int i = 0; i < repeats; ++i) f();
  return (cpu_seconds() - start) / repeats;
}

struct Cost {
  double bullet = 1e9, dynamics = 1e9, runge_kutta = 1e9;  // s per call
};

/// Rounds of all three by turns, so that a disturbance hits them alike.
Cost measure(int n) {
  BulletChain bullet(n);
  OurChain ours(n);
  const int repeats = std::max(4, 20000 / n);
  Cost cost;
  for (int round = 0; round < kRounds; ++round) {
    cost.bullet = std::min(cost.bullet, seconds(repeats / 4, [&] { bullet.step(); }));
    cost.dynamics = std::min(cost.dynamics, seconds(repeats, [&] { ours.accelerate(); }));
    cost.runge_kutta = std::min(cost.runge_kutta, seconds(repeats / 4, [&] { ours.runge_kutta(); }));
  }
  return cost;
}

/// Both must compute the same thing, or the ratio means nothing.
bool same_physics() {
  BulletChain bullet(9);
  OurChain ours(9);
  const State state = chain_state(9);
  bullet.step();
  double worst = 0;
  for (int i = 0; i < 9; ++i) {
    const double theirs = (bullet.joint_velocity(i) - state.v[i]) / kStep, own = ours.acceleration(i);
    worst = std::max(worst, std::abs(theirs - own) / (1 + std::abs(own)));
  }
  std::printf("accelerations of the chain of 9 differ from Bullet's by %.1e\n", worst);
  return worst < 1e-3;
}

}  // namespace

int main() {
  bool holds = same_physics();
  std::printf("%6s %14s %14s %10s %14s %10s\n", "links", "Bullet step", "dynamics", "ratio", "RK4 step", "RK4/dyn");
  std::printf("%6s %14s %14s %10s %14s %10s\n", "", "ns/link", "ns/link", "<= 0.5", "ns/link", "<= 5");
  double at_20 = 0, at_640 = 0;
  for (const int n : {9, 20, 50, 100, 640}) {
    const Cost cost = measure(n);
    const double ratio = cost.dynamics / cost.bullet, steps = cost.runge_kutta / cost.dynamics;
    const double per_link = 1e9 / n;
    std::printf("%6d %14.1f %14.1f %10.3f %14.1f %10.2f\n", n, cost.bullet * per_link, cost.dynamics * per_link, ratio,
                cost.runge_kutta * per_link, steps);
    if (n <= 100) holds = holds && ratio <= kMostAgainstBullet;
    holds = holds && steps <= kMostRungeKutta;
    if (n == 20) at_20 = cost.dynamics;
    if (n == 640) at_640 = cost.dynamics;
  }
  const double growth = at_640 / at_20;
  std::printf("640 links cost %.1f times 20 links (32 +- 20 %%)\n", growth);
  holds = holds && std::abs(growth / kGrowth - 1) <= kGrowthTolerance;
  std::printf("%s\n", holds ? "holds" : "DOES NOT HOLD");
  return holds ? 0 : 1;
}
