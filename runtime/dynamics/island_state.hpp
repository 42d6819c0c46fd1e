// The state of an island: which bodies and trees it consists of, which pairs of them are near, and where they stand.
// Everything else that an island is made of works on this; it knows none of that.
#pragma once

#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "runtime/articulated/impulse.hpp"
#include "runtime/base/meter.hpp"
#include "runtime/contact/solver.hpp"
#include "runtime/dynamics/island_result.hpp"
#include "runtime/dynamics/motion.hpp"
#include "runtime/dynamics/near_pairs.hpp"
#include "runtime/dynamics/stage.hpp"

namespace breve::island {

/// Parts of the smaller body's radius. Within the first, slow bodies rest on one another; within the second they touch;
/// within the third they have met: what approaches collides there, not before.
inline constexpr double kSkin = 1e-3, kTouchSkin = 1e-4, kMetSkin = 1e-9;
inline constexpr double kLimitSkin = 1e-6;  // rad or length units: a joint that is nearer to its limit rests there
inline constexpr double kTiny = 1e-9;       // of stored energy: round-off of sums
inline constexpr double kStill = 1e-6;      // of weight(): what a step of bodies that hardly move may leave unexplained
inline constexpr double kFew = 0.01;        // of the energy in motion: what may be taken from it without trying again
inline constexpr double kSlow = 0.02;       // rad/s and length units/s: slower is still
// Sub-steps of a step whose energy does not balance, times the bodies that it moves: a crowd's step stays bounded.
inline constexpr std::size_t kMostInParts = 40;

/// A body without joints, or one that a script moves.
struct Free {
  BodyIndex body;
  FreeBody now, before;
  double next = 0, next_before = 0;
  double v[6], free_v[6];  // velocity and spin: as the solver has them, and without its impulses
  double plain_v[6];       // as the solver had them without rebounds
  bool struck = false;     // by a contact whose force did not act before
  double push[6];          // likewise, those along which positions were last put right
  bool driver = false;     // a script moves it, whatever pushes it; each pair and island has its own of it

  /// v from `now`.
  void load_velocity();
};

/// Energy as a sub-step began, for what its rows did to it.
struct SubStepEnergy {
  double stored = 0;          // J
  double kinetic = 0;         // J, of all trees
  double smooth_kinetic = 0;  // J, likewise, after smooth motion
  double solved_kinetic = 0;  // J, likewise, after the rows' solution if motors are the only rows
  double predicted = 0;       // J, that predicted forces give from rest
  Energy ledger;              // works and losses
  double unexplained = 0;     // J, that smooth motion gained
};

/// Trees that one integrator moves.
struct Clustered {
  ClusterEntry* entry;
  Accuracy own;  // of its integrator, where the island's step sets no other
  // Some spring in its joints is faster than the shortest sub-steps: semi-implicit Euler moves it, and its springs and
  // dampers are implicit.
  bool fast_springs = false;
  std::optional<Stage> stage;
  double next_before = 0;
  bool semi = false;        // its last smooth motion was semi-implicit Euler's
  bool loose = false;       // nothing but contacts and gravity acts on it from outside
  Energy pending;           // of the last smooth motion
  double held_work = 0;     // J, likewise, of forces that were predicted
  SubStepEnergy sub_start;  // of the sub-step

  bool alone() const { return entry->trees.size() == 1 && entry->springs.empty(); }
  /// Calls f for trees whose motion in common only what is outside changes: all of them, or where force methods push
  /// them, those that springs connect.
  template <class F>
  void each_whole(const F& f) const {
    const std::span trees = entry->system->trees();
    if (!entry->asked) return f(trees);
    std::size_t first = 0;
    for (const std::size_t end : entry->wholes) {
      f(trees.subspan(first, end - first));
      first = end;
    }
  }
  /// What the last smooth motion did: nothing so far.
  void forget_parts();
  /// The island's accuracy, as it is for this cluster.
  Accuracy accuracy_in(const Accuracy& island) const;
};

/// Bodies that springs connect and that move as points: they are in free_bodies, from that position on.
struct NetworkCluster {
  ClusterEntry* entry;
  std::size_t first;
};

/// Something that went wrong, the body that shows it, and by how much: J, m or a ratio.
struct Trouble {
  bool found = false;
  GuardReason reason = GuardReason::NotFinite;
  double value = 0;
  BodyIndex body = kNoBody;
};

struct State {
  State(Dynamics::Core& world, std::pmr::memory_resource* resource);

  // --- what belongs to the island, set before a step in this order
  void clear();
  void add_free(BodyIndex body);
  /// If the cluster's bodies move as points for h seconds, they are like free bodies.
  void add_network(ClusterEntry& cluster, double h);
  void add_drivers(const NearPair& pair);   // of each pair in turn
  void add_cluster(ClusterEntry& cluster);  // does nothing if the cluster is one of networks
  void put_drivers(double h);
  /// Loads and integrators for steps of h seconds.
  void begin(MechanicsClient* client, double h);
  bool begin_networks(double h);
  void read_springs();
  void read_drives(double h);
  void use_accuracy(const Accuracy& other);
  /// The island's as it was asked for, and that of each cluster again.
  void end_use(const Accuracy& asked);

