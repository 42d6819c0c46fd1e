// The solve of an island's rows, and what follows from its impulses: states, works and losses, forces in joints, and
// where the next solve begins.
#include <algorithm>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/base/rotation_vector.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

void Island::load_velocities() {
  for (Free& one : free_) {
    for (int k = 0; k < 3; ++k) {
      one.v[k] = one.free_v[k] = one.now.velocity[k];
      one.v[3 + k] = one.free_v[3 + k] = one.now.spin[k];
    }
  }
  for (Tree* tree : trees_) tree->free_v = tree->smooth_v = tree->state.v;
}

void Island::store_velocities(double moved_h) {
  for (Free& one : free_) {
    const Vector3 change(one.v[0] - one.free_v[0], one.v[1] - one.free_v[1], one.v[2] - one.free_v[2]);
    const Vector3 rotation(one.v[3] - one.free_v[3], one.v[4] - one.free_v[4], one.v[5] - one.free_v[5]);
    one.now.velocity = Vector3(one.v[0], one.v[1], one.v[2]);
    one.now.spin = Vector3(one.v[3], one.v[4], one.v[5]);
    if (moved_h == 0) continue;
    one.now.center += moved_h * change;
    if (rotation != Vector3::Zero())
      one.now.orientation = (rotation_by(moved_h * rotation) * one.now.orientation).normalized();
  }
  if (moved_h == 0) return;
  note_wholes(&Tree::smooth_v, false);
  // Semi-implicit Euler moves with the velocity after.
  for (const Clustered& one : clusters_)
    for (Tree* tree : one.entry->system->trees()) {
      tree->way = (one.semi ? 2 : 1) * moved_h * (tree->state.v - tree->smooth_v);
      articulated::move(tree->model, tree->state.q, tree->way, tree->state.q);
    }
  keep_wholes(moved_h, Given::All);
}

/// Motors, dampers and scripts pushed along the way that smooth motion took; what the rows' impulses added to it, half
/// of the change of velocity for h, is worked along too.
void Island::correct_works(double h) {
  for (const Free& one : free_) {
    for (int k = 0; k < 3; ++k)
      free_work_ +=
          0.5 * h *
          (one.now.force[k] * (one.v[k] - one.free_v[k]) + one.now.torque[k] * (one.v[3 + k] - one.free_v[3 + k]));
  }
  correct_network_drag();
  for (Clustered& clustered : clusters_)
    for (const std::uint32_t index : clustered.entry->trees) {
      Tree& tree = *core_.trees[index];
      if (!tree.driven) continue;
      const bool semi = clustered.semi;
      const articulated::Vector &before = tree.sub_state.v, &free = tree.smooth_v, &after = tree.state.v;
      for (int i = 0; i < tree.model.size(); ++i) {
        const TreeLink& link = tree.links[static_cast<std::size_t>(i)];
        if (link.joint == kNoJoint) continue;
        const articulated::Body& body = tree.model.body(i);
        const double damping = core_.joints[link.joint].drive.damping;
        for (int k = body.v; k < body.v + articulated::velocity_count(body.type); ++k) {
          const double change = after[k] - free[k], mean = 0.5 * (before[k] + free[k]);
          clustered.pending.motor_work += 0.5 * change * tree.motor_impulse[k];
          clustered.pending.script_work += (semi ? 1 : 0.5) * change * h * tree.set_tau[k];
          // An implicit damper pushes against the velocity that comes of it.
          if (semi && !link.slow_spring)
            clustered.pending.drag_loss += damping * h * (after[k] * after[k] - free[k] * mean);
          else
            clustered.pending.drag_loss += 0.5 * change * damping * h * (semi ? before[k] : mean);
        }
      }
    }
}

/// After smooth motion of h seconds: what is left of each motor's strength, and the speed that it is to reach.
void Island::bound_motors(double h) {
  if (motors_.empty()) return;
  for (Tree* tree : trees_)
    if (tree->aimed) core_.aim(*tree);
  const std::size_t first = limit_rows();
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const MotorRow& motor = motors_[i];
    contact::ScalarRow& row = scalars_[first + i];
    const double given = motor.tree->motor_impulse[motor.velocity], most = motor.strength * h;
    row.bias = motor.tree->loads.motor_speed[motor.velocity];
    row.lo = std::min(0.0, -most - given);
    row.hi = std::max(0.0, most - given);
  }
}

