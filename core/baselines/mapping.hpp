// SPDX-License-Identifier: Apache-2.0
// Maps made from a run's own scans: occupancy by log-odds, and poses straightened by matching.
#pragma once

#include <span>
#include <vector>

#include "core/baselines/grid_map.hpp"
#include "core/recording.hpp"

namespace kidnapwatch::core::baselines {

struct MappingConfig {
  double cell_m = 0.05;
  double reach_m = 15.0;  ///< farther hits are left out, and free space ends there
  Pose T_base_lidar;
};

/// The map that the scans saw from the poses T_map_base, one for each scan: a cell is occupied or
/// free if its log-odds say so after all hits in it and beams through it (Moravec and Elfes 1985;
/// a scan counts once per cell, and a hit outweighs its beams). Invalid beams tell nothing. Throws
/// BadInput naming `map` if it would need more than kMaxCells.
[[nodiscard]] GridMap map_from(std::span<const RecordedScan> scans, std::span<const Pose> poses,
                               const MappingConfig& config = {});

struct RefinementConfig {
  MappingConfig mapping;
  double keyframe_m = 0.2;  ///< a scan is added to what later ones are matched with after so much
  double keyframe_rad = 0.2;
  double window_m = 0.3;  ///< farthest correction of a step's odometry
  double window_rad = 0.2;
};

/// The poses T_map_base of a run by its odometry, each step corrected by matching the scan with
/// those before it (correlation with their blurred end points, as Olson 2009). Starts at 0. A scan
/// without odometry is sought where the one before it was.
///
/// Long loops close only as well as the steps are matched: there is no loop closing.
[[nodiscard]] std::vector<Pose> refine_poses(std::span<const RecordedScan> scans,
                                             const RefinementConfig& config = {});

/// T_map_base of each scan: the true poses if all scans have one, else refine_poses().
[[nodiscard]] std::vector<Pose> poses_of(std::span<const RecordedScan> scans,
                                         const RefinementConfig& config = {});

}  // namespace kidnapwatch::core::baselines
