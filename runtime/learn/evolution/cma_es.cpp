// CMA-ES: candidates, adaptation of the mean, of the step and of the covariance matrix.
#include "runtime/learn/evolution/cma_es.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "runtime/base/error.hpp"

namespace breve::learn {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

/// The strategy parameters of table 1.
struct CmaEs::Weights {
  VectorXd weights;  // of the candidates, the best first; those of the worse half are negative
  Index parents;     // how many are positive
  double selection_mass, step_decay, step_damping, path_decay, rank_one, rank_mu, expected_length;

  Weights(std::int32_t dimension, std::int32_t population) {
    const double n = dimension, lambda = population;
    VectorXd raw(population);
    for (Index i = 0; i < population; ++i) raw[i] = std::log((lambda + 1) / 2) - std::log(static_cast<double>(i + 1));
    parents = population / 2;
    const auto mass = [](const VectorXd& w) { return w.sum() * w.sum() / w.squaredNorm(); };
    selection_mass = mass(raw.head(parents));
    const double negative_mass = mass(raw.tail(population - parents));
    path_decay = (4 + selection_mass / n) / (n + 4 + 2 * selection_mass / n);
    rank_one = 2 / ((n + 1.3) * (n + 1.3) + selection_mass);
    rank_mu = std::min(1 - rank_one,
                       2 * (0.25 + selection_mass + 1 / selection_mass - 2) / ((n + 2) * (n + 2) + selection_mass));
    step_decay = (selection_mass + 2) / (n + selection_mass + 5);
    step_damping = 1 + 2 * std::max(0.0, std::sqrt((selection_mass - 1) / (n + 1)) - 1) + step_decay;
    expected_length = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
    const double positive = raw.cwiseMax(0).sum(), negative = -raw.cwiseMin(0).sum();
    const double bound = std::min({1 + rank_one / rank_mu, 1 + 2 * negative_mass / (selection_mass + 2),
                                   (1 - rank_one - rank_mu) / (n * rank_mu)});
    weights = (raw.array() >= 0).select(raw / positive, raw * (std::max(bound, 0.0) / negative));
  }
};

std::int32_t CmaEs::default_population(std::int32_t dimension) {
  return 4 + static_cast<std::int32_t>(std::floor(3 * std::log(static_cast<double>(dimension))));
}

CmaEs::CmaEs(std::pmr::memory_resource* memory)
    : best_value_(std::numeric_limits<double>::infinity()),
      mean_(memory),
      step_path_(memory),
      path_(memory),
      covariance_(memory),
      axes_(memory),
      lengths_(memory),
      candidates_(memory),
      best_(memory) {}

void CmaEs::resize(std::int32_t dimension, std::int32_t population) {
  dimension_ = 0;  // until all is there
  const auto n = static_cast<std::size_t>(dimension);
  for (Numbers* vector : {&mean_, &step_path_, &path_, &lengths_}) vector->resize(n);
  for (Numbers* matrix : {&covariance_, &axes_}) matrix->resize(n * n);
  candidates_.resize(n * static_cast<std::size_t>(population));
  dimension_ = dimension;
  population_ = population;
}

void CmaEs::begin(std::span<const double> mean, double step, std::int32_t population) {
  if (mean.empty() || mean.size() > kMaxDimension)
    throw Error(ErrorCode::Argument, "a search in " + std::to_string(mean.size()) + " dimensions (must be 1 to " +
                                         std::to_string(kMaxDimension) + ")");
  if (!std::isfinite(step) || step <= 0) throw Error(ErrorCode::Argument, "the first step must be > 0 and finite");
  const auto n = static_cast<std::int32_t>(mean.size());
  if (population == 0) population = default_population(n);
  if (population < 4 || population > kMaxPopulation)
    throw Error(ErrorCode::Argument, "a population of " + std::to_string(population) + " (must be 4 to " +
                                         std::to_string(kMaxPopulation) + ")");
  resize(n, population);
  std::copy(mean.begin(), mean.end(), mean_.begin());
  step_path_.fill(0);
  path_.fill(0);
  lengths_.fill(1);
  covariance_.matrix(0, n, n).setIdentity();
  axes_.matrix(0, n, n).setIdentity();
  step_ = step;
  asked_ = false;
  generation_ = decomposed_ = 0;
  best_.resize(0);
  best_value_ = std::numeric_limits<double>::infinity();
}

std::span<const double> CmaEs::ask(Random& random, const Poll& poll) {
  if (dimension_ == 0) throw Error(ErrorCode::Argument, "there is no search: begin one first");
  const Index n = dimension_;
  const MatrixMap axes = axes_.matrix(0, n, n);
  VectorXd draw(n);
  for (Index k = 0; k < population_; ++k) {
    for (double& x : draw) x = random.gauss();
    draw.array() *= lengths_.vector().array();
    candidates_.matrix(0, n, population_).col(k).noalias() = mean_.vector() + step_ * (axes * draw);
    if (poll) poll();
  }
  asked_ = true;
  return {candidates_.data(), candidates_.size()};
}

void CmaEs::tell(std::span<const double> values, const Poll& poll) {
  if (!asked_) throw Error(ErrorCode::Argument, "there are no candidates to report values for: ask for them first");
  if (values.size() != static_cast<std::size_t>(population_))
    throw Error(ErrorCode::Argument,
                std::to_string(values.size()) + " values for " + std::to_string(population_) + " candidates");
  constexpr double kWorst = std::numeric_limits<double>::infinity();
  std::pmr::vector<std::uint32_t> order(values.size(), candidates_.memory());
  std::iota(order.begin(), order.end(), 0U);
  const auto value = [&](std::uint32_t i) { return std::isnan(values[i]) ? kWorst : values[i]; };
  // By number where values are equal: a stable sort would take memory of its own.
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return value(a) < value(b) || (value(a) == value(b) && a < b); });
  const auto n = static_cast<std::size_t>(dimension_);
  if (value(order[0]) < best_value_) {
    best_.resize(n);
    std::copy_n(candidates_.begin() + static_cast<std::ptrdiff_t>(order[0] * n), n, best_.begin());
    best_value_ = value(order[0]);
  }
  asked_ = false;
  adapt(Weights(dimension_, population_), order, poll);
}

