// Smooth motion of bodies that springs connect and that move as points: to contacts, impacts and the books they are
// like free bodies, and outside of the step they are trees like everything that springs connect.
#pragma once

#include "runtime/dynamics/island_state.hpp"

namespace breve::island {

class Networks {
 public:
  explicit Networks(State& state) : state_(state) {}

  /// @param work  J, of scripts: grows
  void move(double time, double h, double& work);
  /// After the rows were solved: dampers also pulled along the motion that the rows' impulses added.
  void correct_drag();
  double loss() const { return loss_; }  // J, in dampers in the last motion

 private:
  State& state_;
  double loss_ = 0;
};

}  // namespace breve::island
