// What wakes bodies that sleep: what they touch moved, has another shape or another surface.
#include <utility>

#include "runtime/dynamics/near_pairs.hpp"

namespace breve {

namespace {

bool same(const contact::Law& x, const contact::Law& y) {
  return x.restitution == y.restitution && x.tangential_restitution == y.tangential_restitution &&
         x.static_friction == y.static_friction && x.dynamic_friction == y.dynamic_friction &&
         x.restitution_threshold == y.restitution_threshold;
}

}  // namespace

void NearPairs::wake(BodyIndex body) {
  if (body >= proxy_of_.size() || proxy_of_[body] == kNoProxy) return;
  Proxy& proxy = proxies_[proxy_of_[body]];
  if (proxy.rest.asleep && !std::exchange(proxy.woken, true)) woken_.push_back(proxy_of_[body]);
  proxy.rest = {};
}

void NearPairs::wake_all() {
  for (Proxy& proxy : proxies_) proxy.rest = {};
}

bool NearPairs::reshaped(const Bodies& bodies, const Proxy& proxy) {
  const Shape* shape = bodies.collision_shape(proxy.body).get();
  return proxy.shape != shape || proxy.shape_changes != shape->changes();
}

/// Whether something that does not move by itself stands elsewhere, or has another shape, than when its box was found.
bool NearPairs::displaced(const Bodies& bodies, const Proxy& proxy) {
  if (proxy.moves || !proxy.placed) return false;
  return reshaped(bodies, proxy) || proxy.location != bodies.location(proxy.body) ||
         proxy.orientation.coeffs() != bodies.orientation(proxy.body).coeffs();
}

/// What the body may touch where it stands now.
void NearPairs::wake_met(const Bodies& bodies, const Proxy& proxy) {
  const Eigen::AlignedBox3d box = bodies.bounds(proxy.body);
  if (!box.min().allFinite() || !box.max().allFinite()) return;
  found_.clear();
  tree_.query(box, found_);
  // Boxes in the tree are roomier than bodies, as the past made them.
  for (const ProxyIndex other : found_)
    if (proxies_[other].moves && bodies.bounds(proxies_[other].body).intersects(box)) wake(proxies_[other].body);
}

void NearPairs::wake_disturbed(Bodies& bodies, double unit) {
  for (const PairKey& key : keys_) {
    if (!remembers(key) || !bodies.used(key.a) || !bodies.used(key.b)) continue;
    const NearPair& pair = pairs_[key.at];
    const Proxy &a = proxies_[proxy_of_[key.a]], &b = proxies_[proxy_of_[key.b]];
    const Bodies& all = bodies;
    const bool changed =
        !holds(all, a) || !holds(all, b) || a.woken || b.woken || displaced(all, a) || displaced(all, b) ||
        (pair.law_known && !same(pair.law, contact::combine(all.material(key.a), all.material(key.b), unit)));
    if (!changed) continue;
    for (const BodyIndex body : {key.a, key.b}) proxies_[proxy_of_[body]].rest = {};
  }
  for (const ProxyIndex index : woken_) proxies_[index].woken = false;
  woken_.clear();
  bodies.take_put(Follower::Dynamics, put_);
  const bool scaled = bodies.shape_changes() != seen_scalings_;
  for (const Proxy& proxy : proxies_)
    if (scaled && proxy.body != kNoBody && bodies.used(proxy.body) && displaced(bodies, proxy)) wake_met(bodies, proxy);
  for (const BodyIndex body : put_)
    if (body < proxy_of_.size() && proxy_of_[body] != kNoProxy && bodies.used(body) &&
        displaced(bodies, proxies_[proxy_of_[body]]))
      wake_met(bodies, proxies_[proxy_of_[body]]);
}

}  // namespace breve
