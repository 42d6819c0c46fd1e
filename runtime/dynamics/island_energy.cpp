// Energies of what an island holds.
#include "runtime/dynamics/island_energy.hpp"

#include <algorithm>

#include "runtime/articulated/carried.hpp"
#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/joints.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/common_motion.hpp"
#include "runtime/dynamics/network_motion.hpp"
#include "runtime/dynamics/spring_network.hpp"

namespace breve::island {

void take_points(State& state, const NetworkCluster& one) {
  NetworkMotion& points = *one.entry->points;
  for (std::size_t i = 0; i < points.trees().size(); ++i) {
    const FreeBody& body = state.free_bodies[one.first + i].now;
    points.point(i).center = body.center;
    points.point(i).velocity = body.velocity;
  }
}

double network_energy(State& state) {
  double sum = 0;
  for (const NetworkCluster& one : state.networks) {
    take_points(state, one);
    sum += one.entry->points->energy();
  }
  return sum;
}

double spring_energy(const State& state, const Clustered& one) {
  if (one.entry->network) return one.entry->network->spring_energy(state.core);
  double sum = 0;
  for (const SpringIndex spring : one.entry->springs) sum += state.core.spring_energy_in(state.core.springs[spring].is);
  return sum;
}

double stored_energy(State& state, const Clustered& one, double& kinetic) {
  double sum = 0;
  kinetic = 0;
  for (const std::uint32_t index : one.entry->trees) {
    const Energy energy = state.core.energy_of(*state.core.trees[index]);
    kinetic += energy.kinetic;
    sum += energy.kinetic + energy.potential + energy.springs;
  }
  return sum + spring_energy(state, one);
}

double stored_energy(State& state) {
  double sum = 0, kinetic = 0;
  for (const Free& one : state.loose_bodies())
    sum += one.now.kinetic() - one.now.solid->mass * state.core.settings.gravity.dot(one.now.center);
  sum += network_energy(state);
  for (const Clustered& one : state.clusters) sum += stored_energy(state, one, kinetic);
  return sum;
}

double inner_energy(const Clustered& one, bool held) {
  double sum = 0;
  one.each_whole([&](std::span<Tree* const> trees) { sum += common_of(trees, held).inner; });
  return sum;
}

double shorten_inner_motion(const Clustered& one, double scale, bool held) {
  double sum = 0;
  one.each_whole([&](std::span<Tree* const> trees) {
    const Common common = common_of(trees, held);
    sum += common.inner;
    shorten_inner(trees, common, scale);
  });
  return sum;
}

double motion_of_trees(State& state) {
  double sum = 0;
  for (Tree* tree : state.trees) sum += state.core.energy_of(*tree).kinetic;
  return sum;
}

double weight(const State& state) {
  double sum = 0;
  for (const Tree* tree : state.trees)
    for (const TreeLink& link : tree->links) sum += link.solid.mass * state.shape(link.body).bounding_radius();
  return sum * state.core.settings.gravity.norm();
}

double free_weight(const State& state) {
  double sum = 0;
  for (const Free& one : state.loose_bodies()) sum += one.now.solid->mass * state.shape(one.body).bounding_radius();
  return sum * state.core.settings.gravity.norm();
}

double script_weight(const State& state) {
  double sum = 0;
  for (const Clustered& one : state.clusters) {
    for (const std::uint32_t index : one.entry->trees) {
      const Tree& tree = *state.core.trees[index];
      if (!tree.pushed && !one.entry->asked) continue;
      for (const TreeLink& link : tree.links)
        sum += (link.force + link.asked).norm() * state.shape(link.body).bounding_radius();
    }
  }
  return sum;
}

double energy_of_stillness(const State& state) {
  double mass = 0;
  for (const Tree* tree : state.trees)
    for (const TreeLink& link : tree->links) mass += link.solid.mass;
  if (mass > 0)
    for (const Free& one : state.loose_bodies()) mass += one.now.solid->mass;
  const double slow = kSlow * state.unit();
  return 0.5 * slow * slow * mass;
}

namespace {

/// @param take  called with each link that scripts push, its tree and its number; links are placed
template <class Take>
void for_each_pushed(Clustered& one, const Take& take) {
  const auto pushed = [](const TreeLink& link) {
    return link.force != Vector3::Zero() || link.torque != Vector3::Zero() || link.asked != Vector3::Zero();
  };
  for (Tree* tree : one.entry->system->trees()) {
    if (std::none_of(tree->links.begin(), tree->links.end(), pushed)) continue;
    articulated::forward_kinematics(tree->model, tree->data, tree->state);
    for (std::size_t i = 0; i < tree->links.size(); ++i)
      if (pushed(tree->links[i])) take(tree->links[i], *tree, static_cast<int>(i));
  }
}

}  // namespace

void note_pushed(Clustered& one) {
  for_each_pushed(one, [](TreeLink& link, const Tree& tree, int i) {
    link.pushed_center = articulated::com_position(tree.model, tree.data, i);
    link.pushed_orientation = Quaternion(Eigen::Matrix3d(tree.data.of(i).rotation));
  });
}

double work_on_pushed(Clustered& one) {
  double sum = 0;
  for_each_pushed(one, [&sum](TreeLink& link, const Tree& tree, int i) {
    const Vector3 way = articulated::com_position(tree.model, tree.data, i) - link.pushed_center;
    sum += (link.force + link.asked).dot(way);
    if (link.torque == Vector3::Zero()) return;
    const Eigen::AngleAxisd rotation(Quaternion(Eigen::Matrix3d(tree.data.of(i).rotation)) *
                                     link.pushed_orientation.conjugate());
    sum += rotation.angle() * link.torque.dot(rotation.axis());
  });
  return sum;
}

namespace {

/// Springs of networks, whose bodies stand where the arrays have them.
double held_network_energy(const State& state) {
  double sum = 0;
  for (const NetworkCluster& one : state.networks)
    for (const SpringIndex spring : one.entry->springs) sum += state.core.spring_energy(state.core.springs[spring].is);
  return sum;
}

}  // namespace

double held_energy(const State& state) {
  double sum = 0;
  for (const Free& one : state.loose_bodies()) sum += state.core.free_energy(one.body).total();
  sum += held_network_energy(state);
  for (Tree* tree : state.trees) sum += state.core.energy_of(*tree).total();
  for (const Clustered& one : state.clusters)
    for (const SpringIndex spring : one.entry->springs) sum += state.core.spring_energy(state.core.springs[spring].is);
  return sum;
}

namespace {

/// The farthest that a joint rotates in a motion of its tree, rad.
double farthest_rotation(const articulated::Model& model, const articulated::Vector& way) {
  double farthest = 0;
  for (int i = 0; i < model.size(); ++i) {
    const articulated::Body& body = model.body(i);
    using Type = articulated::JointType;
    if (body.type != Type::Revolute && body.type != Type::Universal && body.type != Type::Ball) continue;
    farthest = std::max(farthest, way.segment(body.v, articulated::velocity_count(body.type)).norm());
  }
  return farthest;
}

}  // namespace

double share_without_gain(Tree& tree, const articulated::Vector& way) {
  constexpr double kNear = 0.05;  // rad: it gains little by that
  constexpr double kShorter = 0.25;
  constexpr int kTries = 3;
  // Loops are closed by the whole way.
  if (!tree.loops.empty() || !(farthest_rotation(tree.model, way) > kNear)) return 1;
  tree.work_q = tree.state.q;
  const double before = tree.kinetic();
  double share = 1;
  for (int i = 1; i <= kTries; ++i) {
    tree.work_w = share * way;
    articulated::move(tree.model, tree.work_q, tree.work_w, tree.state.q);
    if (tree.kinetic() <= (1 + kFew) * before) break;
    share = i < kTries ? kShorter * share : 0;
  }
  tree.state.q = tree.work_q;
  articulated::forward_kinematics(tree.model, tree.data, tree.state);
  return share;
}

void move_without_gain(State& state, Tree& tree, const articulated::Vector& way) {
  articulated::move_carried(tree.model, tree.data, tree.state, way, kFew, state.momenta);
}

}  // namespace breve::island
