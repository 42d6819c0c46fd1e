// Which bodies are near one another: boxes in a tree that is kept from step to step, and pairs in the order of
// creation, each with what it remembers of its contact.
#pragma once

#include <memory_resource>
#include <vector>

#include "runtime/contact/springs.hpp"
#include "runtime/dynamics/dynamics.hpp"
#include "runtime/solid/manifold.hpp"
#include "runtime/space/box_tree.hpp"

namespace breve {

/// What a contact point remembers of the last sub-step, world axes.
struct WarmPoint {
  std::uint32_t feature = 0;
  bool slides = false;                // of a spring
  Vector3 impulse = Vector3::Zero();  // N*s, to start from in the next; of a spring its stretch along the surface, m
};

/// Two bodies whose roomy boxes meet. There are several times as many as pairs that may touch, and all are gone through
/// in each step: so they are small.
struct PairKey {
  static constexpr std::uint32_t kNone = 0xffffffffU;
  BodyIndex a = kNoBody, b = kNoBody;  // a was created earlier
  std::uint64_t serial_a = 0, serial_b = 0;
  bool pushes = false;       // contacts of these two are solved
  bool handled = false;      // a handler wants to know
  std::uint32_t at = kNone;  // of its NearPair, if it has one
};

/// Two bodies that may touch in this step and push each other: what is known of their contact.
struct NearPair {
  BodyIndex a = kNoBody, b = kNoBody;
  bool handled = false;
  bool touching = false;  // at the end of the last sub-step
  bool reported = false;  // the handler was called in this step
  PairCache cache;
  contact::Law law;
  contact::Spring spring;  // that its surfaces are, until they part; stiffness 0: they are rigid
  double stored = 0;       // J, in that
  int warm_count = 0;
  std::array<WarmPoint, 2 * kMostPoints> warm;
};

class NearPairs {
 public:
  explicit NearPairs(std::pmr::memory_resource* memory);

  /// Brings boxes and pairs up to date for a step of h seconds.
  /// @param rules    grows when an answer of `wanted` may have changed
  /// @param strikes  what is struck within the step is to meet what it reaches then
  template <class Wanted>
  void update(const Bodies& bodies, const DynamicsClient& client, const Vector3& gravity, double h, std::uint64_t rules,
              bool strikes, const Wanted& wanted) {
    refresh(bodies, client, gravity, h);
    if (rules != seen_rules_ || unasked_)
      for (PairKey& key : keys_) wanted(key);
    seen_rules_ = rules;
    unasked_ = true;
    merge();
    for (const std::size_t index : fresh_) wanted(keys_[index]);
    constexpr int kMostPassed = 64;  // bodies, one after the other
    for (int i = 0; strikes && i < kMostPassed && pass_on(bodies, h); ++i) {
      merge();
      for (const std::size_t index : fresh_) wanted(keys_[index]);
    }
    drop_far();
    place_near();
    unasked_ = incomplete_ = false;
  }
  void forget(BodyIndex body);

  NearPair& at(std::uint32_t index) { return pairs_[index]; }
  /// Calls f(key, pair) for those that have a NearPair, in the order of creation.
  template <class F>
  void each(F&& f) {
    for (const PairKey& key : keys_)
      if (key.at != PairKey::kNone) f(key, pairs_[key.at]);
  }
  template <class F>
  void each(F&& f) const {
    for (const PairKey& key : keys_)
      if (key.at != PairKey::kNone) f(key, pairs_[key.at]);
  }
  NearPair* find(BodyIndex a, BodyIndex b);
  std::uint64_t serial(BodyIndex body) const { return proxies_[proxy_of_[body]].serial; }
  /// Bodies in the order of creation: those that forces move.
  const std::pmr::vector<BodyIndex>& movers() const { return movers_; }

  /// Of each body that forces move: how long it has been still, s, and whether it sleeps.
  struct Rest {
    double still = 0;
    bool asleep = false;
  };
  Rest& rest(BodyIndex body) { return proxies_[proxy_of_[body]].rest; }
  const Rest* find_rest(BodyIndex body) const {
    return body < proxy_of_.size() && proxy_of_[body] != kNoProxy ? &proxies_[proxy_of_[body]].rest : nullptr;
  }
  void wake(BodyIndex body) {
    if (body < proxy_of_.size() && proxy_of_[body] != kNoProxy) proxies_[proxy_of_[body]].rest = {};
  }
  std::size_t bytes() const;
  void save(ByteWriter& out) const;
  void load(ByteReader& in, const Bodies& bodies);
  void hash(Hasher& hasher) const;

 private:
  using ProxyIndex = std::uint32_t;
  static constexpr ProxyIndex kNoProxy = 0xffffffffU;
  struct Proxy {
    BodyIndex body = kNoBody;
    std::uint64_t serial = 0;
    BoxTree::Leaf leaf = BoxTree::kNoLeaf;
    bool moves = false;
    Rest rest;
    Vector3 location = Vector3::Zero();  // of a body that does not move by itself, when its box was found
    Quaternion orientation{1, 0, 0, 0};
    const Shape* shape = nullptr;
    double speed = 0;   // m/s, that it has or may be given
    bool wide = false;  // by what may strike it
  };
  /// Apart from the rest of a proxy, since each pair looks at two of them.
  struct Reach {
    Eigen::AlignedBox3d box;  // in this step
    bool moved = false;       // its roomy box, in this update
  };
  void gather(const Bodies& bodies, const DynamicsClient& client);
  void refresh(const Bodies& bodies, const DynamicsClient& client, const Vector3& gravity, double h);
  void enter(const Bodies& bodies, const DynamicsClient& client, BodyIndex body);
  void leave(ProxyIndex index);
  void update_box(const Bodies& bodies, Proxy& proxy, const Vector3& gravity, double h);
  void seek(ProxyIndex index);
  PairKey* find_key(std::uint64_t serial_a, std::uint64_t serial_b);
  bool near(const PairKey& key) const;
  void release(PairKey& key);
  bool pass_on(const Bodies& bodies, double h);
  bool widen(Proxy& proxy, double speed, double h, double far, double more);
  void merge();
  void drop_far();
  void place_near();

  BoxTree tree_;
  std::pmr::vector<Proxy> proxies_;
  std::pmr::vector<Reach> reach_;  // of proxies
  std::pmr::vector<ProxyIndex> free_, proxy_of_;
  std::pmr::vector<BodyIndex> movers_;
  std::pmr::vector<PairKey> keys_, new_keys_;
  std::pmr::vector<NearPair> pairs_;  // in places that are used again
  std::pmr::vector<std::uint32_t> free_pairs_;
  std::pmr::vector<std::size_t> fresh_;
  std::pmr::vector<std::uint32_t> found_;
  std::uint64_t seen_rules_ = 0, seen_bodies_ = ~std::uint64_t{0};
  // Memory ended in the last update: all is to be looked for again, and `wanted` to be asked of all.
  bool incomplete_ = false, unasked_ = false;
};

}  // namespace breve
