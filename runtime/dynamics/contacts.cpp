// The broad phase: boxes a little too large, so that slow bodies are not looked at again.
#include "runtime/dynamics/contacts.hpp"

#include <algorithm>
#include <utility>

namespace breve {

namespace {

bool earlier(const NearPair& x, const NearPair& y) {
  return x.serial_a != y.serial_a ? x.serial_a < y.serial_a : x.serial_b < y.serial_b;
}

}  // namespace

NearPairs::NearPairs(std::pmr::memory_resource* memory)
    : tree_(memory),
      proxies_(memory),
      free_(memory),
      proxy_of_(memory),
      movers_(memory),
      pairs_(memory),
      new_pairs_(memory),
      fresh_(memory),
      found_(memory) {}

void NearPairs::enter(const Bodies& bodies, const DynamicsClient& client, BodyIndex body) {
  ProxyIndex index;
  if (free_.empty()) {
    if (free_.capacity() <= proxies_.size()) free_.reserve(2 * proxies_.size() + 16);  // leave() takes none
    index = static_cast<ProxyIndex>(proxies_.size());
    proxies_.emplace_back();
  } else {
    index = free_.back();
    free_.pop_back();
  }
  Proxy& proxy = proxies_[index] = Proxy();
  proxy.body = body;
  proxy.serial = client.serial(body);
  proxy.moves = bodies.kind(body) != BodyKind::Stationary;
  proxy_of_[body] = index;
}

void NearPairs::leave(ProxyIndex index) {
  Proxy& proxy = proxies_[index];
  if (proxy.leaf != BoxTree::kNoLeaf) tree_.remove(proxy.leaf);
  const BodyIndex body = proxy.body;
  std::erase_if(pairs_, [body](const NearPair& pair) { return pair.a == body || pair.b == body; });
  proxy_of_[body] = kNoProxy;
  proxy = Proxy();
  free_.push_back(index);
}

void NearPairs::forget(BodyIndex body) {
  if (body < proxy_of_.size() && proxy_of_[body] != kNoProxy) leave(proxy_of_[body]);
  std::erase(movers_, body);
}

void NearPairs::gather(const Bodies& bodies, const DynamicsClient& client) {
  proxy_of_.resize(bodies.index_end(), kNoProxy);
  movers_.clear();
  for (BodyIndex body = 0; body < proxy_of_.size(); ++body) {
    const bool solid = bodies.used(body) && (bodies.kind(body) == BodyKind::Stationary || bodies.physics(body));
    const bool known = proxy_of_[body] != kNoProxy;
    if (solid && !known) enter(bodies, client, body);
    if (!solid && known) leave(proxy_of_[body]);
    if (solid && bodies.kind(body) != BodyKind::Stationary) movers_.push_back(body);
  }
  std::sort(movers_.begin(), movers_.end(), [this](BodyIndex x, BodyIndex y) { return serial(x) < serial(y); });
}

void NearPairs::refresh(const Bodies& bodies, const DynamicsClient& client, const Vector3& gravity, double h) {
  const bool again = std::exchange(incomplete_, true);
  if (again || bodies.revision() != seen_bodies_) {
    gather(bodies, client);
    seen_bodies_ = bodies.revision();
  }
  fresh_.clear();
  new_pairs_.clear();
  for (Proxy& proxy : proxies_)
    if (proxy.body != kNoBody) update_box(bodies, proxy, gravity, h);
  if (!again) return;
  for (ProxyIndex index = 0; index < proxies_.size(); ++index)
    if (proxies_[index].leaf != BoxTree::kNoLeaf) seek(index);
}

void NearPairs::update_box(const Bodies& bodies, Proxy& proxy, const Vector3& gravity, double h) {
  const Shape* shape = bodies.collision_shape(proxy.body).get();
  const Vector3& location = bodies.location(proxy.body);
  const Quaternion orientation = bodies.orientation(proxy.body);
  const bool still = proxy.leaf != BoxTree::kNoLeaf && proxy.shape == shape && proxy.location == location &&
                     proxy.orientation.coeffs() == orientation.coeffs();
  if (still && !proxy.wide && (!proxy.moves || proxy.rest.asleep)) return;
  proxy.wide = false;
  proxy.speed = proxy.moves ? bodies.velocity(proxy.body).norm() : 0;
  proxy.shape = shape;
  proxy.location = location;
  proxy.orientation = orientation;
  proxy.box = shape->bounds(orientation.toRotationMatrix());
  proxy.box.translate(location);
  Vector3 room = Vector3::Constant(1e-3 * shape->bounding_radius());
  if (proxy.moves) {
    // What it may reach: straight on, falling, turning; twice as far, since it may be pushed on the way.
    const double turn = bodies.rotational_velocity(proxy.body).norm() * h * shape->bounding_radius();
    const Vector3 way = (bodies.velocity(proxy.body).cwiseAbs() + h * gravity.cwiseAbs()) * (2 * h);
    room += way + Vector3::Constant(2 * std::min(turn, shape->bounding_radius()));
  }
  proxy.box.min() -= room;
  proxy.box.max() += room;
  if (!proxy.box.min().allFinite() || !proxy.box.max().allFinite()) {
    // A body that flew out of the numbers touches nothing.
    proxy.box.setEmpty();
    if (proxy.leaf != BoxTree::kNoLeaf) tree_.remove(std::exchange(proxy.leaf, BoxTree::kNoLeaf));
    return;
  }
  if (proxy.leaf != BoxTree::kNoLeaf && tree_.box(proxy.leaf).contains(proxy.box)) return;
  Eigen::AlignedBox3d roomy = proxy.box;
  if (proxy.moves) {
    constexpr double kRoom = 0.1;  // of the radius: slow bodies keep their box for many steps
    const Vector3 more = Vector3::Constant(kRoom * shape->bounding_radius());
    roomy.min() -= more;
    roomy.max() += more;
  }
  const auto index = static_cast<ProxyIndex>(&proxy - proxies_.data());
  if (proxy.leaf == BoxTree::kNoLeaf)
    proxy.leaf = tree_.insert(roomy, index);
  else
    tree_.move(proxy.leaf, roomy);
  seek(index);
}

void NearPairs::seek(ProxyIndex index) {
  found_.clear();
  tree_.query(tree_.box(proxies_[index].leaf), found_);
  const Proxy& self = proxies_[index];
  for (const ProxyIndex other_index : found_) {
    const Proxy& other = proxies_[other_index];
    if (other_index == index || !(self.moves || other.moves)) continue;
    NearPair pair;
    const bool first = self.serial < other.serial;
    pair.a = first ? self.body : other.body;
    pair.b = first ? other.body : self.body;
    pair.serial_a = first ? self.serial : other.serial;
    pair.serial_b = first ? other.serial : self.serial;
    if (!find(pair.a, pair.b)) new_pairs_.push_back(pair);
  }
}

NearPair* NearPairs::find(BodyIndex a, BodyIndex b) {
  if (a >= proxy_of_.size() || b >= proxy_of_.size() || proxy_of_[a] == kNoProxy || proxy_of_[b] == kNoProxy)
    return nullptr;
  NearPair key;
  key.serial_a = std::min(serial(a), serial(b));
  key.serial_b = std::max(serial(a), serial(b));
  const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), key, earlier);
  return at != pairs_.end() && at->serial_a == key.serial_a && at->serial_b == key.serial_b ? &*at : nullptr;
}

