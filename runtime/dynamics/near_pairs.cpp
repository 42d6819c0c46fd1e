// The broad phase: boxes a little too large, so that slow bodies are not looked at again.
#include "runtime/dynamics/near_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/corners.hpp"

namespace breve {

NearPairs::NearPairs(std::pmr::memory_resource* memory)
    : tree_(memory),
      proxies_(memory),
      reach_(memory),
      free_(memory),
      proxy_of_(memory),
      movers_(memory),
      put_(memory),
      drivers_(memory),
      woken_(memory),
      struck_(memory),
      moved_(memory),
      keys_(memory),
      new_keys_(memory),
      pairs_(memory),
      free_pairs_(memory),
      fresh_(memory),
      found_(memory) {}

void NearPairs::enter(const Bodies& bodies, const MechanicsClient& client, BodyIndex body) {
  ProxyIndex index;
  if (free_.empty()) {
    // leave() and wake() take none.
    if (free_.capacity() <= proxies_.size()) free_.reserve(2 * proxies_.size() + 16);
    if (woken_.capacity() <= proxies_.size()) woken_.reserve(2 * proxies_.size() + 16);
    index = static_cast<ProxyIndex>(proxies_.size());
    reach_.resize(proxies_.size() + 1);
    proxies_.emplace_back();
  } else {
    index = free_.back();
    free_.pop_back();
  }
  reach_[index] = {};
  Proxy& proxy = proxies_[index] = Proxy();
  proxy.body = body;
  proxy.serial = client.serial(body);
  proxy.moves = bodies.dynamic(body);
  proxy.switches = bodies.physics_switches(body);
  proxy_of_[body] = index;
}

void NearPairs::leave(ProxyIndex index) {
  Proxy& proxy = proxies_[index];
  if (proxy.leaf != BoxTree::kNoLeaf) tree_.remove(proxy.leaf);
  const BodyIndex body = proxy.body;
  std::erase_if(keys_, [&](PairKey& key) {
    const bool of_body = key.a == body || key.b == body;
    if (of_body && remembers(key)) wake(key.a == body ? key.b : key.a);
    if (of_body) release(key);
    return of_body;
  });
  proxy_of_[body] = kNoProxy;
  std::erase(woken_, index);
  proxy = Proxy();
  free_.push_back(index);
}

void NearPairs::forget(BodyIndex body) {
  if (body < proxy_of_.size() && proxy_of_[body] != kNoProxy) leave(proxy_of_[body]);
  std::erase(movers_, body);
}

void NearPairs::gather(const Bodies& bodies, const MechanicsClient& client) {
  proxy_of_.resize(bodies.index_end(), kNoProxy);
  movers_.clear();
  for (BodyIndex body = 0; body < proxy_of_.size(); ++body) {
    const bool dynamic = bodies.dynamic(body), solid = dynamic || bodies.driver(body);
    bool known = proxy_of_[body] != kNoProxy;
    if (known && (!solid || proxies_[proxy_of_[body]].moves != dynamic || !holds(bodies, proxies_[proxy_of_[body]]))) {
      leave(proxy_of_[body]);
      known = false;
    }
    if (solid && !known) enter(bodies, client, body);
    if (dynamic) movers_.push_back(body);
  }
  std::sort(movers_.begin(), movers_.end(), [this](BodyIndex x, BodyIndex y) { return serial(x) < serial(y); });
}

void NearPairs::refresh(Bodies& bodies, const MechanicsClient& client, const Vector3& gravity, double h,
                        Asking& asking) {
  const bool again = std::exchange(incomplete_, true);
  const bool gathers = again || bodies.revision() != seen_bodies_;
  if (gathers) {
    gather(bodies, client);
    seen_bodies_ = bodies.revision();
  }
  fresh_.clear();
  new_keys_.clear();
  for (const ProxyIndex index : moved_) reach_[index].moved = false;
  moved_.clear();
  bodies.take_put(Follower::Dynamics, put_);
  find_drivers(bodies);
  const std::uint64_t scalings = bodies.shape_changes();
  update_boxes(bodies, gathers || scalings != seen_scalings_, gravity, h, asking);
  put_.clear();
  seen_scalings_ = scalings;
  if (!again) return;
  // After an update that was not ended nobody knows which boxes moved.
  for (ProxyIndex index = 0; index < reach_.size(); ++index) mark_moved(index);
  for (ProxyIndex index = 0; index < proxies_.size(); ++index)
    if (proxies_[index].leaf != BoxTree::kNoLeaf) seek(index);  // they all moved: each pair is found twice
}

/// Bodies that move without forces, in the order of their indices: the stages' own order depends on the past. Those of
/// the last step are looked at once more: what they may reach is less where they stopped.
void NearPairs::find_drivers(const Bodies& bodies) {
  put_.insert(put_.end(), drivers_.begin(), drivers_.end());
  drivers_.clear();
  for (const std::pmr::vector<BodyIndex>* some : {&bodies.translating_bodies(), &bodies.rotating_bodies()})
    for (const BodyIndex body : *some)
      if (bodies.driver(body)) drivers_.push_back(body);
  std::sort(drivers_.begin(), drivers_.end());
  drivers_.erase(std::unique(drivers_.begin(), drivers_.end()), drivers_.end());
}

/// Skips bodies that stand where they were: a world may have many more of them than bodies that move.
void NearPairs::update_boxes(const Bodies& bodies, bool all, const Vector3& gravity, double h, Asking& asking) {
  if (all) {
    for (Proxy& proxy : proxies_)
      if (proxy.body != kNoBody) update_box(bodies, proxy, gravity, h, asking);
    return;
  }
  for (const BodyIndex body : movers_) update_box(bodies, proxies_[proxy_of_[body]], gravity, h, asking);
  const auto update_driver = [&](BodyIndex body) {
    if (body >= proxy_of_.size() || proxy_of_[body] == kNoProxy) return;
    Proxy& proxy = proxies_[proxy_of_[body]];
    if (!proxy.moves) update_box(bodies, proxy, gravity, h, asking);
  };
  for (const std::pmr::vector<BodyIndex>* some : {&put_, &drivers_})
    std::for_each(some->begin(), some->end(), update_driver);
}

void NearPairs::mark_moved(ProxyIndex index) {
  if (std::exchange(reach_[index].moved, true)) return;
  moved_.push_back(index);
}

/// How far a body may come out of its bounds in a step.
Vector3 NearPairs::room_of(const Bodies& bodies, const Proxy& proxy, double radius, const Vector3& gravity, double h) {
  Vector3 room = Vector3::Constant(1e-3 * radius);
  const double rotation = std::min(bodies.rotational_velocity(proxy.body).norm() * h * radius, radius);
  const Vector3 speed = bodies.velocity(proxy.body).cwiseAbs();
  if (proxy.moves) {
    // Straight on, falling, rotating; twice as far, since it may be pushed meanwhile.
    room += (speed + h * gravity.cwiseAbs()) * (2 * h) + Vector3::Constant(2 * rotation);
  } else if (bodies.moving(proxy.body)) {
    // It stands where its motion ends, and it may have rotated.
    room += h * speed + Vector3::Constant(rotation);
  }
  return room;
}

/// A box is a function of the present state alone: a world that was restored has no other.
void NearPairs::update_box(const Bodies& bodies, Proxy& proxy, const Vector3& gravity, double h, Asking& asking) {
  ++boxes_;
  const Shape* shape = bodies.collision_shape(proxy.body).get();
  const Vector3& location = bodies.location(proxy.body);
  const Quaternion orientation = bodies.orientation(proxy.body);
  const Vector3 room = room_of(bodies, proxy, shape->bounding_radius(), gravity, h);
  const auto index = static_cast<ProxyIndex>(&proxy - proxies_.data());
  Reach& reach = reach_[index];
  proxy.speed = reach.speed = proxy.moves ? bodies.velocity(proxy.body).norm() : 0;
  const bool still = proxy.leaf != BoxTree::kNoLeaf && proxy.shape == shape &&
                     proxy.shape_changes == shape->changes() && proxy.location == location &&
                     proxy.orientation.coeffs() == orientation.coeffs() && proxy.room == room;
  if (still && !proxy.wide) return;
  proxy.wide = false;
  proxy.room = room;
  proxy.placed = true;
  proxy.shape = shape;
  proxy.shape_changes = shape->changes();
  proxy.location = location;
  proxy.orientation = orientation;
  reach.box = shape->bounds(orientation.toRotationMatrix());
  reach.box.translate(location);
  reach.box.min() -= room;
  reach.box.max() += room;
  if (!reach.box.min().allFinite() || !reach.box.max().allFinite()) {
    // A body that flew out of the numbers touches nothing.
    reach.box.setEmpty();
    mark_moved(index);
    if (proxy.leaf != BoxTree::kNoLeaf) tree_.remove(std::exchange(proxy.leaf, BoxTree::kNoLeaf));
    return;
  }
  if (proxy.leaf != BoxTree::kNoLeaf && tree_.box(proxy.leaf).contains(reach.box)) return;
  mark_moved(index);
  Eigen::AlignedBox3d roomy = reach.box;
  if (proxy.moves) {
    constexpr double kRoom = 0.1;  // of the radius: slow bodies keep their box for many steps
    const Vector3 more = Vector3::Constant(kRoom * shape->bounding_radius());
    roomy.min() -= more;
    roomy.max() += more;
  }
  if (proxy.leaf == BoxTree::kNoLeaf)
    proxy.leaf = tree_.insert(roomy, index);
  else
    tree_.move(proxy.leaf, roomy);
  seek(index, asking);
}

void NearPairs::seek(ProxyIndex index, Asking& asking) {
  found_.clear();
  tree_.query(tree_.box(proxies_[index].leaf), found_);
  const Proxy& self = proxies_[index];
  bound_->poll();
  for (const ProxyIndex other_index : found_) {
    poll();
    const Proxy& other = proxies_[other_index];
    if (other_index == index || !(self.moves || other.moves)) continue;
    PairKey key;
    const bool first = self.serial < other.serial;
    key.a = first ? self.body : other.body;
    key.b = first ? other.body : self.body;
    key.serial_a = first ? self.serial : other.serial;
    key.serial_b = first ? other.serial : self.serial;
    if (find_key(key.serial_a, key.serial_b)) continue;
    if (asking.most != kNoMost) meet(key, other_index, asking);
    new_keys_.push_back(key);
  }
}

PairKey* NearPairs::find_key(std::uint64_t serial_a, std::uint64_t serial_b) {
  PairKey wanted;
  wanted.serial_a = serial_a;
  wanted.serial_b = serial_b;
  const auto at = std::lower_bound(keys_.begin(), keys_.end(), wanted, earlier);
  return at != keys_.end() && at->serial_a == serial_a && at->serial_b == serial_b ? &*at : nullptr;
}

NearPair* NearPairs::find(BodyIndex a, BodyIndex b) {
  if (a >= proxy_of_.size() || b >= proxy_of_.size() || proxy_of_[a] == kNoProxy || proxy_of_[b] == kNoProxy)
    return nullptr;
  const PairKey* key = find_key(std::min(serial(a), serial(b)), std::max(serial(a), serial(b)));
  return key && key->at != PairKey::kNone ? &pairs_[key->at] : nullptr;
}

void NearPairs::release(PairKey& key) {
  if (key.at == PairKey::kNone) return;
  pairs_[key.at] = {};
  free_pairs_.push_back(std::exchange(key.at, PairKey::kNone));  // place_near() left room for it
}

void NearPairs::merge() {
  if (new_keys_.empty()) return;
  std::sort(new_keys_.begin(), new_keys_.end(), [this](const PairKey& x, const PairKey& y) {
    poll();
    return earlier(x, y);
  });
  const auto last = std::unique(new_keys_.begin(), new_keys_.end(), [](const PairKey& x, const PairKey& y) {
    return x.serial_a == y.serial_a && x.serial_b == y.serial_b;
  });
  new_keys_.erase(last, new_keys_.end());
  // Merged from the back, in place.
  std::size_t old = keys_.size(), fresh = new_keys_.size();
  fresh_.reserve(fresh);  // so that memory ends before anything is moved, or not at all
  keys_.resize(old + fresh);
  for (std::size_t at = old + fresh; fresh > 0;) {
    const bool take_old = old > 0 && earlier(new_keys_[fresh - 1], keys_[old - 1]);
    --at;
    if (!take_old) fresh_.push_back(at);
    keys_[at] = take_old ? keys_[--old] : new_keys_[--fresh];
  }
}

void NearPairs::drop_far() {
  std::erase_if(keys_, [this](PairKey& key) {
    const ProxyIndex a = proxy_of_[key.a], b = proxy_of_[key.b];
    if (!reach_[a].moved && !reach_[b].moved) return false;
    const BoxTree::Leaf leaf_a = proxies_[a].leaf, leaf_b = proxies_[b].leaf;
    if (leaf_a != BoxTree::kNoLeaf && leaf_b != BoxTree::kNoLeaf && tree_.box(leaf_a).intersects(tree_.box(leaf_b)))
      return false;
    release(key);
    return true;
  });
}

namespace {

[[noreturn]] void fail_by_pairs(std::size_t most) {
  throw Error(
      ErrorCode::Budget,
      fmt::format("more than {} pairs of bodies may touch in this step: to solve their contacts takes more than "
                  "the physics budget (breve_world_config.physics_budget, --physics-budget); put bodies apart",
                  most));
}

[[noreturn]] void fail_by_others(std::size_t most) {
  throw Error(
      ErrorCode::Budget,
      fmt::format("more than {} pairs of bodies are near each other in this step, even if they do not push each other: "
                  "to examine them takes more than the physics budget (breve_world_config.physics_budget, "
                  "--physics-budget); slow the bodies down or put them apart",
                  most));
}

}  // namespace

/// A crowd with too many pairs is not searched to its end. If two bodies both moved in this update, the one that
/// was looked at later counts them, with the boxes of this step.
void NearPairs::meet(PairKey& key, ProxyIndex other, Asking& asking) const {
  if (!reach_[other].moved || !near(key)) return;
  asking.ask(asking.wanted, key);
  if (key.pushes) {
    asking.met += weight(key);
    if (asking.met > asking.most) fail_by_pairs(asking.most);
  } else if (++asking.others > kOthers * asking.most) {
    fail_by_others(kOthers * asking.most);
  }
}

/// Before anything is forgotten: the worlds that a step like this leaves behind are the same, whatever they found
/// before.
void NearPairs::bound_near(std::size_t most) const {
  if (most == kNoMost) return;
  std::size_t met = 0, others = 0;
  for (const PairKey& key : keys_)
    if (near(key)) (key.pushes ? met : others) += key.pushes ? weight(key) : 1;
  if (met > most) fail_by_pairs(most);
  if (others > kOthers * most) fail_by_others(kOthers * most);
}

/// Where many pairs are new, what they will need at once: what there is no memory for does not begin.
void NearPairs::reserve_near() {
  if (new_keys_.size() < kMany) return;
  const auto is_new = [this](const PairKey& key) { return key.at == PairKey::kNone && key.pushes && near(key); };
  pairs_.reserve(pairs_.size() + static_cast<std::size_t>(std::count_if(keys_.begin(), keys_.end(), is_new)));
}

/// Whether a pair is in the list depends on the past; what it remembers must not: that is kept from step to step only
/// by those whose boxes meet in each.
void NearPairs::place_near() {
  reserve_near();
  others_ = 0;
  for (PairKey& key : keys_) {
    poll();
    const bool meets = near(key);
    if (!key.pushes || !meets) {
      others_ += meets;
      release(key);
      continue;
    }
    if (key.at == PairKey::kNone) {
      if (free_pairs_.empty()) {
        if (free_pairs_.capacity() <= pairs_.size())
          free_pairs_.reserve(2 * pairs_.size() + 16);  // release() takes none
        pairs_.emplace_back();
        free_pairs_.push_back(static_cast<std::uint32_t>(pairs_.size() - 1));
      }
      key.at = free_pairs_.back();
      free_pairs_.pop_back();
      pairs_[key.at].a = key.a;
      pairs_[key.at].b = key.b;
    }
    pairs_[key.at].handled = key.handled;
  }
}

/// True if the boxes of what the two may reach in this step meet.
bool NearPairs::near(const PairKey& key) const {
  return reach_[proxy_of_[key.a]].box.intersects(reach_[proxy_of_[key.b]].box);
}

/// How many pairs it counts as: to find how deep two solids of many corners are in one another takes long.
std::size_t NearPairs::weight(const PairKey& key) const {
  constexpr std::size_t kCornersPerPair = 12;
  constexpr double kDeep = 0.25;  // of the lesser box
  const ProxyIndex a = proxy_of_[key.a], b = proxy_of_[key.b];
  const Shape *one = proxies_[a].shape, *other = proxies_[b].shape;
  const std::size_t corners = one != nullptr && other != nullptr ? many_corners(*one, *other) : 0;
  if (corners == 0) return 1;
  const double common = reach_[a].box.intersection(reach_[b].box).sizes().minCoeff();
  const double least = std::min(reach_[a].box.sizes().minCoeff(), reach_[b].box.sizes().minCoeff());
  return common > kDeep * least ? 1 + corners / kCornersPerPair : 1;
}

std::size_t NearPairs::bytes() const {
  return tree_.bytes() + proxies_.capacity() * sizeof(Proxy) + reach_.capacity() * sizeof(Reach) +
         pairs_.capacity() * sizeof(NearPair) + (keys_.capacity() + new_keys_.capacity()) * sizeof(PairKey) +
         free_pairs_.capacity() * sizeof(std::uint32_t) +
         (free_.capacity() + proxy_of_.capacity() + movers_.capacity() + put_.capacity() + drivers_.capacity() +
          struck_.capacity() + moved_.capacity()) *
             sizeof(BodyIndex);
}

}  // namespace breve
