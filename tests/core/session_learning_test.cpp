// SPDX-License-Identifier: Apache-2.0
// What a session learns, keeps and takes over.
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/session_fixture.hpp"

namespace kidnapwatch::core {
namespace {

using SessionLearning = SessionTest;

TEST_F(SessionLearning, WarmsUpWithoutAThreshold) {
  calibrate_instead(20);
  observe(2.0, 0.0);
  for (int i = 1; i < 20; ++i) {
    const Verdict verdict = judged(2.0 + 0.001 * (i % 3), i);
    EXPECT_EQ(verdict.score.state, RobotState::unknown);
    EXPECT_FALSE(verdict.score.threshold);
    EXPECT_EQ(session_.calibration_pairs(), static_cast<std::size_t>(i));
  }
  EXPECT_EQ(judged(2.0, 20.0).score.state, RobotState::normal);
  EXPECT_TRUE(session_.threshold());
}

TEST_F(SessionLearning, AlarmsByTheThresholdThatItLearned) {
  calibrate_instead(20);
  for (int i = 0; i <= 20; ++i) {
    observe(2.0 + 0.001 * (i % 3), i);
  }
  ASSERT_TRUE(session_.threshold());
  judged(8.0, 21.0);
  EXPECT_EQ(judged(8.0, 22.0).change, EpisodeChange::opened);
}

TEST_F(SessionLearning, PrefersTheConfiguredThresholdToTheLearnedOne) {
  calibrate_instead(20);
  for (int i = 0; i <= 20; ++i) {
    observe(2.0 + 0.001 * (i % 3), i);
  }
  ASSERT_NE(session_.threshold(), std::nullopt);
  DetectionConfig config = plain_config();
  config.calibration.warmup_pairs = 20;
  session_.configure(config);
  EXPECT_EQ(session_.threshold(), 4.0);
}

TEST_F(SessionLearning, LearnsNothingFromAKidnapping) {
  kidnap();
  const std::size_t learned = session_.calibration_pairs();
  for (int i = 1; i < 20; ++i) {
    judged(8.0, i);
  }
  judged(5.0, 20.0);  // a glitch in the open incident
  judged(8.0, 21.0);
  judged(8.0, 22.0);
  EXPECT_EQ(session_.calibration_pairs(), learned);
  session_.resolve();
  judged(8.0, 23.0);
  EXPECT_EQ(session_.calibration_pairs(), learned + 1);
}

TEST_F(SessionLearning, TakesAnotherThresholdWhileDriving) {
  observe(2.0, 0.0);
  EXPECT_EQ(judged(2.05, 0.2).score.state, RobotState::normal);
  DetectionConfig config = plain_config();
  config.threshold = 1.0;
  session_.configure(config);
  EXPECT_EQ(session_.threshold(), 1.0);
  const Score score = judged(2.1, 0.4).score;
  EXPECT_EQ(score.reference, at_s(0.2));
  EXPECT_EQ(score.threshold, 1.0);
  EXPECT_EQ(score.state, RobotState::suspect);
}

TEST_F(SessionLearning, KeepsWhatItLearnedUnlessTheScoreChanges) {
  for (int i = 0; i <= 30; ++i) {
    observe(2.0 + 0.001 * (i % 3), i);
  }
  DetectionConfig config = plain_config();
  config.stale_after_s = 60.0;
  session_.configure(config);
  EXPECT_EQ(session_.calibration_pairs(), 30U);
  config.dissimilarity.gate = Gate::always;
  session_.configure(config);
  EXPECT_EQ(session_.calibration_pairs(), 0U);
}

TEST_F(SessionLearning, ForgetsASuspicionInTheUnitOfAnotherScore) {
  observe(2.0, 0.0);
  judged(8.0, 0.2);
  DetectionConfig config = plain_config();
  config.dissimilarity.dimension = Dimension::points;
  session_.configure(config);
  const Verdict verdict = judged(8.0, 0.4);
  EXPECT_FALSE(verdict.change);
  EXPECT_EQ(verdict.score.state, RobotState::normal);
}

TEST_F(SessionLearning, DoesNotMeasureAJumpInTheUnitOfAnotherScore) {
  observe(2.0, 0.0);
  judged(8.0, 0.2);
  DetectionConfig config = plain_config();
  config.dissimilarity.dimension = Dimension::points;
  session_.configure(config);
  judged(6.0, 0.4);
  EXPECT_EQ(judged(6.0, 0.6).change, EpisodeChange::opened);
}

TEST_F(SessionLearning, TakesUpWhereAnEarlierRunStopped) {
  calibrate_instead(20);
  std::vector<double> natural;
  observe(2.0, 0.0);
  for (int i = 1; i <= 25; ++i) {
    natural.push_back(judged(2.0 + 0.001 * (i % 3), i).score.dissimilarity.cost);
  }
  DetectionConfig config = plain_config();
  config.threshold.reset();
  config.calibration.warmup_pairs = 20;
  Session resumed(config);
  resumed.resume(natural, false, at_s(25.0));
  EXPECT_EQ(resumed.threshold(), session_.threshold());
  EXPECT_EQ(resumed.calibration_pairs(), 25U);
  EXPECT_EQ(resumed.state(at_s(25.0)), RobotState::normal);
}

TEST_F(SessionLearning, TakesUpAnOpenIncidentAndResolvesItByRule) {
  session_.resume({}, true, at_s(0.0));
  EXPECT_EQ(session_.state(at_s(0.0)), RobotState::kidnapped);
  observe(8.0, 0.0);
  EXPECT_FALSE(judged(8.0, 1.0).change);
  EXPECT_EQ(judged(8.0, 31.0).change, EpisodeChange::resolved);
}

}  // namespace
}  // namespace kidnapwatch::core
