// SPDX-License-Identifier: Apache-2.0
// Scans to test with: what a lidar sees from the middle of a round room.
#pragma once

#include <cstddef>
#include <numbers>

#include "core/scan.hpp"

namespace kidnapwatch::core {

/// `seconds` after an arbitrary whole second.
inline Stamp at_s(double seconds) {
  return later_by_s(stamp_from_ns(1'700'000'000'000'000'000), seconds);
}

/// A full turn of beams that all hit a wall `radius_m` away.
inline Scan round_room(double radius_m, Stamp stamp, std::size_t beams = 40) {
  const double turn_rad = 2.0 * std::numbers::pi;
  const ScanGeometry geometry{0.0, turn_rad / static_cast<double>(beams), 0.1, 10.0};
  return {stamp, geometry, std::vector<float>(beams, static_cast<float>(radius_m)), {}};
}

/// A scan in which not one beam hit anything.
inline Scan empty_space(Stamp stamp) { return round_room(0.0, stamp); }

}  // namespace kidnapwatch::core
