// What a body may reach in a step if something strikes it: as far as what strikes it would go on.
#include <algorithm>
#include <cmath>

#include "runtime/dynamics/near_pairs.hpp"

namespace breve {

/// Passes speed on from body to body along near pairs, and looks for pairs where boxes grow by it.
/// @return  true if some box grew: new pairs may pass it on further
bool NearPairs::pass_on(const Bodies& bodies, double h) {
  // Of the radius: a strike that moves less than this within the step meets what is in the roomy boxes anyway.
  constexpr double kFar = 0.05, kMore = 1.01;
  bool grew = false;
  fresh_.clear();
  new_keys_.clear();
  for (const PairKey& pair : keys_) {
    if (!pair.pushes || !near(pair)) continue;
    Proxy &a = proxies_[proxy_of_[pair.a]], &b = proxies_[proxy_of_[pair.b]];
    if (!a.moves || !b.moves || a.leaf == BoxTree::kNoLeaf || b.leaf == BoxTree::kNoLeaf) continue;
    const double mass_a = bodies.mass(pair.a), mass_b = bodies.mass(pair.b);
    // What leaves an elastic impact with something at rest. That never has more energy than what struck it, so that
    // the speeds of a crowd of light and heavy bodies end at that of the heaviest times the root of the ratio of
    // masses.
    grew = widen(b, a.speed * 2 * mass_a / (mass_a + mass_b), h, kFar, kMore) || grew;
    grew = widen(a, b.speed * 2 * mass_b / (mass_a + mass_b), h, kFar, kMore) || grew;
  }
  return grew;
}

bool NearPairs::widen(Proxy& proxy, double speed, double h, double far, double more) {
  if (!(speed > more * proxy.speed) || !(speed * h > far * proxy.shape->bounding_radius())) return false;
  const auto index = static_cast<ProxyIndex>(&proxy - proxies_.data());
  Reach& reach = reach_[index];
  const Vector3 room = Vector3::Constant(2 * h * (speed - proxy.speed));
  proxy.speed = speed;
  proxy.wide = true;
  reach.box.min() -= room;
  reach.box.max() += room;
  if (!reach.box.min().allFinite() || !reach.box.max().allFinite()) return false;
  if (tree_.box(proxy.leaf).contains(reach.box)) return true;
  mark_moved(index);
  tree_.move(proxy.leaf, reach.box);
  seek(index);
  return true;
}

}  // namespace breve
