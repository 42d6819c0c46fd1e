// One solution of an island: its bodies, the rows of its contacts, limits and motors, and what becomes of the result.
#include "runtime/planar/island.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace breve {

namespace {

double travel_of(const b2RevoluteJoint& b) { return double{b.GetJointAngle()}; }
double travel_of(const b2PrismaticJoint& b) { return double{b.GetJointTranslation()}; }
double strength_of(const b2RevoluteJoint& b) { return double{b.GetMaxMotorTorque()}; }
double strength_of(const b2PrismaticJoint& b) { return double{b.GetMaxMotorForce()}; }

Vector2 arm_to(const FlatBody& flat, const b2Vec2& point) {
  return vector_of(point) - vector_of(flat.b2->GetWorldCenter());
}

}  // namespace

void Planar::Core::Island::add_body(FlatBody& flat) {
  if (flat.fixed || flat.gathered) return;
  flat.gathered = true;
  flat.part = kNoSlot;
  bodies_.push_back(&flat);
}

void Planar::Core::Island::add_joints(const FlatBody& flat) {
  const auto found = core_.joints_at.find(flat.body);
  if (found == core_.joints_at.end()) return;
  for (const JointIndex index : found->second) {
    FlatJoint& joint = core_.joints[index];
    if (!joint.b2) continue;
    joints_.push_back(&joint);
    for (const BodyIndex end : {joint.is.parent, joint.is.child})
      if (FlatBody* other = end == kNoBody ? nullptr : core_.find(end)) add_body(*other);
  }
}

void Planar::Core::Island::gather(FlatBody& first) {
  add_body(first);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    b2Body* b2 = bodies_[i]->b2;
    for (b2ContactEdge* edge = b2->GetContactList(); edge; edge = edge->next) {
      b2Contact* contact = edge->contact;
      if (!contact->IsTouching() || !contact->IsEnabled() || contact->GetManifold()->pointCount == 0) continue;
      FlatBody& other = core_.of(edge->other);
      // Once, though both its bodies may move.
      if (other.fixed || contact->GetFixtureA()->GetBody() == b2) contacts_.push_back(contact);
      add_body(other);
    }
    if (bodies_[i]->jointed) add_joints(*bodies_[i]);
  }
  // The order of Box2D's lists depends on the past, and on bodies far away.
  std::sort(bodies_.begin(), bodies_.end(), [](const FlatBody* p, const FlatBody* q) { return p->body < q->body; });
  std::sort(joints_.begin(), joints_.end(),
            [](const FlatJoint* p, const FlatJoint* q) { return p->serial < q->serial; });
  joints_.erase(std::unique(joints_.begin(), joints_.end()), joints_.end());
  const auto key = [this](b2Contact* contact) {
    const b2Fixture *a = contact->GetFixtureA(), *b = contact->GetFixtureB();
    return std::tuple(core_.of(a->GetBody()).body, core_.of(b->GetBody()).body, number_of(a), number_of(b),
                      contact->GetChildIndexA(), contact->GetChildIndexB());
  };
  std::sort(contacts_.begin(), contacts_.end(), [&key](b2Contact* p, b2Contact* q) { return key(p) < key(q); });
}

std::span<double> Planar::Core::Island::numbers(std::size_t count) {
  auto* made = static_cast<double*>(arena_.allocate(count * sizeof(double), alignof(double)));
  std::fill_n(made, count, 0.0);
  return {made, count};
}

