// SPDX-License-Identifier: Apache-2.0
// Point-to-line ICP against known motions.
#include "core/alignment.hpp"

#include <gtest/gtest.h>

#include "tests/core/walls.hpp"

namespace kidnapwatch::core {
namespace {

Contour traced(const Scan& scan) {
  Contour contour;
  trace(scan, contour);
  return contour;
}

void expect_near(const Pose& a, const Pose& b, double metres, double radians) {
  EXPECT_LT(distance_m(a, b), metres);
  EXPECT_LT(std::abs(wrapped(a.theta_rad - b.theta_rad)), radians);
}

TEST(Aligned, FindsTheMotionFromAnySeedNear) {
  const Walls walls = furnished_room();
  const Pose from{4.0, 2.0, 0.3};
  for (const Pose& motion : {Pose{0.2, 0.0, 0.0}, Pose{0.0, 0.1, 0.1}, Pose{-0.15, 0.1, -0.1}}) {
    const Contour before = traced(seen_from(walls, from, at_s(0.0), 360, 0.01, 1));
    const Contour now = traced(seen_from(walls, from * motion, at_s(0.1), 360, 0.01, 2));
    expect_near(aligned(before, now, {}, {}).motion, motion, 0.02, 0.01);
    expect_near(aligned(before, now, motion, {}).motion, motion, 0.01, 0.005);
  }
}

TEST(Aligned, GoesNoFartherThanItsReach) {
  const Walls walls = furnished_room();
  const Contour before = traced(seen_from(walls, {4.0, 2.0, 0.3}));
  const Contour now = traced(seen_from(walls, {1.0, 5.0, 2.3}));
  const AlignmentConfig config;
  const Pose motion = aligned(before, now, {}, config).motion;
  EXPECT_LE(std::abs(motion.x_m), config.reach_m);
  EXPECT_LE(std::abs(motion.y_m), config.reach_m);
  EXPECT_LE(std::abs(motion.theta_rad), config.reach_rad);
}

TEST(Aligned, BelievesItsSeedAlongAFeaturelessCorridor) {
  const Walls walls = box(100.0, 2.0);
  const Contour before = traced(seen_from(walls, {50.0, 1.0, 0.0}, at_s(0.0), 360, 0.01, 1));
  const Contour now = traced(seen_from(walls, {50.4, 1.1, 0.05}, at_s(0.1), 360, 0.01, 2));
  const Pose motion = aligned(before, now, {0.2, 0.0, 0.0}, {}).motion;
  EXPECT_NEAR(motion.x_m, 0.2, 0.02);  // nothing to see along the corridor
  EXPECT_NEAR(motion.y_m, 0.1, 0.02);
  EXPECT_NEAR(motion.theta_rad, 0.05, 0.01);
}

TEST(Aligned, StaysAtItsSeedWithoutMatches) {
  const Contour nothing = traced(round_room(0.0, at_s(0.0), 360));
  const Pose seed{0.1, 0.2, 0.3};
  EXPECT_EQ(aligned(nothing, nothing, seed, {}).motion, seed);
}

TEST(ProfileTurn, FindsATurnOnTheSpotOfAnySize) {
  const Walls walls = furnished_room();
  const Contour before = traced(seen_from(walls, {4.0, 2.0, 0.3}));
  for (const double turn : {0.3, -0.5, 1.5, 3.0}) {
    const Contour now = traced(seen_from(walls, {4.0, 2.0, 0.3 + turn}));
    EXPECT_NEAR(wrapped(profile_turn_rad(before, now, 0.0, 3.15) - turn), 0.0, 0.04) << turn;
  }
}

}  // namespace
}  // namespace kidnapwatch::core
