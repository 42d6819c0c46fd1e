// W is made of the rows' matrices, block by block below the diagonal.
#include "runtime/contact/condensed.hpp"

#include <algorithm>

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

/// W of all points, with `each` rows, and then of all scalar rows: symmetric, row by row.
void fill(const Workspace& work, std::size_t each, std::pmr::vector<double>& out) {
  const std::size_t points = work.points.size(), n = each * points + work.scalars.size();
  out.assign(n * n, 0.0);
  double* const W = out.data();
  const auto each_up_to = [&](std::size_t end, auto&& f) {
    for (std::size_t i = 0; i < points && each * i <= end; ++i) f(Block(work, i, static_cast<int>(each)), each * i);
    for (std::size_t i = 0; i < work.scalars.size() && each * points + i <= end; ++i)
      f(Block(work, work.scalars[i]), each * points + i);
  };
  each_up_to(n, [&](const Block& from, std::size_t at_from) {
    each_up_to(at_from, [&](const Block& to, std::size_t at_to) { couple(from, at_from, to, at_to, n, W); });
  });
  // A block on the diagonal has both halves: its upper one is also dropped here.
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < i; ++k) W[k * n + i] = W[i * n + k];
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
  if (work.normal_answers.empty()) fill(work, 1, work.normal_answers);
  return true;
}

void expand(Workspace& work) {
  if (!work.condensed && !work.by_normals) return;
  work.condensed = work.by_normals = false;
  push_all(work);
}

}  // namespace breve::contact
