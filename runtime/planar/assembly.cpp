// Box2D moves links along the tangents of their paths, and then pulls their joints together without changing
// velocities. Angular momentum and energy of what rotates are lost in this way, and where its sweeps have not
// converged, links are lifted for nothing. So the sub-step of an assembly that nothing pushes is solved again, as
// RATTLE does (Andersen 1983): impulses of the joints at the old pose, such that all joints hold at the new one, then
// impulses at the new pose such that the velocities are allowed there. Gravity acts in halves before and after. Momenta
// are kept exactly, and the energy errs by the square of the sub-step without drift. Which motors and limits hold
// is at first what Box2D has found.
#include "runtime/planar/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/planar/doors.hpp"

namespace breve {

namespace {

/// How the velocity of a point along a direction follows from (x, y, angular) of a body.
JointSystem::Vector row_of(const Vector2& along, const Vector2& arm) {
  return {along.x(), along.y(), cross(arm, along)};
}

}  // namespace

Planar::Core::Assembly::Assembly(Core& core, BodyIndex first)
    : core_(core),
      links_(core.memory),
      joints_(core.memory),
      system_(core.memory),
      before_(core.memory),
      after_(core.memory),
      mobility_(core.memory),
      velocities_(core.memory),
      moves_(core.memory),
      forces_(core.memory),
      rates_(core.memory) {
  std::pmr::vector<BodyIndex> all(core.memory);
  core.collect(first, all);
  Numbers numbers(core.memory);
  for (const BodyIndex body : all) {
    numbers.emplace_back(body, static_cast<int>(links_.size()));
    links_.push_back({body, nullptr});
  }
  std::sort(numbers.begin(), numbers.end());
  collect_joints(numbers);
  std::pmr::vector<JointSystem::Ends> ends(core.memory);
  for (const Member& member : joints_) {
    const JointDescription& is = core.joints[member.joint].is;
    ends.push_back({number_of(numbers, is.parent), number_of(numbers, is.child)});
  }
  planned_ = system_.plan(ends);
  if (!planned_) return;
  before_.resize(links_.size());
  after_.resize(links_.size());
  mobility_.assign(links_.size(), Vector::Zero());
  velocities_ = moves_ = forces_ = mobility_;
  rates_.assign(joints_.size(), Vector::Zero());
}

/// -1: it does not move by itself.
int Planar::Core::Assembly::number_of(const Numbers& numbers, BodyIndex body) {
  const auto found = std::lower_bound(numbers.begin(), numbers.end(), std::pair(body, 0));
  return found == numbers.end() || found->first != body ? -1 : found->second;
}

/// Those of the body that was found last come first: in a tree, from its leaves to its root.
void Planar::Core::Assembly::collect_joints(const Numbers& numbers) {
  std::pmr::vector<JointIndex> found(core_.memory);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const auto at = core_.joints_at.find(links_[i].body);
    if (at == core_.joints_at.end()) continue;
    for (const JointIndex joint : at->second) {
      const JointDescription& is = core_.joints[joint].is;
      // A joint belongs to the body of its two that was found later.
      const BodyIndex other = is.parent == links_[i].body ? is.child : is.parent;
      if (number_of(numbers, other) < static_cast<int>(i)) found.push_back(joint);
    }
  }
  for (auto joint = found.rbegin(); joint != found.rend(); ++joint) {
    const FlatJoint& entry = core_.joints[*joint];
    Member member;
    member.joint = *joint;
    member.serial = entry.serial;
    member.kind = entry.is.kind;
    joints_.push_back(member);
  }
}

bool Planar::Core::Assembly::connects_script(const JointDescription& is) const {
  for (const BodyIndex end : {is.parent, is.child})
    if (const FlatBody* flat = end == kNoBody ? nullptr : core_.find(end); flat && flat->driven) return true;
  return false;
}

