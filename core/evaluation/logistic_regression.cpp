// SPDX-License-Identifier: Apache-2.0
// Newton's method for the logistic likelihood; forward and backward steps by likelihood ratios.
#include "core/evaluation/logistic_regression.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include <Eigen/Dense>

namespace kidnapwatch::core::evaluation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTolerance = 1e-10;  // of a step, relative
constexpr int kHalvings = 30;

struct Problem {
  MatrixXd x;  // a row per example, 1 in the first column
  VectorXd y;  // 1 where kidnapped
  VectorXd ridge;
};

Problem problem(std::span<const Example> examples, std::span<const std::size_t> selected,
                double ridge) {
  const auto rows = static_cast<Eigen::Index>(examples.size());
  const auto columns = static_cast<Eigen::Index>(selected.size()) + 1;
  Problem result{MatrixXd::Ones(rows, columns), VectorXd(rows), VectorXd::Constant(columns, ridge)};
  result.ridge[0] = 0.0;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Example& example = examples[static_cast<std::size_t>(row)];
    result.y[row] = example.kidnapped ? 1.0 : 0.0;
    for (Eigen::Index column = 1; column < columns; ++column) {
      result.x(row, column) = example.features[selected[static_cast<std::size_t>(column - 1)]];
    }
  }
  return result;
}

/// log(1 + exp(z)) without overflow.
double softplus(double z) { return std::max(z, 0.0) + std::log1p(std::exp(-std::abs(z))); }

double log_likelihood(const Problem& p, const VectorXd& beta) {
  const VectorXd z = p.x * beta;
  return p.y.dot(z) - z.unaryExpr(&softplus).sum();
}

double objective(const Problem& p, const VectorXd& beta) {
  return log_likelihood(p, beta) - 0.5 * beta.cwiseAbs2().dot(p.ridge);
}

double logistic(double z) { return 1.0 / (1.0 + std::exp(-z)); }

MatrixXd information(const Problem& p, const VectorXd& mu) {
  const VectorXd weights = mu.cwiseProduct(VectorXd::Ones(mu.size()) - mu);
  MatrixXd result = p.x.transpose() * weights.asDiagonal() * p.x;
  result.diagonal() += p.ridge;
  return result;
}

/// One Newton step, halved until the objective does not fall; whether the maximum was reached.
bool step(const Problem& p, VectorXd& beta) {
  const VectorXd mu = (p.x * beta).unaryExpr(&logistic);
  const VectorXd gradient = p.x.transpose() * (p.y - mu) - beta.cwiseProduct(p.ridge);
  VectorXd delta = information(p, mu).ldlt().solve(gradient);
  if (!delta.allFinite()) return false;
  const double before = objective(p, beta);
  for (int i = 0; i < kHalvings && !(objective(p, beta + delta) >= before); ++i) delta *= 0.5;
  beta += delta;
  return delta.norm() <= kTolerance * (1.0 + beta.norm());
}

LogisticModel described(const Problem& p, const VectorXd& beta,
                        std::span<const std::size_t> selected, bool converged) {
  const VectorXd mu = (p.x * beta).unaryExpr(&logistic);
  const MatrixXd covariance =
      information(p, mu).ldlt().solve(MatrixXd::Identity(beta.size(), beta.size()));
  LogisticModel model;
  model.selected.assign(selected.begin(), selected.end());
  model.intercept = beta[0];
  model.intercept_error = std::sqrt(covariance(0, 0));
  for (Eigen::Index i = 1; i < beta.size(); ++i) {
    model.coefficients.push_back(beta[i]);
    model.coefficient_errors.push_back(std::sqrt(covariance(i, i)));
  }
  model.log_likelihood = log_likelihood(p, beta);
  model.converged = converged;
  return model;
}

/// Of the likelihood-ratio test of nested models that differ in one feature.
double p_value(const LogisticModel& smaller, const LogisticModel& larger) {
  const double ratio = 2.0 * (larger.log_likelihood - smaller.log_likelihood);
  return std::erfc(std::sqrt(0.5 * std::max(0.0, ratio)));
}

std::vector<std::size_t> with(std::vector<std::size_t> features, std::size_t added) {
  features.insert(std::ranges::upper_bound(features, added), added);
  return features;
}

std::vector<std::size_t> without(std::vector<std::size_t> features, std::size_t removed) {
  std::erase(features, removed);
  return features;
}

/// The model with the one further feature that improves it most, if it does so significantly.
std::optional<LogisticModel> entered(std::span<const Example> examples, const LogisticModel& model,
                                     const LogisticConfig& config) {
  std::optional<LogisticModel> best;
  for (std::size_t i = 0; i < examples.front().features.size(); ++i) {
    if (std::ranges::binary_search(model.selected, i)) continue;
    LogisticModel larger = fit(examples, with(model.selected, i), config);
    if (!best || larger.log_likelihood > best->log_likelihood) best = std::move(larger);
  }
  if (best && p_value(model, *best) >= config.enter_p) best.reset();
  return best;
}

/// The model without the feature that matters least, if it does not matter.
std::optional<LogisticModel> left(std::span<const Example> examples, const LogisticModel& model,
                                  const LogisticConfig& config) {
  std::optional<LogisticModel> best;
  for (const std::size_t i : model.selected) {
    LogisticModel smaller = fit(examples, without(model.selected, i), config);
    if (!best || smaller.log_likelihood > best->log_likelihood) best = std::move(smaller);
  }
  if (best && p_value(*best, model) <= config.leave_p) best.reset();
  return best;
}

}  // namespace

LogisticModel fit(std::span<const Example> examples, std::span<const std::size_t> selected,
                  const LogisticConfig& config) {
  assert(!examples.empty());
  const Problem p = problem(examples, selected, config.ridge);
  VectorXd beta = VectorXd::Zero(p.x.cols());
  bool converged = false;
  for (std::size_t i = 0; i < config.iterations && !converged; ++i) converged = step(p, beta);
  return described(p, beta, selected, converged);
}

LogisticModel stepwise(std::span<const Example> examples, const LogisticConfig& config) {
  assert(config.enter_p <= config.leave_p);  // else a feature could come and go for ever
  LogisticModel model = fit(examples, {}, config);
  while (auto larger = entered(examples, model, config)) {
    model = std::move(*larger);
    while (auto smaller = left(examples, model, config)) model = std::move(*smaller);
  }
  return model;
}

double probability(const LogisticModel& model, std::span<const double> features) {
  double z = model.intercept;
  for (std::size_t i = 0; i < model.selected.size(); ++i) {
    z += model.coefficients[i] * features[model.selected[i]];
  }
  return logistic(z);
}

}  // namespace kidnapwatch::core::evaluation
