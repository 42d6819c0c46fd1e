// Contact springs: touching surfaces as springs with dampers, for low speeds on the rungs that step through a contact.
// As functions of the state alone, so that they may be used inside the stages of an integrator.
#pragma once

#include "runtime/base/math.hpp"
#include "runtime/contact/law.hpp"

namespace breve::contact {

using Vector2 = Eigen::Vector2d;

/// Damping ratios while the surfaces approach and while they part.
struct Dashpots {
  double in = 0, out = 0;
};

/// Surfaces push and never pull, so a linear damper, cut off where it would pull, gives another rebound than the linear
/// oscillator of its damping ratio. These two ratios give the oscillator's back, exactly: rebound exp(-pi zeta / s) and
/// duration pi / (s w), with s^2 = 1 - zeta^2, w^2 = k / m.
/// @param zeta  0..0.9; what is outside is brought there
Dashpots calibrate(double zeta);

/// The ratio that gives a rebound of `restitution`, 0..1; at most 0.9, whose rebound is 0.0015.
double damping_ratio(double restitution);

struct Spring {
  double stiffness = 0;                              // normal, N/m
  double in = 0, out = 0;                            // dampers, N*s/m
  double tangential_stiffness = 0;                   // N/m
  double tangential_damping = 0;                     // N*s/m, > 0
  double static_friction = 0, dynamic_friction = 0;  // coefficients
  double linear_depth = 0;                           // m: deeper, the normal spring hardens; 0: it never does
  double damped_depth = 0;  // m: dampers act in proportion to the depth until here, so that no force jumps; 0: at once
};

/// @param mass  what an impulse along the normal moves: 1 / (n . W n), kg
/// Tangentially everything is 2/7 of normal: a solid sphere then rocks as fast along the surface as against it. There
/// the damper is never less than a twentieth of critical.
Spring make_spring(double stiffness, const Dashpots& dashpots, double mass, const Law& law);

/// What the normal spring does.
struct Press {
  double force = 0;   // N, >= 0, on a along the normal
  double stored = 0;  // J
  double loss = 0;    // W, >= 0: d(stored)/dt = -force * gap_rate - loss
};

/// @param gap       m; < 0: the surfaces overlap
/// @param gap_rate  m/s
Press press(const Spring& spring, double gap, double gap_rate);

/// What the tangential spring does.
struct Drag {
  Vector2 force = Vector2::Zero();         // N on a, along (t1, t2); within the cone of the normal force
  Vector2 stretch_rate = Vector2::Zero();  // m/s: the stretch is a state of the integration; zero when contact begins
  double stored = 0;                       // J
  double loss = 0;                         // W, >= 0: d(stored)/dt = -force . slip - loss
  bool slides = false;                     // the slider gives way
};

/// A spring and a damper side by side, held by a slider that gives way where their force would leave the cone.
/// @param stretch  of the spring, m
/// @param slip     velocity of a's point less that of b's along (t1, t2), m/s
Drag drag(const Spring& spring, const Vector2& stretch, const Vector2& slip, double normal_force);

}  // namespace breve::contact
