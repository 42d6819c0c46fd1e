// Smooth motion, without contacts: clusters of trees by their integrator, free bodies by rules of their own.
#include "runtime/dynamics/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/articulated/rotation.hpp"
#include "runtime/base/error.hpp"
#include "runtime/base/rotation_vector.hpp"
#include "runtime/dynamics/network_motion.hpp"
#include "runtime/dynamics/spring_network.hpp"
#include "runtime/dynamics/stage.hpp"
#include "runtime/kinematics/free_motion.hpp"

namespace breve {

// --- clusters -------------------------------------------------------------------------------------------------------

ClusterEntry::ClusterEntry(std::pmr::memory_resource* memory) : trees(memory), springs(memory), wholes(memory) {}
ClusterEntry::~ClusterEntry() = default;

namespace {

/// Springs of a cluster of bodies without joints.
void make_network(const Dynamics::Core& core, ClusterEntry& entry, std::span<Tree* const> members) {
  std::pmr::memory_resource* memory = core.memory;
  entry.network = make_in<SpringNetwork>(memory, memory, members);
  if (members.size() > 1) entry.points = make_in<NetworkMotion>(memory, memory, members);
  for (std::size_t i = 0; i < members.size(); ++i) members[i]->slot = static_cast<int>(i);
  const auto number_of = [&core](BodyIndex body) {
    const BodyEntry* known = core.find(body);
    return !known || known->tree == kNone ? -1 : core.trees[known->tree]->slot;
  };
  for (const SpringIndex spring : entry.springs) {
    const int a = number_of(core.springs[spring].is.a), b = number_of(core.springs[spring].is.b);
    entry.network->add(spring, a, b);
    if (entry.points) entry.points->add(core, spring, a, b);
  }
}

/// Trees that springs connect stand together in a cluster that force methods connect, in the order of their first one.
/// @param sprung  by tree: one of those that springs connect with it, the same one for all of these
void order_wholes(ClusterEntry& entry, std::span<const std::uint32_t> sprung) {
  entry.asked = true;
  std::pmr::vector<std::size_t> place(sprung.size(), sprung.size(), entry.trees.get_allocator().resource());
  const auto place_of = [&](std::uint32_t tree) -> std::size_t& { return place[sprung[tree]]; };
  for (std::size_t i = 0; i < entry.trees.size(); ++i) place_of(entry.trees[i]) = std::min(place_of(entry.trees[i]), i);
  std::stable_sort(entry.trees.begin(), entry.trees.end(),
                   [&](std::uint32_t x, std::uint32_t y) { return place_of(x) < place_of(y); });
  for (std::size_t i = 1; i <= entry.trees.size(); ++i)
    if (i == entry.trees.size() || place_of(entry.trees[i]) != place_of(entry.trees[i - 1])) entry.wholes.push_back(i);
}

/// Sets of trees.
class Sets {
 public:
  Sets(std::size_t trees, std::pmr::memory_resource* memory) : set_(trees, memory) {
    std::iota(set_.begin(), set_.end(), 0U);
  }
  std::uint32_t of(std::uint32_t tree) {
    while (set_[tree] != tree) tree = set_[tree] = set_[set_[tree]];
    return tree;
  }
  void join(std::uint32_t a, std::uint32_t b) { set_[of(a)] = of(b); }

