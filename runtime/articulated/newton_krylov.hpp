// Newton's method without a matrix: each linear equation is solved by GMRES, which needs products of the Jacobian with
// vectors only, and those come from differences of the residual. So an implicit step on a tree of n links costs O(n)
// for each product, and the system need not know its derivatives. Source: Knoll, Keyes 2004; Saad, Schultz 1986.
#pragma once

#include "runtime/articulated/vector.hpp"

namespace breve::articulated {

/// An equation F(z) = 0.
class Residual {
 public:
  virtual void residual(const Vector& z, Vector& f) = 0;

 protected:
  ~Residual() = default;
};

class NewtonKrylov {
 public:
  /// @param size  of z; the only place where memory is taken
  explicit NewtonKrylov(int size);

  /// Improves z until the residual stops falling, which is at round-off if all went well.
  /// @param scale  the size of the terms whose difference the residual is
  /// @return       whether the residual is below 1e-9 * scale
  bool solve(Residual& equation, Vector& z, double scale);

 private:
  void find_direction(Residual& equation, const Vector& z, double norm);
  bool extend_basis(Residual& equation, const Vector& z, int k, double difference);
  double rotate_column(int k);

  int most_;  // dimensions of the Krylov space
  Vector f_, trial_, direction_, best_;
  Eigen::MatrixXd basis_;  // (size, most + 1), orthonormal columns
  Eigen::MatrixXd upper_;  // (most + 1, most), Hessenberg, rotated to upper triangular as it grows
  Vector cosines_, sines_, right_;
};

}  // namespace breve::articulated
