// Sums over the links.
#include "runtime/articulated/energy.hpp"

#include "runtime/articulated/kinematics.hpp"

namespace breve::articulated {

Vector3 own_momentum(const Model& model, const Data& data, int link) {
  const Work& w = data.of(link);
  return w.rotation * (model.body(link).inertia_com * Vector3(w.rotation.transpose() * w.spin));
}

double kinetic_energy_of_link(const Model& model, const Data& data, int link) {
  return 0.5 * (model.body(link).mass * com_velocity(model, data, link).squaredNorm() +
                data.of(link).spin.dot(own_momentum(model, data, link)));
}

double kinetic_energy(const Model& model, const Data& data) {
  double energy = 0;
  for (int i = 0; i < model.size(); ++i) energy += kinetic_energy_of_link(model, data, i);
  return energy;
}

double potential_energy(const Model& model, const Data& data, const Vector3& gravity) {
  double energy = 0;
  for (int i = 0; i < model.size(); ++i) energy -= model.body(i).mass * gravity.dot(com_position(model, data, i));
  return energy;
}

Vector3 linear_momentum(const Model& model, const Data& data) {
  Vector3 momentum = Vector3::Zero();
  for (int i = 0; i < model.size(); ++i) momentum += model.body(i).mass * com_velocity(model, data, i);
  return momentum;
}

Vector3 angular_momentum(const Model& model, const Data& data, const Vector3& about) {
  Vector3 momentum = Vector3::Zero();
  for (int i = 0; i < model.size(); ++i) {
    const Vector3 arm = com_position(model, data, i) - about;
    momentum += model.body(i).mass * arm.cross(com_velocity(model, data, i)) + own_momentum(model, data, i);
  }
  return momentum;
}

Vector3 centre_of_mass(const Model& model, const Data& data) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < model.size(); ++i) sum += model.body(i).mass * com_position(model, data, i);
  return sum / model.mass();
}

}  // namespace breve::articulated
