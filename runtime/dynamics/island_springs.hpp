// Contacts that are springs: when slow surfaces become so, which of their points are followed through a sub-step, and
// when they are rigid again. A pair with restitution that comes slower than its threshold is caught so, instead of
// being stopped dead: the speed after a contact does not jump where the approach becomes slow.
#pragma once

#include <memory>

#include "runtime/dynamics/island_contacts.hpp"

namespace breve::island {

struct SprungPoint;
class SprungMotion;

class ContactSprings {
 public:
  ContactSprings(State& state, Contacts& contacts);
  ~ContactSprings();

  void clear();
  /// Takes the points of pairs that are springs out of the touches into those that are followed.
  void take();
  void hold_limits(double h);
  bool move() const;  // some push: smooth() is the motion of the island
  /// @return  the work of scripts on free bodies, J
  double smooth(double time, double h);
  void commit();  // the last smooth() counts
  /// After a sub-step that counts: what its springs lost, and what they remember.
  void keep();
  void note_forces();

  // Points that are followed.
  std::size_t points() const;
  /// A point that was open as the sub-step of h seconds began closed in it: it is to push from that moment on.
  /// @param time  set to a guess of that moment, s since the sub-step began
  bool closes(std::size_t point, double h, double& time);
  std::size_t pair_of(std::size_t point) const;
  double gap_of(std::size_t point, double& rate);

 private:
  double effective_mass(const NearPair& pair, const Vector3& point, const Vector3& normal) const;
  void begin_spring(NearPair& pair, const Touch& touch);
  void end_spring(NearPair& pair);
  void add_point(const NearPair& pair, const Touch& touch);
  void hand_on(const NearPair& pair, std::span<SprungPoint> points);

  State& state_;
  Contacts& contacts_;
  std::unique_ptr<SprungMotion> motion_;     // made when it is first needed
  std::pmr::vector<std::uint8_t> followed_;  // of pairs: a spring with points
  double calibrated_ = -1;                   // the ratio of damping that gave
  contact::Dashpots dashpots_;
};

}  // namespace breve::island
