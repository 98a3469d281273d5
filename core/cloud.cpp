// SPDX-License-Identifier: Apache-2.0
// A scan as points in the plane. Eq. (1).
#include "core/cloud.hpp"

#include <cmath>

namespace kidnapwatch::core {
namespace {

/// Calls visit(beam, range in metres) for every beam that the policy keeps.
template <typename Visit>
void for_each_kept(const Scan& scan, InvalidPolicy policy, Visit visit) {
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    if (is_valid(scan.ranges_m[i], scan.geometry)) {
      visit(i, static_cast<double>(scan.ranges_m[i]));
    } else if (policy == InvalidPolicy::clamp) {
      visit(i, scan.geometry.range_max_m);
    }
  }
}

}  // namespace

std::vector<double> kept_ranges(const Scan& scan, InvalidPolicy policy) {
  std::vector<double> ranges_m;
  ranges_m.reserve(scan.ranges_m.size());
  for_each_kept(scan, policy, [&](std::size_t, double range_m) { ranges_m.push_back(range_m); });
  return ranges_m;
}

Cloud cloud(const Scan& scan, InvalidPolicy policy) {
  Cloud points;
  points.x.reserve(scan.ranges_m.size());
  points.y.reserve(scan.ranges_m.size());
  for_each_kept(scan, policy, [&](std::size_t beam, double range_m) {
    const double bearing_rad =
        scan.geometry.angle_min_rad + static_cast<double>(beam) * scan.geometry.angle_increment_rad;
    points.x.push_back(range_m * std::cos(bearing_rad));  // Eq. (1)
    points.y.push_back(range_m * std::sin(bearing_rad));
  });
  return points;
}

}  // namespace kidnapwatch::core
