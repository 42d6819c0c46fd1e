// Coordinates and forces of an island with contact springs. Energy closes at every stage: what a spring does to the
// bodies, what it stores and what it loses are functions of the same gap, gap rate, stretch and slip.
#include "runtime/dynamics/sprung_motion.hpp"

#include <cmath>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/articulated/rotation.hpp"
#include "runtime/base/rotation_vector.hpp"

namespace breve::island {

using articulated::Kind;
using articulated::Vector;
using contact::Vector2;

namespace {
constexpr std::size_t kLeastRoom = 8;
// Surfaces that rattle change from piece to piece of their forces hundreds of times a second: what each errs by adds
// up.
constexpr double kCoarsest = 1e-5;
constexpr std::uint64_t kNoPiece = 0xcbf29ce484222325, kPrime = 0x100000001b3;  // FNV-1a
}  // namespace

/// Calls of_free(body, first place, first speed) and of_cluster(cluster, part, first place, first speed) in order.
template <class OfFree, class OfCluster>
void SprungMotion::each(const OfFree& of_free, const OfCluster& of_cluster) {
  int q = 0, v = 0;
  for (Free& one : state_.free_bodies) {
    of_free(one, q, v);
    q += kFreePositions;
    v += kFreeSpeeds;
  }
  for (std::size_t i = 0; i < state_.clusters.size(); ++i) {
    const Clustered& one = state_.clusters[i];
    of_cluster(*one.entry->system, parts_[i], q, v);
    q += one.entry->system->positions();
    v += one.entry->system->velocities();
  }
}

void SprungMotion::lay_out() {
  parts_.resize(state_.clusters.size());
  kinds_.clear();
  nq_ = 0;
  mass_ = 0;
  each(
      [this](const Free& one, int, int) {
        for (int k = 0; k < kFreeSpeeds; ++k) kinds_.push_back(k < 3 ? Kind::Length : Kind::Angle);
        nq_ += kFreePositions;
        if (!one.driver) mass_ += one.now.solid->mass;
      },
      [this](const Cluster& cluster, const Part&, int, int) {
        for (int k = 0; k < cluster.velocities(); ++k) kinds_.push_back(cluster.kind(k));
        nq_ += cluster.positions();
      });
  for (const Tree* tree : state_.trees) mass_ += tree->model.mass();
  bodies_v_ = static_cast<int>(kinds_.size());
  while (room_ < points.size()) room_ = std::max(kLeastRoom, 2 * room_);
  const int size = tree_works_at(static_cast<int>(state_.trees.size()));
  kinds_.resize(static_cast<std::size_t>(size), Kind::Length);
  pushes_.assign(state_.free_bodies.size(), {});
  const Accuracy& accuracy = state_.accuracy;
  const double tolerance = std::min(accuracy.tolerance, kCoarsest);
  const bool same =
      integrator_ && nv_ == size && start_.q.size() == nq_ && scheme_ == accuracy.scheme && tolerance_ == tolerance;
  nv_ = size;
  if (same) return;
  constexpr std::size_t kVectors = 24;  // of this class and its integrator
  reserved_.reset();
  reserved_.emplace(pushes_.get_allocator().resource(),
                    kVectors * sizeof(double) * static_cast<std::size_t>(nq_ + nv_));
  start_.q.setZero(nq_);
  start_.v.setZero(nv_);
  articulated::Settings settings;
  settings.tolerance.relative = tolerance_ = tolerance;
  settings.tolerance.length = settings.tolerance.velocity = state_.unit();
  settings.implicit_joints = accuracy.implicit_joints;
  settings.refine = true;
  integrator_.emplace(*this, scheme_ = accuracy.scheme, settings);
}

// --- the state ------------------------------------------------------------------------------------------------------

double SprungMotion::stretch_unit() const { return 1 / std::sqrt(state_.accuracy.contact_stiffness); }

void SprungMotion::read(articulated::Instant& at) {
  at.v.setZero();
  at.step = 0;
  const auto take_step = [&at](double step) {
    if (step > 0 && (at.step == 0 || step < at.step)) at.step = step;
  };
  each(
      [&](const Free& one, int q, int v) {
        const Quaternion& orientation = one.now.orientation;
        at.q.segment<3>(q) = one.now.center;
        at.q.segment<4>(q + 3) << orientation.w(), orientation.x(), orientation.y(), orientation.z();
        at.v.segment<3>(v) = one.now.velocity;
        at.v.segment<3>(v + 3) = orientation.conjugate() * one.now.spin;
        take_step(one.next);
      },
      [&](const Cluster& cluster, Part& part, int q, int v) {
        part.q.resize(cluster.positions());
        part.v.resize(cluster.velocities());
        cluster.read(part.q, part.v);
        at.q.segment(q, part.q.size()) = part.q;
        at.v.segment(v, part.v.size()) = part.v;
        take_step(cluster.next_step());
      });
  state_.place_links();
  for (std::size_t i = 0; i < points.size(); ++i) {
    follow(points[i]);
    at.v.segment<2>(stretch_at(i)) = (points[i].axes * points[i].stretch).tail<2>() / stretch_unit();
  }
}

/// The bodies' state, without what a step brings about beside it.
void SprungMotion::place(const Vector& q, const Vector& v) {
  each(
      [&](Free& one, int at_q, int at_v) {
        one.now.center = q.segment<3>(at_q);
        one.now.orientation = Quaternion(q[at_q + 3], q[at_q + 4], q[at_q + 5], q[at_q + 6]);
        one.now.velocity = v.segment<3>(at_v);
        one.now.spin = one.now.orientation * Vector3(v.segment<3>(at_v + 3));
      },
      [&](Cluster& cluster, Part& part, int at_q, int at_v) {
        part.q = q.segment(at_q, cluster.positions());
        part.v = v.segment(at_v, cluster.velocities());
        cluster.place(part.q, part.v);
      });
}

void SprungMotion::write(const articulated::Instant& at) {
  place(at.q, at.v);
  each([&](Free& one, int, int) { one.next = at.step; },
       [&](Cluster& cluster, Part& part, int q, int v) {
         part.q = at.q.segment(q, cluster.positions());
         part.v = at.v.segment(v, cluster.velocities());
         cluster.write(part.q, part.v);
         cluster.set_next_step(at.step);
       });
}

void SprungMotion::step(double time, double h) {
  lay_out();
  read(start_);
  start_.t = time;
  end_ = start_;
  const auto press = [this](bool on) {
    for (Clustered& one : state_.clusters) one.stage->pressed = on;
  };
  press(true);
  try {
    integrator_->step(end_, h);
  } catch (...) {
    press(false);
    write(start_);
    throw;
  }
  press(false);
  write(end_);
  const articulated::StepCount& count = integrator_->count();
  state_.result.counters.evaluations += static_cast<std::uint64_t>(count.evaluations);
  state_.result.counters.rejected += static_cast<std::uint64_t>(count.rejected);
}

void SprungMotion::look() {
  state_.place_links();
  for (std::size_t i = 0; i < points.size(); ++i) {
    follow(points[i]);
    resist(points[i], end_.v.segment<2>(stretch_at(i)) * stretch_unit());
  }
}

double SprungMotion::gap_of(std::size_t index, double& rate) {
  SprungPoint& point = points[index];
  follow(point);
  rate = point.slip[0];
  return point.gap;
}

Energy SprungMotion::lost() const {
  Energy all;
  all.contact_loss = end_.v[works_at()] * mass_;
  all.friction_loss = end_.v[works_at() + 1] * mass_;
  all.script_work = end_.v[works_at() + 2] * mass_;
  for (const Tree* tree : state_.trees) all.limit_loss += lost(*tree).limit_loss;
  return all;
}

Energy SprungMotion::lost(const Tree& tree) const {
  Energy own;
  own.contact_loss = end_.v[tree_works_at(tree.slot)] * mass_;
  own.friction_loss = end_.v[tree_works_at(tree.slot) + 1] * mass_;
  own.limit_loss = end_.v[tree_works_at(tree.slot) + 2] * mass_;
  return own;
}

// --- forces ----------------------------------------------------------------------------------------------------------

/// Where the point is and how fast it slips, at the island's state.
void SprungMotion::follow(SprungPoint& point) const {
  const NearPair& pair = *state_.pairs[point.pair];
  const Pose a = state_.pose_of(pair.a), b = state_.pose_of(pair.b);
  const Quaternion& orientation = point.with_a ? a.orientation : b.orientation;
  Vector3 normal = orientation * point.normal;
  if (point.round) {
    const Bodies& bodies = *state_.core.bodies;
    const Contact contact = closest(*bodies.collision_shape(pair.a), a, *bodies.collision_shape(pair.b), b);
    normal = contact.normal;
    point.at = contact.point;
    point.gap = contact.distance;
  } else {
    const Vector3 on_a = a.location + a.orientation * point.on_a, on_b = b.location + b.orientation * point.on_b;
    // On the body without the normal: there the rate of the gap is that of the two bodies' points, exactly.
    point.at = point.with_a ? Vector3(on_b + point.radius * normal) : Vector3(on_a - point.radius * normal);
    point.gap = normal.dot(on_a - on_b) - point.radius;
  }
  const Vector3 tangent = orientation * point.tangent;
  const Vector3 first = (tangent - normal.dot(tangent) * normal).normalized();
  point.axes << normal.transpose(), first.transpose(), normal.cross(first).transpose();
  point.slip = point.axes * (state_.point_velocity(pair.a, point.at) - state_.point_velocity(pair.b, point.at));
}

/// The forces of the springs of a point that was followed. A point that was open as the sub-step began is met by an
/// event.
SprungMotion::Resistance SprungMotion::resist(SprungPoint& point, const Vector2& stretch) const {
  Resistance out;
  if (point.apart == 0) out.press = contact::press(point.spring, point.gap - point.skin, point.slip[0]);
  out.drag = contact::drag(point.spring, stretch, point.slip.tail<2>(), out.press.force);
  point.slips = out.press.force > 0 && out.drag.slides;
  const Vector3 force(out.press.force, out.drag.force[0], out.drag.force[1]);
  point.force = point.axes.transpose() * force;
  point.stretched = point.axes.transpose() * Vector3(0, stretch[0], stretch[1]);
  point.stored = out.press.stored + out.drag.stored;
  return out;
}

void SprungMotion::push(const SprungPoint& point, Vector& a) {
  const NearPair& pair = *state_.pairs[point.pair];
  for (const auto& [body, sign] : {std::pair{pair.a, 1.0}, std::pair{pair.b, -1.0}}) {
    const BodySlot side = state_.slot_of(body);
    if (side.mover < 0) continue;
    const Vector3 force = sign * point.force;
    if (!side.tree) {
      articulated::Wrench& on = pushes_[static_cast<std::size_t>(side.mover)];
      on.force += force;
      on.couple += state_.arm_of(side, point.at).cross(force);
      continue;
    }
    articulated::Wrench& on = side.tree->links[static_cast<std::size_t>(side.link)].pressed;
    on.force += force;
    on.couple += (point.at - articulated::com_position(side.tree->model, side.tree->data, side.link)).cross(force);
    const Vector3 velocity = articulated::point_velocity(side.tree->data, side.link, point.at);
    const double along = point.force.dot(point.axes.row(0)) * point.axes.row(0).dot(velocity);
    a[tree_works_at(side.tree->slot)] -= sign * along / mass_;
    a[tree_works_at(side.tree->slot) + 1] -= (force.dot(velocity) - sign * along) / mass_;
  }
}

void SprungMotion::acceleration(double t, const Vector& q, const Vector& v, double step, Vector& a) {
  place(q, v);
  a.setZero();
  pushes_.assign(state_.free_bodies.size(), {});
  for (Tree* tree : state_.trees)
    for (TreeLink& link : tree->links) link.pressed = {};
  piece_ = kNoPiece;
  for (std::size_t i = 0; i < points.size(); ++i) {
    SprungPoint& point = points[i];
    follow(point);
    const Resistance now = resist(point, v.segment<2>(stretch_at(i)) * stretch_unit());
    a.segment<2>(stretch_at(i)) = now.drag.stretch_rate / stretch_unit();
    piece_ = kPrime * (piece_ ^ ((now.press.force > 0 ? 1u : 0u) + (point.slips ? 2u : 0u)));
    a[works_at()] += now.press.loss / mass_;
    a[works_at() + 1] += now.drag.loss / mass_;
    push(point, a);
  }
  each(
      [&](const Free& one, int, int at) {
        const articulated::Wrench& pushed = pushes_[static_cast<std::size_t>(&one - state_.free_bodies.data())];
        if (one.driver) {
          const double power = pushed.force.dot(one.now.velocity) + pushed.couple.dot(one.now.spin);
          a[works_at() + 2] -= power / mass_;
          return;
        }
        const MassProperties& solid = *one.now.solid;
        const Vector3 spin = v.segment<3>(at + 3);
        const Vector3 torque = one.now.orientation.conjugate() * (one.now.torque + pushed.couple);
        a.segment<3>(at) = state_.core.settings.gravity + (one.now.force + pushed.force) / solid.mass;
        a.segment<3>(at + 3) = Eigen::Matrix3d(solid.inertia).inverse() * (torque - spin.cross(solid.inertia * spin));
        a[works_at() + 2] += (one.now.force.dot(one.now.velocity) + one.now.torque.dot(one.now.spin)) / mass_;
      },
      [&](Cluster& cluster, Part& part, int at_q, int at_v) {
        part.q = q.segment(at_q, cluster.positions());
        part.v = v.segment(at_v, cluster.velocities());
        part.a.resize(part.v.size());
        cluster.acceleration(t, part.q, part.v, step, part.a);
        for (const Tree* tree : cluster.trees()) {
          if (tree->held.empty()) continue;
          for (const HeldLimit& held : tree->held) piece_ = kPrime * (piece_ ^ (held.holds ? 1u : 0u));
          a[tree_works_at(tree->slot) + 2] -= tree->held_force.dot(tree->state.v) / mass_;
        }
        a.segment(at_v, part.a.size()) = part.a;
      });
}

// --- the space that positions lie in --------------------------------------------------------------------------------

void SprungMotion::move(const Vector& q, const Vector& d, Vector& out) {
  out.resize(nq_);
  each(
      [&](const Free&, int at, int by) {
        const Quaternion orientation(q[at + 3], q[at + 4], q[at + 5], q[at + 6]);
        const Quaternion rotated = (orientation * rotation_by(d.segment<3>(by + 3))).normalized();
        out.segment<3>(at) = q.segment<3>(at) + d.segment<3>(by);
        out.segment<4>(at + 3) << rotated.w(), rotated.x(), rotated.y(), rotated.z();
      },
      [&](Cluster& cluster, Part& part, int at, int by) {
        part.q = q.segment(at, cluster.positions());
        part.v = d.segment(by, cluster.velocities());
        cluster.move(part.q, part.v, part.q);
        out.segment(at, part.q.size()) = part.q;
      });
}

void SprungMotion::rate_of_move(const Vector& d, const Vector& v, Vector& out) {
  out.setZero(nv_);  // a speed that belongs to no body moves no position
  each(
      [&](const Free&, int, int at) {
        out.segment<3>(at) = v.segment<3>(at);
        out.segment<3>(at + 3) = articulated::rate_of_rotation_vector(d.segment<3>(at + 3), v.segment<3>(at + 3));
      },
      [&](Cluster& cluster, Part& part, int, int at) {
        part.v = d.segment(at, cluster.velocities());
        part.a = v.segment(at, cluster.velocities());
        cluster.rate_of_move(part.v, part.a, part.out);
        out.segment(at, part.v.size()) = part.out;
      });
}

void SprungMotion::bend_to_cayley(Vector& d) {
  each([&](const Free&, int, int at) { d.segment<3>(at + 3) = articulated::cayley(d.segment<3>(at + 3)); },
       [&](Cluster& cluster, Part& part, int, int at) {
         part.v = d.segment(at, cluster.velocities());
         cluster.bend_to_cayley(part.v);
         d.segment(at, part.v.size()) = part.v;
       });
}

}  // namespace breve::island