/// Whether what joints connect is small enough to answer as a whole.
bool Planar::Core::Island::make_parts() {
  const double u = core_.settings.unit;
  for (FlatBody* flat : bodies_) {
    if (flat->jointed && flat->part != kNoSlot) continue;
    const auto index = static_cast<std::uint32_t>(parts_.size());
    flat->part = index;
    Part part{flat, nullptr, {}};
    contact::Mover mover;
    if (flat->jointed) {
      part.response = std::make_unique<Response>(core_, flat, nullptr);
      if (!part.response->holds()) return false;
      part.v = numbers(static_cast<std::size_t>(part.response->size()));
      for (FlatBody* body : part.response->bodies()) body->part = index;
      mover.size = static_cast<int>(part.response->size());
    } else {
      part.v = numbers(6);
      mover.inverse_mass = 1 / flat->mass.mass;
      mover.inverse_inertia(2, 2) = u * u / flat->mass.inertia(2, 2);
    }
    mover.v = part.v.data();
    movers_.push_back(mover);
    parts_.push_back(std::move(part));
  }
  return true;
}

/// All parts have the velocities with which the sub-step began.
void Planar::Core::Island::take_velocities() {
  for (Part& part : parts_) {
    if (!part.response) {
      const Vector3 v = part.first->velocity_before();
      part.v[0] = v[0];
      part.v[1] = v[1];
      part.v[5] = v[2];
      continue;
    }
    Response::Vector v(part.response->size());
    for (const FlatBody* body : part.response->bodies())
      v.segment<3>(part.response->index_of(*body)) = body->velocity_before();
    // Box2D's solver leaves velocities that the joints do not quite allow.
    Eigen::Map<Response::Vector>(part.v.data(), v.size()) = v + part.response->allowed(v);
  }
}

/// What a script moves gives way to nothing: another mover each time.
int Planar::Core::Island::driver(const FlatBody& flat) {
  constexpr double kImmovable = 1e-12;  // 1/kg and 1/(kg*m^2)
  const std::span<double> v = numbers(6);
  v[0] = double{flat.b2->GetLinearVelocity().x};
  v[1] = double{flat.b2->GetLinearVelocity().y};
  v[5] = double{flat.b2->GetAngularVelocity()};
  contact::Mover mover;
  mover.v = v.data();
  mover.inverse_mass = mover.inverse_inertia(2, 2) = kImmovable;
  movers_.push_back(mover);
  return static_cast<int>(movers_.size()) - 1;
}

/// A unit impulse at a body's point, and an angular one, as impulses on the bodies of its part.
Response::Vector Planar::Core::Island::load_of(const FlatBody& flat, const Vector2& arm, const Vector2& along,
                                               double rotation) {
  const Response& response = *part_of(flat).response;
  Response::Vector load = Response::Vector::Zero(response.size());
  load.segment<3>(response.index_of(flat)) = Vector3(along.x(), along.y(), cross(arm, along) + rotation);
  return load;
}

/// One body of a contact: what has no joints by its arm, another by matrices.
void Planar::Core::Island::add_side(contact::Row& row, bool first, const FlatBody& flat, const b2Vec2& point) {
  int& mover = first ? row.a : row.b;
  (first ? row.arm_a : row.arm_b).head<2>() = arm_to(flat, point);
  if (flat.fixed) {
    mover = flat.driven ? driver(flat) : -1;
    return;
  }
  mover = static_cast<int>(flat.part);
  if (part_of(flat).response) add_matrices(row, first ? &flat : nullptr, first ? nullptr : &flat, point);
}

/// Of one side; or of the first, with the difference of two bodies of one part.
void Planar::Core::Island::add_matrices(contact::Row& row, const FlatBody* a, const FlatBody* b, const b2Vec2& point) {
  const Response& response = *part_of(a ? *a : *b).response;
  const auto size = static_cast<std::size_t>(response.size());
  const std::span<double> j = numbers(3 * size), r = numbers(3 * size);
  for (std::size_t k = 0; k < 2; ++k) {  // nothing moves along the other tangent
    const Vector2 along = row.axes.row(static_cast<Eigen::Index>(k)).head<2>();
    Response::Vector load = Response::Vector::Zero(response.size());
    if (a) load += load_of(*a, arm_to(*a, point), along, 0);
    if (b) load += (a ? -1 : 1) * load_of(*b, arm_to(*b, point), along, 0);
    Eigen::Map<Response::Vector>(&j[k * size], response.size()) = load;
    Eigen::Map<Response::Vector>(&r[k * size], response.size()) = response.answer(load);
  }
  (a ? row.ja : row.jb) = j.data();
  (a ? row.ra : row.rb) = r.data();
}

