// The inside of Dynamics: tables of joints and springs, what is known of each body, trees, settings. One idea a file
// works on it: joints, assemblies, trees, motion, ledger, save.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "runtime/dynamics/cluster.hpp"
#include "runtime/dynamics/dynamics.hpp"
#include "runtime/dynamics/grouped.hpp"
#include "runtime/dynamics/loop_rows.hpp"
#include "runtime/dynamics/near_pairs.hpp"
#include "runtime/dynamics/shared_memory.hpp"
#include "runtime/dynamics/tree.hpp"
#include "runtime/mechanics/core.hpp"

namespace breve {

inline constexpr std::uint32_t kNone = 0xffffffffU;

/// Energy of what the ledger does not know yet: it comes with what it has when it first takes part in a step.
inline constexpr double kNoBook = std::numeric_limits<double>::quiet_NaN();
inline bool in_books(double booked) { return !std::isnan(booked); }

struct JointEntry : JointRecord {
  std::uint32_t tree = kNone;
  int link = -1;         // of the tree, whose inboard joint this is; -1: none (a loop joint, or not built yet)
  bool flipped = false;  // the tree goes from the child to the parent
  JointVector position = Vector3::Zero();  // as last known: full rotations are counted from here
  // Forces, N or N*m, in the last sub-step: of the limits, > 0 of the lower one; in the one before; of the motor's
  // rows.
  JointVector limit = Vector3::Zero(), limit_before = Vector3::Zero(), motor = Vector3::Zero();
};

struct SpringEntry : SpringRecord {
  double booked = kNoBook;  // J, that it holds by the books
  bool set = true;          // since a step was taken
};

/// What dynamics knows of a body beside the arrays; only bodies that it has to do with have one.
struct BodyEntry {
  BodyIndex body = kNoBody;
  std::uint32_t tree = kNone;  // that it is a link of; kNone: free
  int link = -1;
  bool force_method = false;
  bool known = false;  // the four below are what dynamics wrote last
  Vector3 location = Vector3::Zero(), velocity = Vector3::Zero(), spin = Vector3::Zero();
  Quaternion orientation{1, 0, 0, 0};
  double step = 0;                      // s, that step control would try next (a free body)
  std::pmr::vector<JointIndex> joints;  // in the order of creation
  std::uint32_t springs = 0;            // springs that hold it
  std::uint64_t mark = 0;               // of the last search that came here

  explicit BodyEntry(std::pmr::memory_resource* memory) : joints(memory) {}
};

/// What a script or host set in the arrays of a body that dynamics had written.
struct Change {
  BodyIndex body = kNoBody;
  Pose pose;
  Vector3 velocity = Vector3::Zero(), spin = Vector3::Zero();
  bool moved = false, pushed = false, spun = false;  // which of these it set
};

class SpringNetwork;
class NetworkMotion;

/// Trees that springs connect: what one integrator moves.
struct ClusterEntry : InMemory {
  explicit ClusterEntry(std::pmr::memory_resource* memory);
  ~ClusterEntry();
  std::pmr::vector<std::uint32_t> trees;  // in their order
  std::pmr::vector<SpringIndex> springs;  // in the order of their indices
  bool asked = false;                     // some link has a force method
  std::pmr::vector<std::size_t> wholes;   // then: where those that springs connect end among the trees
  std::unique_ptr<Cluster> system;
  std::unique_ptr<SpringNetwork>
      network;  // if they are bodies without joints, and more than one or connected to something
  std::unique_ptr<NetworkMotion> points;  // likewise, if more than one: as their centres move where that is all
};

class Island;

/// What a body is in the island that moves it.
struct BodySlot {
  Tree* tree = nullptr;  // null: it is free
  int mover = -1;        // in the island's order; -1: nothing moves it
  int link = -1;         // of the tree
};

struct Dynamics::Core : MechanicsCore {
  Core(std::pmr::memory_resource* memory, Bodies& bodies);

  std::pmr::vector<JointEntry> joints;
  std::pmr::vector<SpringEntry> springs;
  std::uint64_t springs_version = 1;  // grows where somebody sets one

