// SPDX-License-Identifier: Apache-2.0
// Mean and variance of a sample.
#pragma once

#include <span>

namespace kidnapwatch::core {

struct Moments {
  double mean = 0.0;
  double variance = 0.0;  ///< with n - 1
};

/// Of at least one value; the variance of a single one is 0. Two passes, so that a small variance
/// far from 0 keeps its digits.
[[nodiscard]] constexpr Moments moments(std::span<const double> sample) {
  const auto n = static_cast<double>(sample.size());
  double sum = 0.0;
  for (const double value : sample) {
    sum += value;
  }
  const double mean = sum / n;
  double squares = 0.0;
  for (const double value : sample) {
    squares += (value - mean) * (value - mean);
  }
  return {mean, sample.size() > 1 ? squares / (n - 1.0) : 0.0};
}

}  // namespace kidnapwatch::core
