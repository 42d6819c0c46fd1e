// Smooth motion of an island some of whose contacts are springs: free bodies and clusters as one system for an
// integrator, with the springs' stretches and what was lost in them as further coordinates.
#pragma once

#include <memory>
#include <optional>

#include "runtime/articulated/integrator.hpp"
#include "runtime/dynamics/island_state.hpp"

namespace breve::island {

/// A point of a pair whose surfaces are springs, as it is followed through one sub-step. The features that touch at its
/// start are followed, so that nothing jumps between stages; a round body is asked for its closest point.
struct SprungPoint {
  std::uint32_t pair = 0, feature = 0;
  bool round = false;   // one body is a sphere, the other has no neighbouring faces to choose from
  bool with_a = false;  // the normal rotates with a; else with b
  double apart = 0;     // m, as the sub-step began: until it is closed, which is an event, the point does not push
  bool slides = false;  // as the sub-step began: then friction has the dynamic coefficient all along
  Vector3 on_a = Vector3::Zero(), on_b = Vector3::Zero();  // in the frames of the bodies, m
  Vector3 normal = Vector3::Zero(), tangent = Vector3::Zero();
  double skin = 0;                    // m: the gap at which it begins to push, so that one that has just met pushes
  double radius = 0;                  // m, of a sphere whose centre stands in for its point
  contact::Spring spring;             // with one coefficient of friction
  Vector3 stretch = Vector3::Zero();  // m, world axes, as the sub-step began: it may begin again

  // At the state that was asked for last, world axes.
  Matrix3 axes = Matrix3::Zero();                        // rows: normal, from b toward a, and tangents
  Vector3 at = Vector3::Zero(), slip = Vector3::Zero();  // where it pushes; velocity of a less that of b, along `axes`
  Vector3 force = Vector3::Zero();                       // N, on a
  Vector3 stretched = Vector3::Zero();                   // m
  double gap = 0;                                        // m
  double stored = 0;                                     // J
  bool slips = false;                                    // its friction gives way
};

class SprungMotion final : public articulated::System, public InMemory {
 public:
  explicit SprungMotion(State& state)
      : points(state.memory), state_(state), kinds_(state.memory), pushes_(state.memory), parts_(state.memory) {}

  std::pmr::vector<SprungPoint> points;  // of the sub-step

  /// Moves the island by h seconds. Error{Numeric} leaves it as it was.
  void step(double time, double h);
  /// Sets of all points what depends on the island's state, which is that after the last step.
  void look();
  /// The gap of a point at the island's state, m, and its rate, m/s.
  double gap_of(std::size_t point, double& rate);
  // What the last step lost: all, with the work of scripts on free bodies; and what left a tree through its contacts.
  Energy lost() const;
  Energy lost(const Tree& tree) const;

  // --- System
  int positions() const override { return nq_; }
  int velocities() const override { return nv_; }
  articulated::Kind kind(int velocity) const override { return kinds_[static_cast<std::size_t>(velocity)]; }
  void acceleration(double t, const articulated::Vector& q, const articulated::Vector& v, double step,
                    articulated::Vector& a) override;
  std::uint64_t piece() const override { return piece_; }
  void move(const articulated::Vector& q, const articulated::Vector& d, articulated::Vector& out) override;
  void rate_of_move(const articulated::Vector& d, const articulated::Vector& v, articulated::Vector& out) override;
  void bend_to_cayley(articulated::Vector& d) override;

 private:
  // A free body has: position of its centre and quaternion; velocity in the world and spin in its own axes.
  static constexpr int kFreePositions = 7, kFreeSpeeds = 6;
  // After the bodies' own: two stretches a point; then losses of springs, of friction and the work of scripts; then for
  // each tree what it lost to springs, to friction and to limits that are held.
  static constexpr int kWorks = 3, kTreeWorks = 3;
  struct Resistance {
    contact::Press press;
    contact::Drag drag;
  };

  struct Part {  // what a cluster is given and gives
    articulated::Vector q, v, a, out;
  };

  void lay_out();
  void read(articulated::Instant& at);
  void write(const articulated::Instant& at);
  void place(const articulated::Vector& q, const articulated::Vector& v);
  void follow(SprungPoint& point) const;
  Resistance resist(SprungPoint& point, const contact::Vector2& stretch) const;
  void push(const SprungPoint& point, articulated::Vector& a);
  template <class OfFree, class OfCluster>
  void each(const OfFree& of_free, const OfCluster& of_cluster);
  double stretch_unit() const;
  int stretch_at(std::size_t point) const { return bodies_v_ + 2 * static_cast<int>(point); }
  int works_at() const { return stretch_at(room_); }
  int tree_works_at(int slot) const { return works_at() + kWorks + kTreeWorks * slot; }

  State& state_;
  std::pmr::vector<articulated::Kind> kinds_;
  std::pmr::vector<articulated::Wrench> pushes_;  // on free bodies
  std::pmr::vector<Part> parts_;                  // of clusters
  int nq_ = 0, nv_ = 0, bodies_v_ = 0;
  std::size_t room_ = 0;     // points that there are coordinates for: more than needed, so that a step takes no memory
  std::uint64_t piece_ = 0;  // of the points that press and of those that slip
  double mass_ = 1;          // kg: works are kept per kg, so that step control sees numbers of ordinary size
  articulated::Instant start_, end_;
  std::optional<Reservation> reserved_;
  std::optional<articulated::Integrator> integrator_;
  articulated::Scheme scheme_{};
  double tolerance_ = 0;
};

}  // namespace breve::island