 private:
  std::pmr::vector<std::uint32_t> set_;
};

/// Force methods may look at one another's bodies: at each stage all of these are to stand where the stage is.
/// @return  one of their trees, or kNone
std::uint32_t join_asked(std::span<const BodyEntry> entries, Sets& sets) {
  std::uint32_t asked = kNone;
  for (const BodyEntry& entry : entries) {
    if (entry.body == kNoBody || !entry.force_method || entry.tree == kNone) continue;
    if (asked == kNone) asked = entry.tree;
    sets.join(entry.tree, asked);
  }
  return asked;
}

}  // namespace

void Dynamics::Core::build_clusters() {
  clusters.clear();
  Sets sets(trees.size(), memory);
  const auto tree_of = [this](BodyIndex body) {
    const BodyEntry* known = find(body);
    return known ? known->tree : kNone;
  };
  for (const SpringEntry& spring : springs) {
    if (!spring.used) continue;
    const std::uint32_t a = tree_of(spring.is.a), b = tree_of(spring.is.b);
    if (a != kNone && b != kNone) sets.join(a, b);
  }
  std::pmr::vector<std::uint32_t> sprung(trees.size(), kNone, memory);
  for (const std::uint32_t index : tree_order) sprung[index] = sets.of(index);
  const std::uint32_t asked = join_asked(entries, sets);
  std::pmr::vector<ClusterEntry*> of(trees.size(), nullptr, memory);
  for (const std::uint32_t index : tree_order) {
    ClusterEntry*& entry = of[sets.of(index)];
    if (!entry) {
      clusters.push_back(make_in<ClusterEntry>(memory, memory));
      entry = clusters.back().get();
    }
    entry->trees.push_back(index);
  }
  if (asked != kNone) order_wholes(*of[sets.of(asked)], sprung);
  for (SpringIndex i = 0; i < springs.size(); ++i) {
    if (!springs[i].used) continue;
    std::uint32_t tree = tree_of(springs[i].is.a);
    if (tree == kNone) tree = tree_of(springs[i].is.b);
    if (tree != kNone) of[sets.of(tree)]->springs.push_back(i);
  }
  for (const auto& entry : clusters) {
    std::pmr::vector<Tree*> members(memory);
    for (const std::uint32_t index : entry->trees) {
      members.push_back(trees[index].get());
      for (TreeLink& link : trees[index]->links)
        link.motor = link.joint != kNoJoint && joints[link.joint].drive.strength_limit > 0;
    }
    const Accuracy* finest = nullptr;
    for (const Tree* tree : members) {
      const Accuracy& one = accuracy_of(tree->links.front().body);
      if (!finest || finer(one.rung, finest->rung)) finest = &one;
    }
    entry->system = make_in<Cluster>(memory, memory, members, *finest, settings.unit, entry->asked);
    if (!entry->springs.empty() && SpringNetwork::are(members)) make_network(*this, *entry, members);
  }
  // Not before: what memory cut short is made anew.
  clusters_changed = integrators_changed = false;
}

bool finer(Rung a, Rung b) {
  // Conserving stands between balanced and precise: it is exact in other things.
  constexpr int kOrder[] = {0, 1, 3, 4, 2};
  return kOrder[static_cast<int>(a)] > kOrder[static_cast<int>(b)];
}

// --- free bodies ----------------------------------------------------------------------------------------------------

FreeBody read_free(const Bodies& bodies, BodyIndex body) {
  const MassProperties& solid = bodies.mass_properties(body);
  FreeBody free;
  free.solid = &solid;
  free.orientation = bodies.orientation(body);
  free.spin = bodies.rotational_velocity(body);
  const Vector3 arm = free.orientation * solid.center_of_mass;
  free.center = bodies.location(body) + arm;
  free.velocity = bodies.velocity(body) + free.spin.cross(arm);
  free.force = bodies.force(body);
  free.torque = bodies.torque(body);
  return free;
}

void write_free(Bodies& bodies, BodyIndex body, const FreeBody& free) {
  const Vector3 arm = free.orientation * free.solid->center_of_mass;
  bodies.set_motion(body, free.center - arm, free.orientation, free.velocity - free.spin.cross(arm), free.spin);
}

namespace {

/// The spin and attitude of one body, as a system for integrators: q the quaternion, v the spin in its own axes.
class Spin final : public articulated::System {
 public:
  Spin(const FreeBody& body, Meter& meter)
      : body_(body), meter_(meter), inverse_(Eigen::Matrix3d(body.solid->inertia).inverse()) {}

  int positions() const override { return 4; }
  int velocities() const override { return 3; }
  articulated::Kind kind(int) const override { return articulated::Kind::Angle; }
  void acceleration(double, const articulated::Vector& q, const articulated::Vector& v, double,
                    articulated::Vector& a) override {
    meter_.add(1);
    const Vector3 spin = v, torque = Quaternion(q[0], q[1], q[2], q[3]).conjugate() * body_.torque;
    a = inverse_ * (torque - spin.cross(body_.solid->inertia * spin));
  }
  void move(const articulated::Vector& q, const articulated::Vector& d, articulated::Vector& out) override {
    const Quaternion rotated = (Quaternion(q[0], q[1], q[2], q[3]) * rotation_by(d.head<3>())).normalized();
    out.resize(4);
    out << rotated.w(), rotated.x(), rotated.y(), rotated.z();
  }
  void rate_of_move(const articulated::Vector& d, const articulated::Vector& v, articulated::Vector& out) override {
    out = articulated::rate_of_rotation_vector(d.head<3>(), v.head<3>());
  }
  void bend_to_cayley(articulated::Vector& d) override { d = articulated::cayley(d.head<3>()); }
  bool over() const override { return meter_.over(); }

