// The contacts and joint limits of an island that are near: what one look at its pairs and joints finds, and which of
// that rests, so that it becomes a row, or is an impact to be located.
#pragma once

#include <array>

#include "runtime/dynamics/carried_point.hpp"
#include "runtime/dynamics/island_state.hpp"

namespace breve::island {

inline constexpr double kSeen = 1e-6;       // rad, or of the radius: closer is not looked at where contacts act
inline constexpr double kRoundOff = 1e-13;  // likewise, else; of the length unit

/// What a pair is in this sub-step: its impact is looked for on the whole path; or only whether it comes back; or it
/// has rows; or it is a spring.
enum class Role : std::uint8_t { Far, Leaves, Rests, Springs };

/// A point that touches, or nearly, as rows see it.
struct Touch {
  std::uint32_t pair = 0;
  std::uint32_t feature = 0;
  Vector3 point, normal;                                               // world, of its row; the normal from b toward a
  Vector3 start;                                                       // the point, as the sub-step began
  Pose from_a, from_b;                                                 // of the bodies then
  Vector3 velocity_a = Vector3::Zero(), velocity_b = Vector3::Zero();  // of the bodies there, as the sub-step began
  double gap = 0;                                                      // m, at the start of the sub-step
  double approach = 0;  // m/s, v_n when the sub-step began; unknown where a look takes the point at any speed
  bool far = false;     // touches only if the bodies rotate toward it, and says nothing of whether the pair rests
  bool turned = false;  // other forces turn the bodies back before they touch
  Vector3 predicted = Vector3::Zero();  // N, world axes: a force that is taken to go on and acts inside the stages
};

/// A joint's limit that is near, or was passed.
struct Bound {
  JointIndex joint;
  int axis;
  double sign;        // the gap grows with sign * position
  double limit;       // the position, m or rad
  double gap;         // m or rad
  double rate;        // of the gap when the sub-step began
  double unit;        // of the gap: 1 rad, or the world's length unit
  double slow;        // slower than this it is caught by a row, and does not strike
  bool rests;         // it is a row; else it is to be located
  bool held = false;  // it acts inside the stages, and is not located
};

/// When a joint left its limit, or one body another, s, and how fast.
struct Rebound {
  double time = 0, rate = JointDrive::kNoLimit;
  bool stays = false;  // it was back at once: for the remainder of the step it rests where it is near
};

class Contacts {
 public:
  explicit Contacts(State& state);

  /// Begins a step: nothing is known to be near, nothing has rebounded.
  /// @param awaited  handlers are called at the moment of impact
  void begin(bool awaited);
  /// Forgets what touches; roles of pairs and rebounds stay.
  void clear();
  /// @param speculative  no impact is located any more: rows are to stop whatever comes within h seconds
  void find_touches(double h, bool speculative);
  void find_touches_now();
  /// Where the nearest points of a pair approach and none of its points that touch do: those of facets in one patch
  /// have one normal, which is not that of each facet. The nearest points are then also a touch.
  void add_nearest(std::size_t pair);
  /// After a sub-step of h seconds that was looked at speculatively, with the links placed: makes contacts of points
  /// that overlap and that no row held apart. A body that is struck may come down elsewhere, where nothing approached.
  /// @return  whether there are some
  bool find_missed(double h);
  void find_bounds();
  /// Limits without a row that joints have passed, by more than `far` units, become rows.
  /// @return  whether there are some
  bool find_passed(double far);
  /// @param struck  what touches has collided already: what still approaches then is stopped by rows
  void find_roles(double h, bool struck);
  void forget_rebounds();

  /// Something touches that approaches so fast that it collides at once.
  bool strikes(double h) const;
  /// Known before rows are made: whether there will be some beside those of loops.
  bool any() const;
  /// Impulses of contacts are taken as constant over a sub-step: where some act, more digits are not seen.
  bool coarse() const;
  /// How far from zero the gap may be at the moment of an impact: m of a pair, or units of a joint.
  double closeness() const { return coarse() ? kSeen : kRoundOff; }
  double closeness(const NearPair& pair) const {
    return coarse() ? kSeen * state_.size_of_pair(pair) : kRoundOff * state_.unit();
  }
  double met_limit() const;
  const WarmPoint* warm_of(const Touch& touch) const;

  std::pmr::vector<Touch>& touches() { return touches_; }
  const std::pmr::vector<Touch>& touches() const { return touches_; }
  std::pmr::vector<Bound>& bounds() { return bounds_; }
  const std::pmr::vector<Bound>& bounds() const { return bounds_; }
  NearPair& pair_of(const Touch& touch) const { return *state_.pairs[touch.pair]; }
  Role role(std::size_t pair) const { return roles_[pair]; }
  double depth(std::size_t pair) const { return depths_[pair]; }  // m, of overlap when the sub-step began
  Rebound& rebound_of(std::size_t bound) { return rebounds_[bound]; }
  Rebound& rebound_of_pair(std::size_t pair) { return pair_rebounds_[pair]; }
  Rebound& rebound_of(const Touch& touch) { return pair_rebounds_[touch.pair]; }
  const Rebound& rebound_of(const Touch& touch) const { return pair_rebounds_[touch.pair]; }
  /// m/s: slower than this is at rest, in a sub-step of this length.
  double resting() const { return resting_; }
  /// rad/s, by which the spin of a body that is rotated by hand may be wrong.
  double unseen_spin(const Free& one) const;
  /// No impact is located any more: the last look was speculative.
  bool spent() const { return spent_; }

 private:
  /// Speeds of a pair, m/s, that separate impacts from what the rows of a sub-step do.
  struct Speeds {
    double slow;    // approaching or leaving slower than this rests
    double strike;  // what touches and approaches faster collides at once
  };
  Speeds speeds_of(const contact::Law& law, double size, double h) const;
  /// A body as a speculative look found it.
  struct Seen {
    Pose pose;
    Vector3 velocity, spin;  // m/s, at the pose's location, and rad/s

    Vector3 velocity_at(const Vector3& point) const { return velocity + spin.cross(point - pose.location); }
  };
  void note_seen(bool speculative);
  Seen seen(BodyIndex body) const;
  bool deflected(const std::array<Seen, 2>& before, const NearPair& pair, double h) const;
  std::pmr::vector<Touch>::const_iterator end_of(std::size_t pair) const;
  bool add_missed(std::size_t pair, const Manifold& manifold, const ContactPoint& point);
  double falling(const JointEntry& joint) const;

  State& state_;
  std::pmr::vector<Touch> touches_;
  std::pmr::vector<Bound> bounds_;           // in the order of trees, links, axes and ends
  std::pmr::vector<Rebound> rebounds_;       // of bounds_: the last of each in this step
  std::pmr::vector<Rebound> pair_rebounds_;  // likewise, of pairs
  std::pmr::vector<Role> roles_;             // of pairs
  std::pmr::vector<double> depths_;          // of pairs
  std::pmr::vector<Manifold> manifolds_;
  std::pmr::vector<std::array<Seen, 2>> seen_;  // of pairs, at a speculative look at trees
  double resting_ = 0;                          // m/s
  double looked_h_ = 0;                         // s, of the sub-step that was looked at last
  bool awaited_ = false;
  bool spent_ = false;
};

}  // namespace breve::island
