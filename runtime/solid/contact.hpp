// Where two solids are closest, how deep they overlap, and when two moving solids first touch.
#pragma once

#include <atomic>
#include <cstdint>

#include "runtime/base/math.hpp"
#include "runtime/solid/shape.hpp"
#include "runtime/solid/surface.hpp"

namespace breve {

struct Pose {
  Vector3 location = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
};

/// Rigid motion from `start` at constant velocity; the body rotates about its origin at constant rate. World frame.
struct Motion {
  Pose start;
  Vector3 velocity = Vector3::Zero();
  Vector3 rotational_velocity_world = Vector3::Zero();  // rad/s
};

/// `normal` has unit length and points from b toward a. `distance` < 0 is the depth of the overlap: the shortest way
/// along which b can be moved out of a, along -normal. `point` is midway between the two closest (or deepest) points.
struct Contact {
  Vector3 point;
  Vector3 normal;
  double distance;
};

/// What the narrow phase did, for tests and reports.
struct NarrowCounters {
  std::uint64_t pairs = 0;                  // asked for and not told apart by the spheres around them
  std::uint64_t warm = 0;                   // started from what the pair remembered
  std::uint64_t separate = 0;               // decided by the remembered axis alone
  std::uint64_t facets = 0;                 // of surfaces, visited
  std::uint64_t boxes = 0;                  // about facets, looked at to find these
  const std::atomic<bool>* stop = nullptr;  // true: facets are searched no further, since nobody asks for them any more

  bool stopped() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
  void add(const FacetCounters& search) {
    facets += search.facets;
    boxes += search.boxes;
  }
};

/// Closest or deepest points of two solids. Spheres in closed form, polyhedra exact to round-off.
/// Sources: Gilbert, Johnson, Keerthi 1988 (distance); Gottschalk 1996 and Gregorius 2013 (separating axes).
Contact closest(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb);

/// Are two solids at most `limit` apart (m; not positive: do they overlap by at least so much)? `contact` is then what
/// `closest` gives, and not written otherwise. Distant solids cost almost nothing, for every kind of surface.
/// @param counters  may be null
bool closest_within(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double limit, Contact& contact,
                    NarrowCounters* counters = nullptr);

/// The pose after `t` seconds; rotation by the exponential map, the orientation normalised.
Pose pose_at(const Motion& motion, double t);

/// The gap up to which two solids count as touching: what round-off at their places and sizes can hide.
double touch_tolerance(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb);

/// First touch of two solids that are apart at the start.
/// @param h        end of the interval, s
/// @param t        time of the first touch in (0, h]; written only if true is returned
/// @param contact  closest points at that time; written only if true is returned
/// @return         false if they do not touch within h, or touch or overlap already at the start (touch_tolerance)
/// Two spheres in closed form. Otherwise conservative advancement (Mirtich 1996) with bounds of second order: it never
/// steps over a touch that lasts longer than 1e-13 h; t is exact to 1e-10 h or to what a gap of 1e-14 of the sizes
/// means.
/// @param counters  may be null
bool time_of_impact(const Shape& a, const Motion& ma, const Shape& b, const Motion& mb, double h, double& t,
                    Contact& contact, NarrowCounters* counters = nullptr);

/// A cheap answer to whether that may be false: two convex solids that stay apart along one axis (unit, in the frame of
/// a, from b toward a; such as the one of PairCache) for all of [0, h]. Then time_of_impact finds nothing, and they are
/// apart at the end. False says nothing.
bool stay_apart(const Shape& a, const Motion& ma, const Shape& b, const Motion& mb, double h, const Vector3& axis);

}  // namespace breve
