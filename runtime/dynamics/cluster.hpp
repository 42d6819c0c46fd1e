// Trees that springs connect, as one system for an integrator: joint coordinates of all, and as further
// coordinates the works that the energy ledger keeps, so that they are integrated by the same stages as the motion.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/integrator.hpp"
#include "runtime/base/meter.hpp"
#include "runtime/dynamics/tree.hpp"
#include "runtime/mechanics/accuracy.hpp"

namespace breve {

/// What the forces of a cluster depend on beside its own numbers; asked at every stage.
class StageForces {
 public:
  virtual ~StageForces() = default;
  /// Sets what depends on the trees' states, which are the stage's: motors' speeds, forces of joints that rotate with
  /// them.
  virtual void aim() = 0;
  /// True if add() has something to do: the trees' links must then be placed.
  virtual bool adds() const = 0;
  /// Forces that go with the way of the trees' links are among these.
  virtual bool pulls() const = 0;
  /// Adds what springs, contacts and scripts do to wrenches of the trees' links, which stand where the stage is if
  /// adds() says so.
  virtual void add(double time) = 0;
  /// Adds what holds loops closed and joints within limits to the accelerations (nv) of a tree that has some, after its
  /// forward dynamics. Returns the units of work that it took.
  virtual std::uint64_t constrain(Tree& tree, double* acceleration) = 0;
  /// Where nothing acts that needs links to be placed, and all trees are single bodies: their accelerations (nv), at q
  /// and v of the cluster. Else nothing.
  /// @return  whether it did
  virtual bool accelerate(const articulated::Vector& q, const articulated::Vector& v, articulated::Vector& a) = 0;
  /// Power of scripts' forces, of dampers and of predicted contacts among these, W; after add() or accelerate().
  virtual double script_power() const = 0;
  virtual double drag_power() const = 0;
  virtual double reaction_power() const = 0;
};

class Cluster final : public articulated::System, public InMemory {
 public:
  /// `trees` outlive the cluster. It takes its state from them and gives it back.
  /// @param unit   the world's length unit, m: errors of lengths are measured by it
  /// @param asked  force methods push its trees: see received()
  Cluster(std::pmr::memory_resource* memory, std::span<Tree* const> trees, const Accuracy& accuracy, double unit,
          bool asked);

  std::span<Tree* const> trees() const { return trees_; }
  const Accuracy& accuracy() const { return accuracy_; }
  void set_accuracy(const Accuracy& accuracy);  // makes another integrator
  /// Semi-implicit Euler as the rung `fast` has it, not as a setting of its own: a finer scheme may stand in for it.
  bool can_be_finer() const { return finer_.has_value(); }
  /// If it can be: the following steps are Runge-Kutta 4's, or its own again.
  void set_finer(bool on);

  /// Call after the loads of the trees were set and before the first step() that uses them.
  /// @param meter  counts the evaluations of the following steps; outlives them
  void begin(StageForces* forces, Meter& meter);
  /// Moves the trees' states from `time` by h seconds, without contacts. Error{Numeric} leaves them as they were.
  void step(double time, double h);
  // The same by another's integrator, of a larger system that this one is part of.
  void read(articulated::Vector& q, articulated::Vector& v) const;         // the trees' states; works are zero
  void write(const articulated::Vector& q, const articulated::Vector& v);  // likewise, and what the step took
  void place(const articulated::Vector& q, const articulated::Vector& v);  // trees and their links: a stage

  // The last step: how many steps it took, and its works.
  const articulated::StepCount& count() const { return (finer_now_ ? finer_ : integrator_)->count(); }
  double motor_work() const { return works_[0]; }     // J
  double script_work() const { return works_[1]; }    // J, of forces on joints and bodies
  double drag_loss() const { return works_[2]; }      // J
  double reaction_work() const { return works_[3]; }  // J, of the trees' Loads::reaction
  /// Trees with joints that nothing but forces on their links holds, if force methods push them: what these forces gave
  /// each of them in the last step, integrated by the same stages.
  struct Received {
    Tree* tree;
    Vector3 impulse = Vector3::Zero();  // N*s
    Vector3 way = Vector3::Zero();      // m, of the centre of mass
    Vector3 spin = Vector3::Zero();     // N*m*s, about the centre of mass
  };
  std::span<const Received> received() const { return received_; }
  double next_step() const { return at_.step; }
  void set_next_step(double step) { at_.step = step; }
  /// How many times the tolerance step control may err by, until set anew.
  void set_slack(double slack) { at_.slack = slack; }
  /// A step that step control would give more evaluations fails; 0: any number is taken.
  void set_most_evaluations(int most) { most_evaluations_ = most; }

