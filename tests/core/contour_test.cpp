// SPDX-License-Identifier: Apache-2.0
// Contours: points, normals and free-space bounds of a scan.
#include "core/contour.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/core/walls.hpp"

namespace kidnapwatch::core {
namespace {

constexpr std::size_t kMargin = Contour::kMargin;

Contour traced(const Scan& scan) {
  Contour contour;
  trace(scan, contour);
  return contour;
}

TEST(BearingRad, IsAtan2ToATenthOfAMilliradianOrFive) {
  for (double angle = -3.14; angle < 3.14; angle += 0.001) {
    const auto y = static_cast<float>(2.5 * std::sin(angle));
    const auto x = static_cast<float>(2.5 * std::cos(angle));
    EXPECT_NEAR(bearing_rad(y, x), angle, 5e-4);
  }
  EXPECT_EQ(bearing_rad(0.0F, 0.0F), 0.0F);
}

TEST(Contour, HoldsThePointsOfTheValidBeams) {
  Scan scan = round_room(2.0, at_s(0.0), 40);
  scan.ranges_m[3] = 0.0F;
  scan.ranges_m[4] = std::numeric_limits<float>::quiet_NaN();
  const Contour contour = traced(scan);
  EXPECT_EQ(contour.valid, 38U);
  EXPECT_EQ(contour.px.size(), 38U);
  EXPECT_NEAR(contour.x[kMargin], 2.0F, 1e-6F);
  EXPECT_EQ(contour.x[kMargin + 3], Contour::kNowhere);
  EXPECT_NEAR(contour.mean_range_m, 2.0F, 1e-6F);
}

TEST(Contour, BoundsTheFreeSpaceByThreeNeighbours) {
  Scan scan = round_room(2.0, at_s(0.0), 40);
  scan.ranges_m[10] = 1.0F;
  scan.ranges_m[20] = scan.ranges_m[21] = scan.ranges_m[22] = 0.0F;
  const Contour contour = traced(scan);
  EXPECT_EQ(contour.near_m[kMargin + 11], 1.0F);
  EXPECT_EQ(contour.far_m[kMargin + 11], 2.0F);
  EXPECT_EQ(contour.near_m[kMargin + 20], 2.0F);  // its left neighbour saw something
  EXPECT_EQ(contour.far_m[kMargin + 21], 0.0F);   // none of the three did
}

TEST(Contour, RaisesNormalsOnWallsButNotAcrossGaps) {
  const Contour contour = traced(seen_from(box(8.0, 6.0), {4.0, 3.0, 0.0}));
  EXPECT_NEAR(std::abs(contour.normal_x[kMargin]), 1.0F, 1e-3F);  // the wall ahead
  EXPECT_NEAR(contour.normal_y[kMargin], 0.0F, 1e-3F);
  Scan step = round_room(2.0, at_s(0.0), 40);
  for (std::size_t i = 20; i < 40; ++i) step.ranges_m[i] = 5.0F;
  EXPECT_EQ(traced(step).normal_x[kMargin + 20], 0.0F);
}

TEST(Contour, RepeatsTheOtherEndOnlyOfAWholeTurn) {
  Scan scan = round_room(2.0, at_s(0.0), 40);
  scan.ranges_m[39] = 3.0F;
  EXPECT_TRUE(traced(scan).whole_turn);
  EXPECT_EQ(traced(scan).far_m[kMargin], 3.0F);
  scan.geometry.angle_increment_rad *= 0.5;
  EXPECT_FALSE(traced(scan).whole_turn);
  EXPECT_EQ(traced(scan).far_m[kMargin], 2.0F);
}

TEST(Contour, IsTracedAnewForAnotherGeometry) {
  Contour contour = traced(round_room(2.0, at_s(0.0), 40));
  const Scan other = round_room(3.0, at_s(0.0), 90);
  trace(other, contour);
  EXPECT_EQ(contour.valid, 90U);
  EXPECT_EQ(contour.x, traced(other).x);
}

TEST(BeamTowards, FindsEveryBeamOfBothSenses) {
  for (const double sense : {1.0, -1.0}) {
    Scan scan = round_room(2.0, at_s(0.0), 200);
    scan.geometry.angle_min_rad = -2.0;
    scan.geometry.angle_increment_rad = sense * 0.02;
    const Contour contour = traced(scan);
    for (int i = 0; i < 200; ++i) {
      const auto k = kMargin + static_cast<std::size_t>(i);
      EXPECT_EQ(beam_towards(contour, contour.x[k], contour.y[k]), i);
    }
    const double outside = -2.0 - sense * 0.5;
    EXPECT_LT(beam_towards(contour, static_cast<float>(std::cos(outside)),
                           static_cast<float>(std::sin(outside))),
              0);
  }
}

}  // namespace
}  // namespace kidnapwatch::core
