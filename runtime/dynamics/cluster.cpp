// Joint coordinates of several trees behind one another, and the powers that the ledger integrates.
#include "runtime/dynamics/cluster.hpp"

#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/articulated/motors.hpp"

namespace breve {

namespace {

constexpr double kCoarse = 1e-3;      // tolerances of step control that ask for few digits
constexpr std::uint64_t kUnits = 16;  // of work, of a link's part in an evaluation

using articulated::Kind;
using articulated::Vector;

articulated::Settings settings_of(const Accuracy& accuracy, double unit) {
  articulated::Settings settings;
  settings.tolerance.relative = accuracy.tolerance;
  settings.tolerance.length = settings.tolerance.velocity = unit;
  settings.implicit_joints = accuracy.implicit_joints;
  // In all sub-steps of a step together. Hard scenes need some 1,000 at coarse tolerances; what needs far more, such as
  // a link without inertia on a spring, is to be reported, not to be followed.
  constexpr int kMostAttempts = 5'000, kMostFine = 50'000;
  settings.most_attempts = accuracy.tolerance >= kCoarse ? kMostAttempts : kMostFine;
  // A plain scheme must not blow up on a light chain with a heavy load. A midpoint rule that was set is there to be
  // studied.
  settings.refine = accuracy.scheme != articulated::Scheme::ImplicitMidpoint || accuracy.rung == Rung::Conserving;
  return settings;
}

}  // namespace

Cluster::Cluster(std::pmr::memory_resource* memory, std::span<Tree* const> trees, const Accuracy& accuracy, double unit,
                 bool asked)
    : trees_(trees.begin(), trees.end(), memory),
      accuracy_(accuracy),
      unit_(unit),
      kinds_(memory),
      sprung_(memory),
      motors_(memory),
      received_(memory) {
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    const Tree* tree = trees_[t];
    for (int i = 0; i < tree->model.size(); ++i) {
      if (!tree->links[static_cast<std::size_t>(i)].motor) continue;
      const articulated::Body& body = tree->model.body(i);
      for (int k = body.v; k < body.v + articulated::velocity_count(body.type); ++k) motors_.push_back({nv_ + k, t, k});
    }
    // Bodies without joints have momenta for coordinates, which every integrator keeps.
    if (asked && tree->loose && tree->model.size() > 1) received_.push_back({trees_[t]});
    nq_ += tree->model.positions();
    nv_ += tree->model.velocities();
    mass_ += tree->model.mass();
    units_ += kUnits * static_cast<std::uint64_t>(tree->model.size());
    for (const articulated::Body& body : tree->model.bodies())
      for (int k = 0; k < articulated::velocity_count(body.type); ++k)
        kinds_.push_back(articulated::is_length(body.type, k) ? Kind::Length : Kind::Angle);
  }
  kinds_.insert(kinds_.end(), kWorks + motors_.size() + kReceived * received_.size(), Kind::Ledger);
  sprung_.assign(kinds_.size(), 0);
  at_.q.setZero(nq_);
  at_.v.setZero(velocities());
  at_.mean.setZero(velocities());
  torques_.setZero(nv_);
  if (!trees_.empty()) at_.step = trees_.front()->step;
  make_integrators();
}

// Both at once: a step allocates nothing.
void Cluster::make_integrators() {
  integrator_.emplace(*this, accuracy_.scheme, settings_of(accuracy_, unit_));
  finer_.reset();
  if (accuracy_.rung != Rung::Fast || accuracy_.scheme != articulated::Scheme::SemiImplicitEuler) return;
  articulated::Settings finer = settings_of(accuracy_, unit_);
  finer.implicit_joints = false;
  // Semi-implicit Euler is always there instead: more attempts would cost a frame more than they gain.
  constexpr int kMostAttempts = 300;
  finer.most_attempts = kMostAttempts;
  finer_.emplace(*this, articulated::Scheme::RungeKutta4, finer);
}

