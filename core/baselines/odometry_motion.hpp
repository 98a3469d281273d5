// SPDX-License-Identifier: Apache-2.0
// Where a robot may have gone when odometry says it moved so (Thrun, Burgard, Fox 2005, Table 5.6).
#pragma once

#include <random>

#include "core/pose.hpp"
#include "core/random.hpp"
#include "core/scan.hpp"

namespace kidnapwatch::core::baselines {

/// Variances as shares of squared motions, and a floor for a robot that hardly moves.
struct OdometryNoise {
  double alpha1 = 0.02;   ///< of a turn, by turning: rad^2 / rad^2
  double alpha2 = 0.02;   ///< of a turn, by driving: rad^2 / m^2
  double alpha3 = 0.02;   ///< of a distance, by driving: m^2 / m^2
  double alpha4 = 0.005;  ///< of a distance, by turning: m^2 / rad^2
  double least_m = 0.005;
  double least_rad = 0.003;
};

/// T_before_now by odometry; none where one of the scans has no odometry.
[[nodiscard]] Pose motion_between(const Scan& before, const Scan& now);

/// A motion of the base, taken apart: turn, drive, turn; and how far each is to be trusted.
class OdometryMotion {
 public:
  OdometryMotion(const Pose& T_before_now, const OdometryNoise& noise);

  /// The pose after the motion from `before`, drawn at random.
  [[nodiscard]] Pose drawn(const Pose& before, std::mt19937_64& random, Normal& normal) const;

 private:
  double turn1_rad_;
  double drive_m_;
  double turn2_rad_;
  double turn1_sd_rad_;
  double drive_sd_m_;
  double turn2_sd_rad_;
};

}  // namespace kidnapwatch::core::baselines
