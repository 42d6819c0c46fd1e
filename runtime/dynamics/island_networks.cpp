// Bodies that springs tie and that move as points: to contacts, impacts and the books they are like free bodies, and
// outside of the step they are trees as all that springs tie. Springs are beside them here.
#include <algorithm>

#include "runtime/dynamics/island.hpp"
#include "runtime/dynamics/network_motion.hpp"

namespace breve {

void Island::add_network(ClusterEntry& cluster, double h) {
  const Accuracy& accuracy = cluster.system->accuracy();
  const bool coarse = accuracy.rung == Rung::Fast || accuracy.rung == Rung::Balanced;
  if (!cluster.points || !coarse || accuracy.custom || accuracy.contact_springs ||
      !cluster.points->begin(core_, accuracy.rung, h))
    return;
  networks_.push_back({&cluster, free_.size()});
  for (const Tree* tree : cluster.points->trees()) add_free(tree->links.front().body);
  if (finer(accuracy.rung, accuracy_.rung)) accuracy_ = accuracy;
}

bool Island::is_network(const ClusterEntry& cluster) const {
  return std::any_of(networks_.begin(), networks_.end(),
                     [&cluster](const NetworkCluster& one) { return one.entry == &cluster; });
}

/// The first in free_ after all that are tied.
std::size_t Island::networks_end() const {
  return networks_.empty() ? 0 : networks_.back().first + networks_.back().entry->points->trees().size();
}

/// Springs as scripts have set them. False if they are more than points can follow for h seconds.
bool Island::begin_networks(double h) {
  return std::all_of(networks_.begin(), networks_.end(),
                     [&](const NetworkCluster& one) { return one.entry->points->begin(core_, accuracy_.rung, h); });
}

void Island::take_points(const NetworkCluster& one) {
  NetworkMotion& points = *one.entry->points;
  for (std::size_t i = 0; i < points.trees().size(); ++i) {
    const FreeBody& body = free_[one.first + i].now;
    points.point(i).center = body.center;
    points.point(i).velocity = body.velocity;
  }
}

void Island::smooth_networks(double time, double h) {
  for (const NetworkCluster& one : networks_) {
    NetworkMotion& points = *one.entry->points;
    take_points(one);
    for (std::size_t i = 0; i < points.trees().size(); ++i) {
      const FreeBody& body = free_[one.first + i].now;
      points.set_pull(i, core_.settings.gravity + body.force / body.solid->mass);
    }
    result.counters.evaluations += static_cast<std::uint64_t>(points.step(h, finished_, meter_));
    network_loss_ += points.loss();
    for (std::size_t i = 0; i < points.trees().size(); ++i) {
      Free& free = free_[one.first + i];
      FreeBody& body = free.now;
      const Vector3 spin = body.spin;
      free_work_ += body.force.dot(points.point(i).center - body.center);
      body.center = points.point(i).center;
      body.velocity = points.point(i).velocity;
      rotate_free(body, accuracy_, time, h, free.next, meter_);
      free_work_ += 0.5 * h * body.torque.dot(spin + body.spin);
    }
  }
}

/// J, of the springs where the bodies are.
double Island::network_energy() {
  double sum = 0;
  for (const NetworkCluster& one : networks_) {
    take_points(one);
    sum += one.entry->points->energy();
  }
  return sum;
}

/// The same where the arrays have the bodies.
double Island::held_network_energy() const {
  double sum = 0;
  for (const NetworkCluster& one : networks_)
    for (const SpringIndex spring : one.entry->springs) sum += core_.spring_energy(core_.springs[spring].is);
  return sum;
}

/// Dampers pulled along the way that the rows' impulses added as well: half of the change of velocity, for the step.
void Island::correct_network_drag() {
  for (const NetworkCluster& one : networks_)
    for (std::size_t i = 0; i < one.entry->points->trees().size(); ++i) {
      const Free& free = free_[one.first + i];
      const Vector3& drag = one.entry->points->drag(i);
      for (int k = 0; k < 3; ++k) network_loss_ -= 0.5 * drag[k] * (free.v[k] - free.free_v[k]);
    }
}

/// To the trees that they are outside of the step; the arrays have them.
void Island::write_networks() {
  for (const NetworkCluster& one : networks_) {
    const std::span<Tree* const> trees = one.entry->points->trees();
    for (std::size_t i = 0; i < trees.size(); ++i) {
      const FreeBody& body = free_[one.first + i].now;
      articulated::State& state = trees[i]->state;
      const Quaternion& orientation = body.orientation;
      state.q.head<3>() = body.center;
      state.q.tail<4>() << orientation.w(), orientation.x(), orientation.y(), orientation.z();
      state.v.head<3>() = body.velocity;
      state.v.tail<3>() = orientation.conjugate() * body.spin;
      core_.note_written(trees[i]->links.front().body);
    }
  }
}

void Island::book_networks() {
  if (networks_.empty()) return;
  if (!booked_) network_energy();
  for (const NetworkCluster& one : networks_) {
    const std::span<Tree* const> trees = one.entry->points->trees();
    for (std::size_t i = 0; i < trees.size(); ++i) {
      const FreeBody& body = free_[one.first + i].now;
      trees[i]->booked = body.kinetic() - body.solid->mass * core_.settings.gravity.dot(body.center);
      trees[i]->changed = false;
    }
    one.entry->points->write(core_);
  }
}

}  // namespace breve
