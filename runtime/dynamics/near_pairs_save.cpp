// Near pairs in a snapshot and in the world hash. What a pair remembers is state; boxes and which pairs are near are
// found again. A pair that is kept because boxes are roomy, but has nothing to remember, makes no difference, unless it
// is one of bodies at rest that may not push each other: a rule that lets them wakes them.
#include <algorithm>

#include "runtime/dynamics/near_pairs.hpp"

namespace breve {

void NearPairs::save_pair(ByteWriter& out, const NearPair& pair) {
  out.put(pair.touching);
  out.put(pair.cache.axis);
  out.put(pair.cache.feature);
  out.put(pair.cache.apart);
  const contact::Spring& spring = pair.spring;
  for (const double number :
       {spring.stiffness, spring.in, spring.out, spring.tangential_stiffness, spring.tangential_damping, pair.stored})
    out.put(number);
  out.put(pair.warm_count);
  for (int i = 0; i < pair.warm_count; ++i) {
    const WarmPoint& point = pair.warm[static_cast<std::size_t>(i)];
    out.put(point.feature);
    out.put(point.slides);
    out.put(point.force);
    out.put(point.before);
  }
}

void NearPairs::save(ByteWriter& out, const Bodies& bodies) const {
  const auto remembered = [&](const PairKey& key) {
    return key.at != PairKey::kNone && keeps(bodies, key, pairs_[key.at]);
  };
  // If a rule lets them push each other from now on, those that rest wake up.
  const auto yielding = [&](const PairKey& key) {
    if (key.at != PairKey::kNone || key.pushes || !bodies.used(key.a) || !bodies.used(key.b)) return false;
    const Proxy &a = proxies_[proxy_of_[key.a]], &b = proxies_[proxy_of_[key.b]];
    return holds(bodies, a) && holds(bodies, b) && (rests(bodies, a) || rests(bodies, b));
  };
  std::uint64_t count = 0;
  for (const PairKey& key : keys_) count += remembered(key) || yielding(key);
  out.put(count);
  for (const PairKey& key : keys_) {
    const bool has_pair = remembered(key);
    if (!has_pair && !yielding(key)) continue;
    out.put(key.a);
    out.put(key.b);
    out.put(key.serial_a);
    out.put(key.serial_b);
    out.put(has_pair);
    if (has_pair) save_pair(out, pairs_[key.at]);
  }
  count = 0;
  for (const Proxy& proxy : proxies_) count += rests(bodies, proxy);
  out.put(count);
  for (BodyIndex body = 0; body < proxy_of_.size(); ++body) {
    if (proxy_of_[body] == kNoProxy || !rests(bodies, proxies_[proxy_of_[body]])) continue;
    const Rest* rest = find_rest(body);
    out.put(body);
    out.put(serial(body));
    out.put(rest->still);
    out.put(rest->asleep);
  }
  save_standing(out, bodies);
}

/// Where what does not move by itself stood when its box was found: what stands elsewhere wakes what it touches.
void NearPairs::save_standing(ByteWriter& out, const Bodies& bodies) const {
  const auto stands = [&](const Proxy& proxy) {
    return proxy.body != kNoBody && !proxy.moves && proxy.placed && holds(bodies, proxy);
  };
  out.put(static_cast<std::uint64_t>(std::count_if(proxies_.begin(), proxies_.end(), stands)));
  for (const ProxyIndex index : proxy_of_) {
    if (index == kNoProxy || !stands(proxies_[index])) continue;
    const Proxy& proxy = proxies_[index];
    out.put(proxy.body);
    out.put(proxy.serial);
    out.put(displaced(bodies, proxy));
    if (!displaced(bodies, proxy)) continue;
    out.put(reshaped(bodies, proxy));
    out.put(proxy.location);
    out.put(proxy.orientation);
  }
}

/// The proxy of a body that is known from an image alone, until the next update.
NearPairs::Proxy& NearPairs::known(BodyIndex body, std::uint64_t serial, const Bodies& bodies) {
  if (!bodies.used(body)) ByteReader::fail();
  if (proxy_of_[body] != kNoProxy) {
    Proxy& proxy = proxies_[proxy_of_[body]];
    if (proxy.serial != serial) ByteReader::fail();
    return proxy;
  }
  proxy_of_[body] = static_cast<ProxyIndex>(proxies_.size());
  free_.reserve(proxies_.size() + 1);
  woken_.reserve(proxies_.size() + 1);
  reach_.resize(proxies_.size() + 1);
  Proxy& proxy = proxies_.emplace_back();
  proxy.body = body;
  proxy.serial = serial;
  proxy.moves = bodies.dynamic(body);
  proxy.switches = bodies.physics_switches(body);
  return proxy;
}

void NearPairs::load(ByteReader& in, const Bodies& bodies, double unit) {
  proxy_of_.resize(bodies.index_end(), kNoProxy);
  load_pairs(in, bodies, unit);
  load_rests(in, bodies);
  load_standing(in, bodies);
  incomplete_ = true;  // boxes are to be found again
}

NearPair NearPairs::load_pair(ByteReader& in) {
  NearPair pair;
  pair.touching = in.get_bool();
  pair.cache.axis = in.get_vector();
  pair.cache.feature = in.get<std::uint32_t>();
  pair.cache.apart = in.get<std::uint32_t>();
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
    point.force = in.get_vector();
    point.before = in.get<double>();
  }
  return pair;
}

