// SPDX-License-Identifier: Apache-2.0
// Eqs. (2) and (3), for both polarities at once.
#include "core/evaluation/performance_index.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kidnapwatch::core::evaluation {
namespace {

/// The score among steps 2..last, without t_k, that looks most like a kidnapping.
std::optional<double> rival(std::span<const std::optional<double>> scores, std::size_t t_k,
                            std::size_t last, Polarity polarity) {
  std::optional<double> strongest;
  for (std::size_t t = 2; t <= last; ++t) {
    const auto& score = scores[t - 1];
    if (t == t_k || !score) continue;
    if (!std::isfinite(*score)) return score;
    if (!strongest || raised(*score, polarity) > raised(*strongest, polarity)) strongest = score;
  }
  return strongest;
}

}  // namespace

std::optional<double> performance_index(std::span<const std::optional<double>> scores,
                                        std::size_t t_k, Polarity polarity, Evaluator evaluator) {
  assert(t_k >= 1 && t_k <= scores.size());
  const std::size_t last = evaluator == Evaluator::prior ? t_k - 1 : scores.size();
  const auto other = rival(scores, t_k, last, polarity);
  if (!other) return std::nullopt;
  const auto& kidnapped = scores[t_k - 1];
  if (!kidnapped || !std::isfinite(*kidnapped) || !std::isfinite(*other)) return -1.0;
  const double gap = raised(*kidnapped, polarity) - raised(*other, polarity);
  const double scale = std::max(std::abs(*kidnapped), std::abs(*other));
  return scale > 0.0 ? gap / scale : 0.0;  // Eqs. (2), (3)
}

Performance performance(std::span<const double> etas) {
  Performance result;
  result.kidnappings = etas.size();
  if (etas.empty()) return result;
  for (const double eta : etas) {
    result.mean += eta;
    result.undetected += eta <= 0.0 ? 1.0 : 0.0;
  }
  result.mean /= static_cast<double>(etas.size());
  result.undetected /= static_cast<double>(etas.size());
  return result;
}

}  // namespace kidnapwatch::core::evaluation
