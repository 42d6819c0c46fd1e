// The momenta of links are impulses on the tree at rest in its new pose.
#include "runtime/articulated/carried.hpp"

#include <cmath>

#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/kinematics.hpp"

namespace breve::articulated {

bool move_carried(const Model& model, Data& data, State& state, const Vector& way, double most,
                  std::pmr::vector<Impulse>& momenta) {
  forward_kinematics(model, data, state);
  const double before = kinetic_energy(model, data);
  momenta.clear();
  for (int i = 0; i < model.size(); ++i) {
    const Vector3 linear = model.body(i).mass * com_velocity(model, data, i);
    momenta.push_back({i, Vector3::Zero(), linear, own_momentum(model, data, i)});
  }
  move(model, state.q, way, state.q);
  forward_kinematics(model, data, state);
  if (kinetic_energy(model, data) <= (1 + most) * before) return false;
  for (Impulse& one : momenta) one.point = com_position(model, data, one.link);
  factorize(model, data, state, Loads());  // motors would make joints stiffer
  impulse_response(model, data, momenta, state.v);
  forward_kinematics(model, data, state);
  const double after = kinetic_energy(model, data);
  if (after > before) {  // the inertia of a link that rotates is another
    state.v *= std::sqrt(before / after);
    forward_kinematics(model, data, state);
  }
  return true;
}

}  // namespace breve::articulated
