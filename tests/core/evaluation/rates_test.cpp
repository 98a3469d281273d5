// SPDX-License-Identifier: Apache-2.0
// Rates, their intervals, and thresholds for them.
#include "core/evaluation/rates.hpp"

#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace kidnapwatch::core::evaluation {
namespace {

TEST(Rate, HasWilsonsInterval) {
  const Rate rate{3, 10};  // Wilson (1927): 0.1078, 0.6032
  EXPECT_DOUBLE_EQ(rate.value(), 0.3);
  EXPECT_NEAR(rate.low(), 0.1078, 1e-4);
  EXPECT_NEAR(rate.high(), 0.6032, 1e-4);
}

TEST(Rate, NeverClaimsZeroFromFewTrials) {
  EXPECT_NEAR((Rate{0, 100}.high()), 0.0370, 1e-4);
  EXPECT_EQ((Rate{0, 100}.low()), 0.0);
  EXPECT_EQ((Rate{0, 0}.high()), 1.0);
}

TEST(ThresholdAt, IsExceededByNoMoreThanTheRate) {
  std::vector<double> scores(1000);
  std::iota(scores.begin(), scores.end(), 1.0);
  EXPECT_EQ(share_above(scores, threshold_at(scores, 1e-2)).hits, 10U);
  EXPECT_EQ(share_above(scores, threshold_at(scores, 1e-3)).hits, 1U);
  EXPECT_EQ(share_above(scores, threshold_at(scores, 1e-4)).hits, 0U);
}

}  // namespace
}  // namespace kidnapwatch::core::evaluation
