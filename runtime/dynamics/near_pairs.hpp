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
  bool slides = false;              // of a spring
  Vector3 force = Vector3::Zero();  // N, to start from in the next; of a spring its stretch along the surface, m
  double before = 0;                // N, along the normal, in the sub-step before; of a spring in the last one
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

/// In the order of creation.
inline bool earlier(const PairKey& x, const PairKey& y) {
  return x.serial_a != y.serial_a ? x.serial_a < y.serial_a : x.serial_b < y.serial_b;
}

/// Two bodies that may touch in this step and push each other: what is known of their contact.
struct NearPair {
  BodyIndex a = kNoBody, b = kNoBody;
  bool handled = false;
  bool touching = false;  // at the end of the last sub-step
  bool reported = false;  // the handler was called in this step
  PairCache cache;
  contact::Law law;
  bool law_known = false;  // `law` is of a step that was taken
  contact::Spring spring;  // that its surfaces are, until they part; stiffness 0: they are rigid
  double stored = 0;       // J, in that
  int warm_count = 0;
  std::array<WarmPoint, 2 * kMostPoints> warm;

  /// What of it an image keeps: which pairs are near without is another matter after a restore.
  bool remembers() const { return touching || warm_count > 0 || !cache.cold(); }
};

class NearPairs {
 public:
  static constexpr std::size_t kNoMost = static_cast<std::size_t>(-1);  // pairs

  explicit NearPairs(std::pmr::memory_resource* memory);

