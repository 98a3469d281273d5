// SPDX-License-Identifier: Apache-2.0
// A robot's own threshold.
#include "core/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

std::vector<double> exponential_scores(std::size_t n, double mean, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> score(1.0 / mean);
  std::vector<double> scores(n);
  std::ranges::generate(scores, [&] { return score(random); });
  return scores;
}

std::vector<double> one_to(std::size_t n) {
  std::vector<double> scores(n);
  for (std::size_t i = 0; i < n; ++i) {
    scores[i] = static_cast<double>(i + 1);
  }
  return scores;
}

void learn(Calibration& calibration, const std::vector<double>& scores) {
  for (const double score : scores) {
    calibration.learn(score);
  }
}

TEST(ExponentialTailThreshold, AddsLogsOfTheMeanExcess) {
  // q95 is 96; 97, 98, 99 and 100 exceed it by 2.5 on average
  EXPECT_DOUBLE_EQ(exponential_tail_threshold(one_to(100), 0.001), 96.0 + 2.5 * std::log(50.0));
}

TEST(ExponentialTailThreshold, DoesNotCareAboutTheOrder) {
  auto scores = one_to(100);
  std::ranges::shuffle(scores, std::mt19937_64(1));
  EXPECT_DOUBLE_EQ(exponential_tail_threshold(scores, 0.001), 96.0 + 2.5 * std::log(50.0));
}

TEST(ExponentialTailThreshold, IsTheQuantileOfExponentialScores) {
  const auto scores = exponential_scores(100'000, 2.0, 1);
  for (const double rate : {1e-2, 1e-3, 1e-4}) {
    EXPECT_NEAR(exponential_tail_threshold(scores, rate), -2.0 * std::log(rate),
                -0.1 * std::log(rate));
  }
}

TEST(ExponentialTailThreshold, IsFiniteForTheLeastRateThereIs) {
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_TRUE(std::isfinite(exponential_tail_threshold(one_to(100), least)));
}

TEST(ExponentialTailThreshold, IsTheScoreWhereAllAreEqual) {
  EXPECT_EQ(exponential_tail_threshold(std::vector<double>(20, 3.5), 0.001), 3.5);
}

TEST(Calibration, HasNoThresholdWhileWarmingUp) {
  Calibration calibration({.false_alarm_rate = 0.001, .warmup_pairs = 100, .window_pairs = 200});
  learn(calibration, one_to(99));
  EXPECT_EQ(calibration.threshold(), std::nullopt);
  EXPECT_EQ(calibration.pairs(), 99U);
  calibration.learn(100.0);
  EXPECT_EQ(calibration.threshold(), exponential_tail_threshold(one_to(100), 0.001));
}

TEST(Calibration, ForgetsWhatLeftItsWindow) {
  const CalibrationConfig config{
      .false_alarm_rate = 0.001, .warmup_pairs = 20, .window_pairs = 100};
  Calibration calibration(config);
  learn(calibration, exponential_scores(300, 50.0, 1));
  learn(calibration, one_to(100));
  EXPECT_EQ(calibration.pairs(), 100U);
  EXPECT_EQ(calibration.threshold(), exponential_tail_threshold(one_to(100), 0.001));
}

TEST(Calibration, FollowsItsRobotWithinTwentyScores) {
  const auto scores = exponential_scores(500, 1.0, 7);
  Calibration calibration({.false_alarm_rate = 0.001, .warmup_pairs = 20, .window_pairs = 1000});
  learn(calibration, scores);
  const double before = calibration.threshold().value();
  learn(calibration, std::vector<double>(20, 100.0));
  EXPECT_GT(calibration.threshold().value(), before);
}

TEST(Calibration, KeepsItsScoresWhenConfigured) {
  const auto scores = exponential_scores(150, 1.0, 3);
  CalibrationConfig config{.false_alarm_rate = 0.001, .warmup_pairs = 100, .window_pairs = 200};
  Calibration calibration(config);
  learn(calibration, scores);
  config.false_alarm_rate = 0.01;
  calibration.configure(config);
  EXPECT_EQ(calibration.pairs(), 150U);
  EXPECT_EQ(calibration.threshold(), exponential_tail_threshold(scores, 0.01));
}

TEST(Calibration, WarmsUpAgainIfMoreScoresAreAskedFor) {
  CalibrationConfig config{.false_alarm_rate = 0.001, .warmup_pairs = 20, .window_pairs = 200};
  Calibration calibration(config);
  learn(calibration, one_to(50));
  config.warmup_pairs = 60;
  calibration.configure(config);
  EXPECT_EQ(calibration.threshold(), std::nullopt);
  learn(calibration, one_to(10));
  EXPECT_TRUE(calibration.threshold().has_value());
}

TEST(Calibration, DropsTheOldestForASmallerWindow) {
  CalibrationConfig config{.false_alarm_rate = 0.001, .warmup_pairs = 20, .window_pairs = 200};
  Calibration calibration(config);
  learn(calibration, std::vector<double>(100, 1000.0));
  learn(calibration, one_to(100));
  config.window_pairs = 100;
  calibration.configure(config);
  EXPECT_EQ(calibration.threshold(), exponential_tail_threshold(one_to(100), 0.001));
}

}  // namespace
}  // namespace kidnapwatch::core
