// SPDX-License-Identifier: Apache-2.0
// Dynamic time warping of one scan onto the next. Algorithm 1 (lines 3-5), Remark 1.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/cloud.hpp"

namespace kidnapwatch::core {

/// Cost of the cheapest alignment of `p` with `q`: the sum of the L1 distances of all matched
/// beams, in the unit of the clouds.
///
/// The alignment starts at both first beams, ends at both last beams, never turns back and never
/// skips a beam: the cost is symmetric, and 0 exactly for clouds that differ only in how long they
/// dwell on each point.
///
/// Neither cloud is empty. Time O(p.size() q.size()), memory O(q.size()).
[[nodiscard]] double dtw_cost(const Cloud& p, const Cloud& q);

/// The same for sequences of ranges: the one-dimensional form.
[[nodiscard]] double dtw_cost(std::span<const double> p, std::span<const double> q);

/// Two matched beams, by their places in the two sequences.
struct WarpingStep {
  std::size_t p = 0;
  std::size_t q = 0;
  double cost = 0.0;  ///< their L1 distance

  friend bool operator==(const WarpingStep&, const WarpingStep&) = default;
};

/// A cheapest alignment itself, from both first beams to both last: its costs add up to dtw_cost().
/// Where several are as cheap, the one that dwells least. A cloud without y is a sequence of
/// ranges.
///
/// Neither cloud is empty. Time and memory O(p.size() q.size()), a byte each.
[[nodiscard]] std::vector<WarpingStep> dtw_path(const Cloud& p, const Cloud& q);

}  // namespace kidnapwatch::core
