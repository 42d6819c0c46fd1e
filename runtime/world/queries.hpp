// Questions about where things are: rays, overlaps, shapes that are swept, nearest points, all bodies near a place.
// Answers are exact, about this moment, and in an order that nothing hidden decides: by distance, then by creation.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/kinematics/bodies.hpp"
#include "runtime/solid/contact.hpp"
#include "runtime/space/box_index.hpp"
#include "runtime/space/extent.hpp"

namespace breve {

inline Pose pose_of(const Bodies& bodies, BodyIndex body) { return {bodies.location(body), bodies.orientation(body)}; }

/// Which bodies a question is about.
struct QueryFilter {
  std::uint32_t mask = 0xffffffffU;  // those whose category has one of these bits
  ObjectId except;                   // not this one; null: nobody is left out
  bool sensors = true;               // also sensors
  /// If not null: those of objects for which this is true.
  bool (*wants)(const void* context, ObjectId object) = nullptr;
  const void* context = nullptr;
};

struct QueryHit {
  ObjectId object;
  Vector3 point = Vector3::Zero();   // on the surface of the object, world frame
  Vector3 normal = Vector3::Zero();  // unit, away from the object
  double distance = 0;               // m, as the question says
  std::uint64_t serial = 0;          // position in the order of creation
};

/// Where bodies are, kept as a tree of boxes from the first question on. Each question first brings it up to date.
class Queries {
 public:
  explicit Queries(std::pmr::memory_resource* memory);

  /// What the questions are about: the world as it is now.
  struct Scene {
    Bodies& bodies;
    const Extent& space;
    std::uint64_t moved;  // grows whenever a stage of the step may have moved bodies
    std::uint64_t (*serial)(const void* world, BodyIndex body);
    const void* world;
    /// Told what the question costs as it is answered, in units of some 200 ns, see CostMeter: as much for every world
    /// in this state. Null: nobody counts, which is faster.
    void (*work)(const void* world, std::uint64_t units) = nullptr;
    const std::atomic<bool>* ended = nullptr;  // true: the answer is not wanted any more, and may be wrong
  };

  // Numbers must be finite: @throws Error{Argument}. In a flat world places, ways and axes are in the plane.
  /// Bodies on start + t way, t in [0, 1]; `distance` from the start. A ray that starts inside a body hits it there. It
  /// goes straight on: not across edges of space that wrap.
  bool ray_first(const Scene& scene, const Vector3& start, const Vector3& way, const QueryFilter& filter,
                 QueryHit& hit);
  const std::pmr::vector<QueryHit>& ray_all(const Scene& scene, const Vector3& start, const Vector3& way,
                                            const QueryFilter& filter);
  /// Bodies that a solid meets, touching counts; `distance` <= 0 is the depth. Across edges of space that wrap, each
  /// with that image which is nearest to the solid's centre.
  const std::pmr::vector<QueryHit>& overlap(const Scene& scene, const Shape& shape, const Pose& pose,
                                            const QueryFilter& filter);
  /// The body that a solid meets first when it is moved by `way` without rotation; `distance` is how far it comes. One
  /// that it meets to begin with: 0.
  bool cast_first(const Scene& scene, const Shape& shape, const Pose& pose, const Vector3& way,
                  const QueryFilter& filter, QueryHit& hit);
  /// The body whose surface is nearest to a point, at most `limit` from it; `distance` < 0 if the point is inside. Of
  /// bodies around the point the one that it is deepest in. Across edges that wrap.
  bool nearest(const Scene& scene, const Vector3& point, double limit, const QueryFilter& filter, QueryHit& hit);
  /// Bodies whose centres are strictly nearer to a point than `radius`; `distance` between them, `point` the centre.
  const std::pmr::vector<QueryHit>& near(const Scene& scene, const Vector3& point, double radius,
                                         const QueryFilter& filter);
  /// Bodies whose boxes meet a box, in the order of creation. Not across edges that wrap.
  const std::pmr::vector<BodyIndex>& boxes(const Scene& scene, const Eigen::AlignedBox3d& box);
  /// Do the shapes of two bodies meet, touching counts? Not across edges that wrap.
  bool meet(const Scene& scene, BodyIndex a, BodyIndex b);

  std::size_t bytes() const;

 private:
  void update(const Scene& scene);
  void rebuild(const Scene& scene);
  void follow_put(const Scene& scene);
  Eigen::AlignedBox3d box_of(const Bodies& bodies, BodyIndex body) const;
  template <class Visit>
  void images(const Scene& scene, const Eigen::AlignedBox3d& box, Visit&& visit);
  bool looks_at(const Scene& scene, BodyIndex body, const QueryFilter& filter) const;
  void count_facets(const Scene& scene);
  /// A body whose box is on the way, or near a point.
  struct Near {
    double entry;  // of the way, or m
    std::uint64_t serial;
    BodyIndex body;
  };
  void gather(const Scene& scene, BodyIndex body, double entry);
  template <class Ask>
  void ask_gathered(const Scene& scene, const double& bound, Ask&& ask);
  template <class Ask>
  void along(const Scene& scene, const Vector3& start, const Vector3& way, const Vector3& grow, const double& bound,
             Ask&& ask);
  template <class Ask>
  void around(const Scene& scene, const Vector3& point, const double& bound, Ask&& ask);
  void keep(const Scene& scene, BodyIndex body, const Contact& found);
  void put_in_order();

  BoxIndex tree_;
  std::pmr::vector<Eigen::AlignedBox3d> boxes_;  // by body
  std::pmr::vector<BodyIndex> loose_;            // came after the tree was built
  std::pmr::vector<BodyIndex> put_, found_;
  std::pmr::vector<Near> near_;
  std::pmr::vector<QueryHit> hits_;
  std::uint64_t seen_moved_ = 0, seen_shapes_ = 0;
  NarrowCounters narrow_;  // of the question that is being answered
  bool built_ = false;
  bool followed_ = false;  // what setters move is noted
};

}  // namespace breve
