// Joints that close loops: held closed by the stages of an integrator, by impulses at both ends of smooth motion, or by
// a projection of positions after it.
#pragma once

#include "runtime/dynamics/island_positions.hpp"
#include "runtime/dynamics/island_smooth.hpp"

namespace breve::island {

class Loops {
 public:
  Loops(State& state, Contacts& contacts, Rows& rows, Positions& positions, SmoothMotion& smooth)
      : state_(state), contacts_(contacts), rows_(rows), positions_(positions), smooth_(smooth) {}

  /// Schemes of order 4 and 5 hold loops inside their stages; others by hold(), a rule of order 2.
  bool in_stages() const;
  /// Smooth motion of h seconds that leaves the loops closed, where no other rows are.
  /// @return  false if none was found: near a position in which a loop may fold either way
  bool hold(double time, double h);
  void close();

 private:
  double read_errors();

  State& state_;
  Contacts& contacts_;
  Rows& rows_;
  Positions& positions_;
  SmoothMotion& smooth_;
};

}  // namespace breve::island
