// SPDX-License-Identifier: Apache-2.0
// Mean and variance of a sample.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace kidnapwatch::core {

struct Moments {
  double mean = 0.0;
  double variance = 0.0;  ///< with n - 1

  friend bool operator==(const Moments&, const Moments&) = default;
};

/// Of at least one value; the variance of a single one is 0. One pass over the differences from the
/// first value, so that a small variance far from 0 keeps its digits and a constant has none. Eight
/// sums run side by side: one would wait for every addition.
[[nodiscard]] constexpr Moments moments(std::span<const double> sample) {
  constexpr std::size_t kLanes = 8;
  std::array<double, kLanes> sums{};
  std::array<double, kLanes> squares{};
  const double origin = sample[0];
  const std::size_t whole = sample.size() / kLanes * kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double off = sample[i + lane] - origin;
      sums[lane] += off;
      squares[lane] += off * off;
    }
  }
  for (std::size_t i = whole; i < sample.size(); ++i) {
    const double off = sample[i] - origin;
    sums[i - whole] += off;
    squares[i - whole] += off * off;
  }
  double sum = 0.0;
  double square = 0.0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    sum += sums[lane];
    square += squares[lane];
  }
  const auto n = static_cast<double>(sample.size());
  const double spread = square - sum * sum / n;
  return {origin + sum / n, sample.size() > 1 && spread > 0.0 ? spread / (n - 1.0) : 0.0};
}

}  // namespace kidnapwatch::core
