// A set of bodies that may push one another within a step: what moves, which pairs are near, and the rows of contacts,
// limits and rings. Islands know nothing of one another, so that several may be stepped at once.
#pragma once

#include <exception>
#include <optional>

#include "runtime/contact/impacts.hpp"
#include "runtime/contact/solver.hpp"
#include "runtime/dynamics/contacts.hpp"
#include "runtime/dynamics/motion.hpp"
#include "runtime/dynamics/stage.hpp"

namespace breve {

/// What an island was found to have, and what its step took; added to the world's in the order of islands.
struct IslandResult {
  DynamicsCounters counters;
  Energy account;
  std::pmr::vector<Impact> impacts;
  std::pmr::vector<Intervention> interventions;
  explicit IslandResult(std::pmr::memory_resource* memory) : impacts(memory), interventions(memory) {}
};

class Island : public InMemory {
 public:
  Island(Dynamics::Core& core, std::pmr::memory_resource* memory);
  ~Island();

  // --- what belongs to it, set before a step
  void clear();
  void add_free(BodyIndex body);
  void add_cluster(ClusterEntry& cluster);  // after all free bodies
  void add_pair(NearPair& pair);
  bool empty() const { return free_.empty() && clusters_.empty(); }

  /// Moves it from `start` by h seconds; write() is to follow, but for a step that is unfinished. Touches nothing that
  /// is not the island's if there is no client: on any thread then.
  /// @param client  for handlers and force methods; then on the world's thread only
  void step(DynamicsClient* client, double start, double h);
  bool calls_out() const;  // step() needs a client
  /// Seconds of the step that are left because a handler made or freed bodies or joints; 0: none.
  double unfinished() const { return unfinished_; }
  void append_bodies(std::pmr::vector<BodyIndex>& out) const;
  /// Slow enough to sleep, all of it.
  bool still() const;
  void stop();   // all velocities zero
  void write();  // to the arrays

  /// Adds to `j` (nv) how the velocity of a link's point along `axis` (or its spin about it) depends on v; the tree's
  /// links are placed.
  static void fill(Tree& tree, int link, const Vector3& point, const Vector3& axis, bool angular, double sign,
                   double* j);
  /// The same of a ring's row, and nothing else, into `j`. Zero where the tree itself keeps what the row holds (a plane
  /// ring its plane): round-off there, taken for a direction to push in, would push without bound.
  static void fill_ring(Tree& tree, const RingRows& ring, const RingRow& row, double* j);
  /// Likewise of a joint's limit: how the room to it grows.
  static void fill_limit(const Tree& tree, const JointEntry& joint, int axis, double sign, double* j);

  IslandResult result;
  std::exception_ptr error;  // that ended its step, where others are stepped at the same time

 private:
  // Parts of the smaller body's radius: within the first, bodies that are slow rest on one another; within the second,
  // they touch, and within the third they have met: what approaches collides there, not before.
  static constexpr double kSkin = 1e-3, kTouchSkin = 1e-4, kMetSkin = 1e-9;
  static constexpr double kTurnRoom = 0.02;   // of the radius, which turning may bring nearer in a sub-step
  static constexpr double kTiny = 1e-9;       // of stored energy: round-off of sums
  static constexpr double kCoarse = 1e-3;     // tolerances of step control from which contacts are seen less exactly
  static constexpr double kLimitSkin = 1e-6;  // rad or m

  struct Free {
    BodyIndex body;
    FreeBody now, before;
    double next = 0, next_before = 0;
    double v[6], free_v[6];  // velocity and spin: as the solver has them, and without its impulses
  };
  struct Clustered {
    ClusterEntry* entry;
    std::optional<Stage> stage;
    double next_before = 0;
    Energy pending;  // of the last smooth()
    bool alone() const { return entry->trees.size() == 1 && entry->ties.empty(); }
  };
  /// What a pair is in this sub-step: its impact is looked for on the whole way; or only whether it comes back; or it
  /// has rows; or it is a spring.
  enum class Role : std::uint8_t { Far, Leaves, Rests, Springs };
  /// A point that touches, or nearly, as rows see it.
  struct Touch {
    std::uint32_t pair;
    std::uint32_t feature;
    Vector3 point, normal;  // world; the normal from b toward a
    double gap;             // m, at the start of the sub-step
    double approach;        // m/s, v_n when the sub-step began; unknown where nothing is located
  };
  /// Speeds of a pair, m/s, that separate impacts from what the rows of a sub-step do.
  struct Speeds {
    double slow;    // approaching or leaving slower than this rests
    double strike;  // what touches and approaches faster collides at once
  };
  /// A joint's limit as a scalar row.
  struct Bound {
    JointIndex joint;
    int axis;
    double sign;        // the gap grows with sign * position
    double limit;       // the position, m or rad
    double gap;         // m or rad
    double rate;        // of the gap when the sub-step began
    bool rests;         // it is a row; else it is to be located
    bool held = false;  // it acts inside the stages, and is not located
  };
  /// When a joint left its limit, s, and how fast.
  struct Rebound {
    double time = 0, rate = JointDrive::kNoLimit;
    bool stays = false;  // it was back at once: for the remainder of the step it rests where it is near
  };
  /// What comes first in a sub-step.
  struct Event {
    double time = 0;                        // s after the start of the sub-step
    int pair = -1, bound = -1, point = -1;  // the last of a spring
    double depth = 0;  // m or rad, of overlap when the sub-step began: it is an event if it gets deeper
    bool found() const { return pair >= 0 || bound >= 0 || point >= 0; }
  };

