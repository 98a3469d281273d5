// SPDX-License-Identifier: Apache-2.0
// CARMEN's messages, and the logs that were corrected with GMapping.
#include "adapters/logs/carmen.hpp"

#include <cmath>
#include <numbers>

#include "tests/adapters/logs/log_file.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

using CarmenTest = LogFileTest;

constexpr double kPi = std::numbers::pi;

/// A FLASER message of `ranges`, at time `t`, the robot at (x, 0, 0) and its laser 0.25 m ahead.
std::string flaser(const std::string& ranges, int count, double x_m, double t_s) {
  return "FLASER " + std::to_string(count) + " " + ranges + " " + std::to_string(x_m + 0.25) +
         " 0 0 " + std::to_string(x_m) + " 0 0 " + std::to_string(t_s) + " host 1.5\n";
}

TEST_F(CarmenTest, FlaserIsReadWithTheRobotsOwnPose) {
  const Log log = read_log(gzipped(
      "run.log.gz", "# a comment\nPARAM x 1 nohost 0\n" + flaser("1 2 3 81.91", 4, 7.0, 10.0) +
                        "SYNC now\n" + flaser("1 2 3 4", 4, 8.0, 10.2)));
  EXPECT_EQ(log.skipped_lines, 0U);
  EXPECT_EQ(log.recording.name, "run");
  ASSERT_EQ(log.recording.scans.size(), 2U);
  const core::RecordedScan& first = log.recording.scans[0];
  EXPECT_EQ(first.scan.odometry, (core::Pose{7, 0, 0}));
  EXPECT_FALSE(first.true_pose);
  EXPECT_EQ(first.scan.ranges_m, (std::vector<float>{1, 2, 3, 81.91F}));
  EXPECT_EQ(first.scan.geometry, (core::ScanGeometry{-0.5 * kPi, kPi / 4, 0.0, 80.0}));
  EXPECT_NEAR(core::elapsed_s(first.scan.stamp, log.recording.scans[1].scan.stamp), 0.2, 1e-6);
}

TEST_F(CarmenTest, AnOddNumberOfBeamsReachesBothSides) {
  const Log log = read_log(plain("a", flaser("1 2 3 4 5", 5, 0, 1)));
  EXPECT_DOUBLE_EQ(log.recording.scans[0].scan.geometry.angle_increment_rad, kPi / 4);
}

TEST_F(CarmenTest, FiftyMetresAreTheReachOfALogThatEndsThere) {
  const Log coded = read_log(plain("a", flaser("1 50", 2, 0, 1) + flaser("1 51.16", 2, 0, 2)));
  for (const auto& recorded : coded.recording.scans) {
    EXPECT_EQ(recorded.scan.geometry.range_max_m, 50.0);
    EXPECT_EQ(core::valid_beams(recorded.scan), 1U);
  }
  const Log near = read_log(plain("b", flaser("1 49", 2, 0, 1)));
  EXPECT_EQ(near.recording.scans[0].scan.geometry.range_max_m, 80.0);
}

TEST_F(CarmenTest, Robotlaser1IsReadWithItsOwnGeometry) {
  constexpr std::string_view kText =
      "ROBOTLASER1 0 -1.57 3.14 0.785 30 0.01 0 3 1.5 2.5 30 2 100 200 1.2 0 0 1 0 0.5 "
      "0.3 0.1 0.2 0.2 0 1134864642.914187 b21 0.43\n";
  const Log log = read_log(plain("csail.log", kText));
  ASSERT_EQ(log.recording.scans.size(), 1U);
  const core::Scan& scan = log.recording.scans[0].scan;
  EXPECT_EQ(scan.geometry, (core::ScanGeometry{-1.57, 0.785, 0.0, 30.0}));
  EXPECT_EQ(scan.odometry, (core::Pose{1, 0, 0.5}));
  EXPECT_EQ(scan.ranges_m, (std::vector<float>{1.5F, 2.5F, 30.0F}));
  EXPECT_NEAR(core::elapsed_s(core::Stamp{}, scan.stamp), 1134864642.914187, 1e-6);
}

