// What a body may reach in a step if something strikes it: as far as what strikes it would go on.
#include <cmath>

#include "runtime/dynamics/near_pairs.hpp"

namespace breve {

/// Passes speed on from body to body along the pairs that are near, and looks for pairs where boxes grow by it. Boxes
/// grow when all pairs were gone through: which pairs are in the list before they are near depends on the past.
/// @return  true if some box grew: new pairs may pass it on further
bool NearPairs::pass_on(const Bodies& bodies, double h) {
  // Part of the radius: a strike that moves less than this within the step meets only what is in the roomy boxes.
  constexpr double kFar = 0.05, kMore = 1.01;
  fresh_.clear();
  new_keys_.clear();
  struck_.clear();
  const auto strike = [&](ProxyIndex index, double speed) {
    Proxy& proxy = proxies_[index];
    if (!std::isfinite(speed) || !(speed > kMore * proxy.speed) || !(speed * h > kFar * proxy.shape->bounding_radius()))
      return;
    if (proxy.speed == reach_[index].speed) struck_.push_back(index);
    proxy.speed = speed;
  };
  for (const PairKey& pair : keys_) {
    if (!pair.pushes || !near(pair)) continue;
    const ProxyIndex a = proxy_of_[pair.a], b = proxy_of_[pair.b];
    const Proxy &of_a = proxies_[a], &of_b = proxies_[b];
    if (!of_a.moves || !of_b.moves || of_a.leaf == BoxTree::kNoLeaf || of_b.leaf == BoxTree::kNoLeaf) continue;
    const double mass_a = bodies.mass(pair.a), mass_b = bodies.mass(pair.b);
    // What leaves an elastic impact with something at rest. That never has more energy than what struck it, so that
    // the speeds of a crowd of light and heavy bodies end at that of the heaviest times the root of the ratio of
    // masses.
    strike(b, of_a.speed * 2 * mass_a / (mass_a + mass_b));
    strike(a, of_b.speed * 2 * mass_b / (mass_a + mass_b));
  }
  for (const ProxyIndex index : struck_) widen(index, h);
  return !struck_.empty();
}

void NearPairs::widen(ProxyIndex index, double h) {
  Proxy& proxy = proxies_[index];
  Reach& reach = reach_[index];
  const Vector3 room = Vector3::Constant(2 * h * (proxy.speed - reach.speed));
  reach.speed = proxy.speed;
  const Eigen::AlignedBox3d wider(reach.box.min() - room, reach.box.max() + room);
  if (!wider.min().allFinite() || !wider.max().allFinite()) return;
  proxy.wide = true;
  reach.box = wider;
  if (tree_.box(proxy.leaf).contains(reach.box)) return;
  mark_moved(index);
  tree_.move(proxy.leaf, reach.box);
  seek(index);
}

}  // namespace breve
