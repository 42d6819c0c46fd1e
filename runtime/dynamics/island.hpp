// A set of bodies that may push one another within a step: what moves, which pairs are near, and the rows of contacts,
// limits and rings. Islands know nothing of one another, so that several may be stepped at once.
#pragma once

#include <exception>
#include <optional>

#include "runtime/contact/impacts.hpp"
#include "runtime/contact/solver.hpp"
#include "runtime/dynamics/island_result.hpp"
#include "runtime/dynamics/motion.hpp"
#include "runtime/dynamics/near_pairs.hpp"
#include "runtime/dynamics/stage.hpp"

namespace breve {

class Island : public InMemory {
 public:
  Island(Dynamics::Core& core, std::pmr::memory_resource* memory);
  ~Island();

  // --- what belongs to it, set before a step
  void clear();
  void add_free(BodyIndex body);
  void add_drivers(const NearPair& pair);  // after all free bodies: of each pair in turn
  /// If its bodies move as points for h seconds: they are like free bodies. After all of these.
  void add_network(ClusterEntry& cluster, double h);
  void add_cluster(ClusterEntry& cluster);  // after all free bodies; nothing if it is tied
  void add_pair(NearPair& pair);
  bool empty() const { return free_.empty() && clusters_.empty(); }
  bool has_drivers() const { return drivers_ > 0; }

  /// Moves it from `start` by h seconds; write() is to follow, but where it was dissolved. Touches nothing that
  /// is not the island's if there is no client: on any thread then.
  /// @param client  for handlers and force methods; then on the world's thread only
  void step(MechanicsClient* client, double start, double h);
  bool calls_out() const;  // step() needs a client
  /// Work that step() may take, from now on; where it is used up, what is left of the step is finished coarsely.
  void bound_work(std::uint64_t most, const std::atomic<bool>* ended) { meter_.begin(most, ended); }
  std::size_t items() const;  // bodies and pairs, by which work is shared out
  std::uint64_t work() const { return meter_.done(); }
  /// A handler made or freed bodies or joints: what the island refers to may be gone.
  bool dissolved() const { return dissolved_; }
  /// Seconds of the step that are left then.
  double unfinished() const { return unfinished_; }
  void append_bodies(std::pmr::vector<BodyIndex>& out) const;
  /// Slow enough to sleep, all of it.
  bool still() const;
  enum class Momenta : bool { Take, Keep };  // the last of what nothing outside touches
  void stop(Momenta momenta, double h);      // all velocities zero but these, h seconds after the step began
  void write();                              // to the arrays

  /// Adds to `j` (nv) how the velocity of a link's point along `axis` (or its spin about it) depends on v; the tree's
  /// links are placed.
  static void fill(Tree& tree, int link, const Vector3& point, const Vector3& axis, bool angular, double sign,
                   double* j);
  /// The same of a ring's row, and nothing else, into `j`. Zero where the tree itself keeps what the row holds (a plane
  /// ring its plane): round-off there, taken for a direction to push in, would push without bound.
  static void fill_loop(Tree& tree, const LoopRows& loop, const LoopRow& row, double* j);
  /// Likewise of a joint's limit: how the room to it grows.
  static void fill_limit(const Tree& tree, const JointEntry& joint, int axis, double sign, double* j);

  IslandResult result;
  std::exception_ptr error;  // that ended its step, where others are stepped at the same time

 private:
  // Parts of the smaller body's radius: within the first, bodies that are slow rest on one another; within the second,
  // they touch, and within the third they have met: what approaches collides there, not before.
  static constexpr double kSkin = 1e-3, kTouchSkin = 1e-4, kMetSkin = 1e-9;
  static constexpr double kRotationRoom = 0.02;  // of the radius, which turning may bring nearer in a sub-step
  static constexpr double kTiny = 1e-9;          // of stored energy: round-off of sums
  static constexpr double kStill = 1e-6;         // of weight(): what may be unexplained of a step of what hardly moves
  static constexpr double kCoarse = 1e-3;        // tolerances of step control from which contacts are seen less exactly
  static constexpr double kFew = 0.01;           // of what moves: what may be taken from it without trying again
  static constexpr double kLimitSkin = 1e-6;     // rad or m

