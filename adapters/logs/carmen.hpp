// SPDX-License-Identifier: Apache-2.0
// CARMEN log files: FLASER, ROBOTLASER1 and ODOM messages, one per line.
#pragma once

#include <string_view>

#include "adapters/logs/lines.hpp"
#include "adapters/logs/log.hpp"

namespace kidnapwatch::adapters::logs {

[[nodiscard]] bool is_carmen(std::string_view head);

/// Of the two scan messages the one that comes first counts, others are taken for the same scans
/// told again. Further messages and comments are passed over.
///
/// Both scan messages carry the laser's pose and the robot's by odometry: the latter becomes the
/// odometry, T_odom_base. In a log corrected by GMapping (it has NEFF messages) both are the
/// corrected pose: that becomes the true pose, and the odometry is chained from the ODOM messages,
/// each of which continues from the corrected pose before it. (In other corrected logs the odometry
/// is as corrected: nothing in them tells.)
///
/// FLASER says neither angles nor limits: the beams cover 180 degrees about straight ahead, with
/// both ends if their number is odd and without the left one if it is even; range_max is the SICK's
/// 80 m, or CARMEN's 50 m where no range exceeds 80 m and some exceed 50 m or equal it ("no
/// return").
[[nodiscard]] Log read_carmen(Lines& lines);

}  // namespace kidnapwatch::adapters::logs
