// SPDX-License-Identifier: Apache-2.0
// Rates with what is known of their uncertainty, and thresholds for a rate that is wanted.
#pragma once

#include <cstddef>
#include <span>

namespace kidnapwatch::core::evaluation {

/// `hits` of `trials`, with Wilson's 95 % interval. Without trials: 0 in [0, 1].
struct Rate {
  std::size_t hits = 0;
  std::size_t trials = 0;

  [[nodiscard]] double value() const;
  [[nodiscard]] double low() const;
  [[nodiscard]] double high() const;
};

/// The least score that at most a share `rate` of `negatives` exceeds. With fewer than 1 / rate of
/// them the greatest: no smaller rate can be shown then. Not empty.
[[nodiscard]] double threshold_at(std::span<const double> negatives, double rate);

[[nodiscard]] Rate share_above(std::span<const double> scores, double threshold);

}  // namespace kidnapwatch::core::evaluation
