// The solution of an island's rows after smooth motion, and how it moves what it changed.
#pragma once

#include <optional>

#include "runtime/dynamics/island_predict.hpp"
#include "runtime/dynamics/island_rebound.hpp"

namespace breve::island {

class Solver {
 public:
  Solver(State& state, Contacts& contacts, Rows& rows, Momentum& momentum, Prediction& prediction)
      : state_(state),
        contacts_(contacts),
        rows_(rows),
        momentum_(momentum),
        prediction_(prediction),
        rebounds_(state, contacts, rows) {}

  /// Makes rows where smooth motion of h seconds has led to, where the trees are placed, and solves them.
  void solve_after(double h);
  /// Positions follow what the impulses changed, for so many seconds; before it, how much of that way trees may go.
  void limit_moves(double moved_h);
  /// @param smooth  J, of the island after smooth motion, where that is known
  void move_by_impulses(double moved_h, std::optional<double> smooth = std::nullopt);
  double direct_share() const;

 private:
  void begin(double h);
  double follow_arms(double h);
  void bound_motors(double h);
  bool shorten_couples(double h);
  bool stands() const;
  bool burdened() const;
  void find_struck();
  void solve_rows();
  void solve_once();
  void solve_rebounding(double h);
  void move_networks_back(double moved_h);
  double share_to_part(double moved_h) const;

  State& state_;
  Contacts& contacts_;
  Rows& rows_;
  Momentum& momentum_;
  Prediction& prediction_;
  Rebounds rebounds_;
};

}  // namespace breve::island
