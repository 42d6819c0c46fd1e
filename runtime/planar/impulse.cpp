// Collisions: the impulse of two bodies, with all that joints connect them with, by the laws of runtime/contact; and
// how it spreads through bodies that touch, pair by pair, the fastest approach first.
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/contact/impact_law.hpp"
#include "runtime/planar/core.hpp"

namespace breve {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

Vector2 vector_of(const b2Vec2& v) { return {v.x, v.y}; }

/// How some bodies answer impulses on two of them: (force, force, torque about the centre of mass) of each, in Box2D's
/// units. Free bodies answer alone; what joints connect answers as a whole, M^-1 - M^-1 J^T (J M^-1 J^T)^-1 J M^-1.
class Response {
 public:
  Response(const Planar::Core& core, FlatBody& a, FlatBody& b) : core_(core), bodies_(core.memory) {
    gather(a);
    gather(b);
    const auto n = static_cast<Eigen::Index>(3 * bodies_.size());
    columns_ = Matrix::Zero(n, 6);
    for (const auto& [flat, column] : {std::pair{&a, 0}, std::pair{&b, 3}}) {
      const Eigen::Index at = place(*flat);
      if (at < 0) continue;
      columns_(at, column) = columns_(at + 1, column + 1) = 1 / double{flat->b2->GetMass()};
      columns_(at + 2, column + 2) = 1 / inertia(*flat);
    }
    hold_joints();
  }

  /// Of the velocity of a point of the first (which = 0) or second body, to an impulse on one of them.
  Vector2 at_point(const FlatBody& flat, const Vector2& arm, const Vector& answer) const {
    const Eigen::Index at = place(flat);
    if (at < 0) return Vector2::Zero();
    return Vector2(answer[at], answer[at + 1]) + answer[at + 2] * left_of(arm);
  }
  /// To the impulse P on the second body and -P on the first, each at its arm.
  Vector answer(const Vector2& arm_a, const Vector2& arm_b, const Vector2& impulse) const {
    Eigen::Matrix<double, 6, 1> load;
    load << -impulse, -cross(arm_a, impulse), impulse, cross(arm_b, impulse);
    return columns_ * load;
  }
  void give(const Vector& change) const {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(3 * i);
      b2Body& b = *bodies_[i]->b2;
      b.SetLinearVelocity(b.GetLinearVelocity() +
                          b2Vec2(static_cast<float>(change[at]), static_cast<float>(change[at + 1])));
      b.SetAngularVelocity(b.GetAngularVelocity() + static_cast<float>(change[at + 2]));
    }
  }
  double kinetic() const {
    double sum = 0;
    for (const FlatBody* flat : bodies_)
      sum += 0.5 * double{flat->b2->GetMass()} * vector_of(flat->b2->GetLinearVelocity()).squaredNorm() +
             0.5 * inertia(*flat) * std::pow(double{flat->b2->GetAngularVelocity()}, 2);
    return sum;
  }
  Eigen::Index size() const { return columns_.rows(); }

 private:
  static double inertia(const FlatBody& flat) {
    // Box2D gives it about the origin.
    return double{flat.b2->GetInertia()} - double{flat.b2->GetMass()} * flat.b2->GetLocalCenter().LengthSquared();
  }
  void gather(FlatBody& flat) {
    if (flat.fixed || place(flat) >= 0) return;
    if (!flat.jointed) {
      bodies_.push_back(&flat);
      return;
    }
    std::pmr::vector<BodyIndex> all(core_.memory);
    core_.collect(flat.body, all);
    for (const BodyIndex body : all)
      if (FlatBody* one = const_cast<Planar::Core&>(core_).find(body)) bodies_.push_back(one);
  }
  Eigen::Index place(const FlatBody& flat) const {
    const auto found = std::find(bodies_.begin(), bodies_.end(), &flat);
    return found == bodies_.end() ? -1 : static_cast<Eigen::Index>(3 * (found - bodies_.begin()));
  }

