// SPDX-License-Identifier: Apache-2.0
// Nothing but the scans tells of a kidnapping that was cut in.
#include "core/evaluation/splice.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kScans = 300;

/// A drive along a wide circle at 10 Hz; the single range of a scan is its index, and the true
/// poses are the odometry seen from elsewhere.
Recording circle_drive(double radius_m = 5.0) {
  Recording recording{"circle", {}};
  for (std::size_t i = 0; i < kScans; ++i) {
    const double turned_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / kScans;
    RecordedScan recorded;
    recorded.scan.stamp = stamp_from_ns(1'700'000'000'000'000'000) + milliseconds(100 * i);
    recorded.scan.ranges_m = {static_cast<float>(i)};
    recorded.scan.odometry = Pose{radius_m * std::sin(turned_rad),
                                  radius_m * (1.0 - std::cos(turned_rad)), wrapped(turned_rad)};
    recorded.true_pose = Pose{7.0, -3.0, 1.0} * *recorded.scan.odometry;
    recording.scans.push_back(recorded);
  }
  return recording;
}

float label(const RecordedScan& recorded) { return recorded.scan.ranges_m.front(); }

void expect_near(const Pose& a, const Pose& b) {
  EXPECT_NEAR(a.x_m, b.x_m, 1e-9);
  EXPECT_NEAR(a.y_m, b.y_m, 1e-9);
  EXPECT_NEAR(wrapped(a.theta_rad - b.theta_rad), 0.0, 1e-9);
}

Spliced one_cut(const Recording& recording, double at_s, double to_s) {
  return splice(recording, std::array{Cut{at_s, to_s}});
}

TEST(Splice, WithoutCutsChangesNothing) {
  const Recording recording = circle_drive();
  const Spliced spliced = splice(recording, {});
  EXPECT_TRUE(spliced.first_after.empty());
  ASSERT_EQ(spliced.recording.scans.size(), kScans);
  EXPECT_EQ(spliced.recording.scans[17].scan.odometry, recording.scans[17].scan.odometry);
}

TEST(Splice, GoesOnWithTheScansFromElsewhere) {
  const Recording recording = circle_drive();
  const Spliced spliced = one_cut(recording, 10.0, 20.0);
  EXPECT_EQ(spliced.recording.name, "circle");
  EXPECT_EQ(spliced.first_after, std::vector<std::size_t>{100});
  ASSERT_EQ(spliced.recording.scans.size(), 100U + 100U);
  EXPECT_EQ(label(spliced.recording.scans[99]), 99.0F);
  EXPECT_EQ(label(spliced.recording.scans[100]), 200.0F);
  EXPECT_EQ(label(spliced.recording.scans.back()), 299.0F);
  EXPECT_EQ(spliced.recording.scans[100].true_pose, recording.scans[200].true_pose);
}

TEST(Splice, CutsAtTheFirstScanNotBeforeTheTimes) {
  const Spliced spliced = one_cut(circle_drive(), 9.95, 19.91);
  EXPECT_EQ(spliced.first_after, std::vector<std::size_t>{100});
  EXPECT_EQ(label(spliced.recording.scans[100]), 200.0F);
}

TEST(Splice, MayGoBack) {
  const Spliced spliced = one_cut(circle_drive(), 20.0, 5.0);
  ASSERT_EQ(spliced.recording.scans.size(), 200U + 250U);
  EXPECT_EQ(label(spliced.recording.scans[200]), 50.0F);
}

TEST(Splice, LeavesNoTraceInTheStamps) {
  const Recording spliced = one_cut(circle_drive(), 10.0, 20.0).recording;
  for (std::size_t i = 1; i < spliced.scans.size(); ++i) {
    EXPECT_EQ(spliced.scans[i].scan.stamp - spliced.scans[i - 1].scan.stamp, milliseconds(100));
  }
}

TEST(Splice, LeavesNoTraceInTheOdometry) {
  const Recording recording = circle_drive();
  const Recording spliced = one_cut(recording, 10.0, 20.0).recording;
  const Pose step = inverse(*recording.scans[0].scan.odometry) * *recording.scans[1].scan.odometry;
  for (std::size_t i = 1; i < spliced.scans.size(); ++i) {
    const Pose moved =
        inverse(*spliced.scans[i - 1].scan.odometry) * *spliced.scans[i].scan.odometry;
    expect_near(moved, step);  // a circle: all steps are the same
  }
  expect_near(*spliced.scans[100].scan.odometry, *recording.scans[100].scan.odometry);
}

