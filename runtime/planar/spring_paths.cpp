// The paths of bodies that springs pull at, on which all springs agree: Newton's method, each step of it by conjugate
// gradients (Hestenes and Stiefel 1952). What joints hold stays in what they allow: their response is the
// preconditioner.
#include <algorithm>
#include <cmath>

#include "runtime/planar/spring_rows.hpp"

namespace breve {

namespace {

using Vectors = std::pmr::vector<Vector3>;

double dot(const Vectors& a, const Vectors& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// to += factor * by
void add_scaled(Vectors& to, double factor, const Vectors& by) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * by[i];
}

Vector3 inertia(const FlatBody& flat) { return {flat.mass.mass, flat.mass.mass, flat.mass.inertia(2, 2)}; }

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

/// Connected bodies, each part in the order of its springs: other parts change nothing, bit for bit.
void SpringRows::make_parts() {
  part_count_ = 0;
  part_of_.assign(nodes_.size(), -1);
  const auto of = [&](int i) -> Part& {
    int& known = part_of_[index(root_of(i))];
    if (known >= 0) return parts_[index(known)];
    known = static_cast<int>(part_count_++);
    if (parts_.size() < part_count_) parts_.emplace_back(core_.memory);
    Part& fresh = parts_[index(known)];
    fresh.nodes.clear();
    fresh.rows.clear();
    fresh.assemblies.clear();
    return fresh;
  };
  for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
    Part& part = of(i);
    node(i).at = static_cast<int>(part.nodes.size());
    part.nodes.push_back(i);
  }
  for (const Assembly& one : assemblies_) of(one.nodes.front()).assemblies.push_back(&one);
  for (Row& row : rows_)
    if (const int at = std::max(row.ends[0].node, row.ends[1].node); at >= 0) of(at).rows.push_back(&row);
}

/// What its equations need again and again lies side by side.
void SpringRows::take_part(const Part& part) {
  const std::size_t count = part.nodes.size();
  for (Vectors* all :
       {&inertias_, &residual_, &tolerance_, &diagonal_, &step_, &left_, &ahead_, &way_, &pushed_, &scratch_})
    all->resize(count);
  shares_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    inertias_[i] = inertia(*node(part.nodes[i]).flat);
    shares_[i] = share(part.nodes[i]);
  }
}

/// The accelerations by these loads, as joints allow them.
void SpringRows::mobile(const Part& part, const Vectors& loads, Vectors& out) const {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = loads[i].cwiseQuotient(inertias_[i]);
  const double u = core_.settings.unit;
  for (const Assembly* one : part.assemblies) {
    Response::Vector impulses(one->response.size());
    for (std::size_t k = 0; k < one->nodes.size(); ++k)
      impulses.segment<3>(static_cast<Eigen::Index>(3 * k)) =
          loads[index(node(one->nodes[k]).at)].cwiseQuotient(Vector3(u, u, u * u));
    const Response::Vector change = one->response.answer(impulses);
    for (std::size_t k = 0; k < one->nodes.size(); ++k)
      out[index(node(one->nodes[k]).at)] =
          change.segment<3>(static_cast<Eigen::Index>(3 * k)).cwiseProduct(Vector3(u, u, 1));
  }
}

/// What the rows that depend on the path pull back, times a sign.
void SpringRows::add_pulls(const Part& part, double sign, Vectors& out) const {
  for (const Row* row : part.rows)
    for (const End& end : row->ends)
      if (row->rule != Rule::Now && end.node >= 0) out[index(node(end.node).at)] += sign * row->force * end.along;
}

/// x is velocities; by the time in which they come about.
void SpringRows::times_inertia(const Vectors& x, Vectors& out) const {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = x[i].cwiseProduct(inertias_[i]) / shares_[i];
}

void SpringRows::set_residual(const Part& part) {
  evaluate(part);
  for (std::size_t i = 0; i < scratch_.size(); ++i) scratch_[i] = node(part.nodes[i]).path - node(part.nodes[i]).start;
  times_inertia(scratch_, residual_);
  std::fill(scratch_.begin(), scratch_.end(), Vector3::Zero());
  add_pulls(part, 1, scratch_);
  add_scaled(residual_, 1, scratch_);
  for (std::size_t i = 0; i < residual_.size(); ++i) residual_[i] -= node(part.nodes[i]).load;
  if (part.assemblies.empty()) return;
  // What joints hold is not an error. They give way a little, which would be seen where the rest is small.
  mobile(part, residual_, scratch_);
  for (std::size_t i = 0; i < residual_.size(); ++i)
    if (node(part.nodes[i]).held) residual_[i] = scratch_[i].cwiseProduct(inertias_[i]);
}

