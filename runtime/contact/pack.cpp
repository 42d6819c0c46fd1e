// Packing: arms or matrices of each side become the 3x3 response of the contact, once per solve.
#include "runtime/contact/pack.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/contact/sides.hpp"

namespace breve::contact {

namespace {

Packed world() {
  Packed out{};
  out.free = true;
  return out;
}

Packed packed(const Mover& mover) {
  Packed out{};
  out.source = mover.v;
  out.size = mover.size;
  out.free = mover.inverse_mass > 0;
  if (!out.free) return out;
  std::copy_n(mover.v, 6, out.v);
  out.inverse_mass = mover.inverse_mass;
  const Matrix3& inverse = mover.inverse_inertia;
  const double inertia[6] = {inverse(0, 0), inverse(0, 1), inverse(0, 2), inverse(1, 1), inverse(1, 2), inverse(2, 2)};
  std::copy_n(inertia, 6, out.inertia);
  return out;
}

/// The response of a free body, with its impulse at an arm.
void add_response(const Packed& m, const double arm[3], const Point& c, LocalMatrix& W) {
  if (m.inverse_mass == 0) return;
  const double* axes[3] = {c.normal, c.tangent1, c.tangent2};
  double torque[3][3], spin[3][3];
  for (int k = 0; k < 3; ++k) {
    const double* n = axes[k];
    const double x = arm[1] * n[2] - arm[2] * n[1], y = arm[2] * n[0] - arm[0] * n[2],
                 z = arm[0] * n[1] - arm[1] * n[0];
    torque[k][0] = x;
    torque[k][1] = y;
    torque[k][2] = z;
    spin[k][0] = m.inertia[0] * x + m.inertia[1] * y + m.inertia[2] * z;
    spin[k][1] = m.inertia[1] * x + m.inertia[3] * y + m.inertia[4] * z;
    spin[k][2] = m.inertia[2] * x + m.inertia[4] * y + m.inertia[5] * z;
  }
  const auto dot = [&](int i, int k) {
    return torque[i][0] * spin[k][0] + torque[i][1] * spin[k][1] + torque[i][2] * spin[k][2];
  };
  W.nn += m.inverse_mass + dot(0, 0);
  W.n1 += dot(0, 1);
  W.n2 += dot(0, 2);
  W.s11 += m.inverse_mass + dot(1, 1);
  W.s12 += dot(1, 2);
  W.s22 += m.inverse_mass + dot(2, 2);
}

/// The response of a side given by its matrices. J R is symmetric; both halves are read, so that round-off is shared.
void add_response(const double* j, const double* r, int n, LocalMatrix& W) {
  const auto at = [&](int i, int k) { return dot(j + i * n, r + k * n, n); };
  W.nn += at(0, 0);
  W.n1 += 0.5 * (at(0, 1) + at(1, 0));
  W.n2 += 0.5 * (at(0, 2) + at(2, 0));
  W.s11 += at(1, 1);
  W.s12 += 0.5 * (at(1, 2) + at(2, 1));
  W.s22 += at(2, 2);
}

/// How many numbers of some rows behind one another there are up to the last column that is not zero.
int reach_of(const double* j, int rows, int size) {
  if (j == nullptr) return 0;
  const auto zero = [=](int column) {
    for (int k = 0; k < rows; ++k)
      if (j[k * size + column] != 0) return false;
    return true;
  };
  int reach = size;
  while (reach > 0 && zero(reach - 1)) --reach;
  return reach;
}

/// The first number of a row that is not zero.
int first_of(const double* j, int reach) {
  int first = 0;
  while (first < reach && j[first] == 0) ++first;
  return first;
}

void fill(Point& c, const Row& row, const std::pmr::vector<Packed>& movers) {
  c.a = row.a + 1;
  c.b = row.b + 1;
  c.plain = row.ja == nullptr && row.jb == nullptr;
  c.friction = row.static_friction;
  for (int k = 0; k < 3; ++k) {
    c.normal[k] = row.axes(0, k);
    c.tangent1[k] = row.axes(1, k);
    c.tangent2[k] = row.axes(2, k);
    c.arm_a[k] = row.arm_a[k];
    c.arm_b[k] = row.arm_b[k];
  }
  c.bias = row.bias;
  c.softness = row.softness;
  c.response = {};
  const Packed& a = movers[static_cast<std::size_t>(c.a)];
  const Packed& b = movers[static_cast<std::size_t>(c.b)];
  if (row.ja != nullptr)
    add_response(row.ja, row.ra, a.size, c.response);
  else
    add_response(a, c.arm_a, c, c.response);
  if (row.jb != nullptr)
    add_response(row.jb, row.rb, b.size, c.response);
  else
    add_response(b, c.arm_b, c, c.response);
  c.response.nn += row.softness;
  c.inverse = regular_inverse(c.response);
  const bool warm = row.impulse[0] > 0 && row.impulse.allFinite();
  for (int k = 0; k < 3; ++k) c.impulse[k] = warm ? row.impulse[k] : 0.0;
  if (warm) clip_to_cone(c.friction, c.impulse);
}

PackedScalar packed(const ScalarRow& row, const std::pmr::vector<Packed>& movers) {
  PackedScalar out{};
  out.a = row.a + 1;
  out.b = row.b + 1;
  out.ja = row.ja;
  out.ra = row.ra;
  out.jb = row.jb;
  out.rb = row.rb;
  out.reach_a = reach_of(row.ja, 1, movers[static_cast<std::size_t>(out.a)].size);
  out.reach_b = reach_of(row.jb, 1, movers[static_cast<std::size_t>(out.b)].size);
  out.first_a = first_of(row.ja, out.reach_a);
  out.first_b = first_of(row.jb, out.reach_b);
  out.bias = row.bias;
  out.softness = row.softness;
  out.lo = row.lo;
  out.hi = row.hi;
  if (row.ja != nullptr) out.response += dot(row.ja, row.ra, movers[static_cast<std::size_t>(out.a)].size);
  if (row.jb != nullptr) out.response += dot(row.jb, row.rb, movers[static_cast<std::size_t>(out.b)].size);
  out.response += row.softness;
  out.impulse = std::isfinite(row.impulse) ? std::clamp(row.impulse, row.lo, row.hi) : 0.0;
  return out;
}

/// Notes the columns of J, as far as it reaches. @return where they begin
std::size_t add_columns(const double* j, int reach, int size, std::pmr::vector<Column>& columns) {
  const std::size_t first = columns.size();
  for (int k = 0; k < reach; ++k) columns.push_back({Lanes{j[k], j[size + k]}, Lanes{j[2 * size + k], 0}});
  return first;
}

/// u += sign J v.
/// @param reach  columns of J; behind them it is zero
void add_velocity(const Column* j, int reach, const Packed& m, double sign, double u[3]) {
  const double* v = m.now();
  Lanes first{}, second{};
  for (int k = 0; k < reach; ++k) {
    first += j[k].first * both(v[k]);
    second += j[k].second * both(v[k]);
  }
  u[0] += sign * first[0];
  u[1] += sign * first[1];
  u[2] += sign * second[0];
}

/// v += R p, R being three columns of n numbers.
void push_columns(const double* r, int n, const double p[3], double* v) {
  const double *s = r + n, *t = s + n;
  const Lanes p0 = both(p[0]), p1 = both(p[1]), p2 = both(p[2]);
  int i = 0;
  for (; i + 1 < n; i += 2) store(v + i, load(v + i) + (load(r + i) * p0 + load(s + i) * p1 + load(t + i) * p2));
  if (i < n) v[i] += r[i] * p[0] + s[i] * p[1] + t[i] * p[2];
}

/// Velocity of the point of a side with an arm, added with a sign.
void add_velocity(const Point& c, const double arm[3], const Packed& m, double sign, double u[3]) {
  const double x = m.v[0] + m.v[4] * arm[2] - m.v[5] * arm[1];
  const double y = m.v[1] + m.v[5] * arm[0] - m.v[3] * arm[2];
  const double z = m.v[2] + m.v[3] * arm[1] - m.v[4] * arm[0];
  u[0] += sign * (c.normal[0] * x + c.normal[1] * y + c.normal[2] * z);
  u[1] += sign * (c.tangent1[0] * x + c.tangent1[1] * y + c.tangent1[2] * z);
  u[2] += sign * (c.tangent2[0] * x + c.tangent2[1] * y + c.tangent2[2] * z);
}

/// Its place among all rows, of which a point has three.
std::size_t row_of(const Workspace& work, const PackedScalar& row) {
  return 3 * work.points.size() + static_cast<std::size_t>(&row - work.scalars.data());
}

}  // namespace

void pack(std::span<const Mover> movers, std::span<const Row> rows, std::span<const ScalarRow> scalars,
          Workspace& work) {
  work.condensed = work.by_normals = false;  // a solve for which there was no memory left them
  work.movers.clear();
  work.movers.push_back(world());
  work.began.clear();
  for (const Mover& mover : movers) {
    const Packed& now = work.movers.emplace_back(packed(mover));
    if (!now.free && now.source != nullptr) work.began.insert(work.began.end(), now.source, now.source + now.size);
  }
  work.has_plain = false;
  work.columns.clear();
  work.answers.clear();
  work.normal_answers.clear();
  work.points.resize(rows.size());
  work.sides.resize(rows.size());
  work.grips.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    fill(work.points[i], row, work.movers);
    const Point& c = work.points[i];
    const int size_a = work.movers[static_cast<std::size_t>(c.a)].size;
    const int size_b = work.movers[static_cast<std::size_t>(c.b)].size;
    const int reach_a = reach_of(row.ja, 3, size_a), reach_b = reach_of(row.jb, 3, size_b);
    work.sides[i] = {row.ja, row.ra, row.jb, row.rb, reach_a, reach_b, 0, 0, {}};
    work.sides[i].columns_a = add_columns(row.ja, reach_a, size_a, work.columns);
    work.sides[i].columns_b = add_columns(row.jb, reach_b, size_b, work.columns);
    work.grips[i] = row.dynamic_friction < row.static_friction ? Grip::Unsettled : Grip::Holds;
    velocity(work, i, work.sides[i].free_velocity);
  }
  work.scalars.clear();
  for (const ScalarRow& row : scalars) {
    work.scalars.push_back(packed(row, work.movers));
    work.scalars.back().free_velocity = velocity(work, work.scalars.back());
  }
}

