// SPDX-License-Identifier: Apache-2.0
// Algorithm 3 (QS-2DDTW) and its five siblings.
#include "core/dissimilarity.hpp"

#include <cmath>
#include <initializer_list>

#include "core/dtw.hpp"
#include "core/moments.hpp"

namespace kidnapwatch::core {
namespace {

constexpr double kNoSpread = 1e-9;  // a smaller standard deviation is rounding, not spread

using Axis = std::span<const double>;
struct AxisPair {
  Axis before;
  Axis now;
};

/// Algorithm 3, line 4, on one axis.
bool opens(Gate gate, double statistic, double critical) {
  return statistic < critical && (gate == Gate::homogeneous || statistic > 1.0);
}

bool is_to_be_standardized(std::initializer_list<AxisPair> axes,
                           const DissimilarityConfig& config) {
  if (config.gate == Gate::never || config.gate == Gate::always) {
    return config.gate == Gate::always;
  }
  const auto& any = *axes.begin();
  const double critical = critical_value(config.significance, any.before.size() + any.now.size());
  for (const auto& axis : axes) {
    const double v = variance_statistic(config.variance_test, axis.before, axis.now);
    if (!opens(config.gate, v, critical)) {
      return false;
    }
  }
  return true;
}

/// (value - mean) / standard deviation, in place; only centred where nothing varies.
/// Algorithm 1, lines 1-2.
void standardize(std::vector<double>& axis) {
  const Moments m = moments(axis);
  const double sd = std::sqrt(m.variance);
  const double scale = sd < kNoSpread ? 1.0 : 1.0 / sd;
  for (double& value : axis) {
    value = (value - m.mean) * scale;
  }
}

Dissimilarity with_cost(double cost, std::size_t steps, bool standardized) {
  return {cost, cost / static_cast<double>(steps), standardized};
}

Dissimilarity of_points(Cloud before, Cloud now, const DissimilarityConfig& config) {
  const bool standardized = is_to_be_standardized({{before.x, now.x}, {before.y, now.y}}, config);
  if (standardized) {
    for (auto* axis : {&before.x, &before.y, &now.x, &now.y}) {
      standardize(*axis);
    }
  }
  return with_cost(dtw_cost(before, now), before.size() + now.size(), standardized);
}

Dissimilarity of_ranges(std::vector<double> before, std::vector<double> now,
                        const DissimilarityConfig& config) {
  const bool standardized = is_to_be_standardized({{before, now}}, config);
  if (standardized) {
    standardize(before);
    standardize(now);
  }
  return with_cost(dtw_cost(before, now), before.size() + now.size(), standardized);
}

}  // namespace

Dissimilarity dissimilarity(const Scan& before, const Scan& now,
                            const DissimilarityConfig& config) {
  return config.dimension == Dimension::points
             ? of_points(cloud(before, config.invalid), cloud(now, config.invalid), config)
             : of_ranges(kept_ranges(before, config.invalid), kept_ranges(now, config.invalid),
                         config);
}

std::string_view detector_name(const DissimilarityConfig& config) {
  const bool points = config.dimension == Dimension::points;
  switch (config.gate) {
    case Gate::never:
      return points ? "2ddtw" : "1ddtw";
    case Gate::always:
      return points ? "s2ddtw" : "s1ddtw";
    case Gate::paper:
    case Gate::homogeneous:
      break;
  }
  return points ? "qs2ddtw" : "qs1ddtw";
}

}  // namespace kidnapwatch::core
