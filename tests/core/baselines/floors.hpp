// SPDX-License-Identifier: Apache-2.0
// Maps of simulated worlds, and maps drawn by hand.
#pragma once

#include <string_view>
#include <vector>

#include "core/baselines/grid_map.hpp"
#include "core/sim/world.hpp"

namespace kidnapwatch::core::baselines {

/// North up, origin in the south-west corner: '#' is occupied, '?' unknown, anything else free.
inline GridMap drawn(const std::vector<std::string_view>& rows, double cell_m) {
  GridMap map{
      {0.0, 0.0, cell_m, static_cast<long>(rows.front().size()), static_cast<long>(rows.size())},
      {}};
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    for (const char cell : *row) {
      map.cells.push_back(cell == '#' ? Cell::occupied : cell == '?' ? Cell::unknown : Cell::free);
    }
  }
  return map;
}

inline std::vector<Segment> segments(const sim::World& world) {
  std::vector<Segment> found;
  for (const sim::Wall& wall : world.walls) {
    found.push_back({wall.from.x_m, wall.from.y_m, wall.to.x_m, wall.to.y_m});
  }
  return found;
}

/// The floor that the robot can be on.
inline GridMap floor_of(const sim::World& world, double cell_m = 0.05) {
  const sim::Point inside = world.path.front();
  return reachable(rasterised(segments(world), cell_m), {inside.x_m, inside.y_m, 0.0});
}

}  // namespace kidnapwatch::core::baselines
