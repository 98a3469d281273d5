// SPDX-License-Identifier: Apache-2.0
// The normal numbers are normal, and everywhere the same.
#include "core/random.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

TEST(Normal, HasTheMomentsAndTailsOfTheNormalDistribution) {
  constexpr int kDraws = 100'000;
  std::mt19937_64 random(1);
  Normal normal;
  double sum = 0.0;
  double squares = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = normal(random);
    sum += value;
    squares += value * value;
    beyond_two += std::abs(value) > 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.015);
  EXPECT_NEAR(squares / kDraws, 1.0, 0.02);
  EXPECT_NEAR(static_cast<double>(beyond_two) / kDraws, 0.0455, 0.003);
}

TEST(Uniform, LiesInZeroToOne) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 10'000; ++i) {
    const double value = uniform(random);
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
  }
}

TEST(Uniform, IsTheUpperBitsOfAGeneratorThatTheStandardFixes) {
  std::mt19937_64 random;  // its 10000th number is fixed by the standard
  random.discard(9999);
  EXPECT_DOUBLE_EQ(uniform(random), static_cast<double>(9981545732273789042ULL >> 11U) * 0x1p-53);
}

}  // namespace
}  // namespace kidnapwatch::core
