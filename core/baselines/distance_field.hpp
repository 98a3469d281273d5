// SPDX-License-Identifier: Apache-2.0
// How far every cell of a map is from a wall, and rays cast among these cells.
#pragma once

#include <vector>

#include "core/baselines/grid_map.hpp"

namespace kidnapwatch::core::baselines {

struct DistanceField {
  GridLayout layout;
  std::vector<float> metres;  ///< per cell: from its centre to the nearest occupied cell's centre
};

/// Exact, in time linear in the cells (Felzenszwalb and Huttenlocher 2012). Infinity everywhere in
/// a map without an occupied cell.
[[nodiscard]] DistanceField distance_field(const GridMap& map);

/// Metres from `ray` along its angle to the nearest occupied cell: to the middle of the way through
/// it, since walls run through the middle of cells. 0 in an occupied cell; infinity where there is
/// none within `reach_m` or the ray leaves the grid first. Unknown cells are looked through.
///
/// Leaps over empty space by the field: 4 to 8 leaps in a corridor instead of a step per cell.
[[nodiscard]] double cast_ray(const DistanceField& field, const Pose& ray, double reach_m);

}  // namespace kidnapwatch::core::baselines