  /// Brings boxes and pairs up to date for a step of h seconds.
  /// @param rules    grows when an answer of `wanted` may have changed
  /// @param strikes  what is struck within the step is to meet what it reaches then
  /// @param most     pairs that push each other and whose boxes meet; kNoMost: no bound. There may be kOthers times as
  ///                 many that do not push each other
  /// @param bound    says whether the host wants the end
  /// @throws         Error{Budget} if there are more; Error{Interrupted}
  template <class Wanted>
  void update(Bodies& bodies, const MechanicsClient& client, const Vector3& gravity, double h, std::uint64_t rules,
              bool strikes, std::size_t most, const WorkBound& bound, const Wanted& wanted) {
    bound_ = &bound;
    Asking asking{most, 0, 0, &wanted,
                  [](const void* asked, PairKey& key) { (*static_cast<const Wanted*>(asked))(key); }};
    refresh(bodies, client, gravity, h, asking);
    expect(wanted);
    if (rules != seen_rules_ || unasked_)
      for (PairKey& key : keys_) {
        poll();
        ask_again(key, wanted);
      }
    seen_rules_ = rules;
    unasked_ = true;
    merge();
    ask_fresh(wanted);
    constexpr int kMostPassed = 64;  // bodies, one after the other
    for (int i = 0; strikes && i < kMostPassed && pass_on(bodies, h); ++i) {
      merge();
      ask_fresh(wanted);
    }
    bound_near(most);
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

  /// For each body that forces move: how long it has been still, s, and whether it sleeps.
  struct Rest {
    double still = 0;
    bool asleep = false;
  };
  Rest& rest(BodyIndex body) { return proxies_[proxy_of_[body]].rest; }
  const Rest* find_rest(BodyIndex body) const {
    return body < proxy_of_.size() && proxy_of_[body] != kNoProxy ? &proxies_[proxy_of_[body]].rest : nullptr;
  }
  bool asleep(BodyIndex body) const {
    const Rest* known = find_rest(body);
    return known && known->asleep;
  }
  /// Something about the body changed: it is awake, and so will be what it touches.
  void wake(BodyIndex body);
  void wake_all();
  /// Wakes what touches a body that was woken, moved or scaled since the last update, or made of another material.
  void wake_disturbed(Bodies& bodies, double unit);  // m, the world's length unit
  std::size_t bytes() const;
  std::uint64_t boxes() const { return boxes_; }  // of bodies, looked at so far
  /// Pairs whose boxes meet in this step and that do not push each other: links of a chain, bodies that ignore another.
  std::size_t others() const { return others_; }
  void save(ByteWriter& out, const Bodies& bodies) const;
  void load(ByteReader& in, const Bodies& bodies, double unit);
  void hash(Hasher& hasher, const Bodies& bodies) const;

 private:
  /// In each loop whose length is the number of pairs, which may be millions.
  void poll() {
    constexpr std::uint32_t kEvery = 1024;
    if (++polled_ % kEvery == 0) bound_->poll();
  }
  template <class Wanted>
  void ask_fresh(const Wanted& wanted) {
    for (const std::size_t index : fresh_) {
      poll();
      wanted(keys_[index]);
    }
  }
  /// Bodies that push each other from now on, or no longer, are awake.
  template <class Wanted>
  void ask_again(PairKey& key, const Wanted& wanted) {
    const bool pushed = key.pushes || key.at != PairKey::kNone;
    wanted(key);
    if (key.pushes == pushed || (pushed && !remembers(key))) return;
    wake(key.a);
    wake(key.b);
  }
  using ProxyIndex = std::uint32_t;
  static constexpr ProxyIndex kNoProxy = 0xffffffffU;
  /// How many pairs there may be that push each other, and `wanted`, which says whether two do.
  struct Asking {
    std::size_t most, met = 0, others = 0;  // met and others: by boxes that moved in this update
    const void* wanted;
    void (*ask)(const void*, PairKey&);
  };
  /// Where many pairs are new, the memory that they will need, before they are sorted: a crowd for which there is none
  /// is not gone through to its end. Two that both moved have found each other, so half of them count.
  template <class Wanted>
  void expect(const Wanted& wanted) {
    if (new_keys_.size() < kMany) return;
    std::size_t pushing = 0, room = kMany;
    for (PairKey& key : new_keys_) {
      poll();
      wanted(key);
      if (!key.pushes || !near(key) || ++pushing / 2 < room) continue;
      pairs_.reserve(pairs_.size() + room);
      room *= 2;
    }
  }
  void bound_near(std::size_t most) const;
  void meet(PairKey& key, ProxyIndex other, Asking& asking) const;
  static constexpr std::size_t kMany = 10'000;
  static constexpr std::size_t kOthers = 8;
  struct Proxy {
    BodyIndex body = kNoBody;
    std::uint64_t serial = 0;
    BoxTree::Leaf leaf = BoxTree::kNoLeaf;
    std::uint32_t switches = 0;  // of its physics, when it was entered
    bool moves = false;
    Rest rest;
    Vector3 location = Vector3::Zero();  // of a body that does not move by itself, when its box was found
    Quaternion orientation{1, 0, 0, 0};
    const Shape* shape = nullptr;
    std::uint64_t shape_changes = 0;
    Vector3 room = Vector3::Zero();  // about its bounds, for this step
    double speed = 0;                // m/s, that it has or may be given
    bool placed = false;             // its box was found, there
    bool wide = false;               // by what may strike it
    bool woken = false;              // from sleep, by what changed it: those that touch it are to wake
  };
  /// Apart from the rest of a proxy, since each pair looks at two of them.
  struct Reach {
    Eigen::AlignedBox3d box;  // in this step
    double speed = 0;         // m/s, that it is for
    bool moved = false;       // its roomy box, in this update
  };
  bool remembers(const PairKey& key) const { return key.at != PairKey::kNone && pairs_[key.at].remembers(); }
  /// Whether it is still what it was as it was entered: else the next update enters it anew.
  static bool holds(const Bodies& bodies, const Proxy& proxy) {
    return bodies.used(proxy.body) && bodies.physics_switches(proxy.body) == proxy.switches;
  }
  static bool rests(const Bodies& bodies, const Proxy& proxy) {
    return proxy.body != kNoBody && proxy.rest.still > 0 && holds(bodies, proxy);
  }
  bool keeps(const Bodies& bodies, const PairKey& key, const NearPair& pair) const {
    return pair.remembers() && holds(bodies, proxies_[proxy_of_[key.a]]) && holds(bodies, proxies_[proxy_of_[key.b]]);
  }
  static bool reshaped(const Bodies& bodies, const Proxy& proxy);
  static bool displaced(const Bodies& bodies, const Proxy& proxy);
  void wake_met(const Bodies& bodies, const Proxy& proxy);
  void gather(const Bodies& bodies, const MechanicsClient& client);
  void find_drivers(const Bodies& bodies);
  void refresh(Bodies& bodies, const MechanicsClient& client, const Vector3& gravity, double h, Asking& asking);
  void enter(const Bodies& bodies, const MechanicsClient& client, BodyIndex body);
  void leave(ProxyIndex index);
  void update_boxes(const Bodies& bodies, bool all, const Vector3& gravity, double h, Asking& asking);
  static Vector3 room_of(const Bodies& bodies, const Proxy& proxy, double radius, const Vector3& gravity, double h);
  void update_box(const Bodies& bodies, Proxy& proxy, const Vector3& gravity, double h, Asking& asking);
  void mark_moved(ProxyIndex index);
  void seek(ProxyIndex index, Asking& asking);
  void seek(ProxyIndex index) {
    Asking none{kNoMost, 0, 0, nullptr, nullptr};
    seek(index, none);
  }
  PairKey* find_key(std::uint64_t serial_a, std::uint64_t serial_b);
  bool near(const PairKey& key) const;
  std::size_t weight(const PairKey& key) const;
  void release(PairKey& key);
  bool pass_on(const Bodies& bodies, double h);
  void widen(ProxyIndex index, double h);
  void merge();
  void drop_far();
  void reserve_near();
  void place_near();
  static void save_pair(ByteWriter& out, const NearPair& pair);
  static NearPair load_pair(ByteReader& in);
  void save_standing(ByteWriter& out, const Bodies& bodies) const;
  Proxy& known(BodyIndex body, std::uint64_t serial, const Bodies& bodies);
  void load_pairs(ByteReader& in, const Bodies& bodies, double unit);
  void load_rests(ByteReader& in, const Bodies& bodies);
  void load_standing(ByteReader& in, const Bodies& bodies);

  BoxTree tree_;
  std::pmr::vector<Proxy> proxies_;
  std::pmr::vector<Reach> reach_;  // of proxies
  std::pmr::vector<ProxyIndex> free_, proxy_of_;
  std::pmr::vector<BodyIndex> movers_, put_;
  std::pmr::vector<BodyIndex> drivers_;  // that move without forces
  std::pmr::vector<ProxyIndex> woken_;
  std::pmr::vector<ProxyIndex> struck_;
  std::pmr::vector<ProxyIndex> moved_;  // whose roomy boxes moved in the last update
  std::pmr::vector<PairKey> keys_, new_keys_;
  std::pmr::vector<NearPair> pairs_;  // in places that are used again
  std::pmr::vector<std::uint32_t> free_pairs_;
  std::pmr::vector<std::size_t> fresh_;
  std::pmr::vector<std::uint32_t> found_;
  std::uint64_t boxes_ = 0;
  std::size_t others_ = 0;
  const WorkBound* bound_ = nullptr;  // of the update that runs
  std::uint32_t polled_ = 0;
  std::uint64_t seen_rules_ = 0, seen_bodies_ = ~std::uint64_t{0}, seen_scalings_ = 0;
  // Memory ended in the last update: all is to be looked for again, and `wanted` to be asked of all.
  bool incomplete_ = false, unasked_ = false;
};

}  // namespace breve