  // island.cpp
  void begin(DynamicsClient* client, double h);
  void place();  // kinematics and factors of trees, at the state now
  void remember();
  void restore();
  void smooth(double time, double h);
  // island_smooth.cpp
  void smooth_once(Clustered& one, double time, double h);
  void smooth_by_euler(Clustered& one, double time, double h);
  double gain_of(Clustered& one, double time, double h, int parts, double shift);
  double stored_in(const Clustered& one, double shift, double& kinetic);
  void commit();  // the last smooth() counts: its works go to the account
  Pose pose_of(BodyIndex body) const;
  /// Of a point, from the centre of mass of a free body, m.
  Vector3 arm_of(const BodyPlace& free, const Vector3& point) const {
    return point - free_[static_cast<std::size_t>(free.mover)].now.center;
  }
  Vector3 point_velocity(BodyIndex body, const Vector3& point) const;

  // island_rows.cpp
  double size_of_pair(const NearPair& pair) const;
  Speeds speeds_of(const contact::Law& law, double size, double h) const;
  void find_touches(double h, bool speculative);
  void find_roles(double h, bool struck);
  void find_touches_now();
  void find_bounds();
  void make_rows(double h, bool restitution);
  void set_biases(double h);
  void add_touch_row(const Touch& touch);
  void add_bound_row(const Bound& bound);
  void add_ring_rows(const Tree& tree);
  double* rows_of(Tree& tree, int count);
  void respond(Tree& tree, const double* j, double* r) const;
  void solve();                           // this and what follows: island_results.cpp
  void load_velocities();                 // movers' v from the state
  void store_velocities(double moved_h);  // back, and positions by what impulses changed times moved_h
  void correct_works(double h);
  Vector3 rate_of(const contact::Row& row, bool first) const;
  double rate_of(const contact::ScalarRow& row) const;
  void account_rows();
  void note_forces(double h);
  void add_force(BodyIndex body, const Vector3& point, const Vector3& force);
  void keep_warm();

  // island_step.cpp
  void step_quiet(double start, double h);
  void step_fast(double start, double h);
  void step_located(DynamicsClient* client, double start, double h);
  void advance_once(double time, double h);
  Event seek(double h);
  void locate(double time, Event& event, double h);
  const NearPair& pair_of(const Event& event) const;
  double closeness(const Event& event) const;
  double met_limit() const;
  bool coarse() const;
  void refine(double time, Event& event, double h);
  bool is_past(const Event& event);
  double gap_of(const Event& event, double& rate);
  void look(double h, bool spent);
  double contact_part(double left) const;
  bool strikes(double h) const;
  void meet(DynamicsClient* client, const Event& event, double moment, double left);
  void collide(double time);
  void rebound(std::size_t bound, double time);
  void push_apart(double h);
  void begin_moves();
  void end_moves(double h);
  bool call(DynamicsClient& client, int pair, double moment, double left);
  bool holds_rings() const;
  bool only_rings() const;  // nothing else has rows
  bool hold_rings(double time, double h);
  double read_ring_errors();
  void close_rings();
  void place_links();
  static Motion chord(const Pose& from, const Pose& to, double h);
  double longest(double left) const;

