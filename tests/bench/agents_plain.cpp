// The models of bench_agents as one would write them in C++ for this one purpose.
#include "agents_plain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <random>
#include <utility>
#include <vector>

#include "runtime/base/random.hpp"

namespace plain {

double now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

namespace {

using Generator = std::mt19937_64;

double uniform(Generator& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }
int below(Generator& random, int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); }

}  // namespace

// --- flocking: cells of the sight's size, three by three of them searched --------------------------------------------

Outcome flocking(int steps) {
  constexpr int kBirds = 400, kCells = 10;
  constexpr double kSize = 150, kSight = 15, kSeparation = 4, kCohere = 0.03, kSeparate = 0.015, kMatch = 0.05;
  struct Bird {
    double x, y, vx, vy;
  };
  // The same start as in steve, since a flock that crowds costs more: the same generator, drawn from as there.
  breve::Random random(1);
  std::vector<Bird> birds(kBirds);
  for (Bird& b : birds) {
    const double angle = random.uniform() * 6.283185307179586, x = random.uniform() * kSize,
                 y = random.uniform() * kSize;
    random.uniform();  // z
    b = {x, y, std::cos(angle), std::sin(angle)};
  }
  std::array<std::vector<int>, kCells * kCells> cells;
  const auto cell_of = [](double v) { return std::min(static_cast<int>(v / kSight), kCells - 1); };
  const auto wrapped = [](double v) { return v < 0 ? v + kSize : v >= kSize ? v - kSize : v; };
  const auto shortest = [](double v) { return v > kSize / 2 ? v - kSize : v < -kSize / 2 ? v + kSize : v; };
  const double begin = now();
  for (int step = 0; step < steps; ++step) {
    for (auto& cell : cells) cell.clear();
    for (int i = 0; i < kBirds; ++i) {
      Bird& b = birds[static_cast<std::size_t>(i)];
      b.x = wrapped(b.x + b.vx);
      b.y = wrapped(b.y + b.vy);
      cells[static_cast<std::size_t>(cell_of(b.x) * kCells + cell_of(b.y))].push_back(i);
    }
    for (int i = 0; i < kBirds; ++i) {
      Bird& b = birds[static_cast<std::size_t>(i)];
      double cx = 0, cy = 0, sx = 0, sy = 0, mx = 0, my = 0;
      int count = 0;
      const int bx = cell_of(b.x), by = cell_of(b.y);
      for (int u = -1; u <= 1; ++u) {
        for (int v = -1; v <= 1; ++v) {
          const int at = (bx + u + kCells) % kCells * kCells + (by + v + kCells) % kCells;
          for (const int j : cells[static_cast<std::size_t>(at)]) {
            if (j == i) continue;
            const Bird& other = birds[static_cast<std::size_t>(j)];
            const double dx = shortest(other.x - b.x), dy = shortest(other.y - b.y), square = dx * dx + dy * dy;
            if (square >= kSight * kSight) continue;
            cx += dx;
            cy += dy;
            mx += other.vx;
            my += other.vy;
            if (square < kSeparation * kSeparation) {
              sx -= dx;
              sy -= dy;
            }
            ++count;
          }
        }
      }
      const double n = std::max(count, 1);
      const double hx = b.vx + (cx * kCohere + sx * kSeparate + mx * kMatch) / n;
      const double hy = b.vy + (cy * kCohere + sy * kSeparate + my * kMatch) / n;
      const double length = std::sqrt(hx * hx + hy * hy);
      if (length > 0) {
        b.vx = hx / length;
        b.vy = hy / length;
      }
    }
  }
  Outcome outcome{0, now() - begin};
  for (const Bird& a : birds) {
    for (const Bird& b : birds) {
      const double dx = shortest(b.x - a.x), dy = shortest(b.y - a.y);
      if (&a != &b && dx * dx + dy * dy < kSight * kSight) outcome.result += 1.0 / kBirds;
    }
  }
  return outcome;
}

// --- segregation: a board of agents, and a list of free cells --------------------------------------------------------

