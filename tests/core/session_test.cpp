// SPDX-License-Identifier: Apache-2.0
// What a session concludes from one scan after another.
#include "core/session.hpp"

#include <gtest/gtest.h>

#include "tests/core/session_fixture.hpp"

namespace kidnapwatch::core {
namespace {

TEST_F(SessionTest, MakesTheFirstScanTheReference) {
  const Observation observation = observe(2.0, 0.0);
  EXPECT_EQ(observation.outcome, Outcome::first);
  EXPECT_FALSE(observation.verdict);
}

TEST_F(SessionTest, ScoresEachScanAgainstTheOneBefore) {
  observe(2.0, 0.0);
  const Score score = judged(2.05, 0.2).score;
  EXPECT_EQ(score.stamp, at_s(0.2));
  EXPECT_EQ(score.reference, at_s(0.0));
  EXPECT_NEAR(score.dissimilarity.cost, 2.0, 1e-5);
  EXPECT_EQ(score.threshold, 4.0);
  EXPECT_EQ(score.state, RobotState::normal);
}

TEST_F(SessionTest, RaisesOneIncidentWhenTheRoomChanges) {
  observe(2.0, 0.0);
  const Verdict jump = judged(8.0, 0.2);
  EXPECT_EQ(jump.score.state, RobotState::suspect);
  EXPECT_FALSE(jump.change);
  const Verdict confirmed = judged(8.0, 0.4);
  EXPECT_EQ(confirmed.score.state, RobotState::kidnapped);
  EXPECT_EQ(confirmed.change, EpisodeChange::opened);
  const Verdict after = judged(8.0, 0.6);
  EXPECT_EQ(after.score.state, RobotState::kidnapped);
  EXPECT_FALSE(after.change);
}

TEST_F(SessionTest, KeepsTheJumpAsEvidence) {
  EXPECT_FALSE(session_.jump());
  kidnap();
  ASSERT_TRUE(session_.jump());
  EXPECT_EQ(session_.jump()->scans.before.stamp, at_s(0.0));
  EXPECT_EQ(session_.jump()->scans.after.stamp, at_s(0.2));
  EXPECT_FLOAT_EQ(session_.jump()->scans.after.ranges_m.front(), 8.0F);
  EXPECT_NEAR(session_.jump()->score, 240.0, 1e-3);
  EXPECT_EQ(session_.jump()->threshold, 4.0);
}

TEST_F(SessionTest, TakesAGlitchOfOneScanForNormal) {
  observe(2.0, 0.0);
  EXPECT_EQ(judged(8.0, 0.2).score.state, RobotState::suspect);
  const Verdict back = judged(2.0, 0.4);  // the way back is a jump as well
  EXPECT_GT(back.score.dissimilarity.cost, 4.0);
  EXPECT_FALSE(back.change);
  const Verdict after = judged(2.0, 0.6);
  EXPECT_FALSE(after.change);
  EXPECT_EQ(after.score.state, RobotState::normal);
  EXPECT_FALSE(session_.jump());
}

TEST_F(SessionTest, TakesARunOfHighScoresForAFastTurn) {
  double radius_m = 2.0;
  observe(radius_m, 0.0);
  for (int i = 1; i < 10; ++i) {
    radius_m += 0.5;
    const Verdict turning = judged(radius_m, i);
    EXPECT_NEAR(turning.score.dissimilarity.cost, 20.0, 1e-3);
    EXPECT_FALSE(turning.change);
  }
  EXPECT_FALSE(judged(radius_m, 10.0).change);
  EXPECT_EQ(session_.state(at_s(10.0)), RobotState::normal);
}

TEST_F(SessionTest, AsksOfAJumpThatItIsTwiceItsNeighbours) {
  const auto jumps = [this](double before_m, double jump_m, double after_m, double t_s) {
    session_ = Session(plain_config());
    const double a_m = 2.0 + before_m;
    observe(2.0, t_s);
    observe(a_m, t_s + 1.0);
    observe(a_m + jump_m, t_s + 2.0);
    return judged(a_m + jump_m + after_m, t_s + 3.0).change == EpisodeChange::opened;
  };
  EXPECT_TRUE(jumps(0.0, 1.01, 0.5, 0.0));
  EXPECT_FALSE(jumps(0.0, 0.99, 0.5, 10.0));
  EXPECT_TRUE(jumps(0.5, 1.01, 0.0, 20.0));
  EXPECT_FALSE(jumps(0.5, 0.99, 0.0, 30.0));
}

TEST_F(SessionTest, AsksOfAJumpThatTheNextScanIsNotBackWithinTheThreshold) {
  const auto jumps = [this](double radius_m, double t_s) {
    session_ = Session(plain_config());
    observe(2.0, t_s);
    observe(2.15, t_s + 0.2);
    return judged(radius_m, t_s + 0.4).change == EpisodeChange::opened;
  };
  EXPECT_TRUE(jumps(2.11, 0.0));
  EXPECT_FALSE(jumps(2.09, 10.0));
}

TEST_F(SessionTest, ConfirmsAcrossScansThatCannotBeCompared) {
  observe(2.0, 0.0);
  judged(8.0, 0.2);
  EXPECT_EQ(feed(session_, empty_space(at_s(0.4)), at_s(0.4)).outcome, Outcome::not_comparable);
  EXPECT_EQ(session_.state(at_s(0.4)), RobotState::suspect);
  EXPECT_EQ(judged(8.0, 0.6).change, EpisodeChange::opened);
}

TEST_F(SessionTest, DoesNotAlarmAtTheThresholdItself) {
  DetectionConfig config = plain_config();
  config.threshold = 40.0;  // exactly one metre
  session_.configure(config);
  observe(2.0, 0.0);
  EXPECT_EQ(judged(3.0, 0.2).score.state, RobotState::normal);
}

TEST_F(SessionTest, UpdatesTheOpenIncidentWhenMovedAgain) {
  kidnap();
  EXPECT_FALSE(judged(5.0, 0.6).change);
  EXPECT_EQ(judged(5.0, 0.8).change, EpisodeChange::updated);
  EXPECT_EQ(session_.jump()->scans.before.stamp, at_s(0.4));
  EXPECT_EQ(session_.jump()->scans.after.stamp, at_s(0.6));
}

TEST_F(SessionTest, DoesNotUpdateForAGlitchInAnOpenIncident) {
  kidnap();
  judged(5.0, 0.6);
  EXPECT_FALSE(judged(8.0, 0.8).change);
  EXPECT_EQ(session_.jump()->scans.after.stamp, at_s(0.2));
}

TEST_F(SessionTest, ResolvesWhenTheScansHaveFitForLongEnough) {
  kidnap();
  judged(8.0, 1.0);  // fits: the time runs from here
  EXPECT_FALSE(judged(8.0, 30.9).change);
  const Verdict verdict = judged(8.0, 31.0);
  EXPECT_EQ(verdict.change, EpisodeChange::resolved);
  EXPECT_EQ(verdict.score.state, RobotState::normal);
  EXPECT_FALSE(judged(8.0, 100.0).change);
}

TEST_F(SessionTest, StartsTheTimeAnewAfterEveryJump) {
  kidnap();
  judged(8.0, 1.0);
  judged(5.0, 30.0);
  judged(5.0, 30.5);
  judged(5.0, 31.0);
  EXPECT_FALSE(judged(5.0, 60.9).change);
  EXPECT_EQ(judged(5.0, 61.0).change, EpisodeChange::resolved);
}

TEST_F(SessionTest, DoesNotStartTheTimeAnewAfterAGlitch) {
  kidnap();
  judged(8.0, 1.0);
  judged(5.0, 15.0);
  judged(8.0, 15.2);
  judged(8.0, 15.4);
  EXPECT_EQ(judged(8.0, 31.0).change, EpisodeChange::resolved);
}

TEST_F(SessionTest, NeverResolvesByRuleIfToldSo) {
  DetectionConfig config = plain_config();
  config.resolve_after_s = 0.0;
  session_.configure(config);
  kidnap();
  judged(8.0, 1.0);
  EXPECT_EQ(judged(8.0, 1e6).score.state, RobotState::kidnapped);
}

TEST_F(SessionTest, IsResolvedFromOutsideOnce) {
  EXPECT_FALSE(session_.resolve());
  kidnap();
  EXPECT_TRUE(session_.resolve());
  EXPECT_FALSE(session_.resolve());
  EXPECT_EQ(session_.state(at_s(0.4)), RobotState::normal);
  judged(2.0, 0.6);
  EXPECT_EQ(judged(2.0, 0.8).change, EpisodeChange::opened);
}

TEST(Session, FindsARoomChangedWithThePapersScore) {
  DetectionConfig config;
  config.alarm = AlarmBy::qs2ddtw;
  config.calibration.warmup_pairs = 20;
  Session session(config);
  for (int i = 0; i <= 40; ++i) {
    feed(session, round_room(2.0 + 0.002 * (i % 5), at_s(i)), at_s(i));
  }
  ASSERT_EQ(session.state(at_s(40.0)), RobotState::normal);
  feed(session, round_room(8.0, at_s(41.0)), at_s(41.0));
  const auto observation = feed(session, round_room(8.0, at_s(42.0)), at_s(42.0));
  ASSERT_TRUE(observation.verdict);
  EXPECT_EQ(observation.verdict->change, EpisodeChange::opened);
}

}  // namespace
}  // namespace kidnapwatch::core
