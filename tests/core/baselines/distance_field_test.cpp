// SPDX-License-Identifier: Apache-2.0
// Distances equal those found by trying every wall; rays end where plane geometry says.
#include "core/baselines/distance_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "core/sim/world.hpp"
#include "tests/core/baselines/floors.hpp"

namespace kidnapwatch::core::baselines {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

GridMap random_map(std::mt19937_64& random, double walls) {
  const auto columns = static_cast<long>(1 + random() % 40);
  const auto rows = static_cast<long>(1 + random() % 40);
  GridMap map{{-3.0, 7.0, 0.2, columns, rows}, {}};
  for (std::size_t i = 0; i < map.layout.cells(); ++i) {
    map.cells.push_back(uniform(random) < walls ? Cell::occupied : Cell::free);
  }
  return map;
}

double nearest_wall_m(const GridMap& map, long column, long row) {
  double nearest_m = kInfinity;
  for (long r = 0; r < map.layout.rows; ++r) {
    for (long c = 0; c < map.layout.columns; ++c) {
      if (map.at(c, r) != Cell::occupied) continue;
      nearest_m =
          std::min(nearest_m, map.layout.cell_m * std::hypot(static_cast<double>(c - column),
                                                             static_cast<double>(r - row)));
    }
  }
  return nearest_m;
}

TEST(DistanceField, EqualsTheNearestOfAllWalls) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 40; ++trial) {
    const GridMap map = random_map(random, trial % 2 == 0 ? 0.02 : 0.3);
    const DistanceField field = distance_field(map);
    ASSERT_EQ(field.metres.size(), map.layout.cells());
    for (long row = 0; row < map.layout.rows; ++row) {
      for (long column = 0; column < map.layout.columns; ++column) {
        const auto found_m = static_cast<double>(field.metres[map.layout.index(column, row)]);
        const double expected_m = nearest_wall_m(map, column, row);
        if (std::isinf(expected_m)) {
          ASSERT_TRUE(std::isinf(found_m));
        } else {
          ASSERT_NEAR(found_m, expected_m, 1e-5);
        }
      }
    }
  }
}

TEST(DistanceField, DoesNotTakeTheUnknownForWalls) {
  const DistanceField field = distance_field(drawn({"?.#"}, 1.0));
  EXPECT_EQ(field.metres, (std::vector<float>{2.0F, 1.0F, 0.0F}));
}

TEST(DistanceField, WithoutWallsIsInfinite) {
  const DistanceField field = distance_field(drawn({"...", "..."}, 1.0));
  for (const float away_m : field.metres) EXPECT_TRUE(std::isinf(away_m));
}

/// Walls run through the middle of cells, so rays are as long as among the segments, but for what
/// a slanted hit makes of half a cell.
TEST(CastRay, AgreesWithTheWallsThatTheGridWasMadeFrom) {
  const sim::World world = sim::corridor_world();
  const DistanceField field = distance_field(floor_of(world));
  std::mt19937_64 random(3);
  std::vector<double> errors;
  for (int i = 0; i < 4000; ++i) {
    const sim::Point from = world.path[random() % world.path.size()];
    const double bearing_rad = 2.0 * std::numbers::pi * uniform(random);
    const double expected_m = sim::cast_ray(world, from, bearing_rad);
    const double found_m = cast_ray(field, {from.x_m, from.y_m, bearing_rad}, 30.0);
    ASSERT_FALSE(std::isinf(found_m));
    errors.push_back(std::abs(found_m - expected_m));
  }
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() / 2], 0.02);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.15);  // past a corner, by a hair or not
}

TEST(CastRay, HitsWallsSquarelyToTheMillimetre) {
  const std::array<Segment, 4> square{
      {{0.0, 0.0, 4.0, 0.0}, {4.0, 0.0, 4.0, 3.0}, {4.0, 3.0, 0.0, 3.0}, {0.0, 3.0, 0.0, 0.0}}};
  const DistanceField field = distance_field(rasterised(square, 0.05));
  const double up = 0.5 * std::numbers::pi;
  EXPECT_NEAR(cast_ray(field, {1.5, 1.0, 0.0}, 10.0), 2.5, 1e-9);
  EXPECT_NEAR(cast_ray(field, {1.5, 1.0, 2.0 * up}, 10.0), 1.5, 1e-9);
  EXPECT_NEAR(cast_ray(field, {1.5, 1.0, up}, 10.0), 2.0, 1e-9);
  EXPECT_NEAR(cast_ray(field, {1.5, 1.0, -up}, 10.0), 1.0, 1e-9);
}

/// Every ray, from anywhere, against a walk in tiny steps.
TEST(CastRay, LeapsOverNoWall) {
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 400; ++trial) {
    const GridMap map = random_map(random, 0.03);
    const DistanceField field = distance_field(map);
    const GridLayout& layout = map.layout;
    const Pose ray{layout.origin_x_m + uniform(random) * 0.2 * static_cast<double>(layout.columns),
                   layout.origin_y_m + uniform(random) * 0.2 * static_cast<double>(layout.rows),
                   2.0 * std::numbers::pi * uniform(random)};
    const double found_m = cast_ray(field, ray, 20.0);
    for (double walked_m = 0.0; walked_m < std::min(found_m, 20.0) - 0.15; walked_m += 1e-3) {
      const long column = layout.column_at(ray.x_m + walked_m * std::cos(ray.theta_rad));
      const long row = layout.row_at(ray.y_m + walked_m * std::sin(ray.theta_rad));
      ASSERT_NE(map.at(column, row), Cell::occupied) << trial << ", " << walked_m;
    }
    if (std::isinf(found_m)) continue;
    const long column = layout.column_at(ray.x_m + found_m * std::cos(ray.theta_rad));
    const long row = layout.row_at(ray.y_m + found_m * std::sin(ray.theta_rad));
    ASSERT_EQ(map.at(column, row), Cell::occupied) << trial;
  }
}

TEST(CastRay, EndsAtItsReachAtTheEdgeAndInAWall) {
  const DistanceField field = distance_field(drawn({"....#"}, 1.0));
  EXPECT_NEAR(cast_ray(field, {0.5, 0.5, 0.0}, 10.0), 4.0, 1e-12);
  EXPECT_TRUE(std::isinf(cast_ray(field, {0.5, 0.5, 0.0}, 3.9)));
  EXPECT_TRUE(std::isinf(cast_ray(field, {0.5, 0.5, 1.0}, 10.0)));
  EXPECT_TRUE(std::isinf(cast_ray(field, {-0.5, 0.5, 0.0}, 10.0)));
  EXPECT_EQ(cast_ray(field, {4.5, 0.5, 1.0}, 10.0), 0.0);
  EXPECT_TRUE(std::isinf(cast_ray(distance_field(drawn({"..."}, 1.0)), {0.5, 0.5, 0.0}, 10.0)));
}

}  // namespace
}  // namespace kidnapwatch::core::baselines
