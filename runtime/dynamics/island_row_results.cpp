// Velocities at an island's rows, and what follows from their impulses: works and losses, forces in joints, and where
// the next solution begins.
#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/dynamics/gap_path.hpp"
#include "runtime/dynamics/island_rows.hpp"

namespace breve::island {

/// Velocities at the rows when the sub-step began: seen then, where the rows were found.
void Rows::recall_rates() {
  before_.clear();
  scalars_before_.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto& [touch, pair, row, law] = contact(i);
    const Vector3 a = row.axes * touch.velocity_a, b = row.axes * touch.velocity_b;
    const BodySlot of_a = state_.slot_of(pair.a), of_b = state_.slot_of(pair.b);
    const bool inner = of_a.tree && of_a.tree == of_b.tree;
    before_.push_back({inner ? Vector3(a - b) : a, inner ? Vector3(Vector3::Zero()) : b});
    row.slip[0] = a[1] - b[1];
    row.slip[1] = a[2] - b[2];
  }
  for (const std::size_t bound : limits_) scalars_before_.push_back(contacts_.bounds()[bound].rate);
  for (const MotorRow& motor : motors_) scalars_before_.push_back(motor.tree->sub_state.v[motor.velocity]);
  scalars_before_.resize(scalars_.size(), 0.0);
}

/// The same where the movers stand, with the velocities that they have.
void Rows::read_rates() {
  before_.clear();
  scalars_before_.clear();
  for (contact::Row& row : rows_) {
    const Vector3 a = rate_of(row, true), b = rate_of(row, false);
    before_.push_back({a, b});
    row.slip[0] = a[1] - b[1];
    row.slip[1] = a[2] - b[2];
  }
  for (const contact::ScalarRow& row : scalars_) scalars_before_.push_back(rate_of(row));
  started_ = before_;
  given_ = 0;
}

/// Velocities when a sub-step of h seconds began, at the points of free bodies that impulses push as it ends: the work
/// of an impulse is along these, but for what gravity and scripts' forces did meanwhile, which have their own books.
/// @param given  J, by the couples that make up for the forces' arms
void Rows::note_starts(double h, double given) {
  started_ = before_;
  given_ = given;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const contact::Row& row = rows_[i];
    for (const bool first : {true, false}) {
      const int index = first ? row.a : row.b;
      if (index < 0 || (first ? row.ja : row.jb)) continue;
      const Free& one = state_.free_bodies[static_cast<std::size_t>(index)];
      Vector3& start = started_[i][first ? 0 : 1];
      if (one.driver) {
        start = rate_of(row, first);
        continue;
      }
      const Matrix3& inverse = movers_[static_cast<std::size_t>(index)].inverse_inertia;
      const Vector3 spin = Vector3(one.free_v[3], one.free_v[4], one.free_v[5]) - h * (inverse * one.now.torque);
      start = row.axes * (one.before.velocity + spin.cross(first ? row.arm_a : row.arm_b));
    }
  }
}

double Rows::fastest() const {
  double fastest = 0;
  for (const contact::Row& row : rows_)
    fastest = std::max({fastest, row.bias, (rate_of(row, true) - rate_of(row, false)).norm()});
  return fastest;
}

bool Rows::squeezed(double stopped) {
  constexpr double kMuch = 3e-3, kDriven = 0.1;  // of the fastest; motors may press more than anything moves
  const double much = (motors_.empty() ? kMuch : kDriven) * stopped;
  const auto gives_way = [much](const contact::Row& row) { return row.softness * row.impulse[0] > much; };
  if (yield_ == 0 || std::none_of(rows_.begin(), rows_.end(), gives_way)) return false;
  state_.squeezed = true;
  state_.reset_velocities();
  for (contact::ScalarRow& row : scalars_) row.impulse = 0;
  for (contact::Row& row : rows_) {
    row.impulse.setZero();
    if (row.softness > 0) row.softness = 1 / state_.mass();
  }
  return true;
}

/// m/s along the normal, by which smooth motion changed the velocity of one side: of a free body that of its centre of
/// mass, since its rotation is not a force.
double Rows::swerve(std::size_t contact, bool first) const {
  const contact::Row& row = rows_[contact];
  const int index = first ? row.a : row.b;
  if (index < 0 || state_.is_driver(index)) return 0;
  if (first ? row.ja : row.jb) return rate_of(row, first)[0] - before(contact, first)[0];
  const Free& one = state_.free_bodies[static_cast<std::size_t>(index)];
  return row.axes.row(0) * (Vector3(one.free_v[0], one.free_v[1], one.free_v[2]) - one.before.velocity);
}