void restore_velocities(Workspace& work) {
  if (work.condensed) {
    double* rate = work.rates.data();
    for (const Sides& sides : work.sides) rate = std::copy_n(sides.free_velocity, 3, rate);
    for (const PackedScalar& row : work.scalars) *rate++ = row.free_velocity;
    return;
  }
  const double* tree = work.began.data();
  for (Packed& mover : work.movers) {
    if (mover.source == nullptr) continue;
    if (mover.free) {
      std::copy_n(mover.source, 6, mover.v);
    } else {
      std::copy_n(tree, mover.size, mover.source);
      tree += mover.size;
    }
  }
}

void start_over(std::span<const Push> rows, std::span<const double> scalar_biases, Workspace& work) {
  for (Packed& mover : work.movers)
    if (mover.free) std::fill_n(mover.v, 6, 0.0);
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    Point& c = work.points[i];
    std::fill_n(c.impulse, 3, 0.0);
    c.friction = 0;
    c.bias = rows[i].velocity;
    c.response.nn += rows[i].softness - c.softness;
    c.softness = rows[i].softness;
  }
  for (std::size_t i = 0; i < work.scalars.size(); ++i) {
    work.scalars[i].impulse = 0;
    work.scalars[i].bias = scalar_biases[i];
  }
  work.condensed = !work.answers.empty();
  work.rates.assign(work.rates.size(), 0.0);
}

