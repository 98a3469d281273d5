// SPDX-License-Identifier: Apache-2.0
// A scan as points in the plane. Eq. (1).
#pragma once

#include <span>
#include <vector>

#include "core/scan.hpp"

namespace kidnapwatch::core {

/// Points in beam order, x.size() == y.size(). Metres, or standard deviations once standardised.
struct Cloud {
  std::vector<double> x;
  std::vector<double> y;

  [[nodiscard]] std::size_t size() const noexcept { return x.size(); }
  friend bool operator==(const Cloud&, const Cloud&) = default;
};

/// What to do with a beam that hit nothing. A zero range never becomes a point at the sensor.
enum class InvalidPolicy {
  drop,   ///< leave the beam out
  clamp,  ///< put it at range_max
};

/// The ranges that the policy keeps, in beam order, in metres: the one-dimensional form of a scan.
[[nodiscard]] std::vector<double> kept_ranges(const Scan& scan, InvalidPolicy policy);

/// Eq. (1): r (cos phi, sin phi) of every beam that the policy keeps, in beam order, in metres and
/// in the sensor's frame.
[[nodiscard]] Cloud cloud(const Scan& scan, InvalidPolicy policy);

}  // namespace kidnapwatch::core
