// The sweeps of a pile: nothing but arithmetic in the loops.
#include "runtime/contact/plain.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/contact/visit.hpp"

namespace breve::contact {

namespace {

struct Velocities {
  Lanes v[6];
  void read(const Packed& a, const Packed& b) {
    for (int k = 0; k < 6; ++k) v[k] = Lanes{a.v[k], b.v[k]};
  }
  void write(Packed& a, Packed& b) const {
    for (int k = 0; k < 6; ++k) {
      a.v[k] = v[k][0];
      b.v[k] = v[k][1];
    }
  }
  void at(const PlainPoint& c, double u[3]) const {
    const Lanes x = v[0] + v[4] * c.arm[2] - v[5] * c.arm[1];
    const Lanes y = v[1] + v[5] * c.arm[0] - v[3] * c.arm[2];
    const Lanes z = v[2] + v[3] * c.arm[1] - v[4] * c.arm[0];
    u[0] = x[0] - x[1];
    u[1] = y[0] - y[1];
    u[2] = z[0] - z[1];
  }
  void push(const PlainPoint& c, const double p[3]) {
    const Lanes x = both(p[0]), y = both(p[1]), z = both(p[2]);
    v[0] += c.mass * x;
    v[1] += c.mass * y;
    v[2] += c.mass * z;
    for (int k = 0; k < 3; ++k) v[3 + k] += c.angular[3 * k] * x + c.angular[3 * k + 1] * y + c.angular[3 * k + 2] * z;
  }
};

double along(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void to_world(const Point& c, const double p[3], double out[3]) {
  for (int k = 0; k < 3; ++k) out[k] = c.normal[k] * p[0] + c.tangent1[k] * p[1] + c.tangent2[k] * p[2];
}

void to_local(const Point& c, const double p[3], double out[3]) {
  out[0] = along(c.normal, p);
  out[1] = along(c.tangent1, p);
  out[2] = along(c.tangent2, p);
}

/// The impulse of a contact that slides: in its own axes.
void slide(Point& own, const double u[3], PlainPoint& c, double next[3]) {
  double local[3], change[3];
  to_local(own, u, local);
  to_local(own, c.impulse, own.impulse);
  visit(own, local, change);
  to_world(own, own.impulse, next);
}

/// The contact's next impulse, by the velocity there.
inline void answer(Point& own, const double u[3], PlainPoint& c, double next[3]) {
  const double* n = c.normal;
  const double normal = along(n, u);
  next[0] = next[1] = next[2] = 0;
  if (!(normal - c.bias < along(c.coupling, c.impulse)) || !(c.give > 0)) return;  // it opens
  const double rest = c.softness * c.pressed - c.bias;
  if (c.friction == 0) {
    const double p = std::max(0.0, c.pressed - (normal + rest) / c.give);
    for (int k = 0; k < 3; ++k) next[k] = p * n[k];
    return;
  }
  const double e[3] = {u[0] + rest * n[0], u[1] + rest * n[1], u[2] + rest * n[2]};
  const double* W = c.inverse;
  next[0] = c.impulse[0] - (W[0] * e[0] + W[1] * e[1] + W[2] * e[2]);
  next[1] = c.impulse[1] - (W[1] * e[0] + W[3] * e[1] + W[4] * e[2]);
  next[2] = c.impulse[2] - (W[2] * e[0] + W[4] * e[1] + W[5] * e[2]);
  const double pressed = along(n, next), radius = c.friction * pressed;
  if (!(pressed > 0 && along(next, next) - pressed * pressed <= radius * radius)) slide(own, u, c, next);
}

/// How an impulse changes the spin of a body: its inverse inertia times [arm]x.
void angular_response(const Packed& m, const double arm[3], double out[9]) {
  const double* I = m.inertia;
  const double rows[3][3] = {{I[0], I[1], I[2]}, {I[1], I[3], I[4]}, {I[2], I[4], I[5]}};
  for (int k = 0; k < 3; ++k) {
    const double* row = rows[k];
    out[3 * k] = row[1] * arm[2] - row[2] * arm[1];
    out[3 * k + 1] = row[2] * arm[0] - row[0] * arm[2];
    out[3 * k + 2] = row[0] * arm[1] - row[1] * arm[0];
  }
}

/// A^T M A of a symmetric matrix in the contact's axes.
void rotate_to_world(const Point& c, const LocalMatrix& M, double out[6]) {
  const double rows[3][3] = {{M.nn, M.n1, M.n2}, {M.n1, M.s11, M.s12}, {M.n2, M.s12, M.s22}};
  double rotated[3][3];
  for (int k = 0; k < 3; ++k) to_world(c, rows[k], rotated[k]);
  int at = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = i; k < 3; ++k)
      out[at++] = c.normal[i] * rotated[0][k] + c.tangent1[i] * rotated[1][k] + c.tangent2[i] * rotated[2][k];
}

void fill_plain(const Point& own, const std::pmr::vector<Packed>& movers, PlainPoint& c) {
  c.a = own.a;
  c.b = own.b;
  const Packed &a = movers[static_cast<std::size_t>(c.a)], &b = movers[static_cast<std::size_t>(c.b)];
  double angular_a[9], angular_b[9];
  angular_response(a, own.arm_a, angular_a);
  angular_response(b, own.arm_b, angular_b);
  for (int k = 0; k < 9; ++k) c.angular[k] = Lanes{angular_a[k], -angular_b[k]};
  c.mass = Lanes{a.inverse_mass, -b.inverse_mass};
  for (int k = 0; k < 3; ++k) {
    c.arm[k] = Lanes{own.arm_a[k], own.arm_b[k]};
    c.normal[k] = own.normal[k];
  }
  c.softness = own.softness;
  c.give = own.response.nn;
  c.largest = std::max({own.response.nn, own.response.s11, own.response.s22});
  rotate_to_world(own, own.inverse, c.inverse);
  const double row[3] = {own.response.nn - own.softness, own.response.n1, own.response.n2};
  to_world(own, row, c.coupling);
}

}  // namespace

bool is_plain(const Workspace& work) {
  return work.scalars.empty() &&
         std::all_of(work.points.begin(), work.points.end(), [](const Point& c) { return c.plain; });
}

void enter_plain(Workspace& work) {
  if (!std::exchange(work.has_plain, true)) {
    if (work.plain.size() < work.points.size()) work.plain.resize(work.points.size());
    for (std::size_t i = 0; i < work.points.size(); ++i) fill_plain(work.points[i], work.movers, work.plain[i]);
  }
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    const Point& own = work.points[i];
    PlainPoint& c = work.plain[i];
    to_world(own, own.impulse, c.impulse);
    std::fill_n(c.way, 3, 0.0);
    c.pressed = own.impulse[0];
    c.bias = own.bias;
    c.friction = own.friction;
  }
}

