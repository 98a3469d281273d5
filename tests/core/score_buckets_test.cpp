// SPDX-License-Identifier: Apache-2.0
// Scores by time: nothing is counted twice, and no spike is lost.
#include "core/score_buckets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

using std::chrono::seconds;

Score score(double at_s, double cost, RobotState state = RobotState::normal) {
  Score score;
  score.stamp = later_by_s(Stamp{}, at_s);
  score.dissimilarity.cost = cost;
  score.state = state;
  return score;
}

TEST(ScoreBuckets, KeepTheSpikeBesideTheMean) {
  ScoreBuckets buckets(seconds(10), 100);
  for (int i = 0; i < 99; ++i) buckets.add(score(0.1 * i, 1.0));
  buckets.add(score(9.95, 1000.0, RobotState::suspect));
  const auto all = buckets.all();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].scores, 100U);
  EXPECT_EQ(all[0].cost.min, 1.0);
  EXPECT_EQ(all[0].cost.max, 1000.0);
  EXPECT_NEAR(all[0].cost.mean(), 10.99, 1e-9);
  EXPECT_EQ(all[0].state, RobotState::suspect);
}

TEST(ScoreBuckets, BeginAtMultiplesOfTheResolution) {
  ScoreBuckets buckets(seconds(10), 100);
  for (const double at_s : {-0.1, 0.0, 9.999, 10.0, 35.0}) buckets.add(score(at_s, 1.0));
  const auto all = buckets.all();
  std::vector<std::int64_t> starts;
  starts.reserve(all.size());
  for (const auto& bucket : all) {
    starts.push_back(ns_since_epoch(bucket.from) / 1'000'000'000);
  }
  EXPECT_EQ(starts, (std::vector<std::int64_t>{-10, 0, 10, 30}));
}

TEST(ScoreBuckets, DoNotCareAboutTheOrder) {
  ScoreBuckets forth(seconds(1), 3);
  ScoreBuckets back(seconds(1), 3);
  for (int i = 0; i < 20; ++i) {
    forth.add(score(0.25 * i, i));
    back.add(score(0.25 * (19 - i), 19 - i));
  }
  EXPECT_EQ(forth.all(), back.all());
  ASSERT_EQ(back.all().size(), 3U);
  EXPECT_EQ(back.all()[2].cost.max, 11.0);
}

TEST(ScoreBuckets, AreCompleteOnceTheFirstOnesAre) {
  ScoreBuckets buckets(seconds(1), 2);
  buckets.add(score(0.5, 1.0));
  buckets.add(score(1.5, 1.0));
  EXPECT_FALSE(buckets.is_complete(later_by_s(Stamp{}, 2.0)));
  buckets.add(score(3.5, 1.0));
  EXPECT_TRUE(buckets.is_complete(later_by_s(Stamp{}, 3.0)));
  EXPECT_FALSE(buckets.is_complete(later_by_s(Stamp{}, 2.0)));
  EXPECT_EQ(buckets.all().size(), 2U);
}

TEST(ScoreBuckets, TellMotionAndTheLowestThresholds) {
  ScoreBucket bucket;
  Score one = score(0.0, std::numeric_limits<double>::infinity());
  one.threshold = 60.0;
  one.motion = MotionScore{.score = 2.0, .confirmed = 3.0, .threshold = 4.5, .carry = 0.5};
  Score two = one;
  two.threshold = 50.0;
  two.motion = MotionScore{.score = 7.0, .confirmed = {}, .threshold = 5.5, .carry = 1.5};
  bucket.add(one);
  bucket.add(two);
  EXPECT_EQ(bucket.cost.count, 0U);  // what is not finite
  EXPECT_EQ(bucket.motion.min, 2.0F);
  EXPECT_EQ(bucket.motion.max, 7.0F);
  EXPECT_EQ(bucket.motion.mean(), 4.5);
  EXPECT_EQ(bucket.confirmed.count, 1U);
  EXPECT_EQ(bucket.carry.mean(), 1.0);
  EXPECT_EQ(bucket.threshold, 50.0);
  EXPECT_EQ(bucket.motion_threshold, 4.5);
}

TEST(ScoreBuckets, ShowTheGravestState) {
  ScoreBucket bucket;
  for (const auto state : {RobotState::unknown, RobotState::kidnapped, RobotState::suspect,
                           RobotState::degraded, RobotState::normal}) {
    bucket.add(score(0.0, 1.0, state));
  }
  EXPECT_EQ(bucket.state, RobotState::kidnapped);
  ScoreBucket first;
  first.add(score(0.0, 1.0, RobotState::unknown));
  EXPECT_EQ(first.state, RobotState::unknown);
}

TEST(Spread, IsTheSameInWhateverPartsItIsAdded) {
  std::mt19937 random(1);
  std::normal_distribution<double> exponent(0.0, 12.0);
  for (int round = 0; round < 100; ++round) {
    std::vector<double> values;
    values.reserve(50);
    for (int i = 0; i < 50; ++i) values.push_back((i % 3 - 1) * std::exp(exponent(random)));
    Spread whole;
    for (const double value : values) whole.add(value);
    std::ranges::shuffle(values, random);
    std::array<Spread, 4> parts;
    for (const double value : values) parts.at(random() % parts.size()).add(value);
    Spread sum;
    for (const Spread& part : parts) sum.add(part);
    EXPECT_EQ(sum, whole);
  }
}

TEST(Spread, HasTheMeanOfAllButTheOutlandish) {
  Spread spread;
  for (const double value : {0.25, -1.75, 1e-20}) spread.add(value);
  EXPECT_EQ(spread.mean(), -0.5);
  spread.add(3e38);
  EXPECT_EQ(spread.max, 3e38F);
  EXPECT_NEAR(spread.mean(), 0x1p48, 1.0);
  for (const double value : {1e39, -HUGE_VAL, std::nan("")}) spread.add(value);
  EXPECT_EQ(spread.count, 4U);
}

TEST(ScoreBuckets, AddUpFromSmallerOnes) {
  std::mt19937 random(2);
  ScoreBuckets minutes(seconds(60), 1000);
  ScoreBuckets hours(seconds(3600), 10);
  for (int i = 0; i < 5000; ++i) {
    const auto one =
        score(static_cast<double>(random() % 100'000), static_cast<double>(random() % 777));
    minutes.add(one);
    hours.add(one);
  }
  ScoreBuckets sums(seconds(3600), 10);
  for (const auto& minute : minutes.all()) sums.add(minute);
  EXPECT_EQ(sums.all(), hours.all());
}

TEST(ScoreBuckets, LeaveAWiderBucketAsItIs) {
  ScoreBuckets buckets(seconds(10), 100);
  ScoreBuckets minutes(seconds(60), 100);
  for (const double at_s : {60.0, 119.0}) minutes.add(score(at_s, 1.0));
  buckets.add(score(55.0, 1.0));
  for (const auto& minute : minutes.all()) buckets.add(minute);
  for (const double at_s : {75.0, 120.0}) buckets.add(score(at_s, 5.0));
  const auto all = buckets.all();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[1].from, later_by_s(Stamp{}, 60.0));
  EXPECT_EQ(all[1].width, seconds(60));
  EXPECT_EQ(all[1].scores, 3U);
  EXPECT_EQ(all[1].cost.max, 5.0F);
  EXPECT_EQ(all[2].width, seconds(10));
}

TEST(ScoreBuckets, HoldStampsAtTheEndsOfTime) {
  ScoreBuckets buckets(seconds(86'400), 10);
  for (const auto stamp : {Stamp::min(), Stamp::max(), Stamp::max(), Stamp::min()}) {
    Score one = score(0.0, 1.0);
    one.stamp = stamp;
    buckets.add(one);
  }
  const auto all = buckets.all();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].scores + all[1].scores, 4U);
}

}  // namespace
}  // namespace kidnapwatch::core
