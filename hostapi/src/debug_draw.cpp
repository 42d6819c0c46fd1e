// Lines that show what the simulation does: read from the world when the host asks, and never gathered beforehand.
#include <cmath>
#include <numbers>

#include "physical.hpp"
#include "runtime/solid/polygons.hpp"

namespace breve::host {

namespace {

constexpr std::uint32_t kMostSegments = 256;

struct Color {
  double rgba[4];
};
constexpr Color kRed{{0.9, 0.2, 0.2, 1}}, kGreen{{0.2, 0.8, 0.2, 1}}, kBlue{{0.3, 0.4, 1, 1}}, kYellow{{1, 0.8, 0, 1}},
    kOrange{{1, 0.5, 0.1, 1}}, kCyan{{0, 0.8, 0.8, 1}}, kGray{{0.6, 0.6, 0.6, 1}}, kWhite{{1, 1, 1, 1}};

class DebugPainter {
 public:
  DebugPainter(const breve_world& world, const breve_debug_draw& draw)
      : handle_(world), world_(*world.world), bodies_(world_.bodies()), draw_(draw) {}
  void paint() {
    for (const ObjectId id : world_.objects()) {
      if (world_.has_body(id)) paint_body(id, world_.body(id));
      if (wants(BREVE_DEBUG_JOINTS) && draw_.line) paint_mechanism(id);
    }
    if (wants(BREVE_DEBUG_CONTACTS)) paint_contacts();
    if (wants(BREVE_DEBUG_IMPACTS)) paint_impacts();
  }

 private:
  bool wants(std::uint32_t part) const { return (draw_.parts & part) != 0; }
  void line(const Vector3& from, const Vector3& to, const Color& color) const {
    if (draw_.line) draw_.line(draw_.user, from.data(), to.data(), color.rgba);
  }
  void point(const Vector3& at, const Color& color) const {
    if (draw_.point) draw_.point(draw_.user, at.data(), color.rgba);
  }
  /// @param u, v  perpendicular, as long as the radius
  void circle(const Vector3& centre, const Vector3& u, const Vector3& v, const Color& color) const {
    Vector3 before = centre + u;
    for (std::uint32_t i = 1; i <= draw_.segments; ++i) {
      const double angle = 2 * std::numbers::pi * i / draw_.segments;
      const Vector3 next =
          i == draw_.segments ? Vector3(centre + u) : centre + std::cos(angle) * u + std::sin(angle) * v;
      line(before, next, color);
      before = next;
    }
  }

  void paint_body(ObjectId id, BodyIndex body) {
    const Vector3 at = bodies_.location(body);
    const Matrix3 axes = bodies_.orientation(body).toRotationMatrix();
    if (wants(BREVE_DEBUG_SHAPES) && draw_.line) paint_shape(body, at, axes);
    if (wants(BREVE_DEBUG_AXES) && draw_.line) {
      const double length = bodies_.display_shape(body)->bounding_radius();
      line(at, at + length * axes.col(0), kRed);
      line(at, at + length * axes.col(1), kGreen);
      line(at, at + length * axes.col(2), kBlue);
    }
    if (const Vector3& way = bodies_.velocity(body); wants(BREVE_DEBUG_VELOCITIES) && !way.isZero(0))
      line(at, at + way, kCyan);
    if (const double size = bodies_.neighborhood_size(body); wants(BREVE_DEBUG_NEIGHBORHOODS) && size > 0)
      paint_neighborhood(at, size);
    if (wants(BREVE_DEBUG_NAMES) && draw_.text) paint_name(id, body, at);
  }

  Color color_of(BodyIndex body) const {
    const Appearance& appearance = bodies_.appearance(body);
    const double dim = world_.mechanics().asleep(body) ? 0.5 : 1;
    return {{dim * appearance.color[0], dim * appearance.color[1], dim * appearance.color[2], 1}};
  }

  void paint_shape(BodyIndex body, const Vector3& at, const Matrix3& axes) {
    const Shape& shape = *bodies_.display_shape(body);
    const Color color = color_of(body);
    if (shape.kind() == ShapeKind::Sphere) {
      const Matrix3 scaled = shape.radius() * axes;
      circle(at, scaled.col(0), scaled.col(1), color);
      if (world_.dimension() == 3) {
        circle(at, scaled.col(1), scaled.col(2), color);
        circle(at, scaled.col(2), scaled.col(0), color);
      } else {
        line(at, at + scaled.col(0), color);  // shows the rotation of a disc
      }
      return;
    }
    points_.clear();
    edges_.clear();
    for_each_vertex(shape, [&](const Vector3& vertex) { points_.push_back(at + axes * vertex); });
    for_each_face(shape, [&](const int* face, std::size_t size) {
      for (std::size_t i = 0; i < size; ++i) edges_.push_back(std::minmax({face[i], face[(i + 1) % size]}));
    });
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    for (const auto& [from, to] : edges_)
      line(points_[static_cast<std::size_t>(from)], points_[static_cast<std::size_t>(to)], color);
  }

