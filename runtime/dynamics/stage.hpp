// The forces of one cluster at the stages of its integrator: motors that look at positions, springs between bodies,
// forces that scripts set or compute.
#pragma once

#include "runtime/dynamics/cluster.hpp"
#include "runtime/dynamics/core.hpp"

namespace breve {

class Stage final : public StageForces {
 public:
  /// @param client  asked for the forces of force methods; null: there are none
  Stage(Dynamics::Core& core, const ClusterEntry& cluster, MechanicsClient* client);

  bool needed() const { return needed_; }

  void aim() override;
  bool adds() const override;
  bool pulls() const override { return asked_ || pressed || !cluster_.springs.empty(); }
  void add(double time) override;
  bool accelerate(const articulated::Vector& q, const articulated::Vector& v, articulated::Vector& a) override;
  std::uint64_t constrain(Tree& tree, double* acceleration) override {
    if (!holds_loops && !pressed) return 0;
    return core_.hold(tree, acceleration, holds_loops, pressed);
  }
  bool holds_loops = false;  // else somebody else does
  bool pressed = false;      // contact springs act on its links
  double script_power() const override { return script_; }
  double drag_power() const override { return drag_; }
  double reaction_power() const override { return reaction_; }

 private:
  struct End {
    Tree* tree = nullptr;
    int link = -1;
    Vector3 point = Vector3::Zero(), velocity = Vector3::Zero();
  };
  End end_of(BodyIndex body, const Vector3& point) const;
  void show();
  void pull(SpringEntry& spring);

  Dynamics::Core& core_;
  const ClusterEntry& cluster_;
  MechanicsClient* client_;
  bool aims_ = false, pushed_ = false, asked_ = false, loops_ = false, braces_ = false, needed_ = false;
  double script_ = 0, drag_ = 0, reaction_ = 0;
};

}  // namespace breve
