// The stage of a sub-step that finds touching bodies and calls the handlers: first touches at their time of impact, in
// order of time, then once per sub-step while an overlap lasts. No physical response.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/kinematics/bodies.hpp"
#include "runtime/solid/contact.hpp"
#include "runtime/space/box_tree.hpp"
#include "runtime/space/extent.hpp"

namespace breve {

/// What the stage asks of the world around it.
class CollisionClient {
 public:
  virtual ~CollisionClient() = default;
  /// True if some handler names the class of this body's object.
  virtual bool takes_part(BodyIndex body) const = 0;
  /// True if contacts of these two are to be reported.
  virtual bool reported(BodyIndex a, BodyIndex b) const = 0;
  /// Position in the order of creation.
  virtual std::uint64_t serial(BodyIndex body) const = 0;
  /// `a` and `b` touch; `a` was created earlier. May change, free and create bodies; may throw.
  virtual void touched(BodyIndex a, BodyIndex b, const Contact& contact, double moment) = 0;
  /// So much work (units, see Meter) begins now. A function of the state of bodies alone, whatever was found before.
  /// Throws if there may not be so much, or if the host wants the end.
  virtual void work(std::uint64_t units) = 0;
  /// At least so much work is still to begin: throws as `work` would, and counts nothing.
  virtual void expect(std::uint64_t units) = 0;
};

class CollisionStage {
 public:
  CollisionStage(std::pmr::memory_resource* memory, Bodies& bodies);

  void rebind(Bodies& bodies) { bodies_ = &bodies; }  // the same bodies, at another address

  /// Before anything moves. `rules` grows when an answer of takes_part or reported may have changed. Bodies meet across
  /// edges of space that wrap, with that image of each other which is nearest.
  void begin(const CollisionClient& client, std::uint64_t rules, const Extent& space);
  /// After everything moved from time `start` to `start + h`.
  void finish(CollisionClient& client, double start, double h, const Vector3& gravity, bool at_impact);
  /// A sub-step was left by an exception: forget what belongs to it alone.
  void abandon();
  /// The body is going; at any time, also from within touched().
  void forget(BodyIndex body);

  struct Counters {
    std::uint64_t pairs = 0;     // pairs looked at
    std::uint64_t impacts = 0;   // first touches at their time of impact
    std::uint64_t reports = 0;   // all calls of touched()
    std::uint64_t held = 0;      // bodies held at their last impact of a sub-step
    std::uint64_t searches = 0;  // time-of-impact searches
    std::uint64_t facets = 0;    // of surfaces, visited
    std::uint64_t boxes = 0;     // of bodies, looked at
  };
  Counters take_counters();
  std::size_t bytes() const;

  // Which pairs touch is state; everything else is found again.
  void save(ByteWriter& out) const;
  void load(ByteReader& in);
  void hash(Hasher& hasher) const;

 private:
  using ProxyIndex = std::uint32_t;

  /// A straight piece of a body's path: rigid motion from `begin` to the end of the sub-step.
  struct Path {
    double begin = 0;  // s after the start of the sub-step
    double end = 0;
    BodyState from, to;
    Vector3 velocity, rotational_velocity;  // of the pose, world frame; constant on the piece
  };
  struct Proxy {
    BodyIndex body = kNoBody;  // kNoBody: gone
    std::uint64_t serial = 0;
    BoxTree::Leaf leaf = BoxTree::kNoLeaf;
    std::uint32_t path = kNoPath;  // of a moving body: index into paths_
    std::uint32_t version = 0;     // grows when the path changes: impacts found before are void
    std::uint32_t impacts = 0;     // in this sub-step
    bool mobile = false;
    Eigen::AlignedBox3d box;  // of the path, with the tolerance of touch; empty if it is not finite
  };
  struct Pair {
    ProxyIndex a = 0, b = 0;  // a was created earlier
    bool touching = false;    // at the end of the last sub-step, or since
    bool reported = false;    // touched() was called in this sub-step
    bool ask_at_end = false;  // no impact was found on the way: they may overlap all the same
  };
  struct Impact {
    double time = 0;  // s after the start of the sub-step
    ProxyIndex a = 0, b = 0;
    std::uint32_t version_a = 0, version_b = 0;
    Contact contact;
  };
  /// What a handler may depend on and what deliver_impact needs, fixed for one sub-step.
  struct Substep {
    CollisionClient& client;
    double start, h;
    const Vector3& gravity;
  };
  static constexpr std::uint32_t kNoPath = 0xffffffffU;
  static constexpr ProxyIndex kNoProxy = 0xffffffffU;
  static constexpr std::uint32_t kMostImpacts = 64;  // of one body in one sub-step; then it is held until the end
  // Units of work, measured.
  static constexpr std::uint64_t kWorkOfPath = 4;    // a body that moves: its box, and where that is in the tree
  static constexpr std::uint64_t kWorkOfPair = 4;    // two whose boxes meet: found, kept, and asked once
  static constexpr std::uint64_t kWorkOfImpact = 8;  // a search for a time of impact, its facets apart

