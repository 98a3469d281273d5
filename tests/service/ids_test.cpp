// SPDX-License-Identifier: Apache-2.0
// Identifiers are UUIDv7 and keep their order.
#include "service/ids.hpp"

#include <regex>

#include <gtest/gtest.h>

namespace kidnapwatch::service {
namespace {

TEST(Ids, AreUuidsOfVersionSevenWithTheirTime) {
  Ids ids(1);
  const auto id = ids.next(core::stamp_from_ns(0x0123456789abLL * 1'000'000));
  EXPECT_TRUE(
      std::regex_match(id, std::regex("01234567-89ab-7[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}")))
      << id;
}

TEST(Ids, SortAsTheyWereMadeEvenIfTheClockGoesBack) {
  Ids ids(1);
  std::string last;
  for (int i = 0; i < 10'000; ++i) {
    const auto id = ids.next(core::stamp_from_ns(5'000'000'000'000 - i * 300'000LL));
    EXPECT_LT(last, id);
    last = id;
  }
}

TEST(Ids, SurviveAClockBeforeTheEpoch) {
  Ids ids(1);
  EXPECT_EQ(ids.next(core::stamp_from_ns(-1)).size(), 36U);
}

}  // namespace
}  // namespace kidnapwatch::service
