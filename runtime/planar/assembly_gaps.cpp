// Joints that are open are closed where their links have come to, as Box2D does it: positions move, velocities do not.
// Where links touch something Box2D closes a part of each gap in a sub-step, joint by joint: joints would stand open
// where links move far along tangents, or heavy ones hang on light ones. So what it leaves is closed all at once.
#include <algorithm>
#include <cmath>

#include "runtime/planar/assembly.hpp"
#include "runtime/planar/island.hpp"
#include "runtime/planar/moved_back.hpp"

namespace breve {

/// By how much joints are open at the new pose, the widest; limits count where their joints are at them.
double Planar::Core::Assembly::find_gaps() {
  double worst = 0;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Member& member = joints_[i];
    Vector& gap = rates_[i] = gap_of(i, after_);
    if (member.locked) {
      double& travel = gap[member.free_row()];
      travel = std::min(travel - member.low, 0.0) + std::max(travel - member.high, 0.0);
    }
    worst = std::max(worst, gap.cwiseAbs().maxCoeff());
  }
  return worst;
}

/// What joints are open at the new pose is closed there, as Box2D does it: positions move and velocities do not, but
/// for a rotation of the whole that keeps the angular momentum.
/// @param most  the energy by which this may lift the links, in Box2D's units
/// @return      the work of gravity along the way that they are moved
double Planar::Core::Assembly::close_gaps(double most) {
  constexpr double kOpen = 1e-5;  // length units or rad
  constexpr double kMost = 0.1;   // the same: what is moved at once
  constexpr int kMostRounds = 6;  // of Newton's method
  // A straight chain between two points that are too far apart, or too near, would be moved far across for next to
  // nothing.
  constexpr double kSoft = 1e-3;
  if (!(find_gaps() > kOpen)) return 0;
  const Common had = common_motion();
  double work = 0;
  for (int round = 0; round < kMostRounds && find_gaps() > kOpen; ++round) {
    linearize(after_, kSoft);
    for (Vector& gap : rates_) gap = -gap;
    system_.solve(rates_);
    std::fill(moves_.begin(), moves_.end(), Vector::Zero());
    system_.spread(rates_, moves_);
    double farthest = 0;
    for (const Vector& move : moves_) farthest = std::max(farthest, move.cwiseAbs().maxCoeff());
    double part = farthest > kMost ? kMost / farthest : 1;
    const double falls = work_of_moves(), left = most + work;
    if (-part * falls > left) part = std::max(left, 0.0) / -falls;
    work += part * falls;
    for (std::size_t i = 0; i < links_.size(); ++i)
      after_[i] = FlatPose(after_[i].center + part * moves_[i].head<2>(), after_[i].angle + part * moves_[i][2]);
  }
  linearize(after_);
  keep_rotation(had);
  return work;
}

/// The work of gravity along the moves of the links, in Box2D's units.
double Planar::Core::Assembly::work_of_moves() const {
  const Vector2 fall = vector_of(core_.b2->GetGravity());
  double sum = 0;
  for (std::size_t i = 0; i < links_.size(); ++i) sum += fall.dot(moves_[i].head<2>()) / mobility_[i][0];
  return sum;
}

/// Whether a joint is further open than Box2D leaves one that it has closed.
bool Planar::Core::Assembly::is_open(const FlatJoint& joint) const {
  const b2Vec2 a = joint.b2->GetAnchorA(), b = joint.b2->GetAnchorB();
  Vector2 way = vector_of(b) - vector_of(a);
  if (joint.is.kind == JointKind::Prismatic) {
    const Vector2 axis = core_.axis_of(joint);
    way -= way.dot(axis) * axis;
  }
  return way.squaredNorm() > double{b2_linearSlop} * double{b2_linearSlop};
}

void Planar::Core::Assembly::list_touching(std::pmr::vector<Island::Apart>& all) const {
  for (const Link& link : links_)
    for (b2ContactEdge* edge = link.flat->b2->GetContactList(); edge; edge = edge->next) {
      if (!edge->contact->IsTouching() || edge->contact->GetManifold()->pointCount == 0) continue;
      b2WorldManifold where;
      edge->contact->GetWorldManifold(&where);
      all.push_back({edge->contact, {where.separations[0], where.separations[1]}});
    }
}

