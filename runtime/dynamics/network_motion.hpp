// The motion of bodies that only springs between their centres of mass connect: no spring rotates a body, so
// that what moves is a set of points. Flat arrays of points and springs, gone through once for each evaluation of
// forces.
//
// Forces are those of the positions alone, in a symmetric scheme of order 4 with four evaluations (Omelyan, Mryglod and
// Folk 2002: position-extended Forest-Ruth-like) or, where the springs are slow beside the step, in the leapfrog scheme
// with one. Both are symplectic: energy errs by a bounded amount and does not drift. Dampers act in the middle of each
// part, pair by pair: each takes from the relative velocity of its ends exactly what it would take if it were alone, so
// that it is stable however strong it is, and what it takes of the energy is known (Shardlow 2003). All forces act in
// pairs: momentum is kept to round-off.
#pragma once

#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/memory.hpp"
#include "runtime/base/meter.hpp"
#include "runtime/dynamics/core.hpp"

namespace breve {

class NetworkMotion : public InMemory {
 public:
  /// @param trees  bodies without joints; they outlive it
  NetworkMotion(std::pmr::memory_resource* memory, std::span<Tree* const> trees);
  /// @param a, b  numbers of the bodies at its ends; -1: one that the cluster does not move
  void add(const Dynamics::Core& core, SpringIndex spring, int a, int b);

  /// Reads what the springs are set to. Call before each step, and after scripts ran.
  /// @param rung  `fast` takes longer parts where there are many springs
  /// @param h     s, that the step lasts
  /// @return      whether the points can follow: the springs act between centres of mass, pull and push without bound,
  ///              and are not too fast for the step; no body has a force method; ends outside the cluster stand still
  bool begin(const Dynamics::Core& core, Rung rung, double h);

  std::span<Tree* const> trees() const { return trees_; }
  /// Where a body is, and how fast it moves; in and out.
  struct Point {
    Vector3 center = Vector3::Zero(), velocity = Vector3::Zero();
    double inverse_mass = 0;  // 0: an end that does not move
  };
  Point& point(std::size_t body) { return points_[body]; }
  /// m/s^2, by all that does not depend on where bodies are.
  void set_pull(std::size_t body, const Vector3& pull) { pulls_[body] = pull; }

  /// Moves the points by h seconds. Springs that are too stiff for one part count as softer if `in_one`.
  /// @return  evaluations of the forces
  int step(double h, bool in_one, Meter& meter);
  double fastest() const { return fastest_; }  // rad/s: no oscillation is faster
  double loss() const { return loss_; }        // J, in the dampers, in the last step
  double swung() const { return swung_; }  // J, the most that the points moved with as a part of the last step ended
  /// N*s, of the dampers on a body, in the last step.
  const Vector3& drag(std::size_t body) const { return drags_[body]; }
  /// J, of the springs where the points are.
  double energy();
  /// Writes forces and energies to the springs, for callers that ask and for the books; after energy().
  void write(Dynamics::Core& core) const;

 private:
  struct Edge {
    int a, b;
    SpringIndex spring;
    double length, strength, damping;
    double yields;       // 1/kg, of both ends
    double share, loss;  // of the damper in a part: impulse by the relative velocity, energy by its square
    double force, drag;  // N, of the spring and of the damper when they acted last
    double stored;       // J
  };

  bool read(const Dynamics::Core& core);
  void set_part(double part);
  void drift(double time);
  void kick(double time, double scale);
  void damp(double part);
  double kinetic() const;

  std::pmr::vector<Tree*> trees_;
  std::pmr::vector<Point> points_;  // of the trees' bodies, then ends that do not move
  std::pmr::vector<Vector3> pulls_, drags_;
  std::pmr::vector<Edge> edges_;
  std::pmr::vector<std::pair<BodyIndex, Vector3>> still_;  // ends that do not move, in the bodies' frames
  std::uint64_t version_ = 0;                              // of the springs' settings, that was read
  bool plain_ = false, damped_ = false;
  double fastest_ = 0;     // rad/s: no oscillation is faster
  double most_phase_ = 1;  // rad, of that, in a part
  double part_ = 0;        // s, that shares were made for
  double loss_ = 0, swung_ = 0;
};

}  // namespace breve