/// The couple of a ball joint's motor is bounded as a whole: where its three numbers are more than that together, each
/// is bounded by its share.
/// @return  whether some were: the rows are to be solved again
bool Island::shorten_couples(double h) {
  constexpr double kRoundOff = 1e-9;
  bool any = false;
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const MotorRow& motor = motors_[i];
    if (motor.shared < 3) continue;
    contact::ScalarRow* rows = &scalars_[limit_rows() + i];
    const Vector3 given = motor.tree->motor_impulse.segment<3>(motor.velocity);
    const Vector3 whole = given + Vector3(rows[0].impulse, rows[1].impulse, rows[2].impulse);
    const double most = motor.strength * h;
    if (!(whole.norm() > (1 + kRoundOff) * most)) continue;
    const Vector3 left = whole * (most / whole.norm()) - given;
    for (int k = 0; k < 3; ++k) {
      rows[k].lo = std::min(0.0, left[k]);
      rows[k].hi = std::max(0.0, left[k]);
    }
    any = true;
  }
  return any;
}

void Island::solve(double h) {
  if (rows_.empty() && scalars_.empty()) return;
  const bool rebounds = spent_ && find_rebounds(h);
  if (rebounds) read_row_rates(free_rates_);
  rebounds ? solve_rebounding() : solve_rows();
  if (!shorten_couples(h)) return;
  reset_velocities();
  set_biases(h);
  rebounds ? solve_rebounding() : solve_rows();
}

/// How many times the operations of the sweeps a direct solution may take: those that a stack would need to come as
/// near to the solution are many more than are allowed. Only `reference` has no bound.
double Island::direct_share() const {
  constexpr double kSwept = 3, kSolved = 10, kExact = 100;
  // Sweeps hardly close a loop that something presses on.
  if (!accuracy_.direct) return has_loops() ? kSolved : kSwept;
  switch (accuracy_.rung) {
    case Rung::Reference: return JointDrive::kNoLimit;
    case Rung::Precise: return kExact;
    default: return kSolved;
  }
}

void Island::solve_rows() {
  contact::SolveSettings settings;
  const int fast = core_.settings.fast_contacts;
  settings.iterations = fast > 0 ? fast : accuracy_.iterations;
  constexpr double kSwept = 0.1;  // of the speed that is rest
  settings.direct = fast == 0;
  settings.direct_share = direct_share();
  settings.meter = &meter_;
  // Where `fast` solves directly, no digit that cannot be seen in a step is worth a linear solve.
  constexpr double kUnseen = 1e-3;  // of the speed that is rest
  if (!accuracy_.direct) settings.tolerance = std::max(settings.tolerance, kUnseen * resting_);
  // Sweeps that no exact solution follows end when they change less than could be seen, or a hundredth of that.
  settings.swept = (accuracy_.direct ? 0.01 * kSwept : kSwept) * resting_;
  const contact::SolveReport report = contact::solve_island(movers_, rows_, scalars_, settings, workspace_);
  result.counters.solver_iterations += static_cast<std::uint64_t>(report.iterations + report.newton);
  result.counters.direct += report.direct;
  result.counters.residual = std::max(result.counters.residual, report.residual);
}

/// Of one side's point along the row's axes, from the movers' v as they are. A tree that touches itself is one side.
Vector3 Island::rate_of(const contact::Row& row, bool first) const {
  const int index = first ? row.a : row.b;
  if (index < 0) return Vector3::Zero();
  const contact::Mover& mover = movers_[static_cast<std::size_t>(index)];
  const double *v = mover.v, *j = first ? row.ja : row.jb;
  if (!j) {
    const Vector3& arm = first ? row.arm_a : row.arm_b;
    return row.axes * (Vector3(v[0], v[1], v[2]) + Vector3(v[3], v[4], v[5]).cross(arm));
  }
  const Eigen::Map<const articulated::Vector> velocity(v, mover.size);
  Vector3 rate;
  for (int k = 0; k < 3; ++k)
    rate[k] = Eigen::Map<const articulated::Vector>(j + k * mover.size, mover.size).dot(velocity);
  return rate;
}

double Island::rate_of(const contact::ScalarRow& row) const {
  const contact::Mover& mover = movers_[static_cast<std::size_t>(row.a)];
  return Eigen::Map<const articulated::Vector>(row.ja, mover.size)
      .dot(Eigen::Map<const articulated::Vector>(mover.v, mover.size));
}