Outcome segregation(int steps) {
  constexpr int kSide = 100, kAgents = 8000, kRadius = 2, kAlike = 8;
  struct Agent {
    int x, y, group, content;
  };
  Generator random(1);
  std::vector<int> board(kSide * kSide, -1), free_cells(kSide * kSide);
  for (int i = 0; i < kSide * kSide; ++i) free_cells[static_cast<std::size_t>(i)] = i;
  std::shuffle(free_cells.begin(), free_cells.end(), random);
  std::vector<Agent> agents(kAgents);
  for (int i = 0; i < kAgents; ++i) {
    const int cell = free_cells.back();
    free_cells.pop_back();
    agents[static_cast<std::size_t>(i)] = {cell / kSide, cell % kSide, i % 2, 0};
    board[static_cast<std::size_t>(cell)] = i;
  }
  const double begin = now();
  for (int step = 0; step < steps; ++step) {
    for (int i = 0; i < kAgents; ++i) {
      Agent& a = agents[static_cast<std::size_t>(i)];
      int alike = 0;
      for (int x = std::max(a.x - kRadius, 0); x <= std::min(a.x + kRadius, kSide - 1); ++x) {
        for (int y = std::max(a.y - kRadius, 0); y <= std::min(a.y + kRadius, kSide - 1); ++y) {
          const int other = board[static_cast<std::size_t>(x * kSide + y)];
          if (other >= 0 && other != i && agents[static_cast<std::size_t>(other)].group == a.group) ++alike;
        }
      }
      a.content = alike >= kAlike ? 1 : 0;
      if (a.content != 0) continue;
      const auto pick = static_cast<std::size_t>(below(random, static_cast<int>(free_cells.size())));
      const int cell = std::exchange(free_cells[pick], a.x * kSide + a.y);
      board[static_cast<std::size_t>(a.x * kSide + a.y)] = -1;
      board[static_cast<std::size_t>(cell)] = i;
      a.x = cell / kSide;
      a.y = cell % kSide;
    }
  }
  Outcome outcome{0, now() - begin};
  for (const Agent& a : agents) outcome.result += a.content;
  outcome.result /= kAgents;
  return outcome;
}

// --- wolves, sheep and grass: animals in one list, and a list of animals for each cell
// ------------------------------------

namespace {

class Meadow {
 public:
  Meadow() : here_(kSize * kSize), grass_(kSize * kSize) {
    for (int& left : grass_) left = below(random_, 2) * below(random_, kRegrowth);
    for (int i = 0; i < kSheep + kWolves; ++i) {
      const bool wolf = i >= kSheep;
      add(wolf, below(random_, kSize), below(random_, kSize),
          below(random_, 2 * (wolf ? kSheepEnergy : kGrassEnergy) + 1));
    }
  }
  void step() {
    // An animal born in this step waits for the next.
    const std::size_t count = animals_.size();
    for (std::size_t i = 0; i < count; ++i)
      if (animals_[i].alive) live(i);
    for (int& left : grass_) --left;
    if (dead_ * 2 > animals_.size()) sweep();
  }
  std::size_t alive() const { return animals_.size() - dead_; }

 private:
  static constexpr int kSize = 100, kSheep = 1000, kWolves = 500, kRegrowth = 20, kGrassEnergy = 5, kSheepEnergy = 13;
  static constexpr double kSheepBreeds = 0.2, kWolfBreeds = 0.1;
  struct Animal {
    int x, y, energy;
    bool wolf, alive;
  };

  std::vector<std::size_t>& at(const Animal& a) { return here_[static_cast<std::size_t>(a.x * kSize + a.y)]; }
  void add(bool wolf, int x, int y, int energy) {
    animals_.push_back({x, y, energy, wolf, true});
    at(animals_.back()).push_back(animals_.size() - 1);
  }
  void leave(std::size_t i) {
    auto& cell = at(animals_[i]);
    cell.erase(std::find(cell.begin(), cell.end(), i));
  }
  void die(std::size_t i) {
    leave(i);
    animals_[i].alive = false;
    ++dead_;
  }
  void live(std::size_t i) {
    int dx = 0, dy = 0;
    while (dx == 0 && dy == 0) {
      dx = below(random_, 3) - 1;
      dy = below(random_, 3) - 1;
    }
    leave(i);
    Animal& a = animals_[i];
    a.x = (a.x + dx + kSize) % kSize;
    a.y = (a.y + dy + kSize) % kSize;
    at(a).push_back(i);
    if (--a.energy < 0) return die(i);
    if (a.wolf) {
      const auto& cell = at(a);
      const auto prey = std::find_if(cell.begin(), cell.end(), [&](std::size_t j) { return !animals_[j].wolf; });
      if (prey != cell.end()) {
        a.energy += kSheepEnergy;
        die(*prey);
      }
    } else if (int& left = grass_[static_cast<std::size_t>(a.x * kSize + a.y)]; left <= 0) {
      a.energy += kGrassEnergy;
      left = kRegrowth;
    }
    if (uniform(random_) >= (a.wolf ? kWolfBreeds : kSheepBreeds)) return;
    a.energy /= 2;
    add(a.wolf, a.x, a.y, a.energy);
  }
  void sweep() {
    std::erase_if(animals_, [](const Animal& a) { return !a.alive; });
    dead_ = 0;
    for (auto& cell : here_) cell.clear();
    for (std::size_t i = 0; i < animals_.size(); ++i) at(animals_[i]).push_back(i);
  }

