// Rebounds of what is not located in time: all at the end of a sub-step, with no more energy than there was.
#pragma once

#include "runtime/dynamics/island_rows.hpp"

namespace breve::island {

class Rebounds {
 public:
  Rebounds(State& state, Contacts& contacts, Rows& rows);

  bool find(double h);
  /// Velocities as they are without the rows' impulses.
  void note_free() { read_rates(free_rates_); }
  /// After the rows were solved without rebound: asks for it, from the velocities before.
  void ask();
  /// After they were solved with it, for a sub-step of h seconds.
  void settle(double h);

 private:
  void read_rates(std::pmr::vector<double>& rates) const;
  void read_impulses(std::pmr::vector<double>& impulses) const;
  double lifted(double share, double h) const;
  void mix(double share);

  State& state_;
  Contacts& contacts_;
  Rows& rows_;
  std::pmr::vector<double> speeds_;  // of rows, then of scalar rows: at which they are to part
  // Of rows but those of motors, three numbers a contact: velocities without impulses, without and with rebound.
  std::pmr::vector<double> free_rates_, plain_rates_, rates_, plain_impulses_, impulses_;
  std::pmr::vector<double> plain_scalars_;  // impulses of all scalar rows without rebound
};

}  // namespace breve::island
