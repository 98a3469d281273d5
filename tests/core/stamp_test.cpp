// SPDX-License-Identifier: Apache-2.0
// Stamps keep their nanoseconds.
#include "core/stamp.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

TEST(Stamp, ComesBackFromItsNanoseconds) {
  for (const std::int64_t ns :
       {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1'700'000'000'123'456'789},
        std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_EQ(ns_since_epoch(stamp_from_ns(ns)), ns);
  }
}

TEST(Stamp, CountsSecondsBothWays) {
  const Stamp early = stamp_from_ns(1'700'000'000'000'000'000);
  const Stamp late = stamp_from_ns(1'700'000'002'500'000'000);
  EXPECT_DOUBLE_EQ(elapsed_s(early, late), 2.5);
  EXPECT_DOUBLE_EQ(elapsed_s(late, early), -2.5);
}

TEST(Stamp, MovesBySecondsRoundedTowardsZero) {
  const Stamp start = stamp_from_ns(1'000);
  EXPECT_EQ(ns_since_epoch(later_by_s(start, 2.5)), 2'500'001'000);
  EXPECT_EQ(ns_since_epoch(later_by_s(start, 1.9e-9)), 1'001);
  EXPECT_EQ(ns_since_epoch(later_by_s(start, -1.9e-9)), 999);
}

}  // namespace
}  // namespace kidnapwatch::core
