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

/// Up to where the tree is asked for what is no farther than `most`: round-off hides nothing that is as far.
double hair_beyond(double most) {
  constexpr double kHair = 1e-9;
  return most * (1 + kHair);
}

}  // namespace

Queries::Queries(std::pmr::memory_resource* memory)
    : tree_(memory), boxes_(memory), loose_(memory), put_(memory), found_(memory), hits_(memory) {}

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
  looked_at_ = 0;
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
         (loose_.capacity() + put_.capacity() + found_.capacity()) * sizeof(BodyIndex);
}

bool Queries::wanted(const Scene& scene, BodyIndex body, const QueryFilter& filter) const {
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

void Queries::put_in_order() { std::sort(hits_.begin(), hits_.end(), nearer); }

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
    if (!wanted(scene, body, filter)) return;
    ++looked_at_;
    RayHit here;
    if (!meet_ray(*scene.bodies.collision_shape(body), pose_of(scene.bodies, body), start, way, most, here)) return;
    const QueryHit next{scene.bodies.owner(body), here.point, here.normal, here.fraction * length,
                        scene.serial(scene.world, body)};
    if (found && !nearer(next, best)) return;
    best = next;
    most = here.fraction;
    bound = hair_beyond(most);
    found = true;
  };
  tree_.along(start, way, Vector3::Zero(), bound, ask);
  std::for_each(loose_.begin(), loose_.end(), ask);
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
    if (!wanted(scene, body, filter)) return;
    ++looked_at_;
    RayHit here;
    if (meet_ray(*scene.bodies.collision_shape(body), pose_of(scene.bodies, body), start, way, 1, here))
      keep(scene, body, {here.point, here.normal, here.fraction * length});
  };
  const double bound = hair_beyond(1);
  tree_.along(start, way, Vector3::Zero(), bound, ask);
  std::for_each(loose_.begin(), loose_.end(), ask);
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
  found_.insert(found_.end(), loose_.begin(), loose_.end());
  for (const BodyIndex body : found_) visit(body);
}

const std::pmr::vector<QueryHit>& Queries::overlap(const Scene& scene, const Shape& shape, const Pose& pose,
                                                   const QueryFilter& filter) {
  require_location(scene.bodies, pose.location, "the place of a volume");
  update(scene);
  Eigen::AlignedBox3d box = shape.bounds(pose.orientation.toRotationMatrix());
  box.translate(pose.location);
  images(scene, box, [&](BodyIndex body) {
    if (!wanted(scene, body, filter)) return;
    ++looked_at_;
    Pose other = pose_of(scene.bodies, body);
    const Vector3 image = scene.space.image(pose.location, other.location);
    other.location += image;
    Contact found;
    if (!closest_within(shape, pose, *scene.bodies.collision_shape(body), other, 0, found)) return;
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
    if (!wanted(scene, body, filter)) return;
    ++looked_at_;
    const Shape& solid = *scene.bodies.collision_shape(body);
    const Pose at = pose_of(scene.bodies, body);
    Contact contact;
    double t = 0;
    if (!closest_within(shape, pose, solid, at, touch_tolerance(shape, pose, solid, at), contact)) {
      // With the whole way, so that the time of one body does not depend on who was asked before.
      if (length == 0 || !time_of_impact(shape, {pose, way, Vector3::Zero()}, solid,
                                         {at, Vector3::Zero(), Vector3::Zero()}, 1, t, contact))
        return;
    }
    const QueryHit next{scene.bodies.owner(body), contact.point, contact.normal, t * length,
                        scene.serial(scene.world, body)};
    if (found && !nearer(next, best)) return;
    best = next;
    bound = hair_beyond(t);
    found = true;
  };
  tree_.along(middle, way, grow, bound, ask);
  std::for_each(loose_.begin(), loose_.end(), ask);
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
    if (!wanted(scene, body, filter)) return;
    ++looked_at_;
    Pose pose = pose_of(scene.bodies, body);
    const Vector3 image = scene.space.image(point, pose.location);
    pose.location += image;
    Contact here;
    if (!nearest_to(*scene.bodies.collision_shape(body), pose, point, most, here)) return;
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
    tree_.around(point, bound, ask);
    std::for_each(loose_.begin(), loose_.end(), ask);
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
    if (!wanted(scene, body, filter)) return;
    ++looked_at_;
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
  std::erase_if(found_, [&](BodyIndex body) { return !scene.bodies.used(body); });
  std::sort(found_.begin(), found_.end(),
            [&](BodyIndex x, BodyIndex y) { return scene.serial(scene.world, x) < scene.serial(scene.world, y); });
  return found_;
}

}  // namespace breve
