// A shape asked from outside: where a ray meets it, and what of it is nearest to a point.
#pragma once

#include "runtime/solid/contact.hpp"

namespace breve {

struct RayHit {
  double fraction = 0;  // of the way
  Vector3 point = Vector3::Zero();
  Vector3 normal = Vector3::Zero();  // unit, of the surface there; against the way where the ray starts inside
};

/// First point of the solid on start + t way, t in [0, most], world frame. False on a miss, or where the way has length
/// 0 and starts outside; `hit` is then not written. @throws Error{Argument} for numbers that are not finite
bool meet_ray(const Shape& shape, const Pose& pose, const Vector3& start, const Vector3& way, double most, RayHit& hit);

/// The point of the solid's surface that is nearest to `point`, if it is not farther than `limit`, m. `found.point` is
/// that point, `found.normal` points from it to `point` (out of the solid, if that is inside), `found.distance` is < 0
/// inside. False if it is farther: `found` is then not written.
/// @param counters  may be null
bool nearest_to(const Shape& shape, const Pose& pose, const Vector3& point, double limit, Contact& found,
                NarrowCounters* counters = nullptr);

}  // namespace breve
