// Questions about space, answered from a tree of boxes and then exactly.
#include "runtime/world/queries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "runtime/base/error.hpp"
#include "runtime/solid/probe.hpp"

namespace breve {

namespace {

/// @throws Error{Argument} unless it is finite, and in the plane of a flat world
void require_location(const Bodies& bodies, const Vector3& value, const char* what) {
  if (!value.allFinite()) throw Error(ErrorCode::Argument, std::string(what) + " must be finite");
  if (bodies.flat() && value.z() != 0)
    throw Error(ErrorCode::Argument, std::string(what) + " has a z of " + fmt::to_string(value.z()) +
                                         ", but this world is flat: z must be 0");
}

bool nearer(const QueryHit& x, const QueryHit& y) {
  return x.distance != y.distance ? x.distance < y.distance : x.serial < y.serial;
}

void count(const Queries::Scene& scene, std::uint64_t units) {
  if (scene.work != nullptr) scene.work(scene.world, units);
}

/// Units that a ray or a point against a shape costs, facets of surfaces apart.
std::uint64_t cost_of(const Shape& shape) {
  constexpr std::uint64_t kOfSurface = 16;
  constexpr std::size_t kVerticesPerUnit = 32;
  return shape.surface() != nullptr ? kOfSurface : 1 + shape.polyhedron().vertices.size() / kVerticesPerUnit;
}

/// The same of the distance between two.
std::uint64_t cost_of(const Shape& a, const Shape& b) {
  constexpr std::uint64_t kOfSearch = 4;
  if (a.kind() == ShapeKind::Sphere && b.kind() == ShapeKind::Sphere) return 1;
  return kOfSearch * (cost_of(a) + cost_of(b));
}

/// What the depth of two polyhedra costs beyond that: all edges of one against all of the other, or against those that
/// the Gauss map gives.
std::uint64_t cost_of_depth(const Shape& a, const Shape& b) {
  constexpr std::size_t kPairsPerUnit = 6, kOfCorner = 2;
  const std::size_t first = a.polyhedron().vertices.size(), second = b.polyhedron().vertices.size();
  return a.polyhedron().arcs.empty() ? first * second / kPairsPerUnit : kOfCorner * (first + second);
}

/// Up to where the tree is asked for what is no farther than `most`: round-off hides nothing that is as far.
double hair_beyond(double most) {
  constexpr double kHair = 1e-9;
  return most * (1 + kHair);
}

}  // namespace

Queries::Queries(std::pmr::memory_resource* memory)
    : tree_(memory), boxes_(memory), loose_(memory), put_(memory), found_(memory), near_(memory), hits_(memory) {}

// --- where everything is --------------------------------------------------------------------------------------------

/// Includes the centre, which need not be inside the shape. Empty if the position is not finite.
Eigen::AlignedBox3d Queries::box_of(const Bodies& bodies, BodyIndex body) const {
  Eigen::AlignedBox3d box;
  if (!bodies.used(body)) return box;
  box = bodies.bounds(body);
  box.extend(bodies.location(body));
  if (!box.min().allFinite() || !box.max().allFinite()) box.setEmpty();
  return box;
}

void Queries::rebuild(const Scene& scene) {
  boxes_.resize(scene.bodies.index_end());
  for (BodyIndex body = 0; body < boxes_.size(); ++body) boxes_[body] = box_of(scene.bodies, body);
  tree_.build(boxes_);
  loose_.clear();
}

/// What setters moved, and what is new.
void Queries::follow_put(const Scene& scene) {
  const auto loosen = [this](BodyIndex body) {
    const auto at = std::lower_bound(loose_.begin(), loose_.end(), body);
    if (at == loose_.end() || *at != body) loose_.insert(at, body);
  };
  if (boxes_.size() < scene.bodies.index_end()) boxes_.resize(scene.bodies.index_end());
  for (const BodyIndex body : put_) {
    boxes_[body] = box_of(scene.bodies, body);
    if (tree_.has(body))
      tree_.set(body, boxes_[body]);
    else
      loosen(body);
  }
}

void Queries::update(const Scene& scene) {
  narrow_ = {};
  narrow_.stop = scene.ended;
  hits_.clear();
  put_.clear();
  scene.bodies.take_put(Follower::Queries, put_);
  const bool shapes = scene.bodies.shape_changes() != seen_shapes_;
  // Before there are bodies nobody notes where they are put. If memory ends on the way, all is found again.
  const bool followed = std::exchange(followed_, scene.bodies.index_end() != 0);
  if (!std::exchange(built_, false) || !followed || shapes) {
    rebuild(scene);
  } else {
    if (scene.moved != seen_moved_) {
      // Nobody notes what a step moves: all are looked at, and the tree is kept while it is a good one.
      constexpr double kTooWide = 2;
      boxes_.resize(scene.bodies.index_end());
      bool same = true;
      for (BodyIndex body = 0; body < boxes_.size(); ++body) {
        boxes_[body] = box_of(scene.bodies, body);
        same = same && boxes_[body].isEmpty() != tree_.has(body);
      }
      same = same && loose_.empty() && boxes_.size() == tree_.size();
      if (same) tree_.refit(boxes_);
      if (!same || tree_.spread() > kTooWide) tree_.build(boxes_), loose_.clear();
    } else {
      follow_put(scene);
    }
    const double most = 32 + 2 * std::sqrt(static_cast<double>(boxes_.size()));
    if (static_cast<double>(loose_.size()) > most) rebuild(scene);
  }
  built_ = true;
  seen_shapes_ = scene.bodies.shape_changes();
  seen_moved_ = scene.moved;
}

std::size_t Queries::bytes() const {
  return tree_.bytes() + boxes_.capacity() * sizeof(Eigen::AlignedBox3d) + hits_.capacity() * sizeof(QueryHit) +
         near_.capacity() * sizeof(Near) +
         (loose_.capacity() + put_.capacity() + found_.capacity()) * sizeof(BodyIndex);
}

/// Is the question about this body, which is near? Counts one unit.
bool Queries::looks_at(const Scene& scene, BodyIndex body, const QueryFilter& filter) const {
  count(scene, 1);
  if (narrow_.stopped()) return false;
  if (!scene.bodies.used(body)) return false;
  const ObjectId owner = scene.bodies.owner(body);
  if (owner == filter.except) return false;
  const CollisionFilter& own = scene.bodies.filter(body);
  if ((own.category & filter.mask) == 0 || (own.sensor && !filter.sensors)) return false;
  return filter.wants == nullptr || filter.wants(filter.context, owner);
}

void Queries::keep(const Scene& scene, BodyIndex body, const Contact& found) {
  hits_.push_back(
      {scene.bodies.owner(body), found.point, found.normal, found.distance, scene.serial(scene.world, body)});
}

/// What the search for facets of the last body cost.
void Queries::count_facets(const Scene& scene) {
  constexpr std::uint64_t kOfFacet = 4, kBoxesPerUnit = 8;
  if (narrow_.facets == 0 && narrow_.boxes == 0) return;
  count(scene, kOfFacet * std::exchange(narrow_.facets, 0) + std::exchange(narrow_.boxes, 0) / kBoxesPerUnit);
}

void Queries::put_in_order() { std::sort(hits_.begin(), hits_.end(), nearer); }

// --- bodies on the way ----------------------------------------------------------------------------------------------
// In which order the tree gives them, and so how many are asked before `bound` is low, depends on what happened before.
// The cost of a question must depend neither on that nor on whether the world was restored: where it is counted, all
// bodies that are near are gathered first, and asked from the nearest box on.

void Queries::gather(const Scene& scene, BodyIndex body, double entry) {
  constexpr double kInside = 0;  // where numbers overflow
  near_.push_back({std::isnan(entry) ? kInside : entry, scene.serial(scene.world, body), body});
}

template <class Ask>
void Queries::ask_gathered(const Scene& scene, const double& bound, Ask&& ask) {
  count(scene, near_.size());
  std::sort(near_.begin(), near_.end(),
            [](const Near& x, const Near& y) { return x.entry != y.entry ? x.entry < y.entry : x.serial < y.serial; });
  for (const Near& one : near_) {
    if (one.entry > bound) return;
    ask(one.body);
  }
}

/// Calls ask(body) for those whose boxes, grown, meet start + t way for a t in [0, bound], which it may lower.
template <class Ask>
void Queries::along(const Scene& scene, const Vector3& start, const Vector3& way, const Vector3& grow,
                    const double& bound, Ask&& ask) {
  const double whole = bound;
  const Vector3 inverse = way.cwiseInverse();
  const auto entry = [&](BodyIndex body) { return BoxIndex::entry(boxes_[body], start, inverse, grow, whole); };
  const auto visit_loose = [&](auto&& visit) {
    for (const BodyIndex body : loose_)
      if (!boxes_[body].isEmpty() && entry(body) != std::numeric_limits<double>::infinity()) visit(body);
  };
  if (scene.work == nullptr) {
    tree_.along(start, way, grow, bound, ask);
    visit_loose(ask);
    return;
  }
  near_.clear();
  const auto keep_near = [&](BodyIndex body) { gather(scene, body, entry(body)); };
  tree_.along(start, way, grow, whole, keep_near);
  visit_loose(keep_near);
  ask_gathered(scene, bound, ask);
}

/// The same for those whose boxes are not farther from the point than `bound`.
template <class Ask>
void Queries::around(const Scene& scene, const Vector3& point, const double& bound, Ask&& ask) {
  const double whole = bound;
  const auto visit_loose = [&](auto&& visit) {
    for (const BodyIndex body : loose_)
      if (!boxes_[body].isEmpty() && boxes_[body].exteriorDistance(point) <= whole) visit(body);
  };
  if (scene.work == nullptr) {
    tree_.around(point, bound, ask);
    visit_loose(ask);
    return;
  }
  near_.clear();
  const auto keep_near = [&](BodyIndex body) { gather(scene, body, boxes_[body].exteriorDistance(point)); };
  tree_.around(point, whole, keep_near);
  visit_loose(keep_near);
  ask_gathered(scene, bound, ask);
}

// --- rays -----------------------------------------------------------------------------------------------------------

bool Queries::ray_first(const Scene& scene, const Vector3& start, const Vector3& way, const QueryFilter& filter,
                        QueryHit& hit) {
  require_location(scene.bodies, start, "the start of a ray");
  require_location(scene.bodies, way, "the way of a ray");
  update(scene);
  const double length = way.stableNorm();
  double most = 1, bound = hair_beyond(most);
  QueryHit best;
  bool found = false;
  const auto ask = [&](BodyIndex body) {
    if (!looks_at(scene, body, filter)) return;
    const Shape& solid = *scene.bodies.collision_shape(body);
    count(scene, cost_of(solid));
    RayHit here;
    if (!meet_ray(solid, pose_of(scene.bodies, body), start, way, most, here)) return;
    const QueryHit next{scene.bodies.owner(body), here.point, here.normal, here.fraction * length,
                        scene.serial(scene.world, body)};
    if (found && !nearer(next, best)) return;
    best = next;
    most = here.fraction;
    bound = hair_beyond(most);
    found = true;
  };
  along(scene, start, way, Vector3::Zero(), bound, ask);
  if (found) hit = best;
  return found;
}

const std::pmr::vector<QueryHit>& Queries::ray_all(const Scene& scene, const Vector3& start, const Vector3& way,
                                                   const QueryFilter& filter) {
  require_location(scene.bodies, start, "the start of a ray");
  require_location(scene.bodies, way, "the way of a ray");
  update(scene);
  const double length = way.stableNorm();
  const auto ask = [&](BodyIndex body) {
    if (!looks_at(scene, body, filter)) return;
    const Shape& solid = *scene.bodies.collision_shape(body);
    count(scene, cost_of(solid));
    RayHit here;
    if (meet_ray(solid, pose_of(scene.bodies, body), start, way, 1, here))
      keep(scene, body, {here.point, here.normal, here.fraction * length});
  };
  const double bound = hair_beyond(1);
  along(scene, start, way, Vector3::Zero(), bound, ask);
  put_in_order();
  return hits_;
}

// --- overlaps -------------------------------------------------------------------------------------------------------

/// Calls visit(body) for each body of which an image meets the box, once.
template <class Visit>
void Queries::images(const Scene& scene, const Eigen::AlignedBox3d& box, Visit&& visit) {
  found_.clear();
  const auto find = [&](const Eigen::AlignedBox3d& here) {
    tree_.meeting(here, [this](BodyIndex body) { found_.push_back(body); });
    for (const BodyIndex body : loose_)
      if (boxes_[body].intersects(here)) found_.push_back(body);
  };
  if (!scene.space.wraps()) {
    find(box);
  } else {
    // A body at the other end of space has an image a whole length away.
    std::array<std::array<double, 3>, 3> shifts{};
    for (int axis = 0; axis < 3; ++axis) {
      const Extent::Axis& one = scene.space.axis(axis);
      const double length = one.edge == Ending::Wrap ? one.high - one.low : 0;
      shifts[static_cast<std::size_t>(axis)] = {0, -length, length};
    }
    for (const double x : shifts[0])
      for (const double y : shifts[1])
        for (const double z : shifts[2]) find(Eigen::AlignedBox3d(box).translate(Vector3(x, y, z)));
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  }
  constexpr std::uint64_t kOfImages = 8;  // of a space that wraps
  count(scene, scene.space.wraps() ? kOfImages : 1);
  for (const BodyIndex body : found_) visit(body);
}

const std::pmr::vector<QueryHit>& Queries::overlap(const Scene& scene, const Shape& shape, const Pose& pose,
                                                   const QueryFilter& filter) {
  require_location(scene.bodies, pose.location, "the place of a volume");
  update(scene);
  Eigen::AlignedBox3d box = shape.bounds(pose.orientation.toRotationMatrix());
  box.translate(pose.location);
  images(scene, box, [&](BodyIndex body) {
    if (!looks_at(scene, body, filter)) return;
    const Shape& solid = *scene.bodies.collision_shape(body);
    count(scene, cost_of(shape, solid));
    Pose other = pose_of(scene.bodies, body);
    const Vector3 image = scene.space.image(pose.location, other.location);
    other.location += image;
    Contact found;
    const bool meets = closest_within(shape, pose, solid, other, 0, found, &narrow_);
    count_facets(scene);
    if (!meets) return;
    count(scene, cost_of_depth(shape, solid));
    // The point of the body, and not the one midway.
    found.point -= found.normal * (found.distance / 2) + image;
    keep(scene, body, found);
  });
  put_in_order();
  return hits_;
}

bool Queries::cast_first(const Scene& scene, const Shape& shape, const Pose& pose, const Vector3& way,
                         const QueryFilter& filter, QueryHit& hit) {
  require_location(scene.bodies, pose.location, "the place of a volume");
  require_location(scene.bodies, way, "the way of a volume");
  update(scene);
  const Eigen::AlignedBox3d own = shape.bounds(pose.orientation.toRotationMatrix());
  const Vector3 middle = pose.location + own.center(), grow = own.sizes() / 2;
  const double length = way.stableNorm();
  double bound = hair_beyond(1);
  QueryHit best;
  bool found = false;
  const auto ask = [&](BodyIndex body) {
    if (!looks_at(scene, body, filter)) return;
    const Shape& solid = *scene.bodies.collision_shape(body);
    constexpr std::uint64_t kDistances = 4;  // of a search for the time
    count(scene, kDistances * cost_of(shape, solid));
    const Pose at = pose_of(scene.bodies, body);
    Contact contact;
    double t = 0;
    bool meets = closest_within(shape, pose, solid, at, touch_tolerance(shape, pose, solid, at), contact, &narrow_);
    // With the whole way, so that the time of one body does not depend on who was asked before.
    if (!meets && length > 0)
      meets = time_of_impact(shape, {pose, way, Vector3::Zero()}, solid, {at, Vector3::Zero(), Vector3::Zero()}, 1, t,
                             contact, &narrow_);
    count_facets(scene);
    if (!meets) return;
    count(scene, cost_of_depth(shape, solid));
    const QueryHit next{scene.bodies.owner(body), contact.point, contact.normal, t * length,
                        scene.serial(scene.world, body)};
    if (found && !nearer(next, best)) return;
    best = next;
    bound = hair_beyond(t);
    found = true;
  };
  along(scene, middle, way, grow, bound, ask);
  if (found) hit = best;
  return found;
}

// --- points ---------------------------------------------------------------------------------------------------------

bool Queries::nearest(const Scene& scene, const Vector3& point, double limit, const QueryFilter& filter,
                      QueryHit& hit) {
  require_location(scene.bodies, point, "the point");
  update(scene);
  if (!(limit >= 0)) throw Error(ErrorCode::Argument, "the limit of a distance must be >= 0");
  double most = limit, bound = hair_beyond(most);
  QueryHit best;
  bool found = false;
  const auto ask = [&](BodyIndex body) {
    if (!looks_at(scene, body, filter)) return;
    Pose pose = pose_of(scene.bodies, body);
    const Vector3 image = scene.space.image(point, pose.location);
    pose.location += image;
    const Shape& solid = *scene.bodies.collision_shape(body);
    count(scene, cost_of(solid));
    Contact here;
    const bool near = nearest_to(solid, pose, point, most, here, &narrow_);
    count_facets(scene);
    if (!near) return;
    const QueryHit next{scene.bodies.owner(body), here.point - image, here.normal, here.distance,
                        scene.serial(scene.world, body)};
    if (found && !nearer(next, best)) return;
    best = next;
    most = std::max(0.0, here.distance);  // others may be deeper
    bound = hair_beyond(most);
    found = true;
  };
  if (scene.space.wraps()) {
    Eigen::AlignedBox3d box(point - Vector3::Constant(limit), point + Vector3::Constant(limit));
    images(scene, box, ask);
  } else {
    around(scene, point, bound, ask);
  }
  if (found) hit = best;
  return found;
}

const std::pmr::vector<QueryHit>& Queries::near(const Scene& scene, const Vector3& point, double radius,
                                                const QueryFilter& filter) {
  require_location(scene.bodies, point, "the point");
  if (!(radius >= 0)) throw Error(ErrorCode::Argument, "a radius must be >= 0");
  update(scene);
  const Eigen::AlignedBox3d box(point - Vector3::Constant(radius), point + Vector3::Constant(radius));
  images(scene, box, [&](BodyIndex body) {
    if (!looks_at(scene, body, filter)) return;
    const Vector3 way = scene.space.offset(point, scene.bodies.location(body));
    const double distance = way.stableNorm();
    if (!(distance < radius)) return;
    const Vector3 normal = distance > 0 ? Vector3(-way / distance) : Vector3(Vector3::UnitY());
    keep(scene, body, {scene.bodies.location(body), normal, distance});
  });
  put_in_order();
  return hits_;
}

const std::pmr::vector<BodyIndex>& Queries::boxes(const Scene& scene, const Eigen::AlignedBox3d& box) {
  update(scene);
  found_.clear();
  tree_.meeting(box, [this](BodyIndex body) { found_.push_back(body); });
  for (const BodyIndex body : loose_)
    if (boxes_[body].intersects(box)) found_.push_back(body);
  count(scene, found_.size());
  std::erase_if(found_, [&](BodyIndex body) { return !scene.bodies.used(body); });
  std::sort(found_.begin(), found_.end(),
            [&](BodyIndex x, BodyIndex y) { return scene.serial(scene.world, x) < scene.serial(scene.world, y); });
  return found_;
}

bool Queries::meet(const Scene& scene, BodyIndex a, BodyIndex b) {
  const Shape &first = *scene.bodies.collision_shape(a), &second = *scene.bodies.collision_shape(b);
  count(scene, cost_of(first, second));
  Contact contact;
  const bool meets =
      closest_within(first, pose_of(scene.bodies, a), second, pose_of(scene.bodies, b), 0, contact, &narrow_);
  count_facets(scene);
  if (meets) count(scene, cost_of_depth(first, second));
  return meets;
}

}  // namespace breve