void Planar::Core::Island::make_contact_rows() {
  constexpr double kYields = 1e-2;  // of the speed that a body which a script moves gives to all others
  const double mass = std::accumulate(bodies_.begin(), bodies_.end(), 0.0,
                                      [](double sum, const FlatBody* flat) { return sum + flat->mass.mass; });
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    b2Contact* contact = contacts_[i];
    const FlatBody &a = core_.of(contact->GetFixtureA()->GetBody()), &b = core_.of(contact->GetFixtureB()->GetBody());
    const contact::Law law = core_.law_of(a, b);
    b2WorldManifold where;
    contact->GetWorldManifold(&where);
    const Vector2 n = vector_of(where.normal), t = left_of(n);
    for (int k = 0; k < contact->GetManifold()->pointCount; ++k) {
      contact::Row row;
      row.axes << n.x(), n.y(), 0, t.x(), t.y(), 0, 0, 0, 1;
      row.static_friction = law.static_friction;
      row.dynamic_friction = law.dynamic_friction;
      row.pair = static_cast<int>(i);
      // Box2D's normal goes from a to b.
      if (!a.fixed && !b.fixed && a.part == b.part) {
        row.a = static_cast<int>(b.part);
        add_matrices(row, &b, &a, where.points[k]);
      } else {
        add_side(row, true, b, where.points[k]);
        add_side(row, false, a, where.points[k]);
        // So that bodies are not thrown out of wedges at any speed.
        if (a.driven || b.driven) row.softness = kYields / mass;
      }
      rows_.push_back(row);
    }
  }
}

/// The child's velocity along the axis of a joint that is free, less the parent's.
void Planar::Core::Island::add_drive_row(const Drive& drive) {
  const FlatJoint& joint = *drive.joint;
  const bool slides = joint.is.kind == JointKind::Prismatic;
  const Vector2 along = slides ? core_.axis_of(joint) : Vector2(0, 0);
  const b2Vec2 point = joint.b2->GetAnchorB();
  const FlatBody* child = core_.find(joint.is.child);
  const FlatBody* parent = joint.is.parent == kNoBody ? nullptr : core_.find(joint.is.parent);
  contact::ScalarRow row;
  Response::Vector load;
  for (const auto& [flat, sign] : {std::pair{child, 1.0}, std::pair{parent, -1.0}}) {
    if (!flat || flat->fixed) continue;
    row.a = static_cast<int>(flat->part);
    const Response::Vector one = sign * load_of(*flat, arm_to(*flat, point), along, slides ? 0 : 1);
    load = load.size() == 0 ? one : Response::Vector(load + one);
  }
  if (row.a < 0) return;
  const std::span<double> j = numbers(static_cast<std::size_t>(load.size()));
  const std::span<double> r = numbers(static_cast<std::size_t>(load.size()));
  Eigen::Map<Response::Vector>(j.data(), load.size()) = load;
  Eigen::Map<Response::Vector>(r.data(), load.size()) = parts_[static_cast<std::size_t>(row.a)].response->answer(load);
  row.ja = j.data();
  row.ra = r.data();
  scalars_.push_back(row);
  drives_.push_back(drive);
}

template <class Joint>
void Planar::Core::Island::add_drives(FlatJoint& joint, const Joint& b) {
  constexpr double kNoLimit = JointDrive::kNoLimit;
  if (b.IsMotorEnabled()) {
    const double most = strength_of(b) * dt_;
    add_drive_row({&joint, &WarmJoint::motor, 1, true, double{b.GetMotorSpeed()}, -most, most});
  }
  if (!b.IsLimitEnabled()) return;
  const double at = travel_of(b), below = at - double{b.GetLowerLimit()}, above = double{b.GetUpperLimit()} - at;
  constexpr double kReach = 0.2;  // rad or length units: what is further is left to the next sub-step
  if (below < kReach) add_drive_row({&joint, &WarmJoint::lower, 1, false, -std::max(below, 0.0) / dt_, 0, kNoLimit});
  if (above < kReach) add_drive_row({&joint, &WarmJoint::upper, -1, false, std::max(above, 0.0) / dt_, -kNoLimit, 0});
}