void leave_plain(Workspace& work) {
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    const PlainPoint& c = work.plain[i];
    double* p = work.points[i].impulse;
    to_local(work.points[i], c.impulse, p);
    if (c.friction == 0) p[1] = p[2] = 0;
  }
}

namespace {

/// Velocities of the bodies of the last point: those of a pair follow one another.
class Carried {
 public:
  explicit Carried(Workspace& work) : movers_(work.movers.data()) {}
  ~Carried() { put_back(); }
  Carried(const Carried&) = delete;
  Carried& operator=(const Carried&) = delete;

  Velocities& of(const PlainPoint& c) {
    Packed *const a = movers_ + c.a, *const b = movers_ + c.b;
    if (a == a_ && b == b_) return velocities_;
    put_back();
    a_ = a;
    b_ = b;
    velocities_.read(*a, *b);
    return velocities_;
  }

 private:
  void put_back() {
    if (a_ != nullptr) velocities_.write(*a_, *b_);
  }
  Packed *const movers_, *a_ = nullptr, *b_ = nullptr;
  Velocities velocities_;
};

}  // namespace

Moved sweep_plain(Workspace& work, bool backward) {
  Moved moved;
  Carried carried(work);
  const std::size_t count = work.points.size();
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t i = backward ? count - 1 - n : n;
    PlainPoint& c = work.plain[i];
    Velocities& velocities = carried.of(c);
    double u[3], next[3];
    velocities.at(c, u);
    answer(work.points[i], u, c, next);
    for (int k = 0; k < 3; ++k) c.step[k] = next[k] - c.impulse[k];
    const double change = std::max({std::abs(c.step[0]), std::abs(c.step[1]), std::abs(c.step[2])}) * c.largest;
    if (!(change > 0)) continue;
    velocities.push(c, c.step);
    for (int k = 0; k < 3; ++k) c.impulse[k] = next[k];
    c.pressed = along(c.normal, next);
    moved.largest = std::max(moved.largest, change);
    moved.energy += along(c.step, c.step) * c.largest;
  }
  return moved;
}

void go_on_plain(Workspace& work, double share) {
  Carried carried(work);
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    PlainPoint& c = work.plain[i];
    const double more[3] = {share * c.way[0], share * c.way[1], share * c.way[2]};
    for (int k = 0; k < 3; ++k) c.way[k] = more[k] + c.step[k];
    if (more[0] == 0 && more[1] == 0 && more[2] == 0) continue;
    carried.of(c).push(c, more);
    for (int k = 0; k < 3; ++k) c.impulse[k] += more[k];
    c.pressed = along(c.normal, c.impulse);
  }
}

}  // namespace breve::contact
