// A set of bodies that may push one another within a step: what moves, which pairs are near, and the rows of contacts,
// limits and loops. Islands know nothing of one another, so that several may be stepped at once.
//
// The parts stand in the order in which they build on each other: each knows only parts above it.
#pragma once

#include <exception>

#include "runtime/dynamics/island_guard.hpp"

namespace breve {

class Island : public InMemory {
 public:
  Island(Dynamics::Core& core, std::pmr::memory_resource* memory);
  ~Island();

  // --- what belongs to it, set before a step
  void clear();
  void add_free(BodyIndex body) { state_.add_free(body); }
  /// If its bodies move as points for h seconds: they are like free bodies. After all of these.
  void add_network(ClusterEntry& cluster, double h) { state_.add_network(cluster, h); }
  void add_drivers(const NearPair& pair) { state_.add_drivers(pair); }  // after all free bodies: of each pair in turn
  void add_cluster(ClusterEntry& cluster) { state_.add_cluster(cluster); }  // after all free bodies
  void add_pair(NearPair& pair) { state_.pairs.push_back(&pair); }
  bool has_drivers() const { return state_.drivers > 0; }

  /// Moves it from `start` by h seconds; write() is to follow, but where it was dissolved. Touches nothing that
  /// is not the island's if there is no client: on any thread then.
  /// @param client  for handlers and force methods; then on the world's thread only
  void step(MechanicsClient* client, double start, double h);
  bool calls_out() const { return state_.calls_out(); }  // step() needs a client
  /// Work that step() may take, from now on; where it is used up, what is left of the step is finished coarsely.
  void bound_work(std::uint64_t most, const std::atomic<bool>* ended) { state_.meter.begin(most, ended); }
  std::size_t items() const;  // bodies and pairs, by which work is shared out
  std::uint64_t work() const { return state_.meter.done(); }
  const IslandResult& result() const { return state_.result; }
  /// A handler made or freed bodies or joints: what the island refers to may be gone.
  bool dissolved() const { return handlers_.dissolved(); }
  /// Seconds of the step that are left then.
  double unfinished() const { return handlers_.unfinished(); }
  void append_bodies(std::pmr::vector<BodyIndex>& out) const;
  /// Slow enough to sleep, all of it.
  bool still() const { return state_.still(); }
  void fall_asleep(double h) { guard_.put_to_rest(island::Momenta::Take, h); }  // h seconds after the step began
  void write() { arrays_.write(); }                                             // to the arrays

  std::exception_ptr error;  // that ended its step, where others are stepped at the same time

 private:
  island::State state_;
  island::Arrays arrays_;
  island::Balance balance_;
  island::Credit credit_;
  island::Handlers handlers_;
  island::Contacts contacts_;
  island::ContactSprings springs_;
  island::SmoothMotion smooth_;
  island::Rows rows_;
  island::Momentum momentum_;
  island::Books books_;
  island::Prediction prediction_;
  island::Solver solver_;
  island::Positions positions_;
  island::Loops loops_;
  island::Overlaps overlaps_;
  island::SubStep sub_step_;
  island::Impacts impacts_;
  island::Step step_;
  island::Guard guard_;
};

}  // namespace breve