void unpack_velocities(const Workspace& work) {
  for (const Packed& mover : work.movers)
    if (mover.free && mover.source != nullptr) std::copy_n(mover.v, 6, mover.source);
}

void unpack(const Workspace& work, std::span<Row> rows, std::span<ScalarRow> scalars) {
  unpack_velocities(work);
  for (std::size_t i = 0; i < rows.size(); ++i) std::copy_n(work.points[i].impulse, 3, rows[i].impulse.data());
  for (std::size_t i = 0; i < scalars.size(); ++i) scalars[i].impulse = work.scalars[i].impulse;
}

void velocity(const Workspace& work, std::size_t contact, double u[3]) {
  if (work.condensed) {
    std::copy_n(&work.rates[3 * contact], 3, u);
    return;
  }
  const Point& c = work.points[contact];
  const Packed& a = work.movers[static_cast<std::size_t>(c.a)];
  const Packed& b = work.movers[static_cast<std::size_t>(c.b)];
  if (c.plain) return plain_velocity(c, a, b, u);
  const Sides& sides = work.sides[contact];
  u[0] = u[1] = u[2] = 0;
  if (sides.ja != nullptr)
    add_velocity(&work.columns[sides.columns_a], sides.reach_a, a, 1, u);
  else if (c.a != 0)
    add_velocity(c, c.arm_a, a, 1, u);
  if (sides.jb != nullptr)
    add_velocity(&work.columns[sides.columns_b], sides.reach_b, b, -1, u);
  else if (c.b != 0)
    add_velocity(c, c.arm_b, b, -1, u);
}