void Planar::Core::Island::add_drives(FlatJoint& joint) {
  if (joint.is.kind == JointKind::Revolute)
    add_drives(joint, *static_cast<const b2RevoluteJoint*>(joint.b2));
  else if (joint.is.kind == JointKind::Prismatic)
    add_drives(joint, *static_cast<const b2PrismaticJoint*>(joint.b2));
}

/// The impulses of the sub-step's forces on the bodies of a part.
Response::Vector Planar::Core::Island::forces_on(const Part& part) const {
  const double u = core_.settings.unit;
  const Response& response = *part.response;
  Response::Vector loads(response.size());
  for (const FlatBody* flat : response.bodies()) {
    const double m = flat->mass.mass;
    const Vector2 force = m * core_.settings.gravity.head<2>() + flat->force + flat->asked + flat->pull;
    loads.segment<3>(response.index_of(*flat)) =
        Vector3(force.x() / u, force.y() / u, (flat->torque + flat->twist) / (u * u)) * dt_;
  }
  return loads;
}

void Planar::Core::Island::add_forces() {
  const double u = core_.settings.unit;
  for (Part& part : parts_) {
    if (part.response) {
      Eigen::Map<Response::Vector>(part.v.data(), part.response->size()) += part.response->answer(forces_on(part));
      continue;
    }
    const FlatBody& flat = *part.first;
    const Vector2 force = flat.force + flat.asked + flat.pull;
    const Vector2 change = dt_ / u * (core_.settings.gravity.head<2>() + force / flat.mass.mass);
    part.v[0] += change.x();
    part.v[1] += change.y();
    part.v[5] += dt_ * (flat.torque + flat.twist) / flat.mass.inertia(2, 2);
  }
}

void Planar::Core::Island::solve_rows(bool impact) {
  for (contact::Row& row : rows_) row.impulse.setZero();
  for (std::size_t i = 0; i < scalars_.size(); ++i) {
    const Drive& drive = drives_[i];
    const bool idle = impact && drive.motor;
    scalars_[i].bias = drive.bias;
    scalars_[i].lo = idle ? 0 : drive.lo;
    scalars_[i].hi = idle ? 0 : drive.hi;
    scalars_[i].impulse = 0;
  }
  constexpr double kUnseen = 1e-3;  // of the speed that gravity gives in a sub-step
  constexpr double kLeast = 1e-6;   // m/s, without gravity
  solve(std::max(kUnseen * core_.settings.gravity.norm() * dt_, kLeast) / core_.settings.unit);
}

/// @param tolerance  of the rows, in Box2D's units
void Planar::Core::Island::solve(double tolerance) {
  contact::SolveSettings settings;
  constexpr std::size_t kFewest = 8, kMost = 200, kVisits = 8192;  // sweeps; rows that they visit
  const std::size_t rows = rows_.size() + scalars_.size();
  settings.iterations = static_cast<int>(std::clamp(kVisits / std::max<std::size_t>(rows, 1), kFewest, kMost));
  settings.direct = true;
  settings.direct_share = 3;
  settings.tolerance = tolerance;
  // An exact solution that is not found soon is not worth a frame's time: no energy comes from one that is not exact.
  constexpr std::uint64_t kUnits = 1500, kUnitsPerRow = 100;
  Meter meter;
  meter.begin(kUnits + kUnitsPerRow * rows, core_.bound.ended);
  settings.meter = &meter;
  contact::solve_island(movers_, rows_, scalars_, settings, workspace_);
  core_.counters.work += meter.done();
}

