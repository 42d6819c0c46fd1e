// Impacts in groups. Order matters where three bodies touch in a row: the fastest first is how a cradle's shock
// travels.
#include "runtime/contact/impacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/contact/impact_law.hpp"
#include "runtime/contact/pack.hpp"
#include "runtime/contact/sweep.hpp"

namespace breve::contact {

namespace {

constexpr int kSweeps = 300;  // for the points of one pair; a handful converge in far fewer

/// The indices in `order` that belong to one pair.
using Points = std::span<const int>;

void make_rigid(Point& c) {
  if (c.softness == 0) return;
  c.response.nn -= c.softness;
  c.softness = 0;
  c.inverse = regular_inverse(c.response);
}

double approach_speed(const Workspace& work, int point) {
  double u[3];
  velocity(work, static_cast<std::size_t>(point), u);
  return -u[0];
}

/// Points of each pair beside each other, pairs in the order of their first points.
void sort_by_pair(std::span<const Row> rows, Workspace& work) {
  work.order.clear();
  work.firsts.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) work.order.push_back(static_cast<int>(i));
  std::sort(work.order.begin(), work.order.end(), [&](int x, int y) {
    const int pair_x = rows[static_cast<std::size_t>(x)].pair, pair_y = rows[static_cast<std::size_t>(y)].pair;
    return pair_x != pair_y ? pair_x < pair_y : x < y;
  });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto pair = [&](std::size_t k) { return rows[static_cast<std::size_t>(work.order[k])].pair; };
    if (i == 0 || pair(i) != pair(i - 1)) work.firsts.push_back(static_cast<int>(i));
  }
}

Points points_of(const Workspace& work, std::size_t pair) {
  const auto first = static_cast<std::size_t>(work.firsts[pair]);
  const auto end = pair + 1 < work.firsts.size() ? static_cast<std::size_t>(work.firsts[pair + 1]) : work.order.size();
  return {work.order.data() + first, end - first};
}

/// The pair with the fastest approach that its law lets bounce; -1: none.
int next_pair(const Workspace& work, std::span<const Law> laws, double tolerance) {
  int found = -1;
  double fastest = tolerance;
  int first_point = std::numeric_limits<int>::max();
  for (std::size_t pair = 0; pair < work.firsts.size(); ++pair)
    for (const int point : points_of(work, pair)) {
      const Law& law = laws[static_cast<std::size_t>(point)];
      const double speed = approach_speed(work, point);
      if (!(law.restitution > 0) || speed < law.restitution_threshold || speed < fastest) continue;
      if (speed == fastest && point > first_point) continue;
      fastest = speed;
      first_point = point;
      found = static_cast<int>(pair);
    }
  return found;
}

void collide_in_point(Workspace& work, int point, const Law& law) {
  const auto at = static_cast<std::size_t>(point);
  Point& c = work.points[at];
  const LocalMatrix& W = c.response;
  Matrix3 response;
  response << W.nn, W.n1, W.n2, W.n1, W.s11, W.s12, W.n2, W.s12, W.s22;
  Vector3 u;
  velocity(work, at, u.data());
  const Vector3 p = impact_impulse(response, u, Vector3::UnitX(), law);
  push(work, at, p.data());
  for (int k = 0; k < 3; ++k) c.impulse[k] += p[k];
}

/// The impulses of a pair's points from here on, with u before them; in work.saved, six numbers a point.
struct Shock {
  Workspace& work;
  Points points;

  double* before(std::size_t i) { return work.saved.data() + 6 * i; }
  double* plain(std::size_t i) { return work.saved.data() + 6 * i + 3; }

  void begin() {
    work.saved.resize(6 * points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      velocity(work, static_cast<std::size_t>(points[i]), before(i));
      std::fill_n(at(i).impulse, 3, 0.0);
    }
  }
  Point& at(std::size_t i) { return work.points[static_cast<std::size_t>(points[i])]; }

  void solve(double tolerance) {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      double largest = 0;
      for (const int point : points) largest = std::max(largest, visit_point(work, static_cast<std::size_t>(point)));
      if (largest <= 0.1 * tolerance) return;
    }
  }

  /// Energy gained since `before`: half of p.(u before + u now).
  double gained() {
    double sum = 0, u[3];
    for (std::size_t i = 0; i < points.size(); ++i) {
      velocity(work, static_cast<std::size_t>(points[i]), u);
      for (int k = 0; k < 3; ++k) sum += 0.5 * at(i).impulse[k] * (before(i)[k] + u[k]);
    }
    return sum;
  }

  /// Impulses become (1 - share) * plain + share * present.
  void go_back(double share) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      double* p = at(i).impulse;
      double change[3];
      for (int k = 0; k < 3; ++k) change[k] = (1 - share) * (plain(i)[k] - p[k]);
      push(work, static_cast<std::size_t>(points[i]), change);
      for (int k = 0; k < 3; ++k) p[k] += change[k];
    }
  }
};