void CmaEs::adapt(const Weights& w, std::span<const std::uint32_t> order, const Poll& poll) {
  const Index n = dimension_;
  Numbers distances(candidates_.memory(), candidates_.size());
  MatrixMap steps = distances.matrix(0, n, population_);  // of candidates from the mean, in steps, the best first
  for (Index k = 0; k < population_; ++k)
    steps.col(k) =
        (candidates_.matrix(0, n, population_).col(order[static_cast<std::size_t>(k)]) - mean_.vector()) / step_;
  const MatrixMap axes = axes_.matrix(0, n, n);
  const auto whitened = [&](const VectorXd& x) -> VectorXd {  // C^(-1/2) x
    return axes * ((axes.transpose() * x).array() / lengths_.vector().array()).matrix();
  };
  const VectorXd moved = steps.leftCols(w.parents) * w.weights.head(w.parents);
  mean_.vector() += step_ * moved;
  ++generation_;

  VectorMap step_path = step_path_.vector(), path = path_.vector();
  step_path = (1 - w.step_decay) * step_path +
              std::sqrt(w.step_decay * (2 - w.step_decay) * w.selection_mass) * whitened(moved);
  const double length = step_path.norm();
  const double expected = std::sqrt(1 - std::pow(1 - w.step_decay, 2 * static_cast<double>(generation_)));
  // Where the step is still growing fast, it is not taken for a direction.
  const bool steady = length / expected < (1.4 + 2 / (static_cast<double>(n) + 1)) * w.expected_length;
  path = (1 - w.path_decay) * path;
  if (steady) path += std::sqrt(w.path_decay * (2 - w.path_decay) * w.selection_mass) * moved;

  MatrixMap covariance = covariance_.matrix(0, n, n);
  const double lost = steady ? 0 : w.path_decay * (2 - w.path_decay);
  covariance *= 1 + w.rank_one * lost - w.rank_one - w.rank_mu * w.weights.sum();
  covariance.noalias() += w.rank_one * path * path.transpose();
  for (Index k = 0; k < population_; ++k) {
    double weight = w.weights[k];
    if (weight < 0) {  // keeps the matrix positive definite
      const double size = whitened(steps.col(k)).squaredNorm();
      weight = size > 0 ? weight * static_cast<double>(n) / size : 0;
    }
    covariance.noalias() += w.rank_mu * weight * steps.col(k) * steps.col(k).transpose();
    if (poll) poll();
  }
  step_ *= std::exp(std::min(1.0, w.step_decay / w.step_damping * (length / w.expected_length - 1)));
  // The decomposition costs O(n^3): it waits until the matrix has changed enough (appendix B.2).
  const double wait = 1 / ((w.rank_one + w.rank_mu) * static_cast<double>(n) * 10);
  if (static_cast<double>(generation_ - decomposed_) > wait) decompose();
}

void CmaEs::decompose() {
  const Index n = dimension_;
  constexpr double kLeast = 1e-14;  // of the largest eigenvalue: a condition beyond it is round-off
  MatrixMap covariance = covariance_.matrix(0, n, n);
  covariance = (0.5 * (covariance + covariance.transpose())).eval();
  decomposed_ = generation_;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(covariance);
  const bool usable = solver.info() == Eigen::Success && solver.eigenvalues().allFinite() &&
                      solver.eigenvalues()[n - 1] > 0 && std::isfinite(step_) && step_ > 0;
  if (!usable) {  // values without sense: the search goes on around the mean with equal axes
    covariance.setIdentity();
    axes_.matrix(0, n, n).setIdentity();
    lengths_.fill(1);
    step_path_.fill(0);
    path_.fill(0);
    if (!std::isfinite(step_) || step_ <= 0) step_ = std::numeric_limits<double>::min();
    return;
  }
  axes_.matrix(0, n, n) = solver.eigenvectors();
  lengths_.vector() = solver.eigenvalues().cwiseMax(kLeast * solver.eigenvalues()[n - 1]).cwiseSqrt();
}

std::uint64_t CmaEs::work() const {
  constexpr std::uint64_t kPerUnit = 32;
  const auto n = static_cast<std::uint64_t>(dimension_), lambda = static_cast<std::uint64_t>(population_);
  return 1 + (5 * n * n * lambda + 10 * n * n * n) / kPerUnit + n * lambda;
}

}  // namespace breve::learn
