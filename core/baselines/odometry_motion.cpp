// SPDX-License-Identifier: Apache-2.0
// The odometry motion model.
#include "core/baselines/odometry_motion.hpp"

#include <cmath>
#include <numbers>

namespace kidnapwatch::core::baselines {
namespace {

constexpr double kHardlyMoved = 0.01;  // m: below, the direction of a motion is rounding

/// Driving backwards is no half turn.
double square_of_turn(double turn_rad) {
  const double size_rad = std::abs(turn_rad);
  const double least_rad = std::min(size_rad, std::abs(std::numbers::pi - size_rad));
  return least_rad * least_rad;
}

}  // namespace

Pose motion_between(const Scan& before, const Scan& now) {
  if (!before.odometry || !now.odometry) return {};
  return inverse(*before.odometry) * *now.odometry;
}

OdometryMotion::OdometryMotion(const Pose& T_before_now, const OdometryNoise& noise)
    : turn1_rad_(0.0), drive_m_(std::hypot(T_before_now.x_m, T_before_now.y_m)) {
  if (drive_m_ >= kHardlyMoved) turn1_rad_ = std::atan2(T_before_now.y_m, T_before_now.x_m);
  turn2_rad_ = wrapped(T_before_now.theta_rad - turn1_rad_);
  const double turn1 = square_of_turn(turn1_rad_);
  const double turn2 = square_of_turn(turn2_rad_);
  const double drive = drive_m_ * drive_m_;
  const double floor_m = noise.least_m * noise.least_m;
  const double floor_rad = noise.least_rad * noise.least_rad;
  turn1_sd_rad_ = std::sqrt(noise.alpha1 * turn1 + noise.alpha2 * drive + floor_rad);
  drive_sd_m_ = std::sqrt(noise.alpha3 * drive + noise.alpha4 * (turn1 + turn2) + floor_m);
  turn2_sd_rad_ = std::sqrt(noise.alpha1 * turn2 + noise.alpha2 * drive + floor_rad);
}

Pose OdometryMotion::drawn(const Pose& before, std::mt19937_64& random, Normal& normal) const {
  const double turn1_rad = turn1_rad_ + turn1_sd_rad_ * normal(random);
  const double drive_m = drive_m_ + drive_sd_m_ * normal(random);
  const double turn2_rad = turn2_rad_ + turn2_sd_rad_ * normal(random);
  const double heading_rad = before.theta_rad + turn1_rad;
  return {before.x_m + drive_m * std::cos(heading_rad),
          before.y_m + drive_m * std::sin(heading_rad), wrapped(heading_rad + turn2_rad)};
}

}  // namespace kidnapwatch::core::baselines