  Generator random_{1};
  std::vector<Animal> animals_;
  std::vector<std::vector<std::size_t>> here_;
  std::vector<int> grass_;
  std::size_t dead_ = 0;
};

}  // namespace

Outcome wolf_sheep(int steps) {
  Meadow meadow;
  Outcome outcome;
  const double begin = now();
  for (int step = 0; step < steps; ++step) {
    meadow.step();
    outcome.result += static_cast<double>(meadow.alive());
  }
  outcome.seconds = now() - begin;
  return outcome;
}

// --- Life and Gray-Scott: loops over rows with a border
// ------------------------------------------------------------------

Outcome life(int steps) {
  constexpr int kSide = 512, kRow = kSide + 2;
  std::vector<std::uint8_t> now_cells(kRow * kRow), next(kRow * kRow);
  Generator random(1);
  for (int x = 1; x <= kSide; ++x)
    for (int y = 1; y <= kSide; ++y) now_cells[static_cast<std::size_t>(x * kRow + y)] = uniform(random) < 0.3 ? 1 : 0;
  const double begin = now();
  for (int step = 0; step < steps; ++step) {
    std::uint8_t* const c = now_cells.data();
    for (int x = 1; x <= kSide; ++x) {
      c[x * kRow] = c[x * kRow + kSide];
      c[x * kRow + kSide + 1] = c[x * kRow + 1];
    }
    std::copy_n(c + kSide * kRow, kRow, c);
    std::copy_n(c + kRow, kRow, c + (kSide + 1) * kRow);
    for (int x = 1; x <= kSide; ++x) {
      const std::uint8_t *up = c + (x - 1) * kRow, *row = c + x * kRow, *down = c + (x + 1) * kRow;
      std::uint8_t* const to = next.data() + x * kRow;
      for (int y = 1; y <= kSide; ++y) {
        const int n = up[y - 1] + up[y] + up[y + 1] + row[y - 1] + row[y + 1] + down[y - 1] + down[y] + down[y + 1];
        to[y] = static_cast<std::uint8_t>(n == 3 || (n == 2 && row[y] != 0));
      }
    }
    now_cells.swap(next);
  }
  Outcome outcome{0, now() - begin};
  for (int x = 1; x <= kSide; ++x)
    for (int y = 1; y <= kSide; ++y) outcome.result += now_cells[static_cast<std::size_t>(x * kRow + y)];
  outcome.result /= kSide * kSide;
  return outcome;
}

Outcome gray_scott(int steps) {
  constexpr int kSide = 512, kRow = kSide + 2;
  constexpr double kDu = 0.16, kDv = 0.08, kFeed = 0.035, kKill = 0.065;
  std::vector<double> u(kRow * kRow, 1), v(kRow * kRow), un(kRow * kRow), vn(kRow * kRow);
  for (int x = 200; x < 312; ++x) {
    for (int y = 200; y < 312; ++y) {
      u[static_cast<std::size_t>((x + 1) * kRow + y + 1)] = 0.5;
      v[static_cast<std::size_t>((x + 1) * kRow + y + 1)] = 0.25;
    }
  }
  const double begin = now();
  for (int step = 0; step < steps; ++step) {
    for (double* c : {u.data(), v.data()}) {
      for (int x = 1; x <= kSide; ++x) {
        c[x * kRow] = c[x * kRow + kSide];
        c[x * kRow + kSide + 1] = c[x * kRow + 1];
      }
      std::copy_n(c + kSide * kRow, kRow, c);
      std::copy_n(c + kRow, kRow, c + (kSide + 1) * kRow);
    }
    for (int x = 1; x <= kSide; ++x) {
      const double *const a = u.data() + x * kRow, *const b = v.data() + x * kRow;
      double *const to_u = un.data() + x * kRow, *const to_v = vn.data() + x * kRow;
      for (int y = 1; y <= kSide; ++y) {
        const double reacted = a[y] * b[y] * b[y];
        const double lu = a[y - 1] + a[y + 1] + a[y - kRow] + a[y + kRow] - 4 * a[y];
        const double lv = b[y - 1] + b[y + 1] + b[y - kRow] + b[y + kRow] - 4 * b[y];
        to_u[y] = a[y] + kDu * lu - reacted + kFeed * (1 - a[y]);
        to_v[y] = b[y] + kDv * lv + reacted - (kFeed + kKill) * b[y];
      }
    }
    u.swap(un);
    v.swap(vn);
  }
  Outcome outcome{0, now() - begin};
  for (int x = 1; x <= kSide; ++x)
    for (int y = 1; y <= kSide; ++y) outcome.result += v[static_cast<std::size_t>(x * kRow + y)];
  outcome.result /= kSide * kSide;
  return outcome;
}

}  // namespace plain