TEST(Splice, TakesSeveralCutsInTheTimeOfTheSplicedRun) {
  const Spliced spliced =
      splice(circle_drive(), std::array{Cut{5.0, 20.0}, Cut{8.0, 1.0}, Cut{30.0, 0.0}});
  EXPECT_EQ(spliced.first_after, (std::vector<std::size_t>{50, 80, 300}));
  EXPECT_EQ(label(spliced.recording.scans[79]), 229.0F);
  EXPECT_EQ(label(spliced.recording.scans[80]), 10.0F);
  EXPECT_EQ(label(spliced.recording.scans[299]), 229.0F);
  EXPECT_EQ(label(spliced.recording.scans[300]), 0.0F);
}

TEST(Splice, WithoutOdometryAtTheCutHasNoneAfterIt) {
  Recording recording = circle_drive();
  recording.scans[200].scan.odometry.reset();
  const Recording spliced = one_cut(recording, 10.0, 20.0).recording;
  EXPECT_TRUE(spliced.scans[99].scan.odometry.has_value());
  EXPECT_FALSE(spliced.scans[100].scan.odometry.has_value());
  EXPECT_FALSE(spliced.scans[150].scan.odometry.has_value());
}

std::string refused_field(const Recording& recording, std::vector<Cut> cuts) {
  try {
    static_cast<void>(splice(recording, cuts));
  } catch (const BadInput& error) {
    return error.field();
  }
  return "";
}

TEST(Splice, RefusesCutsThatCutNothing) {
  const Recording recording = circle_drive();
  EXPECT_EQ(refused_field(recording, {{0.0, 10.0}}), "at_s");
  EXPECT_EQ(refused_field(recording, {{-1.0, 10.0}}), "at_s");
  EXPECT_EQ(refused_field(recording, {{29.91, 10.0}}), "at_s");
  EXPECT_EQ(refused_field(recording, {{10.0, -0.1}}), "to_s");
  EXPECT_EQ(refused_field(recording, {{10.0, 29.91}}), "to_s");
  EXPECT_EQ(refused_field(recording, {{NAN, 1.0}}), "at_s");
  EXPECT_EQ(refused_field(recording, {{1.0, NAN}}), "to_s");
  EXPECT_EQ(refused_field(recording, {{10.0, 20.0}, {10.0, 1.0}}), "at_s");
  EXPECT_EQ(refused_field({}, {{10.0, 20.0}}), "at_s");
}

TEST(FarJump, GoesFromTheMiddleToTheFarthestPlace) {
  const auto cut = far_jump(circle_drive());
  ASSERT_TRUE(cut);
  EXPECT_NEAR(cut->at_s, 15.0, 1e-9);
  EXPECT_NEAR(cut->to_s, 0.0, 1e-9);  // the other side of the circle
}

TEST(FarJump, LeavesScansToWarmUpAndScansToDecide) {
  FarJumpConfig config;
  config.scans_before = 200;
  config.scans_after = 160;
  const auto cut = far_jump(circle_drive(), config);
  ASSERT_TRUE(cut);
  EXPECT_NEAR(cut->at_s, 20.0, 1e-9);
  EXPECT_NEAR(cut->to_s, 5.0, 1e-9);
}

TEST(FarJump, TrustsTruePosesMoreThanOdometry) {
  Recording recording = circle_drive();
  recording.scans[60].true_pose = Pose{100.0, 0.0, 0.0};
  EXPECT_NEAR(far_jump(recording)->to_s, 6.0, 1e-9);
  for (RecordedScan& recorded : recording.scans) recorded.true_pose.reset();
  EXPECT_NEAR(far_jump(recording)->to_s, 0.0, 1e-9);
}

TEST(FarJump, ProposesNothingInARunWithoutFarPlaces) {
  EXPECT_FALSE(far_jump(circle_drive(1.0)));
  EXPECT_FALSE(far_jump({}));
  Recording blind = circle_drive();
  for (RecordedScan& recorded : blind.scans) {
    recorded.true_pose.reset();
    recorded.scan.odometry.reset();
  }
  EXPECT_FALSE(far_jump(blind));
  Recording brief = circle_drive();
  brief.scans.resize(120);
  EXPECT_FALSE(far_jump(brief));
}

TEST(FarJump, CanAlwaysBeSpliced) {
  const Recording recording = circle_drive();
  const auto cut = far_jump(recording);
  ASSERT_TRUE(cut);
  EXPECT_EQ(splice(recording, std::array{*cut}).first_after, std::vector<std::size_t>{150});
}

}  // namespace
}  // namespace kidnapwatch::core::evaluation
