// Arrows for what pushes and moves bodies. They are found when somebody wants to see them, and not before.
#include <algorithm>
#include <cmath>

#include "runtime/world/show.hpp"
#include "steve/library/joints.hpp"
#include "steve/library/show.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

namespace {

const Vector4f kNormal(0.20F, 0.75F, 0.95F, 1), kContactForce(0.95F, 0.30F, 0.20F, 1),
    kSetForce(0.75F, 0.45F, 0.95F, 1), kSpringForce(1.00F, 0.65F, 0.15F, 1), kVelocity(0.25F, 0.80F, 0.40F, 1),
    kJoint(1.00F, 0.85F, 0.20F, 1);

class ArrowPainter {
 public:
  ArrowPainter(Machine& machine, const Arrows& arrows, SceneBuilder& to)
      : machine_(machine), world_(machine.world()), bodies_(world_.bodies()), arrows_(arrows), to_(to) {}
  void paint() {
    if (arrows_.contacts || arrows_.forces)
      for (const BodyIndex body : bodies_.rigid_bodies()) find_contacts(body);
    for (const ObjectId id : world_.objects()) {
      if (world_.has_body(id)) paint_body(world_.body(id));
      const Instance* object = machine_.instance(id);
      if (arrows_.forces)
        if (const auto* spring = resource_of<SpringResource>(machine_, object)) paint_spring(*spring);
      if (arrows_.joints && object && is_library_kind(*object, "Joint")) paint_joint(joint_of(machine_, *object));
    }
  }

 private:
  void arrow(const Vector3& from, const Vector3& way, const Vector4f& color) {
    if (way.allFinite() && !way.isZero(0))
      to_.scene().arrows.push_back({drawable(from), drawable(Vector3(from + way)), color});
  }
  double radius(BodyIndex body) const { return bodies_.collision_shape(body)->bounding_radius(); }
  /// The force that gives the body an acceleration of 10 m/s^2, which is about its weight, is as long as it is wide.
  void force(BodyIndex body, const Vector3& at, const Vector3& newtons, const Vector4f& color) {
    constexpr double kAcceleration = 10, kMost = 16;  // m/s^2; radii
    const double mass = bodies_.mass(body);
    if (!(mass > 0)) return;
    const Vector3 way = arrows_.scale * 2 * radius(body) / (kAcceleration * mass) * newtons;
    const double longest = kMost * radius(body) * std::max(1.0, arrows_.scale), length = way.norm();
    arrow(at, length > longest ? Vector3(way * (longest / length)) : way, color);
  }

  /// Those of each pair once. A gap that solvers leave where bodies rest counts as touching.
  void find_contacts(BodyIndex body) {
    constexpr double kGap = 1e-3;  // of the smaller radius
    Eigen::AlignedBox3d box = bodies_.bounds(body);
    if (!box.min().allFinite() || !box.max().allFinite()) return;
    const Vector3 slack = Vector3::Constant(kGap * radius(body));
    box.min() -= slack;
    box.max() += slack;
    const Queries::Scene scene = world_.scene();
    for (const BodyIndex other : world_.queries().boxes(scene, box)) {
      if (other == body || (other < body && bodies_.dynamic(other))) continue;
      if (!bodies_.filter(body).meets(bodies_.filter(other)) ||
          !world_.collides(bodies_.owner(body), bodies_.owner(other)))
        continue;
      Pose there = pose_of(bodies_, other);
      there.location += scene.space.image(bodies_.location(body), there.location);
      Contact contact;
      if (closest_within(*bodies_.collision_shape(body), pose_of(bodies_, body), *bodies_.collision_shape(other), there,
                         kGap * std::min(radius(body), radius(other)), contact))
        paint_contact(body, other, contact);
    }
  }

  void paint_contact(BodyIndex a, BodyIndex b, const Contact& contact) {
    if (arrows_.contacts)
      arrow(contact.point, arrows_.scale * std::min(radius(a), radius(b)) * contact.normal, kNormal);
    if (!arrows_.forces) return;
    force(a, contact.point, world_.mechanics().contact_force(a, b), kContactForce);
    force(b, contact.point, world_.mechanics().contact_force(b, a), kContactForce);
  }

  void paint_body(BodyIndex body) {
    if (arrows_.velocities) arrow(bodies_.location(body), arrows_.scale * bodies_.velocity(body), kVelocity);
    if (arrows_.forces) force(body, bodies_.location(body), bodies_.force(body), kSetForce);
  }

  void paint_spring(const SpringResource& resource) {
    const Mechanics& mechanics = world_.mechanics();
    if (resource.index == kNoSpring || !mechanics.has_spring(resource.index)) return;
    const SpringDescription& spring = mechanics.spring(resource.index);
    const Vector3 at_a = on_body(spring.a, spring.point_a), at_b = on_body(spring.b, spring.point_b);
    const Vector3 pull = mechanics.spring_force(resource.index) * (at_b - at_a).normalized();
    force(spring.a, at_a, pull, kSpringForce);
    force(spring.b, at_b, -pull, kSpringForce);
  }

  /// Along the first axis; a dot if the joint has no axis.
  void paint_joint(JointIndex index) {
    if (index == kNoJoint) return;
    const JointDescription& joint = world_.mechanics().joint(index);
    const Vector3 pivot = on_body(joint.child, joint.child_point);
    const Vector3 axis =
        joint.parent == kNoBody ? joint.normal : Vector3(bodies_.orientation(joint.parent) * joint.normal);
    const double length = axis_count(joint.kind) != 0 ? arrows_.scale * radius(joint.child) : 0;
    const Vector3 end = pivot + length * axis.normalized();
    if (end.allFinite()) to_.scene().arrows.push_back({drawable(pivot), drawable(end), kJoint});
  }

  Vector3 on_body(BodyIndex body, const Vector3& point) const {
    return bodies_.location(body) + bodies_.rotation(body) * point;
  }

  Machine& machine_;
  World& world_;
  const Bodies& bodies_;
  const Arrows& arrows_;
  SceneBuilder& to_;
};

}  // namespace

void show_arrows(Machine& machine, const Arrows& arrows, SceneBuilder& scene) {
  if (arrows.any()) ArrowPainter(machine, arrows, scene).paint();
}

}  // namespace breve::steve
