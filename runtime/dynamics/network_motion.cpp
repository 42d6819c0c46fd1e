// Drifts of the points and kicks by the springs.
#include "runtime/dynamics/network_motion.hpp"

#include <algorithm>
#include <cmath>

namespace breve {

namespace {

// How far the fastest oscillation rotates in a part, rad. The scheme of order 4 is stable up to 2.6; energy errs by 3
// in 1,000 at 1, and by 4 in 100 at 1.75, where it is all in that oscillation. Leapfrog's period errs by 1 in 10,000 at
// 0.05.
constexpr double kPartPhase = 1, kPartPhaseFast = 1.75, kPartPhaseFew = 0.25, kSlowPhase = 0.05, kStablePhase = 2;
constexpr double kMostNetworkParts = 32;  // finer steps are left to step control
// So few springs have hardly any slower oscillations that hold the energy, and shorter parts of them cost nothing. On
// `fast`, contacts change from step to step how long these are, and each time what the energy errs by then remains.
constexpr std::size_t kFewSprings = 16;

bool acts_alone(const Dynamics::Core& core, const Tree& tree) {
  return !core.find(tree.links.front().body)->force_method;
}

}  // namespace

NetworkMotion::NetworkMotion(std::pmr::memory_resource* memory, std::span<Tree* const> trees)
    : trees_(trees.begin(), trees.end(), memory),
      points_(trees.size(), Point(), memory),
      pulls_(trees.size(), Vector3(Vector3::Zero()), memory),
      drags_(trees.size(), Vector3(Vector3::Zero()), memory),
      edges_(memory),
      still_(memory) {
  for (std::size_t i = 0; i < trees_.size(); ++i) points_[i].inverse_mass = 1 / trees_[i]->links.front().solid.mass;
}

void NetworkMotion::add(const Dynamics::Core& core, SpringIndex spring, int a, int b) {
  const SpringDescription& is = core.springs[spring].is;
  const auto number = [&](int end, BodyIndex body, const Vector3& at) {
    if (end >= 0) return end;
    still_.emplace_back(body, at);
    points_.emplace_back();
    drags_.push_back(Vector3::Zero());
    return static_cast<int>(points_.size()) - 1;
  };
  Edge edge{};
  edge.spring = spring;
  edge.a = number(a, is.a, is.point_a);
  edge.b = number(b, is.b, is.point_b);
  edges_.push_back(edge);
}

/// What only changes if somebody sets a spring.
bool NetworkMotion::read(const Dynamics::Core& core) {
  const auto bodies = static_cast<int>(trees_.size());
  std::pmr::vector<double> pulled(points_.size(), 0.0, core.memory);
  const auto central = [&](int end, const Vector3& at) {
    if (end < bodies) return at == trees_[static_cast<std::size_t>(end)]->links.front().origin;
    still_[static_cast<std::size_t>(end - bodies)].second = at;
    return true;
  };
  damped_ = false;
  for (Edge& edge : edges_) {
    const SpringDescription& is = core.springs[edge.spring].is;
    if (is.mode != SpringMode::Both || is.maximum_force != 0 || !central(edge.a, is.point_a) ||
        !central(edge.b, is.point_b))
      return false;
    edge.length = is.length;
    edge.strength = is.strength;
    edge.damping = is.damping;
    damped_ = damped_ || is.damping > 0;
    const auto a = static_cast<std::size_t>(edge.a), b = static_cast<std::size_t>(edge.b);
    edge.yields = points_[a].inverse_mass + points_[b].inverse_mass;
    pulled[a] += is.strength * points_[a].inverse_mass;
    pulled[b] += is.strength * points_[b].inverse_mass;
  }
  // Gershgorin's bound of the squares of frequencies, body by body.
  double most = 0;
  for (const Edge& edge : edges_)
    most = std::max(most, pulled[static_cast<std::size_t>(edge.a)] + pulled[static_cast<std::size_t>(edge.b)]);
  fastest_ = std::sqrt(most);
  part_ = 0;
  return true;
}

bool NetworkMotion::begin(const Dynamics::Core& core, Rung rung, double h) {
  constexpr double kMostPulls = 8192;  // springs times parts, on `fast`
  const bool fast = rung == Rung::Fast, few = edges_.size() <= kFewSprings;
  const double longest = fast ? kPartPhaseFast : kPartPhase;
  most_phase_ = few ? (fast ? kPartPhaseFew : kPartPhase) : longest;
  const double pulls = fast ? kMostPulls / static_cast<double>(edges_.size()) : 0;
  if (version_ != core.springs_version) {
    version_ = core.springs_version;
    plain_ = read(core);
  }
  if (!plain_ || !(fastest_ * h <= std::max(kMostNetworkParts * longest, pulls * most_phase_))) return false;
  for (std::size_t i = 0; i < still_.size(); ++i) {
    const auto& [body, at] = still_[i];
    if (core.bodies->velocity(body) != Vector3::Zero() || core.bodies->rotational_velocity(body) != Vector3::Zero())
      return false;
    const Pose pose = core.pose(body);
    points_[trees_.size() + i].center = pose.location + pose.orientation * at;
  }
  return std::all_of(trees_.begin(), trees_.end(), [&core](const Tree* tree) { return acts_alone(core, *tree); });
}

/// What a damper does in `part` seconds.
void NetworkMotion::set_part(double part) {
  if (part_ == part) return;
  part_ = part;
  for (Edge& edge : edges_) {
    const double rate = edge.damping * edge.yields * part;
    // (1 - exp(-rate)) / yields, and half of (1 - exp(-2 rate)) / yields.
    edge.share = edge.yields > 0 ? -std::expm1(-rate) / edge.yields : 0;
    edge.loss = edge.yields > 0 ? -0.5 * std::expm1(-2 * rate) / edge.yields : 0;
  }
}

void NetworkMotion::drift(double time) {
  for (std::size_t i = 0; i < trees_.size(); ++i) points_[i].center += time * points_[i].velocity;
}

/// @param scale  of the springs' forces
void NetworkMotion::kick(double time, double scale) {
  Point* const points = points_.data();
  const double share = time * scale;
  for (Edge& edge : edges_) {
    Point &a = points[edge.a], &b = points[edge.b];
    const Vector3 way = b.center - a.center;
    const double length = way.norm();
    edge.force = 0;
    if (!(length > 0)) continue;
    edge.force = edge.strength * (length - edge.length);
    const double push = share * edge.force / length;
    const double to_a = push * a.inverse_mass, to_b = push * b.inverse_mass;
    a.velocity += to_a * way;
    b.velocity -= to_b * way;
  }
  for (std::size_t i = 0; i < trees_.size(); ++i) points_[i].velocity += time * pulls_[i];
}

void NetworkMotion::damp(double part) {
  if (!damped_) return;
  set_part(part);
  Point* const points = points_.data();
  for (Edge& edge : edges_) {
    Point &a = points[edge.a], &b = points[edge.b];
    const Vector3 way = b.center - a.center;
    const double length = way.norm();
    edge.drag = 0;
    if (!(length > 0)) continue;
    const double inverse = 1 / length, speed = inverse * way.dot(b.velocity - a.velocity);
    edge.drag = edge.damping * speed;
    const Vector3 impulse = (edge.share * speed * inverse) * way;
    a.velocity += a.inverse_mass * impulse;
    b.velocity -= b.inverse_mass * impulse;
    drags_[static_cast<std::size_t>(edge.a)] += impulse;
    drags_[static_cast<std::size_t>(edge.b)] -= impulse;
    loss_ += edge.loss * speed * speed;
  }
}

double NetworkMotion::kinetic() const {
  double sum = 0;
  for (std::size_t i = 0; i < trees_.size(); ++i)
    sum += 0.5 * points_[i].velocity.squaredNorm() / points_[i].inverse_mass;
  return sum;
}

int NetworkMotion::step(double h, bool in_one, Meter& meter) {
  constexpr double kXi = 0.1786178958448091, kLambda = -0.2123418310626054, kChi = -0.06626458266981849;
  loss_ = 0;
  swung_ = kinetic();
  std::fill(drags_.begin(), drags_.end(), Vector3(Vector3::Zero()));
  const double phase = fastest_ * h;
  const bool slow = phase <= kSlowPhase || in_one;
  const int parts = slow ? 1 : static_cast<int>(std::ceil(phase / most_phase_));
  const double part = h / parts, scale = in_one ? std::min(1.0, std::pow(kStablePhase / phase, 2)) : 1;
  const int evaluations = parts * (!slow ? 4 : damped_ ? 2 : 1);
  meter.add(static_cast<std::uint64_t>(evaluations) * (1 + (edges_.size() + points_.size()) / 4));
  for (int i = 0; i < parts; ++i) {
    if (i > 0) swung_ = std::max(swung_, kinetic());
    if (slow) {
      drift(0.5 * part);
      kick(damped_ ? 0.5 * part : part, scale);
      damp(part);
      if (damped_) kick(0.5 * part, scale);
      drift(0.5 * part);
      continue;
    }
    constexpr double kOuter = 0.5 * (1 - 2 * kLambda), kMiddle = 0.5 * (1 - 2 * (kChi + kXi));
    drift(kXi * part);
    kick(kOuter * part, 1);
    drift(kChi * part);
    kick(kLambda * part, 1);
    drift(kMiddle * part);
    damp(part);
    drift(kMiddle * part);
    kick(kLambda * part, 1);
    drift(kChi * part);
    kick(kOuter * part, 1);
    drift(kXi * part);
  }
  return evaluations;
}

double NetworkMotion::energy() {
  double sum = 0;
  for (Edge& edge : edges_) {
    const Vector3 way =
        points_[static_cast<std::size_t>(edge.b)].center - points_[static_cast<std::size_t>(edge.a)].center;
    const double length = way.norm(), stretch = length - edge.length;
    edge.stored = length > 0 ? 0.5 * edge.strength * stretch * stretch : 0;
    sum += edge.stored;
  }
  return sum;
}

void NetworkMotion::write(Dynamics::Core& core) const {
  for (const Edge& edge : edges_) {
    SpringEntry& spring = core.springs[edge.spring];
    spring.force = edge.force + edge.drag;
    spring.booked = edge.stored;
  }
}

}  // namespace breve
