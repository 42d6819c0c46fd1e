// What an island is made of.
#include "runtime/dynamics/island.hpp"

#include <algorithm>
#include <utility>

#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/base/error.hpp"
#include "runtime/base/rotation_vector.hpp"
#include "runtime/dynamics/sprung_motion.hpp"

namespace breve {

Island::Island(Dynamics::Core& core, std::pmr::memory_resource* memory)
    : result(memory),
      core_(core),
      memory_(memory),
      free_start_(memory),
      pair_start_(memory),
      roles_(memory),
      free_(memory),
      pair_drivers_(memory),
      networks_(memory),
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
      pushes_(memory),
      push_scalars_(memory),
      outer_(memory),
      rebounding_(memory),
      free_rates_(memory),
      plain_rates_(memory),
      rates_(memory),
      plain_impulses_(memory),
      impulses_(memory),
      plain_scalars_(memory),
      motors_(memory),
      loop_errors_(memory),
      start_poses_(memory),
      rebound_later_(memory),
      rebounds_(memory),
      found_(memory),
      light_(memory),
      depths_(memory),
      before_(memory),
      predicted_(memory),
      before_force_(memory),
      struck_(memory),
      scalars_before_(memory),
      overlaps_(memory),
      overlapped_(memory),
      workspace_(memory),
      followed_(memory) {}

Island::~Island() = default;

void Island::clear() {
  free_.clear();
  drivers_ = 0;
  pair_drivers_.clear();
  networks_.clear();
  clusters_.clear();
  trees_.clear();
  pairs_.clear();
  if (sprung_) sprung_->points.clear();
  accuracy_set_ = false;
  placed_ = false;
  dissolved_ = false;
  unfinished_ = 0;
  error = nullptr;
  result.counters = {};
  result.ledger = {};
  result.impacts.clear();
  result.interventions.clear();
}

std::size_t Island::items() const {
  std::size_t count = free_.size() + pairs_.size();
  for (const Tree* tree : trees_) count += tree->links.size();
  return count;
}

namespace {
void add_works(const Energy& from, Energy& to) {
  to.motor_work += from.motor_work;
  to.script_work += from.script_work;
  to.drag_loss += from.drag_loss;
}
}  // namespace

void Island::add_free(BodyIndex body) {
  core_.slot_of[body].mover = static_cast<int>(free_.size());
  Free one{};
  one.body = body;
  one.now = read_free(*core_.bodies, body);
  if (const BodyEntry* known = core_.find(body)) one.next = known->step;
  free_.push_back(one);
  const Accuracy& accuracy = core_.accuracy_of(body);
  if (!accuracy_set_ || finer(accuracy.rung, accuracy_.rung)) accuracy_ = accuracy;
  accuracy_set_ = true;
}

namespace {
// The inverse of the mass of a body that a script moves: an impulse does not change its velocity visibly.
constexpr double kUnmoved = 1e-100;  // 1/kg
const MassProperties kDriver{1 / kUnmoved, Matrix3::Identity() / kUnmoved, Vector3::Zero(), true};
}  // namespace

/// One for each pair: what stands on it would else be connected through it, and dear to solve.
void Island::add_drivers(const NearPair& pair) {
  pair_drivers_.push_back(-1);
  for (const BodyIndex body : {pair.a, pair.b}) {
    if (core_.bodies->dynamic(body) || !core_.bodies->moving(body)) continue;
    pair_drivers_.back() = static_cast<int>(free_.size());
    Free one{};
    one.body = body;
    one.driver = true;
    one.now.solid = &kDriver;
    free_.push_back(one);
    ++drivers_;
  }
}

/// To where it was h seconds ago: the arrays have it at the end of its way.
void Island::put_driver(Free& one, double h) {
  FreeBody& now = one.now;
  now.velocity = core_.bodies->velocity(one.body);
  now.spin = core_.bodies->spin(one.body);
  now.center = core_.bodies->location(one.body) - h * now.velocity;
  now.orientation = (rotation_by(-h * now.spin) * core_.bodies->orientation(one.body)).normalized();
}

void Island::add_cluster(ClusterEntry& cluster) {
  if (is_network(cluster)) return;
  clusters_.push_back({&cluster, std::nullopt, 0, false, false, {}, 0, {}});
  for (const std::uint32_t index : cluster.trees) {
    Tree* tree = core_.trees[index].get();
    tree->slot = static_cast<int>(trees_.size());
    trees_.push_back(tree);
    // What joints hold without a degree of freedom is like what does not move.
    const int mover = tree->model.velocities() > 0 ? static_cast<int>(free_.size()) + tree->slot : -1;
    for (std::size_t i = 0; i < tree->links.size(); ++i)
      core_.slot_of[tree->links[i].body] = {tree, mover, static_cast<int>(i)};
  }
  const Accuracy& accuracy = cluster.system->accuracy();
  if (!accuracy_set_ || finer(accuracy.rung, accuracy_.rung)) accuracy_ = accuracy;
  accuracy_set_ = true;
}

void Island::add_pair(NearPair& pair) { pairs_.push_back(&pair); }

bool Island::calls_out() const {
  for (const NearPair* pair : pairs_)
    if (pair->handled) return true;
  for (Tree* tree : trees_)
    for (const TreeLink& link : tree->links)
      if (core_.find(link.body)->force_method) return true;
  return false;
}

void Island::append_bodies(std::pmr::vector<BodyIndex>& out) const {
  for (const Free& one : loose_bodies()) out.push_back(one.body);
  for (Tree* tree : trees_)
    for (const TreeLink& link : tree->links) out.push_back(link.body);
}

void Island::step(MechanicsClient* client, double start, double h) {
  ++result.counters.islands;
  finished_ = false;
  const Accuracy asked = accuracy_;
  const std::uint64_t structure = core_.structure();
  for (std::size_t i = free_.size() - drivers_; i < free_.size(); ++i) put_driver(free_[i], h);
  keep_start();
  try {
    step_guarded(client, start, h);
  } catch (...) {
    // A failed step leaves a state from which nothing can continue.
    if (core_.structure() == structure) {
      use_accuracy(asked);
      back_to_start();
      place_links();
      if (calls_out()) write();  // a handler has seen more of the step
    }
    throw;
  }
}

void Island::step_once(MechanicsClient* client, double start, double h) {
  begin(client, h);
  bool bounded = false;
  for (Tree* tree : trees_) {
    bounded = bounded || !tree->loops.empty();
    for (const TreeLink& link : tree->links)
      bounded =
          bounded || link.motor || (link.joint != kNoJoint && Dynamics::Core::has_limits(core_.joints[link.joint]));
  }
  touches_.clear();
  bounds_.clear();
  rows_.clear();
  scalars_.clear();
  motors_.clear();
  loop_errors_.clear();
  spent_ = false;
  const bool undisturbed = pairs_.empty() && !bounded;
  try {
    if (undisturbed) {
      placed_ = false;
      step_undisturbed(start, h);
    } else if (accuracy_.locate_impacts) {
      step_located(client, start, h);
    } else {
      step_fast(start, h);
    }
  } catch (const Error& error) {
    // Step control gave up since the work is used up.
    if (error.code() != ErrorCode::Numeric || !meter_.over() || finished_) throw;
    if (undisturbed) {
      back_to_start();
      gone_ = 0;
    } else {
      restore();
    }
    finish(start + gone_, h - gone_);
  }
}

void Island::begin(MechanicsClient* client, double h) {
  locates_ = client && client->locates();
  for (Clustered& one : clusters_) {
    for (const std::uint32_t index : one.entry->trees) {
      Tree& tree = *core_.trees[index];
      core_.set_loads(tree, accuracy_, h);
      for (TreeLink& link : tree.links) link.contact = {};
      tree.limit_force.setZero();
      tree.held.clear();
    }
    one.loose = loose(one);
    one.stage.emplace(core_, *one.entry, client);
    const bool pressed = has_contact_springs() && !pairs_.empty();
    one.entry->system->begin(one.stage->needed() || pressed ? &*one.stage : nullptr, meter_);
  }
  movers_.clear();
  for (Free& one : free_) {
    contact::Mover mover;
    mover.v = one.v;
    mover.inverse_mass = 1 / one.now.solid->mass;
    movers_.push_back(mover);
  }
  for (Tree* tree : trees_) {
    contact::Mover mover;
    mover.v = tree->state.v.data();
    mover.size = tree->model.velocities();
    movers_.push_back(mover);
  }
}

/// Where a tree has moved by semi-implicit Euler, springs and dampers give way to the rows of its h seconds as they did
/// to the forces in them: by how much they will be stretched, and how fast.
void Island::place(double h) {
  const articulated::Loads none;
  const bool placed = std::exchange(placed_, false);
  for (const Clustered& one : clusters_) {
    const bool implicit = h > 0 && one.semi && accuracy_.implicit_joints;
    for (Tree* tree : one.entry->system->trees()) {
      if (implicit)
        articulated::factorize(tree->model, tree->data, tree->state, tree->springs, h);
      else
        articulated::factorize(tree->model, tree->data, tree->state, none);
      if (!placed) articulated::forward_kinematics(tree->model, tree->data, tree->state);
    }
  }
}

void Island::remember() {
  for (Free& one : free_) {
    one.before = one.now;
    one.next_before = one.next;
  }
  for (Tree* tree : trees_) tree->sub_state = tree->state;
  for (Clustered& one : clusters_) one.next_before = one.entry->system->next_step();
}

void Island::restore() {
  for (Free& one : free_) {
    one.now = one.before;
    one.next = one.next_before;
  }
  for (Tree* tree : trees_) tree->state = tree->sub_state;
  for (Clustered& one : clusters_) one.entry->system->set_next_step(one.next_before);
}

void Island::commit() {
  ++result.counters.sub_steps;
  result.ledger.script_work += free_work_;
  result.ledger.drag_loss += network_loss_;
  if (springs_move()) commit_springs();
  for (const Clustered& one : clusters_) {
    add_works(one.pending, result.ledger);
    // What springs between trees do is nobody's own.
    if (one.alone()) add_works(one.pending, core_.trees[one.entry->trees.front()]->ledger);
  }
}

void Island::write() {
  for (const Free& one : loose_bodies()) {
    write_free(*core_.bodies, one.body, one.now);
    if (BodyEntry* known = core_.find(one.body)) known->step = one.next;
  }
  write_networks();
  for (const Clustered& one : clusters_)
    for (const std::uint32_t index : one.entry->trees) {
      core_.trees[index]->step = one.entry->system->next_step();
      if (placed_)
        core_.write_back(*core_.trees[index]);
      else
        core_.place_links(*core_.trees[index]);
    }
  book();
}

Pose Island::pose_of(BodyIndex body) const {
  const BodySlot side = slot_of(body);
  if (side.mover < 0) return core_.pose(body);
  if (side.tree) return side.tree->pose(side.link);
  const FreeBody& free = free_[static_cast<std::size_t>(side.mover)].now;
  return {free.center - free.orientation * free.solid->center_of_mass, free.orientation};
}

/// In world axes, rad/s.
Vector3 Island::spin_of(BodyIndex body) const {
  const BodySlot side = slot_of(body);
  if (side.mover < 0) return Vector3::Zero();
  return side.tree ? side.tree->data.of(side.link).spin : free_[static_cast<std::size_t>(side.mover)].now.spin;
}

Vector3 Island::point_velocity(BodyIndex body, const Vector3& point) const {
  const BodySlot side = slot_of(body);
  if (side.mover < 0) return Vector3::Zero();
  if (side.tree) return articulated::point_velocity(side.tree->data, side.link, point);
  const FreeBody& free = free_[static_cast<std::size_t>(side.mover)].now;
  return free.velocity + free.spin.cross(point - free.center);
}

}  // namespace breve