  struct Free {
    BodyIndex body;
    FreeBody now, before;
    double next = 0, next_before = 0;
    double v[6], free_v[6];  // velocity and spin: as the solver has them, and without its impulses
    double plain_v[6];       // as the solver had them without rebounds
    bool driver = false;     // a script moves it, whatever pushes it; each pair and island has its own of it
  };
  /// Energy as a sub-step began, for what its rows did to it.
  struct Books {
    double stored = 0;          // J
    double kinetic = 0;         // J, of all trees
    double smooth_kinetic = 0;  // J, likewise, after smooth motion
    double predicted = 0;       // J, that predicted forces give from rest
    Energy ledger;              // works and losses
    double unexplained = 0;     // J, that smooth motion gained
  };
  struct Clustered {
    ClusterEntry* entry;
    std::optional<Stage> stage;
    double next_before = 0;
    bool semi = false;     // its last smooth motion was semi-implicit Euler's
    bool loose = false;    // nothing but contacts and gravity acts on it from outside
    Energy pending;        // of the last smooth()
    double held_work = 0;  // J, likewise, of forces that were predicted
    Books books;           // of the sub-step
    bool alone() const { return entry->trees.size() == 1 && entry->springs.empty(); }
  };
  /// Bodies that springs tie, which move as points: from that place in free_ on.
  struct NetworkCluster {
    ClusterEntry* entry;
    std::size_t first;
  };
  /// What a pair is in this sub-step: its impact is looked for on the whole way; or only whether it comes back; or it
  /// has rows; or it is a spring.
  enum class Role : std::uint8_t { Far, Leaves, Rests, Springs };
  /// A point that touches, or nearly, as rows see it.
  struct Touch {
    std::uint32_t pair = 0;
    std::uint32_t feature = 0;
    Vector3 point, normal;                                               // world; the normal from b toward a
    Vector3 on_a, on_b;                                                  // the point, in the axes of each body
    Vector3 from_a, from_b;                                              // where the bodies' origins were
    Quaternion orientation_a, orientation_b;                             // how the bodies were turned
    Vector3 velocity_a = Vector3::Zero(), velocity_b = Vector3::Zero();  // of the bodies there, as the sub-step began
    double gap = 0;                                                      // m, at the start of the sub-step
    double approach = 0;  // m/s, v_n when the sub-step began; unknown where nothing is located
    bool far = false;     // touches only if the bodies rotate toward it, and says nothing of whether the pair rests
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
    double slow;        // slower than this it is caught by a row, and does not strike
    bool rests;         // it is a row; else it is to be located
    bool held = false;  // it acts inside the stages, and is not located
  };
  /// A motor as a scalar row: one number of its tree's velocity, and the most that it may push with.
  struct MotorRow {
    Tree* tree;
    JointIndex joint;
    int axis;         // of the joint's numbers
    int velocity;     // of the tree's numbers
    int shared;       // rows that share the limit: this and those that follow it; 0: one of those
    double strength;  // N or N*m
  };
  /// When a joint left its limit, s, and how fast.
  struct Rebound {
    double time = 0, rate = JointDrive::kNoLimit;
    bool stays = false;  // it was back at once: for the remainder of the step it rests where it is near
  };
  /// The first event of a sub-step.
  struct Event {
    double time = 0;                        // s after the start of the sub-step
    int pair = -1, bound = -1, point = -1;  // the last of a spring
    double depth = 0;  // m or rad, of overlap when the sub-step began: it is an event if it gets deeper
    double until = 0;  // s, likewise, when it is deepest, if that is over before the sub-step ends; 0: it is not
    bool found() const { return pair >= 0 || bound >= 0 || point >= 0; }
  };

