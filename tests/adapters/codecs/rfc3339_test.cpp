// SPDX-License-Identifier: Apache-2.0
// RFC 3339 both ways.
#include "adapters/codecs/rfc3339.hpp"

#include <random>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

std::int64_t read_ns(std::string_view text) {
  return core::ns_since_epoch(stamp_from_rfc3339(text, "from"));
}

TEST(Rfc3339, WritesNineDigitsInUtc) {
  EXPECT_EQ(rfc3339(core::stamp_from_ns(0)), "1970-01-01T00:00:00.000000000Z");
  EXPECT_EQ(rfc3339(core::stamp_from_ns(1'767'225'600'000'000'001)),
            "2026-01-01T00:00:00.000000001Z");
  EXPECT_EQ(rfc3339(core::stamp_from_ns(-1)), "1969-12-31T23:59:59.999999999Z");
}

TEST(Rfc3339, ReadsFractionsAndOffsets) {
  EXPECT_EQ(read_ns("1970-01-01T00:00:00Z"), 0);
  EXPECT_EQ(read_ns("1970-01-01t00:00:00.5z"), 500'000'000);
  EXPECT_EQ(read_ns("1970-01-01T00:00:00.000000001Z"), 1);
  EXPECT_EQ(read_ns("1970-01-01T02:00:00+02:00"), 0);
  EXPECT_EQ(read_ns("1969-12-31T18:30:00-05:30"), 0);
  EXPECT_EQ(read_ns("2024-02-29T00:00:00Z"), 1'709'164'800'000'000'000);
}

TEST(Rfc3339, RefusesEverythingElse) {
  for (const char* bad : {"",
                          "now",
                          "2026-01-01",
                          "2026-01-01T00:00:00",
                          "2026-01-01 00:00:00Z",
                          "2026-01-01T00:00Z",
                          "2026-13-01T00:00:00Z",
                          "2026-00-01T00:00:00Z",
                          "2026-02-29T00:00:00Z",
                          "2026-04-31T00:00:00Z",
                          "2026-01-01T24:00:00Z",
                          "2026-01-01T00:60:00Z",
                          "2026-01-01T00:00:60Z",
                          "2026-01-01T00:00:00.Z",
                          "2026-01-01T00:00:00.0000000001Z",
                          "2026-01-01T00:00:00+2:00",
                          "2026-01-01T00:00:00+0200",
                          "2026-01-01T00:00:00+24:00",
                          "2026-01-01T00:00:00Z ",
                          " 2026-01-01T00:00:00Z",
                          "+026-01-01T00:00:00Z",
                          "1600-01-01T00:00:00Z",
                          "2262-01-01T00:00:00Z",
                          "2026\r01-01T00:00:00Z",
                          "2026-01-01\02400:00:00Z"}) {
    EXPECT_THROW((void)stamp_from_rfc3339(bad, "from"), core::BadInput) << bad;
  }
}

TEST(Rfc3339, NamesTheField) {
  try {
    (void)stamp_from_rfc3339("yesterday", "from");
    FAIL() << "no exception";
  } catch (const core::BadInput& error) {
    EXPECT_EQ(error.field(), "from");
  }
}

TEST(Rfc3339, ReadsWhatItWroteAndKeepsTheOrder) {
  std::mt19937_64 random(7);
  std::uniform_int_distribution<std::int64_t> ns(-9'000'000'000'000'000'000,
                                                 9'000'000'000'000'000'000);
  for (int i = 0; i < 2000; ++i) {
    const auto a = core::stamp_from_ns(ns(random));
    const auto b = core::stamp_from_ns(ns(random));
    EXPECT_EQ(stamp_from_rfc3339(rfc3339(a), "x"), a);
    EXPECT_EQ(rfc3339(a) < rfc3339(b), a < b);
  }
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
