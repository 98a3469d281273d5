// SPDX-License-Identifier: Apache-2.0
// Odometry between its messages.
#include "adapters/logs/odometry.hpp"

#include <array>

#include <gtest/gtest.h>

namespace kidnapwatch::adapters::logs {
namespace {

constexpr std::array<TimedPose, 3> kPoses{
    {{10.0, {0, 0, 3.0}}, {10.2, {1, 2, -3.0}}, {12.0, {5, 5, 0.0}}}};

TEST(PoseAt, LiesBetweenThePosesAround) {
  const auto pose = pose_at(kPoses, 10.1);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->x_m, 0.5, 1e-9);
  EXPECT_NEAR(pose->y_m, 1.0, 1e-9);
  EXPECT_NEAR(std::abs(pose->theta_rad), 3.14159265, 1e-6);  // the short way round
  EXPECT_EQ(pose_at(kPoses, 10.2), kPoses[1].T_odom_base);
}

TEST(PoseAt, IsTheNearestWhereOnlyOneIsNear) {
  EXPECT_EQ(pose_at(kPoses, 9.6), kPoses[0].T_odom_base);
  EXPECT_EQ(pose_at(kPoses, 10.6), kPoses[1].T_odom_base);
  EXPECT_EQ(pose_at(kPoses, 11.6), kPoses[2].T_odom_base);
  EXPECT_EQ(pose_at(kPoses, 12.4), kPoses[2].T_odom_base);
}

TEST(PoseAt, IsUnknownFarFromAllMessages) {
  EXPECT_FALSE(pose_at(kPoses, 9.4));
  EXPECT_FALSE(pose_at(kPoses, 11.1));
  EXPECT_FALSE(pose_at(kPoses, 12.6));
  EXPECT_FALSE(pose_at({}, 10.0));
}

TEST(PoseAt, SurvivesMessagesOfTheSameTime) {
  constexpr std::array<TimedPose, 2> kSame{{{1.0, {1, 0, 0}}, {1.0, {2, 0, 0}}}};
  EXPECT_EQ(pose_at(kSame, 1.0), kSame[0].T_odom_base);
  EXPECT_EQ(pose_at(kSame, 1.1), kSame[1].T_odom_base);
}

}  // namespace
}  // namespace kidnapwatch::adapters::logs
