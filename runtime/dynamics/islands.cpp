// Which bodies may push one another in this step, and the step of each such island.
#include <algorithm>
#include <numeric>

#include "runtime/dynamics/island.hpp"

namespace breve {

Dynamics::Core::~Core() = default;

namespace {

/// One is moved by forces, the other too or something that such bodies meet.
bool meet(const Bodies& bodies, BodyIndex a, BodyIndex b) {
  const bool moves_a = bodies.dynamic(a), moves_b = bodies.dynamic(b);
  return (moves_a || moves_b) && (moves_a || bodies.driver(a)) && (moves_b || bodies.driver(b));
}

}  // namespace

bool Dynamics::pushes(BodyIndex a, BodyIndex b, const MechanicsClient& client) const {
  if (core_) return core_->pushes(a, b, client);
  // Nothing has moved yet: no joints, no trees.
  return meet(*bodies_, a, b) && !client.ignored(a, b);
}

bool Dynamics::Core::pushes(BodyIndex a, BodyIndex b, const MechanicsClient& client) {
  if (!meet(*bodies, a, b)) return false;
  if (jointed(a, b) || client.ignored(a, b)) return false;
  const BodyEntry *x = find(a), *y = find(b);
  const bool same = x && y && x->tree != kNone && x->tree == y->tree;
  if (!same) return true;
  const AssemblySettings* own = settings_of(a, [](const AssemblySettings& s) { return s.has_self; });
  return own && own->self_collisions;
}

/// Bodies that joints or springs connect are set aside together or not at all. A handler may have connected some that
/// are with some that are not: the first of them decides, so that they are stepped once.
void Dynamics::Core::keep_clusters_whole() {
  if (aside.empty()) return;
  aside.resize(bodies->index_end(), 1);
  for (const auto& cluster : clusters) {
    const std::uint8_t first = aside[first_of(*cluster)];
    for (const std::uint32_t index : cluster->trees)
      for (const TreeLink& link : trees[index]->links) aside[link.body] = first;
  }
}

BodyIndex Dynamics::Core::first_of(const ClusterEntry& cluster) const {
  return trees[cluster.trees.front()]->links.front().body;
}

void Dynamics::Core::find_islands() {
  bound.poll();  // after laws and books of each pair
  keep_clusters_whole();
  // Sets of bodies by union-find. A tree's first link stands for the tree, a cluster's first tree for the cluster.
  set_of.resize(bodies->index_end());
  slot_of.assign(bodies->index_end(), {});
  for (const BodyIndex body : near.movers()) set_of[body] = body;
  const auto root = [this](BodyIndex body) {
    while (set_of[body] != body) body = set_of[body] = set_of[set_of[body]];
    return body;
  };
  const auto join = [&](BodyIndex a, BodyIndex b) { set_of[root(a)] = root(b); };
  for (const auto& cluster : clusters)
    for (const std::uint32_t index : cluster->trees)
      for (const TreeLink& link : trees[index]->links) join(link.body, first_of(*cluster));
  near.each([&](const PairKey& key, const NearPair&) {
    if (moves_now(key.a) && moves_now(key.b)) join(key.a, key.b);
  });

  // Islands in the order of creation of their first bodies.
  island_count = 0;
  island_of.assign(bodies->index_end(), kNone);
  const auto island = [&](BodyIndex body) {
    std::uint32_t& index = island_of[root(body)];
    if (index == kNone) index = island_count++;
    return index;
  };
  for (Grouped* some : {&island_free, &island_clusters, &island_pairs}) some->clear();
  for (const BodyIndex body : near.movers()) {
    if (!moves_now(body)) continue;
    const BodyEntry* known = find(body);
    if (known && known->tree != kNone)
      island(body);
    else
      island_free.add(island(body), body);
  }
  for (std::uint32_t i = 0; i < clusters.size(); ++i) {
    const BodyIndex first = first_of(*clusters[i]);
    if (moves_now(first)) island_clusters.add(island(first), i);
  }
  const auto waits = [this](BodyIndex body) { return bodies->dynamic(body) && !moves_now(body); };
  near.each([&](const PairKey& key, const NearPair&) {
    if (!waits(key.a) && !waits(key.b)) island_pairs.add(island(bodies->dynamic(key.a) ? key.a : key.b), key.at);
  });
  for (Grouped* some : {&island_free, &island_clusters, &island_pairs}) some->sort(island_count);
}

/// The island of that number, in the place where islands are worked on.
Island& Dynamics::Core::fill(std::size_t slot, std::size_t number, double h) {
  if (islands.size() == slot) islands.push_back(make_in<Island>(memory, *this, &shared));
  Island& island = *islands[slot];
  island.clear();
  for (const std::uint32_t body : island_free.of(number)) island.add_free(body);
  for (const std::uint32_t cluster : island_clusters.of(number)) island.add_network(*clusters[cluster], h);
  for (const std::uint32_t pair : island_pairs.of(number)) island.add_drivers(near.at(pair));
  for (const std::uint32_t cluster : island_clusters.of(number)) island.add_cluster(*clusters[cluster]);
  for (const std::uint32_t pair : island_pairs.of(number)) island.add_pair(near.at(pair));
  return island;
}

/// That the sub-step may take.
std::uint64_t Dynamics::Core::work_left() const {
  if (bound.most == 0) return Meter::kNoBound;
  return work_most > counters.work ? work_most - counters.work : 0;
}

/// An island's part of that, by what it consists of: so that it does not depend on what the others do.
std::uint64_t Dynamics::Core::part_of(std::uint64_t work, const Island& island) const {
  if (work == Meter::kNoBound) return work;
  const double items = static_cast<double>(near.movers().size() + island_pairs.size());
  const double part = std::min(1.0, static_cast<double>(island.items()) / items);
  return static_cast<std::uint64_t>(part * static_cast<double>(work));
}

/// The coarsest step still looks at each pair, and solves its contacts: how many it may be. A budget that is less than
/// usual makes steps coarse and does not refuse them.
std::size_t Dynamics::Core::most_pairs() const {
  constexpr std::uint64_t kUnits = 125, kUsual = 1'000'000;
  if (bound.most == 0) return NearPairs::kNoMost;
  return static_cast<std::size_t>(std::max(bound.most, kUsual) / kUnits);
}

void Dynamics::Core::advance(MechanicsClient& client, double start, double h, double share) {
  const double left = bound.most > counters.work ? static_cast<double>(bound.most - counters.work) : 0;
  work_most = counters.work + static_cast<std::uint64_t>(share * left);
  ++sub_step;
  aside.clear();
  near.each([](const PairKey&, NearPair& pair) { pair.reported = false; });
  run(client, start, h, 0);
  report_lasting(client, start + h);
  counters.sleeping = 0;
  if (!settings.sleeping) return;
  for (const BodyIndex body : near.movers()) counters.sleeping += near.rest(body).asleep;
}

bool Dynamics::Core::locates() const {
  if (settings.accuracy.locate_impacts) return true;
  for (const auto& [body, one] : own)
    if (one.has_accuracy && one.accuracy.locate_impacts) return true;
  return false;
}

namespace {

void combine_laws(NearPairs& near, const Bodies& bodies, double unit) {
  near.each([&bodies, unit](const PairKey& key, NearPair& pair) {
    pair.law = contact::combine(bodies.material(key.a), bodies.material(key.b), unit);
    pair.law_known = true;
  });
}

}  // namespace

void Dynamics::Core::run(MechanicsClient& client, double start, double h, int depth) {
  take_changes();
  settle_books(true);
  if (clusters_changed || integrators_changed) build_clusters();
  if (settings.sleeping) near.wake_disturbed(*bodies, settings.unit);
  const auto wanted = [&](PairKey& key) {
    key.pushes = pushes(key.a, key.b, client);
    key.handled = client.handled(key.a, key.b);
  };
  near.update(*bodies, client, settings.gravity, h, rules + client.rules(), locates(), most_pairs(), bound, wanted);
  combine_laws(near, *bodies, settings.unit);
  enter_books();
  find_islands();
  counters.work += near.movers().size() + island_pairs.size() + near.others();
  const std::uint64_t work = work_left();
  // Islands that call nobody first: what a handler does must not pull the ground from under them. They are stepped in
  // lots that use the same memory one after the other: what an island works with would not fit the caches for all of a
  // crowd, and hardly for more than a few. Several workers wait for one another at the end of each lot.
  const std::size_t most = settings.workers > 1 ? 64 : 4;
  std::size_t lot = 0, callers = 0;
  Energy alone;
  for (std::size_t i = 0; i < island_count; ++i) {
    if (step_alone(i, start, h, work, alone)) continue;
    Island& island = fill(lot, i, h);
    if (sleep_through(island)) continue;
    island.bound_work(part_of(work, island), bound.ended);
    if (island.calls_out()) {
      if (calling.size() == callers) calling.push_back(make_in<Island>(memory, *this, &shared));
      std::swap(islands[lot], calling[callers++]);
      continue;
    }
    if (++lot < most) continue;
    step_undisturbed(client.workers(), lot, start, h);
    lot = 0;
  }
  step_undisturbed(client.workers(), lot, start, h);
  // At once, so that sums do not depend on how islands were put together in lots.
  ledger.script_work += alone.script_work;
  ledger.residual += alone.residual;
  constexpr int kDeepest = 64;  // handlers that make or free bodies, in one step
  for (std::size_t i = 0; i < callers; ++i) {
    std::pmr::vector<BodyIndex> mine(memory), others(memory);
    calling[i]->append_bodies(mine);
    for (std::size_t k = i + 1; k < callers; ++k) calling[k]->append_bodies(others);
    calling[i]->step(&client, start, h);
    if (!calling[i]->dissolved()) {
      calling[i]->write();
      note_rest(*calling[i], h);
    }
    take_result(*calling[i]);
    if (!calling[i]->dissolved()) continue;
    // The other islands also refer to what was.
    const double left = calling[i]->unfinished();
    if (depth < kDeepest) {
      if (left > 0) run_only(client, start + (h - left), left, depth + 1, mine);
      run_only(client, start, h, depth + 1, others);
    }
    return;
  }
}

/// The first `count` islands, which call nobody, by the workers. What all see is written when all are done, in their
/// order: so that nothing depends on which came first, an error neither.
void Dynamics::Core::step_undisturbed(Workers* workers, std::size_t count, double start, double h) {
  const auto step = [&](std::size_t i) {
    try {
      islands[i]->step(nullptr, start, h);
    } catch (...) {
      islands[i]->error = std::current_exception();
    }
  };
  if (workers && settings.workers > 1) {
    workers->run(settings.workers, count, std::ref(step));
  } else {
    for (std::size_t i = 0; i < count; ++i) step(i);
  }
  const std::span all = std::span(islands).first(count);
  std::exception_ptr first;
  for (const auto& island : all) {
    if (island->error) {
      if (!first) first = island->error;
      continue;
    }
    island->write();
    note_rest(*island, h);
    take_result(*island);
  }
  if (first) std::rethrow_exception(first);
}

void Dynamics::Core::run_only(MechanicsClient& client, double start, double h, int depth,
                              std::span<const BodyIndex> some) {
  const std::pmr::vector<std::uint8_t> before(aside, memory);
  aside.assign(bodies->index_end(), 1);
  for (const BodyIndex body : some)
    if (bodies->used(body)) aside[body] = 0;
  if (!some.empty()) run(client, start, h, depth);
  aside = before;
}

void Dynamics::Core::report_lasting(MechanicsClient& client, double moment) {
  std::pmr::vector<std::pair<BodyIndex, BodyIndex>> touching(memory);
  near.each([&touching](const PairKey& key, const NearPair& pair) {
    if (key.handled && pair.touching && !pair.reported) touching.emplace_back(key.a, key.b);
  });
  for (const auto& [a, b] : touching) {
    NearPair* pair = near.find(a, b);
    if (!pair || !bodies->used(a) || !bodies->used(b)) continue;
    pair->reported = true;
    client.impact(a, b, closest(*bodies->collision_shape(a), pose(a), *bodies->collision_shape(b), pose(b)), moment);
  }
}

// --- sleeping -------------------------------------------------------------------------------------------------------

bool Dynamics::Core::sleep_through(Island& island) {
  if (!settings.sleeping) return false;
  scratch.clear();
  island.append_bodies(scratch);
  bool all = true;
  for (const BodyIndex body : scratch) all = all && near.rest(body).asleep;
  all = all && !island.has_drivers();
  if (all) return true;
  // One that is awake wakes the others.
  for (const BodyIndex body : scratch) {
    if (!near.rest(body).asleep) continue;
    near.rest(body) = {};
  }
  return false;
}

void Dynamics::Core::note_rest(Island& island, double h) {
  if (!settings.sleeping) return;
  constexpr double kUntilSleep = 0.5;  // s
  scratch.clear();
  island.append_bodies(scratch);
  const bool still = island.still();
  bool all = still;
  for (const BodyIndex body : scratch) {
    NearPairs::Rest& rest = near.rest(body);
    rest.still = still ? rest.still + h : 0;
    all = all && rest.still >= kUntilSleep;
  }
  if (!all) return;
  for (const BodyIndex body : scratch) near.rest(body).asleep = true;
  island.fall_asleep(h);
  island.write();
}

void Dynamics::Core::take_result(Island& island) {
  const IslandResult& from = island.result();
  const DynamicsCounters& c = from.counters;
  counters.sub_steps += c.sub_steps;
  counters.evaluations += c.evaluations;
  counters.rejected += c.rejected;
  counters.islands += c.islands;
  counters.pairs += c.pairs;
  counters.manifolds += c.manifolds;
  counters.contacts += c.contacts;
  counters.warm += c.warm;
  counters.impacts += c.impacts;
  counters.searches += c.searches;
  counters.solver_iterations += c.solver_iterations;
  counters.direct += c.direct;
  counters.limits += c.limits;
  counters.interventions += from.interventions.size();
  counters.work += island.work();
  counters.residual = std::max(counters.residual, c.residual);
  ledger.motor_work += from.ledger.motor_work;
  ledger.script_work += from.ledger.script_work;
  ledger.drag_loss += from.ledger.drag_loss;
  ledger.contact_loss += from.ledger.contact_loss;
  ledger.friction_loss += from.ledger.friction_loss;
  ledger.limit_loss += from.ledger.limit_loss;
  ledger.residual += from.ledger.residual;
  impacts.insert(impacts.end(), from.impacts.begin(), from.impacts.end());
  interventions.insert(interventions.end(), from.interventions.begin(), from.interventions.end());
}

}  // namespace breve