TEST_F(CarmenTest, TheSameScansToldInAnotherMessageDoNotCountTwice) {
  constexpr std::string_view kRobotLaser =
      "ROBOTLASER1 0 -1.57 3.14 0.785 30 0.01 0 3 1 2 3 0 0 0 0 0 0 0 0 0 0 0 0 1 host 1\n";
  const Log log = read_log(plain("a", flaser("1 2", 2, 0, 1) + std::string(kRobotLaser)));
  EXPECT_EQ(log.recording.scans.size(), 1U);
}

TEST_F(CarmenTest, GMappingsCorrectionIsTakenForTrueAndUndone) {
  // Driven: 1 m ahead, then 1 m ahead again. The correction puts the first scan 0.1 m to the left,
  // and the odometry goes on from there.
  constexpr std::string_view kText =
      "ODOM 1 0 0 0 0 0 1 host 1\n"
      "FLASER 2 1 2 1 0.1 0 1 0.1 0 1 host 1\n"
      "ODOM 1 0.1 0 0 0 0 0 host 0\n"
      "NEFF 30\n"
      "ODOM 1.5 0.1 0 0 0 0 1.5 host 1.5\n"
      "ODOM 2 0.1 0 0 0 0 2 host 2\n"
      "FLASER 2 1 2 2 0.4 0 2 0.4 0 2 host 2\n"
      "ODOM 2 0.4 0 0 0 0 0 host 0\n"
      "FLASER 2 1 2 2 0.3 0 2 0.3 0 3 host 3\n";
  const auto scans = read_log(plain("a", kText)).recording.scans;
  ASSERT_EQ(scans.size(), 3U);
  EXPECT_EQ(scans[1].true_pose, (core::Pose{2, 0.4, 0}));
  EXPECT_NEAR(scans[0].scan.odometry->y_m, 0.1, 1e-12);
  EXPECT_NEAR(scans[1].scan.odometry->x_m, 2.0, 1e-12);
  EXPECT_NEAR(scans[1].scan.odometry->y_m, 0.1, 1e-12);
  EXPECT_NEAR(scans[2].scan.odometry->y_m, 0.1, 1e-12);  // stood still, whatever the map says
}

TEST_F(CarmenTest, BrokenMessagesAreSkippedAndCounted) {
  const auto file =
      plain("broken.log", flaser("1 2 3 4", 4, 0, 1) +      // good
                              flaser("1 2 3 4", 3, 0, 2) +  // more ranges than it says
                              flaser("1 2 3 4", 5, 0, 2) +  // fewer
                              flaser("", 0, 0, 2) +         // none
                              flaser("1 2 x 4", 4, 0, 2) +  // not a number
                              flaser("1 2 3 4", 999'999'999, 0, 2) +
                              "FLASER 4 1 2 3 4\n"  // cut off
                              "FLASER\n"
                              "ODOM 1 nan 0 0 0 0 1 host 1\n"
                              "ROBOTLASER2 passed over\n"
                              "\x7f\x45LF garbage\n" +
                              flaser("1 2 3 4", 4, 0, 3));  // good
  const Log log = read_log(file);
  EXPECT_EQ(log.recording.scans.size(), 2U);
  EXPECT_EQ(log.skipped_lines, 9U);
  EXPECT_EQ(log.first_skipped.find(file.string() + ":2: "), 0U) << log.first_skipped;
}

TEST_F(CarmenTest, RemissionsAreCountedWithinBounds) {
  const auto with_remissions = [](const std::string& count) {
    return "ROBOTLASER1 0 -1.57 3.14 0.785 30 0.01 0 2 1 2 " + count +
           " 0 0 0 0 0 0 0 0 0 0 0 1 host 1\n";
  };
  EXPECT_EQ(read_log(plain("a", with_remissions("0"))).recording.scans.size(), 1U);
  for (const std::string count : {"-1", "1e99", "nan", "65537", "5"}) {
    EXPECT_NE(refused(plain("b", with_remissions(count))), "") << count;
  }
}

TEST(Carmen, IsToldByItsMessages) {
  EXPECT_TRUE(is_carmen("# a comment\n\nODOM 0 0"));
  EXPECT_TRUE(is_carmen("# message formats defined: PARAM"));
  EXPECT_FALSE(is_carmen("ODOMETER 3"));
  EXPECT_FALSE(is_carmen(""));
  EXPECT_FALSE(is_carmen("\n\n\n"));
}

}  // namespace
}  // namespace kidnapwatch::adapters::logs
