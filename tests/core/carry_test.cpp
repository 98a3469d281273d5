// SPDX-License-Identifier: Apache-2.0
// Slow carries.
#include "core/carry.hpp"

#include <random>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

struct Drive {
  Carry carry;
  std::mt19937_64 random{5};

  Pose seen(const Pose& motion) {
    std::normal_distribution<double> noise(0.0, 0.005);
    return motion * Pose{noise(random), noise(random), noise(random)};
  }
  void natural(int pairs) {
    for (int i = 0; i < pairs; ++i) carry.observe({0.05, 0.0, 0.0}, seen({0.05, 0.0, 0.0}), true);
  }
};

TEST(Carry, StaysSilentOnANaturalDrive) {
  Drive drive;
  for (int i = 0; i < 2000; ++i) {
    drive.natural(1);
    ASSERT_FALSE(drive.carry.alarmed()) << i;
  }
}

TEST(Carry, FindsARobotCarriedWhileItsWheelsStand) {
  Drive drive;
  drive.natural(200);
  int scans = 0;
  for (; scans < 30 && !drive.carry.alarmed(); ++scans)
    drive.carry.observe({}, drive.seen({0.04, 0.0, 0.0}), false);
  EXPECT_LT(scans, 30);
}

TEST(Carry, FindsARobotTurnedSlowly) {
  Drive drive;
  drive.natural(200);
  for (int i = 0; i < 30; ++i) drive.carry.observe({}, drive.seen({0.0, 0.0, 0.04}), false);
  EXPECT_TRUE(drive.carry.alarmed());
}

TEST(Carry, ForgivesErrorsThatCancel) {
  Drive drive;
  drive.natural(200);
  for (int i = 0; i < 100; ++i) {
    const double late = i % 2 == 0 ? 0.05 : -0.05;
    drive.carry.observe({0.05, 0.0, 0.0}, drive.seen({0.05 + late, 0.0, 0.0}), false);
  }
  EXPECT_FALSE(drive.carry.alarmed());
}

TEST(Carry, SaysNothingBeforeItKnowsTheRobot) {
  Drive drive;
  drive.natural(20);
  for (int i = 0; i < 30; ++i) drive.carry.observe({}, {0.05, 0.0, 0.0}, false);
  EXPECT_FALSE(drive.carry.alarmed());
}

TEST(Carry, StartsOverAfterAReset) {
  Drive drive;
  drive.natural(200);
  for (int i = 0; i < 30; ++i) drive.carry.observe({}, {0.05, 0.0, 0.0}, false);
  drive.carry.reset();
  EXPECT_EQ(drive.carry.cusum(), 0.0F);
}

}  // namespace
}  // namespace kidnapwatch::core