/// Whether what touches a body pushed it in this sub-step, or is to be moved out of it.
bool Planar::Core::Assembly::is_pushed(const FlatBody& flat) {
  if (flat.touching == 0) return false;
  for (b2ContactEdge* edge = flat.b2->GetContactList(); edge; edge = edge->next) {
    if (!edge->contact->IsTouching()) continue;
    b2WorldManifold where;
    edge->contact->GetWorldManifold(&where);
    const b2Manifold& manifold = *edge->contact->GetManifold();
    for (int k = 0; k < manifold.pointCount; ++k)
      if (manifold.points[k].normalImpulse > 0 || where.separations[k] < -b2_linearSlop) return true;
  }
  return false;
}

/// Whether all are awake and step, and nothing but joints and forces acted on them.
bool Planar::Core::Assembly::may_move() {
  if (!planned_) return false;
  for (Link& link : links_) {
    link.flat = core_.find(link.body);
    const FlatBody* flat = link.flat;
    if (!flat || flat->fixed || flat->set_apart || is_pushed(*flat) || !flat->b2->IsAwake()) return false;
    if (flat->given != b2Vec2(0, 0) || flat->given_spin != 0 || !is_finite(*flat->b2)) return false;
  }
  return std::all_of(joints_.begin(), joints_.end(), [this](const Member& member) {
    const FlatJoint& joint = core_.joints[member.joint];
    return joint.used && joint.serial == member.serial && joint.b2 && !connects_script(joint.is);
  });
}

void Planar::Core::Assembly::load(double dt) {
  const double u = core_.settings.unit;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const FlatBody& flat = *links_[i].flat;
    const double inverse = 1 / flat.mass.mass;
    mobility_[i] = Vector(inverse, inverse, u * u / flat.mass.inertia(2, 2));
    const Vector2 force = (flat.force + flat.asked + flat.pull) / u;
    forces_[i] = mobility_[i].cwiseProduct(Vector(force.x(), force.y(), (flat.torque + flat.twist) / (u * u)));
    before_[i] = pose_before(flat);
    links_[i].eccentric = false;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) load_joint(i, dt);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    joints_[i].travel = travel_of(i, before_);
    aim(joints_[i], dt);
    take_spring(i);
  }
}

FlatPose Planar::Core::Assembly::pose_before(const FlatBody& flat) {
  return {vector_of(flat.at), double{flat.before_angle}};
}

void Planar::Core::Assembly::load_joint(std::size_t index, double dt) {
  Member& member = joints_[index];
  const FlatJoint& joint = core_.joints[member.joint];
  const JointDescription& is = joint.is;
  const double u = core_.settings.unit;
  const FlatBody* parent = is.parent == kNoBody ? nullptr : core_.find(is.parent);
  const FlatBody* child = core_.find(is.child);
  const auto center = [](const FlatBody* flat) {
    return flat ? vector_of(flat->b2->GetLocalCenter()) : Vector2(Vector2::Zero());
  };
  member.parent_point = is.parent_point.head<2>() / u - center(parent);
  member.child_point = is.child_point.head<2>() / u - center(child);
  member.axis = is.normal.head<2>();
  member.reference = double{reference_of(joint)};
  const auto pose_now = [](const FlatBody* flat) {
    if (!flat) return FlatPose();
    return FlatPose(vector_of(flat->b2->GetWorldCenter()), double{flat->b2->GetAngle()});
  };
  const JointSystem::Ends& ends = system_.ends(index);
  if (ends.parent < 0) member.parent = pose_now(parent);
  if (ends.child < 0) member.child = pose_now(child);
  for (const auto& [end, point] : {std::pair{ends.parent, &member.parent_point}, {ends.child, &member.child_point}}) {
    if (end < 0) continue;
    // A joint near the center of a link does not move as the link rotates.
    constexpr double kNear = 0.01;
    const Vector& m = mobility_[static_cast<std::size_t>(end)];
    if (point->squaredNorm() * m[2] > kNear * m[0]) links_[static_cast<std::size_t>(end)].eccentric = true;
  }
  note_drive(member, dt);
}

std::pair<FlatPose, FlatPose> Planar::Core::Assembly::ends_of(std::size_t index,
                                                              std::span<const FlatPose> poses) const {
  const JointSystem::Ends& ends = system_.ends(index);
  return {ends.parent < 0 ? joints_[index].parent : poses[static_cast<std::size_t>(ends.parent)],
          ends.child < 0 ? joints_[index].child : poses[static_cast<std::size_t>(ends.child)]};
}

