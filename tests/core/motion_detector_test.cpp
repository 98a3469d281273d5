// SPDX-License-Identifier: Apache-2.0
// The detector on a robot that circles in a room: what it reports, and what it must not.
#include "core/motion_detector.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "tests/core/walls.hpp"

namespace kidnapwatch::core {
namespace {

/// Drives circles of 1 m radius around (4.9, 2.6); tells odometry as asked.
class MotionDetectorTest : public testing::Test {
 protected:
  explicit MotionDetectorTest(Walls walls = furnished_room()) : walls_(std::move(walls)) {}

  Scan scan() {
    Scan seen = seen_from(walls_, at_, at_s(0.1 * static_cast<double>(count_)), 360, 0.01, count_);
    ++count_;
    if (tells_odometry_) seen.odometry = odometry_;
    return seen;
  }
  /// Drives one step, of which the wheels tell `told`.
  MotionVerdict step(const Pose& motion, const Pose& told, bool learn = true) {
    at_ = at_ * motion;
    odometry_ = odometry_ * told;
    return note(detector_.observe(scan(), learn));
  }
  MotionVerdict step() { return step(kStep, kStep); }
  void drive(int scans) {
    for (int i = 0; i < scans; ++i) step();
  }
  MotionVerdict note(const MotionVerdict& verdict) {
    if (verdict.jump && verdict.jump->alarm) {
      ++alarms_;
      cause_ = verdict.jump->cause;
    }
    carries_ += verdict.carried;
    return verdict;
  }

