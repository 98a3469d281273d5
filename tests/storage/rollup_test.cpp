// SPDX-License-Identifier: Apache-2.0
// Packed rollups: what goes in comes out, whatever it is; broken bytes are told apart.
#include "storage/rollup.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "storage/sqlite.hpp"
#include "tests/storage/any_score.hpp"

namespace kidnapwatch::storage {
namespace {

using std::chrono::seconds;

/// Of any scores within the span of the level that holds at_s(0).
std::vector<core::ScoreBucket> any_run(const RollupLevel& level, int scores, std::mt19937& random) {
  const auto begin = core::begin_of(level.span, at_s(0));
  core::ScoreBuckets buckets(level.width, std::numeric_limits<std::size_t>::max());
  for (int i = 0; i < scores; ++i) {
    auto score = any_score(0, random);
    score.stamp = begin + seconds(random() % static_cast<unsigned>(level.span.count()));
    buckets.add(score);
  }
  return buckets.all();
}

TEST(Rollup, AnythingComesBack) {
  std::mt19937 random(1);
  for (const auto& level : {kMinutes, kHours}) {
    for (const int scores : {0, 1, 2, 50, 5000}) {
      const auto run = any_run(level, scores, random);
      EXPECT_EQ(unpacked(packed(run, level), level), run) << scores;
    }
  }
}

TEST(Rollup, ABucketTakesFewBytes) {
  std::mt19937 random(2);
  core::ScoreBuckets buckets(kMinutes.width, 60);
  std::lognormal_distribution cost(2.0, 0.6);
  for (int i = 0; i < 60 * 300; ++i) {
    auto score = score_at(0.2 * i, cost(random));
    score.motion = core::MotionScore{.score = cost(random), .threshold = 4.5, .carry = 0.25};
    buckets.add(as_stored(score));
  }
  const auto run = buckets.all();
  EXPECT_LT(packed(std::span(run).first(20), kMinutes).size(), 20U * 60);  // of 300 in memory
}

TEST(Rollup, BrokenBytesAreRefused) {
  std::mt19937 random(3);
  const auto whole = packed(any_run(kMinutes, 500, random), kMinutes);
  EXPECT_THROW((void)unpacked({}, kMinutes), StorageError);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW((void)unpacked(std::span(whole).first(size), kMinutes), StorageError) << size;
  }
  int refused = 0;
  for (int round = 0; round < 2000; ++round) {
    auto broken = whole;
    broken.at(random() % broken.size()) ^= static_cast<std::byte>(1 + random() % 255);
    try {
      (void)unpacked(broken, kMinutes);  // may be other buckets, but must end
    } catch (const StorageError& error) {
      EXPECT_TRUE(error.is_damage());
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(Nesting, IsTheLeastThatEndsWhereMinutesAndHoursEnd) {
  const auto nested = [](int s) { return nesting(seconds(s)).count(); };
  for (const int s : {1, 2, 10, 15, 30, 60, 120, 300, 720, 1800, 3600, 7200, 5 * 3600, 86'400}) {
    EXPECT_EQ(nested(s), s);
  }
  EXPECT_EQ(nested(7), 10);
  EXPECT_EQ(nested(31), 60);
  EXPECT_EQ(nested(61), 120);
  EXPECT_EQ(nested(450), 600);
  EXPECT_EQ(nested(1801), 3600);
  EXPECT_EQ(nested(3601), 7200);
  EXPECT_EQ(nested(86'399), 86'400);
}

}  // namespace
}  // namespace kidnapwatch::storage
