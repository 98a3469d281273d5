// SPDX-License-Identifier: Apache-2.0
// Occupancy grids: what is known of every square of a floor.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/pose.hpp"

namespace kidnapwatch::core::baselines {

/// Where a grid's cells lie: cell (column, row) is the square with its south-west corner
/// `cell_m` (column, row) away from the origin, and sides along the map frame's axes.
struct GridLayout {
  double origin_x_m = 0.0;  ///< south-west corner of cell (0, 0)
  double origin_y_m = 0.0;
  double cell_m = 0.05;
  long columns = 0;
  long rows = 0;

  friend bool operator==(const GridLayout&, const GridLayout&) = default;

  [[nodiscard]] std::size_t cells() const { return static_cast<std::size_t>(columns * rows); }
  [[nodiscard]] bool contains(long column, long row) const {
    return column >= 0 && column < columns && row >= 0 && row < rows;
  }
  /// Of a cell that the grid contains: row by row, the southern one first.
  [[nodiscard]] std::size_t index(long column, long row) const {
    return static_cast<std::size_t>(row * columns + column);
  }
  [[nodiscard]] long column_at(double x_m) const {
    return static_cast<long>(std::floor((x_m - origin_x_m) / cell_m));
  }
  [[nodiscard]] long row_at(double y_m) const {
    return static_cast<long>(std::floor((y_m - origin_y_m) / cell_m));
  }
  [[nodiscard]] double centre_x_m(long column) const {
    return origin_x_m + (static_cast<double>(column) + 0.5) * cell_m;
  }
  [[nodiscard]] double centre_y_m(long row) const {
    return origin_y_m + (static_cast<double>(row) + 0.5) * cell_m;
  }
};

/// Most cells that a map may have: 16384 x 4096.
inline constexpr std::size_t kMaxCells = std::size_t{1} << 26U;

enum class Cell : std::uint8_t { unknown, free, occupied };

struct GridMap {
  GridLayout layout;
  std::vector<Cell> cells;  ///< layout.cells() of them

  /// Unknown outside the grid.
  [[nodiscard]] Cell at(long column, long row) const {
    return layout.contains(column, row) ? cells[layout.index(column, row)] : Cell::unknown;
  }
};

/// A layout that covers the rectangle with `margin_m` to spare; a whole number of cells from its
/// south-west corner is the centre of a cell. Throws BadInput naming `map` above kMaxCells.
[[nodiscard]] GridLayout layout_around(const Pose& south_west, const Pose& north_east,
                                       double cell_m, double margin_m);

/// A straight wall, in the map frame.
struct Segment {
  double from_x_m = 0.0;
  double from_y_m = 0.0;
  double to_x_m = 0.0;
  double to_y_m = 0.0;
};

/// The floor plan: cells that a wall runs through are occupied, all others free. There is a wall.
[[nodiscard]] GridMap rasterised(std::span<const Segment> walls, double cell_m);

/// The map with all free cells unknown that no way of free cells, side by side, leads to from
/// `inside`: what lies beyond the walls.
[[nodiscard]] GridMap reachable(GridMap map, const Pose& inside);

/// Calls visit(column, row) for every cell, in the grid or not, on the straight line from `from` to
/// `to`, in order, the last cell included; where the line runs through a corner, for one of the two
/// cells beside it as well.
template <typename Visit>
void for_each_cell_between(const GridLayout& layout, const Pose& from, const Pose& to,
                           Visit visit) {
  long column = layout.column_at(from.x_m);
  long row = layout.row_at(from.y_m);
  const long last_column = layout.column_at(to.x_m);
  const long last_row = layout.row_at(to.y_m);
  const long right = last_column > column ? 1 : -1;
  const long up = last_row > row ? 1 : -1;
  const double along_x = std::abs(to.x_m - from.x_m);
  const double along_y = std::abs(to.y_m - from.y_m);
  // Distance to the next border of a column and of a row, to be compared as shares of the line.
  double to_x = std::abs(layout.centre_x_m(column) - from.x_m +
                         0.5 * static_cast<double>(right) * layout.cell_m);
  double to_y =
      std::abs(layout.centre_y_m(row) - from.y_m + 0.5 * static_cast<double>(up) * layout.cell_m);
  visit(column, row);
  while (column != last_column || row != last_row) {
    const bool sideways =
        row == last_row || (column != last_column && to_x * along_y < to_y * along_x);
    if (sideways) {
      column += right;
      to_x += layout.cell_m;
    } else {
      row += up;
      to_y += layout.cell_m;
    }
    visit(column, row);
  }
}

}  // namespace kidnapwatch::core::baselines