double Rows::normal_change(std::size_t contact) const {
  const contact::Row& row = rows_[contact];
  double sum = 0;
  for (const bool first : {true, false}) {
    const int index = first ? row.a : row.b;
    if (index < 0) continue;
    const Free& one = state_.free_bodies[static_cast<std::size_t>(index)];
    const Vector3 change(one.v[0] - one.free_v[0], one.v[1] - one.free_v[1], one.v[2] - one.free_v[2]);
    const Vector3 rotation(one.v[3] - one.free_v[3], one.v[4] - one.free_v[4], one.v[5] - one.free_v[5]);
    sum += (first ? 1 : -1) * row.axes.row(0).dot(change + rotation.cross(first ? row.arm_a : row.arm_b));
  }
  return sum;
}

bool Rows::unsteady(std::size_t contact, double h) const {
  const double turned = swerve(contact, true) - swerve(contact, false);
  return std::abs(turned) > kStrong * h * state_.core.settings.gravity.norm();
}

/// After smooth motion of h seconds, whose velocities the movers have: whether bodies that were apart are apart all the
/// way since something stronger than gravity, such as a spring, turns them. The rate at which they approach at one end
/// then says nothing of whether they touch. A predicted force acts in smooth motion and not in the velocities: there
/// the path does not tell.
bool Rows::turns_back(std::size_t contact, double h) {
  const auto& [touch, pair, row, law] = this->contact(contact);
  if (touch.gap <= kTouchSkin * state_.size_of_pair(pair)) return false;
  for (const int mover : {row.a, row.b})
    if (const Tree* tree = mover < 0 ? nullptr : state_.tree_of(mover); tree && (tree->loads.reacts || tree->braced))
      return false;
  if (!unsteady(contact, h)) return false;
  const double start = before(contact, true)[0] - before(contact, false)[0];
  const double end = rate_of(row, true)[0] - rate_of(row, false)[0];
  return GapPath{touch.gap, gap_now(touch), h * start, h * end}.stays_open();
}

/// Velocities that rows ask for after smooth motion of h seconds, whose velocities the movers have. Rows move positions
/// by half of what they change velocities for h: bodies that turned back on their own may come as near as they are.
void Rows::set_biases(double h) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Touch& touch = contacts_.touches()[i];
    contact::Row& row = rows_[i];
    row.bias = std::min(0.0, -touch.gap / h);
    touch.turned = turns_back(i, h);
    if (!touch.turned) continue;
    const double end = rate_of(row, true)[0] - rate_of(row, false)[0];
    row.bias = std::min(row.bias, end - 2 * gap_now(touch) / h);
  }
  for (std::size_t i = 0; i < limits(); ++i) limit(i).row.bias = std::min(0.0, -limit(i).bound.gap / h);
}

void Rows::set_length(double h) {
  solved_h_ = h;
  for (contact::Row& row : rows_) row.impulse *= h;
  for (contact::ScalarRow& row : scalars_) row.impulse *= h;
}

void Rows::begin_cold() {
  for (contact::Row& row : rows_) row.impulse = Vector3::Zero();
}

Vector3 Rows::rate_of(const contact::Row& row, bool first) const {
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

double Rows::rate_of(const contact::ScalarRow& row) const {
  const contact::Mover& mover = movers_[static_cast<std::size_t>(row.a)];
  return Eigen::Map<const articulated::Vector>(row.ja, mover.size)
      .dot(Eigen::Map<const articulated::Vector>(mover.v, mover.size));
}

double Rows::response(const contact::ScalarRow& row) const {
  const int size = movers_[static_cast<std::size_t>(row.a)].size;
  return Eigen::Map<const articulated::Vector>(row.ja, size).dot(Eigen::Map<const articulated::Vector>(row.ra, size));
}

bool Rows::push() const {
  return std::any_of(rows_.begin(), rows_.end(),
                     [](const contact::Row& row) { return row.impulse != Vector3::Zero(); });
}

/// J, that the impulses of the last solution would give alone, to bodies that were free.
double Rows::pressure() const {
  double sum = 0;
  for (const contact::Row& row : rows_) {
    const NearPair& pair = pair_of(row);
    sum += 0.5 * row.impulse.squaredNorm() * (state_.natural_response(pair.a) + state_.natural_response(pair.b));
  }
  for (const contact::ScalarRow& row : scalars_) sum += 0.5 * row.impulse * row.impulse * response(row);
  return sum;
}

void Rows::book() {
  pressed_ += pressure();
  state_.result.ledger.contact_loss -= given_;
  rotated_ += std::exchange(given_, 0.0);
  // A contact force that is constant over the sub-step works along the mean of the velocities before and after. Each
  // tree's own ledger has what left it through the contact, even if it went into another body.
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const contact::Row& row = rows_[i];
    if (row.impulse == Vector3::Zero()) continue;
    // The side that a script moves gives work of that script.
    for (const bool first : {true, false}) {
      const int mover = first ? row.a : row.b;
      if (state_.is_driver(mover))
        state_.result.ledger.script_work += (first ? -1 : 1) * row.impulse.dot(rate_of(row, first));
    }
    for (const bool first : {true, false}) {
      const Vector3 &start = started_[i][first ? 0 : 1], mean = (first ? 0.5 : -0.5) * (rate_of(row, first) + start);
      rotated_ += (first ? 0.5 : -0.5) * row.impulse.dot(start - before(i, first));
      const double along = row.impulse[0] * mean[0], across = row.impulse[1] * mean[1] + row.impulse[2] * mean[2];
      state_.result.ledger.contact_loss -= along;
      state_.result.ledger.friction_loss -= across;
      if (Tree* tree = state_.tree_of(first ? row.a : row.b)) {
        tree->ledger.contact_loss -= along;
        tree->ledger.friction_loss -= across;
      }
    }
  }
  for (std::size_t i = 0; i < limits() + motors(); ++i) {
    const contact::ScalarRow& row = scalars_[i];
    const double work = 0.5 * row.impulse * (scalars_before_[i] + rate_of(row));
    Tree& tree = *state_.tree_of(row.a);
    if (i < limits()) {
      state_.result.ledger.limit_loss -= work;
      tree.ledger.limit_loss -= work;
    } else {
      state_.result.ledger.motor_work += work;
      tree.ledger.motor_work += work;
    }
  }
}

