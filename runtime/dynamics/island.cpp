// What an island is made of, and its smooth motion.
#include "runtime/dynamics/island.hpp"

#include <algorithm>

#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/kinematics.hpp"

namespace breve {

Island::Island(Dynamics::Core& core, std::pmr::memory_resource* memory)
    : result(memory),
      core_(core),
      memory_(memory),
      at_start_(memory),
      free_start_(memory),
      tree_start_(memory),
      pair_start_(memory),
      roles_(memory),
      free_(memory),
      clusters_(memory),
      trees_(memory),
      pairs_(memory),
      touches_(memory),
      bounds_(memory),
      movers_(memory),
      rows_(memory),
      scalars_(memory),
      laws_(memory),
      numbers_(memory),
      manifolds_(memory),
      apart_(memory),
      apart_scalars_(memory),
      ring_errors_(memory),
      start_poses_(memory),
      rebound_later_(memory),
      before_(memory),
      workspace_(memory) {}

void Island::clear() {
  free_.clear();
  clusters_.clear();
  trees_.clear();
  pairs_.clear();
  accuracy_set_ = false;
  unfinished_ = 0;
  result.counters = {};
  result.account = {};
  result.impacts.clear();
  result.interventions.clear();
}

void Island::add_free(BodyIndex body) {
  core_.slot_of[body] = static_cast<int>(free_.size());
  Free one{};
  one.body = body;
  one.now = read_free(*core_.bodies, body);
  if (const BodyEntry* known = core_.find(body)) one.next = known->step;
  free_.push_back(one);
  const Accuracy& accuracy = core_.accuracy_of(body);
  if (!accuracy_set_ || finer(accuracy.rung, accuracy_.rung)) accuracy_ = accuracy;
  accuracy_set_ = true;
}

void Island::add_cluster(ClusterEntry& cluster) {
  clusters_.push_back({&cluster, nullptr, 0});
  for (const std::uint32_t index : cluster.trees) {
    Tree* tree = core_.trees[index].get();
    tree->slot = static_cast<int>(trees_.size());
    trees_.push_back({tree, tree->state, tree->state.v, tree->state.v});
  }
  const Accuracy& accuracy = cluster.system->accuracy();
  if (!accuracy_set_ || finer(accuracy.rung, accuracy_.rung)) accuracy_ = accuracy;
  accuracy_set_ = true;
}

void Island::add_pair(NearPair& pair) { pairs_.push_back(&pair); }

bool Island::calls_out() const {
  for (const NearPair* pair : pairs_)
    if (pair->handled) return true;
  for (const Treed& one : trees_)
    for (const TreeLink& link : one.tree->links)
      if (core_.find(link.body)->force_method) return true;
  return false;
}

void Island::append_bodies(std::pmr::vector<BodyIndex>& out) const {
  for (const Free& one : free_) out.push_back(one.body);
  for (const Treed& one : trees_)
    for (const TreeLink& link : one.tree->links) out.push_back(link.body);
}

void Island::step_once(DynamicsClient* client, double start, double h) {
  begin(client, h);
  bool bounded = false;
  for (const Treed& one : trees_) {
    bounded = bounded || !one.tree->rings.empty();
    for (const TreeLink& link : one.tree->links)
      bounded = bounded || (link.joint != kNoJoint && Dynamics::Core::has_limits(core_.joints[link.joint]));
  }
  rows_.clear();
  scalars_.clear();
  if (pairs_.empty() && !bounded)
    step_quiet(start, h);
  else if (accuracy_.locate_impacts)
    step_located(client, start, h);
  else
    step_fast(start, h);
}

void Island::begin(DynamicsClient* client, double h) {
  for (Clustered& one : clusters_) {
    for (const std::uint32_t index : one.entry->trees) core_.set_loads(*core_.trees[index], accuracy_, h);
    one.stage = std::make_unique<Stage>(core_, *one.entry, client);
    one.entry->system->begin(one.stage->needed() ? one.stage.get() : nullptr);
  }
  movers_.clear();
  for (Free& one : free_) {
    contact::Mover mover;
    mover.v = one.v;
    mover.inverse_mass = 1 / one.now.solid->mass;
    movers_.push_back(mover);
  }
  for (const Treed& one : trees_) {
    contact::Mover mover;
    mover.v = one.tree->state.v.data();
    mover.size = one.tree->model.velocities();
    movers_.push_back(mover);
  }
}

void Island::place() {
  const articulated::Loads none;
  for (const Treed& one : trees_) {
    articulated::factorize(one.tree->model, one.tree->data, one.tree->state, none);
    articulated::forward_kinematics(one.tree->model, one.tree->data, one.tree->state);
  }
}

void Island::remember() {
  for (Free& one : free_) {
    one.before = one.now;
    one.next_before = one.next;
  }
  for (Treed& one : trees_) one.before = one.tree->state;
  for (Clustered& one : clusters_) one.next_before = one.entry->system->next_step();
}

void Island::restore() {
  for (Free& one : free_) {
    one.now = one.before;
    one.next = one.next_before;
  }
  for (Treed& one : trees_) one.tree->state = one.before;
  for (Clustered& one : clusters_) one.entry->system->set_next_step(one.next_before);
}

void Island::smooth(double time, double h) {
  pending_ = {};
  for (Free& one : free_) {
    const Vector3 center = one.now.center, spin = one.now.spin;
    move_free(one.now, accuracy_, core_.settings.gravity, time, h, one.next);
    pending_.script_work +=
        one.now.force.dot(one.now.center - center) + 0.5 * h * one.now.torque.dot(spin + one.now.spin);
  }
  for (Clustered& one : clusters_) {
    Cluster& system = *one.entry->system;
    system.step(time, h);
    result.counters.evaluations += static_cast<std::uint64_t>(system.count().evaluations);
    result.counters.rejected += static_cast<std::uint64_t>(system.count().rejected);
    pending_.motor_work += system.motor_work();
    pending_.script_work += system.script_work();
    pending_.drag_loss += system.drag_loss();
  }
}

void Island::commit() {
  result.account.motor_work += pending_.motor_work;
  result.account.script_work += pending_.script_work;
  result.account.drag_loss += pending_.drag_loss;
  ++result.counters.sub_steps;
  if (trees_.size() != 1) return;
  Energy& own = trees_.front().tree->account;
  own.motor_work += pending_.motor_work;
  own.script_work += pending_.script_work;
  own.drag_loss += pending_.drag_loss;
}

void Island::write() {
  for (const Free& one : free_) {
    write_free(*core_.bodies, one.body, one.now);
    if (BodyEntry* known = core_.find(one.body)) known->step = one.next;
  }
  for (const Clustered& one : clusters_)
    for (const std::uint32_t index : one.entry->trees) {
      core_.trees[index]->step = one.entry->system->next_step();
      core_.place_links(*core_.trees[index]);
    }
}

Island::Side Island::side_of(BodyIndex body) const {
  Side side;
  if (!core_.moves_now(body)) return side;
  const BodyEntry* known = core_.find(body);
  if (known && known->tree != kNone) {
    side.tree = core_.trees[known->tree].get();
    side.link = known->link;
    side.mover = static_cast<int>(free_.size()) + side.tree->slot;
    return side;
  }
  side.mover = core_.slot_of[body];
  side.center = free_[static_cast<std::size_t>(side.mover)].now.center;
  return side;
}

Pose Island::pose_of(BodyIndex body) const {
  const Side side = side_of(body);
  if (side.mover < 0) return core_.pose(body);
  if (side.tree) return side.tree->pose(side.link);
  const FreeBody& free = free_[static_cast<std::size_t>(side.mover)].now;
  return {free.center - free.orientation * free.solid->center_of_mass, free.orientation};
}

Vector3 Island::point_velocity(BodyIndex body, const Vector3& point) const {
  const Side side = side_of(body);
  if (side.mover < 0) return Vector3::Zero();
  if (side.tree) return articulated::point_velocity(side.tree->data, side.link, point);
  const FreeBody& free = free_[static_cast<std::size_t>(side.mover)].now;
  return free.velocity + free.spin.cross(point - free.center);
}

}  // namespace breve
