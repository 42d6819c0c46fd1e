// The engines beside which scenes are measured, one file for each. All get the same masses, shapes, friction,
// restitution, motors and gravity, and otherwise the settings that they come with; none lets bodies sleep.
#pragma once

#include <memory>

#include "tests/scenes/scene.hpp"

namespace breve::bench {

/// Bullet's world of rigid bodies in double precision: sequential impulses, 10 iterations. Joints are constraints.
std::unique_ptr<scenes::Side> make_bullet(const scenes::Scene& scene, double step);

/// Open Dynamics Engine in double precision: the quick step, 20 iterations, in a hash space.
std::unique_ptr<scenes::Side> make_ode(const scenes::Scene& scene, double step);

/// Box2D, of flat scenes: one step, 8 iterations for velocities and 3 for positions.
std::unique_ptr<scenes::Side> make_box2d(const scenes::Scene& scene, double step);

/// The force of a spring on its body `a`, N.
inline scenes::Vector3 spring_force(const scenes::Spring& spring, const scenes::Vector3& apart,
                                    const scenes::Vector3& apart_rate) {
  const double length = apart.norm();
  const scenes::Vector3 along = apart / length;
  return (spring.stiffness * (length - spring.length) + spring.damping * along.dot(apart_rate)) * along;
}

}  // namespace breve::bench