/// By how much a joint is open, and how far a locked one is along its own axis: length units or rad.
Planar::Core::Assembly::Vector Planar::Core::Assembly::gap_of(std::size_t index,
                                                              std::span<const FlatPose> poses) const {
  const Member& member = joints_[index];
  const auto [parent, child] = ends_of(index, poses);
  const Vector2 way = child.point(member.child_point) - parent.point(member.parent_point);
  const double rotation = child.angle - parent.angle - member.reference;
  switch (member.kind) {
    case JointKind::Revolute: return {way.x(), way.y(), member.locked ? rotation : 0};
    case JointKind::Prismatic: {
      const Vector2 axis = parent.rotated(member.axis);
      return {way.dot(left_of(axis)), member.locked ? way.dot(axis) : 0, rotation};
    }
    default: return {way.x(), way.y(), rotation};
  }
}

void Planar::Core::Assembly::linearize(std::span<const FlatPose> poses, double softness) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Member& member = joints_[i];
    const auto [parent, child] = ends_of(i, poses);
    JointSystem::Rates& rates = system_.rates(i);
    rates.parent.setZero();
    rates.child.setZero();
    const Vector2 arm = child.rotated(member.child_point);
    Vector2 parent_arm = parent.rotated(member.parent_point), first(1, 0), second(0, 1);
    const bool slides = member.kind == JointKind::Prismatic;
    if (slides) {  // its axes rotate with the parent
      parent_arm = child.center + arm - parent.center;
      second = parent.rotated(member.axis);
      first = left_of(second);
    }
    rates.child.row(0) = row_of(first, arm);
    rates.parent.row(0) = -row_of(first, parent_arm);
    if (!slides || member.locked) {
      rates.child.row(1) = row_of(second, arm);
      rates.parent.row(1) = -row_of(second, parent_arm);
    }
    if (member.kind == JointKind::Revolute && !member.locked) continue;
    rates.child(2, 2) = 1;
    rates.parent(2, 2) = -1;
  }
  system_.factor(mobility_, softness);
}

/// The part of a link's forces that acts before it moves: those of springs in flight are meant for halves.
double Planar::Core::Assembly::early(const Link& link) { return link.flat->flies ? 0.5 : 1; }

/// The impulses of h seconds: half of gravity, the early part of the forces, and of motors that are at their strength.
/// @param part  of the sub-step that this is
void Planar::Core::Assembly::add_loads(double h, double part) {
  const Vector2 fall = h / 2 * vector_of(core_.b2->GetGravity());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    velocities_[i] += early(links_[i]) * h * forces_[i];
    velocities_[i].head<2>() += fall;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i)
    push(i, part * joints_[i].load + early(i) * h * joints_[i].spring, before_);
}

/// How the rate of the axis of its own follows from the velocities of parent and child.
std::pair<Planar::Core::Assembly::Vector, Planar::Core::Assembly::Vector> Planar::Core::Assembly::axis_rows(
    std::size_t index, std::span<const FlatPose> poses) const {
  if (joints_[index].kind == JointKind::Revolute) return {-Vector::UnitZ(), Vector::UnitZ()};
  const Member& member = joints_[index];
  const auto [parent, child] = ends_of(index, poses);
  const Vector2 arm = child.rotated(member.child_point), axis = parent.rotated(member.axis);
  return {-row_of(axis, child.center + arm - parent.center), row_of(axis, arm)};
}

void Planar::Core::Assembly::advance_poses(double dt) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Vector& v = velocities_[i];
    after_[i] = FlatPose(before_[i].center + dt * v.head<2>(), before_[i].angle + dt * v[2]);
  }
}

/// Takes the rates that the joints have beyond what they allow off all velocities.
void Planar::Core::Assembly::give_rates() {
  for (Vector& rate : rates_) rate = -rate;
  system_.solve(rates_);
  system_.spread(rates_, velocities_);
  for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i].impulse += rates_[i];
}

