// SPDX-License-Identifier: Apache-2.0
// Odometry that comes beside the scans: where the robot believed to be when a scan was taken.
#pragma once

#include <deque>
#include <optional>

#include "core/pose.hpp"
#include "core/stamp.hpp"

namespace kidnapwatch::core {

/// The last seconds of a robot's odometry.
class OdometryTrack {
 public:
  /// Takes the next pose T_odom_base. One that is not newer than the last starts the track anew if
  /// it is older by more than a second (the clock was set back), and is ignored otherwise.
  void add(Stamp stamp, const Pose& pose);

  /// The pose at `stamp`: between two poses on the straight way with the angle in proportion, after
  /// the last by its motion going on for at most kAhead_s. Nothing farther from what is known.
  [[nodiscard]] std::optional<Pose> at(Stamp stamp) const;

  static constexpr double kAhead_s = 0.25;
  static constexpr double kGapMax_s = 1.0;  ///< between two poses

 private:
  struct Entry {
    Stamp stamp;
    Pose pose;
  };

  std::deque<Entry> entries_;  // in order of stamps
};

}  // namespace kidnapwatch::core
