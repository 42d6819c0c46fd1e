// The broad phase: boxes of paths in a dynamic tree, a little too large so that slow bodies are not looked at again,
// and the list of pairs that are near, kept from sub-step to sub-step in the order of creation.
#include <algorithm>

#include "runtime/contact/collision_stage.hpp"

namespace breve {

CollisionStage::CollisionStage(std::pmr::memory_resource* memory, Bodies& bodies)
    : bodies_(&bodies),
      tree_(memory),
      proxies_(memory),
      free_proxies_(memory),
      left_(memory),
      proxy_of_(memory),
      order_(memory),
      paths_(memory),
      moved_(memory),
      settling_(memory),
      fresh_(memory),
      put_(memory),
      late_(memory),
      pairs_(memory),
      new_pairs_(memory),
      impacts_(memory),
      log_(memory),
      found_(memory),
      loaded_touching_(memory) {}

void CollisionStage::purge() {
  if (left_.empty()) return;
  std::erase_if(order_, [this](ProxyIndex index) { return proxies_[index].body == kNoBody; });
  std::erase_if(pairs_, [this](const Pair& pair) {
    return proxies_[pair.a].body == kNoBody || proxies_[pair.b].body == kNoBody;
  });
  free_proxies_.insert(free_proxies_.end(), left_.begin(), left_.end());
  left_.clear();
}

void CollisionStage::refresh(const CollisionClient& client, bool rules_changed) {
  proxy_of_.resize(bodies_->index_end(), kNoProxy);
  const std::size_t before = order_.size();
  const auto sort_order = [&] {
    if (order_.size() == before) return;
    std::sort(order_.begin(), order_.end(),
              [this](ProxyIndex x, ProxyIndex y) { return proxies_[x].serial < proxies_[y].serial; });
  };
  try {
    for (BodyIndex body = 0; body < proxy_of_.size(); ++body) {
      if (proxy_of_[body] == kNoProxy && bodies_->used(body) && client.takes_part(body)) enter(client, body);
    }
  } catch (...) {
    sort_order();
    throw;
  }
  sort_order();
  if (!rules_changed) return;
  std::erase_if(pairs_,
                [&](const Pair& pair) { return !client.reported(proxies_[pair.a].body, proxies_[pair.b].body); });
  look_at_all_ = true;
}

void CollisionStage::enter(const CollisionClient& client, BodyIndex body) {
  // Room for all to leave, so that forget() never allocates.
  if (left_.capacity() <= order_.size()) left_.reserve(2 * order_.size() + 16);
  if (order_.capacity() == order_.size()) order_.reserve(2 * order_.size() + 16);
  ProxyIndex index;
  if (free_proxies_.empty()) {
    proxies_.emplace_back();
    index = static_cast<ProxyIndex>(proxies_.size() - 1);
  } else {
    index = free_proxies_.back();
    free_proxies_.pop_back();
  }
  const std::uint32_t version = proxies_[index].version;
  Proxy& proxy = proxies_[index] = Proxy();
  proxy.body = body;
  proxy.serial = client.serial(body);
  proxy.version = version + 1;
  proxy.mobile = bodies_->kind(body) != BodyKind::Stationary;
  proxy_of_[body] = index;
  order_.push_back(index);
  ++live_;
}

/// The touching pairs of an image, now that their bodies are known.
void CollisionStage::enter_loaded(const CollisionClient& client) {
  for (const auto& [a, b] : loaded_touching_) {
    if (a >= proxy_of_.size() || b >= proxy_of_.size()) continue;
    const ProxyIndex x = proxy_of_[a], y = proxy_of_[b];
    if (x == kNoProxy || y == kNoProxy || !client.reported(a, b)) continue;
    Pair pair;
    pair.a = proxies_[x].serial < proxies_[y].serial ? x : y;
    pair.b = pair.a == x ? y : x;
    pair.touching = true;
    new_pairs_.push_back(pair);
  }
  merge_new_pairs();
  loaded_touching_.clear();
}

void CollisionStage::forget(BodyIndex body) {
  std::erase_if(loaded_touching_, [body](const auto& pair) { return pair.first == body || pair.second == body; });
  if (body >= proxy_of_.size() || proxy_of_[body] == kNoProxy) return;
  const ProxyIndex index = proxy_of_[body];
  Proxy& proxy = proxies_[index];
  if (proxy.leaf != BoxTree::kNoLeaf) tree_.remove(proxy.leaf);
  proxy.leaf = BoxTree::kNoLeaf;
  proxy.body = kNoBody;
  proxy.path = kNoPath;
  ++proxy.version;
  proxy_of_[body] = kNoProxy;
  left_.push_back(index);
  --live_;
}

Eigen::AlignedBox3d CollisionStage::box_of_path(const Proxy& proxy) const {
  const Shape& shape = *bodies_->collision_shape(proxy.body);
  Eigen::AlignedBox3d box;
  if (proxy.path == kNoPath || paths_[proxy.path].rotational_velocity == Vector3::Zero()) {
    const Matrix3 rotation = bodies_->rotation(proxy.body);
    box = shape.bounds(rotation);
  } else {
    // It turns on the way: the ball about its centre holds it at every angle.
    const Vector3 reach = Vector3::Constant(shape.bounding_radius());
    box = Eigen::AlignedBox3d(-reach, reach);
  }
  const Vector3 now = bodies_->location(proxy.body);
  Vector3 from = now;
  Vector3 to = now;
  if (proxy.path != kNoPath) {
    from = paths_[proxy.path].from.location;
    to = paths_[proxy.path].to.location;
  }
  Eigen::AlignedBox3d swept(from.cwiseMin(to) + box.min(), from.cwiseMax(to) + box.max());
  // Far more than the tolerance of touch, so that what touches has boxes that meet.
  constexpr double kMargin = 1e-6;
  const double largest = std::max(swept.min().cwiseAbs().maxCoeff(), swept.max().cwiseAbs().maxCoeff());
  const Vector3 margin = Vector3::Constant(kMargin * shape.bounding_radius() + 1e-12 * largest);
  swept.min() -= margin;
  swept.max() += margin;
  return swept;
}

/// The boxes that may be others than in the last sub-step, then the pairs of those that left theirs in the tree.
void CollisionStage::update_boxes(CollisionClient& client) {
  put_.clear();
  put_.swap(late_);
  bodies_->take_put(Follower::Collisions, put_);
  // Handlers that physics called since begin() may have made bodies, which enter at the next.
  for (const BodyIndex body : put_) {
    const bool known = body < proxy_of_.size() && proxy_of_[body] != kNoProxy;
    if (!known && bodies_->used(body) && client.takes_part(body)) late_.push_back(body);
  }
  fresh_.clear();
  const std::uint64_t scalings = bodies_->shape_changes();
  if (look_at_all_ || scalings != seen_scalings_) {
    for (const ProxyIndex index : order_) update_box(index);
  } else {
    for (const auto* list : {&moved_, &settling_})
      for (const ProxyIndex index : *list)
        if (proxies_[index].body != kNoBody) update_box(index);
    for (const BodyIndex body : put_)
      if (body < proxy_of_.size() && proxy_of_[body] != kNoProxy) update_box(proxy_of_[body]);
  }
  find_new_pairs(client);
  seen_scalings_ = scalings;
  look_at_all_ = false;
}

void CollisionStage::update_box(ProxyIndex index) {
  ++counters_.boxes;
  Proxy& proxy = proxies_[index];
  proxy.box = box_of_path(proxy);
  const Vector3 sides = proxy.box.sizes();
  if (!proxy.box.min().allFinite() || !proxy.box.max().allFinite() || !sides.allFinite()) {
    // A body that flew out of the numbers touches nothing.
    proxy.box.setEmpty();
    if (proxy.leaf != BoxTree::kNoLeaf) tree_.remove(proxy.leaf);
    proxy.leaf = BoxTree::kNoLeaf;
    return;
  }
  if (proxy.leaf != BoxTree::kNoLeaf && tree_.box(proxy.leaf).contains(proxy.box)) {
    if (look_at_all_) fresh_.push_back(index);
    return;
  }
  Eigen::AlignedBox3d roomy = proxy.box;
  if (proxy.mobile) {
    constexpr double kRoom = 0.1;  // of the size: slow bodies keep their box for many sub-steps
    const Vector3 room = Vector3::Constant(kRoom * sides.minCoeff());
    roomy.min() -= room;
    roomy.max() += room;
  }
  if (proxy.leaf == BoxTree::kNoLeaf) {
    proxy.leaf = tree_.insert(roomy, index);
  } else {
    tree_.move(proxy.leaf, roomy);
  }
  fresh_.push_back(index);
}

/// Those whose boxes a box meets, itself or one of its images across edges that wrap: whoever it meets is inside space,
/// or sticks out of it by less than its size, so the tree refuses most images at its root.
void CollisionStage::find_near(const Eigen::AlignedBox3d& box) {
  found_.clear();
  tree_.query(box, found_);
  if (!space_.wraps()) return;
  const std::size_t own = found_.size();
  const auto lengths = [this](int axis) {
    const Extent::Axis& a = space_.axis(axis);
    return a.edge == Ending::Wrap ? a.high - a.low : 0;
  };
  for (int i = 0; i < 27; ++i) {
    const int steps[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    Vector3 shift;
    bool real = i != 13;  // the box itself
    for (int k = 0; k < 3; ++k) {
      shift[k] = steps[k] * lengths(k);
      real = real && (steps[k] == 0 || lengths(k) > 0);
    }
    if (real) tree_.query(box.translated(shift), found_);
  }
  if (found_.size() == own) return;
  std::sort(found_.begin(), found_.end());
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
}

bool CollisionStage::boxes_meet(const Pair& pair) const {
  const Eigen::AlignedBox3d &a = proxies_[pair.a].box, &b = proxies_[pair.b].box;
  if (a.isEmpty() || b.isEmpty()) return false;
  return space_.wraps() ? a.intersects(b.translated(image_of_b(pair))) : a.intersects(b);
}

/// The pairs of the fresh boxes. Where there are more pairs than may be looked at, it ends before all of them are
/// found.
void CollisionStage::find_new_pairs(CollisionClient& client) {
  constexpr std::size_t kLot = 4096;
  std::uint64_t meeting = 0;
  std::size_t looked = 0;
  for (const ProxyIndex index : fresh_) {
    meeting += find_pairs(client, index);
    looked += found_.size();
    if (looked < kLot) continue;
    looked = 0;
    client.expect(kWorkOfPair * (meeting / 2));  // each may be found from both its ends
  }
  merge_new_pairs();
}

/// Those of one body that are not known yet; how many of them have boxes that meet.
std::uint64_t CollisionStage::find_pairs(const CollisionClient& client, ProxyIndex index) {
  find_near(tree_.box(proxies_[index].leaf));
  std::uint64_t meeting = 0;
  const Proxy& self = proxies_[index];
  for (const ProxyIndex other_index : found_) {
    const Proxy& other = proxies_[other_index];
    if (other_index == index || !(self.mobile || other.mobile)) continue;
    Pair pair;
    pair.a = self.serial < other.serial ? index : other_index;
    pair.b = self.serial < other.serial ? other_index : index;
    if (find_pair(pair.a, pair.b) || !client.reported(self.body, other.body)) continue;
    new_pairs_.push_back(pair);
    meeting += boxes_meet(pair) ? 1 : 0;
  }
  return meeting;
}

bool CollisionStage::earlier(const Pair& x, const Pair& y) const {
  const std::uint64_t xa = proxies_[x.a].serial;
  const std::uint64_t ya = proxies_[y.a].serial;
  return xa != ya ? xa < ya : proxies_[x.b].serial < proxies_[y.b].serial;
}

void CollisionStage::merge_new_pairs() {
  if (new_pairs_.empty()) return;
  std::sort(new_pairs_.begin(), new_pairs_.end(), [this](const Pair& x, const Pair& y) { return earlier(x, y); });
  const auto last = std::unique(new_pairs_.begin(), new_pairs_.end(),
                                [](const Pair& x, const Pair& y) { return x.a == y.a && x.b == y.b; });
  new_pairs_.erase(last, new_pairs_.end());
  // Merged from the back, in place.
  std::size_t old = pairs_.size();
  std::size_t fresh = new_pairs_.size();
  pairs_.resize(old + fresh);
  for (std::size_t at = old + fresh; fresh > 0;) {
    const bool take_old = old > 0 && earlier(new_pairs_[fresh - 1], pairs_[old - 1]);
    pairs_[--at] = take_old ? pairs_[--old] : new_pairs_[--fresh];
  }
  new_pairs_.clear();
}

void CollisionStage::drop_far_pairs() {
  std::erase_if(pairs_, [this](const Pair& pair) {
    const Proxy& a = proxies_[pair.a];
    const Proxy& b = proxies_[pair.b];
    if (a.leaf == BoxTree::kNoLeaf || b.leaf == BoxTree::kNoLeaf) return true;
    const Eigen::AlignedBox3d &x = tree_.box(a.leaf), &y = tree_.box(b.leaf);
    return !x.intersects(space_.wraps() ? y.translated(space_.image(x.center(), y.center())) : y);
  });
}

CollisionStage::Pair* CollisionStage::find_pair(ProxyIndex x, ProxyIndex y) {
  Pair key;
  key.a = proxies_[x].serial < proxies_[y].serial ? x : y;
  key.b = key.a == x ? y : x;
  const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), key,
                                   [this](const Pair& p, const Pair& q) { return earlier(p, q); });
  return at != pairs_.end() && at->a == key.a && at->b == key.b ? &*at : nullptr;
}