void NearPairs::merge() {
  if (new_pairs_.empty()) return;
  std::sort(new_pairs_.begin(), new_pairs_.end(), earlier);
  const auto last = std::unique(new_pairs_.begin(), new_pairs_.end(), [](const NearPair& x, const NearPair& y) {
    return x.serial_a == y.serial_a && x.serial_b == y.serial_b;
  });
  new_pairs_.erase(last, new_pairs_.end());
  // Merged from the back, in place.
  std::size_t old = pairs_.size(), fresh = new_pairs_.size();
  fresh_.reserve(fresh);  // so that memory ends before anything is moved, or not at all
  pairs_.resize(old + fresh);
  for (std::size_t at = old + fresh; fresh > 0;) {
    const bool take_old = old > 0 && earlier(new_pairs_[fresh - 1], pairs_[old - 1]);
    --at;
    if (!take_old) fresh_.push_back(at);
    pairs_[at] = take_old ? pairs_[--old] : new_pairs_[--fresh];
  }
}

void NearPairs::drop_far() {
  std::erase_if(pairs_, [this](const NearPair& pair) {
    const Proxy &a = proxies_[proxy_of_[pair.a]], &b = proxies_[proxy_of_[pair.b]];
    if (a.leaf == BoxTree::kNoLeaf || b.leaf == BoxTree::kNoLeaf) return true;
    return !tree_.box(a.leaf).intersects(tree_.box(b.leaf));
  });
  // Whether a pair is in the list depends on the past; what it remembers must not.
  for (NearPair& pair : pairs_) {
    if (near(pair)) continue;
    pair.touching = false;
    pair.warm_count = 0;
    pair.cache = {};
  }
}

bool NearPairs::near(const NearPair& pair) const {
  return proxies_[proxy_of_[pair.a]].box.intersects(proxies_[proxy_of_[pair.b]].box);
}

std::size_t NearPairs::bytes() const {
  return tree_.bytes() + proxies_.capacity() * sizeof(Proxy) +
         (pairs_.capacity() + new_pairs_.capacity()) * sizeof(NearPair) +
         (free_.capacity() + proxy_of_.capacity() + movers_.capacity()) * sizeof(BodyIndex);
}

// What a pair remembers is state; boxes and which pairs are near are found again. A pair that is kept because boxes are
// roomy, but has nothing to remember, makes no difference.

