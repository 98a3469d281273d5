// SPDX-License-Identifier: Apache-2.0
// Eqs. (9)-(12) by hand: weights of two, three and many particles.
#include "core/baselines/particle_scores.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace kidnapwatch::core::baselines {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(MaxCurrentWeight, IsTheLargestAsGiven) {
  EXPECT_EQ(max_current_weight(std::array{0.02, 0.07, 0.01}), 0.07);
  EXPECT_EQ(max_current_weight({}), 0.0);
}

TEST(MeasurementEntropy, HasTheTextbookValues) {
  EXPECT_NEAR(measurement_entropy(std::array{0.5, 0.5}), 0.6931471805599453, 1e-15);
  EXPECT_NEAR(measurement_entropy(std::array{0.5, 0.25, 0.25}), 1.0397207708399179, 1e-15);
  EXPECT_NEAR(measurement_entropy(std::array{0.1, 0.2, 0.7}), 0.8018185525433373, 1e-15);
  EXPECT_EQ(measurement_entropy(std::array{1.0, 0.0, 0.0}), 0.0);
  EXPECT_NEAR(measurement_entropy(std::vector<double>(2000, 0.3)), std::log(2000.0), 1e-12);
}

TEST(MeasurementEntropy, NormalisesTheWeights) {
  EXPECT_NEAR(measurement_entropy(std::array{3.0, 6.0, 21.0}), 0.8018185525433373, 1e-14);
}

TEST(MeasurementEntropy, OfNothingIsNotANumber) {
  EXPECT_TRUE(std::isnan(measurement_entropy({})));
  EXPECT_TRUE(std::isnan(measurement_entropy(std::array{0.0, 0.0})));
  EXPECT_TRUE(std::isnan(measurement_entropy(std::array{0.5, -0.5, 1.0})));
  EXPECT_TRUE(std::isnan(measurement_entropy(std::array{0.5, kNaN})));
  EXPECT_TRUE(std::isnan(measurement_entropy(std::array{0.5, kInfinity})));
}

TEST(MeasurementEntropyOfLogs, IsTheSameHoweverSmallTheWeights) {
  const std::array logs{std::log(0.1) - 5000.0, std::log(0.2) - 5000.0, std::log(0.7) - 5000.0};
  EXPECT_NEAR(measurement_entropy_of_logs(logs), 0.8018185525433373, 1e-11);
  EXPECT_EQ(measurement_entropy_of_logs(std::array{0.0, -2000.0}), 0.0);
  EXPECT_EQ(measurement_entropy_of_logs(std::array{0.0, -kInfinity}), 0.0);
  EXPECT_TRUE(std::isnan(measurement_entropy_of_logs(std::array{-kInfinity})));
}

TEST(EffectiveSampleSize, CountsWhoHasWeight) {
  EXPECT_NEAR(effective_sample_size(std::array{0.2, 0.2, 0.2, 0.2, 0.2}), 5.0, 1e-12);
  EXPECT_NEAR(effective_sample_size(std::array{1.0, 0.0, 0.0}), 1.0, 1e-12);
  EXPECT_NEAR(effective_sample_size(std::array{6.0, 3.0}), 1.8, 1e-12);
  EXPECT_EQ(effective_sample_size({}), 0.0);
}

}  // namespace
}  // namespace kidnapwatch::core::baselines
