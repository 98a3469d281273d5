// SPDX-License-Identifier: Apache-2.0
// Interpolates odometry.
#include "adapters/logs/odometry.hpp"

#include <algorithm>

namespace kidnapwatch::adapters::logs {
namespace {

constexpr double kNear = 0.5;  // s

core::Pose between(const TimedPose& a, const TimedPose& b, double time_s) {
  const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
  const core::Pose& from = a.T_odom_base;
  const core::Pose& to = b.T_odom_base;
  return {from.x_m + share * (to.x_m - from.x_m), from.y_m + share * (to.y_m - from.y_m),
          core::wrapped(from.theta_rad + share * core::wrapped(to.theta_rad - from.theta_rad))};
}

}  // namespace

std::optional<core::Pose> pose_at(std::span<const TimedPose> poses, double time_s) {
  const auto after = std::ranges::lower_bound(poses, time_s, {}, &TimedPose::time_s);
  const bool has_after = after != poses.end() && after->time_s - time_s <= kNear;
  const bool has_before = after != poses.begin() && time_s - (after - 1)->time_s <= kNear;
  if (has_after && after->time_s == time_s) return after->T_odom_base;
  if (has_after && has_before) return between(*(after - 1), *after, time_s);
  if (has_after) return after->T_odom_base;
  if (has_before) return (after - 1)->T_odom_base;
  return std::nullopt;
}

}  // namespace kidnapwatch::adapters::logs
