// SPDX-License-Identifier: Apache-2.0
// Occupancy grids from floor plans.
#include "core/baselines/grid_map.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/bad_input.hpp"

namespace kidnapwatch::core::baselines {
namespace {

constexpr double kRoomAround = 2.0;  // cells beyond the outermost wall

Pose south_west(const Segment& wall) {
  return {std::min(wall.from_x_m, wall.to_x_m), std::min(wall.from_y_m, wall.to_y_m), 0.0};
}

Pose north_east(const Segment& wall) {
  return {std::max(wall.from_x_m, wall.to_x_m), std::max(wall.from_y_m, wall.to_y_m), 0.0};
}

}  // namespace

GridLayout layout_around(const Pose& south_west, const Pose& north_east, double cell_m,
                         double margin_m) {
  assert(cell_m > 0.0 && margin_m >= 0.0);
  const double before = std::ceil(margin_m / cell_m) + 0.5;  // cells
  const double columns = std::ceil((north_east.x_m - south_west.x_m) / cell_m + 2.0 * before);
  const double rows = std::ceil((north_east.y_m - south_west.y_m) / cell_m + 2.0 * before);
  if (!(columns * rows <= static_cast<double>(kMaxCells))) {
    throw BadInput("map", "more than 67108864 cells");
  }
  return {south_west.x_m - before * cell_m, south_west.y_m - before * cell_m, cell_m,
          static_cast<long>(columns), static_cast<long>(rows)};
}

GridMap rasterised(std::span<const Segment> walls, double cell_m) {
  assert(!walls.empty());
  Pose low = south_west(walls.front());
  Pose high = north_east(walls.front());
  for (const Segment& wall : walls) {
    low = {std::min(low.x_m, south_west(wall).x_m), std::min(low.y_m, south_west(wall).y_m), 0.0};
    high = {std::max(high.x_m, north_east(wall).x_m), std::max(high.y_m, north_east(wall).y_m),
            0.0};
  }
  GridMap map{layout_around(low, high, cell_m, kRoomAround * cell_m), {}};
  map.cells.assign(map.layout.cells(), Cell::free);
  for (const Segment& wall : walls) {
    for_each_cell_between(
        map.layout, {wall.from_x_m, wall.from_y_m, 0.0}, {wall.to_x_m, wall.to_y_m, 0.0},
        [&](long column, long row) { map.cells[map.layout.index(column, row)] = Cell::occupied; });
  }
  return map;
}

GridMap reachable(GridMap map, const Pose& inside) {
  const GridLayout& layout = map.layout;
  std::vector<bool> reached(layout.cells(), false);
  std::vector<std::pair<long, long>> open;
  const auto reach = [&](long column, long row) {
    if (map.at(column, row) != Cell::free || reached[layout.index(column, row)]) return;
    reached[layout.index(column, row)] = true;
    open.emplace_back(column, row);
  };
  reach(layout.column_at(inside.x_m), layout.row_at(inside.y_m));
  while (!open.empty()) {
    const auto [column, row] = open.back();
    open.pop_back();
    reach(column - 1, row);
    reach(column + 1, row);
    reach(column, row - 1);
    reach(column, row + 1);
  }
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    if (map.cells[i] == Cell::free && !reached[i]) map.cells[i] = Cell::unknown;
  }
  return map;
}

}  // namespace kidnapwatch::core::baselines