  std::pmr::vector<std::uint32_t> entry_of;  // by body; kNone: no entry
  std::pmr::vector<BodyEntry> entries;
  std::pmr::vector<std::uint32_t> free_entries;

  std::pmr::vector<std::unique_ptr<Tree>> trees;             // null: a free place
  std::pmr::vector<std::uint32_t> tree_order;                // by the serial of their first joint
  std::pmr::vector<std::unique_ptr<ClusterEntry>> clusters;  // in the order of their first tree
  bool graph_changed = false;                                // some body's tree is to be built anew
  bool clusters_changed = false;                             // trees or springs between them changed
  bool integrators_changed = false;                          // the accuracy of something changed
  bool loading = false;                                      // trees take their numbers from an image

  NearPairs near;
  std::pmr::vector<BodySlot> slot_of;                 // by body, since islands were found
  SharedMemory shared;                                // of islands, which workers step
  std::pmr::vector<std::unique_ptr<Island>> islands;  // places to work on one
  std::pmr::vector<std::unique_ptr<Island>> calling;  // those of the step that need a client
  std::uint32_t island_count = 0;
  Grouped island_free, island_clusters, island_pairs;  // by number of the island: bodies without joints, and so on
  std::pmr::vector<std::uint8_t> aside;                // by body; empty: all move
  std::pmr::vector<std::uint32_t> set_of, island_of;   // by body: for finding islands

  std::uint64_t work_most = 0;  // of the sub-step: what counters.work may become
  // J, by body: what those without a tree have by the books. What differs when a step begins, scripts did.
  std::pmr::vector<double> booked;
  std::pmr::vector<BodyIndex> unsettled;  // of them, those that were set since; may name some twice
  std::pmr::vector<BodyIndex> scratch, changed;
  std::pmr::vector<Change> changes;
  std::uint64_t search = 0;  // the number of the last one

  // bodies.cpp
  BodyEntry& entry(BodyIndex body);
  BodyEntry* find(BodyIndex body);
  const BodyEntry* find(BodyIndex body) const;
  /// Dynamic, and not set aside while the rest of a step is taken by others.
  bool moves_now(BodyIndex body) const {
    return bodies->dynamic(body) && (aside.empty() || (body < aside.size() && !aside[body]));
  }
  std::uint64_t structure() const {
    return bodies->revision() + rules + (graph_changed ? 1 : 0) + (clusters_changed ? 1 : 0);
  }
  Pose pose(BodyIndex body) const { return {bodies->location(body), bodies->orientation(body)}; }

  // joints.cpp
  JointEntry& at(JointIndex joint);
  void place_child(JointEntry& joint);
  void detach(JointIndex joint);
  void note_joined(JointIndex joint);
  JointReaction react(const JointEntry& joint);
  /// Bodies connected with `body` through joints that hold, itself first; breadth first in the order of joints.
  void collect(BodyIndex body, std::pmr::vector<BodyIndex>& out);
  bool held_by_world(BodyIndex body);
  void move_rigidly(std::span<const BodyIndex> some, const Pose& from, const Pose& to);
  void touch_tree(BodyIndex body);  // the body's tree is to be built anew

  // assemblies.cpp
  bool jointed(BodyIndex a, BodyIndex b) const;
  /// The settings of the first body of the assembly, by index, that has `wanted` ones; null if there is none.
  const AssemblySettings* settings_of(BodyIndex body, bool (*wanted)(const AssemblySettings&));
  const Accuracy& accuracy_of(BodyIndex body);

  // springs.cpp
  SpringEntry& spring_at(SpringIndex spring);

  // trees.cpp
  bool needs_tree(BodyIndex body) const;
  void build_trees();
  void build_tree_of(BodyIndex body);
  void order_trees();
  void drop_tree(std::uint32_t tree);
  void build_tree(std::span<const BodyIndex> component);
  double unbook(Tree& tree, std::span<double> books) const;
  double book_together(std::span<const BodyIndex> component);
  void read_state(Tree& tree) const;
  std::pair<Quaternion, Vector3> between(const JointDescription& is) const;  // the child as seen from the parent
  void project_velocities(Tree& tree);
  void place_links(Tree& tree);  // forward kinematics, then write_back
  void write_back(Tree& tree);   // to the arrays, after forward kinematics