void Island::book_rows() {
  // A contact force that is constant over the sub-step works along the mean of the velocities before and after. Each
  // tree's own account has what left it through the contact, were it into another body.
  const auto tree_at = [this](int mover) {
    const int first = static_cast<int>(free_.size());
    return mover < first ? nullptr : trees_[static_cast<std::size_t>(mover - first)];
  };
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const contact::Row& row = rows_[i];
    if (row.impulse == Vector3::Zero()) continue;
    // The side that a script moves gives work of that script.
    for (const bool first : {true, false}) {
      const int mover = first ? row.a : row.b;
      if (is_driver(mover)) result.ledger.script_work += (first ? -1 : 1) * row.impulse.dot(rate_of(row, first));
    }
    for (const bool first : {true, false}) {
      const Vector3 mean = (first ? 0.5 : -0.5) * (rate_of(row, first) + before_[2 * i + (first ? 0 : 1)]);
      const double along = row.impulse[0] * mean[0], across = row.impulse[1] * mean[1] + row.impulse[2] * mean[2];
      result.ledger.contact_loss -= along;
      result.ledger.friction_loss -= across;
      if (Tree* tree = tree_at(first ? row.a : row.b)) {
        tree->ledger.contact_loss -= along;
        tree->ledger.friction_loss -= across;
      }
    }
  }
  const std::size_t limits = limit_rows();
  for (std::size_t i = 0; i < limits + motors_.size(); ++i) {
    const contact::ScalarRow& row = scalars_[i];
    const double work = 0.5 * row.impulse * (scalars_before_[i] + rate_of(row));
    Tree& tree = *tree_at(row.a);
    if (i < limits) {
      result.ledger.limit_loss -= work;
      tree.ledger.limit_loss -= work;
    } else {
      result.ledger.motor_work += work;
      tree.ledger.motor_work += work;
    }
  }
}

/// Notes the impulses of contacts and limits on trees as forces that last the h seconds of a sub-step: the reaction of
/// a joint is made of them.
void Island::note_forces(double h) {
  if (trees_.empty()) return;
  for (Tree* tree : trees_) {
    for (TreeLink& link : tree->links) link.contact = {};
    tree->limit_force.setZero();
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].impulse == Vector3::Zero()) continue;
    const NearPair& pair = *pairs_[touches_[i].pair];
    const Vector3 force = rows_[i].axes.transpose() * rows_[i].impulse / h;
    add_force(pair.a, touches_[i].point, force);
    add_force(pair.b, touches_[i].point, -force);
  }
  note_spring_forces();
  for (std::size_t i = 0; i < limit_rows(); ++i) {
    Tree& tree = *trees_[static_cast<std::size_t>(scalars_[i].a) - free_.size()];
    tree.limit_force +=
        scalars_[i].impulse / h * Eigen::Map<const articulated::Vector>(scalars_[i].ja, tree.model.velocities());
  }
}

void Island::add_force(BodyIndex body, const Vector3& point, const Vector3& force) {
  const BodySlot side = slot_of(body);
  if (!side.tree) return;
  articulated::Wrench& wrench = side.tree->links[static_cast<std::size_t>(side.link)].contact;
  wrench.force += force;
  wrench.couple += (point - articulated::com_position(side.tree->model, side.tree->data, side.link)).cross(force);
}

void Island::keep_warm(double h) {
  // An event may cut a sub-step to a sliver: that says nothing of forces.
  const bool kept = h > 0;
  // By the old ones, before they are written over.
  before_force_.clear();
  for (std::size_t i = 0; kept && i < rows_.size(); ++i) {
    const WarmPoint* warm = warm_of(touches_[i]);
    before_force_.push_back(warm ? std::max(0.0, warm->force.dot(touches_[i].normal)) : 0);
  }
  for (NearPair* pair : pairs_) {
    if (pair->spring.stiffness > 0) continue;  // keep_springs
    if (kept) pair->warm_count = 0;
    pair->touching = false;
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    NearPair& pair = *pairs_[touches_[i].pair];
    const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
    pair.touching = pair.touching || touches_[i].gap <= kSkin * std::min(a.bounding_radius(), b.bounding_radius()) ||
                    rows_[i].impulse[0] > 0;
    if (!kept || pair.warm_count == static_cast<int>(pair.warm.size()) || rows_[i].impulse == Vector3::Zero()) continue;
    pair.warm[static_cast<std::size_t>(pair.warm_count++)] = {
        touches_[i].feature, false, rows_[i].axes.transpose() * rows_[i].impulse / h, before_force_[i]};
  }
  if (!kept) return;
  for (const Bound& bound : bounds_) {
    JointEntry& joint = core_.joints[bound.joint];
    joint.limit_before[bound.axis] = joint.limit[bound.axis];
  }
  for (const Bound& bound : bounds_) core_.joints[bound.joint].limit[bound.axis] = 0;
  std::size_t k = 0;
  for (const Bound& bound : bounds_)
    if (bound.rests) core_.joints[bound.joint].limit[bound.axis] += bound.sign * scalars_[k++].impulse / h;
  for (const MotorRow& motor : motors_) core_.joints[motor.joint].motor[motor.axis] = scalars_[k++].impulse / h;
}

}  // namespace breve
