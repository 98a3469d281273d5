// SPDX-License-Identifier: Apache-2.0
// Rays, sweeps and clearance, held to pictured worlds and to each other.
#include "core/sim/world.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace kidnapwatch::core::sim {
namespace {

constexpr double kPi = std::numbers::pi;

/// A square with corners (0, 0) and (4, 4).
World square() {
  return {
      "square", {{{0, 0}, {4, 0}}, {{4, 0}, {4, 4}}, {{4, 4}, {0, 4}}, {{0, 4}, {0, 0}}}, {}, {}};
}

TEST(CastRay, HitsTheNearestWall) {
  World world = square();
  EXPECT_DOUBLE_EQ(cast_ray(world, {1, 1}, 0.0), 3.0);
  EXPECT_DOUBLE_EQ(cast_ray(world, {1, 1}, kPi), 1.0);
  EXPECT_NEAR(cast_ray(world, {1, 1}, kPi / 4), 3.0 * std::sqrt(2.0), 1e-12);
  world.walls.push_back({{2, 0}, {2, 2}});
  EXPECT_DOUBLE_EQ(cast_ray(world, {1, 1}, 0.0), 1.0);
}

TEST(CastRay, SeesNothingBesideOrBehindAWallOrAlongIt) {
  const World world{"one wall", {{{2, -1}, {2, 1}}}, {}, {}};
  EXPECT_EQ(cast_ray(world, {0, 1.5}, 0.0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(cast_ray(world, {0, 0}, kPi), std::numeric_limits<double>::infinity());
  EXPECT_EQ(cast_ray({"along", {{{1, 0}, {3, 0}}}, {}, {}}, {0, 0}, 0.0),
            std::numeric_limits<double>::infinity());
}

TEST(Sweep, StartsStraightAheadAndTurnsCounterClockwise) {
  const auto ranges_m = sweep(square(), {1, 2, kPi / 2}, Fan(4), 10.0);
  ASSERT_EQ(ranges_m.size(), 4U);
  EXPECT_NEAR(ranges_m[0], 2.0, 1e-12);  // north
  EXPECT_NEAR(ranges_m[1], 1.0, 1e-12);  // west
  EXPECT_NEAR(ranges_m[2], 2.0, 1e-12);  // south
  EXPECT_NEAR(ranges_m[3], 3.0, 1e-12);  // east
}

TEST(Sweep, SeesNoFartherThanItsReach) {
  const auto ranges_m = sweep(square(), {1, 2, 0}, Fan(4), 2.5);
  EXPECT_EQ(ranges_m[0], std::numeric_limits<double>::infinity());
  EXPECT_NEAR(ranges_m[2], 1.0, 1e-12);
}

TEST(Sweep, HasNoGapInTheCorners) {
  // From the middle of the square, beams 1, 3, 5, 7 of 8 point into the corners.
  for (const double range_m : sweep(square(), {2, 2, 0}, Fan(8), 10.0)) {
    EXPECT_LE(range_m, 2.0 * std::sqrt(2.0) + 1e-9);
  }
}

class SweepInAWorld : public ::testing::TestWithParam<World> {};

TEST_P(SweepInAWorld, AgreesWithSingleRays) {
  const World& world = GetParam();
  constexpr double kReach = 3.5;
  const Fan fan(360);
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 100; ++trial) {
    const Point at{20.0 * uniform(random), 10.0 * uniform(random)};
    const Pose sensor{at.x_m, at.y_m, 2.0 * kPi * uniform(random) - kPi};
    const auto ranges_m = sweep(world, sensor, fan, kReach);
    for (std::size_t i = 0; i < ranges_m.size(); ++i) {
      const double bearing_rad = sensor.theta_rad + static_cast<double>(i) * fan.increment_rad;
      const double range_m = cast_ray(world, at, bearing_rad);
      if (range_m < kReach) {
        EXPECT_NEAR(ranges_m[i], range_m, 1e-6) << "trial " << trial << " beam " << i;
      } else {
        EXPECT_EQ(ranges_m[i], std::numeric_limits<double>::infinity());
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, SweepInAWorld, ::testing::Values(corridor_world(), room_world()),
                         [](const auto& world) { return world.param.name; });

TEST(Clearance, IsTheDistanceToTheNearestPointOfAnyWall) {
  EXPECT_DOUBLE_EQ(clearance_m(square(), {1, 2}), 1.0);
  EXPECT_DOUBLE_EQ(clearance_m(square(), {7, 8}), 5.0);  // beyond a corner
  EXPECT_DOUBLE_EQ(clearance_m(square(), {4, 1}), 0.0);
  EXPECT_EQ(clearance_m({}, {0, 0}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace kidnapwatch::core::sim
