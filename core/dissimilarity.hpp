// SPDX-License-Identifier: Apache-2.0
// How unlike two consecutive scans are: Algorithm 3 (QS-2DDTW) and its five siblings.
#pragma once

#include <string_view>

#include "core/cloud.hpp"
#include "core/variance.hpp"

namespace kidnapwatch::core {

enum class Dimension {
  ranges,  ///< 1-D: the ranges themselves
  points,  ///< 2-D: the points in the plane
};

/// When the samples are standardised before they are warped: Algorithm 3, line 4.
enum class Gate {
  paper,        ///< 1 < V < c on every axis, as printed
  homogeneous,  ///< V < c on every axis: whenever the variances do not differ
  never,        ///< the raw score
  always,       ///< Algorithm 1: MD-DTW of standardised samples
};

struct DissimilarityConfig {
  Dimension dimension = Dimension::points;
  Gate gate = Gate::paper;
  VarianceTest variance_test = VarianceTest::bartlett;
  double significance = 0.05;
  InvalidPolicy invalid = InvalidPolicy::drop;

  friend bool operator==(const DissimilarityConfig&, const DissimilarityConfig&) = default;
};

struct Dissimilarity {
  double cost = 0.0;           ///< of the whole warping path; metres, or sigmas if standardised
  double cost_per_beam = 0.0;  ///< cost / (n + m)
  bool standardized = false;

  friend bool operator==(const Dissimilarity&, const Dissimilarity&) = default;
};

/// Algorithm 3. Both scans are comparable (is_comparable).
[[nodiscard]] Dissimilarity dissimilarity(const Scan& before, const Scan& now,
                                          const DissimilarityConfig& config);

/// The variant's name in the paper's manner: "qs2ddtw", "2ddtw", "s1ddtw", ...
[[nodiscard]] std::string_view detector_name(const DissimilarityConfig& config);

}  // namespace kidnapwatch::core