/// The derivative of the residual, without what makes it indefinite: springs that are compressed and swing out; and the
/// loads that are not worth a further step, far below what single precision makes of the lengths.
void SpringRows::linearize(const Part& part) {
  constexpr double kForce = 1e-7, kLength = 1e-10;
  couplings_.clear();
  std::fill(tolerance_.begin(), tolerance_.end(), Vector3::Zero());
  for (std::size_t i = 0; i < diagonal_.size(); ++i) diagonal_[i] = inertias_[i] / shares_[i];
  for (const Row* row : part.rows) {
    if (row->rule == Rule::Now) continue;
    const double least = kForce * std::abs(row->force) + kLength * row->strength * row->size;
    Coupling& made = couplings_.emplace_back();
    made.stiff = row->stiff;
    made.sideways = row->sideways;
    for (std::size_t i = 0; i < 2; ++i) {
      const End& end = row->ends[i];
      made.at[i] = end.node < 0 ? -1 : node(end.node).at;
      made.along[i] = end.along;
      made.across[i] = end.across;
      if (end.node < 0) continue;
      tolerance_[index(made.at[i])] += least * end.along.cwiseAbs();
      diagonal_[index(made.at[i])] += made.stiff * end.along.cwiseAbs2() + made.sideways * end.across.cwiseAbs2();
    }
  }
  for (std::size_t i = 0; i < tolerance_.size(); ++i)
    tolerance_[i] += kLength * node(part.nodes[i]).start.cwiseAbs().cwiseProduct(inertias_[i]) / shares_[i];
}

/// By that derivative.
void SpringRows::multiply(const Vectors& x, Vectors& out) const {
  times_inertia(x, out);
  for (const Coupling& one : couplings_) {
    double along = 0, across = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      if (one.at[i] < 0) continue;
      along += one.along[i].dot(x[index(one.at[i])]);
      across += one.across[i].dot(x[index(one.at[i])]);
    }
    const double pull = one.stiff * along, side = one.sideways * across;
    for (std::size_t i = 0; i < 2; ++i)
      if (one.at[i] >= 0) out[index(one.at[i])] += pull * one.along[i] + side * one.across[i];
  }
}

void SpringRows::precondition(const Part& part, const Vectors& x, Vectors& out) const {
  if (!part.assemblies.empty()) mobile(part, x, out);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!part.assemblies.empty() && node(part.nodes[i]).held)
      out[i] *= shares_[i];
    else
      out[i] = x[i].cwiseQuotient(diagonal_[i]);
  }
}

/// The change of the path that takes the residual away, to a part of it: Newton's next step sees what is left.
void SpringRows::find_step(const Part& part) {
  constexpr double kPart = 1e-2;
  constexpr std::size_t kMost = 100;
  const std::size_t count = step_.size();
  std::fill(step_.begin(), step_.end(), Vector3::Zero());
  for (std::size_t i = 0; i < count; ++i) left_[i] = -residual_[i];
  precondition(part, left_, ahead_);
  way_ = ahead_;
  double size = dot(left_, ahead_);
  const double enough = kPart * kPart * size;
  for (std::size_t i = 0; i < std::min(kMost, 3 * count + 3) && size > enough; ++i) {
    looks_ += part.rows.size();
    multiply(way_, pushed_);
    const double bends = dot(way_, pushed_);
    if (!(bends > 0)) break;
    add_scaled(step_, size / bends, way_);
    add_scaled(left_, -size / bends, pushed_);
    precondition(part, left_, ahead_);
    const double next = dot(left_, ahead_);
    for (std::size_t k = 0; k < count; ++k) way_[k] = ahead_[k] + next / size * way_[k];
    size = next;
  }
}

/// What a path outside of flight has least of, J: its residual is the gradient of this, by h.
double SpringRows::merit(const Part& part) const {
  double sum = 0;
  for (const int i : part.nodes) {
    const Node& one = node(i);
    const Vector3 gained = one.path - one.start;
    sum += gained.dot(gained.cwiseProduct(inertia(*one.flat))) / 2 - dt_ * one.load.dot(one.path);
  }
  for (const Row* row : part.rows)
    if (row->rule != Rule::Now) sum += row->stored;
  return sum;
}

/// The square of a residual, as its diagonal weighs it.
double SpringRows::wrong(const Part& part, const Vectors& residual) {
  precondition(part, residual, scratch_);
  return dot(residual, scratch_);
}

