// The steps: I + R D J is solved, and gone along as far as it helps.
#include "runtime/contact/newton.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/contact/direct.hpp"

namespace breve::contact {

namespace {
constexpr int kNewtonSteps = 6;
constexpr int kHalvings = 5;  // of a step that makes things worse
}  // namespace

Newton::Newton(Workspace& work, Equations& equations, double* room)
    : work_(work), equations_(equations), rows_(equations.rows()) {
  for (double** numbers : {&centre_, &p_, &kept_, &q_, &dq_, &u_, &du_}) {
    *numbers = room;
    room += rows_;
  }
}

void Newton::begin() {
  equations_.get_impulses(centre_);
  std::copy_n(centre_, rows_, q_);
  equations_.apply(q_);
}

bool Newton::settle(double stiffness, double tolerance, LinearSolves& solves) {
  stiffness_ = stiffness;
  // Steps of length 0 are taken along these: what an earlier solve or one that failed left there may not be finite.
  std::fill_n(dq_, rows_, 0.0);
  std::fill_n(du_, rows_, 0.0);
  equations_.read_rows(u_);
  double before = 0, first = 0;
  for (int i = 0; i < kNewtonSteps; ++i) {
    project_all(0);
    const double here = misfit(0);
    if (here <= 0.1 * tolerance) return true;
    if (i > 2 && here < 1e-6 && here > 0.3 * before) return true;  // round-off
    if (i > 1 && here > 10 * first) return false;
    before = here;
    if (i == 0) first = here;
    if (solves.spent() || !find_step()) return false;
    solves.make();
    const double length = search(here);
    for (std::size_t k = 0; k < rows_; ++k) q_[k] -= length * dq_[k];
    equations_.apply(q_);
    equations_.read_rows(u_);
  }
  project_all(0);
  return misfit(0) <= 0.1 * tolerance;
}

double Newton::take() {
  std::copy_n(p_, rows_, centre_);
  std::copy_n(p_, rows_, q_);
  equations_.take(p_);
  return violation(work_);
}

void Newton::restore() {
  std::copy_n(kept_, rows_, centre_);
  std::copy_n(kept_, rows_, q_);
  equations_.take(kept_);
}

void Newton::project_all(double length) {
  std::size_t at = 0;
  for (const Point& c : work_.points) {
    const double u[3] = {u_[at] - length * du_[at], u_[at + 1] - length * du_[at + 1],
                         u_[at + 2] - length * du_[at + 2]};
    project(c, centre_ + at, u, stiffness_, p_ + at);
    at += 3;
  }
  for (const PackedScalar& row : work_.scalars) {
    project(row, centre_[at], u_[at] - length * du_[at], stiffness_, p_[at]);
    ++at;
  }
}

/// The largest difference of q - length dq and p, as the velocity it would be at its own row.
double Newton::misfit(double length) const {
  double worst = 0;
  std::size_t at = 0;
  const auto look = [&](double response) {
    worst = std::max(worst, std::abs(q_[at] - length * dq_[at] - p_[at]) * response);
    ++at;
  };
  for (const Point& c : work_.points) look(c.response.nn), look(c.response.s11), look(c.response.s22);
  for (const PackedScalar& row : work_.scalars) look(row.response);
  return worst;
}

/// The Newton step: (I + R D J) dv = R (q - p), with dq so that dv = R dq; and its row velocities.
bool Newton::find_step() {
  equations_.clear();
  std::size_t at = 0;
  double p[3];
  for (std::size_t i = 0; i < work_.points.size(); ++i, at += 3)
    equations_.add_point(i, project(work_.points[i], centre_ + at, u_ + at, stiffness_, p));
  for (std::size_t i = 0; i < work_.scalars.size(); ++i, ++at)
    equations_.add_scalar(i, project(work_.scalars[i], centre_[at], u_[at], stiffness_, p[0]));
  for (std::size_t k = 0; k < rows_; ++k) dq_[k] = q_[k] - p_[k];
  if (!equations_.factorize() || !equations_.solve(dq_, du_)) return false;
  at = 0;
  for (const Point& c : work_.points) {
    apply_slope(project(c, centre_ + at, u_ + at, stiffness_, p), du_ + at, dq_ + at);
    at += 3;
  }
  for (const PackedScalar& row : work_.scalars) {
    dq_[at] -= project(row, centre_[at], u_[at], stiffness_, p[0]) * du_[at];
    ++at;
  }
  return true;
}

/// How far to go along the step: all the way, unless q and p then differ more than `here`; then half of that, and so
/// on. If nothing helps, all the way: the law changes there, and so do the next steps.
double Newton::search(double here) {
  double length = 1;
  for (int i = 0; i < kHalvings; ++i) {
    project_all(length);
    if (misfit(length) <= (1 - 0.1 * length) * here) return length;
    length *= 0.5;
  }
  return 1;
}

}  // namespace breve::contact
