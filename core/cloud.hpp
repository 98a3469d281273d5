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

/// The cosine and sine of every beam's bearing: computed once for a geometry, and kept for as long
/// as scans of the same one come.
class Bearings {
 public:
  /// For beams 0..beams-1 of `geometry`.
  void fit(const ScanGeometry& geometry, std::size_t beams);

  [[nodiscard]] double cosine(std::size_t beam) const { return cosines_[beam]; }
  [[nodiscard]] double sine(std::size_t beam) const { return sines_[beam]; }

 private:
  double angle_min_rad_ = 0.0;
  double angle_increment_rad_ = 0.0;
  std::vector<double> cosines_;
  std::vector<double> sines_;
};

/// The ranges that the policy keeps, in beam order, in metres: the one-dimensional form of a scan.
/// `ranges_m` is replaced; its memory is reused.
void keep_ranges(const Scan& scan, InvalidPolicy policy, std::vector<double>& ranges_m);

/// Eq. (1): r (cos phi, sin phi) of every beam that the policy keeps, in beam order, in metres and
/// in the sensor's frame. `points` is replaced; its memory is reused.
void project(const Scan& scan, InvalidPolicy policy, Bearings& bearings, Cloud& points);

/// The beam of each of these points.
[[nodiscard]] std::vector<std::size_t> kept_beams(const Scan& scan, InvalidPolicy policy);

/// The same, as a value.
[[nodiscard]] std::vector<double> kept_ranges(const Scan& scan, InvalidPolicy policy);
[[nodiscard]] Cloud cloud(const Scan& scan, InvalidPolicy policy);

}  // namespace kidnapwatch::core
