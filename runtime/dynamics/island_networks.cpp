// The motion of bodies that springs connect, as points.
#include "runtime/dynamics/island_networks.hpp"

#include <algorithm>

#include "runtime/dynamics/island_energy.hpp"
#include "runtime/dynamics/network_motion.hpp"

namespace breve::island {

void Networks::move(double time, double h, double& work) {
  loss_ = 0;
  double swung = 0;
  for (const NetworkCluster& one : state_.networks) {
    NetworkMotion& points = *one.entry->points;
    take_points(state_, one);
    for (std::size_t i = 0; i < points.trees().size(); ++i) {
      const FreeBody& body = state_.free_bodies[one.first + i].now;
      points.set_pull(i, state_.core.settings.gravity + body.force / body.solid->mass);
    }
    state_.result.counters.evaluations += static_cast<std::uint64_t>(points.step(h, state_.finished, state_.meter));
    loss_ += points.loss();
    swung += points.swung();
    for (std::size_t i = 0; i < points.trees().size(); ++i) {
      Free& free = state_.free_bodies[one.first + i];
      FreeBody& body = free.now;
      const Vector3 spin = body.spin;
      work += body.force.dot(points.point(i).center - body.center);
      body.center = points.point(i).center;
      body.velocity = points.point(i).velocity;
      rotate_free(body, state_.accuracy, time, h, free.next, state_.meter);
      work += 0.5 * h * body.torque.dot(spin + body.spin);
    }
  }
  state_.swung = std::max(state_.swung, swung);
}

/// Dampers also pulled along the motion that the rows' impulses added: half of the change of velocity, for the step.
void Networks::correct_drag() {
  for (const NetworkCluster& one : state_.networks)
    for (std::size_t i = 0; i < one.entry->points->trees().size(); ++i) {
      const Free& free = state_.free_bodies[one.first + i];
      const Vector3& drag = one.entry->points->drag(i);
      for (int k = 0; k < 3; ++k) loss_ -= 0.5 * drag[k] * (free.v[k] - free.free_v[k]);
    }
}

}  // namespace breve::island
