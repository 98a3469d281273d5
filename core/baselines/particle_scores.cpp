// SPDX-License-Identifier: Apache-2.0
// Scores of particle weights. Eqs. (9)-(12).
#include "core/baselines/particle_scores.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kidnapwatch::core::baselines {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double max_current_weight(std::span<const double> weights) {
  double most = 0.0;
  for (const double weight : weights) most = std::max(most, weight);  // Eq. (9)
  return most;
}

double measurement_entropy(std::span<const double> weights) {
  double sum = 0.0;
  double w_log_w = 0.0;
  for (const double weight : weights) {
    if (!(weight >= 0.0)) return kNaN;
    sum += weight;
    if (weight > 0.0) w_log_w += weight * std::log(weight);
  }
  if (!(sum > 0.0) || !std::isfinite(sum)) return kNaN;
  // Eqs. (10)-(12): -sum (w / W) ln (w / W), with the normaliser W = sum w taken out.
  return std::max(0.0, std::log(sum) - w_log_w / sum);
}

double measurement_entropy_of_logs(std::span<const double> log_weights) {
  double most = -std::numeric_limits<double>::infinity();
  for (const double log_weight : log_weights) most = std::max(most, log_weight);
  if (!std::isfinite(most)) return kNaN;
  double sum = 0.0;
  double w_log_w = 0.0;
  for (const double log_weight : log_weights) {
    const double weight = std::exp(log_weight - most);
    sum += weight;
    if (weight > 0.0) w_log_w += weight * (log_weight - most);
  }
  return std::max(0.0, std::log(sum) - w_log_w / sum);
}

double effective_sample_size(std::span<const double> weights) {
  double sum = 0.0;
  double squares = 0.0;
  for (const double weight : weights) {
    sum += weight;
    squares += weight * weight;
  }
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

}  // namespace kidnapwatch::core::baselines
