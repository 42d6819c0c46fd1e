// Assembled over the velocities, since there are fewer of them than rows, and solved within the matrix's envelope.
#include "runtime/contact/equations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/contact/pack.hpp"
#include "runtime/contact/sides.hpp"

namespace breve::contact {

namespace {

constexpr int kMostVelocities = 3000;  // beyond it the matrix is too large: leave the island to the sweeps

/// D J of a side with rows of `size` numbers, of which `count` may be other than zero.
void weigh(const Slope& D, const double* j, int size, int count, double* n, double* t1, double* t2) {
  const auto pair = [](double a, Lanes x, double b, Lanes y, double c, Lanes z) {
    return both(a) * x + both(b) * y + both(c) * z;
  };
  int k = 0;
  for (; k + 1 < count; k += 2) {
    const Lanes j0 = load(j + k), j1 = load(j + size + k), j2 = load(j + 2 * size + k);
    store(n + k, pair(D.nn, j0, D.n1, j1, D.n2, j2));
    store(t1 + k, pair(D.t1n, j0, D.t11, j1, D.t12, j2));
    store(t2 + k, pair(D.t2n, j0, D.t21, j1, D.t22, j2));
  }
  if (k == count) return;
  const double j0 = j[k], j1 = j[size + k], j2 = j[2 * size + k];
  n[k] = D.nn * j0 + D.n1 * j1 + D.n2 * j2;
  t1[k] = D.t1n * j0 + D.t11 * j1 + D.t12 * j2;
  t2[k] = D.t2n * j0 + D.t21 * j1 + D.t22 * j2;
}

/// y += a p + b q + c r, for n numbers.
void add_multiples(Lanes a, const double* p, Lanes b, const double* q, Lanes c, const double* r, int n, double* y) {
  int k = 0;
  for (; k + 1 < n; k += 2) store(y + k, load(y + k) + (a * load(p + k) + b * load(q + k) + c * load(r + k)));
  if (k < n) y[k] += a[0] * p[k] + b[0] * q[k] + c[0] * r[k];
}

}  // namespace

Equations::Equations(Workspace& work) : work_(work), rows_(3 * work.points.size() + work.scalars.size()) {
  if (work.condensed) {
    work.indices.clear();
    size_ = static_cast<int>(rows_);
    return;
  }
  work.indices.resize(work.movers.size());
  for (const Packed& mover : work.movers)
    if (mover.source != nullptr) size_ += mover.size;
}

bool Equations::fits() const { return size_ > 0 && size_ <= kMostVelocities; }

double* Equations::begin(std::size_t numbers) {
  const auto n = static_cast<std::size_t>(size_);
  offsets_ = work_.indices.size();
  work_.indices.resize(offsets_ + 2 * n);
  int widest = 0;
  for (const Packed& mover : work_.movers) widest = std::max(widest, mover.size);
  const auto width = static_cast<std::size_t>(widest);
  matrix_ = BandMatrix(size_, band());
  work_.numbers.resize(matrix_.numbers() + 2 * n + 3 * width + rows_ + numbers);
  double* next = work_.numbers.data();
  const auto take = [&](std::size_t count) { return std::exchange(next, next + count); };
  matrix_.use(take(matrix_.numbers()));
  free_ = take(n);
  step_ = take(n);
  for (double*& columns : columns_) columns = take(width);
  double* const impulses = take(rows_);
  get_impulses(impulses);
  push_impulses(impulses, -1);
  get_velocities(free_);
  return next;
}

void Equations::take(const double* q) {
  set_impulses(q);
  apply(q);
}

template <class F>
void Equations::each_mover(F&& f) {
  for (std::size_t i = 0; i < work_.movers.size(); ++i)
    if (work_.movers[i].source != nullptr) f(work_.movers[i], work_.indices[i]);
}

void Equations::get_velocities(double* out) {
  if (work_.condensed) {
    std::copy(work_.rates.begin(), work_.rates.end(), out);
    return;
  }
  each_mover([&](Packed& m, int at) { std::copy_n(m.now(), m.size, out + at); });
}

void Equations::set_velocities(const double* in) {
  if (work_.condensed) {
    std::copy_n(in, rows_, work_.rates.begin());
    return;
  }
  each_mover([&](Packed& m, int at) { std::copy_n(in + at, m.size, m.now()); });
}

void Equations::get_impulses(double* out) const {
  for (const Point& c : work_.points) out = std::copy_n(c.impulse, 3, out);
  for (const PackedScalar& row : work_.scalars) *out++ = row.impulse;
}

void Equations::set_impulses(const double* in) {
  for (Point& c : work_.points) {
    std::copy_n(in, 3, c.impulse);
    in += 3;
  }
  for (PackedScalar& row : work_.scalars) row.impulse = *in++;
}

void Equations::push_impulses(const double* p, double sign) {
  for (std::size_t i = 0; i < work_.points.size(); ++i, p += 3) {
    const double signed_p[3] = {sign * p[0], sign * p[1], sign * p[2]};
    if (p[0] != 0 || p[1] != 0 || p[2] != 0) push(work_, i, signed_p);
  }
  for (const PackedScalar& row : work_.scalars) push(work_, row, sign * *p++);
}

void Equations::apply(const double* p) {
  set_velocities(free_);
  push_impulses(p, 1);
}

void Equations::read_free(double* u) {
  set_velocities(free_);
  read_rows(u);
}

void Equations::read_rows(double* out) {
  for (std::size_t i = 0; i < work_.points.size(); ++i, out += 3) velocity(work_, i, out);
  for (const PackedScalar& row : work_.scalars) *out++ = velocity(work_, row);
}

void Equations::clear() {
  matrix_.clear();
  for (int k = 0; k < size_; ++k) matrix_.row(k)[k] = 1;
}

bool Equations::factorize() { return breve::contact::factorize(matrix_, pivots(), ends()); }

bool Equations::solve(const double* q, double* du) {
  std::fill_n(step_, size_, 0.0);
  set_velocities(step_);
  push_impulses(q, 1);
  get_velocities(step_);
  // An infinite or invalid value leaves no trace, neither here nor in the world, which takes part in every push.
  std::fill_n(work_.movers.front().v, 6, 0.0);
  if (!std::all_of(step_, step_ + size_, [](double v) { return std::isfinite(v); })) return false;
  substitute(matrix_, pivots(), ends(), {step_, static_cast<std::size_t>(size_)});
  set_velocities(step_);
  read_rows(du);
  return std::all_of(du, du + rows_, [](double u) { return std::isfinite(u); });
}

/// How far from the diagonal rows couple velocities.
int Equations::band() const {
  if (work_.condensed) return size_;
  int widest = 0;
  const auto look = [&](int a, int b) {
    const Packed &of_a = work_.movers[static_cast<std::size_t>(a)], &of_b = work_.movers[static_cast<std::size_t>(b)];
    const int at_a = work_.indices[static_cast<std::size_t>(a)], at_b = work_.indices[static_cast<std::size_t>(b)];
    if (of_a.source != nullptr) widest = std::max(widest, of_a.size - 1);
    if (of_b.source != nullptr) widest = std::max(widest, of_b.size - 1);
    if (of_a.source == nullptr || of_b.source == nullptr) return;
    widest = std::max(widest, std::max(at_a + of_a.size, at_b + of_b.size) - std::min(at_a, at_b) - 1);
  };
  for (const Point& c : work_.points) look(c.a, c.b);
  for (const PackedScalar& row : work_.scalars) look(row.a, row.b);
  return widest;
}

void Equations::add_point(std::size_t point, const Slope& D) {
  if (D.nn == 0) return;
  if (work_.condensed) return add_condensed(point, D);
  const Point& c = work_.points[point];
  const Sides& own = work_.sides[point];
  SideMatrices sides[2];
  const int movers[2] = {c.a, c.b};
  sides[0].read(work_.movers[static_cast<std::size_t>(c.a)], own.ja, own.ra, c, c.arm_a);
  sides[1].read(work_.movers[static_cast<std::size_t>(c.b)], own.jb, own.rb, c, c.arm_b);
  for (int y = 0; y < 2; ++y) {
    const SideMatrices& J = sides[y];
    const int column = work_.indices[static_cast<std::size_t>(movers[y])];
    // A point of a tree moves with the joints between it and the root: the columns behind them are zero.
    const int reach = y == 0 ? own.reach_a : own.reach_b;
    const int count = reach > 0 ? reach : J.size;
    double *const n = columns_[0], *const t1 = columns_[1], *const t2 = columns_[2];
    weigh(D, J.j, J.size, count, n, t1, t2);
    for (int x = 0; x < 2; ++x) {
      const SideMatrices& R = sides[x];
      const int row = work_.indices[static_cast<std::size_t>(movers[x])];
      const double sign = x == y ? 1 : -1;
      for (int i = 0; i < R.size; ++i) {
        const double r0 = sign * R.r[i], r1 = sign * R.r[R.size + i], r2 = sign * R.r[2 * R.size + i];
        add_multiples(both(r0), n, both(r1), t1, both(r2), t2, count, matrix_.row(row + i) + column);
      }
    }
  }
}

/// The velocities are those of the rows: J is a unit matrix, and R is W.
void Equations::add_condensed(std::size_t point, const Slope& D) {
  const double* W = &work_.answers[3 * point * rows_];
  for (std::size_t i = 0; i < rows_; ++i) {
    const double r0 = W[i], r1 = W[rows_ + i], r2 = W[2 * rows_ + i];
    double* line = matrix_.row(static_cast<int>(i)) + 3 * point;
    line[0] += r0 * D.nn + r1 * D.t1n + r2 * D.t2n;
    line[1] += r0 * D.n1 + r1 * D.t11 + r2 * D.t21;
    line[2] += r0 * D.n2 + r1 * D.t12 + r2 * D.t22;
  }
}

void Equations::add_scalar(std::size_t scalar, double slope) {
  if (slope == 0) return;
  if (work_.condensed) {
    const std::size_t at = 3 * work_.points.size() + scalar;
    for (std::size_t i = 0; i < rows_; ++i)
      matrix_.row(static_cast<int>(i))[at] += slope * work_.answers[at * rows_ + i];
    return;
  }
  const PackedScalar& row = work_.scalars[scalar];
  const double* j[2] = {row.ja, row.jb};
  const double* r[2] = {row.ra, row.rb};
  const int movers[2] = {row.a, row.b};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      if (j[y] == nullptr || r[x] == nullptr) continue;
      const int top = work_.indices[static_cast<std::size_t>(movers[x])],
                left = work_.indices[static_cast<std::size_t>(movers[y])];
      const double sign = x == y ? slope : -slope;
      const int first = y == 0 ? row.first_a : row.first_b, reach = y == 0 ? row.reach_a : row.reach_b;
      for (int i = 0; i < work_.movers[static_cast<std::size_t>(movers[x])].size; ++i)
        add_multiple(sign * r[x][i], j[y] + first, reach - first, matrix_.row(top + i) + left + first);
    }
}

}  // namespace breve::contact
