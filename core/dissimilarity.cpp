// SPDX-License-Identifier: Apache-2.0
// Algorithm 3 (QS-2DDTW) and its five siblings.
#include "core/dissimilarity.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace kidnapwatch::core {
namespace {

constexpr double kNoSpread = 1e-9;  // a smaller standard deviation is rounding, not spread

double statistic(VarianceTest test, std::span<const double> a, const Moments& of_a,
                 std::span<const double> b, const Moments& of_b) {
  return test == VarianceTest::bartlett ? bartlett_statistic(of_a, a.size(), of_b, b.size())
                                        : variance_statistic(test, a, b);
}

/// Algorithm 3, line 4.
bool is_to_be_standardized(const Sample& before, const Sample& now,
                           const DissimilarityConfig& config, CriticalValues& critical_values) {
  if (config.gate == Gate::never || config.gate == Gate::always) {
    return config.gate == Gate::always;
  }
  const double low = config.gate == Gate::paper ? 1.0 : -1.0;
  const auto test = config.variance_test;
  const bool flat = config.dimension == Dimension::ranges;
  const double v_x = statistic(test, before.values.x, before.x, now.values.x, now.x);
  const double v_y = flat ? v_x : statistic(test, before.values.y, before.y, now.values.y, now.y);
  if (std::min(v_x, v_y) <= low) {
    return false;
  }
  return std::max(v_x, v_y) < critical_values.at(config.significance, before.size() + now.size());
}

/// (value - mean) / standard deviation; only centred where nothing varies. Algorithm 1, lines 1-2.
void standardize(const std::vector<double>& axis, const Moments& moments,
                 std::vector<double>& standardized) {
  const double sd = std::sqrt(moments.variance);
  const double scale = sd < kNoSpread ? 1.0 : 1.0 / sd;
  standardized.resize(axis.size());
  std::ranges::transform(axis, standardized.begin(),
                         [&](double value) { return (value - moments.mean) * scale; });
}

const Cloud& standardized(const Sample& sample, Cloud& memory) {
  standardize(sample.values.x, sample.x, memory.x);
  standardize(sample.values.y, sample.y, memory.y);
  return memory;
}

double cost(const Cloud& before, const Cloud& now, const DissimilarityConfig& config,
            DtwWorkspace& workspace) {
  return config.dimension == Dimension::points
             ? dtw_cost(before, now, config.precision, workspace)
             : dtw_cost(before.x, now.x, config.precision, workspace);
}

}  // namespace

void prepare(const Scan& scan, const DissimilarityConfig& config, Bearings& bearings,
             Sample& sample) {
  if (config.dimension == Dimension::points) {
    project(scan, config.invalid, bearings, sample.values);
    sample.y = moments(sample.values.y);
  } else {
    keep_ranges(scan, config.invalid, sample.values.x);
    sample.values.y.clear();
  }
  sample.x = moments(sample.values.x);
}

Gated gated(const Sample& before, const Sample& now, const DissimilarityConfig& config,
            DissimilarityWorkspace& workspace) {
  if (!is_to_be_standardized(before, now, config, workspace.critical_values)) {
    return {before.values, now.values, false};
  }
  return {standardized(before, workspace.before), standardized(now, workspace.now), true};
}

Dissimilarity dissimilarity(const Sample& before, const Sample& now,
                            const DissimilarityConfig& config, DissimilarityWorkspace& workspace) {
  const Gated warped = gated(before, now, config, workspace);
  Dissimilarity result;
  result.standardized = warped.standardized;
  result.cost = cost(warped.before, warped.now, config, workspace.dtw);
  result.cost_per_beam = result.cost / static_cast<double>(before.size() + now.size());
  return result;
}

Dissimilarity dissimilarity(const Scan& before, const Scan& now,
                            const DissimilarityConfig& config) {
  Bearings bearings;
  Sample sample_before;
  Sample sample_now;
  prepare(before, config, bearings, sample_before);
  prepare(now, config, bearings, sample_now);
  DissimilarityWorkspace workspace;
  return dissimilarity(sample_before, sample_now, config, workspace);
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
