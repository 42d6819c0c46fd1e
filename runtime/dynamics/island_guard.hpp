// The guard: a step of an island in which something goes wrong (island_watch and island_overlaps find what) is tried
// again more finely, and an island for which that does not help is put to rest. It reports everything that it does.
#pragma once

#include "runtime/dynamics/island_step.hpp"
#include "runtime/dynamics/island_watch.hpp"

namespace breve::island {

class Guard {
 public:
  Guard(State& state, Balance& balance, Books& books, Momentum& momentum, Credit& credit, Overlaps& overlaps,
        Handlers& handlers, Loops& loops, Step& step)
      : state_(state),
        balance_(balance),
        books_(books),
        momentum_(momentum),
        credit_(credit),
        overlaps_(overlaps),
        handlers_(handlers),
        loops_(loops),
        step_(step),
        watch_(state) {}

  void step(MechanicsClient* client, double start, double h);
  /// Puts the island to rest, h seconds after the step began: all velocities zero but momenta that are kept.
  void put_to_rest(Momenta momenta, double h);

 private:
  Trouble take(MechanicsClient* client, double start, double h);
  Trouble take_in_parts(MechanicsClient* client, double start, double h);
  int finest(const Trouble& trouble) const;
  bool astray() const;
  bool unpayable(double owed) const;
  void undo_rise(Rung rung, double start);
  void undo_rise_of_free_bodies(Rung rung);
  bool goes_back(const Trouble& trouble, bool undone) const;
  void give_in(const Trouble& trouble, bool undone, double start, double h);
  void stand_still();
  void forget_forces();

  State& state_;
  Balance& balance_;
  Books& books_;
  Momentum& momentum_;
  Credit& credit_;
  Overlaps& overlaps_;
  Handlers& handlers_;
  Loops& loops_;
  Step& step_;
  Watch watch_;
  // J, of the last try of a step; what is unexplained also has what rows gained, which is taken back.
  double residual_ = 0, unexplained_ = 0, allowed_ = 0;
  bool tried_finer_ = false;  // in this step
};

}  // namespace breve::island