  static constexpr Pose kStep{0.05, 0.0, 0.05};
  Walls walls_;
  Pose at_{5.9, 2.6, 1.5708};
  Pose odometry_;
  unsigned count_ = 0;
  bool tells_odometry_ = true;
  MotionDetector detector_{MotionConfig{}};
  int alarms_ = 0;
  int carries_ = 0;
  std::optional<Cause> cause_;
};

TEST_F(MotionDetectorTest, WarmsUpBeforeItHasAThreshold) {
  EXPECT_FALSE(step().threshold);
  drive(100);
  EXPECT_TRUE(step().threshold);
}

TEST_F(MotionDetectorTest, CallsNothingTroubleWhileItKnowsNothingOfTheRobot) {
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(step().trouble) << i;
}

TEST_F(MotionDetectorTest, RaisesNothingOnANaturalDrive) {
  drive(600);
  EXPECT_EQ(alarms_, 0);
  EXPECT_EQ(carries_, 0);
}

TEST_F(MotionDetectorTest, ReportsATeleportWithTheNextScan) {
  drive(200);
  at_ = {1.2, 5.0, 0.4};
  EXPECT_FALSE(step().jump->alarm);  // of the pair before
  const MotionVerdict verdict = step();
  EXPECT_TRUE(verdict.jump->alarm);
  EXPECT_GT(verdict.jump->clues.misfit, 1.0F);
  EXPECT_EQ(cause_, Cause::teleport);
  drive(20);
  EXPECT_EQ(alarms_, 1);
}

TEST_F(MotionDetectorTest, ReportsAShortMoveAsDisplaced) {
  drive(200);
  step(kStep * Pose{0.0, 0.35, 0.0}, kStep);
  drive(5);
  EXPECT_EQ(alarms_, 1);
  EXPECT_EQ(cause_, Cause::displaced);
}

TEST_F(MotionDetectorTest, ReportsATurnOnTheSpot) {
  for (const double degrees : {15.0, 30.0, 90.0, 180.0}) {
    drive(150);
    alarms_ = 0;
    step(kStep * Pose{0.0, 0.0, degrees * 0.01745}, kStep);
    drive(5);
    EXPECT_EQ(alarms_, 1) << degrees;
    at_ = at_ * Pose{0.0, 0.0, -degrees * 0.01745};
    drive(30);
  }
}

TEST_F(MotionDetectorTest, TellsASlipFromATeleport) {
  drive(200);
  step({}, Pose{0.45, 0.0, 0.0});
  drive(5);
  EXPECT_EQ(alarms_, 1);
  EXPECT_EQ(cause_, Cause::slip);
}

TEST_F(MotionDetectorTest, ForgivesAGlitchOfOneScan) {
  drive(200);
  const Pose here = at_;
  at_ = {1.2, 5.0, 0.4};
  odometry_ = odometry_ * kStep;
  note(detector_.observe(scan()));
  at_ = here * kStep;
  drive(10);
  EXPECT_EQ(alarms_, 0);
}

TEST_F(MotionDetectorTest, ForgivesAnOdometryPoseThatIsOffOnce) {
  drive(200);
  const Pose right = odometry_ * kStep;
  step(kStep, kStep * Pose{0.4, 0.0, 0.2});
  odometry_ = right;
  drive(10);
  EXPECT_EQ(alarms_, 0);
}

TEST_F(MotionDetectorTest, ForgivesMissedScans) {
  drive(200);
  for (int i = 0; i < 10; ++i) {
    at_ = at_ * kStep;
    odometry_ = odometry_ * kStep;
    ++count_;
  }
  drive(10);
  EXPECT_EQ(alarms_, 0);
}

TEST_F(MotionDetectorTest, CallsPersistentlyBadOdometryTroubleAndNoKidnapping) {
  drive(200);
  std::optional<Trouble> trouble;
  for (int i = 0; i < 30; ++i) trouble = step(kStep, kStep * Pose{0.0, 0.0, 0.2}, false).trouble;
  EXPECT_EQ(trouble, Trouble::odometry);
  EXPECT_EQ(alarms_, 0);
}

TEST_F(MotionDetectorTest, FindsASlowCarry) {
  drive(200);
  for (int i = 0; i < 30 && carries_ == 0; ++i) step(kStep, {}, false);
  EXPECT_EQ(carries_, 1);
}

TEST_F(MotionDetectorTest, FindsATeleportWithoutOdometry) {
  tells_odometry_ = false;
  drive(200);
  EXPECT_EQ(alarms_, 0);
  at_ = {1.2, 5.0, 0.4};
  drive(5);
  EXPECT_EQ(alarms_, 1);
}

TEST_F(MotionDetectorTest, FindsATeleportWithoutOdometryThoughAScanIsLate) {
  tells_odometry_ = false;
  drive(200);
  at_ = {1.2, 5.0, 0.4};
  for (int i = 0; i < 5; ++i) {
    at_ = at_ * kStep;
    Scan seen = scan();
    seen.stamp = later_by_s(seen.stamp, 0.06);  // rather two periods than one after the last
    note(detector_.observe(seen));
  }
  EXPECT_EQ(alarms_, 1);
}

TEST_F(MotionDetectorTest, RaisesNothingWhileStanding) {
  tells_odometry_ = false;
  for (int i = 0; i < 400; ++i) step({}, {});
  EXPECT_EQ(alarms_ + carries_, 0);
}

TEST_F(MotionDetectorTest, LearnsNothingWhenToldSo) {
  drive(200);
  const float pairs = detector_.pairs();
  for (int i = 0; i < 20; ++i) step(kStep, kStep, false);
  EXPECT_EQ(detector_.pairs(), pairs);
}

TEST_F(MotionDetectorTest, FollowsWheelsThatWearDown) {
  drive(200);
  for (int i = 1; i <= 800; ++i) {  // until they tell 8 % too much
    const double factor = 1.0 + 0.08 * i / 800.0;
    step(kStep, {kStep.x_m * factor, 0.0, kStep.theta_rad * factor});
  }
  EXPECT_EQ(alarms_ + carries_, 0);
  const Pose worn{kStep.x_m * 1.08, 0.0, kStep.theta_rad * 1.08};
  const Pose expected = detector_.wheels().expected({worn, 1.0, worn, 1.0});
  EXPECT_NEAR(expected.x_m, kStep.x_m, 0.5 * (worn.x_m - kStep.x_m));
  EXPECT_NEAR(expected.theta_rad, kStep.theta_rad, 0.5 * (worn.theta_rad - kStep.theta_rad));
}

TEST_F(MotionDetectorTest, HasNoThresholdBelowTheFleets) {
  drive(200);
  const auto own = detector_.own_threshold();
  ASSERT_TRUE(own);
  EXPECT_EQ(detector_.threshold(), std::max(*own, 6.0F));
  detector_.set_fleet_threshold(12.0);
  EXPECT_EQ(detector_.threshold(), 12.0F);
  EXPECT_EQ(detector_.own_threshold(), own);
  at_ = {1.2, 5.0, 0.4};
  drive(5);
  EXPECT_EQ(alarms_, 1);  // and still finds what is plain
}

TEST_F(MotionDetectorTest, GoesOnWithWhatWasLearnedBefore) {
  drive(300);
  const std::vector<float> learned = detector_.learned();
  MotionDetector next{MotionConfig{}};
  ASSERT_TRUE(next.restore(learned));
  EXPECT_EQ(next.learned(), learned);
  EXPECT_EQ(next.threshold(), detector_.threshold());
  detector_ = next;  // which has seen no scan yet
  at_ = {5.9, 2.6, 1.5708};
  drive(5);
  EXPECT_EQ(alarms_, 0);
  at_ = {1.2, 5.0, 0.4};
  drive(5);
  EXPECT_EQ(alarms_, 1);
}

TEST_F(MotionDetectorTest, RefusesWhatItNeverLearned) {
  drive(100);
  std::vector<float> learned = detector_.learned();
  MotionDetector next{MotionConfig{}};
  EXPECT_FALSE(next.restore({}));
  EXPECT_FALSE(next.restore(std::span(learned).first(learned.size() - 1)));
  learned[0] += 1.0F;  // of another version
  EXPECT_FALSE(next.restore(learned));
  learned = detector_.learned();
  learned[5] = std::nanf("");
  EXPECT_FALSE(next.restore(learned));
  EXPECT_EQ(next.pairs(), 0.0F);
}

TEST_F(MotionDetectorTest, ComparesNothingAcrossForgottenScans) {
  drive(200);
  detector_.forget_scans();
  at_ = {1.2, 5.0, 0.4};
  EXPECT_FALSE(step().jump);
  drive(10);
  EXPECT_EQ(alarms_, 0);
}

TEST_F(MotionDetectorTest, CallsAnEmptyViewBlind) {
  drive(200);
  std::optional<Trouble> trouble;
  for (int i = 0; i < 3; ++i)
    trouble = detector_.observe(round_room(0.0, at_s(100.0 + i), 360)).trouble;
  EXPECT_EQ(trouble, Trouble::blind);
}

/// What cannot be seen cannot be found: told in the README.
class SymmetricPlaces : public MotionDetectorTest {
 protected:
  SymmetricPlaces() : MotionDetectorTest(box(8.0, 6.0)) { at_ = {4.0, 3.0, 0.0}; }
};

TEST_F(SymmetricPlaces, ATurnByHalfInASymmetricRoomIsInvisible) {
  for (int i = 0; i < 200; ++i) step({}, {});
  step({0.0, 0.0, 3.14159265}, {});
  for (int i = 0; i < 5; ++i) step({}, {});
  EXPECT_EQ(alarms_, 0);
}

TEST_F(SymmetricPlaces, AShiftAlongAFeaturelessCorridorIsInvisible) {
  walls_ = box(200.0, 2.0);
  at_ = {60.0, 1.0, 0.0};
  for (int i = 0; i < 200; ++i) step({0.05, 0.0, 0.0}, {0.05, 0.0, 0.0});
  step({3.0, 0.0, 0.0}, {0.05, 0.0, 0.0});
  for (int i = 0; i < 5; ++i) step({0.05, 0.0, 0.0}, {0.05, 0.0, 0.0});
  EXPECT_EQ(alarms_, 0);
}

TEST_F(SymmetricPlaces, ATeleportBetweenRoomsThatLookTheSameIsInvisible) {
  walls_ = furnished_room();
  for (const Line& wall : furnished_room())
    walls_.push_back({wall.x0 + 20.0, wall.y0, wall.x1 + 20.0, wall.y1});
  at_ = {5.9, 2.6, 1.5708};
  drive(200);
  at_.x_m += 20.0;
  drive(5);
  EXPECT_EQ(alarms_, 0);
}

TEST(Names, SayWhatHappened) {
  EXPECT_EQ(name(Cause::slip), "slip");
  EXPECT_EQ(name(Trouble::crowd), "crowd");
  EXPECT_EQ(sentence(Cause::slip), "The walls are where they were, but the wheels say it moved.");
  EXPECT_FALSE(sentence(Trouble::noise).empty());
}

}  // namespace
}  // namespace kidnapwatch::core
