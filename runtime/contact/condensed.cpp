// W is made of the rows' matrices, block by block below the diagonal.
#include "runtime/contact/condensed.hpp"

#include <algorithm>
#include <span>

#include "runtime/contact/bilateral.hpp"
#include "runtime/contact/pack.hpp"
#include "runtime/contact/plain.hpp"
#include "runtime/contact/sides.hpp"
#include "runtime/contact/sweep.hpp"

namespace breve::contact {

namespace {

constexpr std::size_t kMostRows = 32;        // beyond it most rows do not feel one another, and W is mostly zeros
constexpr std::size_t kMostEquations = 400;  // where W is solved, not swept
constexpr std::size_t kMostNormals = 64;     // beyond it a push at a row takes longer at all others than at its movers

/// Of one or three rows on both of their movers.
struct Block {
  int movers[2];
  SideMatrices sides[2];
  int rows;

  /// @param count  3, or 1 for the normal alone
  Block(const Workspace& work, std::size_t point, int count) : rows(count) {
    const Point& c = work.points[point];
    const Sides& own = work.sides[point];
    movers[0] = c.a;
    movers[1] = c.b;
    sides[0].read(work.movers[static_cast<std::size_t>(c.a)], own.ja, own.ra, c, c.arm_a);
    sides[1].read(work.movers[static_cast<std::size_t>(c.b)], own.jb, own.rb, c, c.arm_b);
  }
  Block(const Workspace& work, const PackedScalar& row) : movers{row.a, row.b}, rows(1) {
    sides[0].j = row.ja;
    sides[0].r = row.ra;
    sides[1].j = row.jb;
    sides[1].r = row.rb;
    for (int x = 0; x < 2; ++x)
      sides[x].size = sides[x].j == nullptr ? 0 : work.movers[static_cast<std::size_t>(movers[x])].size;
  }
};

/// What impulses at `to` do to the velocities at `from`; and the other way round, since W is symmetric.
void couple(const Block& from, std::size_t at_from, const Block& to, std::size_t at_to, std::size_t n, double* W) {
  for (int x = 0; x < 2; ++x)
    for (int y = 0; y < 2; ++y) {
      const SideMatrices &J = from.sides[x], &R = to.sides[y];
      if (J.size == 0 || R.size == 0 || from.movers[x] != to.movers[y]) continue;
      const double sign = x == y ? 1 : -1;
      for (int i = 0; i < from.rows; ++i)
        for (int k = 0; k < to.rows; ++k)
          W[(at_from + static_cast<std::size_t>(i)) * n + at_to + static_cast<std::size_t>(k)] +=
              sign * dot(J.j + i * J.size, R.r + k * J.size, J.size);
    }
}

/// Where rows move one tree alone: all of them, in work.lone, a point having `each`.
/// @return  whether it is so
bool find_lone_rows(Workspace& work, std::size_t each) {
  std::pmr::vector<LoneRow>& out = work.lone;
  int only = 0;
  const auto alone = [&](int a, const double* ja, int b, const double* jb) {
    const int mover = ja != nullptr ? a : b;
    if ((ja == nullptr) == (jb == nullptr) || (ja != nullptr ? b : a) != 0) return false;
    if (only == 0) only = mover;
    return mover == only;
  };
  out.clear();
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    const Point& c = work.points[i];
    const Sides& own = work.sides[i];
    if (!alone(c.a, own.ja, c.b, own.jb)) return false;
    const bool first = own.ja != nullptr;
    const int size = work.movers[static_cast<std::size_t>(only)].size;
    for (int k = 0; k < static_cast<int>(each); ++k)
      out.push_back({(first ? own.ja : own.jb) + k * size, (first ? own.ra : own.rb) + k * size, 0,
                     first ? own.reach_a : own.reach_b, first});
  }
  for (const PackedScalar& row : work.scalars) {
    if (!alone(row.a, row.ja, row.b, row.jb)) return false;
    const bool first = row.ja != nullptr;
    out.push_back({first ? row.ja : row.jb, first ? row.ra : row.rb, first ? row.first_a : row.first_b,
                   first ? row.reach_a : row.reach_b, first});
  }
  return only != 0;
}

/// The lower half of W.
void fill_lone(std::span<const LoneRow> rows, double* W) {
  const std::size_t n = rows.size();
  for (std::size_t i = 0; i < n; ++i) {
    const LoneRow& from = rows[i];
    for (std::size_t k = 0; k <= i; ++k) {
      const double answer = dot(from.j + from.first, rows[k].r + from.first, from.reach - from.first);
      W[i * n + k] = from.on_a == rows[k].on_a ? answer : -answer;
    }
  }
}

/// The same where there are several movers.
void fill_any(const Workspace& work, std::size_t each, double* W) {
  const std::size_t points = work.points.size(), n = each * points + work.scalars.size();
  const auto each_up_to = [&](std::size_t end, auto&& f) {
    for (std::size_t i = 0; i < points && each * i <= end; ++i) f(Block(work, i, static_cast<int>(each)), each * i);
    for (std::size_t i = 0; i < work.scalars.size() && each * points + i <= end; ++i)
      f(Block(work, work.scalars[i]), each * points + i);
  };
  each_up_to(n, [&](const Block& from, std::size_t at_from) {
    each_up_to(at_from, [&](const Block& to, std::size_t at_to) { couple(from, at_from, to, at_to, n, W); });
  });
}

/// W of all points, with `each` rows, and then of all scalar rows: symmetric, row by row.
void fill(Workspace& work, std::size_t each, std::pmr::vector<double>& out) {
  const std::size_t n = each * work.points.size() + work.scalars.size();
  out.assign(n * n, 0.0);
  double* const W = out.data();
  if (find_lone_rows(work, each))
    fill_lone(work.lone, W);
  else
    fill_any(work, each, W);
  // A block on the diagonal has both halves: its upper one is also dropped here.
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < i; ++k) W[k * n + i] = W[i * n + k];
}

/// From W of all rows.
void pick_normals(Workspace& work) {
  const std::size_t points = work.points.size(), n = points + work.scalars.size(), all = n + 2 * points;
  const auto place = [points](std::size_t i) { return i < points ? 3 * i : i + 2 * points; };
  work.normal_answers.resize(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) work.normal_answers[i * n + k] = work.answers[place(i) * all + place(k)];
}

}  // namespace

void condense(Workspace& work) {
  const std::size_t n = 3 * work.points.size() + work.scalars.size();
  std::size_t velocities = 0;
  for (const Packed& mover : work.movers)
    if (mover.source != nullptr) velocities += static_cast<std::size_t>(mover.size);
  work.condensed = n <= std::min(velocities, is_bilateral(work) ? kMostEquations : kMostRows);
  if (!work.condensed) return;
  work.rates.clear();
  for (const Sides& sides : work.sides)
    work.rates.insert(work.rates.end(), std::begin(sides.free_velocity), std::end(sides.free_velocity));
  for (const PackedScalar& row : work.scalars) work.rates.push_back(row.free_velocity);
  fill(work, 3, work.answers);
}

bool condense_normals(Workspace& work) {
  const std::size_t n = work.points.size() + work.scalars.size();
  if (n == 0 || n > kMostNormals || is_plain(work)) return false;
  if (!work.normal_answers.empty()) return true;
  if (work.answers.empty())
    fill(work, 1, work.normal_answers);
  else
    pick_normals(work);
  return true;
}

void expand(Workspace& work) {
  if (!work.condensed && !work.by_normals) return;
  work.condensed = work.by_normals = false;
  push_all(work);
}

}  // namespace breve::contact