std::size_t CollisionStage::bytes() const {
  return tree_.bytes() + proxies_.capacity() * sizeof(Proxy) + paths_.capacity() * sizeof(Path) +
         (moved_.capacity() + settling_.capacity() + put_.capacity()) * sizeof(ProxyIndex) +
         (pairs_.capacity() + new_pairs_.capacity()) * sizeof(Pair) + impacts_.capacity() * sizeof(Impact) +
         (proxy_of_.capacity() + order_.capacity() + free_proxies_.capacity() + left_.capacity()) * sizeof(ProxyIndex);
}

void CollisionStage::save(ByteWriter& out) const {
  std::pmr::vector<std::pair<BodyIndex, BodyIndex>> touching(loaded_touching_, loaded_touching_.get_allocator());
  for (const Pair& pair : pairs_) {
    const BodyIndex a = proxies_[pair.a].body;
    const BodyIndex b = proxies_[pair.b].body;
    if (pair.touching && a != kNoBody && b != kNoBody) touching.emplace_back(a, b);
  }
  out.put(static_cast<std::uint64_t>(touching.size()));
  for (const auto& [a, b] : touching) {
    out.put(a);
    out.put(b);
  }
}

void CollisionStage::load(ByteReader& in) {
  const std::size_t count = in.get_count(2 * sizeof(BodyIndex));
  for (std::size_t i = 0; i < count; ++i) {
    const auto a = in.get<BodyIndex>();
    const auto b = in.get<BodyIndex>();
    if (!bodies_->used(a) || !bodies_->used(b) || a == b) ByteReader::fail();
    loaded_touching_.emplace_back(a, b);
  }
}

void CollisionStage::hash(Hasher& hasher) const {
  const auto add = [&hasher](BodyIndex a, BodyIndex b) { hasher.add(std::uint64_t{a} << 32 | b); };
  for (const auto& [a, b] : loaded_touching_) add(a, b);
  for (const Pair& pair : pairs_) {
    const BodyIndex a = proxies_[pair.a].body;
    const BodyIndex b = proxies_[pair.b].body;
    if (pair.touching && a != kNoBody && b != kNoBody) add(a, b);
  }
}

}  // namespace breve