double Rows::motor_doubt(const Tree* tree) const {
  double sum = 0;
  for (std::size_t i = 0; i < motors(); ++i) {
    const contact::ScalarRow& row = scalars_[limits() + i];
    const MotorRow& motor = motors_[i];
    if (tree && motor.tree != tree) continue;
    const double impulse = std::abs(row.impulse) + std::abs(motor.tree->motor_impulse[motor.velocity]);
    sum += 0.5 * impulse * std::abs(rate_of(row) - scalars_before_[limits() + i]);
  }
  return sum;
}

/// Notes the impulses of contacts and limits on trees as forces that last the h seconds of a sub-step: the reaction of
/// a joint is made of them.
void Rows::note_contact_forces(double h) {
  for (Tree* tree : state_.trees) {
    for (TreeLink& link : tree->links) link.contact = {};
    tree->limit_force.setZero();
  }
  for (std::size_t i = 0; i < contacts(); ++i) {
    const auto& [touch, pair, row, law] = contact(i);
    if (row.impulse == Vector3::Zero()) continue;
    const Vector3 force = row.axes.transpose() * row.impulse / h;
    state_.add_force(pair.a, touch.point, force);
    state_.add_force(pair.b, touch.point, -force);
  }
}

void Rows::note_limit_forces(double h) {
  for (std::size_t i = 0; i < limits(); ++i) {
    const contact::ScalarRow& row = scalars_[i];
    Tree& tree = *state_.tree_of(row.a);
    tree.limit_force += row.impulse / h * Eigen::Map<const articulated::Vector>(row.ja, tree.model.velocities());
  }
}

void Rows::keep_warm(double h) {
  // An event may cut a sub-step to a sliver: that says nothing of forces.
  const bool kept = h > 0;
  // By the old ones, before they are written over.
  before_force_.clear();
  for (std::size_t i = 0; kept && i < contacts(); ++i) {
    const Touch& touch = contact(i).touch;
    const WarmPoint* warm = contacts_.warm_of(touch);
    before_force_.push_back(warm ? std::max(0.0, warm->force.dot(touch.normal)) : 0);
  }
  for (NearPair* pair : state_.pairs) {
    if (pair->spring.stiffness > 0) continue;  // ContactSprings::keep() does it
    if (kept) pair->warm_count = 0;
    pair->touching = false;
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto& [touch, pair, row, law] = contact(i);
    pair.touching = pair.touching || touch.gap <= kSkin * state_.size_of_pair(pair) || row.impulse[0] > 0;
    if (!kept || pair.warm_count == static_cast<int>(pair.warm.size()) || row.impulse == Vector3::Zero()) continue;
    pair.warm[static_cast<std::size_t>(pair.warm_count++)] = {touch.feature, false,
                                                              row.axes.transpose() * row.impulse / h, before_force_[i]};
  }
  if (!kept) return;
  for (const Bound& bound : contacts_.bounds()) {
    JointEntry& joint = state_.core.joints[bound.joint];
    joint.limit_before[bound.axis] = joint.limit[bound.axis];
  }
  for (const Bound& bound : contacts_.bounds()) state_.core.joints[bound.joint].limit[bound.axis] = 0;
  for (std::size_t i = 0; i < limits(); ++i) {
    const auto& [bound, row] = limit(i);
    state_.core.joints[bound.joint].limit[bound.axis] += bound.sign * row.impulse / h;
  }
  for (std::size_t i = 0; i < motors(); ++i) {
    const auto& [driven, row] = motor(i);
    state_.core.joints[driven.joint].motor[driven.axis] = row.impulse / h;
  }
}

}  // namespace breve::island
