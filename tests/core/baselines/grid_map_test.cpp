// SPDX-License-Identifier: Apache-2.0
// Floor plans become grids: walls closed, the outside unknown.
#include "core/baselines/grid_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"
#include "tests/core/baselines/floors.hpp"

namespace kidnapwatch::core::baselines {
namespace {

constexpr std::array<Segment, 4> kSquare{
    {{0.0, 0.0, 2.0, 0.0}, {2.0, 0.0, 2.0, 1.0}, {2.0, 1.0, 0.0, 1.0}, {0.0, 1.0, 0.0, 0.0}}};

long count(const GridMap& map, Cell cell) { return std::ranges::count(map.cells, cell); }

TEST(GridLayout, PutsEveryPointIntoTheCellAroundIt) {
  const GridLayout layout{-1.0, 2.0, 0.1, 20, 10};
  EXPECT_EQ(layout.column_at(-0.95), 0);
  EXPECT_EQ(layout.column_at(-1.01), -1);
  EXPECT_EQ(layout.row_at(2.55), 5);
  EXPECT_NEAR(layout.centre_x_m(3), -0.65, 1e-12);
  EXPECT_NEAR(layout.centre_y_m(0), 2.05, 1e-12);
  EXPECT_TRUE(layout.contains(19, 9));
  EXPECT_FALSE(layout.contains(20, 9));
  EXPECT_FALSE(layout.contains(0, -1));
}

TEST(LayoutAround, CentresCellsOnTheCornerAndLeavesTheMargin) {
  const GridLayout layout = layout_around({1.0, 2.0, 0.0}, {3.0, 2.5, 0.0}, 0.25, 0.3);
  const long column = layout.column_at(1.0);
  const long row = layout.row_at(2.0);
  EXPECT_NEAR(layout.centre_x_m(column), 1.0, 1e-12);
  EXPECT_NEAR(layout.centre_y_m(row), 2.0, 1e-12);
  EXPECT_TRUE(layout.contains(layout.column_at(0.7), layout.row_at(1.7)));
  EXPECT_TRUE(layout.contains(layout.column_at(3.3), layout.row_at(2.8)));
}

TEST(LayoutAround, RefusesAFloorThatIsTooLarge) {
  EXPECT_THROW(static_cast<void>(layout_around({0.0, 0.0, 0.0}, {1e5, 1e5, 0.0}, 0.05, 0.0)),
               BadInput);
  EXPECT_THROW(static_cast<void>(layout_around({0.0, 0.0, 0.0}, {NAN, 1.0, 0.0}, 0.05, 0.0)),
               BadInput);
}

TEST(Rasterised, DrawsARectangleOneCellThick) {
  const GridMap map = rasterised(kSquare, 0.1);
  EXPECT_EQ(count(map, Cell::occupied), 2 * 21 + 2 * 9);
  EXPECT_EQ(count(map, Cell::unknown), 0);
  EXPECT_EQ(map.at(map.layout.column_at(1.3), map.layout.row_at(1.0)), Cell::occupied);
  EXPECT_EQ(map.at(map.layout.column_at(1.3), map.layout.row_at(0.5)), Cell::free);
  EXPECT_EQ(map.at(-1, 0), Cell::unknown);
}

TEST(Rasterised, LeavesNoGapInASlantedWall) {
  const std::array<Segment, 3> triangle{
      {{0.0, 0.0, 3.0, 1.7}, {3.0, 1.7, -1.2, 2.9}, {-1.2, 2.9, 0.0, 0.0}}};
  const GridMap map = reachable(rasterised(triangle, 0.05), {0.5, 1.5, 0.0});
  const double area_m2 = 0.5 * std::abs(3.0 * 2.9 - -1.2 * 1.7);
  EXPECT_NEAR(static_cast<double>(count(map, Cell::free)) * 0.05 * 0.05, area_m2, 0.08 * area_m2);
}

TEST(Reachable, KeepsTheRoomAndForgetsTheRest) {
  const GridMap map = reachable(drawn({"......",  //
                                       ".####.",  //
                                       ".#..#.",  //
                                       ".####.", "......"},
                                      1.0),
                                {2.5, 2.5, 0.0});
  EXPECT_EQ(count(map, Cell::free), 2);
  EXPECT_EQ(count(map, Cell::occupied), 10);
  EXPECT_EQ(map.at(0, 0), Cell::unknown);
  EXPECT_EQ(map.at(3, 2), Cell::free);
}

TEST(Reachable, DoesNotSlipBetweenCornersOfWalls) {
  const GridMap map = reachable(drawn({".#.",  //
                                       "#.#",  //
                                       ".#."},
                                      1.0),
                                {1.5, 1.5, 0.0});
  EXPECT_EQ(count(map, Cell::free), 1);
}

TEST(Reachable, FromAWallIsNowhere) {
  EXPECT_EQ(count(reachable(rasterised(kSquare, 0.1), {0.0, 0.0, 0.0}), Cell::free), 0);
}

TEST(ForEachCellBetween, WalksFromSideToSide) {
  const GridLayout layout{0.0, 0.0, 1.0, 10, 10};
  std::vector<std::pair<long, long>> cells;
  for_each_cell_between(layout, {0.5, 0.5, 0.0}, {3.5, 1.5, 0.0},
                        [&](long column, long row) { cells.emplace_back(column, row); });
  EXPECT_EQ(cells, (std::vector<std::pair<long, long>>{{0, 0}, {1, 0}, {1, 1}, {2, 1}, {3, 1}}));
}

TEST(ForEachCellBetween, WalksBackwardsAndStraightUp) {
  const GridLayout layout{0.0, 0.0, 1.0, 10, 10};
  std::vector<std::pair<long, long>> cells;
  const auto note = [&](long column, long row) { cells.emplace_back(column, row); };
  for_each_cell_between(layout, {2.5, 0.5, 0.0}, {2.5, 2.5, 0.0}, note);
  for_each_cell_between(layout, {1.2, 5.5, 0.0}, {-0.5, 5.5, 0.0}, note);
  EXPECT_EQ(cells,
            (std::vector<std::pair<long, long>>{{2, 0}, {2, 1}, {2, 2}, {1, 5}, {0, 5}, {-1, 5}}));
}

}  // namespace
}  // namespace kidnapwatch::core::baselines