void Cluster::set_accuracy(const Accuracy& accuracy) {
  accuracy_ = accuracy;
  at_.step = 0;
  make_integrators();
}

void Cluster::set_finer(bool on) { finer_now_ = on && finer_.has_value(); }

void Cluster::begin(StageForces* forces, Meter& meter) {
  at_.spent = 0;
  forces_ = forces;
  meter_ = &meter;
  working_ = forces != nullptr;
  driven_ = working_;
  for (const Tree* tree : trees_) driven_ = driven_ || tree->driven;
  note_springs();
}

/// Of joints, of whole trees where Springs, contact springs or force methods may push them.
void Cluster::note_springs() {
  const bool all = forces_ && forces_->pulls();
  std::fill_n(sprung_.begin(), nv_, static_cast<char>(all));
  if (all) return;
  auto first = sprung_.begin();
  for (const Tree* tree : trees_) {
    for (std::size_t i = 0; i < tree->loads.drives.size(); ++i) {
      const articulated::Body& body = tree->model.body(static_cast<int>(i));
      if (tree->loads.drives[i].stiffness > 0)
        std::fill_n(first + body.v, articulated::velocity_count(body.type), char{1});
    }
    first += tree->model.velocities();
  }
}

void Cluster::step(double time, double h) {
  read(at_.q, at_.v);
  read_mean();
  working_ = driven_;
  for (const Tree* tree : trees_) working_ = working_ || tree->loads.reacts;
  at_.t = time;
  current_step_ = h;
  evaluations_ = 0;
  guess_ = articulated::MotorGuess::None;  // nothing that a step remembers is in no image
  at_.attempts = 0;
  try {
    (finer_now_ ? finer_ : integrator_)->step(at_, h);
    at_.spent += at_.attempts;
  } catch (...) {
    at_.spent += at_.attempts;
    scatter(at_.q, at_.v);  // the step leaves `at_` as it was; the trees' states are the last stage's
    throw;
  }
  write(at_.q, at_.v);
  write_mean();
}

/// What the last step may tell the next one is the trees' own, as all that images keep.
void Cluster::read_mean() {
  int from = 0;
  for (const Tree* tree : trees_) {
    at_.mean.segment(from, tree->mean.size()) = tree->mean;
    from += tree->model.velocities();
  }
  at_.mean.tail(velocities() - nv_).setZero();
}

void Cluster::write_mean() {
  int from = 0;
  for (Tree* tree : trees_) {
    tree->mean = at_.mean.segment(from, tree->model.velocities());
    from += tree->model.velocities();
  }
}

void Cluster::read(Vector& q, Vector& v) const {
  int from_q = 0, from_v = 0;
  for (const Tree* tree : trees_) {
    q.segment(from_q, tree->state.q.size()) = tree->state.q;
    v.segment(from_v, tree->state.v.size()) = tree->state.v;
    from_q += tree->model.positions();
    from_v += tree->model.velocities();
  }
  v.tail(velocities() - nv_).setZero();
}

void Cluster::write(const Vector& q, const Vector& v) {
  scatter(q, v);
  for (int i = 0; i < kWorks; ++i) works_[static_cast<std::size_t>(i)] = v[nv_ + i] * mass_;
  for (Tree* tree : trees_) tree->part_impulse.setZero();
  for (std::size_t i = 0; i < motors_.size(); ++i)
    trees_[motors_[i].tree]->part_impulse[motors_[i].own] = v[nv_ + kWorks + static_cast<Eigen::Index>(i)] * mass_;
  take_received(v);
}

void Cluster::place(const Vector& q, const Vector& v) {
  scatter(q, v);
  for (Tree* tree : trees_) articulated::forward_kinematics(tree->model, tree->data, tree->state);
}