namespace {

/// Whether a contact overlaps deeper than it did, and than what rests does.
bool is_deeper(const Planar::Core::Island::Apart& before) {
  constexpr float kSeen = 0.1F * b2_linearSlop;
  b2WorldManifold where;
  before.contact->GetWorldManifold(&where);
  for (int k = 0; k < before.contact->GetManifold()->pointCount; ++k)
    if (where.separations[k] < std::min(before.separations[k], -b2_linearSlop) - kSeen) return true;
  return false;
}

}  // namespace

/// Velocities are those that Box2D's bodies have.
void Planar::Core::Assembly::take_velocities() {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const b2Body& b = *links_[i].flat->b2;
    const b2Vec2 v = b.GetLinearVelocity();
    velocities_[i] = Vector(double{v.x}, double{v.y}, double{b.GetAngularVelocity()});
  }
}

/// The motion of the links among one another pays for an energy, in Box2D's units.
void Planar::Core::Assembly::pay(double energy) {
  if (!(energy > 0)) return;
  take_velocities();
  restore_energy(kinetic() - energy);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    b2Body& b = *links_[i].flat->b2;
    b.SetLinearVelocity(b2Vec2(static_cast<float>(velocities_[i].x()), static_cast<float>(velocities_[i].y())));
    b.SetAngularVelocity(static_cast<float>(velocities_[i].z()));
  }
}

FlatBody* Planar::Core::Assembly::close(double dt, std::pmr::vector<Island::Apart>& touching) {
  constexpr std::uint64_t kWork = 20;  // for each joint
  constexpr double kLifts = 0.01;      // of their motion among one another: what this may lift the links by
  if (!planned_ || core_.finishing) return nullptr;
  for (Link& link : links_) {
    link.flat = core_.find(link.body);
    const FlatBody* flat = link.flat;
    if (!flat || flat->fixed || flat->set_apart || flat->solved || !flat->b2->IsAwake() || !is_finite(*flat->b2))
      return nullptr;
  }
  bool any = false;
  for (const Member& member : joints_) {
    const FlatJoint& joint = core_.joints[member.joint];
    if (!joint.used || joint.serial != member.serial || !joint.b2) return nullptr;
    any = any || is_open(joint);
  }
  if (!any) return nullptr;
  core_.counters.work += kWork * joints_.size();
  load(dt);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const b2Body& b = *links_[i].flat->b2;
    after_[i] = FlatPose(vector_of(b.GetWorldCenter()), double{b.GetAngle()});
  }
  take_velocities();
  const double most = kLifts * motion_among();
  std::fill(velocities_.begin(), velocities_.end(), Vector::Zero());
  const auto listed = static_cast<std::ptrdiff_t>(touching.size());
  list_touching(touching);
  const double lifted = -close_gaps(most);
  const auto move_of = [this](std::size_t i) {
    const b2Body& b = *links_[i].flat->b2;
    const Vector2 way = after_[i].center - vector_of(b.GetWorldCenter());
    return Vector3(way.x(), way.y(), after_[i].angle - double{b.GetAngle()});
  };
  MovedBack back;
  for (std::size_t i = 0; i < links_.size(); ++i) back.add(*links_[i].flat, move_of(i));
  for (std::size_t i = 0; i < links_.size(); ++i) {
    back.stop(*links_[i].flat, move_of(i));
    put(i);
  }
  pay(lifted);
  return std::any_of(touching.begin() + listed, touching.end(), is_deeper) ? links_.front().flat : nullptr;
}

/// Once all are closed, overlaps are put right once for each island, however many of its assemblies were open.
void Planar::Core::close_joints(double dt) {
  if (members_changed || !articulations_known) return;
  std::pmr::vector<Island::Apart> touching(memory);
  std::pmr::vector<FlatBody*> pressed(memory);
  for (const std::unique_ptr<Assembly>& one : articulations)
    if (FlatBody* link = one->close(dt, touching)) pressed.push_back(link);
  if (pressed.empty()) return;
  // A contact between two assemblies counts as it was before the first of them was closed.
  std::stable_sort(touching.begin(), touching.end(), Island::Apart::sooner);
  for (FlatBody& flat : slots) flat.gathered = false;
  for (FlatBody* link : pressed) {
    if (link->gathered) continue;
    Island island(*this, dt);
    island.gather(*link);
    island.keep_apart(touching);
  }
}

}  // namespace breve
