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

void Bearings::fit(const ScanGeometry& geometry, std::size_t beams) {
  if (geometry.angle_min_rad != angle_min_rad_ ||
      geometry.angle_increment_rad != angle_increment_rad_) {
    angle_min_rad_ = geometry.angle_min_rad;
    angle_increment_rad_ = geometry.angle_increment_rad;
    cosines_.clear();
    sines_.clear();
  }
  for (std::size_t beam = cosines_.size(); beam < beams; ++beam) {
    const double bearing_rad = angle_min_rad_ + static_cast<double>(beam) * angle_increment_rad_;
    cosines_.push_back(std::cos(bearing_rad));
    sines_.push_back(std::sin(bearing_rad));
  }
}

void keep_ranges(const Scan& scan, InvalidPolicy policy, std::vector<double>& ranges_m) {
  ranges_m.clear();
  ranges_m.reserve(scan.ranges_m.size());
  for_each_kept(scan, policy, [&](std::size_t, double range_m) { ranges_m.push_back(range_m); });
}

void project(const Scan& scan, InvalidPolicy policy, Bearings& bearings, Cloud& points) {
  bearings.fit(scan.geometry, scan.ranges_m.size());
  points.x.resize(scan.ranges_m.size());
  points.y.resize(scan.ranges_m.size());
  std::size_t kept = 0;
  for_each_kept(scan, policy, [&](std::size_t beam, double range_m) {
    points.x[kept] = range_m * bearings.cosine(beam);  // Eq. (1)
    points.y[kept] = range_m * bearings.sine(beam);
    ++kept;
  });
  points.x.resize(kept);
  points.y.resize(kept);
}

std::vector<std::size_t> kept_beams(const Scan& scan, InvalidPolicy policy) {
  std::vector<std::size_t> beams;
  for_each_kept(scan, policy, [&](std::size_t beam, double) { beams.push_back(beam); });
  return beams;
}

std::vector<double> kept_ranges(const Scan& scan, InvalidPolicy policy) {
  std::vector<double> ranges_m;
  keep_ranges(scan, policy, ranges_m);
  return ranges_m;
}

Cloud cloud(const Scan& scan, InvalidPolicy policy) {
  Bearings bearings;
  Cloud points;
  project(scan, policy, bearings, points);
  return points;
}

}  // namespace kidnapwatch::core
