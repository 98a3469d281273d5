// SPDX-License-Identifier: Apache-2.0
// Where odometry said a robot was between two of its messages.
#pragma once

#include <optional>
#include <span>

#include "core/pose.hpp"

namespace kidnapwatch::adapters::logs {

struct TimedPose {
  double time_s = 0.0;
  core::Pose T_odom_base;
};

/// The pose at `time_s`, between the poses before and after in proportion to time. `poses` are in
/// order of time. Nothing if the nearest of them is more than 0.5 s away.
[[nodiscard]] std::optional<core::Pose> pose_at(std::span<const TimedPose> poses, double time_s);

}  // namespace kidnapwatch::adapters::logs
