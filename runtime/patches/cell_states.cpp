// Sums of neighbours are separable: along z, along y, along x, each a pass of additions over neighbouring slabs. So a
// Moore neighbourhood costs six additions a cell, sixteen cells at a time.
#include "runtime/patches/cell_states.hpp"

#include <algorithm>
#include <bit>

namespace breve {

namespace {

using Byte = std::uint8_t;

constexpr std::size_t kChunk = 4096;  // cells at a time, so that what the rule reads stays in the nearest cache

void add(Byte* __restrict to, const Byte* __restrict from, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<Byte>(to[i] + from[i]);
}

bool is_flat(Neighborhood kind) { return kind == Neighborhood::Moore || kind == Neighborhood::VonNeumann; }
bool is_moore(Neighborhood kind) { return kind == Neighborhood::Moore || kind == Neighborhood::Moore3; }

/// to += the neighbours of `from` along an axis of `count` cells that lie `slab` elements apart.
void add_along(std::span<Byte> to, std::span<const Byte> from, std::size_t count, std::size_t slab, bool wraps) {
  if (count < 2) return;  // a cell that is its own neighbour is not counted
  const std::size_t block = count * slab, inner = block - slab;
  for (std::size_t start = 0; start < from.size(); start += block) {
    add(to.data() + start, from.data() + start + slab, inner);
    add(to.data() + start + slab, from.data() + start, inner);
    if (wraps && count > 2) {  // of two, each is the other's one neighbour
      add(to.data() + start + inner, from.data() + start, slab);
      add(to.data() + start, from.data() + start + inner, slab);
    }
  }
}

/// out |= chosen where sum == wanted
void mark(Byte* __restrict out, const Byte* __restrict sum, const Byte* __restrict alive, Byte wanted, Byte if_alive,
          std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    out[i] =
        static_cast<Byte>(out[i] | (static_cast<Byte>(sum[i] == wanted) & static_cast<Byte>(alive[i] == if_alive)));
}

}  // namespace

std::size_t CellStates::count(std::uint8_t state) const {
  return static_cast<std::size_t>(std::count(now_.begin(), now_.end(), state));
}

int CellStates::neighbors(const Grid& grid, Neighborhood kind, CellIndex cell) const {
  const Cell3 c = grid.cell(cell);
  const bool moore = is_moore(kind);
  const auto reach = [&](int count) { return count > 1 ? 1 : 0; };
  const int rx = reach(grid.nx()), ry = reach(grid.ny()), rz = is_flat(kind) ? 0 : reach(grid.nz());
  int sum = 0;
  for (int x = -rx; x <= rx; ++x) {
    for (int y = -ry; y <= ry; ++y) {
      for (int z = -rz; z <= rz; ++z) {
        const int steps = (x != 0 ? 1 : 0) + (y != 0 ? 1 : 0) + (z != 0 ? 1 : 0);
        if (steps == 0 || (!moore && steps > 1)) continue;
        // On a toroid of two cells the step up and the step down meet in one cell, which counts once.
        if (grid.wraps() && ((x == 1 && grid.nx() == 2) || (y == 1 && grid.ny() == 2) || (z == 1 && grid.nz() == 2)))
          continue;
        const CellIndex other = grid.at(c.x + x, c.y + y, c.z + z);
        if (other != kNoCell && now_[other] != 0) ++sum;
      }
    }
  }
  return sum;
}

/// Into rows_: first n bytes of 0 and 1, behind them for each cell the sum of itself and its neighbours.
void CellStates::sum_block(const Grid& grid, Neighborhood kind) {
  const std::size_t n = now_.size();
  rows_.resize(2 * n);
  next_.resize(n);
  const std::span<Byte> alive(rows_.data(), n), sum(rows_.data() + n, n), part(next_.data(), n);
  for (std::size_t i = 0; i < n; ++i) alive[i] = now_[i] != 0 ? 1 : 0;
  const auto nx = static_cast<std::size_t>(grid.nx()), ny = static_cast<std::size_t>(grid.ny()),
             nz = static_cast<std::size_t>(grid.nz());
  std::copy(alive.begin(), alive.end(), sum.begin());
  if (!is_moore(kind)) {
    add_along(sum, alive, nx, ny * nz, grid.wraps());
    add_along(sum, alive, ny, nz, grid.wraps());
    if (!is_flat(kind)) add_along(sum, alive, nz, 1, grid.wraps());
    return;
  }
  if (!is_flat(kind) && nz > 1) add_along(sum, alive, nz, 1, grid.wraps());
  std::copy(sum.begin(), sum.end(), part.begin());
  add_along(sum, part, ny, nz, grid.wraps());
  std::copy(sum.begin(), sum.end(), part.begin());
  add_along(sum, part, nx, ny * nz, grid.wraps());
}

std::span<const std::uint8_t> CellStates::neighbor_counts(const Grid& grid, Neighborhood kind) {
  sum_block(grid, kind);
  const std::size_t n = now_.size();
  Byte* const sum = rows_.data() + n;
  for (std::size_t i = 0; i < n; ++i) sum[i] = static_cast<Byte>(sum[i] - rows_[i]);
  return {sum, n};
}

void CellStates::step_at_once(const Grid& grid, Neighborhood kind, const TotalisticRule& rule, const Poll& poll) {
  sum_block(grid, kind);
  if (poll) poll();
  const std::size_t n = now_.size();
  const Byte* const alive = rows_.data();
  const Byte* const sum = rows_.data() + n;
  for (std::size_t start = 0; start < n; start += kChunk) {
    const std::size_t count = std::min(kChunk, n - start);
    Byte* const out = next_.data() + start;
    std::fill_n(out, count, Byte{0});
    // A living cell is in its own sum.
    for (std::uint32_t bits = rule.born; bits != 0; bits &= bits - 1)
      mark(out, sum + start, alive + start, static_cast<Byte>(std::countr_zero(bits)), 0, count);
    for (std::uint32_t bits = rule.survive; bits != 0; bits &= bits - 1)
      mark(out, sum + start, alive + start, static_cast<Byte>(std::countr_zero(bits) + 1), 1, count);
    if (poll) poll();
  }
  now_.swap(next_);
}

void CellStates::step(const Grid& grid, Neighborhood kind, const TotalisticRule& rule, UpdateOrder order,
                      Random& random, const Poll& poll) {
  if (order == UpdateOrder::Synchronous) return step_at_once(grid, kind, rule, poll);
  std::pmr::vector<CellIndex> cells(now_.get_allocator());
  if (order == UpdateOrder::Random) shuffled(now_.size(), random, cells);
  constexpr std::size_t kBetweenPolls = 1 << 16;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (poll && i % kBetweenPolls == 0) poll();
    const CellIndex cell = order == UpdateOrder::Random ? cells[i] : static_cast<CellIndex>(i);
    const std::uint32_t mask = now_[cell] != 0 ? rule.survive : rule.born;
    now_[cell] = static_cast<Byte>(mask >> neighbors(grid, kind, cell) & 1U);
  }
}

void CellStates::begin() {
  next_ = now_;
  buffered_ = true;
}

void CellStates::end() {
  now_.swap(next_);
  buffered_ = false;
}

void CellStates::save(ByteWriter& out) const {
  out.put(made());
  if (made()) out.raw(now_.data(), now_.size());
}

void CellStates::load(ByteReader& in, const Grid& grid) {
  if (!in.get_bool()) return;
  if (grid.cells() > in.left()) ByteReader::fail();
  make(grid);
  in.raw(now_.data(), now_.size());
}

void CellStates::hash(Hasher& hasher) const {
  hasher.add(std::string_view(reinterpret_cast<const char*>(now_.data()), now_.size()));
}

void shuffled(std::size_t count, Random& random, std::pmr::vector<CellIndex>& out) {
  out.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto j = static_cast<std::size_t>(random.below(i + 1));
    out[i] = out[j];
    out[j] = static_cast<CellIndex>(i);
  }
}

}  // namespace breve
