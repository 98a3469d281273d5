// SPDX-License-Identifier: Apache-2.0
// Maps that come with recorded runs, whatever format they were drawn in.
#pragma once

#include <filesystem>
#include <string_view>

#include "adapters/logs/lines.hpp"
#include "core/baselines/grid_map.hpp"

namespace kidnapwatch::adapters::logs {

/// Reads a map, gzipped or not; the format is told by the content: the YAML file beside an image as
/// nav2's map_server reads it, or a map of CMU's robotics courses. Throws BadInput naming the file
/// if it is no such map, is cut off or has more than core::baselines::kMaxCells cells.
[[nodiscard]] core::baselines::GridMap read_grid_map(const std::filesystem::path& file);

/// A map of CMU's robotics courses, `wean.dat`: "robot_specifications->resolution" in centimetres,
/// "global_map[0]: rows columns", then for each row the probability of each cell to be free, or -1
/// for unknown. x goes down the rows and y along them, both from 0.
[[nodiscard]] bool is_cmu_map(std::string_view head);
[[nodiscard]] core::baselines::GridMap read_cmu_map(Lines& lines);

/// map_server's YAML: image, resolution, origin, negate, occupied_thresh, free_thresh; and the
/// image in binary PGM beside it (or that name and ".gz"). Modes trinary (as by default) and scale;
/// in both, what lies between the thresholds is unknown, and so is map_saver's 205. An origin that
/// is turned is refused.
[[nodiscard]] bool is_ros_map(std::string_view head);
[[nodiscard]] core::baselines::GridMap read_ros_map(Lines& lines);

}  // namespace kidnapwatch::adapters::logs
