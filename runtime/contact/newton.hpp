// Newton's method of the direct solver, around one centre; direct.cpp moves the centre.
#pragma once

#include "runtime/contact/projection.hpp"

namespace breve::contact {

/// Which law the rows have around the centre.
enum class Around { Convex, Coulomb };

/// All vectors are in the workspace's buffers. Rows count three numbers a contact, then one a scalar row.
class Newton {
 public:
  explicit Newton(Workspace& work);

  bool fits() const;  // the matrix is not too large
  void begin();       // the first centre are the impulses of the island

  /// Steps for v = v* + R q, q = p(J v).
  /// @return whether q and p agree within a tenth of `tolerance`, or as near as round-off allows
  bool settle(Around law, double stiffness, double tolerance, int& solves);

  /// The impulses p become those of the island, and the next centre. @return the violation, m/s
  double take();

  // Two sets of impulses to come back to.
  void keep() { get_impulses(kept_); }
  void restore() { restore(kept_); }
  void keep_best() { get_impulses(best_); }
  void restore_best() { restore(best_); }

 private:
  template <class F>
  void each_mover(F&& f);
  void get_velocities(double* out);
  void set_velocities(const double* in);
  void get_impulses(double* out);
  void set_impulses(const double* in);
  void push_impulses(const double* p, double sign);
  void apply(const double* p);  // velocities of the island from impulses
  void read_rows(double* out);  // velocities at the rows
  void restore(const double* p);
  void read_lifts();

  Slope project_point(std::size_t i, const double u[3], double p[3]) const;
  void project_all(double length);  // p_ at the row velocities u_ - length du_
  double misfit() const;
  bool find_step();
  void assemble();
  double slope_at(double length);
  double search();
  double& entry(int i, int k);
  void add(const Point& c, const Sides& own, const Slope& slope);
  void add(const PackedScalar& row, double slope);

  Workspace& work_;
  std::size_t rows_, offsets_ = 0;
  int size_ = 0;  // numbers in v
  double stiffness_ = 1;
  Around law_ = Around::Convex;
  Column* columns_ = nullptr;  // of the row that is added
  double *matrix_ = nullptr, *free_ = nullptr, *step_ = nullptr, *lift_ = nullptr;
  // Of the rows: the centre; p(J v); impulses kept; q with v = v* + R q; its step; J v, and that of the step.
  double *centre_ = nullptr, *p_ = nullptr, *best_ = nullptr, *kept_ = nullptr;
  double *q_ = nullptr, *dq_ = nullptr, *u_ = nullptr, *du_ = nullptr;
};

}  // namespace breve::contact