  // --- where bodies are
  BodySlot slot_of(BodyIndex body) const {
    BodySlot slot = core.slot_of[body];
    const std::size_t first = free_bodies.size() - drivers;
    for (std::size_t i = first; slot.mover < 0 && i < free_bodies.size(); ++i)
      if (free_bodies[i].body == body) slot.mover = static_cast<int>(i);
    return slot;
  }
  bool is_driver(int mover) const {
    const auto count = static_cast<int>(free_bodies.size());
    return mover >= count - static_cast<int>(drivers) && mover < count;
  }
  /// The bodies that are free.
  std::span<Free> loose_bodies() { return {free_bodies.data(), free_bodies.size() - drivers}; }
  std::span<const Free> loose_bodies() const { return {free_bodies.data(), free_bodies.size() - drivers}; }
  double mass() const;         // kg, of all that impulses move
  std::size_t bodies() const;  // links, and bodies without joints
  /// The tree of a mover; null if the mover is a free body or nothing.
  Tree* tree_of(int mover) const {
    const int first = static_cast<int>(free_bodies.size());
    return mover < first ? nullptr : trees[static_cast<std::size_t>(mover - first)];
  }
  int mover_of(const Tree& tree) const { return static_cast<int>(free_bodies.size()) + tree.slot; }
  const Shape& shape(BodyIndex body) const { return *core.bodies->collision_shape(body); }
  Pose pose_of(BodyIndex body) const;
  /// The vector from the centre of mass of a free body to a point, m.
  Vector3 arm_of(const BodySlot& slot, const Vector3& point) const {
    return point - free_bodies[static_cast<std::size_t>(slot.mover)].now.center;
  }
  Vector3 spin_of(BodyIndex body) const;
  Vector3 point_velocity(BodyIndex body, const Vector3& point) const;
  /// The world's length unit, m: what thresholds of lengths and speeds are multiples of.
  double unit() const { return core.settings.unit; }
  /// For the solver of rows: the accuracy's sweeps, a tolerance of speed in the world's unit, and the meter.
  contact::SolveSettings solve_settings();
  double size_of_pair(const NearPair& pair) const;
  double natural_response(BodyIndex body) const;
  // Positions in free_bodies: the bodies of networks stand together.
  std::size_t networks_begin() const;
  std::size_t networks_end() const;

  // --- how it is moved
  void place(double h = 0);
  void place_links();
  void remember();
  void restore();
  void load_velocities();   // movers' v from the state
  void store_velocities();  // and back
  void reset_velocities();  // movers' v without the rows' impulses
  void add_force(BodyIndex body, const Vector3& point, const Vector3& force);

  // --- what it is like
  bool calls_out() const;
  bool still() const;
  bool has_loops() const;
  std::uint64_t loop_units() const;
  bool stiff(const Clustered& one) const;
  bool has_contact_springs() const;
  bool springs_for(const contact::Law& law) const;
  BodyIndex any_body() const;
  /// No further sub-step is to begin: the work is used up, or would be by closing the loops once.
  bool unaffordable() const { return meter.over(loop_units()); }
  /// Nothing is to be tried again.
  bool worn() const {
    constexpr std::uint64_t kMostEvaluations = 100'000;
    return finished || meter.over() || result.counters.evaluations > kMostEvaluations;
  }
  void intervene(const Trouble& trouble, GuardAction action, double time);

  Dynamics::Core& core;
  std::pmr::memory_resource* memory;
  IslandResult result;
  Accuracy accuracy;
  Meter meter;
  bool finished = false;  // coarsely: the accuracy is not what was asked for
  bool squeezed = false;  // what a script moves presses where nothing can go: an overlap is not to be mended
  bool booked = false;    // the books have the energy that the island holds now
  bool followed = false;  // the sub-step is a part of one, so short that its rows push as springs let them
  double swung = 0;       // J, the most that networks moved with at some time of the step
  // Movers are numbered: free bodies, the last ones drivers, then trees.
  std::pmr::vector<Free> free_bodies;
  std::size_t drivers = 0;
  std::pmr::vector<Tree*> trees;
  std::pmr::vector<NetworkCluster> networks;
  std::pmr::vector<Clustered> clusters;
  std::pmr::vector<NearPair*> pairs;
  std::pmr::vector<int> pair_drivers;              // of pairs: the driver's position in free_bodies, or -1
  std::pmr::vector<articulated::Impulse> momenta;  // room for a tree's that is moved

 private:
  bool is_network(const ClusterEntry& cluster) const;
  void put_driver(Free& one, double h) const;
  bool loose(const Clustered& one) const;
  void take_accuracy(const Accuracy& other);

  Energy sub_ledger_;  // as the sub-step began
  bool accuracy_set_ = false;
};

}  // namespace breve::island
