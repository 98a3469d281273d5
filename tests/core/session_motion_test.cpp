// SPDX-License-Identifier: Apache-2.0
// A session whose alarm is motion consistency: incidents with their causes, trouble, and the choice
// of detectors.
#include <gtest/gtest.h>

#include "core/session.hpp"
#include "tests/core/walls.hpp"

namespace kidnapwatch::core {
namespace {

/// Drives circles in a furnished room.
class SessionMotionTest : public testing::Test {
 protected:
  std::optional<EpisodeChange> step(const Pose& motion, const Pose& told) {
    at_ = at_ * motion;
    odometry_ = odometry_ * told;
    Scan scan = seen_from(walls_, at_, now(), 180, 0.01, count_);
    scan.odometry = odometry_;
    ++count_;
    const Observation seen = session_.observe(scan, now(), workspace_);
    last_ = seen.verdict;
    return seen.verdict ? seen.verdict->change : std::nullopt;
  }
  std::optional<EpisodeChange> step() { return step(kStep, kStep); }
  /// The first change within so many scans.
  std::optional<EpisodeChange> drive(int scans) {
    std::optional<EpisodeChange> first;
    for (int i = 0; i < scans; ++i) {
      const auto change = step();
      if (!first) first = change;
    }
    return first;
  }
  void take_off() { at_ = {1.2, 5.0, 0.4}; }
  void choose(AlarmBy alarm) {
    DetectionConfig config;
    config.alarm = alarm;
    session_.configure(config);
  }
  [[nodiscard]] Stamp now() const { return at_s(0.1 * count_); }

  static constexpr Pose kStep{0.05, 0.0, 0.05};
  Walls walls_ = furnished_room();
  Pose at_{5.9, 2.6, 1.5708};
  Pose odometry_;
  unsigned count_ = 0;
  DissimilarityWorkspace workspace_;
  Session session_{DetectionConfig{}};
  std::optional<Verdict> last_;
};

TEST_F(SessionMotionTest, ShowsItsWarmUpUntilItHasAThreshold) {
  EXPECT_FALSE(drive(60));
  EXPECT_EQ(session_.state(now()), RobotState::unknown);
  EXPECT_GT(session_.calibration_pairs(), 40U);
  EXPECT_FALSE(drive(80));
  EXPECT_EQ(session_.state(now()), RobotState::normal);
}

TEST_F(SessionMotionTest, OpensAnIncidentWithCauseDetectorAndBothScans) {
  ASSERT_FALSE(drive(200));
  const Stamp before = last_->score.stamp;
  take_off();
  EXPECT_FALSE(step());
  EXPECT_EQ(session_.state(now()), RobotState::suspect);
  EXPECT_EQ(step(), EpisodeChange::opened);
  EXPECT_EQ(session_.state(now()), RobotState::kidnapped);
  const Jump& jump = *session_.jump();
  EXPECT_EQ(jump.cause, Cause::teleport);
  EXPECT_EQ(jump.detector, "motion_consistency");
  EXPECT_EQ(jump.scans.before.stamp, before);
  EXPECT_GT(jump.score, jump.threshold);
  EXPECT_EQ(jump.score, last_->score.motion->confirmed);
}

TEST_F(SessionMotionTest, TellsASlipByName) {
  drive(200);
  step({}, {0.45, 0.0, 0.0});
  EXPECT_EQ(drive(3), EpisodeChange::opened);
  EXPECT_EQ(session_.jump()->cause, Cause::slip);
}

TEST_F(SessionMotionTest, FindsACarryAndNamesIt) {
  drive(200);
  std::optional<EpisodeChange> change;
  for (int i = 0; i < 30 && !change; ++i) change = step(kStep, {});
  EXPECT_EQ(change, EpisodeChange::opened);
  EXPECT_EQ(session_.jump()->cause, Cause::carry);
}

TEST_F(SessionMotionTest, LearnsNothingWhileAnIncidentIsOpen) {
  drive(200);
  take_off();
  drive(3);
  const auto pairs = session_.calibration_pairs();
  drive(20);
  EXPECT_EQ(session_.calibration_pairs(), pairs);
}

TEST_F(SessionMotionTest, RecordsMotionWhereItHasASayAndThePapersScoreAlways) {
  drive(130);
  choose(AlarmBy::qs2ddtw);
  step();
  EXPECT_GT(last_->score.dissimilarity.cost, 0.0);
  EXPECT_FALSE(last_->score.motion);
  for (const AlarmBy alarm : {AlarmBy::motion_consistency, AlarmBy::either, AlarmBy::both}) {
    choose(alarm);
    step();
    EXPECT_GT(last_->score.dissimilarity.cost, 0.0);
    EXPECT_TRUE(last_->score.threshold);
    ASSERT_TRUE(last_->score.motion);
    EXPECT_TRUE(last_->score.motion->threshold);
  }
}

TEST_F(SessionMotionTest, ComparesWithNoScanOfBeforeItHadASay) {
  drive(200);
  choose(AlarmBy::qs2ddtw);
  take_off();
  drive(3);
  choose(AlarmBy::motion_consistency);
  EXPECT_FALSE(drive(5));
}

TEST_F(SessionMotionTest, RaisesAlarmByWhatIsConfigured) {
  drive(200);
  choose(AlarmBy::qs2ddtw);  // a slip changes no scan: the paper's score cannot see it
  step({}, {0.45, 0.0, 0.0});
  EXPECT_FALSE(drive(3));
  choose(AlarmBy::both);
  step({}, {0.45, 0.0, 0.0});
  EXPECT_FALSE(drive(3));
  choose(AlarmBy::either);
  step({}, {0.45, 0.0, 0.0});
  EXPECT_EQ(drive(3), EpisodeChange::opened);
}

TEST_F(SessionMotionTest, WantsBothToAgreeIfToldSo) {
  drive(200);
  choose(AlarmBy::both);
  take_off();
  EXPECT_EQ(drive(3), EpisodeChange::opened);
}

TEST_F(SessionMotionTest, IsDegradedWhenTheWheelsKeepLying) {
  drive(200);
  for (int i = 0; i < 30; ++i) step(kStep, kStep * Pose{0.0, 0.0, 0.2});
  EXPECT_EQ(session_.state(now()), RobotState::degraded);
  EXPECT_EQ(session_.trouble(), Trouble::odometry);
}

TEST_F(SessionMotionTest, IsDegradedWhenNearlyBlind) {
  drive(150);
  for (int i = 0; i < 30; ++i)
    session_.observe(*std::make_unique<Scan>(empty_space(later_by_s(now(), 0.1 * i))), now(),
                     workspace_);
  EXPECT_EQ(session_.state(now()), RobotState::degraded);
  EXPECT_EQ(session_.trouble(), Trouble::blind);
}

}  // namespace
}  // namespace kidnapwatch::core