void NearPairs::load_pairs(ByteReader& in, const Bodies& bodies, double unit) {
  const std::size_t count = in.get_count(2 * sizeof(BodyIndex));
  for (std::size_t i = 0; i < count; ++i) {
    PairKey key;
    key.a = in.get<BodyIndex>();
    key.b = in.get<BodyIndex>();
    key.serial_a = in.get<std::uint64_t>();
    key.serial_b = in.get<std::uint64_t>();
    if (key.a == key.b || (!keys_.empty() && !earlier(keys_.back(), key))) ByteReader::fail();
    known(key.a, key.serial_a, bodies);
    known(key.b, key.serial_b, bodies);
    if (in.get_bool()) {
      NearPair pair = load_pair(in);
      pair.a = key.a;
      pair.b = key.b;
      pair.law = contact::combine(bodies.material(key.a), bodies.material(key.b), unit);
      pair.law_known = true;  // who touches what was made of another material is awake in the image
      key.at = static_cast<std::uint32_t>(pairs_.size());
      pairs_.push_back(pair);
    }
    keys_.push_back(key);
  }
  free_pairs_.reserve(pairs_.size());
}

void NearPairs::load_rests(ByteReader& in, const Bodies& bodies) {
  const std::size_t resting = in.get_count(sizeof(BodyIndex));
  for (std::size_t i = 0; i < resting; ++i) {
    const auto body = in.get<BodyIndex>();
    Proxy& proxy = known(body, in.get<std::uint64_t>(), bodies);
    proxy.rest.still = in.get<double>();
    proxy.rest.asleep = in.get_bool();
    const Eigen::AlignedBox3d box = bodies.bounds(body);
    if (proxy.leaf == BoxTree::kNoLeaf && proxy.moves && box.min().allFinite() && box.max().allFinite())
      proxy.leaf = tree_.insert(box, proxy_of_[body]);  // for wake_met
  }
}

void NearPairs::load_standing(ByteReader& in, const Bodies& bodies) {
  const std::size_t standing = in.get_count(sizeof(BodyIndex));
  for (std::size_t i = 0; i < standing; ++i) {
    const auto body = in.get<BodyIndex>();
    Proxy& proxy = known(body, in.get<std::uint64_t>(), bodies);
    const Shape* shape = bodies.collision_shape(body).get();
    proxy.placed = true;
    proxy.shape = shape;
    proxy.shape_changes = shape->changes();
    proxy.location = bodies.location(body);
    proxy.orientation = bodies.orientation(body);
    if (!in.get_bool()) continue;
    if (in.get_bool()) proxy.shape = nullptr;
    proxy.location = in.get_vector();
    proxy.orientation = in.get_quaternion();
  }
}

void NearPairs::hash(Hasher& hasher, const Bodies& bodies) const {
  each([&](const PairKey& key, const NearPair& pair) {
    if (!keeps(bodies, key, pair)) return;
    hasher.add(key.serial_a);
    hasher.add(key.serial_b);
    hasher.add(static_cast<std::uint64_t>(pair.touching) | std::uint64_t{pair.cache.apart} << 1 |
               std::uint64_t{pair.cache.feature} << 8);
    hasher.add(pair.cache.axis);
    hasher.add(pair.spring.stiffness);
    hasher.add(pair.stored);
    for (int i = 0; i < pair.warm_count; ++i) {
      hasher.add(pair.warm[static_cast<std::size_t>(i)].force);
      hasher.add(pair.warm[static_cast<std::size_t>(i)].before);
    }
  });
  for (BodyIndex body = 0; body < proxy_of_.size(); ++body)
    if (proxy_of_[body] != kNoProxy && rests(bodies, proxies_[proxy_of_[body]]))
      hasher.add(proxies_[proxy_of_[body]].rest.still);
}

}  // namespace breve