/// As if springs pulled as they do at the start, where the sub-step follows that; else as if none pulled.
void SpringRows::start_path(const Part& part) {
  constexpr double kFollows = 0.5;
  std::fill(left_.begin(), left_.end(), Vector3::Zero());
  if (std::all_of(part.nodes.begin(), part.nodes.end(), [this](int i) { return node(i).pace < kFollows; })) {
    for (const int i : part.nodes) node(i).path = node(i).start;
    evaluate(part);
    add_pulls(part, -1, left_);
  }
  for (std::size_t i = 0; i < left_.size(); ++i) left_[i] += node(part.nodes[i]).load;
  mobile(part, left_, ahead_);
  for (std::size_t i = 0; i < ahead_.size(); ++i)
    node(part.nodes[i]).path = node(part.nodes[i]).start + shares_[i] * ahead_[i];
}

/// @param lands  nothing flies: each step must lower the merit, else it must lower the residual
/// @return       whether the path is exact to single precision
bool SpringRows::find_path(const Part& part, bool lands) {
  const int most = lands ? 30 : 12, halvings = lands ? 20 : 4;
  take_part(part);
  start_path(part);
  set_residual(part);
  for (int k = 0; k < most; ++k) {
    linearize(part);
    const double size = wrong(part, residual_), before = lands ? merit(part) : 0;
    if (!(size > wrong(part, tolerance_))) return true;
    find_step(part);
    double taken = 0, length = 1;
    for (int i = 0; i < halvings; ++i, length /= 2) {
      for (std::size_t j = 0; j < step_.size(); ++j) node(part.nodes[j]).path += (length - taken) * step_[j];
      taken = length;
      set_residual(part);
      if (lands ? merit(part) < before : wrong(part, residual_) < size) break;
    }
  }
  constexpr double kClose = 100;
  linearize(part);
  return wrong(part, residual_) <= kClose * kClose * wrong(part, tolerance_);
}

/// Springs so stiff that the bodies may swing around each other within a sub-step leave no path in flight.
void SpringRows::land(const Part& part) {
  for (const int i : part.nodes) node(i).flies = false;
  for (Row* row : part.rows)
    if (row->rule == Rule::Mean) row->rule = Rule::End;
  find_path(part, true);
}

/// Writes down what a row pulls.
void SpringRows::give(Row& row) {
  const double set = row.joint ? row.joint->drive.force[0] : 0;
  bool pulls = false;
  if (row.spring) {
    row.spring->force = row.force;
    pulls = row.force != 0 || pull_of(row.spring->is, {row.way.x(), row.way.y(), 0}, Vector3::Zero()).energy != 0;
  } else {
    row.joint->pull = set - row.force;
    double rate = 0;
    for (const End& end : row.ends)
      if (end.node >= 0) rate += end.along.dot(node(end.node).start);
    core_.ledger.script_work += set * rate * dt_;
  }
  core_.ledger.drag_loss += row.loss;
  for (const End& end : row.ends) {
    if (end.node < 0) continue;
    FlatBody& flat = *node(end.node).flat;
    flat.pull += (set - row.force) * end.along.head<2>();
    flat.twist += (set - row.force) * end.along.z();
    flat.pulled = flat.pulled || pulls;
  }
}

/// What flies gets half of its acceleration after it was moved.
void SpringRows::give(const Part& part) {
  std::fill(left_.begin(), left_.end(), Vector3::Zero());
  add_pulls(part, 1, left_);
  for (std::size_t i = 0; i < left_.size(); ++i) left_[i] = node(part.nodes[i]).load - left_[i];
  mobile(part, left_, ahead_);
  for (std::size_t i = 0; i < ahead_.size(); ++i) {
    const Node& one = node(part.nodes[i]);
    one.flat->flies = one.flies;
    if (!one.flies) continue;
    const Vector2 kick = dt_ / 2 / core_.settings.unit * ahead_[i].head<2>();
    one.flat->kick = {static_cast<float>(kick.x()), static_cast<float>(kick.y())};
    one.flat->spin_kick = static_cast<float>(dt_ / 2 * ahead_[i].z());
  }
}

void SpringRows::solve() {
  constexpr std::uint64_t kLooks = 4;  // at a row, for a unit of work
  sum_paces();
  choose_rules();
  set_loads();
  make_parts();
  for (std::size_t i = 0; i < part_count_; ++i) {
    const Part& part = parts_[i];
    const bool flies = std::any_of(part.nodes.begin(), part.nodes.end(), [this](int k) { return node(k).flies; });
    if (!find_path(part, !flies) && flies) land(part);
    give(part);
  }
  for (Row& row : rows_) give(row);
  core_.counters.work += looks_ / kLooks;
}

}  // namespace breve