void push(Workspace& work, std::size_t contact, const double p[3]) {
  if (work.condensed) {
    const std::size_t n = work.rates.size();
    push_columns(&work.answers[3 * contact * n], static_cast<int>(n), p, work.rates.data());
    return;
  }
  const Point& c = work.points[contact];
  Packed& a = work.movers[static_cast<std::size_t>(c.a)];
  Packed& b = work.movers[static_cast<std::size_t>(c.b)];
  if (c.plain) return plain_push(c, a, b, p);
  const Sides& sides = work.sides[contact];
  const auto by_arm = [&](Packed& m, const double arm[3], double sign) {
    const double x = c.normal[0] * p[0] + c.tangent1[0] * p[1] + c.tangent2[0] * p[2];
    const double y = c.normal[1] * p[0] + c.tangent1[1] * p[1] + c.tangent2[1] * p[2];
    const double z = c.normal[2] * p[0] + c.tangent1[2] * p[1] + c.tangent2[2] * p[2];
    plain_push(m, arm, sign * x, sign * y, sign * z);
  };
  if (sides.ja != nullptr)
    push_columns(sides.ra, a.size, p, a.now());
  else if (c.a != 0)
    by_arm(a, c.arm_a, 1);
  const double opposite[3] = {-p[0], -p[1], -p[2]};
  if (sides.jb != nullptr)
    push_columns(sides.rb, b.size, opposite, b.now());
  else if (c.b != 0)
    by_arm(b, c.arm_b, -1);
}

double velocity(const Workspace& work, const PackedScalar& row) {
  if (work.condensed) return work.rates[row_of(work, row)];
  double u = 0;
  if (row.ja != nullptr) {
    const Packed& a = work.movers[static_cast<std::size_t>(row.a)];
    u += dot(row.ja + row.first_a, a.now() + row.first_a, row.reach_a - row.first_a);
  }
  if (row.jb != nullptr) {
    const Packed& b = work.movers[static_cast<std::size_t>(row.b)];
    u -= dot(row.jb + row.first_b, b.now() + row.first_b, row.reach_b - row.first_b);
  }
  return u;
}

void push(Workspace& work, const PackedScalar& row, double impulse) {
  if (work.condensed) {
    const std::size_t n = work.rates.size();
    add_multiple(impulse, &work.answers[row_of(work, row) * n], static_cast<int>(n), work.rates.data());
    return;
  }
  const auto add = [&](int mover, const double* r, double sign) {
    if (r == nullptr) return;
    Packed& m = work.movers[static_cast<std::size_t>(mover)];
    add_multiple(sign * impulse, r, m.size, m.now());
  };
  add(row.a, row.ra, 1);
  add(row.b, row.rb, -1);
}

}  // namespace breve::contact
