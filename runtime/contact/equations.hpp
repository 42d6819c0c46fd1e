// All rows of an island as one linear system over its velocities, for the direct solver's methods.
#pragma once

#include "runtime/contact/elimination.hpp"
#include "runtime/contact/projection.hpp"

namespace breve::contact {

/// v = v* + R q and u = J v: impulses q at the rows, the velocities v that they make, velocities u at the rows. Rows
/// count three numbers a contact, then one a scalar row. All vectors are in the workspace's buffers.
class Equations {
 public:
  /// After order_elimination(): its numbers are used.
  explicit Equations(Workspace& work);

  bool fits() const;  // the matrix is not too large
  std::size_t rows() const { return rows_; }
  /// Takes the memory, and the impulses of the island off its velocities. @return room for `numbers` more
  double* begin(std::size_t numbers);

  void apply(const double* q);  // velocities of the island from impulses
  void read_free(double* u);    // u without impulses; the velocities are then of no use
  void read_rows(double* u);
  void get_impulses(double* out) const;
  void set_impulses(const double* in);
  /// q becomes the impulses of the island, with the velocities that it makes.
  void take(const double* q);

  // The matrix I + R D J, where D has a block for each row: dq = -D du.
  void clear();
  void add_point(std::size_t point, const Slope& D);
  void add_scalar(std::size_t scalar, double slope);
  /// @return false if the matrix is singular
  bool factorize();
  /// Solves (I + R D J) dv = R q after factorize(); du = J dv. The velocities of the island are then of no use.
  /// @return false if a number overflows
  bool solve(const double* q, double* du);

 private:
  template <class F>
  void each_mover(F&& f);
  void get_velocities(double* out);
  void set_velocities(const double* in);
  void push_impulses(const double* p, double sign);
  int band() const;
  void add_condensed(std::size_t point, const Slope& D);

  Workspace& work_;
  std::size_t rows_, offsets_ = 0;
  int size_ = 0;  // numbers in v
  BandMatrix matrix_;
  std::span<int> pivots() { return {work_.indices.data() + offsets_, static_cast<std::size_t>(size_)}; }
  std::span<int> ends() { return {work_.indices.data() + offsets_ + size_, static_cast<std::size_t>(size_)}; }
  double *free_ = nullptr, *step_ = nullptr;
  double* columns_[3] = {};  // D J of the row that is added, one side
};

}  // namespace breve::contact
