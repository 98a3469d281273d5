// SPDX-License-Identifier: Apache-2.0
// Normally distributed numbers that are the same with every standard library.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

namespace kidnapwatch::core {

/// Uniform in [0, 1), from the upper 53 bits.
[[nodiscard]] inline double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1p-53;
}

/// Independent standard normal numbers (Box and Muller 1958): std::normal_distribution is left to
/// the implementation, so that its runs would not repeat elsewhere.
class Normal {
 public:
  double operator()(std::mt19937_64& random) {
    if (spare_) return *std::exchange(spare_, std::nullopt);
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(random)));
    const double angle_rad = 2.0 * std::numbers::pi * uniform(random);
    spare_ = radius * std::sin(angle_rad);
    return radius * std::cos(angle_rad);
  }

 private:
  std::optional<double> spare_;
};

}  // namespace kidnapwatch::core
