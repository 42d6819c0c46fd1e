// A script's handler of an impact, called in the middle of a step: the arrays get the island as it stands, and the
// island gets what the handler changed.
#pragma once

#include "runtime/dynamics/island_arrays.hpp"
#include "runtime/dynamics/island_balance.hpp"

namespace breve::island {

class Handlers {
 public:
  Handlers(State& state, Arrays& arrays, Balance& balance) : state_(state), arrays_(arrays), balance_(balance) {}

  void clear();
  bool call(MechanicsClient& client, NearPair& pair, double moment, double left);
  /// A handler made or freed bodies or joints: what the island refers to may be gone.
  bool dissolved() const { return dissolved_; }
  double unfinished() const { return unfinished_; }  // s, of the step, then

 private:
  void end_unfinished(double held);

  State& state_;
  Arrays& arrays_;
  Balance& balance_;
  bool dissolved_ = false;
  double unfinished_ = 0;
};

}  // namespace breve::island
