// How bodies that joints connect answer impulses.
#include "runtime/planar/response.hpp"

#include <algorithm>
#include <cmath>

namespace breve {

Response::Response(const Planar::Core& core, FlatBody* a, FlatBody* b)
    : core_(core), bodies_(core.memory), held_(core.memory) {
  if (a) gather(*a);
  if (b) gather(*b);
  mobility_.resize(size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    mobility_[at] = mobility_[at + 1] = 1 / double{bodies_[i]->b2->GetMass()};
    mobility_[at + 2] = 1 / inertia(*bodies_[i]);
  }
  hold_joints();
  columns_ = Matrix::Zero(size(), 6);
  for (const auto& [flat, column] : {std::pair{a, 0}, std::pair{b, 3}}) {
    const Eigen::Index at = flat ? index_of(*flat) : -1;
    if (at < 0) continue;
    for (int i = 0; i < 3; ++i) columns_(at + i, column + i) = mobility_[at + i];
  }
  if (jacobian_.rows() > 0) columns_ -= spread_ * between_.solve(jacobian_ * columns_);
}

double Response::inertia(const FlatBody& flat) {
  // Box2D gives it about the origin.
  return double{flat.b2->GetInertia()} - double{flat.b2->GetMass()} * flat.b2->GetLocalCenter().LengthSquared();
}

void Response::gather(FlatBody& flat) {
  if (flat.fixed || index_of(flat) >= 0) return;
  if (!flat.jointed) {
    bodies_.push_back(&flat);
    return;
  }
  std::pmr::vector<BodyIndex> all(core_.memory);
  core_.collect(flat.body, all);
  for (const BodyIndex body : all)
    if (FlatBody* one = const_cast<Planar::Core&>(core_).find(body)) bodies_.push_back(one);
}

Eigen::Index Response::index_of(const FlatBody& flat) const {
  const auto found = std::find(bodies_.begin(), bodies_.end(), &flat);
  return found == bodies_.end() ? -1 : static_cast<Eigen::Index>(3 * (found - bodies_.begin()));
}

void Response::hold_joints() {
  for (const FlatBody* flat : bodies_) {
    const auto found = core_.joints_at.find(flat->body);
    if (found != core_.joints_at.end()) held_.insert(held_.end(), found->second.begin(), found->second.end());
  }
  std::sort(held_.begin(), held_.end());
  held_.erase(std::unique(held_.begin(), held_.end()), held_.end());
  constexpr std::size_t kMost = 100;  // joints; larger assemblies answer as if none held, and Box2D's joints follow
  if (held_.empty() || held_.size() > kMost) return;
  jacobian_ = Matrix::Zero(static_cast<Eigen::Index>(3 * held_.size()), size());
  Eigen::Index rows = 0;
  for (const JointIndex index : held_) add_rows(core_.joints[index], jacobian_, rows);
  jacobian_.conservativeResize(rows, Eigen::NoChange);
  spread_ = mobility_.asDiagonal() * jacobian_.transpose();
  Matrix between = jacobian_ * spread_;
  // Rings hold some things twice: a little softness keeps the matrix regular.
  constexpr double kSoft = 1e-12;
  between.diagonal().array() += kSoft * between.diagonal().maxCoeff();
  between_.compute(between);
}

void Response::add_rows(const FlatJoint& joint, Matrix& jacobian, Eigen::Index& rows) const {
  const FlatBody* child = core_.find(joint.is.child);
  const FlatBody* parent = joint.is.parent == kNoBody ? nullptr : core_.find(joint.is.parent);
  const bool slides = joint.is.kind == JointKind::Prismatic;
  const Vector2 point_b = vector_of(joint.b2->GetAnchorB());
  // What slides is held where the child is now: only there do equal and opposite forces keep angular momentum.
  const Vector2 point_a = slides ? point_b : vector_of(joint.b2->GetAnchorA());
  const auto point_row = [&](const Vector2& along) {
    for (const auto& [flat, point, sign] : {std::tuple{parent, point_a, -1.0}, std::tuple{child, point_b, 1.0}}) {
      const Eigen::Index at = flat ? index_of(*flat) : -1;
      if (at < 0) continue;
      const Vector2 arm = point - vector_of(flat->b2->GetWorldCenter());
      jacobian(rows, at) = sign * along.x();
      jacobian(rows, at + 1) = sign * along.y();
      jacobian(rows, at + 2) = sign * cross(arm, along);
    }
    ++rows;
  };
  const auto rotation_row = [&] {
    for (const auto& [flat, sign] : {std::pair{parent, -1.0}, std::pair{child, 1.0}})
      if (const Eigen::Index at = flat ? index_of(*flat) : -1; at >= 0) jacobian(rows, at + 2) = sign;
    ++rows;
  };
  if (slides) {
    point_row(left_of(core_.axis_of(joint)));
    rotation_row();
    return;
  }
  point_row({1, 0});
  point_row({0, 1});
  if (joint.is.kind == JointKind::Fixed) rotation_row();
}

Response::Vector Response::answer(const Vector& impulses) const {
  Vector change = mobility_.asDiagonal() * impulses;
  if (jacobian_.rows() > 0) change -= spread_ * between_.solve(jacobian_ * change);
  return change;
}

Response::Vector Response::answer(const Vector2& arm_a, const Vector2& arm_b, const Vector2& impulse) const {
  Eigen::Matrix<double, 6, 1> load;
  load << -impulse, -cross(arm_a, impulse), impulse, cross(arm_b, impulse);
  return columns_ * load;
}

Response::Vector Response::answer_rotation() const { return columns_.col(5) - columns_.col(2); }

Vector2 Response::at_point(const FlatBody& flat, const Vector2& arm, const Vector& change) const {
  const Eigen::Index at = index_of(flat);
  if (at < 0) return Vector2::Zero();
  return Vector2(change[at], change[at + 1]) + change[at + 2] * left_of(arm);
}

double Response::spin(const FlatBody& flat, const Vector& change) const {
  const Eigen::Index at = index_of(flat);
  return at < 0 ? 0 : change[at + 2];
}

Response::Vector Response::allowed(const Vector& velocities) const {
  if (jacobian_.rows() == 0) return Vector::Zero(size());
  return -spread_ * between_.solve(jacobian_ * velocities);
}

std::pmr::vector<std::pair<JointIndex, WarmJoint>> Response::holding(const Vector& impulses) const {
  std::pmr::vector<std::pair<JointIndex, WarmJoint>> all(core_.memory);
  const Vector held = -between_.solve(jacobian_ * (mobility_.asDiagonal() * impulses));
  Eigen::Index row = 0;
  for (const JointIndex index : held_) {
    WarmJoint warm;
    warm.x = static_cast<float>(held[row++]);
    warm.y = static_cast<float>(held[row++]);
    if (core_.joints[index].is.kind == JointKind::Fixed) warm.angular = static_cast<float>(held[row++]);
    all.emplace_back(index, warm);
  }
  return all;
}

Response::Vector Response::velocities() const {
  Vector all(size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    const b2Vec2 v = bodies_[i]->b2->GetLinearVelocity();
    all[at] = v.x;
    all[at + 1] = v.y;
    all[at + 2] = bodies_[i]->b2->GetAngularVelocity();
  }
  return all;
}

void Response::give(const Vector& change) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    b2Body& b = *bodies_[i]->b2;
    const b2Vec2 given(static_cast<float>(change[at]), static_cast<float>(change[at + 1]));
    const auto given_spin = static_cast<float>(change[at + 2]);
    b.SetLinearVelocity(b.GetLinearVelocity() + given);
    b.SetAngularVelocity(b.GetAngularVelocity() + given_spin);
    if (!core_.stepping) continue;
    bodies_[i]->given += given;
    bodies_[i]->given_spin += given_spin;
  }
}

double Response::kinetic() const {
  double sum = 0;
  for (const FlatBody* flat : bodies_)
    sum += 0.5 * double{flat->b2->GetMass()} * vector_of(flat->b2->GetLinearVelocity()).squaredNorm() +
           0.5 * inertia(*flat) * std::pow(double{flat->b2->GetAngularVelocity()}, 2);
  return sum;
}

}  // namespace breve