/// The work of what scripts move, by the impulses that contacts have now.
void Planar::Core::Island::book_drivers(double sign) {
  for (b2Contact* contact : contacts_) {
    const b2Manifold& manifold = *contact->GetManifold();
    b2ContactImpulse impulse;
    impulse.count = manifold.pointCount;
    for (int k = 0; k < manifold.pointCount; ++k) {
      impulse.normalImpulses[k] = static_cast<float>(sign) * manifold.points[k].normalImpulse;
      impulse.tangentImpulses[k] = static_cast<float>(sign) * manifold.points[k].tangentImpulse;
    }
    core_.note_driven_work(contact, impulse);
  }
}

/// Bodies move on by the velocities that they have now.
void Planar::Core::Island::write_bodies() {
  const auto dt = static_cast<float>(dt_);
  for (FlatBody* flat : bodies_) {
    const Part& part = part_of(*flat);
    const auto at = part.response ? static_cast<std::size_t>(part.response->index_of(*flat)) : 0;
    const b2Vec2 velocity(static_cast<float>(part.v[at]), static_cast<float>(part.v[at + 1]));
    const auto spin = static_cast<float>(part.response ? part.v[at + 2] : part.v[5]);
    b2Body& b = *flat->b2;
    const b2Vec2 center = b.GetWorldCenter() + dt * (velocity - b.GetLinearVelocity());
    const float angle = b.GetAngle() + dt * (spin - b.GetAngularVelocity());
    b.SetTransform(center - b2Mul(b2Rot(angle), b.GetLocalCenter()), angle);
    b.SetLinearVelocity(velocity);
    b.SetAngularVelocity(spin);
  }
}

void Planar::Core::Island::write_contacts() {
  std::size_t next = 0;
  for (b2Contact* contact : contacts_) {
    b2Manifold& manifold = *contact->GetManifold();
    for (int k = 0; k < manifold.pointCount; ++k) {
      const Vector3& impulse = rows_[next++].impulse;
      manifold.points[k].normalImpulse = static_cast<float>(impulse[0]);
      manifold.points[k].tangentImpulse = static_cast<float>(-impulse[1]);  // Box2D's tangent is to the right
    }
  }
}

/// The impulses that hold the bodies of each joint together against the forces and all other impulses.
void Planar::Core::Island::write_joints() {
  for (const Part& part : parts_) {
    if (!part.response) continue;
    Response::Vector loads = forces_on(part);
    for (const contact::Row& row : rows_)
      for (const auto& [mover, j, sign] : {std::tuple{row.a, row.ja, 1.0}, std::tuple{row.b, row.jb, -1.0}}) {
        if (!j || mover < 0 || &parts_[static_cast<std::size_t>(mover)] != &part) continue;
        for (int k = 0; k < 2; ++k)
          loads += sign * row.impulse[k] * Eigen::Map<const Response::Vector>(j + k * loads.size(), loads.size());
      }
    for (const contact::ScalarRow& row : scalars_)
      if (&parts_[static_cast<std::size_t>(row.a)] == &part)
        loads += row.impulse * Eigen::Map<const Response::Vector>(row.ja, loads.size());
    for (const auto& [joint, warm] : part.response->holding(loads)) core_.set_warm(core_.joints[joint], warm);
  }
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Drive& drive = drives_[i];
    WarmJoint warm = core_.warm_of(*drive.joint);
    warm.*drive.warm = static_cast<float>(drive.sign * scalars_[i].impulse);
    core_.set_warm(*drive.joint, warm);
  }
}

void Planar::Core::Island::solve() {
  if (!make_parts()) return;
  take_velocities();
  make_contact_rows();
  for (FlatJoint* joint : joints_) add_drives(*joint);
  book_drivers(-1);
  solve_rows(true);
  write_contacts();
  book_drivers(1);
  add_forces();
  solve_rows(false);
  write_contacts();
  book_drivers(1);
  write_joints();
  write_bodies();
}

}  // namespace breve