void Cluster::scatter(const Vector& q, const Vector& v) {
  int from_q = 0, from_v = 0;
  for (Tree* tree : trees_) {
    tree->state.q = q.segment(from_q, tree->model.positions());
    tree->state.v = v.segment(from_v, tree->model.velocities());
    from_q += tree->model.positions();
    from_v += tree->model.velocities();
  }
}

void Cluster::acceleration(double t, const Vector& q, const Vector& v, double step, Vector& a) {
  if (meter_) meter_->add(units_);
  ++evaluations_;
  Powers powers;
  if (forces_ && forces_->accelerate(q, v, a)) {
    int from = 0;
    for (const Tree* tree : trees_) {
      add_reaction(*tree, v.data() + from, a.data() + from, powers);
      from += tree->model.velocities();
    }
  } else {
    accelerate_trees(t, q, v, step, a, powers);
  }
  guess_ = articulated::MotorGuess::Last;
  a.tail(velocities() - nv_).setZero();
  if (!working_) return;
  if (forces_) {
    powers.script += forces_->script_power();
    powers.drag += forces_->drag_power();
    powers.reaction += forces_->reaction_power();
  }
  a.segment<kWorks>(nv_) << powers.motor / mass_, powers.script / mass_, powers.drag / mass_, powers.reaction / mass_;
  for (std::size_t i = 0; i < motors_.size(); ++i)
    a[nv_ + kWorks + static_cast<Eigen::Index>(i)] = torques_[motors_[i].place] / mass_;
  if (!received_.empty()) add_received(v, a);
}

/// Forces of scripts and springs on links, which are placed; those of contacts are known without.
void Cluster::add_received(const Vector& v, Vector& a) const {
  int at = received_at();
  for (const Received& one : received_) {
    const Tree& tree = *one.tree;
    const Vector3 center = articulated::centre_of_mass(tree.model, tree.data);
    Vector3 force = Vector3::Zero(), couple = Vector3::Zero();
    for (int i = 0; i < tree.model.size(); ++i) {
      const articulated::Wrench& wrench = tree.loads.wrenches[static_cast<std::size_t>(i)];
      const articulated::Wrench& predicted = tree.links[static_cast<std::size_t>(i)].predicted;
      const Vector3 push = wrench.force - predicted.force;
      force += push;
      couple +=
          (articulated::com_position(tree.model, tree.data, i) - center).cross(push) + wrench.couple - predicted.couple;
    }
    const double mass = tree.model.mass();
    a.segment<3>(at) = force / mass;
    a.segment<3>(at + 3) = v.segment<3>(at);
    a.segment<3>(at + 6) = couple / mass;
    at += kReceived;
  }
}

void Cluster::take_received(const Vector& v) {
  int at = received_at();
  for (Received& one : received_) {
    const double mass = one.tree->model.mass();
    one.impulse = mass * v.segment<3>(at);
    // Semi-implicit Euler knows only where it began.
    one.way = semi_implicit() ? Vector3(0.5 * current_step_ * v.segment<3>(at)) : Vector3(v.segment<3>(at + 3));
    one.spin = mass * v.segment<3>(at + 6);
    at += kReceived;
  }
}

void Cluster::accelerate_trees(double t, const Vector& q, const Vector& v, double step, Vector& a, Powers& powers) {
  scatter(q, v);
  if (forces_) {
    forces_->aim();
    if (forces_->adds())
      for (Tree* tree : trees_) articulated::forward_kinematics(tree->model, tree->data, tree->state);
    forces_->add(t);
  }
  int from = 0;
  for (Tree* tree : trees_) {
    const int n = tree->model.velocities();
    a.segment(from, n) = articulated::forward_dynamics(tree->model, tree->data, tree->state, tree->loads, step, guess_);
    if (forces_ && !(tree->loops.empty() && tree->held.empty())) {
      const std::uint64_t units = forces_->constrain(*tree, a.data() + from);
      if (meter_) meter_->add(units);
    }
    torques_.segment(from, n).setZero();
    if (tree->driven) add_powers(*tree, step, v.data() + from, a.data() + from, torques_.data() + from, powers);
    add_reaction(*tree, v.data() + from, a.data() + from, powers);
    from += n;
  }
}

