// Cells of a grid: geometry, Life against a bit-parallel implementation, agents on cells, images.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <set>

#include "runtime/base/error.hpp"
#include "runtime/patches/cell_states.hpp"
#include "runtime/patches/grid.hpp"
#include "runtime/patches/occupants.hpp"

namespace breve {
namespace {

constexpr TotalisticRule kLife{1U << 3, 1U << 2 | 1U << 3};

Grid plane(int nx, int ny, bool wraps) { return {{nx, ny, 1}, wraps, Vector3::Zero(), Vector3::Ones()}; }

struct Board {
  Grid grid;
  CellStates states{std::pmr::get_default_resource()};
  Random random{7};
  Board(int nx, int ny, bool wraps) : grid(plane(nx, ny, wraps)) { states.make(grid); }
  /// Rows of text, '#' is alive; the first at (x, y).
  void draw(int x, int y, const std::vector<std::string>& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < rows[i].size(); ++j)
        if (rows[i][j] == '#') states.set(grid.at(x + static_cast<int>(i), y + static_cast<int>(j), 0), 1);
  }
  void step(int times = 1) {
    for (int i = 0; i < times; ++i) states.step(grid, Neighborhood::Moore, kLife, UpdateOrder::Synchronous, random);
  }
  std::vector<std::uint8_t> now() const { return {states.all().begin(), states.all().end()}; }
};

TEST(Life, StillLifesStand) {
  Board board(20, 20, false);
  board.draw(1, 1, {"##", "##"});                       // block
  board.draw(6, 1, {".##.", "#..#", ".##."});           // beehive
  board.draw(12, 1, {".##.", "#..#", ".#.#", "..#."});  // loaf
  board.draw(1, 10, {"##.", "#.#", ".#."});             // boat
  board.draw(8, 10, {".#.", "#.#", ".#."});             // tub
  const auto before = board.now();
  board.step(10);
  EXPECT_EQ(board.now(), before);
}

/// The least period of what is drawn, up to `most`; 0 if there is none.
int period(Board board, int most) {
  const auto before = board.now();
  for (int i = 1; i <= most; ++i) {
    board.step();
    if (board.now() == before) return i;
  }
  return 0;
}

TEST(Life, OscillatorsHaveTheirPeriods) {
  Board blinker(9, 9, false);
  blinker.draw(4, 3, {"###"});
  EXPECT_EQ(period(blinker, 20), 2);
  Board beacon(9, 9, false);
  beacon.draw(2, 2, {"##..", "##..", "..##", "..##"});
  EXPECT_EQ(period(beacon, 20), 2);
  Board pulsar(19, 19, false);
  const std::string a = "..###...###..", b = "#....#.#....#", none = ".............";
  pulsar.draw(3, 3, {a, none, b, b, b, a, none, a, b, b, b, none, a});
  EXPECT_EQ(period(pulsar, 20), 3);
  Board pentadecathlon(20, 12, false);
  pentadecathlon.draw(5, 4, {".#.", ".#.", "#.#", ".#.", ".#.", ".#.", ".#.", "#.#", ".#.", ".#."});
  EXPECT_EQ(period(pentadecathlon, 40), 15);
}

TEST(Life, AGliderGoesRoundAToroid) {
  Board board(10, 10, true);
  board.draw(0, 0, {".#.", "..#", "###"});
  EXPECT_EQ(period(board, 100), 40) << "four steps for each cell along the diagonal";
}

TEST(Life, GospersGunFiresEveryThirtySteps) {
  // On a board whose edges swallow gliders, the gun's own part of it repeats, and a glider more has left.
  Board board(12, 40, false);
  board.draw(1, 1,
             {"........................#...........", "......................#.#...........",
              "............##......##............##", "...........#...#....##............##",
              "##........#.....#...##..............", "##........#...#.##....#.#...........",
              "..........#.....#.......#...........", "...........#...#....................",
              "............##......................"});
  const auto gun = [&] {
    std::vector<std::uint8_t> cells;
    for (int x = 0; x < 10; ++x)
      for (int y = 0; y < 22; ++y) cells.push_back(board.states.get(board.grid.at(x, y, 0)));
    return cells;
  };
  const auto before = gun();
  board.step(29);
  EXPECT_NE(gun(), before);
  board.step(1);
  EXPECT_EQ(gun(), before);
  board.step(30);
  EXPECT_EQ(gun(), before);
  Board wide(60, 60, false);
  wide.draw(1, 1,
            {"........................#...........", "......................#.#...........",
             "............##......##............##", "...........#...#....##............##",
             "##........#.....#...##..............", "##........#...#.##....#.#...........",
             "..........#.....#.......#...........", "...........#...#....................",
             "............##......................"});
  const auto alive = [&] { return wide.states.count(1); };
  wide.step(30);
  const std::size_t first = alive();
  wide.step(30);
  EXPECT_EQ(alive(), first + 5) << "a glider of five cells more";
}

/// Life on a torus of 256 x 256 with a row in four words: bits are cells, sums are adders of whole rows.
class BitLife {
 public:
  using Row = std::array<std::uint64_t, 4>;
  std::array<Row, 256> rows{};