  // island.cpp
  void put_driver(Free& one, double h);
  void begin(MechanicsClient* client, double h);
  void place(double h = 0);  // kinematics and factors of trees, at the state now; for rows of h seconds
  void remember();
  void restore();
  void commit();  // the last smooth() counts: its works go to the account
  Pose pose_of(BodyIndex body) const;
  /// The vector from the centre of mass of a free body to a point, m.
  Vector3 arm_of(const BodySlot& free, const Vector3& point) const {
    return point - free_[static_cast<std::size_t>(free.mover)].now.center;
  }
  Vector3 spin_of(BodyIndex body) const;
  Vector3 point_velocity(BodyIndex body, const Vector3& point) const;
  // island_smooth.cpp
  static void move_driver(Free& one, double h);
  /// Where a body is in this island.
  BodySlot slot_of(BodyIndex body) const {
    BodySlot slot = core_.slot_of[body];
    const std::size_t first = free_.size() - drivers_;
    for (std::size_t i = first; slot.mover < 0 && i < free_.size(); ++i)
      if (free_[i].body == body) slot.mover = static_cast<int>(i);
    return slot;
  }
  bool is_driver(int mover) const {
    const auto count = static_cast<int>(free_.size());
    return mover >= count - static_cast<int>(drivers_) && mover < count;
  }
  /// The bodies that are free.
  std::span<Free> loose_bodies() { return {free_.data(), free_.size() - drivers_}; }
  std::span<const Free> loose_bodies() const { return {free_.data(), free_.size() - drivers_}; }
  void smooth(double time, double h);
  void smooth_once(Clustered& one, double time, double h);
  static void forget_parts(Clustered& one);
  void smooth_fast(Clustered& one, double time, double h);
  bool stiff(const Clustered& one) const;
  double gain_of(Clustered& one, double time, double h, int parts);
  double spring_energy_in(const Clustered& one) const;
  double stored_in(const Clustered& one, double& kinetic);
  bool coarse() const;
  // island_networks.cpp
  bool is_network(const ClusterEntry& cluster) const;
  std::size_t networks_end() const;
  bool begin_networks(double h);
  void take_points(const NetworkCluster& one);
  void smooth_networks(double time, double h);
  double network_energy();
  double held_network_energy() const;
  void correct_network_drag();
  void write_networks();
  void book_networks();
  // island_books.cpp
  void open_books();  // this and what follows: island_books.cpp
  void note_smooth();
  void close_books();
  void take_back_rest();
  double stored_now();
  // island_momentum.cpp
  bool loose(const Clustered& one) const;
  void smooth_whole(Clustered& one, double time, double h);
  static bool take_back(Clustered& one, double gain);
  static void take_back_most(Clustered& one, double gain);
  double moving() const;
  void take_from_all(double part);
  bool touched_from_outside() const;
  double stop_links(Clustered& one, Momenta momenta, double h);
  void coast(double h);
  void note_wholes(articulated::Vector Tree::*velocity, bool now);
  enum class Given : std::uint8_t { All, Impacts, Places, Pushes };
  void keep_wholes(double moved_h, Given given);
  bool pushes_itself() const;
  // island_rows.cpp
  double size_of_pair(const NearPair& pair) const;
  Speeds speeds_of(const contact::Law& law, double size, double h) const;
  void find_touches(double h, bool speculative);
  void find_roles(double h, bool struck);
  void find_touches_now();
  double falling(const JointEntry& joint) const;
  void find_bounds();
  enum class Motors : bool { Leave, Drive };
  void make_rows(Motors motors);
  void read_rates();
  void recall_rates();
  static Touch touch_at(std::size_t pair, const Pose& a, const Pose& b, const Manifold& manifold,
                        const ContactPoint& point);
  void set_biases(double h);
  void add_motor_rows(Tree& tree);
  void add_touch_row(Touch& touch);
  Vector3 carried(const Touch& touch) const;
  void add_bound_row(const Bound& bound);
  void add_loop_rows(const Tree& tree);
  std::size_t limit_rows() const { return scalars_.size() - motors_.size() - loop_errors_.size(); }
  double* rows_of(Tree& tree, int count);
  void respond(Tree& tree, const double* j, double* r) const;
  bool strikes(double h) const;
  // island_results.cpp
  void solve(double h);  // this and what follows: island_results.cpp
  void solve_rows();
  double direct_share() const;
  void bound_motors(double h);
  bool shorten_couples(double h);
  void load_velocities();                 // movers' v from the state
  void store_velocities(double moved_h);  // back, and positions by what impulses changed times moved_h
  void correct_works(double h);
  Vector3 rate_of(const contact::Row& row, bool first) const;
  double rate_of(const contact::ScalarRow& row) const;
  void book_rows();
  void note_forces(double h);
  void add_force(BodyIndex body, const Vector3& point, const Vector3& force);
  void keep_warm(double h);
  // island_rebound.cpp
  bool find_rebounds(double h);
  void read_row_rates(std::pmr::vector<double>& rates) const;
  void read_impulses(std::pmr::vector<double>& impulses) const;
  void solve_rebounding();
  void mix(double share);
  void reset_velocities();
  bool is_motor(std::size_t scalar) const { return scalar - limit_rows() < motors_.size(); }
  // island_predict.cpp
  const WarmPoint* warm_of(const Touch& touch) const;
  void predict(double h);
  bool overpressed(double h) const;
  void predict_contact(const Touch& touch, const Vector3& force);
  void begin_solve(double h);
  bool misled(double h);
  bool strained() const;
  void forget_prediction();
  void solve_after(double h);
  // island_step.cpp
  void step_undisturbed(double start, double h);
  void step_fast(double start, double h);
  void take_fast(double time, double h);
  void finish(double time, double left);
  /// No further sub-step is to begin: the work is used up, or would be by what holds rings once.
  bool unaffordable() const { return meter_.over(loop_units()); }
  std::uint64_t loop_units() const;
  bool worn() const { return finished_ || meter_.over(); }  // nothing is to be tried again
  void note_start_poses();
  void book_part(double part, double took);
  void tell_impacts(double time);
  void step_located(MechanicsClient* client, double start, double h);
  void advance_once(double time, double h);
  bool catch_bounds(double time, double h);
  void look(double h, bool spent);
  int located_impacts() const;
  double contact_part(double left, bool lies) const;
  bool lies(double h) const;
  bool call(MechanicsClient& client, int pair, double moment, double left);
  bool holds_loops() const;
  bool has_rows() const;
  bool has_loops() const;
  void place_links();
  double longest(double left, bool lies) const;
  // island_impacts.cpp
  Event seek(double time, double h);
  bool touches_lightly(std::size_t pair, const Pose& a, const Pose& b, double h, Event& event) const;
  void check_light_touches(double time, double h, Event& first);
  void locate(double time, Event& event, double h);
  const NearPair& pair_of(const Event& event) const;
  double closeness(const Event& event) const;
  double met_limit() const;
  void refine(double time, Event& event, double h);
  bool is_past(const Event& event);
  double gap_of(const Event& event, double& rate);
  void meet(MechanicsClient* client, const Event& event, double moment, double left);
  void collide(double time);
  void rebound(std::size_t bound, double time);
  static Motion chord(const Pose& from, const Pose& to, double h);
  // island_positions.cpp
  void push_apart(double h);
  void move_by_pushes(double fastest, double h);
  double payable(double h) const;
  void shorten_pushes(double before, double h);
  void take_back_pushes(double part, double h);
  void hold_bounds(double h);
  bool find_struck(double h);
  void begin_moves();
  void end_moves(double h);
  void book_moves(double sign);
  void book_way(double work, Tree* tree);
  void pay_for_moves(double given);
  void hold_off(double h);
  double natural_response(BodyIndex body) const;
  bool hold_loops(double time, double h);
  double read_loop_errors();
  void close_loops();
  // island_springs.cpp
  struct SprungPoint;
  class SprungMotion;
  bool has_contact_springs() const;
  bool springs_for(const contact::Law& law) const;
  double effective_mass(const NearPair& pair, const Vector3& point, const Vector3& normal) const;
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
  void step_guarded(MechanicsClient* client, double start, double h);
  void use_accuracy(const Accuracy& accuracy);
  void step_once(MechanicsClient* client, double start, double h);
  Trouble try_step(MechanicsClient* client, double start, double h);
  Trouble try_in_parts(MechanicsClient* client, double start, double h);
  double tolerated(double turnover, double h) const;
  double weight() const;
  double energy_of_stillness() const;
  void give_in(const Trouble& trouble, bool unpaid, double start, double h);
  void keep_start();
  void balance(double& residual, double& turnover);
  void back_to_start();
  double stored(double& kinetic, bool start);
  double held_energy() const;
  double unexplained_since_start(double after) const;
  void end_unfinished(double held);
  void book();
  BodyIndex any_body() const;
  void intervene(const Trouble& trouble, GuardAction action, double time);
  // island_watch.cpp
  BodyIndex not_finite() const;  // the first that shows it
  Trouble judge_residual(double residual, double turnover, double before) const;
  Trouble foresee(double h);
  void follow_rotations(double h);
  Trouble fastest_rotation(double h) const;
  Trouble strongest_damper(double h) const;
  double fastest_approach() const;
  void note_overlaps(double h);
  Trouble measure_overlaps();