void Cluster::add_reaction(const Tree& tree, const double* v, const double* a, Powers& powers) const {
  if (!tree.loads.reacts) return;
  const Vector& reaction = tree.loads.reaction;
  const double half = semi_implicit() ? 0.5 * current_step_ : 0;
  for (int k = 0; k < tree.model.velocities(); ++k) powers.reaction += reaction[k] * (v[k] + half * a[k]);
}

void Cluster::add_powers(const Tree& tree, double step, const double* v, const double* a, double* torques,
                         Powers& powers) const {
  // What acts over a semi-implicit step does its work at the mean of the velocities before and after.
  const articulated::Loads& loads = tree.loads;
  const double half = semi_implicit() ? 0.5 * current_step_ : 0;
  const double lag = articulated::motor_lag(loads, step);
  for (int i = 0; i < tree.model.size(); ++i) {
    const articulated::Body& body = tree.model.body(i);
    const articulated::Drive& drive = loads.drives[static_cast<std::size_t>(i)];
    for (int k = body.v; k < body.v + articulated::velocity_count(body.type); ++k) {
      const double mean = v[k] + half * a[k];
      // A force that is set works along the way.
      if (loads.tau.size()) powers.script += tree.set_tau[k] * (semi_implicit() ? v[k] + current_step_ * a[k] : v[k]);
      powers.drag += drive.damping * (v[k] + step * a[k]) * mean;
      powers.drag += tree.links[static_cast<std::size_t>(i)].slow_damping * v[k] * mean;
      if (!(drive.motor_gain > 0)) continue;
      const int shared = body.type == articulated::JointType::Ball ? 3 : 1;
      const double torque = articulated::motor_force(loads, drive, k, shared, v[k], a[k], lag, tree.data);
      powers.motor += torque * mean;
      torques[k] = torque;
    }
  }
}

// The first tree's numbers begin where the whole vector's do, so that one tree alone needs no copies.

void Cluster::move(const Vector& q, const Vector& d, Vector& out) {
  if (trees_.size() == 1) return articulated::move(trees_.front()->model, q, d, out);
  int from_q = 0, from_v = 0;
  for (Tree* tree : trees_) {
    const int nq = tree->model.positions(), nv = tree->model.velocities();
    tree->work_q = q.segment(from_q, nq);
    tree->work_v = d.segment(from_v, nv);
    articulated::move(tree->model, tree->work_q, tree->work_v, tree->work_q);
    out.segment(from_q, nq) = tree->work_q;
    from_q += nq;
    from_v += nv;
  }
}

void Cluster::rate_of_move(const Vector& d, const Vector& v, Vector& out) {
  if (trees_.size() == 1) {
    articulated::rate_of_move(trees_.front()->model, d, v, out);
  } else {
    int from = 0;
    out = v;
    for (Tree* tree : trees_) {
      const int nv = tree->model.velocities();
      tree->work_v = d.segment(from, nv);
      tree->work_u = v.segment(from, nv);
      articulated::rate_of_move(tree->model, tree->work_v, tree->work_u, tree->work_w);
      out.segment(from, nv) = tree->work_w;
      from += nv;
    }
  }
  out.tail(velocities() - nv_).setZero();  // works have no positions
}

void Cluster::bend_to_cayley(Vector& d) {
  if (trees_.size() == 1) return articulated::bend_to_cayley(trees_.front()->model, d);
  int from = 0;
  for (Tree* tree : trees_) {
    const int nv = tree->model.velocities();
    tree->work_v = d.segment(from, nv);
    articulated::bend_to_cayley(tree->model, tree->work_v);
    d.segment(from, nv) = tree->work_v;
    from += nv;
  }
}

}  // namespace breve
