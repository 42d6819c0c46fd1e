#include "search.hpp"

#include <algorithm>
#include <cmath>

namespace adversary {

namespace {

constexpr std::size_t kKept = 4;  // of each measure, the worst first

struct Pool {
  std::array<std::vector<Found>, kMeasures> kept;

  void offer(const Found& found) {
    for (int i = 0; i < kMeasures; ++i) {
      auto& list = kept[static_cast<std::size_t>(i)];
      const double value = found.verdict.found[static_cast<std::size_t>(i)];
      if (!(value > 0)) continue;
      const auto at = std::find_if(list.begin(), list.end(), [&](const Found& other) {
        return value > other.verdict.found[static_cast<std::size_t>(i)];
      });
      list.insert(at, found);
      if (list.size() > kKept) list.pop_back();
    }
  }

  /// One of those kept, of any measure.
  const Case* pick(Random& random) const {
    const auto& list = kept[static_cast<std::size_t>(random.below(kMeasures))];
    if (list.empty()) return nullptr;
    return &list[static_cast<std::size_t>(random.below(static_cast<int>(list.size())))].one;
  }
};

}  // namespace

Worst search(const Search& is, const std::function<void(const Found&)>& begin,
             const std::function<void(const Found&)>& look) {
  Random random(is.seed * 1000003 + static_cast<std::uint64_t>(is.family));
  Pool pool;
  for (int i = 0; i < is.evaluations; ++i) {
    const bool fresh = is.random || 3 * i < is.evaluations || random.chance(0.1);
    const Case* parent = fresh ? nullptr : pool.pick(random);
    Found found;
    found.one = parent ? mutate(*parent, random) : draw_case(is.family, random);
    found.number = i;
    begin(found);
    found.verdict = run_case(found.one, is.setting);
    look(found);
    if (found.verdict.refused.empty()) pool.offer(found);
  }
  Worst worst;
  for (std::size_t i = 0; i < kMeasures; ++i)
    if (!pool.kept[i].empty()) worst[i] = pool.kept[i].front();
  return worst;
}

}  // namespace adversary