  Dynamics::Core& core_;
  std::pmr::memory_resource* memory_;
  Accuracy accuracy_;
  bool accuracy_set_ = false;
  Meter meter_;
  bool finished_ = false;  // coarsely: the accuracy is not what was asked for
  double gone_ = 0;        // s, of the step, that are over
  bool dissolved_ = false;
  double unfinished_ = 0;  // s
  struct ResultStart {     // what the result was when the step began, for one that is tried again
    DynamicsCounters counters;
    Energy ledger;
    std::size_t impacts = 0;
  };
  ResultStart at_start_;
  std::pmr::vector<FreeBody> free_start_;
  std::pmr::vector<NearPair> pair_start_;
  double unexplained_ = 0, allowed_ = 0;  // J, of the last try of a step
  double gained_ = 0;                     // J, likewise, that contacts and limits gave
  bool touched_ = false;                  // something outside was there when they did
  bool keeps_books_ = false;              // of this sub-step
  Books books_;                           // of all, of the sub-step
  double stored_start_ = 0;               // J, as it began
  double handled_ = 0;                    // J, that handlers brought in meanwhile
  bool booked_ = false;                   // the books have what it holds now
  bool placed_ = false;                   // links stand where stored() found them: nothing has moved since
  bool locates_ = false;                  // handlers are called at the moment of impact
  double resting_ = 0;                    // m/s: slower than this is at rest, in a sub-step of this one
  double looked_h_ = 0;                   // s, of the sub-step that was looked at last
  double free_work_ = 0;                  // J, of scripts on free bodies in the last smooth()
  double network_loss_ = 0;               // J, in dampers of networks_ likewise
  std::pmr::vector<Role> roles_;          // of pairs
  std::pmr::vector<Free> free_;           // the last ones drivers
  std::size_t drivers_ = 0;
  std::pmr::vector<int> pair_drivers_;  // of pairs: the place of the driver in free_, or -1
  std::pmr::vector<NetworkCluster> networks_;
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
  std::pmr::vector<contact::Push> pushes_;  // of rows: how positions are put right
  std::pmr::vector<double> push_scalars_;   // of scalar rows: the velocity that does, m/s or rad/s
  /// Impulse on a tree from outside, and about its centre of mass.
  struct OuterImpulse {
    Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
  };
  std::pmr::vector<OuterImpulse> outer_;  // of trees
  std::pmr::vector<double> rebounding_;   // of rows, then of scalar rows: the speed at which they are to part
  // Of rows but those of motors, three numbers a contact: velocities without impulses, without and with rebound.
  std::pmr::vector<double> free_rates_, plain_rates_, rates_, plain_impulses_, impulses_;
  std::pmr::vector<double> plain_scalars_;  // impulses of all scalar rows without rebound
  std::pmr::vector<MotorRow> motors_;       // scalar rows: of limits, then these, then of rings
  std::pmr::vector<double> loop_errors_;
  std::pmr::vector<Pose> start_poses_;           // of each pair's two bodies, as the sub-step began
  std::pmr::vector<std::size_t> rebound_later_;  // of bounds_
  std::pmr::vector<Rebound> rebounds_;           // likewise, the last of each in this step
  std::pmr::vector<Event> found_;                // in a sub-step, with times that are guesses
  std::pmr::vector<Event> light_;                // likewise, that a path may have which bends there and back
  int impacts_ = 0;                              // located so far in this step
  bool spent_ = false;                           // none is located any more
  std::pmr::vector<double> depths_;              // of pairs: overlap when the sub-step began, m
  std::pmr::vector<Vector3> before_;  // of each row's two sides: velocity along its axes as the sub-step began
  // Forces of the last sub-step, N or N*m, that are taken to go on and act inside the stages: of each touch in world
  // axes, of each limit that is a row.
  std::pmr::vector<Vector3> predicted_;
  std::pmr::vector<double> before_force_;    // of rows: N along the normal, in the last sub-step
  std::pmr::vector<std::uint8_t> struck_;    // of movers: contacts changed its velocity
  double solved_h_ = 0;                      // s, of the sub-step that was solved last
  std::pmr::vector<double> scalars_before_;  // of each scalar row
  std::pmr::vector<Overlap> overlaps_;
  std::pmr::vector<std::uint8_t> overlapped_;  // of pairs: it is one of these
  contact::Workspace workspace_;
  std::unique_ptr<SprungMotion> sprung_;     // made when it is first needed
  std::pmr::vector<std::uint8_t> followed_;  // of pairs: a spring with points
  double calibrated_ = -1;                   // the ratio of damping that gave
  contact::Dashpots dashpots_;
};

}  // namespace breve
