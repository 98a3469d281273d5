// SPDX-License-Identifier: Apache-2.0
// Odometry at the time of a scan.
#include "core/odometry_track.hpp"

#include <gtest/gtest.h>

#include "tests/core/rooms.hpp"

namespace kidnapwatch::core {
namespace {

OdometryTrack driven() {
  OdometryTrack track;
  for (int i = 0; i <= 10; ++i) track.add(at_s(0.1 * i), {0.1 * i, 0.0, 3.0 + 0.05 * i});
  return track;
}

TEST(OdometryTrack, InterpolatesOnTheWayAndAcrossTheSeamOfTheAngle) {
  const auto pose = driven().at(at_s(0.35));
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->x_m, 0.35, 1e-9);
  EXPECT_NEAR(wrapped(pose->theta_rad - 3.175), 0.0, 1e-9);
  EXPECT_LT(pose->theta_rad, 0.0);  // past pi
}

TEST(OdometryTrack, GivesThePoseItselfAtItsStamp) {
  EXPECT_EQ(driven().at(at_s(0.0)), (Pose{0.0, 0.0, 3.0}));
}

TEST(OdometryTrack, GoesOnForAWhileAndNoLonger) {
  EXPECT_NEAR(driven().at(at_s(1.2))->x_m, 1.2, 1e-9);
  EXPECT_FALSE(driven().at(at_s(1.3)));
}

TEST(OdometryTrack, KnowsNothingBeforeItsFirstPoseNorInAGap) {
  EXPECT_FALSE(OdometryTrack().at(at_s(0.0)));
  EXPECT_FALSE(driven().at(at_s(-0.1)));
  OdometryTrack track = driven();
  track.add(at_s(3.0), {});
  EXPECT_FALSE(track.at(at_s(2.0)));
}

TEST(OdometryTrack, IgnoresLateOnesAndStartsAnewWhenTheClockWasSetBack) {
  OdometryTrack track = driven();
  track.add(at_s(0.55), {99.0, 0.0, 0.0});
  EXPECT_NEAR(track.at(at_s(0.55))->x_m, 0.55, 1e-9);
  track.add(at_s(-5.0), {7.0, 0.0, 0.0});
  EXPECT_EQ(track.at(at_s(-5.0))->x_m, 7.0);
  EXPECT_FALSE(track.at(at_s(0.55)));
}

}  // namespace
}  // namespace kidnapwatch::core