  void step() {
    std::array<Row, 256> fresh{};
    for (std::size_t r = 0; r < 256; ++r) {
      const Row& up = rows[(r + 255) % 256];
      const Row& down = rows[(r + 1) % 256];
      for (std::size_t w = 0; w < 4; ++w) {
        const std::uint64_t parts[8] = {left(up, w),       up[w],         right(up, w), left(rows[r], w),
                                        right(rows[r], w), left(down, w), down[w],      right(down, w)};
        // Counts of two bits; what carries out of them is "four or more" and so dead.
        std::uint64_t ones = 0, twos = 0, fours = 0;
        for (const std::uint64_t part : parts) {
          const std::uint64_t carry = ones & part;
          ones ^= part;
          fours |= twos & carry;
          twos ^= carry;
        }
        fresh[r][w] = twos & ~fours & (ones | rows[r][w]);
      }
    }
    rows = fresh;
  }

 private:
  static std::uint64_t left(const Row& row, std::size_t w) { return row[w] << 1 | row[(w + 3) % 4] >> 63; }
  static std::uint64_t right(const Row& row, std::size_t w) { return row[w] >> 1 | row[(w + 1) % 4] << 63; }
};

TEST(Life, AThousandGenerationsOfARandomStartAreThoseOfABitParallelOne) {
  Board board(256, 256, true);
  BitLife bits;
  Random random(42);
  for (int x = 0; x < 256; ++x) {
    for (int y = 0; y < 256; ++y) {
      if (random.below(3) != 0) continue;
      board.states.set(board.grid.at(x, y, 0), 1);
      bits.rows[static_cast<std::size_t>(x)][static_cast<std::size_t>(y) / 64] |= std::uint64_t{1} << (y % 64);
    }
  }
  for (int generation = 1; generation <= 1000; ++generation) {
    board.step();
    bits.step();
    if (generation % 50 != 0 && generation > 3) continue;
    std::size_t alive = 0;
    for (int x = 0; x < 256; ++x) {
      for (int y = 0; y < 256; ++y) {
        const bool bit =
            (bits.rows[static_cast<std::size_t>(x)][static_cast<std::size_t>(y) / 64] >> (y % 64) & 1) != 0;
        ASSERT_EQ(board.states.get(board.grid.at(x, y, 0)) != 0, bit) << generation << ": " << x << ", " << y;
        alive += bit ? 1U : 0U;
      }
    }
    ASSERT_GT(alive, 500U);
  }
}

TEST(CellStates, SumsOfWholeGridsAreThoseOfSingleCells) {
  Random random(3);
  for (const bool wraps : {false, true}) {
    for (const Cell3 counts : {Cell3{5, 7, 4}, Cell3{1, 6, 1}, Cell3{2, 2, 2}, Cell3{8, 1, 3}, Cell3{3, 2, 1}}) {
      const Grid grid(counts, wraps, Vector3::Zero(), Vector3::Ones());
      CellStates states(std::pmr::get_default_resource());
      states.make(grid);
      for (std::uint8_t& state : states.all()) state = static_cast<std::uint8_t>(random.below(2) * 200);
      for (const Neighborhood kind :
           {Neighborhood::Moore, Neighborhood::VonNeumann, Neighborhood::Moore3, Neighborhood::VonNeumann3}) {
        const auto sums = states.neighbor_counts(grid, kind);
        const bool box = kind == Neighborhood::Moore || kind == Neighborhood::Moore3;
        const bool flat = kind == Neighborhood::Moore || kind == Neighborhood::VonNeumann;
        for (CellIndex cell = 0; cell < grid.cells(); ++cell) {
          int expected = 0;
          const auto look = [&](CellIndex other) { expected += states.get(other) != 0 ? 1 : 0; };
          box ? grid.moore(cell, 1, flat, look) : grid.von_neumann(cell, 1, flat, look);
          ASSERT_EQ(sums[cell], expected) << cell;
          ASSERT_EQ(states.neighbors(grid, kind, cell), expected) << cell;
        }
      }
    }
  }
}

TEST(CellStates, InRandomOrderEveryCellIsChangedOnce) {
  Board board(6, 6, true);
  for (int i = 0; i < 3; ++i) {
    board.states.step(board.grid, Neighborhood::Moore, {0x1ff, 0}, UpdateOrder::Random, board.random);
    EXPECT_EQ(board.states.count(1), i % 2 == 0 ? 36U : 0U);
  }
  std::pmr::vector<CellIndex> order;
  shuffled(1000, board.random, order);
  EXPECT_EQ(std::set<CellIndex>(order.begin(), order.end()).size(), 1000U);
  EXPECT_FALSE(std::is_sorted(order.begin(), order.end()));
}

TEST(CellStates, ComeBackFromAnImageAndRefuseACutOne) {
  Board board(6, 5, true);
  board.draw(1, 1, {"###"});
  ByteWriter out;
  board.states.save(out);
  const auto image = out.take();
  CellStates again(std::pmr::get_default_resource());
  ByteReader in(image.data(), image.size());
  again.load(in, board.grid);
  EXPECT_TRUE(std::equal(again.all().begin(), again.all().end(), board.states.all().begin()));
  for (std::size_t size = 0; size < image.size(); ++size) {
    ByteReader cut(image.data(), size);
    CellStates none(std::pmr::get_default_resource());
    EXPECT_THROW(none.load(cut, board.grid), Error);
  }
}

TEST(Grid, CellsAreFoundByPlaceAndByIndex) {
  const Grid grid({4, 3, 2}, false, Vector3(1, 2, 3), Vector3(0.5, 1, 2));
  for (CellIndex i = 0; i < grid.cells(); ++i) {
    const Cell3 c = grid.cell(i);
    EXPECT_EQ(grid.at(c.x, c.y, c.z), i);
    EXPECT_EQ(grid.at(grid.middle(i)), i);
    EXPECT_EQ(grid.at(Vector3(grid.corner(i) + Vector3::Constant(1e-9))), i);
  }
  EXPECT_EQ(grid.corner(0), Vector3(0, 0.5, 1));
  EXPECT_EQ(grid.at(-1, 0, 0), kNoCell);
  EXPECT_EQ(grid.at(Vector3(0, 0.4, 1)), kNoCell);
  EXPECT_EQ(grid.at(Vector3(1e300, 0, 0)), kNoCell);
  const Grid toroid({4, 3, 2}, true, Vector3(1, 2, 3), Vector3(0.5, 1, 2));
  EXPECT_EQ(toroid.at(-4, -3, -2), 0U) << "an exact negative multiple is the first cell";
  EXPECT_EQ(toroid.at(-1, 3, 5), toroid.at(3, 0, 1));
  EXPECT_EQ(toroid.at(Vector3(-0.1, 0.5, 1)), toroid.at(3, 0, 0));
}

TEST(Occupants, StandInCyclesAndFreeCellsAreKnownAtAllTimes) {
  const Grid grid = plane(5, 4, true);
  Occupants occupants(std::pmr::get_default_resource());
  occupants.make(grid);
  occupants.set_capacity(0);
  Random random(5);
  std::vector<std::vector<std::uint32_t>> model(grid.cells());  // ids by cell in order of arrival
  std::vector<std::pair<Occupants::Slot, std::uint32_t>> present;
  const auto take_out = [&](CellIndex cell, std::uint32_t id) { std::erase(model[cell], id); };
  for (std::uint32_t i = 1; i < 3000; ++i) {
    const auto cell = static_cast<CellIndex>(random.below(grid.cells()));
    const std::uint64_t what = random.below(3);
    if (what == 0 || present.empty()) {
      present.emplace_back(occupants.enter({i, 1}, cell), i);
      model[cell].push_back(i);
    } else {
      const auto n = static_cast<std::size_t>(random.below(present.size()));
      const auto [slot, id] = present[n];
      take_out(occupants.agent(slot).cell, id);
      if (what == 1 || present.size() > 15) {
        occupants.leave(slot);
        present.erase(present.begin() + static_cast<std::ptrdiff_t>(n));
      } else {
        occupants.move(slot, cell);
        model[cell].push_back(id);
      }
    }
    std::size_t free = 0;
    for (CellIndex c = 0; c < grid.cells(); ++c) {
      std::vector<std::uint32_t> found;
      for (auto p = occupants.first(c); p != Occupants::kNoSlot; p = occupants.next(p))
        found.push_back(occupants.agent(p).id.index);
      ASSERT_EQ(found, model[c]) << i;
      ASSERT_EQ(occupants.count(c), found.size());
      free += found.empty() ? 1U : 0U;
    }
    ASSERT_EQ(occupants.free_cells(), free);
    ASSERT_EQ(occupants.agents(), present.size());
    const CellIndex drawn = occupants.random_free(random);
    ASSERT_TRUE(free == 0 ? drawn == kNoCell : occupants.count(drawn) == 0);
  }
  ByteWriter out;
  occupants.save(out);
  const auto image = out.take();
  Occupants again(std::pmr::get_default_resource());
  ByteReader in(image.data(), image.size());
  again.load(in, grid);
  Hasher a, b;
  occupants.hash(a);
  again.hash(b);
  EXPECT_EQ(a.value(), b.value());
  // Any byte of it changed: the tables hold together, or the image is refused.
  for (std::size_t at = 0; at < image.size(); ++at) {
    auto damaged = image;
    damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ 0x11U);
    ByteReader bad(damaged.data(), damaged.size());
    Occupants other(std::pmr::get_default_resource());
    try {
      other.load(bad, grid);
    } catch (const Error&) {
      continue;
    }
    for (CellIndex c = 0; c < grid.cells(); ++c) {
      std::uint32_t count = 0;
      for (auto p = other.first(c); p != Occupants::kNoSlot; p = other.next(p)) ++count;
      ASSERT_EQ(count, other.count(c));
    }
  }
}

}  // namespace
}  // namespace breve
