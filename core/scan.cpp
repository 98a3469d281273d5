// SPDX-License-Identifier: Apache-2.0
// Which scans can be computed with, and which can be compared.
#include "core/scan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/outcome.hpp"

namespace kidnapwatch::core {
namespace {

constexpr std::size_t kFewestBeams = 20;
constexpr double kFewestShare = 0.10;

void check_beams(std::size_t beams) {
  if (beams == 0) {
    throw BadScan(Outcome::no_beams, "ranges", "has no beams");
  }
  if (beams > kMaxBeams) {
    throw BadScan(Outcome::too_many_beams, "ranges", "has more than 65536 beams");
  }
}

void check_sweep(const ScanGeometry& geometry, std::size_t beams) {
  if (!std::isfinite(geometry.angle_min_rad)) {
    throw BadScan(Outcome::bad_geometry, "angle_min", "must be finite");
  }
  const double increment_rad = std::abs(geometry.angle_increment_rad);
  if (!(increment_rad > 0.0) || !std::isfinite(increment_rad)) {
    throw BadScan(Outcome::bad_geometry, "angle_increment", "must be finite and not 0");
  }
  // One beam and a little more than a turn: XV-11 drivers send 361 beams of one degree.
  const double turn_rad = 2.0 * std::numbers::pi;
  if (static_cast<double>(beams - 1) * increment_rad > 1.01 * turn_rad) {
    throw BadScan(Outcome::bad_geometry, "angle_increment", "sweeps more than one turn");
  }
}

void check_reach(const ScanGeometry& geometry) {
  if (!(geometry.range_min_m >= 0.0) || !std::isfinite(geometry.range_min_m)) {
    throw BadScan(Outcome::bad_geometry, "range_min", "must be finite and at least 0");
  }
  if (!(geometry.range_max_m > geometry.range_min_m) || !std::isfinite(geometry.range_max_m)) {
    throw BadScan(Outcome::bad_geometry, "range_max", "must be finite and above range_min");
  }
}

}  // namespace

void check(const Scan& scan) {
  check_beams(scan.ranges_m.size());
  check_sweep(scan.geometry, scan.ranges_m.size());
  check_reach(scan.geometry);
}

std::size_t valid_beams(const Scan& scan) {
  return static_cast<std::size_t>(std::ranges::count_if(
      scan.ranges_m, [&](float range_m) { return is_valid(range_m, scan.geometry); }));
}

bool is_comparable(const Scan& scan) {
  const auto share = kFewestShare * static_cast<double>(scan.ranges_m.size());
  const std::size_t valid = valid_beams(scan);
  return valid >= kFewestBeams && static_cast<double>(valid) >= share;
}

}  // namespace kidnapwatch::core
