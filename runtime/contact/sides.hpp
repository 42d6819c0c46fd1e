// One side of a contact as matrices, whatever it is given by.
#pragma once

#include "runtime/contact/workspace.hpp"

namespace breve::contact {

inline double dot(const double* a, const double* b, int size) {
  double sum = 0;
  for (int i = 0; i < size; ++i) sum += a[i] * b[i];
  return sum;
}

/// Matrices of its own, or made from the arm of a free body.
struct SideMatrices {
  const double *j = nullptr, *r = nullptr;  // 3 rows, and 3 columns, of `size`
  int size = 0;                             // 0: the world
  double made[36];

  void read(const Packed& m, const double* own_j, const double* own_r, const Point& c, const double arm[3]) {
    size = m.source == nullptr ? 0 : m.size;
    j = own_j;
    r = own_r;
    if (j != nullptr || size == 0) return;
    const double* axes[3] = {c.normal, c.tangent1, c.tangent2};
    for (int k = 0; k < 3; ++k) {
      const double* n = axes[k];
      double* jk = made + 6 * k;
      double* rk = made + 18 + 6 * k;
      for (int i = 0; i < 3; ++i) {
        jk[i] = n[i];
        rk[i] = m.inverse_mass * n[i];
      }
      jk[3] = arm[1] * n[2] - arm[2] * n[1];
      jk[4] = arm[2] * n[0] - arm[0] * n[2];
      jk[5] = arm[0] * n[1] - arm[1] * n[0];
      rk[3] = m.inertia[0] * jk[3] + m.inertia[1] * jk[4] + m.inertia[2] * jk[5];
      rk[4] = m.inertia[1] * jk[3] + m.inertia[3] * jk[4] + m.inertia[4] * jk[5];
      rk[5] = m.inertia[2] * jk[3] + m.inertia[4] * jk[4] + m.inertia[5] * jk[5];
    }
    j = made;
    r = made + 18;
  }
};

}  // namespace breve::contact
