// A cluster of bodies without joints that springs connect: the same equations as of any cluster, with
// nothing in them that only joints need. Bodies are numbered as the cluster's trees are.
#pragma once

#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/articulated/state.hpp"
#include "runtime/base/memory.hpp"
#include "runtime/dynamics/core.hpp"

namespace breve {

class SpringNetwork : public InMemory {
 public:
  /// Whether these are bodies without joints.
  static bool are(std::span<Tree* const> trees);

  /// @param trees  they are, and outlive it
  SpringNetwork(std::pmr::memory_resource* memory, std::span<Tree* const> trees) : bodies_(memory), edges_(memory) {
    bodies_.reserve(trees.size());
    for (Tree* tree : trees) bodies_.push_back({tree, {}});
  }
  /// @param a, b  numbers of the bodies at its ends; -1: one that the cluster does not move
  void add(SpringIndex spring, int a, int b) { edges_.push_back({spring, a, b}); }
  /// Reads what springs are set to, and where on the bodies they end. Call before each step, and after scripts ran.
  void begin(const Dynamics::Core& core);

  struct Powers {
    double script = 0, drag = 0;  // W, of the forces that scripts set, and in the springs' dampers
  };
  /// Accelerations `a` at positions `q` and velocities `v`, all of the cluster; the springs' forces are noted.
  Powers accelerate(Dynamics::Core& core, const articulated::Vector& q, const articulated::Vector& v,
                    articulated::Vector& a);
  /// Gives the springs their forces of the last stage, which scripts may ask for.
  void note_forces(Dynamics::Core& core) const;
  /// J, of all springs; the trees' links are placed.
  double spring_energy(const Dynamics::Core& core) const;

 private:
  /// Where a body is at a stage, in world axes, and what acts on it.
  struct Stage {
    Matrix3 rotation = Matrix3::Identity();
    Vector3 origin = Vector3::Zero(), velocity = Vector3::Zero();  // of its link's frame
    Vector3 spin = Vector3::Zero();
    Vector3 arm = Vector3::Zero();                              // from there to the centre of mass
    Vector3 force = Vector3::Zero(), couple = Vector3::Zero();  // about the centre of mass
  };
  struct Node {
    Tree* tree;
    Stage stage;
  };
  struct Edge {
    SpringIndex spring;
    int a, b;
    // As the step began.
    bool plain = false;  // it ends at the origins of two links, pulls and pushes, and has no bound
    Vector3 own_a = Vector3::Zero(), own_b = Vector3::Zero();  // its ends, from these origins, in the bodies' axes
    double length = 0, strength = 0, damping = 0;
    double force = 0;  // N, at the last stage
  };
  struct End {
    Vector3 point, velocity;
  };

  static void place(const Node& body, const double* q, const double* v, Stage& stage);
  End end_of(const Dynamics::Core& core, int number, BodyIndex body, const Vector3& point, const Vector3& own) const;
  Vector3 point_of(const Dynamics::Core& core, int number, BodyIndex body, const Vector3& point,
                   const Vector3& own) const;
  void push(int number, const Vector3& force, const Vector3& point);
  void pull(Edge& edge, Powers& powers);
  void pull(const Dynamics::Core& core, Edge& edge, Powers& powers);
  static void answer(const Node& body, const Vector3& gravity, const double* v, double* a);

  std::pmr::vector<Node> bodies_;
  std::pmr::vector<Edge> edges_;
  bool pulled_ = false;  // since the step began
};

}  // namespace breve