 private:
  const FreeBody& body_;
  Meter& meter_;
  const Eigen::Matrix3d inverse_;
};

void rotate_by_scheme(FreeBody& body, const Accuracy& accuracy, double time, double h, double& next_step,
                      Meter& meter) {
  Spin system(body, meter);
  articulated::Settings settings;
  settings.tolerance.relative = accuracy.tolerance;
  settings.refine = true;
  articulated::Integrator integrator(system, accuracy.scheme, settings);
  articulated::Instant at;
  at.t = time;
  const Quaternion& o = body.orientation;
  at.q.resize(4);
  at.q << o.w(), o.x(), o.y(), o.z();
  at.v = o.conjugate() * body.spin;
  at.step = next_step;
  integrator.step(at, h);
  next_step = at.step;
  body.orientation = Quaternion(at.q[0], at.q[1], at.q[2], at.q[3]);
  body.spin = body.orientation * Vector3(at.v);
}

/// Implicit midpoint, and Cayley's rotation with it: the angular momentum stays in the world, size and direction.
void rotate_by_midpoint(FreeBody& body, double h) {
  const Quaternion to_own = body.orientation.conjugate();
  const Vector3 spin = to_own * body.spin, torque = to_own * body.torque;
  Vector3 middle, after;
  if (body.solid->round) {
    after = spin + (h / body.solid->inertia(0, 0)) * torque;
    middle = 0.5 * (spin + after);
  } else {
    after = advance_spin(body.solid->inertia, spin, torque, h, middle);
  }
  body.orientation = (body.orientation * rotation_by(articulated::cayley(h * middle))).normalized();
  body.spin = body.orientation * after;
}

}  // namespace

bool semi_implicit(const Accuracy& accuracy) {
  return accuracy.scheme == articulated::Scheme::SemiImplicitEuler && accuracy.rung != Rung::Fast;
}

void rotate_free(FreeBody& body, const Accuracy& accuracy, double time, double h, double& next_step, Meter& meter) {
  const bool still = body.spin == Vector3::Zero() && body.torque == Vector3::Zero();
  if (still) return;
  const bool plain = body.solid->round && body.torque == Vector3::Zero();
  if (plain) {
    // A round body without torque rotates at its rate: exact.
    body.orientation = (rotation_by(h * body.spin) * body.orientation).normalized();
  } else if (accuracy.implicit_spin) {
    rotate_by_midpoint(body, h);
  } else {
    rotate_by_scheme(body, accuracy, time, h, next_step, meter);
  }
}

double FreeBody::rotate(const Vector3& rotation, double unseen) {
  if (rotation == Vector3::Zero()) return 0;
  const Matrix3& own = solid->inertia;
  const Quaternion rotated = (rotation_by(rotation) * orientation).normalized();
  if (own == own(0, 0) * Matrix3::Identity() || rotation.norm() * spin.norm() <= unseen) {
    orientation = rotated;
    return 0;
  }
  const double before = kinetic();
  const Vector3 momentum = inertia() * spin;
  orientation = rotated;
  spin = orientation * own.ldlt().solve(orientation.conjugate() * momentum);
  return kinetic() - before;
}

void move_free(FreeBody& body, const Accuracy& accuracy, const Vector3& gravity, double time, double h,
               double& next_step, Meter& meter) {
  const Vector3 pull = gravity + body.force / body.solid->mass;
  if (semi_implicit(accuracy)) {
    body.velocity += h * pull;
    body.center += h * body.velocity;
  } else {
    // Nothing it depends on changes on the way: the parabola is exact.
    body.center += h * (body.velocity + (0.5 * h) * pull);
    body.velocity += h * pull;
  }
  rotate_free(body, accuracy, time, h, next_step, meter);
}

}  // namespace breve