  // island_springs.cpp
  struct SprungPoint;
  class SprungMotion;
  bool has_contact_springs() const;
  bool springs_for(const contact::Law& law) const;
  double felt_mass(const NearPair& pair, const Vector3& point, const Vector3& normal) const;
  void begin_spring(NearPair& pair, const Touch& touch);
  void end_spring(NearPair& pair);
  void take_springs();
  void hold_limits(double h);
  void add_sprung_point(const NearPair& pair, const Touch& touch);
  void hand_on(const NearPair& pair, std::span<SprungPoint> points);
  bool springs_move() const;
  void smooth_springs(double time, double h);
  void commit_springs();
  void keep_springs();
  void seek_closing(double h);
  std::size_t pair_of_point(int point) const;
  double gap_of_point(int point, double& rate);
  void note_spring_forces();

  // island_guard.cpp
  /// What went wrong, the body that shows it, and how much: J, m or a ratio.
  struct Trouble {
    bool found = false;
    GuardReason reason = GuardReason::NotFinite;
    double value = 0;
    BodyIndex body = kNoBody;
  };
  /// A pair that is deep, or may become so in this step.
  struct Overlap {
    std::uint32_t pair;
    double before;  // m, when it was noted
  };
  void step_once(DynamicsClient* client, double start, double h);
  Trouble try_step(DynamicsClient* client, double start, double h);
  void give_in(const Trouble& trouble, double start);
  void keep_start();
  void balance(double before, double& residual, double& turnover);
  void back_to_start();
  double stored(double& kinetic, bool start);
  BodyIndex any_body() const;
  void intervene(const Trouble& trouble, GuardAction action, double time);

  // island_watch.cpp
  BodyIndex not_finite() const;  // the first that shows it
  Trouble judge_residual(double residual, double turnover, double before) const;
  Trouble foresee(double h);
  Trouble fastest_turn(double h) const;
  Trouble strongest_damper(double h) const;
  double fastest_approach() const;
  void note_overlaps(double h);
  Trouble measure_overlaps();
  double height();

  Dynamics::Core& core_;
  std::pmr::memory_resource* memory_;
  Accuracy accuracy_;
  bool accuracy_set_ = false;
  double unfinished_ = 0;
  struct ResultStart {  // what the result was when the step began, for one that is tried again
    DynamicsCounters counters;
    Energy account;
    std::size_t impacts = 0;
  };
  ResultStart at_start_;
  std::pmr::vector<FreeBody> free_start_;
  std::pmr::vector<NearPair> pair_start_;
  bool placed_ = false;           // links stand where stored() found them: nothing has moved since
  bool locates_ = false;          // handlers are called at the moment of impact
  double quiet_ = 0;              // m/s: slower than this is at rest, in a sub-step of this one
  double free_work_ = 0;          // J, of scripts on free bodies in the last smooth()
  std::pmr::vector<Role> roles_;  // of pairs
  std::pmr::vector<Free> free_;
  std::pmr::vector<Clustered> clusters_;
  std::pmr::vector<Tree*> trees_;
  std::pmr::vector<NearPair*> pairs_;
  std::pmr::vector<Touch> touches_;
  std::pmr::vector<Bound> bounds_;
  std::pmr::vector<contact::Mover> movers_;
  std::pmr::vector<contact::Row> rows_;
  std::pmr::vector<contact::ScalarRow> scalars_;
  std::pmr::vector<contact::Law> laws_;
  std::pmr::vector<double> numbers_;  // of Jacobians
  std::pmr::vector<Manifold> manifolds_;
  std::pmr::vector<double> apart_, apart_scalars_;  // of rows: the velocity that puts positions right, m/s
  std::pmr::vector<double> ring_errors_;
  std::pmr::vector<Pose> start_poses_;           // of each pair's two bodies, as the sub-step began
  std::pmr::vector<std::size_t> rebound_later_;  // of bounds_
  std::pmr::vector<Rebound> rebounds_;           // likewise, the last of each in this step
  std::pmr::vector<Event> found_;                // in a sub-step, with times that are guesses
  int impacts_ = 0;                              // located so far in this step
  std::pmr::vector<double> depths_;              // of pairs: overlap when the sub-step began, m
  std::pmr::vector<Vector3> before_;         // of each row's two sides: velocity along its axes as the sub-step began
  std::pmr::vector<Vector3> warm_;           // of each row, where its solver begins
  std::pmr::vector<double> scalars_before_;  // of each scalar row
  std::pmr::vector<Overlap> overlaps_;
  double pushed_ = 0;  // J, by which pushing apart lifted all in this step
  contact::Workspace workspace_;
  std::unique_ptr<SprungMotion> sprung_;     // made when it is first needed
  std::pmr::vector<std::uint8_t> followed_;  // of pairs: a spring with points
  double calibrated_ = -1;                   // the ratio of damping that gave
  contact::Dashpots dashpots_;
};

}  // namespace breve
