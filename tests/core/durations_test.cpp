// SPDX-License-Identifier: Apache-2.0
// Durations fall into the bucket whose bound they do not exceed.
#include "core/durations.hpp"

#include <numeric>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

TEST(Durations, AreCountedByBoundsThatAreIncluded) {
  Durations durations;
  for (const double s : {0.0, 0.0005, 0.0006, 0.1, 5.0, 5.1, 1e9}) durations.add(s);
  EXPECT_EQ(durations.counts().front(), 2U);
  EXPECT_EQ(durations.counts().at(1), 1U);
  EXPECT_EQ(durations.counts().at(7), 1U);
  EXPECT_EQ(durations.counts().at(12), 1U);
  EXPECT_EQ(durations.counts().back(), 2U);
}

TEST(Durations, AddUp) {
  Durations one;
  one.add(0.25);
  Durations both;
  both.add(0.5);
  both += one;
  EXPECT_DOUBLE_EQ(both.sum_s(), 0.75);
  EXPECT_EQ(std::accumulate(both.counts().begin(), both.counts().end(), std::uint64_t{0}), 2U);
}

}  // namespace
}  // namespace kidnapwatch::core