  // participants.cpp: who takes part, where their boxes are, which pairs are near.
  void refresh(const CollisionClient& client, bool rules_changed);
  void purge();
  void enter(const CollisionClient& client, BodyIndex body);
  void enter_loaded(const CollisionClient& client);
  bool earlier(const Pair& x, const Pair& y) const;
  void find_near(const Eigen::AlignedBox3d& box);
  bool boxes_meet(const Pair& pair) const;
  Eigen::AlignedBox3d box_of_path(const Proxy& proxy) const;
  void update_boxes(CollisionClient& client);
  void update_box(ProxyIndex index);
  void find_new_pairs(CollisionClient& client);
  std::uint64_t find_pairs(const CollisionClient& client, ProxyIndex index);
  void merge_new_pairs();
  void drop_far_pairs();
  Pair* find_pair(ProxyIndex x, ProxyIndex y);

  // collision_stage.cpp: the order of events.
  bool later(const Impact& x, const Impact& y) const;
  void count_first_work(CollisionClient& client);
  void seek_first_impacts(const Substep& substep, bool at_impact);
  void seek_impact(const Substep& substep, Pair& pair, double from);
  void run_impacts(const Substep& substep);
  void deliver_impact(const Substep& substep, const Impact& impact);
  bool stays_on_path(ProxyIndex index, const BodyState& shown);
  void changed_by_others(const Substep& substep, ProxyIndex a, ProxyIndex b, double time);
  void restart(const Substep& substep, ProxyIndex index, double time);
  void report_lasting(const Substep& substep);

  // paths.cpp: where a body is at a time within the sub-step.
  void start_paths();
  void start_path(BodyIndex body);
  static void finish_path(Path& path);
  static BodyState state_at(const Path& path, double time);
  Motion motion_from(const Proxy& proxy, double time) const;
  Pose pose_now(const Proxy& proxy) const;
  Vector3 image_of_b(const Pair& pair) const;
  void place(BodyIndex body, const BodyState& state);
  bool touching(const Substep& substep, const Pair& pair, const Pose& pose_a, const Pose& pose_b, Contact& contact);

  Bodies* bodies_;
  BoxTree tree_;
  std::pmr::vector<Proxy> proxies_;
  std::pmr::vector<ProxyIndex> free_proxies_;
  std::pmr::vector<ProxyIndex> left_;      // gone, but pairs may still name them
  std::pmr::vector<ProxyIndex> proxy_of_;  // by body
  std::pmr::vector<ProxyIndex> order_;     // live proxies in order of creation
  std::pmr::vector<Path> paths_;
  std::pmr::vector<ProxyIndex> moved_, settling_;  // had a path or an impact, in this sub-step and in the last one
  std::pmr::vector<ProxyIndex> fresh_;             // have another box in the tree: their pairs are to be found
  std::pmr::vector<BodyIndex> put_;
  std::pmr::vector<BodyIndex> late_;  // put, but not known yet
  std::pmr::vector<Pair> pairs_;      // sorted by (serial of a, serial of b)
  std::pmr::vector<Pair> new_pairs_;
  std::pmr::vector<Impact> impacts_;  // binary heap, earliest first
  std::pmr::vector<BodyIndex> log_;
  std::pmr::vector<ProxyIndex> found_;
  std::pmr::vector<std::pair<BodyIndex, BodyIndex>> loaded_touching_;  // until the next begin()
  Extent space_;
  std::uint64_t seen_bodies_ = 0, seen_rules_ = 0, seen_scalings_ = 0;
  std::size_t live_ = 0;
  bool look_at_all_ = true;  // pairs must be searched for every proxy, moved or not
  Counters counters_;
};

}  // namespace breve
