// SPDX-License-Identifier: Apache-2.0
// Quantiles and tails of streams.
#include "core/tail.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

Tail exponential(int values, float half_life = 1e9F, unsigned seed = 1) {
  Tail tail(0.0F, 20.0F, half_life);
  std::mt19937_64 random(seed);
  std::exponential_distribution<float> draw(1.0F);
  for (int i = 0; i < values; ++i) tail.learn(draw(random));
  return tail;
}

TEST(Tail, KnowsTheQuantilesOfAnExponential) {
  const Tail tail = exponential(20000);
  for (const float p : {0.5F, 0.9F, 0.95F, 0.99F})
    EXPECT_NEAR(tail.quantile(p), -std::log(1.0F - p), 0.12F) << p;
  EXPECT_NEAR(tail.count(), 20000.0F, 5.0F);
}

TEST(Tail, CountsAndSumsTheExcesses) {
  const Tail tail = exponential(20000);
  const Tail::Excess excess = tail.excess(tail.quantile(0.9F));
  EXPECT_NEAR(excess.count, 2000.0F, 60.0F);
  EXPECT_NEAR(excess.sum / excess.count, 1.0F, 0.08F);
}

TEST(Tail, ForgetsWhatIsManyHalfLivesAgo) {
  Tail tail(0.0F, 20.0F, 100.0F);
  for (int i = 0; i < 5000; ++i) tail.learn(15.0F);
  for (int i = 0; i < 2000; ++i) tail.learn(1.0F);
  EXPECT_NEAR(tail.quantile(0.99F), 1.0F, 0.1F);
  EXPECT_NEAR(tail.count(), 100.0F / std::log(2.0F), 2.0F);
}

TEST(Tail, IsTheSameAfterBeingKeptAndPutBack) {
  const Tail tail = exponential(3000, 500.0F);
  std::vector<float> kept;
  const auto keep = [&](float number) { kept.push_back(number); };
  Tail::visit_learned(tail, keep);
  Tail again(0.0F, 20.0F, 500.0F);
  auto put_back = [next = kept.begin()](float& number) mutable { number = *next++; };
  Tail::visit_learned(again, put_back);
  EXPECT_EQ(again.quantile(0.95F), tail.quantile(0.95F));
  EXPECT_EQ(again.count(), tail.count());
  EXPECT_EQ(again.excess(2.0F).count, tail.excess(2.0F).count);
}

TEST(Tail, PutsValuesBeyondItsRangeAtItsEnds) {
  Tail tail(0.0F, 20.0F, 100.0F);
  tail.learn(-5.0F);
  tail.learn(1e9F);
  EXPECT_LT(tail.quantile(0.4F), 0.1F);
  EXPECT_GT(tail.quantile(1.0F), 19.9F);
}

TEST(PredictedThreshold, IsExceededAsOftenAsTargeted) {
  EXPECT_NEAR(predicted_threshold(exponential(50000), 1e-3F, 0.0F, 0.0F), std::log(1000.0F), 0.5F);
}

TEST(PredictedThreshold, IsMoreCarefulWithFewValuesOnAverage) {
  float few = 0.0F;
  for (unsigned seed = 1; seed <= 50; ++seed)
    few += predicted_threshold(exponential(100, 1e9F, seed), 1e-3F, 0.0F, 0.0F) / 50.0F;
  EXPECT_GT(few, predicted_threshold(exponential(50000), 1e-3F, 0.0F, 0.0F));
}

TEST(PredictedThreshold, StartsFromItsPriorAlone) {
  const Tail nothing(0.0F, 20.0F, 100.0F);
  EXPECT_NEAR(predicted_threshold(nothing, 1e-3F, 10.0F, 1.0F),
              10.0F * (std::pow(50.0F, 0.1F) - 1.0F), 1e-3F);
}

}  // namespace
}  // namespace kidnapwatch::core