namespace {
bool remembers(const NearPair& pair) {
  return pair.touching || pair.warm_count > 0 || pair.cache.axis != Vector3::Zero();
}
}  // namespace

void NearPairs::save(ByteWriter& out) const {
  std::uint64_t count = 0;
  for (const NearPair& pair : pairs_) count += remembers(pair);
  out.put(count);
  for (const NearPair& pair : pairs_) {
    if (!remembers(pair)) continue;
    out.put(pair.a);
    out.put(pair.b);
    out.put(pair.serial_a);
    out.put(pair.serial_b);
    out.put(pair.touching);
    out.put(pair.cache.axis);
    out.put(pair.cache.feature);
    const contact::Spring& spring = pair.spring;
    for (const double number :
         {spring.stiffness, spring.in, spring.out, spring.tangential_stiffness, spring.tangential_damping, pair.stored})
      out.put(number);
    out.put(pair.warm_count);
    for (int i = 0; i < pair.warm_count; ++i) {
      const WarmPoint& point = pair.warm[static_cast<std::size_t>(i)];
      out.put(point.feature);
      out.put(point.slides);
      out.put(point.impulse);
    }
  }
  count = 0;
  for (const Proxy& proxy : proxies_) count += proxy.body != kNoBody && proxy.rest.still > 0;
  out.put(count);
  for (BodyIndex body = 0; body < proxy_of_.size(); ++body) {
    const Rest* rest = find_rest(body);
    if (!rest || !(rest->still > 0)) continue;
    out.put(body);
    out.put(serial(body));
    out.put(rest->still);
    out.put(rest->asleep);
  }
}

void NearPairs::load(ByteReader& in, const Bodies& bodies) {
  proxy_of_.resize(bodies.index_end(), kNoProxy);
  const auto make = [&](BodyIndex body, std::uint64_t serial) {
    if (!bodies.used(body)) ByteReader::fail();
    if (proxy_of_[body] != kNoProxy) return;
    proxy_of_[body] = static_cast<ProxyIndex>(proxies_.size());
    free_.reserve(proxies_.size() + 1);
    proxies_.emplace_back();
    proxies_.back().body = body;
    proxies_.back().serial = serial;
    proxies_.back().moves = bodies.kind(body) != BodyKind::Stationary;
  };
  const std::size_t count = in.get_count(2 * sizeof(BodyIndex));
  for (std::size_t i = 0; i < count; ++i) {
    NearPair pair;
    pair.a = in.get<BodyIndex>();
    pair.b = in.get<BodyIndex>();
    pair.serial_a = in.get<std::uint64_t>();
    pair.serial_b = in.get<std::uint64_t>();
    pair.touching = in.get_bool();
    pair.cache.axis = in.get_vector();
    pair.cache.feature = in.get<std::uint32_t>();
    contact::Spring& spring = pair.spring;
    for (double* number : {&spring.stiffness, &spring.in, &spring.out, &spring.tangential_stiffness,
                           &spring.tangential_damping, &pair.stored})
      *number = in.get<double>();
    pair.warm_count = in.get<int>();
    if (pair.warm_count < 0 || pair.warm_count > static_cast<int>(pair.warm.size())) ByteReader::fail();
    for (int k = 0; k < pair.warm_count; ++k) {
      WarmPoint& point = pair.warm[static_cast<std::size_t>(k)];
      point.feature = in.get<std::uint32_t>();
      point.slides = in.get_bool();
      point.impulse = in.get_vector();
    }
    if (!pairs_.empty() && !earlier(pairs_.back(), pair)) ByteReader::fail();
    make(pair.a, pair.serial_a);
    make(pair.b, pair.serial_b);
    pairs_.push_back(pair);
  }
  const std::size_t resting = in.get_count(sizeof(BodyIndex));
  for (std::size_t i = 0; i < resting; ++i) {
    const auto body = in.get<BodyIndex>();
    make(body, in.get<std::uint64_t>());
    rest(body).still = in.get<double>();
    rest(body).asleep = in.get_bool();
  }
}

void NearPairs::hash(Hasher& hasher) const {
  for (const NearPair& pair : pairs_) {
    if (!remembers(pair)) continue;
    hasher.add(pair.serial_a);
    hasher.add(pair.serial_b);
    hasher.add(static_cast<std::uint64_t>(pair.touching) | std::uint64_t{pair.cache.feature} << 8);
    hasher.add(pair.cache.axis);
    hasher.add(pair.spring.stiffness);
    hasher.add(pair.stored);
    for (int i = 0; i < pair.warm_count; ++i) hasher.add(pair.warm[static_cast<std::size_t>(i)].impulse);
  }
  for (BodyIndex body = 0; body < proxy_of_.size(); ++body)
    if (const Rest* rest = find_rest(body); rest && rest->still > 0) hasher.add(rest->still);
}

}  // namespace breve
