// SPDX-License-Identifier: Apache-2.0
// Mean and variance keep their digits.
#include "core/moments.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

TEST(Moments, DivideTheSquaresByNMinusOne) {
  const Moments m = moments(std::vector{2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0});
  EXPECT_DOUBLE_EQ(m.mean, 5.0);
  EXPECT_DOUBLE_EQ(m.variance, 32.0 / 7.0);
}

TEST(Moments, OfOneValueHaveNoVariance) {
  const Moments m = moments(std::vector{3.5});
  EXPECT_EQ(m.mean, 3.5);
  EXPECT_EQ(m.variance, 0.0);
}

TEST(Moments, KeepASmallVarianceFarFromZero) {
  EXPECT_DOUBLE_EQ(moments(std::vector{1e9, 1e9 + 1.0, 1e9 + 2.0}).variance, 1.0);
}

}  // namespace
}  // namespace kidnapwatch::core