  void hold_joints() {
    std::pmr::vector<JointIndex> held(core_.memory);
    for (const FlatBody* flat : bodies_) {
      const auto found = core_.joints_at.find(flat->body);
      if (found != core_.joints_at.end()) held.insert(held.end(), found->second.begin(), found->second.end());
    }
    std::sort(held.begin(), held.end());
    held.erase(std::unique(held.begin(), held.end()), held.end());
    constexpr std::size_t kMost = 100;  // joints; larger assemblies answer as if none held, and Box2D's joints follow
    if (held.empty() || held.size() > kMost) return;
    Matrix jacobian = Matrix::Zero(static_cast<Eigen::Index>(3 * held.size()), size());
    Eigen::Index rows = 0;
    for (const JointIndex index : held) add_rows(core_.joints[index], jacobian, rows);
    jacobian.conservativeResize(rows, Eigen::NoChange);
    Vector mobility(size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(3 * i);
      mobility[at] = mobility[at + 1] = 1 / double{bodies_[i]->b2->GetMass()};
      mobility[at + 2] = 1 / inertia(*bodies_[i]);
    }
    const Matrix spread = mobility.asDiagonal() * jacobian.transpose();
    Matrix between = jacobian * spread;
    // Rings hold some things twice: a little softness keeps the matrix regular.
    constexpr double kSoft = 1e-12;
    between.diagonal().array() += kSoft * between.diagonal().maxCoeff();
    columns_ -= spread * between.ldlt().solve(jacobian * columns_);
  }
  void add_rows(const FlatJoint& joint, Matrix& jacobian, Eigen::Index& rows) const {
    const FlatBody* child = core_.find(joint.is.child);
    const FlatBody* parent = joint.is.parent == kNoBody ? nullptr : core_.find(joint.is.parent);
    const Vector2 point_a = vector_of(joint.b2->GetAnchorA()), point_b = vector_of(joint.b2->GetAnchorB());
    const auto point_row = [&](const Vector2& along) {
      for (const auto& [flat, point, sign] : {std::tuple{parent, point_a, -1.0}, std::tuple{child, point_b, 1.0}}) {
        const Eigen::Index at = flat ? place(*flat) : -1;
        if (at < 0) continue;
        const Vector2 arm = point - vector_of(flat->b2->GetWorldCenter());
        jacobian(rows, at) = sign * along.x();
        jacobian(rows, at + 1) = sign * along.y();
        jacobian(rows, at + 2) = sign * cross(arm, along);
      }
      ++rows;
    };
    const auto turn_row = [&] {
      for (const auto& [flat, sign] : {std::pair{parent, -1.0}, std::pair{child, 1.0}})
        if (const Eigen::Index at = flat ? place(*flat) : -1; at >= 0) jacobian(rows, at + 2) = sign;
      ++rows;
    };
    if (joint.is.kind == JointKind::Prismatic) {
      const Vector3 axis =
          (joint.is.parent == kNoBody ? Quaternion(1, 0, 0, 0) : core_.bodies->orientation(joint.is.parent)) *
          joint.is.normal;
      point_row(left_of(axis.head<2>()));
      turn_row();
      return;
    }
    point_row({1, 0});
    point_row({0, 1});
    if (joint.is.kind == JointKind::Fixed) turn_row();
  }

  const Planar::Core& core_;
  std::pmr::vector<FlatBody*> bodies_;
  Matrix columns_;
};

/// One point at which two bodies meet. The normal goes from a to b; impulses are those on b.
struct Point {
  Vector2 where, arm_a, arm_b, before, impulse = Vector2::Zero();
};

Vector2 speed_at(const FlatBody& flat, const Vector2& arm) {
  return vector_of(flat.b2->GetLinearVelocity()) + double{flat.b2->GetAngularVelocity()} * left_of(arm);
}

/// Newton's restitution and Coulomb's cone at two points, by sweeps over both.
void solve_two(const Response& response, FlatBody& a, FlatBody& b, std::array<Point, 2>& points, const Vector2& n,
               double mu, double e) {
  const Vector2 t = left_of(n);
  for (Point& p : points) p.impulse.setZero();
  Vector change = Vector::Zero(response.size());
  const auto relative = [&](const Point& p) {
    return Vector2(p.before + response.at_point(b, p.arm_b, change) - response.at_point(a, p.arm_a, change));
  };
  for (int sweep = 0; sweep < 60; ++sweep)
    for (Point& p : points)
      for (const Vector2& along : {n, t}) {
        const Vector unit = response.answer(p.arm_a, p.arm_b, along);
        const double gives = along.dot(response.at_point(b, p.arm_b, unit) - response.at_point(a, p.arm_a, unit));
        if (!(gives > 0)) continue;
        const bool normal = along == n;
        const double wanted = normal ? std::max(0.0, -e * n.dot(p.before)) : 0;
        const double had = along.dot(p.impulse);
        double next = had + (wanted - along.dot(relative(p))) / gives;
        const double bound = mu * std::max(0.0, n.dot(p.impulse));
        next = normal ? std::max(0.0, next) : std::clamp(next, -bound, bound);
        p.impulse += (next - had) * along;
        change += (next - had) * unit;
      }
}

double gain_of(const Response& response, FlatBody& a, FlatBody& b, const std::array<Point, 2>& points) {
  Vector change = Vector::Zero(response.size());
  for (const Point& p : points) change += response.answer(p.arm_a, p.arm_b, p.impulse);
  double gain = 0;
  for (const Point& p : points) {
    const Vector2 after = p.before + response.at_point(b, p.arm_b, change) - response.at_point(a, p.arm_a, change);
    gain += p.impulse.dot(p.before + after) / 2;
  }
  return gain;
}

}  // namespace

/// Approaches slower than this rest, m/s. What rests on something takes up the speed of a sub-step's fall.
double Planar::Core::slowest_bounce(const contact::Law& law) const {
  constexpr double kLeast = 1e-6;
  return std::max({law.restitution_threshold, settings.gravity.norm() * step_length, kLeast});
}

