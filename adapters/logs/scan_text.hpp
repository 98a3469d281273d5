// SPDX-License-Identifier: Apache-2.0
// The common `.scan` text: a header, then a scan per line.
#pragma once

#include <string_view>

#include "adapters/logs/lines.hpp"
#include "adapters/logs/log.hpp"

namespace kidnapwatch::adapters::logs {

/// Whether a text with this beginning is one:
///
///     # name angle_min_rad angle_increment_rad beams range_max_m
///     t_s odom_x_m odom_y_m odom_theta_rad true_x_m true_y_m true_theta_rad r1 ... rn
[[nodiscard]] bool is_scan_text(std::string_view head);

/// A pose that is not finite is absent; ranges are kept as recorded. range_min is 0: what the
/// sensor says of objects that are too close is 0, inf or NaN anyway.
[[nodiscard]] Log read_scan_text(Lines& lines);

}  // namespace kidnapwatch::adapters::logs
