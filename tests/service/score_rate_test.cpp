// SPDX-License-Identifier: Apache-2.0
// Few scores are published, and never too few to see a change.
#include "service/score_rate.hpp"

#include <gtest/gtest.h>

namespace kidnapwatch::service {
namespace {

using core::RobotState;

core::Stamp at_ms(std::int64_t ms) { return core::stamp_from_ns(ms * 1'000'000); }

TEST(ScoreRate, LetsSoManyOfEachRobotPassInASecond) {
  ScoreRate rate(2);
  int passed = 0;
  for (int ms = 0; ms < 10'000; ms += 100) {
    if (rate.allows("r1", RobotState::normal, at_ms(ms))) ++passed;
  }
  EXPECT_EQ(passed, 20);
  EXPECT_TRUE(rate.allows("r2", RobotState::normal, at_ms(9'900)));
}

TEST(ScoreRate, LetsEveryChangeOfStatePass) {
  ScoreRate rate(1);
  EXPECT_TRUE(rate.allows("r1", RobotState::normal, at_ms(0)));
  EXPECT_TRUE(rate.allows("r1", RobotState::suspect, at_ms(100)));
  EXPECT_TRUE(rate.allows("r1", RobotState::kidnapped, at_ms(200)));
  EXPECT_FALSE(rate.allows("r1", RobotState::kidnapped, at_ms(300)));
}

TEST(ScoreRate, GoesOnWhenTheClockWentBack) {
  ScoreRate rate(1);
  EXPECT_TRUE(rate.allows("r1", RobotState::normal, at_ms(86'400'000)));
  EXPECT_TRUE(rate.allows("r1", RobotState::normal, at_ms(0)));
  EXPECT_FALSE(rate.allows("r1", RobotState::normal, at_ms(100)));
}

TEST(ScoreRate, OfNoneLetsNothingPass) {
  ScoreRate rate(0);
  EXPECT_FALSE(rate.allows("r1", RobotState::kidnapped, at_ms(0)));
}

}  // namespace
}  // namespace kidnapwatch::service