/// Impulses at the old pose, such that the joints are as open at the new one as they were. Whether they were found.
bool Planar::Core::Assembly::find_path(double dt) {
  constexpr int kMost = 12;        // times
  constexpr double kExact = 1e-7;  // length units or rad
  constexpr double kGood = 1e-5;   // the same: the rest is closed afterwards
  constexpr double kConverges = 0.7;
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMost; ++i) {
    advance_poses(dt);
    double worst = 0;
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      const Member& member = joints_[k];
      rates_[k] = (gap_of(k, after_) - member.gap) / dt;
      if (member.locked) rates_[k][member.free_row()] -= member.target;
      worst = std::max(worst, rates_[k].cwiseAbs().maxCoeff());
    }
    if (i > 0 && worst * dt < kExact) return true;  // in a short sub-step the first look would be good enough
    if (!(worst < kConverges * last)) return worst * dt < kGood;
    last = worst;
    give_rates();
  }
  return last * dt < kGood;
}

/// Impulses at the new pose, after which its joints allow the velocities.
/// @param ends  the sub-step, where limits are reached
void Planar::Core::Assembly::allow(double h, bool ends) {
  const Vector2 fall = h / 2 * vector_of(core_.b2->GetGravity());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    velocities_[i] += (1 - early(links_[i])) * h * forces_[i];
    velocities_[i].head<2>() += fall;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) push(i, (1 - early(i)) * h * joints_[i].spring, after_);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Member& member = joints_[i];
    rates_[i] = system_.rate_of(i, velocities_);
    if (member.locked && !(ends && member.limited())) rates_[i][member.free_row()] -= member.target;
  }
  give_rates();
}

/// Box2D's body is where the link has come to.
void Planar::Core::Assembly::put(std::size_t link) {
  b2Body& b = *links_[link].flat->b2;
  const FlatPose& at = after_[link];
  const b2Vec2 center(static_cast<float>(at.center.x()), static_cast<float>(at.center.y()));
  const auto angle = static_cast<float>(at.angle);
  if (center != b.GetWorldCenter() || angle != b.GetAngle())
    b.SetTransform(center - b2Mul(b2Rot(angle), b.GetLocalCenter()), angle);
}

void Planar::Core::Assembly::keep(double dt) {
  constexpr double kSingle = 1e-7;  // what single precision leaves of a number
  const double unseen = kSingle * dt * double{core_.b2->GetGravity().Length()};
  for (std::size_t i = 0; i < links_.size(); ++i) {
    FlatBody& flat = *links_[i].flat;
    b2Body& b = *flat.b2;
    // What rests stays at rest, but for what single precision makes of the loads.
    for (double& v : velocities_[i])
      if (std::abs(v) < unseen) v = 0;
    put(i);
    const float slow = sleep_time(b);  // a velocity that is set would begin it anew
    b.SetLinearVelocity(b2Vec2(static_cast<float>(velocities_[i].x()), static_cast<float>(velocities_[i].y())));
    b.SetAngularVelocity(static_cast<float>(velocities_[i].z()));
    sleep_time(b) = slow;
    flat.solved = true;
    flat.kicked = false;  // its velocity is that of the end
  }
  for (const Member& member : joints_) keep_impulses(member);
}

/// The next step of Box2D starts from the impulses of this one.
void Planar::Core::Assembly::keep_impulses(const Member& member) {
  const Vector& given = member.impulse;
  WarmJoint warm;
  warm.x = static_cast<float>(given.x());
  warm.y = static_cast<float>(member.kind == JointKind::Prismatic ? given.z() : given.y());
  if (member.kind == JointKind::Fixed) warm.angular = static_cast<float>(given.z());
  const auto driven = static_cast<float>(member.locked ? given[member.free_row()] : member.load);
  if (member.locked && std::isfinite(member.low))
    warm.lower = std::max(driven, 0.0F);
  else if (member.locked && std::isfinite(member.high))
    warm.upper = std::max(-driven, 0.0F);
  else if (member.kind != JointKind::Fixed)
    warm.motor = driven;
  core_.set_warm(core_.joints[member.joint], warm);
  core_.joints[member.joint].work = member.work * core_.settings.unit * core_.settings.unit;
}

