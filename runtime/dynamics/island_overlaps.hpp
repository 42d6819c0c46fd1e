// Overlaps that grow: noted while the sub-steps are taken, measured when the step is over.
#pragma once

#include "runtime/dynamics/island_rows.hpp"

namespace breve::island {

class Overlaps {
 public:
  Overlaps(State& state, Rows& rows);

  void begin_try();
  void note(double h);
  Trouble measure();

 private:
  /// A pair that is deep, or may become so in this step.
  struct Overlap {
    std::uint32_t pair;
    double before;  // m, when it was noted
  };
  double fastest_approach() const;

  State& state_;
  Rows& rows_;
  std::pmr::vector<Overlap> overlaps_;
  std::pmr::vector<std::uint8_t> noted_;  // of pairs: it is one of these
};

}  // namespace breve::island
