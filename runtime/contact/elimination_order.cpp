// Breadth first from a mover with few neighbours, numbered backward.
#include "runtime/contact/elimination_order.hpp"

#include <algorithm>

namespace breve::contact {

namespace {

/// Pairs of movers that share a row, both ways, sorted; `firsts` says where each mover's begin.
class Neighbors {
 public:
  explicit Neighbors(Workspace& work) : pairs_(work.neighbors), firsts_(work.firsts) {
    pairs_.clear();
    const auto join = [this](int a, int b) {
      if (a == 0 || b == 0 || a == b) return;
      pairs_.emplace_back(a, b);
      pairs_.emplace_back(b, a);
    };
    for (const Point& c : work.points) join(c.a, c.b);
    for (const PackedScalar& row : work.scalars) join(row.a, row.jb == nullptr ? 0 : row.b);
    std::sort(pairs_.begin(), pairs_.end());
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    firsts_.assign(work.movers.size() + 1, 0);
    for (const auto& [a, b] : pairs_) ++firsts_[static_cast<std::size_t>(a) + 1];
    for (std::size_t i = 1; i < firsts_.size(); ++i) firsts_[i] += firsts_[i - 1];
  }
  int count(int mover) const { return firsts_[at(mover) + 1] - firsts_[at(mover)]; }
  template <class F>
  void each(int mover, F&& f) const {
    for (int k = firsts_[at(mover)]; k < firsts_[at(mover) + 1]; ++k) f(pairs_[at(k)].second);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  std::pmr::vector<std::pair<int, int>>& pairs_;
  std::pmr::vector<int>& firsts_;
};

/// Movers in the order of elimination, in work.order; the world is left out.
void find_order(Workspace& work, const Neighbors& neighbors) {
  const int count = static_cast<int>(work.movers.size());
  std::pmr::vector<int>& order = work.order;
  order.clear();
  work.indices.assign(work.movers.size(), -1);  // >= 0: it is in the order
  const auto take = [&](int mover) {
    int& index = work.indices[static_cast<std::size_t>(mover)];
    if (index >= 0) return;
    index = 0;
    order.push_back(mover);
  };
  std::size_t next = 0;
  const auto spread = [&] {
    for (; next < order.size(); ++next) {
      const std::size_t first = order.size();
      neighbors.each(order[next], take);
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(first), order.end(),
                [&](int a, int b) { return std::pair(neighbors.count(a), a) < std::pair(neighbors.count(b), b); });
    }
  };
  // The last mover that a first search reaches lies at the rim: from there layers are narrow.
  for (int start = 1; start < count; ++start) {
    if (work.indices[static_cast<std::size_t>(start)] >= 0) continue;
    const std::size_t first = order.size();
    take(start);
    spread();
    const int rim = order.back();
    for (std::size_t i = first; i < order.size(); ++i) work.indices[static_cast<std::size_t>(order[i])] = -1;
    order.resize(first);
    next = first;
    take(rim);
    spread();
  }
  std::reverse(order.begin(), order.end());
}

// The stored part of the matrix is cleared, and each column looked down: a line of the cache for each number.
constexpr double kLook = 10;
constexpr double kStored = 3;  // times the band of a row

double row_operations(const Workspace& work) {
  double sum = 0;
  const auto size = [&](int mover) { return static_cast<double>(work.movers[static_cast<std::size_t>(mover)].size); };
  for (const Point& c : work.points) {
    const double width = size(c.a) + size(c.b);
    sum += 3 * width * (width + 6);
  }
  for (const PackedScalar& row : work.scalars) {
    const double width = size(row.a) + (row.jb == nullptr ? 0 : size(row.b));
    sum += width * (width + 2);
  }
  return sum;
}

/// The operations of one elimination in the best order that there may be: rows, the matrix, and the velocities of each
/// mover among one another.
double least_operations(const Workspace& work) {
  double velocities = 0, widest = 0, sum = row_operations(work);
  for (std::size_t i = 1; i < work.movers.size(); ++i) {
    const double size = work.movers[i].size;
    velocities += size;
    widest = std::max(widest, size);
    sum += size * size * size / 1.5;
  }
  return sum + kLook * velocities * std::min(velocities, kStored * widest);
}

}  // namespace

double order_elimination(Workspace& work, double most) {
  if (work.condensed) {
    const double n = static_cast<double>(work.rates.size());
    return n * n * (n / 1.5 + 3);
  }
  const double least = least_operations(work);
  if (least > most) return least;
  const Neighbors neighbors(work);
  find_order(work, neighbors);
  int at = 0;
  for (const int mover : work.order) {
    work.indices[static_cast<std::size_t>(mover)] = at;
    at += work.movers[static_cast<std::size_t>(mover)].size;
  }
  work.indices.front() = 0;
  double sum = row_operations(work), widest = 0;
  int reach = 0;  // of the velocities eliminated so far: the last one that one of them is coupled with
  for (const int mover : work.order) {
    const int first = work.indices[static_cast<std::size_t>(mover)];
    const int size = work.movers[static_cast<std::size_t>(mover)].size;
    reach = std::max(reach, first + size);
    neighbors.each(mover, [&](int other) {
      reach = std::max(
          reach, work.indices[static_cast<std::size_t>(other)] + work.movers[static_cast<std::size_t>(other)].size);
    });
    for (int k = first; k < first + size; ++k) {
      const double width = reach - k;
      sum += 2 * width * width;
      widest = std::max(widest, width);
    }
  }
  const auto velocities = static_cast<double>(at);
  return sum + kLook * velocities * std::min(velocities, kStored * widest);
}

double sweep_operations(const Workspace& work) {
  constexpr double kCone = 80,
                   kPlain = 120;  // the answer of one contact; of one between free bodies, velocities included
  double sum = 0;
  const auto size = [&](int mover) { return static_cast<double>(work.movers[static_cast<std::size_t>(mover)].size); };
  if (work.by_normals) {
    const auto n = static_cast<double>(work.points.size() + work.scalars.size());
    return 2 * n * n;
  }
  if (work.condensed) {
    const double n = static_cast<double>(work.rates.size());
    return 2 * n * n + kCone * static_cast<double>(work.points.size());
  }
  for (const Point& c : work.points) sum += c.plain ? kPlain : kCone + 12 * (size(c.a) + size(c.b));
  for (const PackedScalar& row : work.scalars) sum += 4 * (size(row.a) + (row.jb == nullptr ? 0 : size(row.b)));
  return sum;
}

}  // namespace breve::contact
