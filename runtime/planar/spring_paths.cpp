// The paths of bodies that springs pull at, on which all springs agree: Newton's method, each step of it by conjugate
// gradients (Hestenes and Stiefel 1952). What joints hold stays in what they allow: their response is the
// preconditioner.
#include <algorithm>
#include <cmath>

#include "runtime/planar/spring_rows.hpp"

namespace breve {

namespace {

double dot(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// to += factor * by
void add_scaled(std::vector<Vector3>& to, double factor, const std::vector<Vector3>& by) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * by[i];
}

Vector3 inertia(const FlatBody& flat) { return {flat.mass.mass, flat.mass.mass, flat.mass.inertia(2, 2)}; }

}  // namespace

/// Connected bodies, each part in the order of its springs: other parts change nothing, bit for bit.
std::vector<SpringRows::Part> SpringRows::parts() {
  std::vector<Part> all;
  std::vector<int> part_of(nodes_.size(), -1);
  const auto of = [&](int i) -> Part& {
    int& known = part_of[static_cast<std::size_t>(root_of(i))];
    if (known < 0) {
      known = static_cast<int>(all.size());
      all.emplace_back();
    }
    return all[static_cast<std::size_t>(known)];
  };
  for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
    Part& part = of(i);
    node(i).at = part.nodes.size();
    part.nodes.push_back(i);
  }
  for (const Assembly& one : assemblies_) of(one.nodes.front()).assemblies.push_back(&one);
  for (Row& row : rows_)
    if (const int at = std::max(row.ends[0].node, row.ends[1].node); at >= 0) of(at).rows.push_back(&row);
  return all;
}

/// The accelerations by these loads, as joints allow them.
SpringRows::Vectors SpringRows::mobile(const Part& part, const Vectors& loads) const {
  Vectors out(part.nodes.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = loads[i].cwiseQuotient(inertia(*node(part.nodes[i]).flat));
  const double u = core_.settings.unit;
  for (const Assembly* one : part.assemblies) {
    Response::Vector impulses(one->response.size());
    for (std::size_t k = 0; k < one->nodes.size(); ++k)
      impulses.segment<3>(static_cast<Eigen::Index>(3 * k)) =
          loads[node(one->nodes[k]).at].cwiseQuotient(Vector3(u, u, u * u));
    const Response::Vector change = one->response.answer(impulses);
    for (std::size_t k = 0; k < one->nodes.size(); ++k)
      out[node(one->nodes[k]).at] = change.segment<3>(static_cast<Eigen::Index>(3 * k)).cwiseProduct(Vector3(u, u, 1));
  }
  return out;
}

/// What the rows that depend on the path pull back.
SpringRows::Vectors SpringRows::pulls(const Part& part) const {
  Vectors out(part.nodes.size(), Vector3::Zero());
  for (const Row* row : part.rows)
    for (const End& end : row->ends)
      if (row->rule != Rule::Now && end.node >= 0) out[node(end.node).at] += row->force * end.along;
  return out;
}

/// The loads that are not worth a further step: far below what single precision makes of the lengths.
SpringRows::Vectors SpringRows::tolerance(const Part& part) const {
  constexpr double kForce = 1e-7, kLength = 1e-10;
  Vectors out(part.nodes.size(), Vector3::Zero());
  for (const Row* row : part.rows) {
    const double least = kForce * std::abs(row->force) + kLength * row->strength * row->size;
    for (const End& end : row->ends)
      if (row->rule != Rule::Now && end.node >= 0) out[node(end.node).at] += least * end.along.cwiseAbs();
  }
  for (const int i : part.nodes)
    out[node(i).at] += kLength * node(i).start.cwiseAbs().cwiseProduct(inertia(*node(i).flat)) / share(i);
  return out;
}

/// x is velocities; by the time in which they come about.
SpringRows::Vectors SpringRows::times_inertia(const Part& part, const Vectors& x) const {
  Vectors out(x.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = x[i].cwiseProduct(inertia(*node(part.nodes[i]).flat)) / share(part.nodes[i]);
  return out;
}

SpringRows::Vectors SpringRows::residual(const Part& part) {
  evaluate(part);
  Vectors gained(part.nodes.size());
  for (std::size_t i = 0; i < gained.size(); ++i) gained[i] = node(part.nodes[i]).path - node(part.nodes[i]).start;
  Vectors out = times_inertia(part, gained);
  add_scaled(out, 1, pulls(part));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] -= node(part.nodes[i]).load;
  return out;
}

/// By the derivative of the residual, without what makes it indefinite: springs that are compressed and swing out.
SpringRows::Vectors SpringRows::multiply(const Part& part, const Vectors& x) const {
  Vectors out = times_inertia(part, x);
  for (const Row* row : part.rows) {
    if (row->rule == Rule::Now) continue;
    double along = 0, across = 0;
    for (const End& end : row->ends) {
      if (end.node < 0) continue;
      along += end.along.dot(x[node(end.node).at]);
      across += end.across.dot(x[node(end.node).at]);
    }
    for (const End& end : row->ends)
      if (end.node >= 0) out[node(end.node).at] += row->stiff * along * end.along + row->sideways * across * end.across;
  }
  return out;
}

SpringRows::Vectors SpringRows::diagonal(const Part& part) const {
  Vectors out = times_inertia(part, Vectors(part.nodes.size(), Vector3::Ones()));
  for (const Row* row : part.rows)
    for (const End& end : row->ends)
      if (row->rule != Rule::Now && end.node >= 0)
        out[node(end.node).at] += row->stiff * end.along.cwiseAbs2() + row->sideways * end.across.cwiseAbs2();
  return out;
}

SpringRows::Vectors SpringRows::precondition(const Part& part, const Vectors& diagonal, const Vectors& x) const {
  Vectors out = part.assemblies.empty() ? Vectors(x.size()) : mobile(part, x);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (node(part.nodes[i]).held)
      out[i] *= share(part.nodes[i]);
    else
      out[i] = x[i].cwiseQuotient(diagonal[i]);
  }
  return out;
}

