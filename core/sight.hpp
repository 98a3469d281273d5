// SPDX-License-Identifier: Apache-2.0
// What the detectors saw between two scans, beam by beam, for people to look at.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/dtw.hpp"
#include "core/session.hpp"

namespace kidnapwatch::core {

/// The path behind QS-2DDTW's score (Algorithm 1).
struct Warping {
  double cost = 0.0;  ///< metres, or sigmas if standardised
  bool standardized = false;
  std::vector<WarpingStep> steps;  ///< p and q are beams of the scan before and after
};

/// What motion consistency compares.
struct MotionSight {
  std::optional<Pose> told;  ///< T_before_after of the sensor by odometry, where there is some
  Pose seen;                 ///< the same by the best alignment of the scans
  std::vector<std::size_t>
      violating_before;  ///< beams whose points lie where the other saw through
  std::vector<std::size_t> violating_after;
};

struct Sight {
  std::optional<Warping> warping;     ///< nothing for scans of too many beams to draw
  std::optional<MotionSight> motion;  ///< nothing where too little of both overlaps
};

/// Looks at a pair of scans as a session with this `config` does, but without what that has learned
/// of the robot's wheels. Milliseconds. Empty unless both scans are comparable.
[[nodiscard]] Sight sight(const ScanPair& scans, const DetectionConfig& config);

}  // namespace kidnapwatch::core
