// The steps: I + R D J is assembled over the velocities, solved within its envelope, and gone along as far as it helps.
#include "runtime/contact/newton.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/contact/direct.hpp"
#include "runtime/contact/elimination.hpp"
#include "runtime/contact/pack.hpp"

namespace breve::contact {

namespace {

constexpr int kMostVelocities = 1200;  // beyond it the matrix is too large: leave the island to the sweeps
constexpr int kConvexSteps = 30;
constexpr int kCoulombSteps = 6;

/// One side of a row as matrices: of its own, or made from the arm of a free body.
struct Matrices {
  const double *j = nullptr, *r = nullptr;
  int size = 0;
  double made[36];

  void read(const Packed& m, const double* own_j, const double* own_r, const Point& c, const double arm[3]) {
    size = m.place == nullptr ? 0 : m.size;
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

}  // namespace

Newton::Newton(Workspace& work) : work_(work), rows_(3 * work.points.size() + work.scalars.size()) {
  work.indices.clear();
  for (const Packed& mover : work.movers) {
    work.indices.push_back(size_);
    if (mover.place != nullptr) size_ += mover.size;
  }
}

bool Newton::fits() const { return size_ > 0 && size_ <= kMostVelocities; }

void Newton::begin() {
  const auto n = static_cast<std::size_t>(size_);
  offsets_ = work_.indices.size();
  work_.indices.resize(offsets_ + n);
  int widest = 0;
  for (const Packed& mover : work_.movers) widest = std::max(widest, mover.size);
  work_.columns.resize(static_cast<std::size_t>(widest));
  columns_ = work_.columns.data();
  work_.numbers.resize(n * n + 2 * n + 8 * rows_ + work_.points.size());
  double* next = work_.numbers.data();
  const auto take = [&](std::size_t count) { return std::exchange(next, next + count); };
  matrix_ = take(n * n);
  free_ = take(n);
  step_ = take(n);
  lift_ = take(work_.points.size());
  for (double** rows : {&centre_, &p_, &best_, &kept_, &q_, &dq_, &u_, &du_}) *rows = take(rows_);
  get_impulses(centre_);
  std::copy_n(centre_, rows_, q_);
  std::copy_n(centre_, rows_, best_);
  push_impulses(centre_, -1);
  get_velocities(free_);
  apply(q_);
}

bool Newton::settle(Around law, double stiffness, double tolerance, int& solves) {
  const bool convex = law == Around::Convex;
  law_ = law;
  stiffness_ = stiffness;
  read_rows(u_);
  read_lifts();
  const int most = convex ? kConvexSteps : kCoulombSteps;
  double before = 0, first = 0;
  for (int i = 0; i < most; ++i) {
    project_all(0);
    const double here = misfit();
    if (here <= 0.1 * tolerance) return true;
    if (i > 2 && here < 1e-6 && here > 0.3 * before) return true;  // round-off
    if (!convex && i > 1 && here > 10 * first) return false;
    before = here;
    if (i == 0) first = here;
    if (!find_step()) return false;
    ++solves;
    const double length = convex ? search() : 1;
    for (std::size_t k = 0; k < rows_; ++k) q_[k] -= length * dq_[k];
    apply(q_);
    read_rows(u_);
  }
  project_all(0);
  return misfit() <= 0.1 * tolerance;
}

void Newton::read_lifts() {
  for (std::size_t i = 0; i < work_.points.size(); ++i)
    lift_[i] = work_.points[i].friction * std::hypot(u_[3 * i + 1], u_[3 * i + 2]);
}

double Newton::take() {
  set_impulses(p_);
  std::copy_n(p_, rows_, centre_);
  std::copy_n(p_, rows_, q_);
  apply(q_);
  return violation(work_);
}

void Newton::restore(const double* p) {
  set_impulses(p);
  std::copy_n(p, rows_, centre_);
  std::copy_n(p, rows_, q_);
  apply(p);
}

template <class F>
void Newton::each_mover(F&& f) {
  for (std::size_t i = 0; i < work_.movers.size(); ++i)
    if (work_.movers[i].place != nullptr) f(work_.movers[i], work_.indices[i]);
}

void Newton::get_velocities(double* out) {
  each_mover([&](Packed& m, int at) { std::copy_n(m.now(), m.size, out + at); });
}

void Newton::set_velocities(const double* in) {
  each_mover([&](Packed& m, int at) { std::copy_n(in + at, m.size, m.now()); });
}

void Newton::get_impulses(double* out) {
  for (const Point& c : work_.points) out = std::copy_n(c.impulse, 3, out);
  for (const PackedScalar& row : work_.scalars) *out++ = row.impulse;
}

void Newton::set_impulses(const double* in) {
  for (Point& c : work_.points) {
    std::copy_n(in, 3, c.impulse);
    in += 3;
  }
  for (PackedScalar& row : work_.scalars) row.impulse = *in++;
}

void Newton::push_impulses(const double* p, double sign) {
  for (std::size_t i = 0; i < work_.points.size(); ++i, p += 3) {
    const double signed_p[3] = {sign * p[0], sign * p[1], sign * p[2]};
    if (p[0] != 0 || p[1] != 0 || p[2] != 0) push(work_, i, signed_p);
  }
  for (const PackedScalar& row : work_.scalars) push(work_, row, sign * *p++);
}

void Newton::apply(const double* p) {
  set_velocities(free_);
  push_impulses(p, 1);
}

void Newton::read_rows(double* out) {
  for (std::size_t i = 0; i < work_.points.size(); ++i, out += 3) velocity(work_, i, out);
  for (const PackedScalar& row : work_.scalars) *out++ = velocity(work_, row);
}

Slope Newton::project_point(std::size_t i, const double u[3], double p[3]) const {
  const Point& c = work_.points[i];
  return law_ == Around::Convex ? project_convex(c, centre_ + 3 * i, u, lift_[i], stiffness_, p)
                                : project(c, centre_ + 3 * i, u, stiffness_, p);
}

/// p_ at the row velocities u_ - length du_.
void Newton::project_all(double length) {
  std::size_t at = 0;
  for (std::size_t i = 0; i < work_.points.size(); ++i, at += 3) {
    const double u[3] = {u_[at] - length * du_[at], u_[at + 1] - length * du_[at + 1],
                         u_[at + 2] - length * du_[at + 2]};
    project_point(i, u, p_ + at);
  }
  for (const PackedScalar& row : work_.scalars) {
    project(row, centre_[at], u_[at] - length * du_[at], stiffness_, p_[at]);
    ++at;
  }
}

/// The largest difference of q and p, as the velocity it would be at its own row.
double Newton::misfit() const {
  double worst = 0;
  std::size_t at = 0;
  for (const Point& c : work_.points) {
    worst =
        std::max({worst, std::abs(q_[at] - p_[at]) * c.response.nn, std::abs(q_[at + 1] - p_[at + 1]) * c.response.s11,
                  std::abs(q_[at + 2] - p_[at + 2]) * c.response.s22});
    at += 3;
  }
  for (const PackedScalar& row : work_.scalars) {
    worst = std::max(worst, std::abs(q_[at] - p_[at]) * row.response);
    ++at;
  }
  return worst;
}

/// The Newton step: (I + R D J) dv = R (q - p), with dq so that dv = R dq; and its row velocities.
bool Newton::find_step() {
  assemble();
  for (std::size_t k = 0; k < rows_; ++k) dq_[k] = q_[k] - p_[k];
  std::fill_n(step_, size_, 0.0);
  set_velocities(step_);
  push_impulses(dq_, 1);
  get_velocities(step_);
  const auto n = static_cast<std::size_t>(size_);
  if (!eliminate({matrix_, n * n}, {step_, n}, {work_.indices.data() + offsets_, n})) return false;
  set_velocities(step_);
  read_rows(du_);
  std::size_t at = 0;
  double p[3];
  for (std::size_t i = 0; i < work_.points.size(); ++i, at += 3) {
    const Slope D = project_point(i, u_ + at, p);
    const double* d = du_ + at;
    dq_[at] -= D.nn * d[0] + D.n1 * d[1] + D.n2 * d[2];
    dq_[at + 1] -= D.t1n * d[0] + D.t11 * d[1] + D.t12 * d[2];
    dq_[at + 2] -= D.t2n * d[0] + D.t12 * d[1] + D.t22 * d[2];
  }
  for (const PackedScalar& row : work_.scalars) {
    dq_[at] -= project(row, centre_[at], u_[at], stiffness_, p[0]) * du_[at];
    ++at;
  }
  return std::isfinite(du_[0]);
}

/// I + R D J at the row velocities u_.
void Newton::assemble() {
  std::fill_n(matrix_, static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_), 0.0);
  for (int k = 0; k < size_; ++k) entry(k, k) = 1;
  std::size_t at = 0;
  double p[3];
  for (std::size_t i = 0; i < work_.points.size(); ++i, at += 3) {
    const Slope slope = project_point(i, u_ + at, p);
    if (slope.nn > 0) add(work_.points[i], work_.sides[i], slope);
  }
  for (const PackedScalar& row : work_.scalars) {
    const double slope = project(row, centre_[at], u_[at], stiffness_, p[0]);
    if (slope > 0) add(row, slope);
    ++at;
  }
}

/// Slope of the energy along the step: without friction the problem is that of a least energy, and this its
/// derivative.
double Newton::slope_at(double length) {
  project_all(length);
  double sum = 0;
  for (std::size_t k = 0; k < rows_; ++k) sum -= du_[k] * (q_[k] - length * dq_[k] - p_[k]);
  return sum;
}

/// How far to go along the step: all the way, unless that is uphill; then to where the slope is small.
double Newton::search() {
  const double start = slope_at(0);
  if (!(start < 0)) return 1;
  double low = 0, high = 1, low_slope = start, high_slope = slope_at(1);
  if (high_slope <= 0.1 * -start) return 1;
  for (int i = 0; i < 20; ++i) {
    double middle = low + (high - low) * low_slope / (low_slope - high_slope);
    if (i % 3 == 2) middle = 0.5 * (low + high);
    const double slope = slope_at(middle);
    if (std::abs(slope) <= 0.1 * -start) return middle;
    if (slope < 0) {
      low = middle;
      low_slope = slope;
    } else {
      high = middle;
      high_slope = slope;
    }
  }
  return high;
}

double& Newton::entry(int i, int k) {
  return matrix_[static_cast<std::size_t>(i) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(k)];
}

void Newton::add(const Point& c, const Sides& own, const Slope& D) {
  Matrices sides[2];
  const int movers[2] = {c.a, c.b};
  sides[0].read(work_.movers[static_cast<std::size_t>(c.a)], own.ja, own.ra, c, c.arm_a);
  sides[1].read(work_.movers[static_cast<std::size_t>(c.b)], own.jb, own.rb, c, c.arm_b);
  for (int y = 0; y < 2; ++y) {
    const Matrices& J = sides[y];
    const int column = work_.indices[static_cast<std::size_t>(movers[y])];
    // A point of a tree moves with the joints between it and the root: the other columns are zero.
    int count = 0;
    for (int k = 0; k < J.size; ++k) {
      const double n = J.j[k], t1 = J.j[J.size + k], t2 = J.j[2 * J.size + k];
      if (n == 0 && t1 == 0 && t2 == 0) continue;
      columns_[count++] = {column + k, D.nn * n + D.n1 * t1 + D.n2 * t2, D.t1n * n + D.t11 * t1 + D.t12 * t2,
                           D.t2n * n + D.t12 * t1 + D.t22 * t2};
    }
    for (int x = 0; x < 2; ++x) {
      const Matrices& R = sides[x];
      const int row = work_.indices[static_cast<std::size_t>(movers[x])];
      const double sign = x == y ? 1 : -1;
      for (int i = 0; i < R.size; ++i) {
        const double r0 = sign * R.r[i], r1 = sign * R.r[R.size + i], r2 = sign * R.r[2 * R.size + i];
        double* line = &entry(row + i, 0);
        for (int k = 0; k < count; ++k) {
          const Column& at = columns_[k];
          line[at.place] += r0 * at.n + r1 * at.t1 + r2 * at.t2;
        }
      }
    }
  }
}

void Newton::add(const PackedScalar& row, double slope) {
  const double* j[2] = {row.ja, row.jb};
  const double* r[2] = {row.ra, row.rb};
  const int movers[2] = {row.a, row.b};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      if (j[y] == nullptr || r[x] == nullptr) continue;
      const int top = work_.indices[static_cast<std::size_t>(movers[x])],
                left = work_.indices[static_cast<std::size_t>(movers[y])];
      const double sign = x == y ? slope : -slope;
      for (int i = 0; i < work_.movers[static_cast<std::size_t>(movers[x])].size; ++i) {
        const double yields = sign * r[x][i];
        double* line = &entry(top + i, left);
        for (int k = 0; k < work_.movers[static_cast<std::size_t>(movers[y])].size; ++k) line[k] += yields * j[y][k];
      }
    }
}

}  // namespace breve::contact