/// The change of the path that takes this residual away, to a part of it: Newton's next step sees what is left.
SpringRows::Vectors SpringRows::step_against(const Part& part, const Vectors& diagonal, const Vectors& residual) {
  constexpr double kPart = 1e-2;
  constexpr std::size_t kMost = 100;
  Vectors x(residual.size(), Vector3::Zero()), left = x;
  add_scaled(left, -1, residual);
  Vectors ahead = precondition(part, diagonal, left), way = ahead;
  double size = dot(left, ahead);
  const double enough = kPart * kPart * size;
  for (std::size_t i = 0; i < std::min(kMost, 3 * x.size() + 3) && size > enough; ++i) {
    looks_ += part.rows.size();
    const Vectors pushed = multiply(part, way);
    const double bends = dot(way, pushed);
    if (!(bends > 0)) break;
    add_scaled(x, size / bends, way);
    add_scaled(left, -size / bends, pushed);
    ahead = precondition(part, diagonal, left);
    const double next = dot(left, ahead);
    for (std::size_t k = 0; k < way.size(); ++k) way[k] = ahead[k] + next / size * way[k];
    size = next;
  }
  return x;
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

double SpringRows::wrong(const Part& part, const Vectors& residual, const Vectors& diagonal) const {
  return dot(residual, precondition(part, diagonal, residual));
}

/// As if springs pulled as they do at the start, where the sub-step follows that; else as if none pulled.
void SpringRows::start_path(const Part& part) {
  constexpr double kFollows = 0.5;
  Vectors loads(part.nodes.size(), Vector3::Zero());
  if (std::all_of(part.nodes.begin(), part.nodes.end(), [this](int i) { return node(i).pace < kFollows; })) {
    for (const int i : part.nodes) node(i).path = node(i).start;
    evaluate(part);
    add_scaled(loads, -1, pulls(part));
  }
  for (std::size_t i = 0; i < loads.size(); ++i) loads[i] += node(part.nodes[i]).load;
  const Vectors free = mobile(part, loads);
  for (std::size_t i = 0; i < free.size(); ++i)
    node(part.nodes[i]).path = node(part.nodes[i]).start + share(part.nodes[i]) * free[i];
}

/// @param lands  nothing flies: each step must lower the merit, else it must lower the residual
/// @return       whether the path is exact to single precision
bool SpringRows::find_path(const Part& part, bool lands) {
  const int most = lands ? 30 : 12, halvings = lands ? 20 : 4;
  start_path(part);
  Vectors left = residual(part);
  for (int k = 0; k < most; ++k) {
    const Vectors scale = diagonal(part);
    const double size = wrong(part, left, scale), before = lands ? merit(part) : 0;
    if (!(size > wrong(part, tolerance(part), scale))) return true;
    const Vectors step = step_against(part, scale, left);
    double taken = 0, length = 1;
    for (int i = 0; i < halvings; ++i, length /= 2) {
      for (std::size_t j = 0; j < step.size(); ++j) node(part.nodes[j]).path += (length - taken) * step[j];
      taken = length;
      left = residual(part);
      if (lands ? merit(part) < before : wrong(part, left, scale) < size) break;
    }
  }
  constexpr double kClose = 100;
  const Vectors scale = diagonal(part);
  return wrong(part, left, scale) <= kClose * kClose * wrong(part, tolerance(part), scale);
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
  Vectors loads = pulls(part);
  for (std::size_t i = 0; i < loads.size(); ++i) loads[i] = node(part.nodes[i]).load - loads[i];
  const Vectors gains = mobile(part, loads);
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const Node& one = node(part.nodes[i]);
    one.flat->flies = one.flies;
    if (!one.flies) continue;
    const Vector2 kick = dt_ / 2 / core_.settings.unit * gains[i].head<2>();
    one.flat->kick = {static_cast<float>(kick.x()), static_cast<float>(kick.y())};
    one.flat->spin_kick = static_cast<float>(dt_ / 2 * gains[i].z());
  }
}

void SpringRows::solve() {
  constexpr std::uint64_t kLooks = 4;  // at a row, for a unit of work
  sum_paces();
  choose_rules();
  set_loads();
  for (const Part& part : parts()) {
    const bool flies = std::any_of(part.nodes.begin(), part.nodes.end(), [this](int i) { return node(i).flies; });
    if (!find_path(part, !flies) && flies) land(part);
    give(part);
  }
  for (Row& row : rows_) give(row);
  core_.counters.work += looks_ / kLooks;
}

}  // namespace breve