  void paint_neighborhood(const Vector3& at, double size) const {
    const Vector3 x = size * Vector3::UnitX(), y = size * Vector3::UnitY(), z = size * Vector3::UnitZ();
    circle(at, x, y, kGray);
    if (world_.dimension() == 3) circle(at, x, z, kGray);
  }

  void paint_name(ObjectId id, BodyIndex body, const Vector3& at) const {
    std::string text = handle_.program->cls(world_.class_of(id)).name;
    if (const std::string& label = bodies_.appearance(body).label; !label.empty()) text += ": " + label;
    draw_.text(draw_.user, at.data(), text.c_str(), kWhite.rgba);
  }

  void paint_mechanism(ObjectId id) {
    steve::Instance* const object = handle_.machine->instance(id);
    if (!object) return;
    if (steve::is_library_kind(*object, "Joint")) {
      const JointIndex joint = steve::joint_of(*handle_.machine, *object);
      if (joint != kNoJoint) paint_joint(world_.mechanics().joint(joint));
    } else if (steve::is_library_kind(*object, "Spring")) {
      const SpringIndex spring = steve::spring_of(*handle_.machine, *object);
      if (spring == kNoSpring) return;
      const SpringDescription& is = world_.mechanics().spring(spring);
      line(on_body(is.a, is.point_a), on_body(is.b, is.point_b), kOrange);
    }
  }

  Vector3 on_body(BodyIndex body, const Vector3& at) const {
    return body == kNoBody ? at : Vector3(bodies_.location(body) + bodies_.orientation(body) * at);
  }

  void paint_joint(const JointDescription& is) const {
    const Vector3 pivot = on_body(is.child, is.child_point);
    line(bodies_.location(is.child), pivot, kYellow);
    if (is.parent != kNoBody) line(bodies_.location(is.parent), on_body(is.parent, is.parent_point), kYellow);
    point(pivot, kYellow);
    if (axis_count(is.kind) == 0) return;
    const Vector3 axis = is.parent == kNoBody ? is.normal : Vector3(bodies_.orientation(is.parent) * is.normal);
    const double half = 0.5 * bodies_.display_shape(is.child)->bounding_radius();
    line(pivot - half * axis.normalized(), pivot + half * axis.normalized(), kBlue);
  }

  void paint_contacts() const {
    const Events* const events = world_.gathered();
    if (!events) return;
    for (const ContactEvent& contact : events->contacts) {
      if (contact.phase == ContactEvent::Phase::End) continue;
      point(contact.point, kRed);
      line(contact.point, contact.point + contact.normal, kRed);
    }
  }

  void paint_impacts() const {
    for (const Impact& impact : world_.mechanics().impacts()) {
      point(impact.point, kOrange);
      line(impact.point, impact.point + draw_.impulse_scale * impact.impulse, kOrange);
    }
  }

  const breve_world& handle_;
  const World& world_;
  const Bodies& bodies_;
  const breve_debug_draw& draw_;
  std::vector<Vector3> points_;
  std::vector<std::pair<int, int>> edges_;
};

}  // namespace
}  // namespace breve::host

using namespace breve::host;

breve_status breve_world_debug_draw(const breve_world* world, const breve_debug_draw* draw) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(draw, "draw");
    const auto given = read_config(draw, breve_debug_draw_default(), "breve_debug_draw");
    if ((given.parts & ~std::uint32_t{BREVE_DEBUG_ALL}) != 0)
      fail(BREVE_ERROR_ARGUMENT, "breve_debug_draw.parts has bits that are not a breve_debug");
    if (given.segments < 3 || given.segments > kMostSegments)
      fail(BREVE_ERROR_ARGUMENT, "breve_debug_draw.segments must be 3 to " + std::to_string(kMostSegments));
    if (!std::isfinite(given.impulse_scale)) fail(BREVE_ERROR_ARGUMENT, "breve_debug_draw.impulse_scale is not finite");
    DebugPainter(*world, given).paint();
  });
}
