// SPDX-License-Identifier: Apache-2.0
// Scans become points, beam by beam. Eq. (1).
#include "core/cloud.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/core/rooms.hpp"

namespace kidnapwatch::core {
namespace {

constexpr double kQuarterRad = std::numbers::pi / 2.0;

/// Four beams: ahead, left, back, right; the second hits nothing.
Scan crossing() {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  return {at_s(0.0), {0.0, kQuarterRad, 0.1, 8.0}, {1.0F, nan, 2.0F, 4.0F}, {}};
}

void expect_points(const Cloud& cloud, const std::vector<double>& x, const std::vector<double>& y) {
  ASSERT_EQ(cloud.size(), x.size());
  ASSERT_EQ(cloud.y.size(), y.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(cloud.x[i], x[i], 1e-12) << i;
    EXPECT_NEAR(cloud.y[i], y[i], 1e-12) << i;
  }
}

TEST(Cloud, LeavesOutBeamsThatHitNothing) {
  expect_points(cloud(crossing(), InvalidPolicy::drop), {1.0, -2.0, 0.0}, {0.0, 0.0, -4.0});
}

TEST(Cloud, ClampsThemToTheReach) {
  expect_points(cloud(crossing(), InvalidPolicy::clamp), {1.0, 0.0, -2.0, 0.0},
                {0.0, 8.0, 0.0, -4.0});
}

TEST(Cloud, TurnsClockwiseWithANegativeIncrement) {
  Scan scan = crossing();
  scan.geometry.angle_increment_rad = -kQuarterRad;
  expect_points(cloud(scan, InvalidPolicy::drop), {1.0, -2.0, 0.0}, {0.0, 0.0, 4.0});
}

TEST(Cloud, StartsAtTheFirstAngle) {
  Scan scan = crossing();
  scan.geometry.angle_min_rad = kQuarterRad;
  expect_points(cloud(scan, InvalidPolicy::drop), {0.0, 0.0, 4.0}, {1.0, -2.0, 0.0});
}

TEST(Cloud, NeverHasAPointAtTheSensor) {
  Scan scan = crossing();
  scan.ranges_m = {0.0F, -1.0F, std::numeric_limits<float>::infinity(), 8.19F};
  EXPECT_EQ(cloud(scan, InvalidPolicy::drop).size(), 0U);
  const Cloud clamped = cloud(scan, InvalidPolicy::clamp);
  ASSERT_EQ(clamped.size(), 4U);
  for (std::size_t i = 0; i < clamped.size(); ++i) {
    EXPECT_NEAR(std::hypot(clamped.x[i], clamped.y[i]), 8.0, 1e-12);
  }
}

TEST(KeptRanges, AreThoseOfTheCloud) {
  EXPECT_EQ(kept_ranges(crossing(), InvalidPolicy::drop), (std::vector{1.0, 2.0, 4.0}));
  EXPECT_EQ(kept_ranges(crossing(), InvalidPolicy::clamp), (std::vector{1.0, 8.0, 2.0, 4.0}));
}

}  // namespace
}  // namespace kidnapwatch::core
