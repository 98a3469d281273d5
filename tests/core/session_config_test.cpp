// SPDX-License-Identifier: Apache-2.0
// Which configurations of the detection are refused, and by which field.
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"
#include "core/session.hpp"

namespace kidnapwatch::core {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The field that check() refuses after `change`, or "".
template <typename Change>
std::string refused(Change change) {
  DetectionConfig config;
  change(config);
  try {
    check(config);
  } catch (const BadInput& error) {
    return error.field();
  }
  return "";
}

TEST(CheckDetectionConfig, TakesTheDefaults) { EXPECT_NO_THROW(check(DetectionConfig{})); }

TEST(CheckDetectionConfig, WantsDetectorsThatThereAreOnceEach) {
  const auto with = [](std::vector<std::string> names) {
    return refused([&](auto& config) { config.detectors = names; });
  };
  EXPECT_EQ(with({"ndt_qe", "qs2ddtw", "me"}), "");
  EXPECT_EQ(with({"ndt_qx"}), "detectors");
  EXPECT_EQ(with({"ndt_qe", "ndt_qe"}), "detectors");
}

TEST(CheckDetectionConfig, WantsAShareAsSignificance) {
  for (const double bad : {0.0, 1.0, -0.05, kNan, kInfinity}) {
    EXPECT_EQ(refused([&](auto& config) { config.dissimilarity.significance = bad; }),
              "dissimilarity.significance");
  }
}

TEST(CheckDetectionConfig, WantsAFalseAlarmRateBelowTheTail) {
  for (const double bad : {0.0, 0.05, -0.001, kNan}) {
    EXPECT_EQ(refused([&](auto& config) { config.calibration.false_alarm_rate = bad; }),
              "calibration.false_alarm_rate");
  }
}

TEST(CheckDetectionConfig, WantsAWindowThatHoldsTheWarmup) {
  for (const std::size_t bad : {0, 19, 100'001}) {
    EXPECT_EQ(refused([&](auto& config) { config.calibration.window_pairs = bad; }),
              "calibration.window_pairs");
  }
  for (const std::size_t bad : {0, 19, 201}) {
    EXPECT_EQ(refused([&](auto& config) {
                config.calibration.window_pairs = 200;
                config.calibration.warmup_pairs = bad;
              }),
              "calibration.warmup_pairs");
  }
  EXPECT_EQ(refused([](auto& config) { config.calibration.warmup_pairs = 1000; }), "");
}

TEST(CheckDetectionConfig, WantsAThresholdAboveZeroOrNone) {
  for (const double bad : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_EQ(refused([&](auto& config) { config.threshold = bad; }), "threshold");
  }
  EXPECT_EQ(refused([](auto& config) { config.threshold = 1e-9; }), "");
}

TEST(CheckDetectionConfig, WantsUsableTimes) {
  for (const double bad : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_EQ(refused([&](auto& config) { config.stale_after_s = bad; }), "stale_after_s");
  }
  for (const double bad : {-1.0, kNan, kInfinity}) {
    EXPECT_EQ(refused([&](auto& config) { config.resolve_after_s = bad; }), "resolve_after_s");
  }
  EXPECT_EQ(refused([](auto& config) { config.resolve_after_s = 0.0; }), "");
}

TEST(CheckDetectionConfig, WantsAFewScansToBelieveAClock) {
  for (const std::size_t bad : {0, 1, 1001}) {
    EXPECT_EQ(refused([&](auto& config) { config.resync_scans = bad; }), "resync_scans");
  }
}

}  // namespace
}  // namespace kidnapwatch::core
