// SPDX-License-Identifier: Apache-2.0
// Stamps go forward whatever the log's clock did.
#include "adapters/logs/stamps.hpp"

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

std::vector<double> repaired(const std::vector<double>& logged_s) {
  std::vector<double> seconds;
  for (const core::Stamp stamp : increasing_stamps(logged_s, "log")) {
    seconds.push_back(core::elapsed_s(core::Stamp{}, stamp));
  }
  return seconds;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-6) << i;
}

TEST(IncreasingStamps, KeepAGoodClock) {
  expect_near(repaired({32.9, 35.1, 36.4}), {32.9, 35.1, 36.4});
  expect_near(repaired({1134864642.914187, 1134864643.764189}),
              {1134864642.914187, 1134864643.764189});
  expect_near(repaired({5.0}), {5.0});
  EXPECT_TRUE(repaired({}).empty());
}

TEST(IncreasingStamps, BridgeStepsBackAndStandstillWithTheUsualStep) {
  expect_near(repaired({0, 1, 2, 3, 2.5, 3.5, 4.5}), {0, 1, 2, 3, 4, 5, 6});
  expect_near(repaired({0, 1, 2, 2, 3, 4}), {0, 1, 2, 3, 4, 5});
}

TEST(IncreasingStamps, BridgeTheClocksLeaps) {
  expect_near(repaired({0, 1, 2, 4.29497e9, 4.29497e9 + 1, 7, 8}), {0, 1, 2, 3, 4, 5, 6});
}

TEST(IncreasingStamps, CountScansWhereTheClockSaysNothing) {
  expect_near(repaired({1.01893e9, 1.01893e9, 1.01893e9, 1.01894e9}),
              {1.01893e9, 1.01893e9 + 1, 1.01893e9 + 2, 1.01893e9 + 3});
  expect_near(repaired({0, 0, 0}), {0, 1, 2});
}

TEST(IncreasingStamps, StartIn1970IfTheStartIsNoTime) {
  expect_near(repaired({-0.4, 0.6, 1.6}), {0, 1, 2});
  expect_near(repaired({1e300, 1.0, 2.0, 3.0}), {0, 1, 2, 3});
}

TEST(IncreasingStamps, RefuseWhatNoStampCanHold) {
  std::vector<double> logged_s;
  for (int i = 0; i < 110'000; ++i) logged_s.push_back(86'400.0 * i);
  EXPECT_THROW(static_cast<void>(increasing_stamps(logged_s, "log")), core::BadInput);
}

}  // namespace
}  // namespace kidnapwatch::adapters::logs
