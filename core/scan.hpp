// SPDX-License-Identifier: Apache-2.0
// One sweep of a 2-D lidar, as sensor_msgs/LaserScan carries it (the paper's section 2.1).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/pose.hpp"
#include "core/stamp.hpp"

namespace kidnapwatch::core {

/// How a lidar sweeps: beam i points to angle_min_rad + i * angle_increment_rad.
struct ScanGeometry {
  double angle_min_rad = 0.0;
  double angle_increment_rad = 0.0;  ///< negative for a lidar that turns clockwise
  double range_min_m = 0.0;
  double range_max_m = 0.0;

  friend bool operator==(const ScanGeometry&, const ScanGeometry&) = default;
};

struct Scan {
  Stamp stamp;
  ScanGeometry geometry;
  std::vector<float> ranges_m;   ///< in beam order; invalid beams as recorded
  std::optional<Pose> odometry;  ///< T_odom_base at `stamp`, where the robot told it
};

/// Most beams that a scan may have.
inline constexpr std::size_t kMaxBeams = 65536;

/// Throws BadInput naming the field unless the scan can be computed with: 1..kMaxBeams beams;
/// finite angles, an increment that is not 0 and sweeps at most one turn (and one beam); finite 0
/// <= range_min < range_max.
void check(const Scan& scan);

/// Whether beam `range_m` hit something in reach: finite and range_min < r < range_max, so that 0,
/// inf, NaN and "at least range_max" codes are all misses (section 3.1, Eq. 1). The limits are
/// taken as floats, as messages carry them: a range of "5.6" is no nearer than a limit of "5.6".
[[nodiscard]] constexpr bool is_valid(float range_m, const ScanGeometry& geometry) {
  return range_m > static_cast<float>(geometry.range_min_m) &&
         range_m < static_cast<float>(geometry.range_max_m);  // NaN compares false
}

[[nodiscard]] std::size_t valid_beams(const Scan& scan);

/// Whether enough beams are valid for a score to mean anything: max(20, 10 % of all).
[[nodiscard]] bool is_comparable(const Scan& scan);

}  // namespace kidnapwatch::core