void collide_in_points(Workspace& work, Points points, std::span<const Law> laws, double tolerance) {
  Shock shock{work, points};
  // What these points had before is added again at the end.
  work.earlier.clear();
  for (std::size_t i = 0; i < points.size(); ++i)
    work.earlier.insert(work.earlier.end(), shock.at(i).impulse, shock.at(i).impulse + 3);
  shock.begin();
  for (std::size_t i = 0; i < points.size(); ++i) {
    shock.at(i).bias = 0;
    shock.at(i).friction = laws[static_cast<std::size_t>(points[i])].dynamic_friction;
    std::fill_n(shock.plain(i), 3, 0.0);
  }
  shock.solve(tolerance);
  double least = shock.gained();
  if (least > 0) {
    shock.go_back(0);
    least = 0;
  }
  for (std::size_t i = 0; i < points.size(); ++i) std::copy_n(shock.at(i).impulse, 3, shock.plain(i));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Law& law = laws[static_cast<std::size_t>(points[i])];
    const double speed = -shock.before(i)[0];
    shock.at(i).bias = speed > 0 && speed >= law.restitution_threshold ? law.restitution * speed : 0;
  }
  shock.solve(tolerance);
  // Along the way from the plain impulses to these the energy is a convex parabola, from `least` <= 0 up to `full`.
  const double full = shock.gained();
  if (full > 0) {
    shock.go_back(0.5);
    const double half = shock.gained();
    const double a = 2 * (full + least) - 4 * half, b = full - least - a;
    const double root = a > 0 ? (-b + std::sqrt(std::max(0.0, b * b - 4 * a * least))) / (2 * a) : 0;
    // Half the way is taken already: the rest is counted from there.
    shock.go_back(2 * std::clamp(root * (1 - 1e-12), 0.0, 1.0));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    shock.at(i).bias = 0;
    for (int k = 0; k < 3; ++k) shock.at(i).impulse[k] += work.earlier[3 * i + static_cast<std::size_t>(k)];
  }
}

/// One solve of all rows without rebound, its impulses added to those of the impacts.
void stop_the_rest(std::span<const Mover> movers, std::span<Row> rows, std::span<ScalarRow> scalars,
                   const ImpactSettings& settings, Workspace& work) {
  work.earlier.clear();
  for (Row& row : rows) {
    work.earlier.insert(work.earlier.end(), row.impulse.data(), row.impulse.data() + 3);
    row.impulse.setZero();
    std::swap(row.bias, work.biases.emplace_back(0.0));
  }
  solve_island(movers, rows, scalars, settings.rest, work);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (int k = 0; k < 3; ++k) rows[i].impulse[k] += work.earlier[3 * i + static_cast<std::size_t>(k)];
    std::swap(rows[i].bias, work.biases[i]);
  }
}

}  // namespace

ImpactReport resolve_impacts(std::span<const Mover> movers, std::span<Row> rows, std::span<const Law> laws,
                             std::span<ScalarRow> scalars, const ImpactSettings& settings, Workspace& work) {
  ImpactReport report;
  for (Row& row : rows) row.impulse.setZero();
  for (ScalarRow& row : scalars) row.impulse = 0;
  pack(movers, rows, scalars, work);
  for (Point& c : work.points) make_rigid(c);
  sort_by_pair(rows, work);
  while (report.impacts < settings.most) {
    const int pair = next_pair(work, laws, settings.tolerance);
    if (pair < 0) break;
    const Points points = points_of(work, static_cast<std::size_t>(pair));
    if (points.size() == 1)
      collide_in_point(work, points[0], laws[static_cast<std::size_t>(points[0])]);
    else
      collide_in_points(work, points, laws, settings.tolerance);
    ++report.impacts;
  }
  report.settled = scalars.empty();
  for (std::size_t i = 0; i < rows.size(); ++i)
    report.settled = report.settled && approach_speed(work, static_cast<int>(i)) <= settings.tolerance;
  unpack(work, rows, scalars);
  if (!report.settled) {
    work.biases.clear();
    stop_the_rest(movers, rows, scalars, settings, work);
  }
  return report;
}

}  // namespace breve::contact
