// SPDX-License-Identifier: Apache-2.0
// Each thing that can go wrong is told by its name, and for how long.
#include "service/health.hpp"

#include <gtest/gtest.h>

namespace kidnapwatch::service {
namespace {

class HealthTest : public ::testing::Test {
 protected:
  HealthTest() { signs_.broker_connected = true; }

  /// The names of what is wrong `seconds` later.
  std::vector<std::string> after(std::chrono::seconds seconds) {
    signs_.time += seconds;
    signs_.clock += seconds;
    std::vector<std::string> names;
    for (const auto& degradation : health_.look(signs_)) {
      EXPECT_FALSE(degradation.what.empty());
      names.push_back(degradation.name);
    }
    return names;
  }

  using Names = std::vector<std::string>;
  Health health_;
  Signs signs_;
};

constexpr std::chrono::seconds kSecond{1};

TEST_F(HealthTest, NothingIsWrongWhereNothingIs) {
  EXPECT_EQ(after(kSecond), Names{});
  EXPECT_EQ(after(kSecond), Names{});
}

TEST_F(HealthTest, WhatIsWrongNowIsToldAsLongAsItIs) {
  signs_.broker_connected = false;
  signs_.store_problem = "disk full";
  signs_.quarantined = "store.damaged-1";
  EXPECT_EQ(after(kSecond), (Names{"broker", "store", "quarantine"}));
  signs_.broker_connected = true;
  signs_.store_problem = "";
  EXPECT_EQ(after(kSecond), Names{"quarantine"});
}

TEST_F(HealthTest, AJumpOfTheClockIsToldForTenMinutesEitherWay) {
  for (const auto jump : {std::chrono::hours(48), std::chrono::hours(-1)}) {
    (void)after(kSecond);
    signs_.clock += jump;
    EXPECT_EQ(after(kSecond), Names{"clock"});
    EXPECT_EQ(after(std::chrono::seconds(599)), Names{"clock"});
    EXPECT_EQ(after(kSecond), Names{});
  }
}

TEST_F(HealthTest, AClockThatIsSlewedHasNotJumped) {
  for (int i = 0; i < 100; ++i) {
    signs_.clock += std::chrono::milliseconds(500);
    EXPECT_EQ(after(kSecond), Names{});
  }
}

TEST_F(HealthTest, AnOverloadIsToldForAMinuteAfterTheLastLoss) {
  signs_.dropped = 5;
  EXPECT_EQ(after(kSecond), Names{"overload"});
  EXPECT_EQ(after(std::chrono::seconds(50)), Names{"overload"});
  signs_.lost_writes = 1;
  EXPECT_EQ(after(kSecond), Names{"overload"});
  EXPECT_EQ(after(std::chrono::seconds(59)), Names{"overload"});
  EXPECT_EQ(after(kSecond), Names{});
}

}  // namespace
}  // namespace kidnapwatch::service
