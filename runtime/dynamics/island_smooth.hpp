// Smooth motion of what an island holds: without impulses, by the integrators of the rung. On `fast` it is taken in as
// many parts as keep the energy.
#pragma once

#include "runtime/dynamics/island_networks.hpp"
#include "runtime/dynamics/island_springs.hpp"

namespace breve::island {

class SmoothMotion {
 public:
  SmoothMotion(State& state, Contacts& contacts, ContactSprings& springs)
      : state_(state), contacts_(contacts), springs_(springs), networks_(state) {}

  void move(double time, double h);
  /// After the rows of h seconds were solved, in the movers' v: the works of the last motion, corrected by what the
  /// rows' impulses changed.
  void correct_works(double h);
  /// J, that scripts gave free bodies in the last motion, less what dampers between these took.
  double free_works() const { return free_work_ - networks_.loss(); }
  void commit();  // the last motion counts: its works go to the ledger

 private:
  void move_cluster(Clustered& one, double time, double h);
  void move_once(Clustered& one, double time, double h);
  void move_whole(Clustered& one, double time, double h);
  void move_fast(Clustered& one, double time, double h);
  double gain_of(Clustered& one, double time, double h, int parts);

  State& state_;
  Contacts& contacts_;
  ContactSprings& springs_;
  Networks networks_;
  double free_work_ = 0;  // J, of scripts on free bodies in the last motion
};

}  // namespace breve::island