  JointVector read_position(const JointEntry& joint) const;
  JointVector read_velocity(const JointEntry& joint) const;

  // loads.cpp
  static bool has_limits(const JointEntry& joint);
  void measure_motors(Tree& tree);                                 // after factorize
  void set_loads(Tree& tree, const Accuracy& accuracy, double h);  // for steps of at most h
  void aim(Tree& tree) const;                                      // motors and joint forces, at the tree's state

  // motion.cpp
  void build_clusters();

  // islands.cpp
  void advance(MechanicsClient& client, double start, double h, double share);
  std::uint64_t work_left() const;
  std::size_t most_pairs() const;
  std::uint64_t part_of(std::uint64_t work, const Island& island) const;
  bool pushes(BodyIndex a, BodyIndex b, const MechanicsClient& client);
  bool locates() const;  // impacts, somewhere
  void find_islands();
  void keep_clusters_whole();
  BodyIndex first_of(const ClusterEntry& cluster) const;
  Island& fill(std::size_t slot, std::size_t number, double h);
  void step_undisturbed(Workers* workers, std::size_t count, double start, double h);
  void run(MechanicsClient& client, double start, double h, int depth);
  void run_only(MechanicsClient& client, double start, double h, int depth, std::span<const BodyIndex> bodies);
  void report_lasting(MechanicsClient& client, double moment);
  bool sleep_through(Island& island);
  void note_rest(Island& island, double h);
  void take_result(Island& island);
  ~Core();

  // lone_body.cpp
  bool step_alone(std::size_t island, double start, double h, std::uint64_t work, Energy& sum);

  // forget.cpp
  void forget(BodyIndex body);

  // dynamics.cpp
  std::size_t bytes() const;

  // loop_rows.cpp
  LoopRows loop_rows(const Tree& tree, const JointDescription& is) const;

  // stage_constraints.cpp
  /// Adds to accelerations (nv), after forward dynamics, what loops force, and limits that are held.
  std::uint64_t hold(Tree& tree, double* acceleration, bool loops, bool limits);
  JointReaction push_by_loops(Tree& tree, JointIndex wanted);

  // ledger.cpp
  Energy energy_of(Tree& tree) const;
  Vector3 carried(const NearPair& pair) const;
  double joint_springs(Tree& tree) const;
  double spring_energy_in(const SpringDescription& is) const;
  double spring_energy(const SpringDescription& is) const;
  Energy free_energy(BodyIndex body) const;
  double book_of(BodyIndex body) const { return body < booked.size() ? booked[body] : kNoBook; }
  void enter_books();
  double settle_books(bool write);
  double settle_tree(Tree& tree, bool write);
  double settle_spring(SpringEntry& spring, bool write);
  bool known_to_books(BodyIndex body) const;
  void add_stored(Energy& sum);

  // save.cpp
  void save(ByteWriter& out) const;
  void put_unsettled(ByteWriter& out) const;
  void save_tree(ByteWriter& out, const Tree& tree) const;
  void load(ByteReader& in);
  void join_loaded();
  void load_trees(ByteReader& in);
  void load_tree(ByteReader& in, Tree& tree);
  void hash(Hasher& hasher) const;

  // changes.cpp
  void sync_changes();  // trees that there are, with what was set in the arrays
  void follow_changes();
  void take_changes() {
    sync_changes();
    if (graph_changed) build_trees();
  }
  void note_written(BodyIndex body);  // the arrays hold what dynamics knows
  void move_tree(Tree& tree, const Pose& from, const Pose& to);
  bool note_change(BodyIndex body, std::pmr::vector<Change>& out) const;  // false if the arrays hold what was written
  void apply_changes(std::span<const Change> all);
  void drop_stale_trees();
  void strike(Tree& tree, std::span<const Change> all);
  void solve_strike(Tree& tree, std::span<const Change* const> struck);
};

}  // namespace breve
