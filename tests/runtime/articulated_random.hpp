// Random trees of bodies, for tests that hold for any of them.
#pragma once

#include "runtime/articulated/state.hpp"
#include "runtime/base/random.hpp"

namespace breve::articulated {

inline double between(Random& random, double low, double high) { return low + (high - low) * random.uniform(); }

inline Vector3 random_vector(Random& random, double size) {
  const double x = between(random, -size, size), y = between(random, -size, size), z = between(random, -size, size);
  return {x, y, z};
}

inline Quaternion random_rotation(Random& random) {
  Eigen::Vector4d q;
  for (int i = 0; i < 4; ++i) q[i] = between(random, -1, 1);
  q.normalize();
  return {q[0], q[1], q[2], q[3]};
}

/// A tree of `n` links with joints of all types; floating or fixed at its root.
inline std::vector<Link> random_tree(Random& random, int n, bool floating) {
  std::vector<Link> links(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    Link& link = links[static_cast<std::size_t>(i)];
    link.parent = i == 0 ? -1 : static_cast<int>(random.below(static_cast<std::uint64_t>(i)));
    constexpr JointType kTypes[] = {JointType::Revolute,  JointType::Revolute, JointType::Prismatic,
                                    JointType::Universal, JointType::Ball,     JointType::Fixed};
    link.type = i == 0 && floating ? JointType::Free : kTypes[random.below(i == 0 ? 5 : 6)];
    link.position = random_vector(random, 0.4);
    link.rotation = random_rotation(random);
    link.axis = (random_rotation(random) * Vector3::UnitZ()).normalized();
    link.axis2 = link.axis.unitOrthogonal();
    link.mass = between(random, 0.2, 3);
    link.com = random_vector(random, 0.2);
    const Matrix3 axes = random_rotation(random).toRotationMatrix();
    const double a = between(random, 0.005, 0.05), b = between(random, 0.005, 0.05);
    link.inertia =
        axes * Vector3(a, b, between(random, std::abs(a - b) + 0.001, a + b)).asDiagonal() * axes.transpose();
    link.inertia = (0.5 * (link.inertia + link.inertia.transpose())).eval();
  }
  return links;
}

inline State random_state(Random& random, const Model& model, double speed) {
  State state = neutral_state(model);
  Vector d(model.velocities());
  for (Eigen::Index i = 0; i < d.size(); ++i) d[i] = between(random, -1.5, 1.5);
  move(model, state.q, d, state.q);
  for (Eigen::Index i = 0; i < d.size(); ++i) state.v[i] = between(random, -speed, speed);
  return state;
}

inline Vector random_forces(Random& random, int n) {
  Vector f(n);
  for (Eigen::Index i = 0; i < n; ++i) f[i] = between(random, -2, 2);
  return f;
}

}  // namespace breve::articulated
