// SPDX-License-Identifier: Apache-2.0
// How unlike two consecutive scans are: Algorithm 3 (QS-2DDTW) and its five siblings.
#pragma once

#include <string_view>

#include "core/cloud.hpp"
#include "core/dtw_kernel.hpp"
#include "core/moments.hpp"
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
  Precision precision = Precision::f32;

  friend bool operator==(const DissimilarityConfig&, const DissimilarityConfig&) = default;
};

struct Dissimilarity {
  double cost = 0.0;           ///< of the whole warping path; metres, or sigmas if standardised
  double cost_per_beam = 0.0;  ///< cost / (n + m)
  bool standardized = false;

  friend bool operator==(const Dissimilarity&, const Dissimilarity&) = default;
};

/// A scan made ready to be compared any number of times.
struct Sample {
  Cloud values;  ///< the points; for Dimension::ranges the ranges in x, and nothing in y
  Moments x;     ///< of values.x
  Moments y;     ///< of values.y, if there are any

  [[nodiscard]] std::size_t size() const noexcept { return values.x.size(); }
};

/// Makes `sample`, whose memory is reused, of a comparable scan (is_comparable).
void prepare(const Scan& scan, const DissimilarityConfig& config, Bearings& bearings,
             Sample& sample);

/// Memory for comparing, for one thread at a time; any number of robots can share it. Nothing is
/// allocated once it has seen the largest scan.
struct DissimilarityWorkspace {
  DtwWorkspace dtw;
  CriticalValues critical_values;
  Cloud before;  // standardised
  Cloud now;
};

/// What is warped: the samples, or both standardised.
struct Gated {
  const Cloud& before;
  const Cloud& now;
  bool standardized = false;
};

/// Algorithm 3, line 4. What it refers to is in the samples or in the workspace.
[[nodiscard]] Gated gated(const Sample& before, const Sample& now,
                          const DissimilarityConfig& config, DissimilarityWorkspace& workspace);

/// Algorithm 3, for samples prepared with this `config`.
[[nodiscard]] Dissimilarity dissimilarity(const Sample& before, const Sample& now,
                                          const DissimilarityConfig& config,
                                          DissimilarityWorkspace& workspace);

/// The same from scratch. Both scans are comparable.
[[nodiscard]] Dissimilarity dissimilarity(const Scan& before, const Scan& now,
                                          const DissimilarityConfig& config);

/// The variant's name in the paper's manner: "qs2ddtw", "2ddtw", "s1ddtw", ...
[[nodiscard]] std::string_view detector_name(const DissimilarityConfig& config);

}  // namespace kidnapwatch::core
