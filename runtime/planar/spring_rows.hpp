// The springs and dampers of a sub-step, between bodies and in joints, solved together: what each of them pulls depends
// on how far all the others let the bodies move.
#pragma once

#include <list>
#include <memory>

#include "runtime/planar/response.hpp"

namespace breve {

/// The forces of springs in one sub-step of length h. A body is moved by a velocity w, its path velocity. Box2D moves
/// it by that at the end of the sub-step, w = v + h M^-1 F. A body in flight gets half of its acceleration after it was
/// moved instead, so that w = v + h/2 M^-1 F is the mean of the velocities before and after. There a spring pulls with
/// the mean of its force at both ends of the path, along the mean of its vector: the work of that is exactly the change
/// of its energy, whatever its stiffness is (the discrete gradient of Gonzalez 1996; implicit midpoint if the spring is
/// linear). Other springs act as they stand if the sub-step follows all that pulls at their bodies, and else as they
/// will stand at its end, which only loses energy. Newton's method and conjugate gradients find w, separately for
/// bodies that no springs and joints connect.
class SpringRows {
 public:
  explicit SpringRows(Planar::Core& core);

  /// A sub-step of another length, without springs yet. Memory is kept.
  void begin(double dt);
  void add(FlatSpring& spring);
  void add(FlatJoint& joint);
  /// Adds the forces to those of the bodies and of the ledger, and takes note of the bodies that fly.
  void solve();

 private:
  /// How a spring acts: as it stands, by its mean over the sub-step, as at the end of it.
  enum class Rule : std::uint8_t { Now, Mean, End };
  struct Node {
    FlatBody* flat = nullptr;
    bool flies = false;
    const Response* held = nullptr;                           // by joints, if the assembly flies
    int root = 0;                                             // stands for all that is connected
    int at = 0;                                               // among the nodes of its part
    double damped = 0, pace = 0;                              // h c / m and h (c + h k) / m, summed over what acts here
    Vector3 start = Vector3::Zero(), path = Vector3::Zero();  // v, w: m/s, m/s, rad/s
    Vector3 load = Vector3::Zero();                           // N, N, N*m: of all but the rows that are solved
  };
  struct End {
    int node = -1;                       // -1: it does not answer
    Vector2 arm = Vector2::Zero();       // from the centre of mass
    Vector2 velocity = Vector2::Zero();  // of the point; it goes on with that if there is no node
    Vector2 moved = Vector2::Zero();     // by the path, m
    Vector2 mean = Vector2::Zero();      // the arm at which the force acts
    Vector3 along = Vector3::Zero(), across = Vector3::Zero();  // what w makes of the rate of the stretch, and sideways
  };
  struct Elastic {
    double force = 0, energy = 0;
  };
  struct Row {
    FlatSpring* spring = nullptr;
    FlatJoint* joint = nullptr;
    Rule rule = Rule::Mean;
    End ends[2];
    double strength = 0, damping = 0;
    Vector2 way = Vector2::Zero();   // of a spring, at the start
    double from = 0;                 // its length then
    Elastic first;                   // and what it pulls, without its damper
    double stretch = 0;              // of a joint, at the start
    double size = 1;                 // m or rad: its length
    double force = 0, loss = 0;      // against the stretch; J, in the damper
    double stored = 0;               // J, at the end, and half of what its damper takes
    double stiff = 0, sideways = 0;  // what a rate along and across changes of the force
  };
  struct Assembly {
    Response response;
    std::pmr::vector<int> nodes;
  };
  struct Part {  // what springs and joints connect
    explicit Part(std::pmr::memory_resource* memory) : nodes(memory), rows(memory), assemblies(memory) {}
    std::pmr::vector<int> nodes;
    std::pmr::vector<Row*> rows;
    std::pmr::vector<const Assembly*> assemblies;
  };
  using Vectors = std::pmr::vector<Vector3>;  // by node of a part
  /// What a row that depends on the path makes of changes of the path.
  struct Coupling {
    int at[2];  // nodes of the part; -1: none
    double stiff, sideways;
    Vector3 along[2], across[2];
  };

  int node_of(FlatBody* flat);
  End end_of(BodyIndex body, const Vector3& own, Vector2& point);
  Node& node(int i) { return nodes_[static_cast<std::size_t>(i)]; }
  const Node& node(int i) const { return nodes_[static_cast<std::size_t>(i)]; }
  double share(int i) const { return node(i).flies ? dt_ / 2 : dt_; }
  int root_of(int i);
  void connect(int a, int b);

  // spring_rows.cpp: what a row pulls along a path
  double mobility(const End& end) const;
  void move_end(End& end, double h) const;
  void rotate_end(End& end, double h) const;
  void evaluate_spring(Row& row, double h);
  void evaluate_joint(Row& row);
  void evaluate_now(Row& row);
  void evaluate(const Part& part);
  static bool bends(const SpringDescription& is);
  static Elastic elastic_of(const SpringDescription& is, double length);
  void set_elastic(Row& row, double to);

  // spring_flight.cpp: which bodies fly, and the rules
  void sum_paces();
  bool may_fly(std::span<const BodyIndex> all) const;
  void find_assembly(FlatBody& flat);
  void choose_rules();
  void set_loads();

  // spring_paths.cpp: the path on which all agree
  void make_parts();
  void take_part(const Part& part);
  void mobile(const Part& part, const Vectors& loads, Vectors& out) const;
  void add_pulls(const Part& part, double sign, Vectors& out) const;
  void set_residual(const Part& part);
  void linearize(const Part& part);
  void times_inertia(const Vectors& x, Vectors& out) const;
  void multiply(const Vectors& x, Vectors& out) const;
  void precondition(const Part& part, const Vectors& x, Vectors& out) const;
  void find_step(const Part& part);
  double merit(const Part& part) const;
  double wrong(const Part& part, const Vectors& residual);
  void start_path(const Part& part);
  bool find_path(const Part& part, bool lands);
  void land(const Part& part);
  void give(const Part& part);
  void give(Row& row);

  Planar::Core& core_;
  double dt_ = 0;
  std::pmr::vector<Node> nodes_;
  std::pmr::vector<Row> rows_;
  std::pmr::vector<int> node_of_;  // by slot
  std::pmr::list<Assembly> assemblies_;
  std::pmr::vector<Part> parts_;
  std::size_t part_count_ = 0;     // of them are used
  std::pmr::vector<int> part_of_;  // by node that stands for others
  std::uint64_t looks_ = 0;        // at rows
  // The part that is solved, by its nodes and rows.
  Vectors inertias_;
  std::pmr::vector<double> shares_;
  std::pmr::vector<Coupling> couplings_;
  Vectors residual_, tolerance_, diagonal_, step_, left_, ahead_, way_, pushed_, scratch_;
};

}  // namespace breve
