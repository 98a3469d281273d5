// SPDX-License-Identifier: Apache-2.0
// The cost of core/dtw.hpp at the speed of the processor's vector units. Algorithm 1 (lines 3-5).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/cloud.hpp"

namespace kidnapwatch::core {

/// The arithmetic that a pair is warped in.
enum class Precision {
  f32,  ///< for sessions: the same bits on every processor; within 3e-6 of f64 on two scans, 1.3e-5
        ///< on copies of one, whose cost is all rounding
  f64,  ///< for audits: the very bits of the plain dtw_cost(p, q)
};

/// Memory of the kernel, for one thread at a time. It grows to the largest pair seen, about 20
/// bytes a beam and 16 KiB (twice that in f64); calls that fit into it allocate nothing. What it
/// holds between calls means nothing.
struct DtwWorkspace {
  std::vector<float> f32;
  std::vector<double> f64;

  /// Pairs of at least so many beams each are tried within a band first, which takes a half to a
  /// third of the time if the scans are alike. The cost is exact either way.
  std::size_t band_from = 500;
};

/// dtw_cost(p, q): no window, no approximation. Neither cloud is empty, all coordinates are finite.
/// f32 rounds the coordinates and every sum to 24 bits; clouds of coordinates too large or too
/// small for that are warped in f64.
[[nodiscard]] double dtw_cost(const Cloud& p, const Cloud& q, Precision precision,
                              DtwWorkspace& workspace);

/// The same for sequences of ranges: the one-dimensional form.
[[nodiscard]] double dtw_cost(std::span<const double> p, std::span<const double> q,
                              Precision precision, DtwWorkspace& workspace);

}  // namespace kidnapwatch::core