bool Planar::Core::collide(FlatBody& a, FlatBody& b, const b2WorldManifold& where, int count) {
  const Vector2 n = vector_of(where.normal).normalized();
  std::array<Point, 2> points;
  double fastest = 0;
  int used = 0;
  double deepest = where.separations[0];
  if (count == 2) deepest = std::min(deepest, double{where.separations[1]});
  for (int i = 0; i < count; ++i) {
    // A box that lands on its corner touches there alone.
    constexpr double kTogether = 0.25 * b2_linearSlop;
    if (where.separations[i] > deepest + kTogether) continue;
    Point p;
    p.where = vector_of(where.points[i]);
    p.arm_a = p.where - vector_of(a.b2->GetWorldCenter());
    p.arm_b = p.where - vector_of(b.b2->GetWorldCenter());
    p.before = speed_at(b, p.arm_b) - speed_at(a, p.arm_a);
    fastest = std::max(fastest, -n.dot(p.before));
    points[static_cast<std::size_t>(used++)] = p;
  }
  const contact::Law law = law_of(a, b);
  const double u = settings.unit;
  if (used == 0 || !(fastest * u > slowest_bounce(law))) return false;
  const Response response(*this, a, b);
  if (response.size() == 0) return false;
  const double before = response.kinetic();
  if (used == 1) {
    Point& p = points[0];
    Matrix3 W = Matrix3::Zero();
    for (int i = 0; i < 2; ++i) {
      const Vector unit = response.answer(p.arm_a, p.arm_b, i == 0 ? Vector2(1, 0) : Vector2(0, 1));
      W.col(i).head<2>() = response.at_point(b, p.arm_b, unit) - response.at_point(a, p.arm_a, unit);
    }
    p.impulse = contact::impact_impulse(W, {p.before.x(), p.before.y(), 0}, {n.x(), n.y(), 0}, law).head<2>();
  } else {
    bool gains = true;
    for (const double part : {1.0, 0.75, 0.5, 0.25, 0.0}) {
      if (!gains) break;
      solve_two(response, a, b, points, n, law.dynamic_friction, part * law.restitution);
      gains = gain_of(response, a, b, points) > 0;
    }
    // Sweeps over cones that are wide and coupled need not come to an end; without friction they do.
    if (gains) solve_two(response, a, b, points, n, 0, 0);
  }
  Vector change = Vector::Zero(response.size());
  Vector2 sum = Vector2::Zero(), middle = Vector2::Zero();
  for (int i = 0; i < used; ++i) {
    const Point& p = points[static_cast<std::size_t>(i)];
    change += response.answer(p.arm_a, p.arm_b, p.impulse);
    sum += p.impulse;
    middle += p.where / used;
  }
  if (sum == Vector2::Zero()) return false;
  response.give(change);
  if (!stepping) account.contact_loss += (before - response.kinetic()) * u * u;
  Impact impact;
  impact.a = bodies->owner(b.body);
  impact.b = bodies->owner(a.body);
  impact.time = now;
  impact.point = Vector3(middle.x(), middle.y(), 0) * u;
  impact.normal = {n.x(), n.y(), 0};
  impact.impulse = Vector3(sum.x(), sum.y(), 0) * u;
  impacts.push_back(impact);
  return true;
}

void Planar::Core::spread(FlatBody& a, FlatBody& b) {
  std::pmr::vector<b2Body*> struck({a.b2, b.b2}, memory);
  constexpr int kMost = 64;
  for (int i = 0; i < kMost; ++i) {
    b2Contact* fastest = nullptr;
    double speed = 0;
    for (const b2Body* body : struck) {
      if (of(body).fixed) continue;
      for (const b2ContactEdge* edge = body->GetContactList(); edge; edge = edge->next) {
        b2Contact* contact = edge->contact;
        if (!contact->IsTouching() || contact->GetManifold()->pointCount == 0) continue;
        refresh(contact);
        if (!(std::fmod(contact->GetRestitution(), 2.0F) > 0)) continue;
        b2WorldManifold where;
        contact->GetWorldManifold(&where);
        const FlatBody &x = of(contact->GetFixtureA()->GetBody()), &y = of(contact->GetFixtureB()->GetBody());
        const b2Vec2 v = y.b2->GetLinearVelocityFromWorldPoint(where.points[0]) -
                         x.b2->GetLinearVelocityFromWorldPoint(where.points[0]);
        const double approach = -double{b2Dot(v, where.normal)} * settings.unit;
        if (approach > std::max(speed, slowest_bounce(law_of(x, y)))) {
          speed = approach;
          fastest = contact;
        }
      }
    }
    if (!fastest) return;
    FlatBody &x = of(fastest->GetFixtureA()->GetBody()), &y = of(fastest->GetFixtureB()->GetBody());
    b2WorldManifold where;
    fastest->GetWorldManifold(&where);
    if (!collide(x, y, where, fastest->GetManifold()->pointCount)) return;
    for (b2Body* body : {x.b2, y.b2})
      if (std::find(struck.begin(), struck.end(), body) == struck.end()) struck.push_back(body);
  }
}

}  // namespace breve