  // --- System
  int positions() const override { return nq_; }
  int velocities() const override { return received_at() + kReceived * static_cast<int>(received_.size()); }
  articulated::Kind kind(int velocity) const override { return kinds_[static_cast<std::size_t>(velocity)]; }
  bool sprung(int velocity) const override { return sprung_[static_cast<std::size_t>(velocity)] != 0; }
  void acceleration(double t, const articulated::Vector& q, const articulated::Vector& v, double step,
                    articulated::Vector& a) override;
  void move(const articulated::Vector& q, const articulated::Vector& d, articulated::Vector& out) override;
  void rate_of_move(const articulated::Vector& d, const articulated::Vector& v, articulated::Vector& out) override;
  void bend_to_cayley(articulated::Vector& d) override;
  bool over() const override {
    return (meter_ && meter_->over()) || (most_evaluations_ > 0 && evaluations_ >= most_evaluations_);
  }

 private:
  static constexpr int kWorks = 4, kReceived = 9;
  int received_at() const { return nv_ + kWorks + static_cast<int>(motors_.size()); }
  /// A number of v that a motor drives: its place in the whole vector, whose tree, and its place there.
  struct Motor {
    int place;
    std::size_t tree;
    int own;
  };
  struct Powers {
    double motor = 0, script = 0, drag = 0, reaction = 0;
  };
  void add_powers(const Tree& tree, double step, const double* v, const double* a, double* torques,
                  Powers& powers) const;
  void add_reaction(const Tree& tree, const double* v, const double* a, Powers& powers) const;
  void accelerate_trees(double t, const articulated::Vector& q, const articulated::Vector& v, double step,
                        articulated::Vector& a, Powers& powers);
  void add_received(const articulated::Vector& v, articulated::Vector& a) const;
  void take_received(const articulated::Vector& v);
  void make_integrators();
  bool semi_implicit() const { return accuracy_.scheme == articulated::Scheme::SemiImplicitEuler && !finer_now_; }
  void note_springs();
  void read_mean();
  void write_mean();
  void scatter(const articulated::Vector& q, const articulated::Vector& v);

  std::pmr::vector<Tree*> trees_;
  Accuracy accuracy_;
  double unit_;  // m
  bool finer_now_ = false;
  int nq_ = 0, nv_ = 0;
  double mass_ = 0;       // kg: works are kept per kg, so that step control sees numbers of ordinary size
  bool driven_ = false;   // some power may not be zero
  bool working_ = false;  // likewise, reactions included
  StageForces* forces_ = nullptr;
  Meter* meter_ = nullptr;
  std::uint64_t units_ = 0;  // of work, an evaluation
  std::pmr::vector<articulated::Kind> kinds_;
  std::pmr::vector<char> sprung_;        // (of v) springs pull along it
  std::pmr::vector<Motor> motors_;       // their impulses are further coordinates, after the works
  articulated::Vector torques_;          // (nv_) of motors, at the last stage
  std::pmr::vector<Received> received_;  // per kg these are further coordinates, after the motors' impulses
  std::array<double, kWorks> works_{};
  articulated::Instant at_;
  double current_step_ = 0;
  int evaluations_ = 0, most_evaluations_ = 0;  // of the current step
  articulated::MotorGuess guess_ = articulated::MotorGuess::None;
  std::optional<articulated::Integrator> integrator_;
  std::optional<articulated::Integrator> finer_;  // what stands in for semi-implicit Euler
};

}  // namespace breve