/// One of the parts in which what rotates far takes a sub-step. Whether it has a solution.
bool Planar::Core::Assembly::take(double h, double part, bool last) {
  constexpr double kLifts = 0.05;  // of the energy of motion: what closing joints may lift the links by
  linearize(before_);
  begin_works(before_);
  add_loads(h, part);
  for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i].gap = gap_of(i, before_);
  if (!find_path(h)) return false;
  end_works(before_, part);
  work_ += work_along_path(h);
  linearize(after_);
  work_ += close_gaps(kLifts * kinetic());  // which is paid for by the motion
  begin_works(after_);
  allow(h, last);
  end_works(after_, 0);
  return std::all_of(velocities_.begin(), velocities_.end(), [](const Vector& v) { return v.allFinite(); });
}

/// From where the sub-step began to its end.
bool Planar::Core::Assembly::take_all(double dt, int parts) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const FlatBody& flat = *links_[i].flat;
    before_[i] = pose_before(flat);
    velocities_[i] = Vector(double{flat.before.x}, double{flat.before.y}, double{flat.before_spin});
  }
  linearize(before_);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    rates_[i] = system_.rate_of(i, velocities_);
    if (!joints_[i].locked) continue;
    joints_[i].rate = rates_[i][joints_[i].free_row()];
    rates_[i][joints_[i].free_row()] = 0;
  }
  const double had = kinetic();
  give_rates();                   // what contacts left, the joints may not allow
  constexpr double kSeen = 1e-9;  // of it: less is round-off of single precision
  torn_ = had - kinetic();
  if (!(torn_ > kSeen * had)) torn_ = 0;
  for (Member& member : joints_) {
    member.impulse.setZero();
    member.work = 0;
  }
  const double began = kinetic();
  work_ = 0;
  for (int i = 0; i < parts; ++i) {
    if (i > 0) before_.swap(after_);
    if (!take(dt / parts, 1.0 / parts, i + 1 == parts)) return false;
  }
  settle_energy(began, dt);
  return true;
}

void Planar::Core::Assembly::move(double dt) {
  constexpr double kRotation = 0.2;                      // rad, of a part
  constexpr int kUsualParts = 8, kMostParts = 128;       // more than usual only where there is no other solution
  constexpr double kFineRotation = 0.02, kExact = 1e-7;  // rad; of the energy of motion
  constexpr int kFineParts = 32;                         // where that energy would not be kept
  constexpr int kMostChanges = 8;                        // of what motors and limits hold
  constexpr std::uint64_t kWork = 20;                    // for each joint and part
  if (core_.finishing || !may_move()) return;
  load(dt);
  double fastest = 0;
  for (const Link& link : links_)
    if (link.eccentric) fastest = std::max(fastest, std::abs(double{link.flat->before_spin}));
  int parts = 1;
  while (parts < kUsualParts && fastest * dt > kRotation * parts) parts *= 2;
  for (int i = 0; parts <= kMostParts; ++i) {
    core_.counters.work += kWork * joints_.size() * static_cast<std::uint64_t>(parts);
    if (!take_all(dt, parts)) {
      parts *= 2;
      continue;
    }
    if (i < kMostChanges && (release() || catch_up(dt))) continue;
    if (parts < kFineParts && fastest * dt > kFineRotation * parts && std::abs(missing_) > kExact * kinetic()) {
      parts *= 2;
      continue;
    }
    const double u = core_.settings.unit;
    core_.ledger.limit_loss += lost_ * u * u;
    core_.ledger.contact_loss += torn_ * u * u;
    return keep(dt);
  }
}

void Planar::Core::number_joints() {
  articulations.clear();
  for (std::uint32_t i = 0; i < slots.size(); ++i)
    if (slots[i].body != kNoBody && !slots[i].fixed && slots[i].assembly == i)
      articulations.push_back(std::make_unique<Assembly>(*this, slots[i].body));
  articulations_known = true;
}

void Planar::Core::move_assemblies(double dt) {
  if (members_changed) return;  // a handler has changed them in this step
  if (!articulations_known) number_joints();
  for (const std::unique_ptr<Assembly>& one : articulations) one->move(dt);
}

void Planar::Core::take_back_gains(double dt) {
  if (members_changed || !articulations_known) return;
  for (const std::unique_ptr<Assembly>& one : articulations) one->take_back(dt);
}

}  // namespace breve
