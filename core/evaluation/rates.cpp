// SPDX-License-Identifier: Apache-2.0
// Wilson's interval and empirical quantiles.
#include "core/evaluation/rates.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace kidnapwatch::core::evaluation {
namespace {

constexpr double kZ = 1.959963984540054;  // 97.5 % of a standard normal

/// End of Wilson's interval on the side of `sign`.
double wilson(const Rate& rate, double sign) {
  const auto n = static_cast<double>(rate.trials);
  const double p = rate.value();
  const double centre = p + kZ * kZ / (2.0 * n);
  const double margin = kZ * std::sqrt(p * (1.0 - p) / n + kZ * kZ / (4.0 * n * n));
  return std::clamp((centre + sign * margin) / (1.0 + kZ * kZ / n), 0.0, 1.0);
}

}  // namespace

double Rate::value() const {
  return trials > 0 ? static_cast<double>(hits) / static_cast<double>(trials) : 0.0;
}

double Rate::low() const { return hits > 0 ? wilson(*this, -1.0) : 0.0; }

double Rate::high() const { return trials > 0 ? wilson(*this, 1.0) : 1.0; }

double threshold_at(std::span<const double> negatives, double rate) {
  assert(!negatives.empty());
  std::vector<double> sorted(negatives.begin(), negatives.end());
  const auto above = static_cast<std::size_t>(rate * static_cast<double>(sorted.size()));
  const auto at =
      sorted.end() - 1 - static_cast<std::ptrdiff_t>(std::min(above, sorted.size() - 1));
  std::ranges::nth_element(sorted, at);
  return *at;
}

Rate share_above(std::span<const double> scores, double threshold) {
  const auto hits = std::ranges::count_if(scores, [=](double score) { return score > threshold; });
  return {static_cast<std::size_t>(hits), scores.size()};
}

}  // namespace kidnapwatch::core::evaluation
