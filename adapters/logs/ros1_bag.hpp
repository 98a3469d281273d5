// SPDX-License-Identifier: Apache-2.0
// ROS 1 bags, format 2.0: sensor_msgs/LaserScan and nav_msgs/Odometry.
#pragma once

#include <string_view>

#include "adapters/logs/lines.hpp"
#include "adapters/logs/log.hpp"

namespace kidnapwatch::adapters::logs {

[[nodiscard]] bool is_ros1_bag(std::string_view head);

/// Of several scan topics the one called "scan" counts, else the one with the most messages, of
/// those the first by name; of odometry topics likewise "odom". Times are those of the messages'
/// headers. A scan's odometry lies between the two messages around it.
///
/// Chunks are plain or packed by bzip2. A message that cannot be read counts as a skipped line.
/// Throws BadInput naming file and byte for a bag that is cut off, damaged, packed by lz4 or
/// unpacks to more than 512 MiB.
[[nodiscard]] Log read_ros1_bag(Lines& lines);

}  // namespace kidnapwatch::adapters::logs
