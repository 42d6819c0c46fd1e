// Impacts of an island: which comes first in a sub-step and when, and what happens then.
#pragma once

#include "runtime/dynamics/island_handlers.hpp"
#include "runtime/dynamics/island_sub_step.hpp"

namespace breve::island {

/// The first event of a sub-step.
struct Event {
  double time = 0;                        // s after the start of the sub-step
  int pair = -1, bound = -1, point = -1;  // the last of a spring
  double depth = 0;      // m or rad, of overlap when the sub-step began: it is an event if it gets deeper
  double until = 0;      // s, likewise, when it is deepest, if that is over before the sub-step ends; 0: it is not
  bool at_once = false;  // it had not been seen before it happened, in the sub-step
  bool found() const { return pair >= 0 || bound >= 0 || point >= 0; }
};

class Impacts {
 public:
  Impacts(State& state, Contacts& contacts, ContactSprings& springs, Rows& rows, Solver& solver, Momentum& momentum,
          SubStep& sub_step, Handlers& handlers);

  /// As a sub-step begins: where the bodies of each pair are.
  void note_start();
  /// The event that seems to come first in the h seconds that the island has moved by.
  Event seek(double time, double h);
  /// Finds the moment of the event that comes first, not always that which seemed to, and moves the island there.
  void locate(double time, Event& event, double h);
  /// The moment of an event has come: calls the handler first, then applies the impulses.
  void meet(MechanicsClient* client, const Event& event, double moment, double left);
  /// Everything that touches now collides, whatever its speed.
  /// @param met  an event that has come, or none
  void collide(double time, const Event& met = {});

 private:
  // island_impacts.cpp
  void seek_pairs(double h);
  void seek_bounds(double h);
  void seek_closing(double h);
  bool touches_lightly(std::size_t pair, const Pose& a, const Pose& b, double h, Event& event) const;
  void check_light_touches(double time, double h, Event& first);
  const Bound* bound_of(const Event& event) const;  // null: not a joint's limit
  const NearPair& pair_of(const Event& event) const;
  double closeness(const Event& event) const;
  void refine(double time, Event& event, double h);
  bool is_past(const Event& event);
  double gap_of(const Event& event, double& rate);
  // island_collide.cpp
  void find_met(double time);
  void find_returned(double time);
  void note_rebounds(double time);
  void end_stall(const Event& met);
  void rebound(std::size_t bound, double time);
  void resolve();

  struct Poses {
    Pose a, b;
  };

  State& state_;
  Contacts& contacts_;
  ContactSprings& springs_;
  Rows& rows_;
  Solver& solver_;
  Momentum& momentum_;
  SubStep& sub_step_;
  Handlers& handlers_;
  std::pmr::vector<Poses> start_poses_;          // of each pair, as the sub-step began
  std::pmr::vector<Event> found_;                // in a sub-step, with times that are guesses
  std::pmr::vector<Event> light_;                // likewise, that a path may have which bends there and back
  std::pmr::vector<std::size_t> rebound_later_;  // of bounds
};

}  // namespace breve::island
