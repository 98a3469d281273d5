// SPDX-License-Identifier: Apache-2.0
// The logs of CMU's robotics courses: O and L lines, in centimetres.
#pragma once

#include <string_view>

#include "adapters/logs/lines.hpp"
#include "adapters/logs/log.hpp"

namespace kidnapwatch::adapters::logs {

/// Whether a text with this beginning is one:
///
///     O x y theta t
///     L x y theta laser_x laser_y laser_theta r1 ... r180 t
[[nodiscard]] bool is_cmu(std::string_view head);

/// Lengths become metres; the odometry is the robot's pose. The beams are those of CARMEN's FLASER
/// with 180 readings and a SICK's 80 m.
[[nodiscard]] Log read_cmu(Lines& lines);

}  // namespace kidnapwatch::adapters::logs
